// SPDX-License-Identifier: GPL-3.0-or-later
// Coarser depth levels for distant samples.
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "methods/passes.h"

namespace
{

ShadeSamples manyOf(ShadeMethod method, int count)
{
	Recipe recipe{.domain = domainOf(method), .count = count, .method = Method::vogel};
	return samplesOf(method, {generatePattern(recipe)});
}

ShadeSettings alchemyOf(double radius_m, int levels)
{
	ShadeSettings settings = settingsFor(ShadeMethod::alchemy, radius_m);
	settings.depth_levels = levels;
	return settings;
}

} // namespace

TEST_CASE("shade levels: an open plane reads 1 without a bias, however coarse its depths", "[shade]")
{
	ShadeSettings settings = alchemyOf(4.0, 5);
	settings.beta = 0.0;
	checkOpen(visibilityOf(eachPlane(130, 73), manyOf(settings.method, 12), settings));
}

TEST_CASE("shade levels: a pixel's depth at any level is that of the pixel that it is said to be of", "[shade]")
{
	const GBuffer gbuffer = builtinView("courtyard", 53, 37);
	const ShadeSettings settings = GENERATE(alchemyOf(1.0, 5), settingsFor(ShadeMethod::sao, 1.0));
	const ShadeSamples samples = takesPattern(settings.method) ? manyOf(settings.method, 4) : ownSamples(settings);
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings);
	REQUIRE(plan.pictures[0].levels == 5);
	const glm::ivec4 rect = GENERATE(glm::ivec4(0, 0, 52, 36), glm::ivec4(5, 3, 50, 36), glm::ivec4(17, 17, 19, 19));
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
		std::size_t corners = 0; // pixels that stand for themselves: not always the upper left ones
		for (int y = rect.y; y <= rect.w; ++y)
		{
			for (int x = rect.x; x <= rect.z; ++x)
			{
				const glm::ivec2 of = kernels.nookPixelAt({x, y}, level);
				REQUIRE((of.x >= rect.x && of.y >= rect.y && of.x <= rect.z && of.y <= rect.w));
				REQUIRE(kernels.nookDepthAt({x, y}, level) == depths[static_cast<std::size_t>(of.y * 53 + of.x)]);
				REQUIRE((of.x >> level == x >> level || x >> level >= plane.width || of.x == rect.x));
				corners += of == glm::ivec2(x >> level << level, y >> level << level) ? 1U : 0U;
			}
		}
		CHECK((level > 3 || corners < gbuffer.depth.size()));
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
	const auto name = GENERATE(as<std::string>{}, "courtyard", "suburb", "nulls");
	INFO(name);
	checkOnGl(builtinView(name, 131, 77), manyOf(ShadeMethod::alchemy, 12), alchemyOf(2.0, 4));
}
