// SPDX-License-Identifier: GPL-3.0-or-later
// Errors behind a filter and over frames, and the tiles optimised for them.
#include "tile_errors.h"

#include "pattern/recipe.h"

#include <catch2/catch.hpp>

#include <glm/geometric.hpp>

#include <string>

using namespace nook;

namespace
{

// The mean squared error over all pixels and frames, evaluating each as one weighted pattern.
double squaredErrorByUnions(const PatternTile& tile, const TileFilter& filter, const TileTime& time, int last, glm::ivec2 pan)
{
	const int lags = last > 0 ? last : time.ema == 1.0 ? 1 : 400;
	double sum = 0.0;
	int pixels = 0;
	for (int frame = 0; frame < time.frames; ++frame)
	{
		for (int pixel = 0; pixel < tile.size * tile.size; ++pixel, ++pixels)
		{
			std::vector<glm::dvec3> points;
			std::vector<double> weights;
			double share = last > 0 ? 1.0 / last : time.ema;
			for (int lag = 0; lag<lags; ++lag, share *= last> 0 ? 1.0 : 1.0 - time.ema)
			{
				for (int tap = 0; tap < static_cast<int>(filter.taps.size()); ++tap)
				{
					const int x = pixel % tile.size + tap % filter.width - lag * pan.x + 4000 * tile.size;
					const int y = pixel / tile.size + tap / filter.width - lag * pan.y + 4000 * tile.size;
					const int variant = variantOfFrame(tile, frame - lag + 400 * tile.frames);
					const int area = tile.size * tile.size;
					const int row =
						variant / area * area + (y + variant / tile.size) % tile.size * tile.size + (x + variant) % tile.size;
					const Pattern& pattern = tile.variants[static_cast<std::size_t>(row)];
					points.insert(points.end(), pattern.points.begin(), pattern.points.end());
					for (const double w : pattern.weights)
					{
						weights.push_back(w * share * filter.taps[static_cast<std::size_t>(tap)]);
					}
				}
			}
			sum += squaredError(tile.domain, Ensemble::plane, Part::whole, points, weights);
		}
	}
	return sum / pixels;
}

} // namespace

TEST_CASE("tile: the error behind a filter is that of the pattern seen at each pixel", "[pattern]")
{
	const TileFilter binomial = tileFilterNamed("binomial:3");
	const TileFilter box = tileFilterNamed("box:4"); // wider than the tile: taps wrap around
	const TileFilter none = tileFilterNamed("none");
	for (const Domain domain : {Domain::disk, Domain::ball})
	{
		const PatternTile still = scattered(domain, 3, {}, 2);
		for (const TileFilter& filter : {binomial, box, none})
		{
			CHECK(errorOf(still, sharesOf(3, filter)) == Approx(squaredErrorByUnions(still, filter, {}, 1, {0, 0})).epsilon(1e-9));
		}
	}
	const TileTime sequence{3, 0.4, {}};
	const TileTime moving{3, 0.4, tileMoves(2, 3)};
	for (const TileTime& time : {sequence, moving})
	{
		const PatternTile tile = scattered(Domain::ball, 2, time, 1);
		for (const glm::ivec2 pan : {glm::ivec2(0, 0), glm::ivec2(1, 0), glm::ivec2(-3, 2)})
		{
			CHECK(errorOf(tile, sharesOf(2, none, time, 2, pan)) ==
				  Approx(squaredErrorByUnions(tile, none, time, 2, pan)).epsilon(1e-9));
			CHECK(errorOf(tile, sharesOf(2, binomial, time, 1, pan)) ==
				  Approx(squaredErrorByUnions(tile, binomial, time, 1, pan)).epsilon(1e-9));
		}
		CHECK(errorOf(tile, sharesOf(2, none, time, 0)) == Approx(squaredErrorByUnions(tile, none, time, 0, {0, 0})).epsilon(1e-6));
	}
}

TEST_CASE("tile: the error behind a filter has the gradient of finite differences", "[pattern]")
{
	const TileTime time{2, 0.3, {}};
	const TileShares shares = sharesOf(2, tileFilterNamed("gauss:0.7"), time, 0);
	PatternTile tile = scattered(Domain::disk, 2, time, 3);
	EnergyGradient gradient;
	errorOf(tile, shares, &gradient);
	for (const std::size_t i : {0u, 7u, 23u})
	{
		glm::dvec3& point = tile.variants[i / 3].points[i % 3];
		double& weight = tile.variants[i / 3].weights[i % 3];
		constexpr double h = 1e-6;
		point.x += h;
		const double above = errorOf(tile, shares);
		point.x -= 2.0 * h;
		CHECK(gradient.points[i].x == Approx((above - errorOf(tile, shares)) / (2.0 * h)).margin(1e-9));
		point.x += h;
		weight += h;
		const double heavier = errorOf(tile, shares);
		weight -= 2.0 * h;
		CHECK(gradient.weights[i] == Approx((heavier - errorOf(tile, shares)) / (2.0 * h)).margin(1e-9));
		weight += h;
	}
}

