// SPDX-License-Identifier: GPL-3.0-or-later
// Debug views: expected values for planes, steps and bands, consistency with other outputs, and the CPU compared with OpenGL.
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "pattern/tile.h"

namespace
{

constexpr std::array kLookedAt{ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::vo_area,    ShadeMethod::alchemy,
							   ShadeMethod::statvo,  ShadeMethod::crytek,   ShadeMethod::volumetric, ShadeMethod::hbao,
							   ShadeMethod::sao,     ShadeMethod::gtao,     ShadeMethod::bitmask};
constexpr std::array kViews{DebugView::edges, DebugView::lod, DebugView::layers, DebugView::samples, DebugView::noise};

std::vector<Pattern> variantsFor(ShadeMethod method, int count)
{
	Recipe recipe;
	recipe.domain = domainOf(method);
	recipe.count = count;
	recipe.starts = 2;
	recipe.order = Order::progressive;
	TileRecipe tile{.size = 2, .kind = TileKind::random};
	return generateTile(generatePattern(recipe), tile, {}).variants;
}

ShadeSamples samplesFor(const ShadeSettings& settings, int count = 6)
{
	return takesPattern(settings.method) ? samplesOf(settings.method, variantsFor(settings.method, count)) : ownSamples(settings);
}

ShadeSettings debugOf(ShadeMethod method, DebugView view, double radius_m)
{
	ShadeSettings settings = settingsFor(method, radius_m);
	settings.depth_levels = method == ShadeMethod::alchemy ? 5 : 0;
	settings.debug = view;
	return settings;
}

} // namespace

TEST_CASE("shade debug: edges are the pixels on both sides of a step, a fold or the sky, and none on planes", "[shade]")
{
	for (const double tilt : {0.0, 60.0, 80.0})
	{
		const GBuffer gbuffer = planeAt(projectionOf(lensOf(tilt == 60.0 ? 30.0 : 0.0), 1.0), 32, 32, tilt);
		const ShadeSettings settings = debugOf(ShadeMethod::vo_line, DebugView::edges, 0.5);
		const std::vector<float> edges = visibilityOf(gbuffer, samplesFor(settings), settings);
		CAPTURE(tilt);
		for (std::size_t i = 0; i < edges.size(); ++i)
		{
			const bool sky = !std::isfinite(gbuffer.depth[i]);
			REQUIRE(edges[i] == (sky ? 0.0F : edges[i]));
			const auto open = [&](std::size_t there)
			{
				return !std::isfinite(gbuffer.depth[there]);
			};
			const bool beside = (i % 32 > 0 && open(i - 1)) || (i % 32 < 31 && open(i + 1)) || (i >= 32 && open(i - 32)) ||
								(i < 31 * 32 && open(i + 32));
			REQUIRE(edges[i] == (!sky && beside ? 1.0F : 0.0F));
		}
	}
	GBuffer fold = stepOf(16, 0.0);
	GBuffer sky = fold;
	for (std::size_t i = 0; i < fold.depth.size(); ++i)
	{
		if (i % 16 >= 8) // a floor that rises to the right with slope 4/3
		{
			fold.normals[i] = glm::vec3(-0.8F, 0.0F, 0.6F);
			fold.depth[i] -= 0.375F * (static_cast<float>(i % 16) - 7.5F) * 4.0F / 3.0F;
		}
		sky.depth[i] = i % 16 < 8 ? sky.depth[i] : std::numeric_limits<float>::infinity();
	}
	for (const GBuffer& gbuffer : {stepOf(16, 0.2), stepOf(16, -3.0), fold, sky})
	{
		for (const bool half : {false, true})
		{
			ShadeSettings settings = debugOf(ShadeMethod::alchemy, DebugView::edges, 0.5);
			settings.half_resolution = half;
			const std::vector<float> edges = visibilityOf(gbuffer, samplesFor(settings), settings);
			const std::size_t side = half ? 2 : 1;
			for (std::size_t i = 0; i < edges.size(); ++i)
			{
				const std::size_t x = i % 16;
				const bool edge = x >= 8 - side && x < 8 + side && std::isfinite(gbuffer.depth[i]);
				CAPTURE(half, x);
				REQUIRE(edges[i] == (edge ? 1.0F : 0.0F));
			}
		}
	}
	CHECK(visibilityOf(stepOf(16, 0.02), samplesFor(debugOf(ShadeMethod::vo_line, DebugView::edges, 0.5)),
					   debugOf(ShadeMethod::vo_line, DebugView::edges, 0.5)) == std::vector<float>(256, 0.0F));
}

