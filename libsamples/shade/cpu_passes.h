// SPDX-License-Identifier: GPL-3.0-or-later
// One pass of a plan and the pictures it reads → the picture it makes, on the CPU.
#pragma once

#include "core/progress.h"
#include "methods/block.h"
#include "methods/passes.h"

#include <vector>

namespace nook
{

using Planes = std::vector<PicturePlane>; // levels, or layers, of a picture

// The plan's pictures, empty.
std::vector<Planes> picturesFor(const ShadePlan& plan);

// `inputs` holds depths, normals and samples.
void runPass(const ShadePass& pass, const shade_kernels::Kernels& inputs, std::vector<Planes>& pictures, const RunSettings& run);

} // namespace nook
