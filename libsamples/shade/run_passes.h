// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the passes of a plan on the CPU, and takes the times of passes over several drawings.
#pragma once

#include "core/progress.h"
#include "methods/block.h"
#include "methods/passes.h"
#include "methods/picture.h"
#include "shade/shade.h"

#include <string>
#include <vector>

namespace nook
{

using Planes = std::vector<PicturePlane>; // levels or layers of a picture

// Allocates the plan's pictures.
std::vector<Planes> picturesFor(const ShadePlan& plan);

// `inputs` holds depths, normals and samples.
void runPass(const ShadePass& pass, const shade_kernels::Kernels& inputs, std::vector<Planes>& pictures, const RunSettings& run);

// Prefix sums of a picture of counts along x (axis 0) or y (1). Requires planes of equal size.
void scanOnCpu(const PicturePlane& source, int axis, PicturePlane& target, const RunSettings& run);

// The median, without the first of several drawings, which is a warm-up. Requires at least one.
PassTime passTimeOf(const std::string& name, std::vector<double> seconds);

// Stores the last pass's result: visibility, or bent normals and visibility as four values per pixel.
void setResult(Shaded& shaded, std::vector<float> values, bool quads);

// Stores the medians of the passes of several drawings, and their sum. The first drawing is a warm-up.
void setTimes(Shaded& shaded, const std::vector<std::vector<PassTime>>& drawings);

} // namespace nook
