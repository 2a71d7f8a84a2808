// SPDX-License-Identifier: GPL-3.0-or-later
// Candidates and what a view measures of them.
#include "core/content_hash.h"
#include "small_levels.h"
#include "study/measure_view.h"

#include "scene/builtin.h"
#include "shade/gl_context.h"

#include <catch2/catch.hpp>

#include <memory>
#include <set>

using namespace nook;
using namespace nook::test;

namespace
{

// A box on a floor, seen from above one side.
Level boxOnFloor()
{
	Level level = emptyLevel();
	addQuad(level, {-4.0, 0.0, -4.0}, {0.0, 0.0, 8.0}, {8.0, 0.0, 0.0});
	addBox(level, {-0.5, 0.0, -0.5}, {0.5, 1.0, 0.5});
	LevelCamera camera;
	camera.name = "main";
	camera.world_from_camera = worldFromCamera({2.0, 2.0, 2.0}, {0.0, 0.3, 0.0});
	level.cameras.push_back(camera);
	return level;
}

Candidate lines(int count)
{
	Candidate candidate;
	candidate.source = SampleSource::refined;
	candidate.count = count;
	candidate.shade.filter = ShadeFilter::bilateral;
	return candidate;
}

Candidate rays(int count)
{
	Candidate candidate;
	candidate.kind = CandidateKind::rays;
	candidate.origin = Origin::rays;
	candidate.count = count;
	return candidate;
}

} // namespace

TEST_CASE("error report: names of candidates are unique, and the smaller grid is of the larger one's methods", "[report]")
{
	std::size_t before = 0;
	for (const GridSize size : {GridSize::quick, GridSize::normal, GridSize::full})
	{
		const std::vector<Candidate> grid = candidateGrid(size);
		std::set<std::string> names;
		std::set<std::string> methods;
		for (const Candidate& candidate : grid)
		{
			INFO(candidate.name());
			CHECK(names.insert(candidate.name()).second);
			methods.insert(candidate.method());
		}
		CHECK(methods.size() == 16);
		for (const std::string name :
			 {"hbao 6 bilateral-13 bias-10", "gtao 3 bilateral-5", "gtao 3 bilateral-5 rays", "bitmask 3 bilateral-5 rays"})
		{
			CHECK(names.contains(name)); // published at their best, raw and fitted
		}
		CHECK(grid.size() > before);
		before = grid.size();
	}
}

TEST_CASE("error report: more rays err less, and the reference says how far it may be off", "[report]")
{
	LevelBench level(boxOnFloor(), 1.0, {});
	ViewBench view(level, level.level().cameras.front(), {32, 18, 512, 1}, {});
	MeasureSettings settings;
	settings.device = Device::cpu;
	settings.repetitions = 2;
	const Measurement few = view.measure(rays(4), settings);
	const Measurement many = view.measure(rays(256), settings);
	CHECK(many.errors.rmse < 0.5 * few.errors.rmse);
	CHECK(many.errors.eq14 < few.errors.eq14);
	CHECK(view.reference().error > 0.0);
	CHECK(view.reference().error < few.errors.rmse);
	CHECK(few.passes.size() == 1);
	CHECK(few.total.low_s <= few.total.median_s);
	CHECK(few.total.median_s <= few.total.high_s);
	CHECK_FALSE(few.own_rmse);
}

TEST_CASE("error report: a method's definition is what it draws without noise, and a factor can only help", "[report]")
{
	LevelBench level(boxOnFloor(), 1.0, {});
	ViewBench view(level, level.level().cameras.front(), {32, 18, 256, 1}, {});
	MeasureSettings settings;
	settings.device = Device::cpu;
	settings.repetitions = 1;
	const Measurement measured = view.measure(lines(5), settings);
	REQUIRE(measured.own_rmse);
	CHECK(*measured.own_rmse > 0.0);
	CHECK(view.measure(definitionOf(lines(5)), settings).own_rmse == 0.0);
	CHECK(measured.errors.best_rmse <= measured.errors.rmse + 1e-6);
	CHECK(view.errorsOf(view.reference().visibility).rmse == 0.0);
	CHECK(view.errorsOf(view.reference().visibility).eq14 == 0.0);
	CHECK(measured.visibility == view.draw(lines(5), settings));
}