TEST_CASE("shade debug: samples are the band's, and the picture hangs on no other", "[shade]")
{
	const GBuffer gbuffer = stepOf(16, 0.4);
	for (const ShadeMethod method : {ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::vo_area, ShadeMethod::alchemy})
	{
		for (const double radius_px : {0.4, 2.5, 5.0, 7.5})
		{
			ShadeSettings settings = debugOf(method, DebugView::samples, 0.375 * radius_px);
			settings.bands = {3, 3.0, 6.0};
			const ShadeSamples samples = samplesFor(settings);
			const bool none = radius_px < 0.5 && method != ShadeMethod::alchemy;
			const int taken = none ? 0 : radius_px < 3.0 ? 2 : radius_px < 6.0 ? 4 : 6;
			CAPTURE(static_cast<int>(method), radius_px);
			for (const float share : visibilityOf(gbuffer, samples, settings))
			{
				REQUIRE(share == Approx(taken / 6.0).margin(1e-6));
			}
			settings.debug.reset();
			settings.beta = 0.0;
			const std::vector<float> visibility = visibilityOf(gbuffer, samples, settings);
			// An infinite weight spoils every pixel that uses the sample.
			const auto spoilt = [&](int first)
			{
				ShadeSamples others = samples;
				for (std::size_t i = 0; i < others.samples.size(); ++i)
				{
					const bool changed = static_cast<int>(i % 6) >= first;
					others.samples[i].w = changed ? std::numeric_limits<float>::infinity() : others.samples[i].w;
				}
				return visibilityOf(gbuffer, others, settings) != visibility;
			};
			CHECK_FALSE(spoilt(taken));
			CHECK((taken == 0 || spoilt(taken - 1)));
		}
	}
	ShadeSettings hbao = debugOf(ShadeMethod::hbao, DebugView::samples, 0.375 * 3.5);
	CHECK(visibilityOf(gbuffer, samplesFor(hbao), hbao) == std::vector<float>(256, 0.5F)); // 3 of 6 steps: one per pixel
	ShadeSettings sao = debugOf(ShadeMethod::sao, DebugView::samples, 1.0);
	CHECK(visibilityOf(gbuffer, samplesFor(sao), sao) == std::vector<float>(256, 1.0F));
}

TEST_CASE("shade debug: with two radii samples are the mean of both", "[shade]")
{
	ShadeSettings settings = debugOf(ShadeMethod::vo_line, DebugView::samples, 0.375 * 2.0);
	settings.volume.radii = TwoRadii::minimum;
	settings.volume.second_radius_m = 0.375 * 7.0;
	settings.bands = {2, 3.0, 6.0};
	CHECK(visibilityOf(stepOf(16, 0.0), samplesFor(settings), settings) == std::vector<float>(256, 0.75F));
}

TEST_CASE("shade debug: levels are those of the samples' distances", "[shade]")
{
	// Half a metre per pixel; with a radius of 96 pixels, rings at a third and at the full radius are 32 and 96 pixels away.
	GBuffer gbuffer = planeAt(projectionOf(lensOf(0.0), 1.0), 256, 256, 0.0);
	ShadeSettings settings = debugOf(ShadeMethod::alchemy, DebugView::lod, 96.0 * 6.0 / 256.0);
	ShadeSamples samples{1, 2, {{0.34F, 0.0F, 0.0F, 0.5F}, {0.0F, 0.99F, 0.0F, 0.5F}}};
	CHECK(visibilityOf(gbuffer, samples, settings)[128 * 256 + 128] == Approx((2.0 + 3.0) / 2.0 / 5.0));
	settings.depth_levels = 2;
	CHECK(visibilityOf(gbuffer, samples, settings)[128 * 256 + 128] == 1.0F);
	settings.radius_m /= 8.0;
	CHECK(visibilityOf(gbuffer, samples, settings)[128 * 256 + 128] == 0.0F);

	// Areas: one texel of 2^l pixels if the area's side is between 2^l / 0.6 and 2^(l + 1) / 0.6.
	settings = debugOf(ShadeMethod::vo_area, DebugView::lod, 96.0 * 6.0 / 256.0);
	for (const int level : {0, 1, 3, 6})
	{
		const double side_px = 2.4 * (1 << level); // times 2^0.75 = 1.68: 1.43 of a texel
		samples = {1, 1, {glm::vec4(0.0F, 0.0F, static_cast<float>(std::log2(side_px / 96.0)), 1.0F)}};
		CHECK(visibilityOf(gbuffer, samples, settings)[128 * 256 + 128] == Approx(level / 6.0));
	}
	settings = debugOf(ShadeMethod::sao, DebugView::lod, 8.0 * 6.0 / 256.0);
	CHECK(visibilityOf(gbuffer, samplesFor(settings), settings) == std::vector<float>(256 * 256, 0.0F));
}

