// SPDX-License-Identifier: GPL-3.0-or-later
// Published methods: closed forms, results on open planes, and the CPU compared with OpenGL.
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "methods/passes.h"
#include "pattern/tile.h"

namespace
{

constexpr std::array kAll{ShadeMethod::vo_line, ShadeMethod::crytek, ShadeMethod::volumetric, ShadeMethod::hbao,
						  ShadeMethod::sao,     ShadeMethod::gtao,   ShadeMethod::bitmask};
constexpr std::array kPublished{ShadeMethod::crytek, ShadeMethod::volumetric, ShadeMethod::hbao,
								ShadeMethod::sao,    ShadeMethod::gtao,       ShadeMethod::bitmask};

Pattern patternFor(ShadeMethod method, int count)
{
	if (method == ShadeMethod::crytek)
	{
		return crytekPoints(count);
	}
	Recipe recipe{.domain = domainOf(method), .count = count, .starts = 2};
	return generatePattern(recipe);
}

// The samples of `nook shade` without a pattern.
ShadeSamples samplesFor(const ShadeSettings& settings)
{
	if (!takesPattern(settings.method))
	{
		return ownSamples(settings);
	}
	TileRecipe tile{.kind = TileKind::random};
	const int count = settings.method == ShadeMethod::crytek ? 16 : 9;
	return samplesOf(settings.method, generateTile(patternFor(settings.method, count), tile, {}).variants);
}

std::vector<float> drawn(const GBuffer& gbuffer, const ShadeSettings& settings)
{
	return visibilityOf(gbuffer, samplesFor(settings), settings);
}

// The method alone: mean of sixteen pixels in a column, covering all variants of a window's column, whose centres are nearest to
// `at_m` along x.
double valueAt(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, double at_m)
{
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings);
	REQUIRE(plan.passes.size() == 1);
	shade_kernels::Kernels kernels;
	kernels.nook = plan.passes[0].block;
	kernels.depths = gbuffer.depth;
	kernels.normals = gbuffer.normals;
	kernels.samples = samples.samples;
	const auto function = std::get<float (shade_kernels::Kernels::*)(glm::ivec2)>(plan.passes[0].kernel.function);
	const int x = static_cast<int>(std::floor((at_m + 3.0) * gbuffer.width_px / 6.0));
	double sum = 0.0;
	for (int y = 0; y < 16; ++y)
	{
		sum += static_cast<double>((kernels.*function)({x, gbuffer.height_px / 2 + y}));
	}
	return sum / 16.0;
}

// Over the pixels with a surface.
struct Reading
{
	double mean = 0.0;
	double least = 1.0;
};

Reading readingOf(const GBuffer& gbuffer, const std::vector<float>& picture)
{
	Reading reading;
	double pixels = 0.0;
	for (std::size_t i = 0; i < picture.size(); ++i)
	{
		if (std::isfinite(gbuffer.depth[i]))
		{
			reading.mean += static_cast<double>(picture[i]);
			reading.least = std::min(reading.least, static_cast<double>(picture[i]));
			pixels += 1.0;
		}
	}
	reading.mean /= pixels;
	return reading;
}

} // namespace

// docs/measurements/methods.md has the table. A plane across the view is read exactly. At a slope, samples are rounded to pixels,
// and lines through the tangent sphere run along the view's axis while a wide lens looks to the side. Pixels up to half a pixel off
// a slice, or further at the border, show other horizons than the slice's own.
TEST_CASE("shade published: what they read on an open plane", "[shade]")
{
	struct Bound
	{
		ShadeMethod method;
		double across; // view along the plane's normal: every pixel
		double widest; // largest field of view for which that holds, degrees
		double parallel_mean_least;
		double mean_least;
		double mean_most;
		double least;
	};
	constexpr std::array<Bound, 6> kBounds{{{ShadeMethod::crytek, 0.5, 100.0, 0.49, 0.49, 0.61, 0.1},
											{ShadeMethod::volumetric, 1.0, 100.0, 0.995, 0.94, 1.0, 0.5},
											{ShadeMethod::hbao, 1.0, 100.0, 0.985, 0.985, 1.0, 0.4},
											{ShadeMethod::sao, 1.0, 100.0, 0.999, 0.995, 1.0, 0.7},
											{ShadeMethod::gtao, 1.0, 0.0, 0.97, 0.98, 1.0, 0.25},
											{ShadeMethod::bitmask, 1.0, 0.0, 0.9, 0.94, 1.0, 0.4}}};
	for (const double fov : {0.0, 60.0, 100.0})
	{
		for (const double tilt : {0.0, 60.0, 80.0})
		{
			const GBuffer gbuffer = planeAt(projectionOf(lensOf(fov), 16.0 / 9.0), 288, 162, tilt);
			for (const Bound& bound : kBounds)
			{
				const Reading reading = readingOf(gbuffer, drawn(gbuffer, settingsFor(bound.method, 0.5)));
				CAPTURE(static_cast<int>(bound.method), fov, tilt, reading.mean, reading.least);
				CHECK(reading.mean >= (fov == 0.0 ? bound.parallel_mean_least : bound.mean_least));
				CHECK(reading.mean <= bound.mean_most + 1e-6);
				CHECK(reading.least >= bound.least);
				if (tilt == 0.0 && fov <= bound.widest)
				{
					CHECK(reading.least == Approx(bound.across).margin(1e-6));
					CHECK(reading.mean == Approx(bound.across).margin(1e-6));
				}
			}
		}
	}
}

