// SPDX-License-Identifier: GPL-3.0-or-later
// The curve fitted to a level, and all steps from a level to its volumes.
#include "small_levels.h"

#include "core/error.h"
#include "core/random.h"
#include "scene/builtin.h"
#include "volume/build.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>

using namespace nook;
using namespace nook::test;

namespace
{

// One polygon per triangle.
VolumeSet volumesOf(const Level& level, double distance_m)
{
	VolumeSet set;
	set.distance_m = distance_m;
	set.exact_bounds = true;
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		const auto first = static_cast<uint32_t>(set.occluders.corners.size());
		set.occluders.polygons.push_back({first, 3, static_cast<uint32_t>(i), 1.0F, false});
		for (int k = 0; k < 3; ++k)
		{
			set.occluders.corners.push_back(level.positions[level.triangles[i][k]]);
		}
	}
	return set;
}

CompensateSettings fitOf(int views, int per_view, int by_area, int rays)
{
	CompensateSettings settings;
	settings.views = views;
	settings.per_view = per_view;
	settings.by_area = by_area;
	settings.rays = rays;
	return settings;
}

} // namespace

TEST_CASE("compensation: a known curve is found again, and never falls", "[volume_build]")
{
	Random random(3);
	std::vector<double> sums;
	std::vector<double> occlusions;
	for (int i = 0; i < 20000; ++i)
	{
		const double sum = 1.5 * random.uniform();
		sums.push_back(sum);
		occlusions.push_back(std::clamp(sum - 0.25 * sum * sum + 0.05 * (random.uniform() - 0.5), 0.0, 1.0));
	}
	const Compensation curve = fitCurve(sums, occlusions);
	CHECK(curve.occlusion[0] == 0.0);
	for (std::size_t k = 1; k < curve.occlusion.size(); ++k)
	{
		CHECK(curve.occlusion[k] >= curve.occlusion[k - 1]);
		CHECK(curve.occlusion[k] <= 1.0);
	}
	for (double sum = 0.1; sum < 1.45; sum += 0.05)
	{
		CHECK(std::fabs(curve.at(sum) - (sum - 0.25 * sum * sum)) < 0.01);
	}
	CHECK(logResidual(curve, sums, occlusions) <= logResidual(Compensation{}, sums, occlusions));

	// A single receiver, and receivers without occlusion.
	CHECK(fitCurve(std::vector{0.5}, std::vector{0.25}).at(0.5) == Approx(0.25).margin(0.02));
	CHECK(fitCurve(std::vector{0.0, 0.0}, std::vector{0.0, 0.1}).at(0.0) == 0.0);
}

TEST_CASE("compensation: in a corner the curve brings sums to the reference", "[volume_build]")
{
	Level level = emptyLevel();
	addQuad(level, {0.0, 0.0, 4.0}, {4.0, 0.0, 0.0}, {0.0, 0.0, -4.0});
	addQuad(level, {0.0, 0.0, 0.0}, {4.0, 0.0, 0.0}, {0.0, 4.0, 0.0});
	addQuad(level, {0.0, 0.0, 4.0}, {0.0, 0.0, -4.0}, {0.0, 4.0, 0.0});
	const Tracer tracer(level, {});
	const VolumeSet set = volumesOf(level, 1.0);
	const CompensateSettings settings = fitOf(2, 200, 1500, 128);
	const CompensateResult result = compensateVolumes(set, tracer, settings, {2, {}});
	REQUIRE(result.trials.size() >= 2);
	const RatioTrial& best = result.trials[result.best];
	CHECK(best.fitted <= best.paper);
	CHECK(best.unexplained() < 0.15);
	CHECK(result.ray_distance_m == Approx(1.0 / best.ratio));
	for (const RatioTrial& trial : result.trials)
	{
		CHECK(best.unexplained() <= trial.unexplained());
	}
	const CompensateResult again = compensateVolumes(set, tracer, settings, {1, {}});
	CHECK(again.curve.occlusion == result.curve.occlusion);
	CompensateSettings fixed = settings;
	fixed.ray_distance_m = 1.25;
	CHECK(compensateVolumes(set, tracer, fixed, {2, {}}).ray_distance_m == 1.25);
}

