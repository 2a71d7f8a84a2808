// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths of a G-buffer that the kernels could not take.
#include "core/error.h"
#include "core/length.h"
#include "core/number.h"
#include "methods/block.h"

#include <cmath>
#include <string>

namespace nook
{
namespace
{

// What is wrong with the picture's width or height at a depth; empty: nothing.
std::string wrongAcross(const glm::dvec3& across, double w, double depth_m)
{
	const double half_m = w * std::fabs(across.x);
	const double aside_m = depth_m * std::fabs(across.y) + std::fabs(across.z);
	if (!isLength(half_m))
	{
		return ", where half the picture is " + numberText(half_m) + " m";
	}
	return aside_m <= kMostLength_m ? "" : ", where the picture's middle is " + numberText(aside_m) + " m aside";
}

} // namespace

void checkLengths(const ShadeFrame& frame, const ShadeBlock& block)
{
	const glm::dvec3 across_x(block.across_x, block.aside.x);
	const glm::dvec3 across_y(block.across_y, block.aside.y);
	for (std::size_t i = 0; i < frame.depth.size(); ++i)
	{
		const auto depth_m = static_cast<double>(frame.depth[i]);
		if (!std::isfinite(depth_m))
		{
			continue;
		}
		const double w = static_cast<double>(block.w_slope) * depth_m + static_cast<double>(block.w_start);
		const std::string wrong_x = wrongAcross(across_x, w, depth_m);
		const std::string wrong = wrong_x.empty() ? wrongAcross(across_y, w, depth_m) : wrong_x;
		if (isLength(depth_m) && wrong.empty())
		{
			continue;
		}
		const auto width = static_cast<std::size_t>(frame.width_px);
		throw Error(ExitCode::invalid_input, "depth, pixel " + std::to_string(i % width) + "," + std::to_string(i / width) +
												 ": found " + numberText(depth_m) + " m" + (isLength(depth_m) ? wrong : "") +
												 ", expected lengths from " + numberText(kLeastLength_m) + " to " +
												 numberText(kMostLength_m) + " m");
	}
}

} // namespace nook
