// SPDX-License-Identifier: GPL-3.0-or-later
// Samples and settings of methods that are quick to make.
#pragma once

#include "picture_errors.h"

#include "methods/block.h"
#include "methods/kernels.h"
#include "pattern/recipe.h"
#include "shade/shade.h"

namespace nook::test
{

inline ShadeSamples samplesFor(ShadeMethod method, int count)
{
	Recipe recipe{.domain = domainOf(method), .count = count, .starts = 2};
	return samplesOf(method, {generatePattern(recipe)});
}

inline std::vector<float> visibilityOf(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings)
{
	return shadeOnCpu(gbuffer, samples, settings, {2, {}}).visibility;
}

inline ShadeSettings settingsFor(ShadeMethod method, double radius_m = 0.5)
{
	ShadeSettings settings;
	settings.method = method;
	settings.radius_m = radius_m;
	return settings;
}

// Of a method without a pattern.
inline std::vector<float> visibilityOf(const GBuffer& gbuffer, const ShadeSettings& settings)
{
	return visibilityOf(gbuffer, ownSamples(settings), settings);
}

// To evaluate single pixels; samples are left to the caller.
inline shade_kernels::Kernels kernelsOver(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings)
{
	shade_kernels::Kernels kernels;
	kernels.nook = blockOf(frameOf(gbuffer), samples, settings);
	kernels.depths = gbuffer.depth;
	kernels.normals = gbuffer.normals;
	return kernels;
}

inline void checkOnGl(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, double most_off = 1e-3)
{
	const Shaded gl = shadeOnGl(gbuffer, samples, settings);
	INFO(nameOf(settings.method) << " by " << gl.renderer);
	CHECK(gl.renderer.find("OpenGL") != std::string::npos);
	const Shaded cpu = shadeOnCpu(gbuffer, samples, settings, {2, {}});
	CHECK((settings.method == ShadeMethod::statvo || cpu.passes.size() == gl.passes.size())); // tables are made in several ways
	checkSamePicture(cpu.visibility, gl.visibility, most_off);
}

inline ShadeSettings statVo(int layers, int cell_px = 1, bool quadrants = false)
{
	ShadeSettings settings;
	settings.method = ShadeMethod::statvo;
	settings.statvo.layers = layers;
	settings.statvo.cell_px = cell_px;
	settings.statvo.quadrants = quadrants;
	return settings;
}

} // namespace nook::test
