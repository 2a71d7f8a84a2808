// SPDX-License-Identifier: GPL-3.0-or-later
#include "tile_errors.h"

#include "pattern/recipe.h"

#include <catch2/catch.hpp>

#include <glm/geometric.hpp>

#include <algorithm>

using namespace nook;

namespace
{

// The first samples, with normalised weights.
Pattern prefixOf(const Pattern& pattern, std::size_t count)
{
	Pattern prefix = pattern;
	prefix.points.resize(count);
	prefix.weights.resize(count);
	const double sum = std::accumulate(prefix.weights.begin(), prefix.weights.end(), 0.0);
	for (double& w : prefix.weights)
	{
		w /= sum;
	}
	return prefix;
}

void checkVariant(const Pattern& variant, std::size_t count)
{
	CHECK(variant.count() == count);
	CHECK(std::accumulate(variant.weights.begin(), variant.weights.end(), 0.0) == Approx(1.0).margin(1e-6));
	for (const glm::dvec3& p : variant.points)
	{
		CHECK(glm::length(p) <= 1.0);
	}
}

} // namespace

TEST_CASE("tile: the window's mean is close to exact and each variant stays good", "[pattern]")
{
	// Reference values of a plain descent: window 0.0040 at 1.29 times the base, 0.0024 at 1.18.
	const auto figures = GENERATE(table<int, double, double>({{5, 0.0040, 1.29}, {9, 0.0024, 1.18}}));
	const Pattern base = generatePattern(recipeOf(Domain::disk, std::get<0>(figures)), RunSettings{2, {}});
	const PatternTile tile = generateTile(base, {}, RunSettings{2, {}});
	REQUIRE(tile.variants.size() == 16);
	std::vector<glm::dvec3> points;
	std::vector<double> weights;
	double mean_square = 0.0;
	for (const Pattern& variant : tile.variants)
	{
		checkVariant(variant, base.count());
		mean_square += planeErrorOf(variant) * planeErrorOf(variant) / 16.0;
		points.insert(points.end(), variant.points.begin(), variant.points.end());
		for (const double w : variant.weights)
		{
			weights.push_back(w / 16.0);
		}
	}
	CHECK(std::sqrt(squaredError(Domain::disk, Ensemble::plane, Part::whole, points, weights)) < std::get<1>(figures));
	CHECK(std::sqrt(mean_square) < std::get<2>(figures) * planeErrorOf(base));
}

TEST_CASE("tile: variants keep the symmetry of their base, and all kinds and sizes work", "[pattern]")
{
	Recipe recipe = recipeOf(Domain::disk, 5);
	recipe.symmetric = true;
	const Pattern base = generatePattern(recipe);
	for (const int size : {2, 3, 5, 8})
	{
		for (const TileKind kind : {TileKind::points, TileKind::transform, TileKind::even, TileKind::random})
		{
			TileRecipe settings;
			settings.size = size;
			settings.kind = kind;
			settings.starts = kind == TileKind::points || kind == TileKind::transform ? 1 : 0;
			const PatternTile tile = generateTile(base, settings, RunSettings{2, {}});
			REQUIRE(tile.variants.size() == static_cast<std::size_t>(size * size));
			for (const Pattern& variant : tile.variants)
			{
				CHECK(variant.points[0] == glm::dvec3(0.0));
				CHECK(variant.points[1] == -variant.points[2]);
				CHECK(variant.points[3] == -variant.points[4]);
			}
		}
	}
	for (const Domain domain : {Domain::ball, Domain::hemisphere})
	{
		const Pattern other = generatePattern(recipeOf(domain, 6));
		TileRecipe settings;
		settings.starts = 1;
		CHECK(generateTile(other, settings).variants.size() == 16);
		settings.starts = 0;
		settings.kind = TileKind::random;
		CHECK(generateTile(other, settings).variants.size() == 16);
	}
}

