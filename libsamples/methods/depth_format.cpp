// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/depth_format.h"

#include "core/error.h"
#include "core/round.h"
#include "methods/block.h"
#include "methods/kernels.h"
#include "methods/runtime/nook_block.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
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
	double numbers[16];
	std::copy_n(glm::value_ptr(p), 16, numbers);
	nook_depth_numbers depth;
	if (!nook_depth_of(depth, numbers, format.clip == ClipRange::zero_to_one, format.bits))
	{
		throw Error(ExitCode::invalid_input,
					"projection: found a z that does not depend on depth, expected another with device depth");
	}
	block.depth = glm::vec4(glm::make_vec4(depth.terms));
	block.far_end = static_cast<float>(depth.far_end);
	block.depth_step = static_cast<float>(depth.half_step);
	block.depth_share = static_cast<float>(depth.rounding);
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
	return nook_normal_error(bits);
}

} // namespace nook
