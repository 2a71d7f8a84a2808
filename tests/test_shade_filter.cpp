// SPDX-License-Identifier: GPL-3.0-or-later
// Filters and half resolution: what they must preserve, what they must remove, and the CPU compared with OpenGL.
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "methods/passes.h"
#include "pattern/tile.h"
#include "shade/run_passes.h"

namespace
{

PatternTile nineLines(TileKind kind)
{
	Recipe recipe{.domain = Domain::disk, .count = 9};
	TileRecipe tile{.kind = kind};
	return generateTile(generatePattern(recipe), tile, {2, {}});
}

ShadeSamples linesOf(TileKind kind)
{
	return samplesOf(ShadeMethod::vo_line, nineLines(kind).variants);
}

struct Rebuilding
{
	ShadeFilter filter;
	int taps;
	bool half;
};
constexpr std::array<Rebuilding, 7> kRebuildings{{{ShadeFilter::none, 13, true},
												  {ShadeFilter::bilateral, 5, false},
												  {ShadeFilter::bilateral, 13, false},
												  {ShadeFilter::bilateral, 13, true},
												  {ShadeFilter::bilateral, 7, true},
												  {ShadeFilter::window, 13, false},
												  {ShadeFilter::window, 13, true}}};

ShadeSettings settingsOf(const Rebuilding& rebuilding, double radius_m)
{
	ShadeSettings settings;
	settings.radius_m = radius_m;
	settings.filter = rebuilding.filter;
	settings.filter_taps = rebuilding.taps;
	settings.half_resolution = rebuilding.half;
	return settings;
}

// Runs the passes after the method, with visibility from `of` for every pixel.
template <class Of> std::vector<float> rebuilt(const GBuffer& gbuffer, const ShadeSettings& settings, Of of)
{
	ShadeSamples samples;
	samples.size = 4;
	samples.count = 1;
	const std::vector<float> depths = finiteDepths(gbuffer);
	shade_kernels::Kernels kernels;
	kernels.depths = depths;
	kernels.normals = gbuffer.normals;
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings, false);
	std::vector<Planes> pictures = picturesFor(plan);
	for (const ShadePass& pass : plan.passes)
	{
		if (!pass.of_pixel && !pass.fills)
		{
			runPass(pass, kernels, pictures, {1, {}});
			continue;
		}
		kernels.nook = pass.block;
		PicturePlane& plane = pictures[pass.picture].front();
		for (int y = 0; y < plane.height; ++y)
		{
			for (int x = 0; x < plane.width; ++x)
			{
				const glm::ivec2 at(x, y);
				const std::size_t i = plane.index(x, y);
				const float value = of(kernels.nookPixel(at));
				const glm::vec4 packed = pass.packing == ShadePacking::links     ? kernels.nookLinked(at, value)
										 : pass.packing == ShadePacking::surface ? kernels.nookOfSurface(at, value)
																				 : glm::vec4(value);
				if (!pass.fills || plane.values[i] < 0.0F)
				{
					std::copy_n(&packed.x, plane.channels, plane.values.begin() + static_cast<std::ptrdiff_t>(i));
				}
			}
		}
	}
	return pictures[plan.passes.back().picture].front().values;
}

} // namespace

TEST_CASE("shade filter: a constant stays a constant, and sky stays open", "[shade]")
{
	const GBuffer gbuffer = builtinView("courtyard", 97, 55);
	const Rebuilding rebuilding = GENERATE(from_range(kRebuildings));
	const std::vector<float> v = rebuilt(gbuffer, settingsOf(rebuilding, 0.5), [](glm::ivec2) { return 0.375F; });
	for (std::size_t i = 0; i < v.size(); ++i)
	{

		REQUIRE(v[i] == Approx(std::isfinite(gbuffer.depth[i]) ? 0.375F : 1.0F).margin(1e-6));
	}
}

TEST_CASE("shade filter: an open plane stays 1 at any slope, field of view and projection", "[shade]")
{
	static const ShadeSamples samples = linesOf(TileKind::random);
	const Rebuilding rebuilding = GENERATE(from_range(kRebuildings));
	CAPTURE(static_cast<int>(rebuilding.filter), rebuilding.half);
	checkOpen(visibilityOf(eachPlane(64, 36), samples, settingsOf(rebuilding, 0.5)));
}

TEST_CASE("shade filter: a plane is one surface at any slope", "[shade]")
{
	// Visibility 0, 1/15 … 1 for the window's variants: on one surface every pixel of the filtered picture is their mean.
	const auto variant = [](glm::ivec2 pixel)
	{
		return static_cast<float>(pixel.y % 4 * 4 + pixel.x % 4) / 15.0F;
	};
	const double fov = GENERATE(0.0, 60.0);
	const double tilt = GENERATE(0.0, 60.0, 80.0);
	const GBuffer gbuffer = planeAt(projectionOf(lensOf(fov), 1.0), 64, 64, tilt);
	const std::vector<float> v = rebuilt(gbuffer, settingsOf({ShadeFilter::window, 13, false}, 0.1), variant);
	for (int y = 4; y < 60; ++y)
	{
		for (int x = 4; x < 60; ++x)
		{
			const auto seen = [&](int there_x, int there_y)
			{
				return std::isfinite(gbuffer.depth[static_cast<std::size_t>(there_y * 64 + there_x)]);
			};
			if (seen(x - 3, y - 3) && seen(x + 3, y - 3) && seen(x - 3, y + 3) && seen(x + 3, y + 3))
			{
				REQUIRE(v[static_cast<std::size_t>(y * 64 + x)] == Approx(0.5).margin(1e-5));
			}
		}
	}
}

