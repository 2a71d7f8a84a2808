// SPDX-License-Identifier: GPL-3.0-or-later
// Slices: their measure in closed form, planes, a step compared with its integral, rays, and the CPU compared with OpenGL.
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "pattern/tile.h"
#include "scene/tracer.h"

namespace
{

ShadeSettings settingsOf(int slices, int steps, double radius_m = 1.0)
{
	ShadeSettings settings = settingsFor(ShadeMethod::slices, radius_m);
	settings.slices.count = slices;
	settings.slices.steps = steps;
	return settings;
}

} // namespace

TEST_CASE("shade slices: angles and the sectors before a direction, against their integral", "[shade]")
{
	shade_kernels::Kernels kernels;
	for (int i = -1000; i <= 1000; ++i)
	{
		const double angle = kPi * i / 1000.5;
		const SinCos at = sinCosOf(angle);
		REQUIRE(static_cast<double>(kernels.nookSliceAngle(static_cast<float>(at.sin * 3.0), static_cast<float>(at.cos * 3.0))) ==
				Approx(angle).margin(1.5e-5));
	}
	const double normal = GENERATE(-1.5, -0.8, 0.0, 0.3, 1.2, 1.57);
	const SinCos turn = sinCosOf(normal);
	const int parts = 20000;
	std::vector<double> before{0.0};
	for (int i = 0; i < parts; ++i)
	{
		const double t = normal + kPi * ((i + 0.5) / parts - 0.5);
		before.push_back(before.back() + std::cos(t - normal) * std::fabs(std::sin(t)));
	}
	const auto sine = static_cast<float>(turn.sin);
	const auto cosine = static_cast<float>(turn.cos);
	const glm::vec3 sectors = kernels.nookSliceSectors(sine, cosine);
	const glm::vec3 fit = kernels.nookSliceSegment() * (0.5F * sine * sectors.x);
	const glm::vec4 edge(1.0F + sine, 1.0F - sine, 1.0F + sine, 1.0F - sine);
	const glm::vec4 tilt = glm::vec4(0.5F, -0.5F, 0.5F, -0.5F) * (cosine * sectors.x);
	CHECK(static_cast<double>(sectors.z) == Approx(turn.cos + normal * turn.sin).margin(0.012));
	for (int i = 1; i < parts; i += 397)
	{
		const SinCos at = sinCosOf(normal + kPi * (static_cast<double>(i) / parts - 0.5));
		const glm::ivec4 sides = kernels.nookSliceSector(glm::vec4(static_cast<float>(at.cos)), edge, tilt, fit, sectors.y);
		const int sector = at.sin < 0.0 ? sides.y : sides.x;
		const double exact = 31.0 * before[static_cast<std::size_t>(i)] / before.back();
		CAPTURE(normal, i, exact, sector);
		REQUIRE(std::fabs(sector - exact) < 0.75);
	}
	// The tangent plane is at the ends, and beyond it nothing changes.
	for (const float beyond : {0.0F, 0.4F})
	{
		CHECK(kernels.nookSliceSector(1.0F - edge - beyond, edge, tilt, fit, sectors.y) == glm::ivec4(31, 0, 31, 0));
	}
}

TEST_CASE("shade slices: the sixteen variants of a window are sixteen azimuths and sixteen jitters", "[shade]")
{
	shade_kernels::Kernels kernels;
	kernels.nook.samples = 1;
	for (const int cell : {1, 2})
	{
		kernels.nook.cell = cell;
		std::set<int> variants;
		std::set<int> reversed;
		for (int i = 0; i < 16; ++i)
		{
			variants.insert(kernels.nookSliceVariant({(8 + i % 4) * cell, (4 + i / 4) * cell}));
			reversed.insert(kernels.nookSliceReverse(i));
			CHECK(kernels.nookSliceReverse(kernels.nookSliceReverse(i)) == i);
		}
		CHECK((variants.size() == 16 && *variants.rbegin() == 15));
		CHECK((reversed.size() == 16 && *reversed.rbegin() == 15));
	}
	for (const std::uint32_t bits : {0U, 1U, 0xFFFFFFFFU, 0x80000001U, 0x12345678U})
	{
		for (const int native : {0, 1})
		{
			kernels.nook.native_bits = native;
			CHECK(kernels.nookSliceBitCount(bits) == static_cast<int>(std::popcount(bits)));
		}
	}
	CHECK((kernels.nookSliceBitsBelow(0) == 0U && kernels.nookSliceBitsBelow(5) == 31U &&
		   kernels.nookSliceBitsBelow(32) == 0xFFFFFFFFU));
}

TEST_CASE("shade slices: an open plane is open, at any slope and through any lens", "[shade]")
{
	const int slices = GENERATE(1, 3);
	checkOpen(visibilityOf(eachPlane(144, 81), settingsOf(slices, 4, 0.5)));
}

