// SPDX-License-Identifier: GPL-3.0-or-later
// Advice of nook info on levels with known parts.
#include "small_levels.h"

#include "scene/builtin.h"
#include "scene/describe.h"
#include "scene/load.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <utility>

using namespace nook;
using namespace nook::test;

TEST_CASE("advice: closed and open components, shared places and patches are counted", "[scene]")
{
	Level level = emptyLevel();
	addBox(level, {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}); // faces with their own vertices: still closed
	addBox(level, {5.0, 0.0, 0.0}, {6.0, 1.0, 1.0});
	addQuad(level, {0.0, -1.0, 9.0}, {9.0, 0.0, 0.0}, {0.0, 0.0, -9.0}); // a sheet
	for (const int threads : {1, 2})
	{
		const LevelFacts facts = levelFacts(level, threads);
		CHECK(facts.components == 3);
		CHECK(facts.closed == 2);
		CHECK(facts.open_triangles == 2);
		CHECK(facts.places == 8 + 8 + 4);
		CHECK(facts.sharing == level.positions.size() - 20);
		CHECK(facts.patches == 6 + 6 + 1);
		CHECK(std::fabs(facts.median_edge_m - std::sqrt(40.5)) < 1e-9);
		CHECK(facts.coarse_share == 1.0);
	}
}

TEST_CASE("advice: coarse architecture takes volumes, dense meshes a bake", "[scene]")
{
	const auto adviceOf = [](const char* name)
	{
		const LoadedLevel loaded = loadLevel(name, {}, {});
		const LevelFacts facts = levelFacts(loaded.level, 2);
		return adviceFor(facts, volumesEstimate(loaded.level, facts), bakeEstimate(loaded.level, 256)).asset;
	};
	CHECK(adviceOf("builtin:cornell") == Asset::volumes);
	CHECK(adviceOf("builtin:suburb") == Asset::volumes);
	CHECK(adviceOf("builtin:cave:20000") == Asset::bake);
	CHECK(adviceOf("builtin:heightfield:200000") == Asset::bake);
}

TEST_CASE("advice: a bake of a level with large triangles is split", "[scene]")
{
	LevelFacts facts;
	const AssetEstimate many{20e6, 1.0, 1e9};
	const AssetEstimate few{1e6, 1.0, 1e9};
	const AssetEstimate bake{3e6, 1.0, 1e9};
	for (const auto& [share, split] : {std::pair{0.0, false}, {0.2, false}, {0.4, true}})
	{
		facts.coarse_share = share;
		for (const AssetEstimate& volumes : {many, few})
		{
			const Advice advice = adviceFor(facts, volumes, bake);
			CHECK(advice.asset == Asset::bake);
			CHECK(advice.split == split);
		}
	}
}

TEST_CASE("advice: a level in millimetres or of many kilometres is doubted", "[scene]")
{
	for (const auto& [size_m, doubt] : {std::pair{0.3, ScaleDoubt::small}, {30.0, ScaleDoubt::none}, {30000.0, ScaleDoubt::large}})
	{
		Level level = emptyLevel();
		addBox(level, {0.0, 0.0, 0.0}, {size_m, size_m, size_m});
		const LevelFacts facts = levelFacts(level, 1);
		CHECK(scaleDoubt(facts) == doubt);
		CHECK(facts.radius_m > 0.0);
		CHECK(facts.radius_m <= 1.5);
	}
}
