// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/parallel.h"
#include "methods/block.h"
#include "methods/kernels.h"
#include "methods/passes.h"
#include "shade/cpu_passes.h"
#include "shade/pass_times.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

namespace nook
{

ShadeFrame frameOf(const GBuffer& gbuffer)
{
	assert(gbuffer.normals.size() == gbuffer.depth.size());
	return {gbuffer.width_px, gbuffer.height_px, gbuffer.view.projection, gbuffer.depth, gbuffer.depth_error_m};
}

std::vector<float> finiteDepths(const GBuffer& gbuffer)
{
	std::vector<float> depths = gbuffer.depth;
	for (float& depth : depths)
	{
		depth = std::isfinite(depth) ? depth : NOOK_SKY;
	}
	return depths;
}

Shaded shadeOnCpu(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, const RunSettings& run,
				  const DrawSettings& drawing)
{
	const std::vector<float> depths = finiteDepths(gbuffer);
	shade_kernels::Kernels inputs;
	inputs.depths = depths;
	inputs.normals = gbuffer.normals;
	inputs.samples = samples.samples;
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings, settings.statvo.builder != TableBuilder::fragments);
	std::vector<Planes> pictures = picturesFor(plan);
	PassTimes times(plan);
	for (int repetition = 0; repetition < times.drawings(drawing); ++repetition)
	{
		for (std::size_t i = 0; i < plan.passes.size(); ++i)
		{
			const auto start = std::chrono::steady_clock::now();
			runPass(plan.passes[i], inputs, pictures, run);
			times.add(i, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
		}
	}
	Shaded shaded;
	shaded.renderer = "CPU";
	shaded.tables_by = settings.statvo.builder == TableBuilder::fragments ? "fragments" : "scans";
	PicturePlane& last = pictures[plan.passes.back().picture][0];
	setResult(shaded, std::move(last.values), last.channels == 4);
	times.finish(shaded);
	return shaded;
}

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
