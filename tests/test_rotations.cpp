// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/rotations.h"

#include "emit_samples.h"
#include "measure/quality.h"
#include "pattern/generate.h"
#include "pattern/tile_filter.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>

using namespace nook;
using namespace nook::test;
using Approx = Catch::Detail::Approx;

namespace
{

PatternTile tileOf(const Pattern& pattern, const Rotations& rotations)
{
	PatternTile tile;
	tile.domain = pattern.domain;
	tile.size = rotations.size;
	tile.frames = rotations.frames;
	for (const double turns : rotations.turns)
	{
		tile.variants.push_back(turned(pattern, turns));
	}
	return tile;
}

} // namespace

TEST_CASE("rotations: the error by angles is that of the tile with the turned patterns", "[noise]")
{
	const Pattern pattern = scatteredPattern(Domain::disk, 5);
	const RotationError error(pattern);
	for (const int frames : {1, 3})
	{
		for (const RotationNoise noise : {RotationNoise::white, RotationNoise::sixteen, RotationNoise::gradient, RotationNoise::r2})
		{
			const Rotations rotations = rotationsOf(noise, 4, frames);
			for (const int last : {0, 1})
			{
				const TileShares shares = sharesOf(4, tileFilterNamed("binomial:3"), {frames, 0.1}, last);
				// Angles are taken to 1/4096 of a turn.
				CHECK(error.of(rotations, shares) == Approx(errorBehind(tileOf(pattern, rotations), {shares})).epsilon(2e-3));
			}
		}
	}
}

TEST_CASE("rotations: sixteen are sixteen even ones, and all of them on average leave the bias", "[noise]")
{
	const Rotations sixteen = rotationsOf(RotationNoise::sixteen, 4, 1);
	CHECK(std::set<double>(sixteen.turns.begin(), sixteen.turns.end()).size() == 16);
	for (const double turns : sixteen.turns)
	{
		CHECK(turns * 16.0 == std::floor(turns * 16.0));
	}
	Recipe recipe;
	recipe.count = 5;
	recipe.starts = 1;
	const Pattern pattern = generatePattern(recipe);
	const double bias = std::sqrt(squaredError(pattern.domain, Ensemble::plane, Part::bias, pattern.points, pattern.weights));
	const double behind = RotationError(pattern).of(sixteen, sharesOf(4, tileFilterNamed("box:4")));
	CHECK(behind >= 0.999 * bias);
	CHECK(behind <= 1.1 * bias);
}

TEST_CASE("rotations: optimised ones are even angles with less error than the same in random order", "[noise]")
{
	const Pattern pattern = scatteredPattern(Domain::disk, 4);
	const RotationError error(pattern);
	const TileShares shares = sharesOf(8, tileFilterNamed("box:3"));
	const Rotations random = error.optimised(8, 1, shares, 0);
	const Rotations best = error.optimised(8, 1, shares, 200);
	CHECK(std::multiset<double>(random.turns.begin(), random.turns.end()) ==
		  std::multiset<double>(best.turns.begin(), best.turns.end()));
	CHECK(error.of(best, shares) < 0.9 * error.of(random, shares));
	CHECK(error.of(best, shares) <= error.of(rotationsOf(RotationNoise::white, 8, 1), shares));
}
