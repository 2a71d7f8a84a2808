// SPDX-License-Identifier: GPL-3.0-or-later
// Coarser depth levels for distant samples.
#include "picture_errors.h"
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "methods/block.h"
#include "methods/passes.h"
#include "pattern/recipe.h"
#include "shade/shade.h"

namespace
{

ShadeSamples manyOf(ShadeMethod method, int count)
{
	Recipe recipe{.domain = domainOf(method), .count = count, .method = Method::vogel};
	return samplesOf(method, {generatePattern(recipe)});
}

ShadeSettings alchemyOf(double radius_m, int levels)
{
	ShadeSettings settings;
	settings.method = ShadeMethod::alchemy;
	settings.radius_m = radius_m;
	settings.depth_levels = levels;
	return settings;
}

} // namespace

TEST_CASE("shade levels: an open plane reads 1 without a bias, however coarse its depths", "[shade]")
{
	for (const double fov : {0.0, 30.0, 60.0, 100.0})
	{
		for (const double tilt : {0.0, 45.0, 80.0})
		{
			const GBuffer gbuffer = planeAt(projectionOf(lensOf(fov), 16.0 / 9.0), 130, 73, tilt);
			ShadeSettings settings = alchemyOf(4.0, 5);
			settings.beta = 0.0;
			CAPTURE(fov, tilt);
			for (const float v : visibilityOf(gbuffer, manyOf(settings.method, 12), settings))
			{
				REQUIRE(v == Approx(1.0).margin(1.0 / 255.0));
			}
		}
	}
}

TEST_CASE("shade levels: a pixel's depth at any level is that of the pixel that it is said to be of", "[shade]")
{
	const GBuffer gbuffer = builtinView("courtyard", 53, 37);
	const ShadeSettings settings = alchemyOf(1.0, 5);
	const ShadePlan plan = planOf(frameOf(gbuffer), manyOf(settings.method, 4), settings);
	for (const glm::ivec4 rect : {glm::ivec4(0, 0, 52, 36), glm::ivec4(5, 3, 50, 36), glm::ivec4(17, 17, 19, 19)})
	{
		const std::vector<float> depths = finiteDepths(gbuffer);
		shade_kernels::Kernels kernels;
		kernels.depths = depths;
		std::vector<PicturePlane> planes(5);
		for (int level = 1; level <= 5; ++level)
		{
			PicturePlane& plane = planes[static_cast<std::size_t>(level - 1)];
			plane.width = std::max(1, (rect.z + 1) >> level);
			plane.height = std::max(1, (rect.w + 1) >> level);
			plane.values.resize(plane.index(0, plane.height));
			kernels.levels = planes;
			kernels.nook = plan.passes[static_cast<std::size_t>(level - 1)].block;
			kernels.nook.first = {rect.x, rect.y};
			kernels.nook.last = {rect.z, rect.w};
			REQUIRE(kernels.nook.level == level - 1);
			for (int i = 0; i < plane.width * plane.height; ++i)
			{
				plane.values[static_cast<std::size_t>(i)] = kernels.nookCoarser({i % plane.width, i / plane.width});
			}
			for (int y = rect.y; y <= rect.w; ++y)
			{
				for (int x = rect.x; x <= rect.z; ++x)
				{
					const glm::ivec2 of = kernels.nookPixelAt({x, y}, level);
					REQUIRE((of.x >= rect.x && of.y >= rect.y && of.x <= rect.z && of.y <= rect.w));
					REQUIRE(kernels.nookDepthAt({x, y}, level) == depths[static_cast<std::size_t>(of.y * 53 + of.x)]);
					REQUIRE((of.x >> level == x >> level || x >> level >= plane.width || of.x == rect.x));
				}
			}
		}
	}
}

TEST_CASE("shade levels: used from sixteen pixels on, and then for little", "[shade]")
{
	const GBuffer gbuffer = builtinView("courtyard", 192, 108);
	const ShadeSamples samples = manyOf(ShadeMethod::alchemy, 16);
	ShadeSettings near = alchemyOf(1.0, 0);
	near.max_radius_px = 15.9;
	const std::vector<float> none = visibilityOf(gbuffer, samples, near);
	near.depth_levels = 5;
	CHECK(visibilityOf(gbuffer, samples, near) == none);
	const std::vector<float> fine = visibilityOf(gbuffer, samples, alchemyOf(2.0, 0));
	const double moved = rmseOf(visibilityOf(gbuffer, samples, alchemyOf(2.0, 5)), fine);
	CAPTURE(moved);
	CHECK(moved > 0.0);
	CHECK(moved < 0.02);
}

TEST_CASE("shade levels: OpenGL agrees with the CPU", "[shade]")
{
	const ShadeSamples samples = manyOf(ShadeMethod::alchemy, 12);
	for (const std::string name : {"courtyard", "suburb", "nulls"})
	{
		const GBuffer gbuffer = builtinView(name, 131, 77);
		const ShadeSettings settings = alchemyOf(2.0, 4);
		const Shaded cpu = shadeOnCpu(gbuffer, samples, settings, {2, {}});
		const Shaded gl = shadeOnGl(gbuffer, samples, settings);
		CAPTURE(name);
		checkSamePicture(cpu.visibility, gl.visibility);
	}
}
