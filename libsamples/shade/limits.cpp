// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/block.h"
#include "methods/kernels.h"
#include "shade/shade.h"

#include <cmath>

namespace nook
{

LimitedRadii limitedRadii(const GBuffer& gbuffer, const ShadeSettings& settings)
{
	shade_kernels::Kernels kernels;
	kernels.nook = blockOf(frameOf(gbuffer), {1, 1, {glm::vec4(0.0F)}}, settings);
	const float radius = kernels.nook.radius;
	LimitedRadii limited;
	for (const float depth : gbuffer.depth)
	{
		if (std::isfinite(depth))
		{
			const float used = kernels.nookRadius(radius, depth);
			limited.near += used < radius ? 1U : 0U;
			limited.far += used > radius ? 1U : 0U;
		}
	}
	return limited;
}

} // namespace nook
