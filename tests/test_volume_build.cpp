// SPDX-License-Identifier: GPL-3.0-or-later
// The curve fitted to a level, and all steps from a level to its volumes.
#include "small_levels.h"
#include "small_volumes.h"
#include "testing.h"

#include "volume/build.h"
#include "volume/evaluate.h"
#include "volume/trim.h"

namespace
{

CompensateSettings fitOf(int views, int per_view, int by_area, int rays)
{
	CompensateSettings settings;
	settings.views = views;
	settings.per_view = per_view;
	settings.by_area = by_area;
	settings.rays = rays;
	return settings;
}

VolumeSet squareOf(float reach, float side_reach, bool two_sided)
{
	VolumeSet set = setOf({}, 2.0, false);
	set.occluders.add({.two_sided = two_sided, .reach = reach, .side_reach = side_reach},
					  Corners{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}});
	return set;
}

// Convex, in a random plane: corners on an ellipse at random angles.
Corners randomPolygon(nook::Random& random, std::size_t count, double width, double height, glm::dvec3 centre)
{
	glm::dvec3 normal(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
	normal = glm::normalize(normal);
	const glm::dvec3 side =
		glm::normalize(glm::cross(normal, std::fabs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
	const glm::dvec3 up = glm::cross(normal, side);
	std::vector<double> angles;
	for (std::size_t i = 0; i < count; ++i)
	{
		angles.push_back(2.0 * nook::kPi * (static_cast<double>(i) + 0.9 * random.uniform()) / static_cast<double>(count));
	}
	Corners corners;
	for (const double angle : angles)
	{
		const nook::SinCos at = nook::sinCosOf(angle);
		corners.push_back(centre + side * (width * at.cos) + up * (height * at.sin));
	}
	return corners;
}

// AOV eq. 5 without ᾱ, and for two-sided polygons by |height|: a straightforward reference.
double falloff(const Corners& corners, const nook::VolumeShape& shape, glm::dvec3 x)
{
	const glm::dvec3 front = nook::frontOf(corners);
	double g = 1.0;
	for (std::size_t i = 0; i < corners.size(); ++i)
	{
		const glm::dvec3 inward = glm::normalize(glm::cross(front, corners[(i + 1) % corners.size()] - corners[i]));
		const double side = glm::dot(x - corners[i], inward);
		g *= side <= -shape.distance_m * shape.side_share ? 0.0 : std::clamp(side / shape.distance_m + 1.0, 0.0, 1.0);
	}
	const double height = glm::dot(x - corners[0], front);
	if (height < 0.0 && !shape.two_sided)
	{
		return 0.0;
	}
	return g * std::clamp(1.0 - std::fabs(height) / shape.distance_m, 0.0, 1.0);
}

struct Face
{
	std::vector<std::size_t> at;
};

std::vector<Face> facesOf(std::size_t count)
{
	Face low;
	Face high;
	std::vector<Face> faces;
	for (std::size_t i = 0; i < count; ++i)
	{
		const std::size_t next = (i + 1) % count;
		low.at.insert(low.at.begin(), i);
		high.at.push_back(count + i);
		faces.push_back({{i, next, count + next, count + i}});
	}
	faces.push_back(low);
	faces.push_back(high);
	return faces;
}

// The greatest height of a point above a face, metres: ≤ 0 inside.
double outsideOf(const std::vector<glm::dvec3>& points, glm::dvec3 x)
{
	double most = -1e300;
	for (const Face& face : facesOf(points.size() / 2))
	{
		Corners corners;
		for (const std::size_t at : face.at)
		{
			corners.push_back(points[at]);
		}
		most = std::max(most, glm::dot(x - corners[0], nook::frontOf(corners)));
	}
	return most;
}

std::vector<glm::dvec3> prism(const Corners& corners, const nook::VolumeShape& shape)
{
	std::vector<glm::dvec3> points(2 * corners.size());
	nook::prismOf(corners, nook::frontOf(corners), shape, points);
	return points;
}

void requireSound(const Corners& corners, const std::vector<glm::dvec3>& points, double scale)
{
	double volume = 0.0;
	for (const Face& face : facesOf(corners.size()))
	{
		Corners ring;
		for (const std::size_t at : face.at)
		{
			ring.push_back(points[at] - corners[0]);
		}
		REQUIRE(glm::length(nook::frontOf(ring)) > 0.5); // not degenerate
		for (std::size_t i = 1; i + 1 < ring.size(); ++i)
		{
			volume += glm::dot(ring[0], glm::cross(ring[i], ring[i + 1])) / 6.0;
		}
	}
	REQUIRE(volume > 0.0);
	for (const glm::dvec3 point : points) // convex with outward faces: no corner is above any face
	{
		REQUIRE(outsideOf(points, point) <= 1e-9 * scale);
	}
	for (const glm::dvec3 corner : corners)
	{
		REQUIRE(outsideOf(points, corner) <= 1e-9 * scale);
	}
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
	const VolumeSet set = setOf(trianglesOf(level), 1.0);
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
	const std::string need = refusalBy([&] { buildVolumes(level, settings, {}); }, ExitCode::runtime);
	CHECK(need.find("memory: found a need of about") != std::string::npos);
	CHECK(need.ends_with("nook level --cells cuts it into parts that need less each"));
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
	CHECK_FALSE(refusalBy([&] { buildVolumes(empty, settings, {}); }).empty());
}

TEST_CASE("build: detail is chosen by errors, and bytes follow the surface, not its triangles", "[volume_build]")
{
	VolumeSettings settings;
	settings.distance_m = 2.0;
	settings.occluders.distance_m = 2.0;
	settings.detail_more = 0.05;
	std::array<std::size_t, 2> polygons{};
	double first = 0.0; // detail of cave:20000
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
			first = choice.detail;
			// The chosen value as an explicit setting gives the same result.
			VolumeSettings given = settings;
			given.detail_more.reset();
			given.occluders.detail = choice.detail;
			CHECK(buildVolumes(level, given, {2, {}}).set.occluders.corners == built.set.occluders.corners);
		}
	}
	CHECK(polygons[1] < 2 * polygons[0]); // with four times the triangles
	// With a fitted curve, the fitted curve's error counts.
	const Level level = builtinLevel("cave:20000");
	settings.compensate = fitOf(2, 50, 100, 16);
	const DetailChoice fitted = *buildVolumes(level, settings, {2, {}}).detail;
	CHECK(fitted.detail <= first);
	for (const DetailTrial& trial : fitted.trials)
	{
		CHECK((trial.detail != fitted.detail || trial.fitted_rmse <= 1.05 * fitted.trials[0].fitted_rmse));
	}
	// No savings: boxes are unchanged.
	CHECK(buildVolumes(floorAndBox(), settings, {2, {}}).detail->detail == 0.0);
}

namespace
{

// A height field of 20 m × 20 m with waves of 3 m and ripples of 0.3 m; the curtain stands upright.
Level wavesOf(bool curtain)
{
	constexpr int kSteps = 100;
	Level level = emptyLevel();
	const auto at = [&](int x, int z)
	{
		const double u = 0.2 * x;
		const double v = 0.2 * z;
		const double height = 0.3 * std::sin(2.0 * u) * std::cos(1.7 * v) + 0.003 * std::sin(21.0 * u + 17.0 * v);
		return curtain ? glm::dvec3(u - 10.0, v, height) : glm::dvec3(u - 10.0, height, 10.0 - v);
	};
	for (int x = 0; x < kSteps; ++x)
	{
		for (int z = 0; z < kSteps; ++z)
		{
			const auto first = static_cast<uint32_t>(level.positions.size());
			for (const glm::dvec3& corner : {at(x, z), at(x + 1, z), at(x + 1, z + 1), at(x, z + 1)})
			{
				addVertex(level, corner);
			}
			addTriangle(level, first, first + 1, first + 2);
			addTriangle(level, first, first + 2, first + 3);
		}
	}
	return level;
}

} // namespace

TEST_CASE("build: a ground that is open is simplified, and a curtain that is seen from both sides is not", "[volume_build]")
{
	VolumeSettings settings;
	settings.distance_m = 1.0;
	settings.detail_more = 0.05;
	const bool curtain = GENERATE(false, true);
	Level level = wavesOf(curtain);
	if (curtain)
	{
		addBox(level, {-20.0, -1.0, -20.0}, {20.0, -0.01, 20.0});
	}
	const BuiltVolumes built = buildVolumes(level, settings, {2, {}});
	const DetailTrial& whole = built.detail->trials.at(0);
	CAPTURE(curtain, built.detail->detail, whole.polygons, built.set.occluders.polygons.size());
	CHECK((built.detail->detail == 0.0) == curtain);
	CHECK((2 * built.set.occluders.polygons.size() < whole.polygons) == !curtain);
	// Chosen occluders have numbers of their own, so open ones are left alone.
	VolumeSettings chosen = settings;
	const Level occluders = level;
	chosen.occluding = &occluders;
	CHECK(buildVolumes(level, chosen, {2, {}}).detail->detail == 0.0);
}

TEST_CASE("build: points that all polygons get wrong say nothing about detail", "[volume_build]")
{
	// Most points lie in gaps whose walls darken rays and have no volumes, as those that volumes drop as hidden.
	const Level curtain = wavesOf(true);
	Level level = curtain;
	for (int i = 0; i < 20; ++i)
	{
		addBox(level, {100.0 + 0.2 * i, 0.0, 0.0}, {100.1 + 0.2 * i, 10.0, 10.0});
	}
	OccluderSettings occluders;
	occluders.distance_m = 1.0;
	DetailSettings detail;
	detail.more = 0.25;
	detail.ray_distance_m = 1.0;
	detail.masks = true;
	detail.rays = 64;
	const DetailChoice choice = chooseDetail(curtain, Tracer(level, {2, {}}), occluders, detail, {2, {}});
	CHECK(choice.points < 2000);
	REQUIRE_FALSE(choice.trials.empty());
	CHECK(choice.trials[0].paper_rmse < 0.05);
	CHECK(choice.detail == 0.0);
}

TEST_CASE("build: detail of masks by their error, of which one black point is a small part", "[volume_build]")
{
	const Level level = builtinLevel("cave:120000");
	OccluderSettings occluders;
	occluders.distance_m = 1.0;
	DetailSettings detail;
	detail.more = 0.25;
	detail.ray_distance_m = 1.0;
	detail.masks = true;
	const Tracer tracer(level, {2, {}});
	occluders.tracer = &tracer;
	const DetailChoice choice = chooseDetail(level, tracer, occluders, detail, {2, {}});
	bool outvoted = false; // a step that black points alone would rule out
	for (const DetailTrial& trial : choice.trials)
	{
		CHECK(trial.fitted_rmse <= trial.paper_rmse);
		outvoted = outvoted || (trial.fitted_rmse <= 0.008 && trial.paper_rmse > 1.25 * choice.trials[0].paper_rmse);
		const bool fine = trial.fitted_rmse <= 0.008 || trial.paper_rmse <= 1.25 * choice.trials[0].paper_rmse;
		CHECK(fine == (trial.detail <= choice.detail));
	}
	CHECK(outvoted);
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

TEST_CASE("build: a ground with two sides is simplified if people see only its front", "[volume_build]")
{
	Level ground = wavesOf(false);
	ground.material_list[0].two_sided = true;
	VolumeSettings settings;
	settings.occluders.detail = 0.02;
	CHECK(2 * buildVolumes(ground, settings, {2, {}}).merged.proxies < ground.triangles.size());
	Level seen = ground;
	seen.cameras.emplace_back().world_from_camera[3] = {0.0, -4.0, 0.0, 1.0};
	CHECK(buildVolumes(seen, settings, {2, {}}).merged.proxies == ground.triangles.size());
	settings.drop.visible_from = {Bounds{{-9.0, -4.0, -9.0}, {9.0, -3.0, 9.0}}};
	CHECK(buildVolumes(ground, settings, {2, {}}).merged.proxies == ground.triangles.size());
}

TEST_CASE("build: a closed hollow that a camera looks into darkens inside", "[volume_build]")
{
	Level room = emptyLevel();
	room.material_list[0].two_sided = true;
	addBox(room, {0.0, 0.0, 0.0}, {4.0, 3.0, 4.0}); // fronts outside
	room.cameras.emplace_back().world_from_camera[3] = {2.0, 1.5, 9.0, 1.0};
	VolumeSettings settings;
	CHECK(buildVolumes(room, settings, {2, {}}).set.occluders.polygons.empty());
	settings.drop.visible_from = {Bounds{{1.0, 1.0, 1.0}, {3.0, 2.0, 3.0}}};
	CHECK(buildVolumes(room, settings, {2, {}}).set.occluders.polygons.size() == 6);
	settings.drop.visible_from.clear();
	room.cameras[0].world_from_camera[3] = {2.0, 1.5, 2.0, 1.0};
	CHECK(buildVolumes(room, settings, {2, {}}).set.occluders.polygons.size() == 6);
	settings.occluders.sides = Sides::oriented;
	CHECK(buildVolumes(room, settings, {2, {}}).set.occluders.polygons.empty());
}

TEST_CASE("build: folds that simplification makes do not blacken what is in the open", "[volume_build]")
{
	constexpr uint32_t kSide = 200;
	Level level = emptyLevel();
	Random random(7);
	const auto noise = [&random]
	{
		return 0.03 * (random.uniform() - 0.5);
	};
	for (uint32_t i = 0; i < kSide * kSide; ++i)
	{
		addVertex(level, {0.05 * (i % kSide) + noise(), noise(), -0.05 * (i / kSide) + noise()});
	}
	for (uint32_t i = 0; i < kSide * (kSide - 1); ++i)
	{
		if (i % kSide + 1 < kSide)
		{
			addTriangle(level, i, i + 1, i + 1 + kSide);
			addTriangle(level, i, i + 1 + kSide, i + kSide);
		}
	}
	const Tracer tracer(level, {2, {}});
	const std::vector<ReferencePoint> points = sampleReceivers(tracer, 1.0, {0, 0, 20000, 0, 1}, {2, {}});
	ReferenceSettings rays;
	rays.rays = 64;
	rays.radius_m = 1.0;
	rays.falloff = Falloff::linear;
	const std::vector<ReferenceValue> references = referenceAtPoints(tracer, points, rays, {2, {}});
	std::array<int, 2> black{};
	std::array<std::size_t, 2> polygons{};
	for (std::size_t with = 0; with < 2; ++with)
	{
		OccluderSettings settings;
		settings.sides = Sides::oriented;
		settings.detail = 0.03;
		settings.tracer = with == 1 ? &tracer : nullptr;
		VolumeSet set;
		set.occluders = occludersOf(level, settings, {2, {}}).occluders;
		polygons[with] = set.occluders.polygons.size();
		const VolumeEvaluator evaluator(set, {2, {}}, true);
		for (std::size_t i = 0; i < points.size(); ++i)
		{
			const bool open = references[i].visibility > 0.8;
			black[with] += open && evaluator.mask(points[i].position, points[i].normal, 128).visibility < 0.3 ? 1 : 0;
		}
	}
	CAPTURE(black, polygons);
	CHECK(black[0] >= 5);
	CHECK(5 * black[1] <= black[0]);
	CHECK(100 * polygons[1] > 97 * polygons[0]);
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

// Shortened volumes: the cut itself, the allowed losses, and the file's round trip.

TEST_CASE("trim: a receiver beyond the reach gets nothing, one within gets what it got", "[trim]")
{
	Random random(3);
	std::size_t within = 0;
	std::size_t beyond = 0;
	for (const bool two_sided : {false, true})
	{
		const VolumeSet whole = squareOf(1.0F, 1.0F, two_sided);
		const VolumeSet cut = squareOf(0.375F, 0.1875F, two_sided); // 0.75 m up, half as far sideways
		const VolumeEvaluator of_whole(whole, {});
		const VolumeEvaluator of_cut(cut, {}, true);
		std::vector<VolumeShare> shares;
		for (int i = 0; i < 20000; ++i)
		{
			const glm::dvec3 at(4.0 * random.uniform() - 1.5, 4.0 * random.uniform() - 1.5, 4.0 * random.uniform() - 2.0);
			const glm::dvec3 toward = glm::normalize(glm::dvec3(0.5, 0.5, 0.0) - at);
			const double height_m = std::fabs(at.z);
			const double side_m = std::max({0.0, -at.x, at.x - 1.0, -at.y, at.y - 1.0});
			if (std::fabs(height_m - 0.75) < 1e-5 || std::fabs(side_m - 0.375) < 1e-5)
			{
				continue;
			}
			const double expected = height_m < 0.75 && side_m < 0.375 ? of_whole.occlusion(at, toward) : 0.0;
			REQUIRE(of_cut.occlusion(at, toward) == expected);
			const VolumeReceiver receiver{at, toward};
			of_whole.shares({&receiver, 1}, {&shares, 1});
			for (const VolumeShare& share : shares)
			{
				const double lifted_m = height_m < 2e-4 ? 2.1e-4 : 2e-7; // points in the plane are lifted out of it
				REQUIRE(static_cast<double>(share.height_m) == Approx(height_m).margin(lifted_m));
				REQUIRE(static_cast<double>(share.outside_m) == Approx(side_m).margin(2e-7));
			}
			within += expected > 0.0 ? 1U : 0U;
			beyond += expected == 0.0 && of_whole.occlusion(at, toward) > 0.0 ? 1U : 0U;
			// Masks are covered by the same polygons.
			if (expected == 0.0 && i % 16 == 0)
			{
				REQUIRE(of_cut.mask(at, toward, 32).visibility == 1.0);
			}
		}
	}
	CHECK(within > 500);
	CHECK(beyond > 500);
}

TEST_CASE("trim: files keep the reach, rounded up to 1/128, that of sides to eighths of it", "[trim]")
{
	const Level level = builtinLevel("cornell");
	const bool prisms = GENERATE(false, true);
	VolumeSet set = volumesOf(level, 0.4, 8, true);
	Random random(5);
	for (Occluder& polygon : set.occluders.polygons)
	{
		polygon.reach = static_cast<float>(1.0 - random.uniform());
		polygon.side_reach = polygon.reach * static_cast<float>(1.0 - random.uniform());
	}
	set.occluders.polygons[0].reach = set.occluders.polygons[0].side_reach = 1.0F;
	set.occluders.polygons[1].reach = set.occluders.polygons[1].side_reach = 1e-6F;
	const PackedVolumes packed = packVolumes(set, {prisms}, {});
	const VolumeSet back = unpacked(packed, set);
	REQUIRE(back.occluders.polygons.size() == set.occluders.polygons.size());
	for (std::size_t i = 0; i < set.occluders.polygons.size(); ++i)
	{
		const double reach = static_cast<double>(set.occluders.polygons[i].reach);
		REQUIRE(static_cast<double>(back.occluders.polygons[i].reach) == std::ceil(128.0 * reach) / 128.0);
		REQUIRE(back.occluders.polygons[i].two_sided);
		REQUIRE(nook_volumes::reachOf(packed.polygons[i]) == std::ceil(128.0 * reach) / 128.0);
		const double side = static_cast<double>(set.occluders.polygons[i].side_reach);
		const double kept = static_cast<double>(back.occluders.polygons[i].side_reach);
		const double eighth = std::ceil(128.0 * reach) / 1024.0;
		REQUIRE(kept == std::ceil(side / eighth) * eighth);
		REQUIRE(nook_volumes::sideReachOf(packed.polygons[i]) == kept);
		REQUIRE(nook_volumes::cornerCountOf(packed.polygons[i]) == back.occluders.polygons[i].corner_count);
	}
	// An untrimmed volume is written exactly as before reaches existed.
	REQUIRE(packed.polygons[0].flags == nook_volumes::kTwoSided);
	REQUIRE(packed.polygons[0].corner_bits == set.occluders.polygons[0].corner_count);
	const PackedVolumes again = packVolumes(back, {prisms}, {});
	for (std::size_t i = 0; i < packed.polygons.size(); ++i)
	{
		REQUIRE(again.polygons[i].flags == packed.polygons[i].flags);
		REQUIRE(again.polygons[i].corner_bits == packed.polygons[i].corner_bits);
	}
}

TEST_CASE("trim: no receiver loses more than it may, fragments are saved, threads change nothing", "[trim]")
{
	const Level level = builtinLevel("suburb");
	const Tracer tracer(level, {});
	TrimSettings settings{.share = 0.1};
	const std::vector<ReferencePoint> receivers = sampleReceivers(tracer, 1.5, {2, 2000, 6000, 0, 1}, {2, {}});
	const VolumeSet whole = volumesOf(level, 1.5, 64);
	VolumeSet cut = whole;
	const TrimCounts counts = trimVolumes(cut, receivers, settings, {2, {}});
	const std::vector<double> before = sumsAt(whole, receivers, {2, {}});
	const std::vector<double> after = sumsAt(cut, receivers, {2, {}});
	double most = 0.0;
	double mean = 0.0;
	for (std::size_t i = 0; i < receivers.size(); ++i)
	{
		const double lost = before[i] - after[i];
		REQUIRE(lost <= settings.share * std::max(before[i], kTrimFloor) + 2e-5); // sums of floats
		REQUIRE(lost >= -1e-6);
		most = std::max(most, lost);
		mean += lost / static_cast<double>(receivers.size());
	}
	CHECK(counts.receivers == receivers.size());
	// The stored share is rounded up by at most 2⁻¹⁰.
	CHECK(counts.greatest_loss == Approx(most).epsilon(0.001).margin(1e-5));
	CHECK(counts.mean_loss == Approx(mean).epsilon(0.001).margin(1e-5));
	CHECK(counts.greatest_loss >= most - 1e-5);
	CHECK(mean > 1e-4);
	CHECK(counts.mean_reach < 0.9);
	CHECK(counts.surface < 0.7);
	CHECK(counts.trimmed > whole.occluders.polygons.size() / 2);

	const GBuffer gbuffer = castGBuffer(tracer, viewOf(level.cameras.front(), 32, 18), 32, 18, NormalKind::geometric, {});
	const uint64_t of_whole = aovOnGl(gbuffer, whole, {}).counts.fragments;
	const uint64_t of_cut = aovOnGl(gbuffer, cut, {}).counts.fragments;
	INFO(of_whole << " fragments, " << of_cut << " of the shortened");
	CHECK(10 * of_cut < 9 * of_whole);

	VolumeSet again = whole;
	trimVolumes(again, receivers, settings, {1, {}});
	for (std::size_t i = 0; i < cut.occluders.polygons.size(); ++i)
	{
		REQUIRE(again.occluders.polygons[i].reach == cut.occluders.polygons[i].reach);
		REQUIRE(again.occluders.polygons[i].side_reach == cut.occluders.polygons[i].side_reach);
	}
}

TEST_CASE("trim: what few receivers see keeps its reach; a cap leaves receivers out", "[trim]")
{
	// Two squares: one just below the receivers, with nearly all of their occlusion, and a distant one.
	const auto squares = []
	{
		VolumeSet set = squareOf(1.0F, 1.0F, false);
		for (int i = 0; i < 4; ++i)
		{
			set.occluders.corners.push_back(set.occluders.corners[static_cast<std::size_t>(i)] + glm::dvec3(0.0, 0.0, 1.8));
		}
		set.occluders.polygons.push_back({4, 4, 1, 1.0F, false});
		return set;
	};
	VolumeSet set = squares();
	const std::vector<ReferencePoint> three(3, ReferencePoint{{0.5, 0.5, 1.9}, {0.0, 0.0, -1.0}, 0.0});
	const std::vector<ReferencePoint> four(4, three[0]);
	TrimSettings settings{.share = 1.0};
	CHECK(trimVolumes(set, three, settings, {}).trimmed == 0);
	CHECK((set.occluders.polygons[0].reach == 1.0F && set.occluders.polygons[1].reach == 1.0F));
	CHECK(trimVolumes(set, four, settings, {}).trimmed == 1);
	CHECK(set.occluders.polygons[0].reach == 121.0F / 128.0F); // 0.95, rounded down: they lose it
	CHECK(set.occluders.polygons[1].reach == 1.0F);
	settings.most_shares = 1;
	set = squares();
	const std::vector<ReferencePoint> many(9000, three[0]);
	const TrimCounts capped = trimVolumes(set, many, settings, {});
	CHECK(capped.receivers == 4096);
	CHECK(capped.left_out == 9000 - 4096);
	CHECK(capped.whole == 0);
	set = squares();
	CHECK(trimVolumes(set, three, settings, {}).whole == 2);
}

TEST_CASE("trim: volumes that no receiver was asked about are asked about what their polygons see", "[trim]")
{
	const Level level = builtinLevel("cornell");
	const Tracer tracer(level, {});
	VolumeSet set = volumesOf(level, 0.4, 8);
	TrimSettings settings{.share = 0.5};
	CHECK(trimVolumes(set, std::span<const ReferencePoint>(), settings, {}).receivers == 0);
	const TrimCounts counts = trimVolumes(set, std::span<const ReferencePoint>(), settings, {}, &tracer);
	CHECK(counts.receivers > 100);
	CHECK(counts.trimmed > 0);
}

TEST_CASE("trim: eight bytes keep what a receiver gets, none less, and the reach that leaves it out", "[trim]")
{
	Random random(11);
	for (int i = 0; i < 100000; ++i)
	{
		const auto occlusion = static_cast<float>(std::exp2(-30.0 * random.uniform()));
		const VolumeReach needed{static_cast<float>(random.uniform()), static_cast<float>(random.uniform())};
		const TrimPart part(static_cast<uint32_t>(i), occlusion, needed);
		const auto asked = static_cast<double>(occlusion);
		REQUIRE(part.receiver() == static_cast<uint32_t>(i));
		REQUIRE((part.occlusion() >= asked && part.occlusion() <= asked * (1.0 + 0x1p-10)));
		const VolumeReach kept = part.reach();
		REQUIRE((kept.height <= needed.height && needed.height < kept.height + 1.0F / 128.0F));
		REQUIRE((kept.side <= needed.side && needed.side < kept.side + 1.0F / 1024.0F));
	}
	CHECK(TrimPart(0, 1.0F, {0.999999F, 0.999999F}).occlusion() == 1.0);
	CHECK(TrimPart(0, 0.0F, {}).occlusion() > 0.0);
	CHECK(TrimPart(0, 0.5F, {0.5F, 0.3F}).along(0) == 512);
	CHECK(TrimPart(0, 0.5F, {0.5F, 0.3F}).along(1) == 307);
	CHECK(TrimPart(0, 0.5F, {0.2F, 0.3F}).along(2) == 307);
	CHECK(TrimPart(0, 0.5F, {0.007F, 0.9F}).along(0) == 0); // no height in a file excludes it
}

// The closed volume around a polygon: outward, convex, and covering all points with a falloff above 0 in AOV eq. 5.

TEST_CASE("volume: a square's prism is the square moved outward by the distance", "[volume][prism]")
{
	const Corners square{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
	REQUIRE(nook::frontOf(square) == glm::dvec3(0, 0, 1));
	const bool two_sided = GENERATE(false, true);
	const std::vector<glm::dvec3> points = prism(square, {0.5, two_sided, false});
	REQUIRE(glm::distance(points[0], {-0.5, -0.5, two_sided ? -0.5 : 0.0}) < 1e-15);
	REQUIRE(glm::distance(points[6], {2.5, 2.5, 0.5}) < 1e-15);
}

TEST_CASE("volume: collinear neighbours move straight outward", "[volume][prism]")
{
	const Corners corners{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}};
	const bool exact = GENERATE(false, true);
	REQUIRE(glm::distance(prism(corners, {0.25, false, exact})[1], {1.0, -0.25, 0.0}) < 1e-15);
}

TEST_CASE("volume: the clamp takes corners below 60 degrees to twice the distance, no other", "[volume][prism]")
{
	const double half_deg = GENERATE(1e-5, 1.0, 20.0, 29.9, 30.1, 60.0, 80.0);
	const nook::SinCos half = nook::sinCosOf(half_deg * nook::kPi / 180.0);
	const Corners corners{{0, 0, 0}, {half.cos, -half.sin, 0}, {half.cos, half.sin, 0}};
	const double moved = glm::distance(prism(corners, {1.0, false, false})[0], corners[0]);
	REQUIRE(moved == Approx(std::min(2.0, 1.0 / half.sin)).epsilon(1e-9));
	const double whole = glm::distance(prism(corners, {1.0, false, true})[0], corners[0]);
	REQUIRE(whole == Approx(std::min(256.0, 1.0 / half.sin)).epsilon(1e-9));
}

TEST_CASE("volume: prisms are closed, convex and outward, from needles of 1e-7 to sixteen corners", "[volume][prism]")
{
	nook::Random random(7);
	for (int round = 0; round < 3000; ++round)
	{
		const std::size_t count = 3 + static_cast<std::size_t>(round) % 14;
		const double width = nook::powOf(10.0, -4.0 + 7.0 * random.uniform());
		const double thin = nook::powOf(10.0, -7.0 * random.uniform());
		const Corners corners = randomPolygon(random, count, width, width * thin, {});
		const nook::VolumeShape shape{nook::powOf(10.0, -1.0 + 2.0 * random.uniform()), round % 2 == 0, round % 3 == 0,
									  round % 5 == 0 ? 0.25 : 1.0};
		const std::vector<glm::dvec3> points = prism(corners, shape);
		requireSound(corners, points, (shape.exact_bounds ? 100.0 : 1.0) * (width + shape.distance_m));
	}
}

TEST_CASE("volume: with exact bounds no point with a falloff lies outside", "[volume][prism]")
{
	nook::Random random(8);
	for (int round = 0; round < 400; ++round)
	{
		const double width = nook::powOf(10.0, -2.0 + 4.0 * random.uniform());
		const double thin = nook::powOf(10.0, -1.5 * random.uniform());
		const Corners corners = randomPolygon(random, 3 + static_cast<std::size_t>(round) % 6, width, width * thin, {});
		const nook::VolumeShape shape{1.0, round % 2 == 0, true, round % 3 == 0 ? 0.375 : 1.0};
		const std::vector<glm::dvec3> points = prism(corners, shape);
		for (const glm::dvec3 point : points) // also beyond needle tips: towards and past every corner
		{
			for (int i = 0; i < 100; ++i)
			{
				const glm::dvec3 offset(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
				const glm::dvec3 x = point * (1.2 * random.uniform()) + offset * 3.0;
				if (falloff(corners, shape, x) > 0.0)
				{
					REQUIRE(outsideOf(points, x) <= 1e-9 * (width + 1.0));
				}
			}
		}
	}
}

TEST_CASE("volume: with exact bounds needles lose less than 1/8192 of occlusion", "[volume][prism]")
{
	// The mitre of a corner of 1e-7 is 2e7 times the distance; it is cut. Points outside then receive at most g times the form
	// factor of a receiver that faces every part of the needle: the sum of area · height / (π r³).
	nook::Random random(9);
	int outside = 0;
	for (int round = 0; round < 300; ++round)
	{
		const double half = nook::powOf(10.0, -7.0 + 6.0 * random.uniform());
		const double length = nook::powOf(10.0, -1.0 + 4.0 * random.uniform());
		const Corners corners{{0, 0, 0}, {length, -length * half, 0}, {length, length * half, 0}};
		const nook::VolumeShape shape{1.0, false, true};
		const std::vector<glm::dvec3> points = prism(corners, shape);
		for (int i = 0; i < 300; ++i)
		{
			const glm::dvec3 x(length * (1.2 - 4.0 * random.uniform()), 4.0 * random.uniform() - 2.0, random.uniform());
			const double g = falloff(corners, shape, x);
			if (g == 0.0 || outsideOf(points, x) <= 1e-9)
			{
				continue;
			}
			outside += 1;
			double factor = 0.0; // for the receiver that sees most of it: cos ≤ 1
			constexpr int kParts = 2000;
			for (int part = 0; part < kParts; ++part)
			{
				const double at = length * (part + 0.5) / kParts;
				const double area = 2.0 * at * half * length / kParts;
				const glm::dvec3 offset = glm::dvec3(at, 0.0, 0.0) - x;
				const double square = glm::dot(offset, offset);
				factor += area * std::fabs(offset.z) / (nook::kPi * square * std::sqrt(square));
			}
			REQUIRE(g * factor < 1.0 / 8192.0);
		}
	}
	REQUIRE(outside > 20);
}
