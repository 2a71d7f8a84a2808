// SPDX-License-Identifier: GPL-3.0-or-later
// Published GTAO and bit masks: a step compared with their integrals, thin objects, their window of variants, rays.
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "scene/reference.h"
#include "scene/tracer.h"

namespace
{

constexpr int kSize = 1201; // pixels of 6 m
constexpr double kWallHeight = 0.4;

// A floor across a parallel view 10 m below the camera, 6 m wide, with a block on it from x = 1 m to `end_m`.
GBuffer blockTo(double end_m)
{
	return floorWith(kSize, [=](double x) { return x > 1.0 && x < end_m ? kWallHeight : 0.0; });
}

// At their best quality.
ShadeSettings bestOf(ShadeMethod method)
{
	ShadeSettings settings = settingsFor(method, 1.0);
	settings.own["--gtao-slices"] = 16;
	settings.own["--gtao-steps"] = 32;
	settings.own["--gtao-falloff"] = 0.3;
	settings.own["--gtao-thickness"] = 0.0;
	settings.own["--bitmask-slices"] = 16;
	settings.own["--bitmask-steps"] = 32;
	settings.own["--bitmask-thickness"] = 1000.0;
	return settings;
}

using Method = float (shade_kernels::Kernels::*)(glm::ivec2);

// The mean over a window of variants at that distance from the block.
double before(const GBuffer& gbuffer, const ShadeSettings& settings, Method method, double distance_m)
{
	const ShadeSamples samples = ownSamples(settings);
	shade_kernels::Kernels kernels = kernelsOver(gbuffer, samples, settings);
	kernels.samples = samples.samples;
	const int x = static_cast<int>(std::floor((4.0 - distance_m) * kSize / 6.0));
	double sum = 0.0;
	for (int i = 0; i < 16; ++i)
	{
		sum += static_cast<double>((kernels.*method)({x - x % 4 + i % 4, kSize / 2 + i / 4}));
	}
	return sum / 16.0;
}

// The mean over directions of a function of the distance to the block's edge along the floor, if nearer than 1 m.
template <class Function> double meanOverEdge(double distance_m, Function function)
{
	constexpr int kParts = 4096;
	double sum = 0.0;
	for (int i = 0; i < kParts; ++i)
	{
		const double cosine = sinCosOf(2.0 * kPi * (i + 0.5) / kParts).cos;
		const double run = distance_m / std::max(1e-9, cosine);
		sum += cosine > 0.0 && run < 1.0 ? function(run) / kParts : 0.0;
	}
	return sum;
}

} // namespace

// Seen from above, a slice is open by 1/2 sin^2 of the horizon's angle to the eye on either side.
TEST_CASE("shade gtao: beside a step, against its integral", "[shade]")
{
	const GBuffer gbuffer = blockTo(4.0);
	const ShadeSettings settings = bestOf(ShadeMethod::gtao);
	const double distance = GENERATE(0.1, 0.2, 0.5, 0.8);
	const double closed = meanOverEdge(distance,
									   [](double run)
									   {
										   const double apart = std::sqrt(run * run + kWallHeight * kWallHeight);
										   const double cosine = std::clamp((1.0 - apart) / 0.7, 0.0, 1.0) * kWallHeight / apart;
										   return cosine * cosine;
									   });
	CAPTURE(distance);
	CHECK(before(gbuffer, settings, &shade_kernels::Kernels::nookGtao, distance) == Approx(1.0 - closed).margin(0.015));
}

TEST_CASE("shade gtao: with a thickness, what is thin hides less", "[shade]")
{
	ShadeSettings settings = bestOf(ShadeMethod::gtao);
	const auto read = [&settings](double end_m, double thickness)
	{
		settings.own["--gtao-thickness"] = thickness;
		return before(blockTo(end_m), settings, &shade_kernels::Kernels::nookGtao, 0.2);
	};
	CHECK(read(1.1, 0.0) == Approx(read(4.0, 0.0)).margin(0.02));
	CHECK(read(1.1, 0.2) > read(1.1, 0.0) + 0.1);
	CHECK(read(1.1, 1.0) > 0.97);
}

