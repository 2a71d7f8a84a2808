// SPDX-License-Identifier: GPL-3.0-or-later
// Area samples if the picture is a rectangle of a larger texture.
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

namespace
{

// Areas for a picture at (x0, y0) in a texture that is otherwise NaN.
std::vector<float> areasInTexture(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, int x0,
								  int y0)
{
	const int width = gbuffer.width_px;
	const int height = gbuffer.height_px;
	InTexture texture(gbuffer, samples, settings, {x0, y0});
	shade_kernels::Kernels& kernels = texture.kernels;
	std::vector<PicturePlane> levels(kMomentLevels);
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
	const ShadeSettings settings = settingsFor(ShadeMethod::vo_area, 1.0);
	const ShadeSamples samples = samplesFor(settings.method, 5);
	const GBuffer courtyard = builtinView("courtyard", 90, 70);
	// Shifted by texels of the last level: bit-identical.
	CHECK(areasInTexture(courtyard, samples, settings, 64, 128) == shadeOnCpu(courtyard, samples, settings, {2, {}}).visibility);
	const GBuffer plane = planeAt(projectionOf(lensOf(60.0), 90.0 / 70.0), 90, 70, 40.0);
	const glm::ivec2 at = GENERATE(glm::ivec2(5, 3), glm::ivec2(30, 61));
	const std::vector<float> found = areasInTexture(plane, samples, settings, at.x, at.y);
	CHECK(*std::min_element(found.begin(), found.end()) >= 0.999F);
}