TEST_CASE("error report: volumes of a level are measured as its other methods are", "[report]")
{
	LevelBench level(boxOnFloor(), 1.0, {});
	ViewBench view(level, level.level().cameras.front(), {32, 18, 512, 1}, {});
	MeasureSettings settings;
	settings.device = Device::cpu;
	settings.repetitions = 1;
	Candidate volumes;
	volumes.kind = CandidateKind::asset;
	volumes.asset = assetNamed("aov");
	const Measurement built = view.measure(volumes, settings);
	volumes.volumes = VolumeRecipe::triangles;
	const Measurement triangles = view.measure(volumes, settings);
	CHECK(built.volumes < triangles.volumes);
	CHECK(triangles.volumes == 14);
	CHECK(built.fragments > 0);
	CHECK(built.errors.rmse < view.measure(lines(9), settings).errors.rmse);
}

TEST_CASE("error report: hashes differ where pictures may, and nowhere else", "[report]")
{
	LevelBench level(boxOnFloor(), 1.0, {});
	ViewBench view(level, level.level().cameras.front(), {16, 9, 64, 1}, {});
	ViewBench same(level, level.level().cameras.front(), {16, 9, 64, 1}, {});
	ViewBench larger(level, level.level().cameras.front(), {32, 9, 64, 1}, {});
	LevelBench wider(boxOnFloor(), 2.0, {});
	ViewBench further(wider, level.level().cameras.front(), {16, 9, 64, 1}, {});
	MeasureSettings settings;
	MeasureSettings longer;
	longer.repetitions = 9;
	const std::string hash = view.contentHash(lines(5), settings, "1");
	CHECK(hash.size() == 32);
	CHECK(same.contentHash(lines(5), settings, "1") == hash);
	std::set<std::string> others{hash};
	for (const std::string& other : {view.contentHash(lines(6), settings, "1"), view.contentHash(lines(5), longer, "1"),
									 view.contentHash(lines(5), settings, "2"), larger.contentHash(lines(5), settings, "1"),
									 further.contentHash(lines(5), settings, "1")})
	{
		CHECK(others.insert(other).second);
	}
}

TEST_CASE("error report: bakes and volumes say their bytes, and splitting triangles brings a bake nearer to rays", "[report]")
{
	LevelBench bench(boxOnFloor(), 0.5, {});
	ViewBench view(bench, bench.level().cameras.front(), {64, 36, 64, 1}, {});
	MeasureSettings how;
	how.device = Device::cpu;
	how.repetitions = 1;
	Candidate bake;
	bake.kind = CandidateKind::asset;
	bake.asset = assetNamed("bake");
	CHECK(bake.name() == "bake");
	const Measurement coarse = view.measure(bake, how);
	CHECK(coarse.bytes == 4 * bench.level().positions.size());
	CHECK(coarse.total.median_s == 0.0);
	bake.bake_error = 0.05;
	CHECK(bake.name() == "bake 0.05");
	const Measurement fine = view.measure(bake, how);
	CHECK(fine.bytes > coarse.bytes);
	CHECK(fine.errors.rmse < coarse.errors.rmse);
	Candidate volumes;
	volumes.kind = CandidateKind::asset;
	volumes.asset = assetNamed("aov");
	CHECK(view.measure(volumes, how).bytes > 100);
	CHECK(view.flicker(bake, how, 2) >= 0.0);
}

TEST_CASE("error report: pictures of one session are those of contexts of their own, whatever was drawn before", "[report]")
{
	const Level level = boxOnFloor();
	LevelBench bench(boxOnFloor(), 0.5, {});
	ViewBench large(bench, level.cameras.front(), {64, 36, 8, 1}, {});
	ViewBench small(bench, level.cameras.front(), {33, 20, 8, 1}, {});
	MeasureSettings in_session;
	in_session.session = std::make_shared<GlSession>();
	const std::vector<Candidate> grid = candidateGrid(GridSize::quick);
	for (int round = 0; round < 2; ++round) // volumes, in contexts of their own, come between
	{
		for (std::size_t i = 0; i < grid.size(); i += 2)
		{
			if (grid[i].kind != CandidateKind::rays)
			{
				ViewBench& view = i % 4 == 0 ? large : small;
				INFO(grid[i].name());
				CHECK(view.draw(grid[i], in_session) == view.draw(grid[i], {}));
			}
		}
	}
}
