// SPDX-License-Identifier: GPL-3.0-or-later
// The pictures that the passes of a plan make on the way, for those who look at them.
#pragma once

#include "shade/cpu_passes.h"
#include "shade/shade.h"

#include <string>
#include <vector>

namespace nook::stress
{

// Runs the passes up to the first whose name is `end`, on one thread; without one of that name, all.
inline std::vector<Planes> picturesOf(const GBuffer& gbuffer, const ShadeSettings& settings, const std::string& end)
{
	const ShadeSamples samples = ownSamples(settings);
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings, settings.statvo.builder != TableBuilder::fragments);
	const std::vector<float> depths = finiteDepths(gbuffer);
	shade_kernels::Kernels inputs;
	inputs.depths = depths;
	inputs.normals = gbuffer.normals;
	inputs.samples = samples.samples;
	std::vector<Planes> pictures = picturesFor(plan);
	for (const ShadePass& pass : plan.passes)
	{
		if (pass.kernel.name == end)
		{
			break;
		}
		runPass(pass, inputs, pictures, {1, {}});
	}
	return pictures;
}

} // namespace nook::stress