TEST_CASE("tile: filters' tiles are good behind them, and their variants by themselves", "[pattern]")
{
	const Pattern base = generatePattern(recipeOf(Domain::disk, 9), RunSettings{2, {}});
	const auto [filter, limit] = GENERATE(table<const char*, double>(
		{{"box:3", 0.0036}, {"binomial:3", 0.0037}, {"gauss:1", 0.0023}, {"bilateral:5", 0.0014}, {"box:4", 0.00125}}));
	INFO(filter);
	TileRecipe recipe;
	recipe.filters = {tileFilterNamed(filter)};
	recipe.starts = 2;
	const PatternTile tile = generateTile(base, recipe, RunSettings{2, {}});
	CHECK(std::sqrt(errorOf(tile, sharesOf(4, recipe.filters[0]))) < limit);
	CHECK(std::sqrt(errorOf(tile, sharesOf(4, tileFilterNamed("none")))) < 1.25 * planeErrorOf(base));
	// A tile made only for its window is worse behind any other filter.
	if (std::string(filter) != "box:4")
	{
		CHECK(std::sqrt(errorOf(generateTile(base, {}, RunSettings{2, {}}), sharesOf(4, recipe.filters[0]))) > 1.05 * limit);
	}
}

TEST_CASE("tile: frames of their own and one tile that moves", "[pattern]")
{
	const Pattern base = generatePattern(recipeOf(Domain::disk, 5), RunSettings{2, {}});
	TileRecipe recipe;
	recipe.size = 3;
	recipe.filters = {tileFilterNamed("box:3")};
	recipe.frames = 4;
	recipe.starts = 1;
	const PatternTile sequence = generateTile(base, recipe, RunSettings{1, {}});
	CHECK(sequence.variants.size() == 36);
	recipe.moves = true;
	const PatternTile moving = generateTile(base, recipe, RunSettings{1, {}});
	CHECK(moving.variants.size() == 9);
	REQUIRE(moving.moves.size() == 4);
	const TileFilter none = tileFilterNamed("none");
	for (const PatternTile* const tile : {&sequence, &moving})
	{
		const TileTime time{4, 0.1, tile->moves};
		const double one = std::sqrt(errorOf(*tile, sharesOf(3, none, time)));
		CHECK(one < 1.5 * planeErrorOf(base));
		// Four independent variants would halve it.
		CHECK(std::sqrt(errorOf(*tile, sharesOf(3, none, time, 0))) < 0.4 * one);
		CHECK(std::sqrt(errorOf(*tile, sharesOf(3, recipe.filters[0], time, 0))) < 0.15 * one);
	}
	// Two frames after a cut, better than two independent variants.
	const TileTime time{4, 0.1, {}};
	const double behind = std::sqrt(errorOf(sequence, sharesOf(3, recipe.filters[0], time)));
	CHECK(std::sqrt(errorOf(sequence, sharesOf(3, recipe.filters[0], time, 2))) < 0.69 * behind);
	const PatternTile again = generateTile(base, recipe, RunSettings{2, {}});
	CHECK(again.variants[5].points == moving.variants[5].points);
}

TEST_CASE("tile: over frames points and directions gain as lines do", "[pattern]")
{
	for (const Domain domain : {Domain::ball, Domain::hemisphere})
	{
		const Pattern base = generatePattern(recipeOf(domain, 5), RunSettings{2, {}});
		TileRecipe recipe;
		recipe.filters = {tileFilterNamed("box:4")};
		recipe.frames = 16;
		const PatternTile tile = generateTile(base, recipe, RunSettings{2, {}});
		const TileTime time{16, 0.1, {}};
		const double one = std::sqrt(errorOf(tile, sharesOf(4, recipe.filters[0], time)));
		CHECK(one < 0.2 * planeErrorOf(base));
		CHECK(std::sqrt(errorOf(tile, sharesOf(4, recipe.filters[0], time, 0))) < 0.25 * one);
		for (const Pattern& variant : tile.variants)
		{
			for (const glm::dvec3& p : variant.points)
			{
				CHECK((glm::length(p) <= 1.0 + 1e-6 && (domain == Domain::ball || p.z >= 0.0)));
			}
		}
	}
}