TEST_CASE("tile: filters by name, and halves of their taps", "[pattern]")
{
	for (const char* const name : {"box", "box:0", "box:65", "box:2.5", "gauss:0", "gauss:9", "bilateral:4", "bilateral:1",
								   "mean:3", "", "box:3x", "binomial:", "gauss:nan", "box:1e9"})
	{
		INFO(name);
		CHECK_THROWS(tileFilterNamed(name));
	}
	CHECK(tileFilterNamed("binomial:3").taps ==
		  std::vector<double>{1.0 / 16, 2.0 / 16, 1.0 / 16, 2.0 / 16, 4.0 / 16, 2.0 / 16, 1.0 / 16, 2.0 / 16, 1.0 / 16});
	CHECK(nameAndShare("box:4@2.5") == std::pair<std::string, double>{"box:4", 2.5});
	CHECK_THROWS(nameAndShare("box:4@0"));
	CHECK_THROWS(nameAndShare("box:4@x"));
	for (const TileFilter& half : halvesOf(tileFilterNamed("box:4")))
	{
		CHECK(std::count_if(half.taps.begin(), half.taps.end(), [](double tap) { return tap == 0.125; }) == 8);
	}
	for (const TileFilter& half : halvesOf(tileFilterNamed("bilateral:5")))
	{
		CHECK(half.taps[12] > 0.0); // the centre tap remains
	}
}

TEST_CASE("tile: prefixes of ordered variants err less, and what is whole stays as it is", "[pattern]")
{
	for (const bool symmetric : {false, true})
	{
		Recipe recipe = recipeOf(Domain::disk, 9);
		recipe.symmetric = symmetric;
		const Pattern base = generatePattern(recipe, RunSettings{2, {}});
		TileRecipe settings;
		settings.starts = 1;
		const PatternTile plain = generateTile(base, settings);
		settings.progressive = true;
		const PatternTile ordered = generateTile(base, settings);
		double before = 0.0;
		double after = 0.0;
		for (std::size_t v = 0; v < plain.variants.size(); ++v)
		{
			CHECK(planeErrorOf(ordered.variants[v]) == Approx(planeErrorOf(plain.variants[v])).epsilon(1e-9));
			CHECK((!symmetric || ordered.variants[v].points[0] == glm::dvec3(0.0)));
			for (std::size_t count = symmetric ? 3 : 1; count < base.count(); count += symmetric ? 2 : 1)
			{
				before += planeErrorOf(prefixOf(plain.variants[v], count));
				after += planeErrorOf(prefixOf(ordered.variants[v], count));
				CHECK((!symmetric || ordered.variants[v].points[count - 1] == -ordered.variants[v].points[count - 2]));
			}
		}
		CHECK(after < before);
		// Behind the window's mean, where errors common to all prefixes remain.
		const TileShares window = sharesOf(4, tileFilterNamed("box:4"));
		const auto prefixes = [](PatternTile tile, std::size_t count)
		{
			for (Pattern& variant : tile.variants)
			{
				variant = prefixOf(variant, count);
			}
			return tile;
		};
		CHECK(errorOf(prefixes(ordered, 5), window) < 0.75 * errorOf(prefixes(plain, 5), window));
	}
	TileRecipe settings;
	settings.progressive = true;
	settings.kind = TileKind::even;
	CHECK_THROWS(generateTile(generatePattern(recipeOf(Domain::disk, 4)), settings));
}

TEST_CASE("tile: more memory than may be taken is refused before work", "[pattern]")
{
	const Pattern base = generatePattern(recipeOf(Domain::disk, 4));
	TileRecipe recipe;
	recipe.size = 128;
	recipe.filters = {tileFilterNamed("binomial:3")};
	recipe.frames = 32;
	const uint64_t need = tileMemory(recipe, base, 2);
	CHECK_NOTHROW(checkTileSize(recipe, base, need, 2));
	CHECK_NOTHROW(checkTileSize(recipe, base, 0, 2));
	CHECK_THROWS_WITH(checkTileSize(recipe, base, uint64_t{1} << 30U, 2),
					  Catch::StartsWith("memory: found a need of about ") &&
						  Catch::EndsWith(" MiB for 2097152 samples, expected at most 1024 MiB; or a tile that moves"));
	recipe.moves = true;
	CHECK(tileMemory(recipe, base, 2) < need / 8);
}
