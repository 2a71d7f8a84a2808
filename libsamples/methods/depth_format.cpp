// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/depth_format.h"

#include "core/error.h"
#include "core/round.h"
#include "methods/block.h"
#include "methods/kernels.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

} // namespace

void fillDepth(ShadeBlock& block, const glm::dmat4& projection, const DepthFormat& format)
{
	const glm::dmat4 p = unitProjection(projection);
	assert(format.bits == 16 || format.bits == 24 || format.bits == 32);
	block.depth = glm::vec4(0.0F);
	block.depth_step = 0.0F;
	block.depth_share = static_cast<float>(format.bits == 16 ? kHalfRoundoff : kUnitRoundoff);
	if (!format.device)
	{
		return;
	}
	if (p[0][2] != 0.0 || p[1][2] != 0.0)
	{
		throw Error(ExitCode::unsupported, "projection: found a z that depends on x or y, expected none with device depth");
	}
	// z_ndc = scale * device + least, and w z_ndc = clip z: depth = (a + b device) / (c + e device). What 2 x 2 numbers have of
	// rank decides about all of it: steps of device depth are |det|^-1 w^2 long, and their sign says which end is far.
	const double det = p[2][2] * p[3][3] - p[2][3] * p[3][2];
	const double scale = format.clip == ClipRange::zero_to_one ? 1.0 : 2.0;
	const double least = format.clip == ClipRange::zero_to_one ? 0.0 : -1.0;
	const double far = det < 0.0 ? 1.0 : 0.0;
	const double turn = det < 0.0 ? -scale : scale; // of z_ndc, a step away from the far end
	const double end = least + far * scale;         // z_ndc there
	const double above = p[3][2] - p[3][3] * end;
	const double below = p[2][2] - p[2][3] * end;
	const double near = below - p[2][3] * turn; // the same at the other end; what divides all, so that signs and sizes are known
	if (!std::isfinite(det) || det == 0.0 || near == 0.0)
	{
		throw Error(ExitCode::invalid_input,
					"projection: found a z that does not depend on depth, expected another with device depth");
	}
	block.depth = glm::vec4(glm::dvec4(above / near, (0.0 - p[3][3] * turn) / near, below / near, (0.0 - p[2][3] * turn) / near));
	block.far_end = static_cast<float>(far);
	// Half a step, and towards 1 half a step of the floats as which all formats are read.
	const double half_step = (format.bits == 32 ? 0.0 : 0.5 / (std::ldexp(1.0, format.bits) - 1.0)) + far * 0.5 * kUnitRoundoff;
	// Parallel projections take the far end's depth and a part of it off: what that leaves is as exact as what it began with.
	const double sums = p[3][3] == 0.0 ? 0.0 : 4.0 * kUnitRoundoff * std::fabs(above / near);
	block.depth_step = static_cast<float>(half_step * scale / std::fabs(det) + sums);
	block.depth_share =
		static_cast<float>(6.0 * kUnitRoundoff); // of the value, two coefficients, a product, the sum and the quotient
}

void fillMeasuredError(ShadeBlock& block, std::span<const float> depths, std::span<const float> depth_error_m)
{
	assert(depth_error_m.size() == depths.size());
	double steps = 0.0;  // of w squared
	double shares = 0.0; // of the depth
	double slope = 0.0;  // sums over the pixels, to choose
	double square = 0.0;
	for (std::size_t i = 0; i < depths.size(); ++i)
	{
		const auto depth = static_cast<double>(depths[i]);
		if (std::isfinite(depth))
		{
			const auto error = static_cast<double>(depth_error_m[i]);
			const double w = static_cast<double>(block.w_slope) * depth + static_cast<double>(block.w_start);
			steps = std::max(steps, (error - 2.0 * kUnitRoundoff * depth) / (w * w));
			shares = std::max(shares, error / depth);
			slope += depth;
			square += w * w;
		}
	}
	const bool floats = shares * slope < steps * square + 2.0 * kUnitRoundoff * slope;
	block.depth_step = static_cast<float>(floats ? 0.0 : steps);
	block.depth_share = static_cast<float>(floats ? std::max(shares, kUnitRoundoff) : 2.0 * kUnitRoundoff);
}

double normalError(int bits)
{
	assert(bits >= 8 && bits <= 32);
	return bits == 32 ? 0.0 : std::sqrt(3.0) / (std::ldexp(1.0, bits) - 1.0); // half a step of each of three components
}

} // namespace nook