// Seen from above, a slice at an angle f to the wall's normal meets the top's edge at a distance d / cos(f), and is covered from
// there to the floor, since surfaces are thick: sin^2 of the edge's elevation, times 1 - distance.
TEST_CASE("shade slices: beside a step, against its integral", "[shade]")
{
	const int size = 1201;
	const double height = 0.4;
	const GBuffer gbuffer = floorWith(size, [=](double x) { return x > 1.0 ? height : 0.0; });
	const ShadeSettings settings = settingsOf(16, 32);
	shade_kernels::Kernels kernels = kernelsOver(gbuffer, ownSamples(settings), settings);
	const double distance = GENERATE(0.1, 0.2, 0.5, 0.8);
	double closed = 0.0;
	const int parts = 4096;
	for (int i = 0; i < parts; ++i)
	{
		const double run = distance / std::max(1e-9, sinCosOf(2.0 * kPi * (i + 0.5) / parts).cos);
		const double square = run * run + height * height;
		closed += run > 0.0 && square < 1.0 ? height * height / square * (1.0 - std::sqrt(square)) / parts : 0.0;
	}
	double found = 0.0;
	const int x = static_cast<int>(std::floor((4.0 - distance) * size / 6.0));
	for (int i = 0; i < 16; ++i)
	{
		found += static_cast<double>(kernels.nookSlices({x - x % 4 + i % 4, size / 2 + i / 4})) / 16.0;
	}
	CAPTURE(distance);
	CHECK(found == Approx(1.0 - closed).margin(0.015));
}

TEST_CASE("shade slices: one pixel's estimates have the mean of many slices", "[shade]")
{
	const GBuffer gbuffer = builtinView("cornell", 64, 64);
	const Difference difference =
		differenceOf(visibilityOf(gbuffer, settingsOf(1, 8, 0.5)), visibilityOf(gbuffer, settingsOf(16, 8, 0.5)));
	CHECK(std::fabs(difference.signed_mean) < 0.01);
}

TEST_CASE("shade slices: OpenGL agrees with the CPU", "[shade]")
{
	const auto name = GENERATE(as<std::string>{}, "courtyard", "suburb", "nulls");
	const GBuffer gbuffer = builtinView(name, 160, 90);
	ShadeSettings settings = settingsOf(name == "nulls" ? 3 : 1, 4);
	settings.half_resolution = name == "suburb";
	const ShadeSamples samples = ownSamples(settings);
	const Shaded cpu = shadeOnCpu(gbuffer, samples, settings, {2, {}});
	const Shaded gl = shadeOnGl(gbuffer, samples, settings);
	const Difference difference = differenceOf(cpu.visibility, gl.visibility);
	CAPTURE(name, gl.renderer, difference.beyond);
	CHECK(difference.worst < 0.1); // a different bit changes the result by 1/32 of a slice
	CHECK(difference.beyond <= 1e-3);
}

TEST_CASE("shade slices: of a tile, on the CPU and in OpenGL, one and several a pixel", "[shade]")
{
	const GBuffer gbuffer = builtinView("courtyard", 160, 90);
	const ShadeSettings settings = settingsOf(1, 4);
	// The kernel's own variants as a tile: the same picture except for the last bits of azimuths.
	shade_kernels::Kernels kernels = kernelsOver(gbuffer, ownSamples(settings), settings);
	std::vector<Pattern> own;
	for (int pixel = 0; pixel < 16; ++pixel)
	{
		const int place = kernels.nookSliceVariant({pixel % 4, pixel / 4});
		own.push_back(slicePattern(1));
		own.back().points[0] = {(place + 0.5) / 16.0, (kernels.nookSliceReverse(place) + 0.5) / 16.0, 0.0};
	}
	const std::vector<float> drawn_own = visibilityOf(gbuffer, samplesOf(ShadeMethod::slices, own), settings);
	const std::vector<float> without = visibilityOf(gbuffer, settings);
	CHECK(std::inner_product(drawn_own.begin(), drawn_own.end(), without.begin(), 0, std::plus<>(),
							 [](float a, float b) { return std::fabs(a - b) > 1.0F / 255.0F ? 1 : 0; }) <= 14);
	for (const int count : {1, 3})
	{
		TileRecipe recipe{.size = 3};
		const ShadeSamples samples =
			samplesOf(ShadeMethod::slices, generateTile(slicePattern(count), recipe, RunSettings{2, {}}).variants);
		const Shaded cpu = shadeOnCpu(gbuffer, samples, settings, {2, {}});
		const Shaded gl = shadeOnGl(gbuffer, samples, settings);
		CAPTURE(count, gl.renderer);
		CHECK(differenceOf(cpu.visibility, gl.visibility).beyond <= 1e-3);
		CHECK(cpu.visibility != without);
	}
}