TEST_CASE("build: bad input is refused before work starts, great distances are warned of", "[volume_build]")
{
	const Level level = floorAndBox();
	VolumeSettings settings;
	settings.distance_m = 100.0;
	const BuiltVolumes built = buildVolumes(level, settings, {});
	REQUIRE(built.warnings.size() == 1);
	CHECK(built.warnings[0].find("distance: found 100 m, more than the level's diagonal") != std::string::npos);
	CHECK(built.set.ray_distance_m == Approx(100.0 / 0.6));

	settings.distance_m = 1.0;
	CHECK(buildVolumes(level, settings, {}).warnings.empty());
	settings.memory_bytes = 1;
	try
	{
		buildVolumes(level, settings, {});
		FAIL("memory cap ignored");
	}
	catch (const Error& error)
	{
		CHECK(error.code() == ExitCode::runtime);
		CHECK(std::string(error.what()).find("memory: found a need of about") != std::string::npos);
	}
	CHECK_THROWS_WITH(buildVolumes(level, settings, {}),
					  Catch::EndsWith("nook level --cells cuts it into parts that need less each"));
	settings.memory_bytes = volumeMemory(level.triangles.size(), settings) + (uint64_t{1} << 20U);
	settings.compensate = fitOf(2, 50, 100, 16);
	settings.trim.emplace();
	settings.verify = ReceiverSettings{2, 100, 200, 100, 1};
	CHECK_THROWS_WITH(buildVolumes(level, settings, {}),
					  Catch::EndsWith("expected at most 161 MiB: about 161 MiB without trim, which --degrade leaves out"));
	settings.degrade = true;
	const BuiltVolumes less = buildVolumes(level, settings, {});
	CHECK(less.left_out == "trim");
	CHECK((!less.trimmed && less.compensated && less.verified));
	CHECK(less.memory_estimate_bytes <= settings.memory_bytes);
	REQUIRE(less.warnings.size() == 1);
	CHECK_THAT(less.warnings[0], Catch::EndsWith("expected at most 161 MiB: left out trim, which leaves about 161 MiB"));
	settings.degrade = false;
	settings.trim.reset();
	CHECK_NOTHROW(buildVolumes(level, settings, {})); // the message's claim is true
	settings.compensate.reset();
	settings.verify.reset();
	settings.memory_bytes = volumeMemory(level.triangles.size(), settings);
	CHECK(buildVolumes(level, settings, {}).set.occluders.polygons.size() < 14); // merged and dropped
	settings.occluders.extent = 0.1;
	settings.occluders.extent_always = true;
	settings.memory_bytes += uint64_t{1} << 20U;
	CHECK_THROWS_WITH(buildVolumes(level, settings, {}),
					  Catch::Contains("polygons that an extent cuts to, expected at most 161 MiB"));
	settings.memory_bytes = 0;
	settings.distance_m = 1e-6; // more than 32 bits can number
	CHECK_THROWS_WITH(buildVolumes(level, settings, {}), Catch::Contains("extent: found up to"));
	settings = {};

	// Convex, seen from outside: nothing to darken, which is not an error.
	Level box = emptyLevel();
	addBox(box, {-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
	settings.memory_bytes = 0;
	settings.verify = ReceiverSettings{2, 100, 200, 100, 1};
	settings.compensate = fitOf(2, 50, 100, 16);
	const BuiltVolumes none = buildVolumes(box, settings, {});
	CHECK(none.set.occluders.polygons.empty());
	REQUIRE(none.warnings.size() == 1);
	CHECK(none.warnings[0].find("volumes: found none") != std::string::npos);
	CHECK(none.verified->greatest < 1e-6);
	CHECK(none.set.ray_distance_m == Approx(1.0 / 0.6)); // no ray prefers another ratio: the paper's

	const Level empty = emptyLevel();
	try
	{
		buildVolumes(empty, settings, {});
		FAIL("a level without triangles passed");
	}
	catch (const Error& error)
	{
		CHECK(error.code() == ExitCode::invalid_input);
	}
}

TEST_CASE("build: detail is chosen by errors, and bytes follow the surface, not its triangles", "[volume_build]")
{
	VolumeSettings settings;
	settings.distance_m = 2.0;
	settings.occluders.distance_m = 2.0;
	settings.detail_more = 0.05;
	std::array<std::size_t, 2> polygons{};
	for (const std::size_t i : {0U, 1U})
	{
		const Level level = builtinLevel(i == 0 ? "cave:20000" : "cave:80000");
		const BuiltVolumes built = buildVolumes(level, settings, {2, {}});
		REQUIRE(built.detail);
		const DetailChoice& choice = *built.detail;
		REQUIRE(choice.trials.size() >= 3);
		CHECK(choice.detail > 0.0);
		const DetailTrial& whole = choice.trials[0];
		CHECK(whole.detail == 0.0);
		for (const DetailTrial& trial : choice.trials)
		{
			const bool allowed = trial.paper_rmse <= 1.05 * whole.paper_rmse && trial.fitted_rmse <= 1.15 * whole.fitted_rmse;
			CHECK((trial.detail > choice.detail ? !allowed : allowed));
			CHECK((trial.detail != choice.detail || 10 * trial.polygons <= 9 * whole.polygons));
		}
		polygons[i] = built.set.occluders.polygons.size();
		if (i == 0)
		{
			// The chosen value as an explicit setting gives the same result; also on one thread.
			VolumeSettings given = settings;
			given.detail_more.reset();
			given.occluders.detail = choice.detail;
			CHECK(buildVolumes(level, given, {2, {}}).set.occluders.corners == built.set.occluders.corners);
			CHECK(buildVolumes(level, settings, {1, {}}).detail->detail == choice.detail);
		}
	}
	CHECK(polygons[1] < 2 * polygons[0]); // with four times the triangles
	// With a fitted curve, the fitted curve's error counts.
	const Level level = builtinLevel("cave:20000");
	const VolumeSettings paper = settings;
	settings.compensate = fitOf(2, 50, 100, 16);
	const DetailChoice fitted = *buildVolumes(level, settings, {2, {}}).detail;
	CHECK(fitted.detail < buildVolumes(level, paper, {2, {}}).detail->detail);
	for (const DetailTrial& trial : fitted.trials)
	{
		CHECK((trial.detail != fitted.detail || trial.fitted_rmse <= 1.05 * fitted.trials[0].fitted_rmse));
	}
	// No savings: boxes are unchanged.
	CHECK(buildVolumes(floorAndBox(), settings, {2, {}}).detail->detail == 0.0);
}

TEST_CASE("build: what simplification sank below the surface is not inside", "[volume_build]")
{
	VolumeSettings settings;
	settings.occluders.detail = 0.02;
	const BuiltVolumes cave = buildVolumes(builtinLevel("cave:20000"), settings, {2, {}});
	CHECK(cave.merged.proxies < 16000);
	CHECK(cave.dropped.inside == 0); // nothing is inside, and nothing is found to be without simplification
	// A dense ball with a box that stays inside.
	Level ball = emptyLevel();
	addBox(ball, {-4.0, -1.0, -4.0}, {4.0, 0.0, 4.0});
	const std::size_t first = ball.triangles.size();
	addSphere(ball, {0.0, 1.7, 0.0}, 1.5, 60, 60);
	const std::size_t inner = ball.triangles.size();
	addBox(ball, {-0.5, 1.2, -0.5}, {0.5, 2.2, 0.5});
	const BuiltVolumes built = buildVolumes(ball, settings, {2, {}});
	CHECK(built.merged.proxies < ball.triangles.size() / 4);
	CHECK(built.dropped.inside >= 6);
	bool outer = false;
	for (const Occluder& polygon : built.set.occluders.polygons)
	{
		CHECK(polygon.triangle < inner);
		outer = outer || polygon.triangle >= first;
	}
	CHECK(outer);
}

TEST_CASE("build: verified and compensated in one go", "[volume_build]")
{
	const Level level = floorAndBox();
	VolumeSettings settings;
	settings.verify = ReceiverSettings{2, 200, 800, 200, 1};
	settings.compensate = fitOf(2, 100, 400, 64);
	const BuiltVolumes built = buildVolumes(level, settings, {2, {}});
	REQUIRE(built.verified);
	REQUIRE(built.compensated);
	CHECK(built.verified->receivers > 500);
	CHECK(built.verified->greatest <= 1e-5);
	CHECK(built.set.ray_distance_m == built.compensated->ray_distance_m);
	CHECK(built.set.compensation.occlusion == built.compensated->curve.occlusion);
	CHECK(built.dropped.kept < built.dropped.polygons);
}

TEST_CASE("compensation: where no ray meets anything the paper's ratio counts", "[volume_build]")
{
	std::vector<RatioTrial> trials(3);
	trials[0].ratio = 0.5;
	trials[1].ratio = 0.6;
	trials[2].ratio = 0.7;
	CHECK(bestOf(trials) == 1);
	// Shorter rays that hit nothing are no better than longer ones that do.
	trials[0].variance = 0.1;
	trials[0].fitted = 0.05;
	CHECK(bestOf(trials) == 0);
	trials[2].variance = 0.1;
	trials[2].fitted = 0.04;
	CHECK(bestOf(trials) == 2);
	trials[0].fitted = 0.04;
	CHECK(bestOf(trials) == 0);
}