TEST_CASE("shade published: Crytek's points leave out what is far in front, and see sky as open", "[shade]")
{
	ShadeSettings settings = settingsFor(ShadeMethod::crytek, 0.5);
	const int size = 121;
	GBuffer gbuffer = floorWith(size, [](double) { return 6.0; });
	const std::size_t hole = static_cast<std::size_t>(size / 2 * size + size / 2);
	gbuffer.depth[hole] = 10.0F;
	CHECK(drawn(gbuffer, settings)[hole] == 0.5F); // 6 m in front: 1/2 each
	settings.own["--crytek-range"] = 24.0;         // 6 m are half of 12 m
	const float half = drawn(gbuffer, settings)[hole];
	CHECK(half == Approx(0.25F).margin(1e-6));
	std::fill(gbuffer.depth.begin(), gbuffer.depth.end(), std::numeric_limits<float>::infinity());
	gbuffer.depth[hole] = 10.0F;
	CHECK(drawn(gbuffer, settings)[hole] == Approx(1.0F).margin(1e-6));
}

TEST_CASE("shade published: the tangent sphere beside a wall, against the volume of its cap", "[shade]")
{
	const int size = 601;
	const ShadeSettings settings = settingsFor(ShadeMethod::volumetric, 1.0);
	const ShadeSamples samples = samplesOf(settings.method, {patternFor(settings.method, 256)});
	const GBuffer gbuffer = floorWith(size, [](double x) { return x > 1.0 ? 5.0 : 0.0; });
	const double distance = GENERATE(0.1, 0.25, 0.4, 0.6);
	const double c = std::min(distance / 0.5, 1.0);
	CAPTURE(distance);
	CHECK(valueAt(gbuffer, samples, settings, 1.0 - distance) == Approx((1.0 + c) * (1.0 + c) * (2.0 - c) / 4.0).margin(0.01));
}

TEST_CASE("shade published: horizons beside a wall, against their integral", "[shade]")
{
	const int size = 1201;
	const double height = 0.4;
	const GBuffer gbuffer = floorWith(size, [=](double x) { return x > 1.0 ? height : 0.0; });
	const double bias_deg = GENERATE(0.0, 30.0);
	const double strength = GENERATE(1.0, 1.5);
	ShadeSettings settings = settingsFor(ShadeMethod::hbao, 1.0);
	settings.own["--hbao-directions"] = 64;
	settings.own["--hbao-steps"] = 64;
	settings.own["--hbao-angle-bias"] = bias_deg;
	settings.strength = strength;
	const ShadeSamples samples = ownSamples(settings);
	const double distance = GENERATE(0.2, 0.5, 0.8);
	// The first point of the wall's top along each direction is the highest.
	const double least = sinCosOf(bias_deg * kPi / 180.0).sin;
	double sum = 0.0;
	const int parts = 4096;
	for (int i = 0; i < parts; ++i)
	{
		const double run = distance / std::max(1e-9, sinCosOf(2.0 * kPi * (i + 0.5) / parts).cos);
		const double square = run * run + height * height;
		if (run > 0.0 && square < 1.0)
		{
			sum += std::max(0.0, height / std::sqrt(square) - least) * (1.0 - square) / parts;
		}
	}
	CAPTURE(bias_deg, strength, distance);
	CHECK(valueAt(gbuffer, samples, settings, 1.0 - distance) == Approx(1.0 - strength * sum).margin(0.01));
}

TEST_CASE("shade published: the spiral beside a wall, against its integral", "[shade]")
{
	const int size = 1201;
	const double height = 0.4;
	const GBuffer gbuffer = floorWith(size, [=](double x) { return x > 1.0 ? height : 0.0; });
	ShadeSettings settings = settingsFor(ShadeMethod::sao, 1.0);
	settings.own["--sao-samples"] = 256;
	settings.own["--sao-turns"] = 89;
	settings.own["--sao-levels"] = 0;
	const ShadeSamples samples = ownSamples(settings);
	const double distance = GENERATE(0.2, 0.5, 0.8);
	double sum = 0.0;
	const int parts = 512;
	for (int i = 0; i < parts; ++i)
	{
		for (int j = 0; j < parts; ++j)
		{
			const double run = (i + 0.5) / parts;
			const double square = run * run + height * height;
			if (run * sinCosOf(2.0 * kPi * (j + 0.5) / parts).cos > distance && square < 1.0)
			{
				const double f = 1.0 - square;
				sum += f * f * f * (height - 0.012) / (square + 0.01) / (parts * parts);
			}
		}
	}
	CAPTURE(distance);
	CHECK(valueAt(gbuffer, samples, settings, 1.0 - distance) == Approx(1.0 - 5.0 * sum).margin(0.02));
}

