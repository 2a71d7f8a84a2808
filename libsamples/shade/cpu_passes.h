// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the passes of a plan on the CPU.
#pragma once

#include "core/progress.h"
#include "methods/block.h"
#include "methods/passes.h"
#include "methods/picture.h"

#include <vector>

namespace nook
{

using Planes = std::vector<PicturePlane>; // levels or layers of a picture

// Allocates the plan's pictures.
std::vector<Planes> picturesFor(const ShadePlan& plan);

// `inputs` holds depths, normals and samples.
void runPass(const ShadePass& pass, const shade_kernels::Kernels& inputs, std::vector<Planes>& pictures, const RunSettings& run);

// Prefix sums along the rows or columns of a picture of counts, on the CPU.

// Along x (axis 0) or y (1). Requires planes of equal size.
void scanOnCpu(const PicturePlane& source, int axis, PicturePlane& target, const RunSettings& run);

} // namespace nook