TEST_CASE("shade filter: nothing bleeds over a step, a corner or into the sky", "[shade]")
{
	GBuffer corner = planeAt(projectionOf(lensOf(60.0), 1.0), 48, 48, 0.0);
	GBuffer open = corner;
	for (int y = 0; y < 48; ++y)
	{
		for (int x = 24; x < 48; ++x)
		{
			corner.normals[static_cast<std::size_t>(y * 48 + x)] = {-1.0F, 0.0F, 0.0F};
			open.depth[static_cast<std::size_t>(y * 48 + x)] = std::numeric_limits<float>::infinity();
		}
	}
	const auto sides = [](glm::ivec2 pixel)
	{
		return pixel.x < 24 ? 0.25F : 0.75F;
	};
	for (const GBuffer& gbuffer : {stepOf(48, 0.06), stepOf(48, 3.0), corner, open})
	{
		for (const Rebuilding& rebuilding : kRebuildings)
		{
			const std::vector<float> v = rebuilt(gbuffer, settingsOf(rebuilding, 0.5), sides);
			for (int i = 0; i < 48 * 48; ++i)
			{
				const auto pixel = static_cast<std::size_t>(i);
				const float side = std::isfinite(gbuffer.depth[pixel]) ? sides({i % 48, i / 48}) : 1.0F;
				CAPTURE(static_cast<int>(rebuilding.filter), rebuilding.half, i % 48);
				REQUIRE(v[pixel] == Approx(side).margin(1e-6));
			}
		}
	}
}

TEST_CASE("shade filter: the window shows the mean of the variants on a wall beside an occluder", "[shade]")
{
	const GBuffer gbuffer = stepOf(192, 0.4);
	const PatternTile tile = nineLines(TileKind::points);
	ShadeSettings settings = settingsOf({ShadeFilter::none, 13, false}, 1.0);
	std::vector<float> mean(gbuffer.depth.size());
	for (const Pattern& variant : tile.variants)
	{
		const Shaded one = shadeOnCpu(gbuffer, samplesOf(ShadeMethod::vo_line, {variant}), settings, {2, {}});
		for (std::size_t i = 0; i < mean.size(); ++i)
		{
			mean[i] += one.visibility[i] / 16.0F;
		}
	}
	const ShadeSamples samples = samplesOf(ShadeMethod::vo_line, tile.variants);
	const double noisy = rmseOf(visibilityOf(gbuffer, samples, settings), mean);
	settings.filter = ShadeFilter::window;
	const double filtered = rmseOf(visibilityOf(gbuffer, samples, settings), mean);
	CAPTURE(noisy, filtered);
	CHECK(filtered < 0.3 * noisy);
	CHECK(filtered < 0.01);
}

TEST_CASE("shade filter: OpenGL agrees with the CPU", "[shade]")
{
	static const ShadeSamples samples = linesOf(TileKind::random);
	const auto name = GENERATE(as<std::string>{}, "courtyard", "suburb", "nulls");
	const Rebuilding rebuilding = GENERATE(from_range(kRebuildings));
	CAPTURE(name, static_cast<int>(rebuilding.filter), rebuilding.half);
	checkOnGl(builtinView(name, 161, 91), samples, settingsOf(rebuilding, 0.7));
}

TEST_CASE("shade filter: half resolution agrees with full", "[shade]")
{
	// Same filter. The remaining differences are details of a pixel or two, which a window of twice as many pixels blurs at this
	// size.
	const ShadeSamples samples = linesOf(TileKind::points);
	const auto difference = [&](const std::string& name, ShadeFilter filter, int width, int height)
	{
		const GBuffer gbuffer = builtinView(name, width, height);
		const auto visibility = [&](bool half)
		{
			return visibilityOf(gbuffer, samples, settingsOf({filter, 5, half}, 1.0));
		};
		return rmseOf(visibility(false), visibility(true));
	};
	CHECK(difference("courtyard", ShadeFilter::window, 320, 180) < 0.038);
	CHECK(difference("courtyard", ShadeFilter::bilateral, 320, 180) < 0.0375);
	CHECK(difference("cornell", ShadeFilter::window, 320, 180) < 0.018);
	CHECK(difference("cornell", ShadeFilter::bilateral, 320, 180) < 0.016);
}

TEST_CASE("shade filter: on the method's own terms an optimised tile leaves less noise than random reflections", "[shade]")
{
	// Compared with very many samples. In smaller pictures the blur is worse than the error of nine lines.
	const GBuffer gbuffer = builtinView("cornell", 960, 540);
	Recipe recipe{.domain = Domain::disk, .count = 400, .method = Method::vogel};
	const auto with = [&](const ShadeSamples& samples, ShadeFilter filter)
	{
		return visibilityOf(gbuffer, samples, settingsOf({filter, 13, false}, 1.0));
	};
	const std::vector<float> truth = with(samplesOf(ShadeMethod::vo_line, {generatePattern(recipe)}), ShadeFilter::none);
	const ShadeSamples tile = linesOf(TileKind::points);
	const ShadeSamples random = linesOf(TileKind::random);
	const double noisy = rmseOf(with(random, ShadeFilter::none), truth);
	const double filtered = rmseOf(with(random, ShadeFilter::window), truth);
	const double best = rmseOf(with(tile, ShadeFilter::window), truth);
	CAPTURE(noisy, filtered, best);
	CHECK(filtered < 0.6 * noisy);
	CHECK(best < 0.6 * filtered);
}
