// SPDX-License-Identifier: GPL-3.0-or-later
// Area samples if the picture is a rectangle of a larger texture.
#include "small_views.h"
#include "testing.h"

#include "methods/block.h"
#include "methods/kernels.h"
#include "pattern/recipe.h"
#include "shade/shade.h"

namespace
{

// Areas for a picture at (x0, y0) in a texture that is otherwise NaN.
std::vector<float> areasInTexture(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, int x0,
								  int y0)
{
	const int width = gbuffer.width_px;
	const int height = gbuffer.height_px;
	const int stride = x0 + width + 11;
	const std::vector<float> picture = finiteDepths(gbuffer);
	const auto size = static_cast<std::size_t>(stride * (y0 + height + 7));
	std::vector<float> depths(size, std::numeric_limits<float>::quiet_NaN());
	std::vector<glm::vec3> normals(size, glm::vec3(std::numeric_limits<float>::quiet_NaN()));
	for (int i = 0; i < width * height; ++i)
	{
		const auto to = static_cast<std::size_t>((y0 + i / width) * stride + x0 + i % width);
		depths[to] = picture[static_cast<std::size_t>(i)];
		normals[to] = gbuffer.normals[static_cast<std::size_t>(i)];
	}
	std::vector<PicturePlane> levels(kMomentLevels);
	shade_kernels::Kernels kernels;
	kernels.nook = blockOf(frameOf(gbuffer), samples, settings);
	kernels.nook.origin = glm::vec2(x0, y0);
	kernels.nook.first = {x0, y0};
	kernels.nook.last = {x0 + width - 1, y0 + height - 1};
	kernels.depths = depths;
	kernels.normals = normals;
	kernels.samples = samples.samples;
	kernels.stride = stride;
	for (int level = 0; level < kMomentLevels; ++level)
	{
		PicturePlane& plane = levels[static_cast<std::size_t>(level)];
		plane.width = (x0 + width + 63) / 64 * 32 >> level;
		plane.height = (y0 + height + 63) / 64 * 32 >> level;
		plane.channels = 4;
		plane.values.resize(plane.index(0, plane.height));
		kernels.levels = levels;
		kernels.nook.level = level;
		for (int i = 0; i < plane.width * plane.height; ++i)
		{
			const glm::vec4 texel = kernels.nookMoments({i % plane.width, i / plane.width});
			std::copy_n(&texel.x, 4, &plane.values[static_cast<std::size_t>(i) * 4]);
		}
	}
	std::vector<float> found;
	for (int i = 0; i < width * height; ++i)
	{
		found.push_back(kernels.nookVoArea({x0 + i % width, y0 + i / width}));
	}
	return found;
}

} // namespace

TEST_CASE("shade: areas in a rectangle of a texture are those of the picture alone, and planes stay planes", "[shade]")
{
	ShadeSettings settings;
	settings.method = ShadeMethod::vo_area;
	settings.radius_m = 1.0;
	Recipe recipe{.domain = Domain::disk, .count = 5, .starts = 2};
	const ShadeSamples samples = samplesOf(settings.method, {generatePattern(recipe)});
	const GBuffer courtyard = builtinView("courtyard", 90, 70);
	// Shifted by texels of the last level: bit-identical.
	CHECK(areasInTexture(courtyard, samples, settings, 64, 128) == shadeOnCpu(courtyard, samples, settings, {2, {}}).visibility);
	const GBuffer plane = planeAt(projectionOf(lensOf(60.0), 90.0 / 70.0), 90, 70, 40.0);
	const glm::ivec2 at = GENERATE(glm::ivec2(5, 3), glm::ivec2(30, 61));
	const std::vector<float> found = areasInTexture(plane, samples, settings, at.x, at.y);
	CHECK(*std::min_element(found.begin(), found.end()) >= 0.999F);
}
