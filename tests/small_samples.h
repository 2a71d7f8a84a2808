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

// For a method without a pattern.
inline std::vector<float> visibilityOf(const GBuffer& gbuffer, const ShadeSettings& settings)
{
	return visibilityOf(gbuffer, ownSamples(settings), settings);
}

// Kernels that evaluate single pixels; the caller passes samples.
inline shade_kernels::Kernels kernelsOver(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings)
{
	shade_kernels::Kernels kernels;
	kernels.nook = blockOf(frameOf(gbuffer), samples, settings);
	kernels.depths = gbuffer.depth;
	kernels.normals = gbuffer.normals;
	return kernels;
}

// Likewise, where the picture is a rectangle, from `at`, of a texture that is otherwise NaN.
struct InTexture
{
	std::vector<float> depths;
	std::vector<glm::vec3> normals;
	shade_kernels::Kernels kernels;

	InTexture(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, glm::ivec2 at)
	{
		const int stride = at.x + gbuffer.width_px + 11;
		const auto size = static_cast<std::size_t>(stride * (at.y + gbuffer.height_px + 7));
		depths.assign(size, std::numeric_limits<float>::quiet_NaN());
		normals.assign(size, glm::vec3(std::numeric_limits<float>::quiet_NaN()));
		const std::vector<float> picture = finiteDepths(gbuffer);
		for (int i = 0; i < gbuffer.width_px * gbuffer.height_px; ++i)
		{
			const auto to = static_cast<std::size_t>((at.y + i / gbuffer.width_px) * stride + at.x + i % gbuffer.width_px);
			depths[to] = picture[static_cast<std::size_t>(i)];
			normals[to] = gbuffer.normals[static_cast<std::size_t>(i)];
		}
		kernels.nook = blockOf(frameOf(gbuffer), samples, settings);
		kernels.nook.origin = at;
		kernels.nook.first = at;
		kernels.nook.last = at + glm::ivec2(gbuffer.width_px - 1, gbuffer.height_px - 1);
		kernels.depths = depths;
		kernels.normals = normals;
		kernels.samples = samples.samples;
		kernels.stride = stride;
	}
	InTexture& operator=(InTexture&&) = delete;
};

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