// All sectors have equal weight: the covered fraction is the elevation of the block's edge relative to a half turn.
TEST_CASE("shade bitmask: beside a step, against its integral", "[shade]")
{
	const GBuffer gbuffer = blockTo(4.0);
	ShadeSettings settings = bestOf(ShadeMethod::bitmask);
	// hit: 0 from half a sector, 1 from a whole one, 2 from what is touched
	const auto read = [&](int hit, double distance)
	{
		settings.own["--bitmask-hit"] = hit;
		return before(gbuffer, settings, &shade_kernels::Kernels::nookBitmask, distance);
	};
	const double distance = GENERATE(0.1, 0.2, 0.5, 0.8);
	const double open = 1.0 - meanOverEdge(distance, [](double run) { return 2.0 * std::atan(kWallHeight / run) / kPi; });
	CAPTURE(distance);
	const double half = read(0, distance);
	CHECK(half == Approx(open).margin(0.02));
	CHECK(read(1, distance) == Approx(half).margin(0.04));
	CHECK(read(2, distance) == Approx(half).margin(0.04));
	CHECK(read(1, distance) > half);
	CHECK(read(2, distance) < half);
}

TEST_CASE("shade bitmask: light comes from under what is thin", "[shade]")
{
	const GBuffer gbuffer = blockTo(1.1);
	ShadeSettings settings = bestOf(ShadeMethod::bitmask);
	const double thick = before(gbuffer, settings, &shade_kernels::Kernels::nookBitmask, 0.2);
	settings.own["--bitmask-thickness"] = 0.1;
	CHECK(before(gbuffer, settings, &shade_kernels::Kernels::nookBitmask, 0.2) > thick + 0.1);
}

TEST_CASE("shade published: slices of a window have sixteen azimuths, and four jitters in each row and column", "[shade]")
{
	const std::vector<glm::vec4> samples = sliceDirections(3);
	REQUIRE(samples.size() == 48);
	std::set<int> turns;
	for (std::size_t line = 0; line < 4; ++line)
	{
		std::set<float> of_row;
		std::set<float> of_column;
		for (std::size_t i = 0; i < 4; ++i)
		{
			of_row.insert(samples[3 * (4 * line + i)].z);
			of_column.insert(samples[3 * (4 * i + line)].z);
			const glm::vec4& first = samples[3 * (4 * line + i)];
			turns.insert(static_cast<int>(std::floor(std::acos(static_cast<double>(first.x)) / kPi * 48.0)));
		}
		CHECK((of_row.size() == 4 && of_column.size() == 4));
	}
	CHECK((turns.size() == 16 && *turns.begin() == 0 && *turns.rbegin() == 15)); // in sixteenths of a third of a half turn
}

TEST_CASE("shade published: slices are nearer to rays than horizon-based occlusion of as many depths", "[shade]")
{
	const auto name = GENERATE(as<std::string>{}, "courtyard", "suburb");
	const Level level = builtinLevel(name);
	const Tracer tracer(level, {});
	const GBuffer gbuffer = castGBuffer(tracer, viewOf(level.cameras[0], 240, 135), 240, 135, NormalKind::geometric, {});
	ReferenceSettings reference{.falloff = Falloff::linear, .radius_m = 1.5, .rays = 64};
	const std::vector<ReferenceValue> rays = referenceOfGBuffer(&tracer, gbuffer, reference, {2, {}});
	std::map<ShadeMethod, double> errors;
	for (const ShadeMethod method : {ShadeMethod::slices, ShadeMethod::gtao, ShadeMethod::bitmask, ShadeMethod::hbao})
	{
		ShadeSettings settings = settingsFor(method, 1.5);
		settings.slices = {3, 6};
		settings.filter = ShadeFilter::bilateral;
		settings.own["--hbao-angle-bias"] = 10.0;
		errors[method] = rmseOf(visibilityOf(gbuffer, settings), rays);
		UNSCOPED_INFO(name << ", " << nameOf(method) << ": " << errors[method]);
	}
	CHECK(errors[ShadeMethod::slices] < 0.97 * errors[ShadeMethod::hbao]);
	CHECK(errors[ShadeMethod::gtao] < 0.9 * errors[ShadeMethod::hbao]);
	CHECK(errors[ShadeMethod::bitmask] < errors[ShadeMethod::hbao]);
}