TEST_CASE("shade debug: layers are those of the tiles and depths that need them", "[shade]")
{
	GBuffer gbuffer = planeAt(projectionOf(lensOf(0.0), 1.0), 64, 64, 0.0);
	for (std::size_t i = 0; i < gbuffer.depth.size(); ++i)
	{
		gbuffer.depth[i] += i % 64 >= 48 ? 8.0F : 0.0F;
		gbuffer.depth[i] = i < 64 ? std::numeric_limits<float>::infinity() : gbuffer.depth[i];
	}
	ShadeSettings settings = debugOf(ShadeMethod::statvo, DebugView::layers, 0.6);
	const auto layersAt = [&](std::size_t x, std::size_t y)
	{
		return visibilityOf(gbuffer, samplesFor(settings), settings)[y * 64 + x];
	};
	CHECK(layersAt(10, 40) == 0.25F); // smooth: all as one layer
	CHECK(layersAt(47, 40) == 1.0F);
	CHECK(layersAt(49, 40) == 1.0F);
	CHECK(layersAt(10, 0) == 0.0F); // sky
	settings.statvo.skip = false;
	CHECK(layersAt(10, 40) == 1.0F);
	settings.statvo.layers = 1;
	CHECK(layersAt(47, 40) == 1.0F);
	settings.statvo.layering = StatVoLayering::uniform; // 8 m in 16 layers: half a metre each, starting at 5 m
	settings.statvo.layers = 16;
	CHECK(layersAt(10, 40) == Approx(2.0 / 16.0)); // the box ends at 5.6 m
	CHECK(layersAt(60, 40) == Approx(4.0 / 16.0)); // from 11.2 m to the last
}

TEST_CASE("shade debug: noise is the deviation of the variants' pictures, and 0 on a plane with the normal", "[shade]")
{
	const GBuffer gbuffer = builtinView("cornell", 48, 27);
	for (const ShadeMethod method : {ShadeMethod::vo_line, ShadeMethod::vo_area, ShadeMethod::alchemy, ShadeMethod::crytek})
	{
		ShadeSettings settings = debugOf(method, DebugView::noise, 0.5);
		const int count = method == ShadeMethod::crytek ? 8 : 6;
		const std::vector<Pattern> variants = variantsFor(method, count);
		const std::vector<float> noise = visibilityOf(gbuffer, samplesOf(method, variants), settings);
		settings.debug.reset();
		const std::vector<std::vector<float>> pictures =
			mapped(variants, [&](const Pattern& variant) { return visibilityOf(gbuffer, samplesOf(method, {variant}), settings); });
		double most = 0.0;
		for (std::size_t i = 0; i < noise.size(); ++i)
		{
			double mean = 0.0;
			double squares = 0.0;
			for (const std::vector<float>& picture : pictures)
			{
				mean += static_cast<double>(picture[i]) / 4.0;
				squares += static_cast<double>(picture[i]) * static_cast<double>(picture[i]) / 4.0;
			}
			const double deviation = std::sqrt(std::max(squares - mean * mean, 0.0));
			REQUIRE(static_cast<double>(noise[i]) == Approx(deviation).margin(2e-4));
			most = std::max(most, deviation);
		}
		CHECK(most > 0.05);
	}
	const GBuffer wall = planeAt(projectionOf(lensOf(60.0), 1.0), 24, 24, 50.0);
	for (const ShadeMethod method : {ShadeMethod::vo_line, ShadeMethod::vo_point})
	{
		const ShadeSettings settings = debugOf(method, DebugView::noise, 1.0);
		for (const float value : visibilityOf(wall, samplesFor(settings), settings))
		{
			REQUIRE(value <= 1e-3F);
		}
	}
}

TEST_CASE("shade debug: OpenGL agrees with the CPU on every view of every method", "[shade]")
{
	const GBuffer gbuffer = builtinView("courtyard", 61, 33);
	for (const ShadeMethod method : kLookedAt)
	{
		for (const DebugView view : kViews)
		{
			ShadeSettings settings = debugOf(method, view, 1.0);
			settings.half_resolution = view == DebugView::noise || view == DebugView::edges;
			settings.bands.count = takesPattern(method) ? 2 : 1;
			if (!debugShows(view, settings))
			{
				continue;
			}
			const ShadeSamples samples = samplesFor(settings, method == ShadeMethod::crytek ? 8 : 6);
			const std::vector<float> cpu = visibilityOf(gbuffer, samples, settings);
			REQUIRE(cpu.size() == gbuffer.depth.size());
			for (std::size_t i = 0; i < cpu.size(); ++i)
			{
				REQUIRE((cpu[i] >= 0.0F && cpu[i] <= 1.0F));
				REQUIRE((std::isfinite(gbuffer.depth[i]) || settings.half_resolution || cpu[i] == 0.0F));
			}
			CAPTURE(static_cast<int>(method), static_cast<int>(view));
			// Noise compares up to sixteen pictures, and a GPU's sines put a few of their samples into the next pixel.
			checkOnGl(gbuffer, samples, settings, view == DebugView::noise ? 4e-3 : 1e-3);
		}
	}
}