TEST_CASE("shade published: coarser depths are used beyond sixteen pixels alone", "[shade]")
{
	const GBuffer gbuffer = floorWith(128, [](double x) { return 0.3 * std::fabs(x); });
	const auto difference = [&](double radius_m)
	{
		ShadeSettings settings = settingsFor(ShadeMethod::sao, radius_m);
		const std::vector<float> with = drawn(gbuffer, settings);
		settings.own["--sao-levels"] = 0;
		return with != drawn(gbuffer, settings);
	};
	CHECK_FALSE(difference(0.74)); // 15.8 pixels
	CHECK(difference(3.0));
}

TEST_CASE("shade published: sky is never a neighbour", "[shade]")
{
	GBuffer gbuffer = floorWith(97, [](double) { return 0.0; });
	for (std::size_t i = 0; i < gbuffer.depth.size(); i += i % 97 == 40 ? 57 : 1)
	{
		gbuffer.depth[i] = std::numeric_limits<float>::infinity();
		gbuffer.normals[i] = glm::vec3(0.0F);
	}
	const ShadeMethod method = GENERATE(from_range(kPublished));
	const bool half = GENERATE(false, true);
	ShadeSettings settings = settingsFor(method, 1.0);
	settings.half_resolution = half;
	const std::vector<float> picture = drawn(gbuffer, settings);
	for (std::size_t i = 0; i < picture.size(); ++i)
	{
		CAPTURE(static_cast<int>(method), half, i);
		REQUIRE(picture[i] >= (method == ShadeMethod::crytek ? 0.5F - 1e-5F : 1.0F - 1e-5F));
		REQUIRE((std::isfinite(gbuffer.depth[i]) || picture[i] == 1.0F));
	}
}

TEST_CASE("shade published: the same picture through other projections of the same view", "[shade]")
{
	const Level level = builtinLevel("cornell");
	const Tracer tracer(level, {});
	const View plain = viewOf(level.cameras[0], 64, 64);
	glm::dmat4 reversed = plain.projection;
	reversed[2][2] = 0.0; // infinite and reversed: z from 1 at the near plane to 0
	reversed[3][2] = 0.1;
	const auto through = [&](const glm::dmat4& projection)
	{
		return castGBuffer(tracer, {plain.camera_from_world, projection}, 64, 64, NormalKind::geometric, {});
	};
	const ShadeMethod method = GENERATE(from_range(kAll));
	const ShadeSettings settings = settingsFor(method);
	CHECK(drawn(through(plain.projection), settings) ==
		  drawn(through(reversed), settings)); // neither rays nor kernels use the z row
	glm::dmat4 skewed = plain.projection;
	skewed[1][0] = 0.1;
	CHECK_THROWS_AS(drawn(through(skewed), settings), Error);
	// A parallel view compared with one from 3 km away through an equally narrow lens, and with an off-centre part of a wider one.
	const GBuffer parallel = floorWith(128, [](double x) { return x > 1.0 ? 0.4 : 0.0; });
	GBuffer far = parallel;
	Lens lens{.fov_y_rad = 2.0 * std::atan(3.0 / 3000.0)};
	far.view.projection = projectionOf(lens, 1.0);
	for (float& depth : far.depth)
	{
		depth += 2990.0F;
	}
	INFO(nameOf(method));
	CHECK(differenceOf(drawn(parallel, settingsFor(method, 0.73)), drawn(far, settingsFor(method, 0.73))).mean < 2e-3);
}

TEST_CASE("shade published: OpenGL agrees with the CPU", "[shade]")
{
	const auto name = GENERATE(as<std::string>{}, "courtyard", "suburb", "nulls");
	const ShadeMethod method = GENERATE(from_range(kPublished));
	ShadeSettings settings = settingsFor(method, 1.0);
	settings.half_resolution = name == "suburb";
	INFO(name);
	checkOnGl(builtinView(name, 160, 90), samplesFor(settings), settings);
}

TEST_CASE("shade published: pictures of a few pixels", "[shade]")
{
	const ShadeMethod method = GENERATE(from_range(kPublished));
	const int size = GENERATE(1, 2, 3);
	const GBuffer gbuffer = floorWith(size, [](double x) { return x > 0.0 ? 0.3 : 0.0; });
	const ShadeSettings settings = settingsFor(method, 4.0);
	const ShadeSamples samples = samplesFor(settings);
	const std::vector<float> cpu = shadeOnCpu(gbuffer, samples, settings, {}).visibility;
	const std::vector<float> gl = shadeOnGl(gbuffer, samples, settings).visibility;
	for (std::size_t i = 0; i < cpu.size(); ++i)
	{
		REQUIRE(cpu[i] >= 0.0F);
		REQUIRE(cpu[i] <= 1.0F);
		REQUIRE(gl[i] == Approx(cpu[i]).margin(1e-5));
	}
}
