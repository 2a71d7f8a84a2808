// SPDX-License-Identifier: GPL-3.0-or-later
#include "tile_errors.h"

#include "core/error.h"
#include "pattern/recipe.h"

#include <catch2/catch.hpp>

#include <limits>

using namespace nook;

namespace
{

// Squared error of the pattern's share in an interval of azimuths, one of jitters, and a box of both, on the torus.
double squaredErrorByIntervals(const Pattern& p, int count)
{
	double sum = 0.0;
	for (int k = 1; k <= count; ++k)
	{
		const auto index = static_cast<unsigned>(k);
		const double from[2] = {radicalInverse(index, 2), radicalInverse(index, 3)};
		const double length[2] = {radicalInverse(index, 5), radicalInverse(index, 7)};
		double error[3] = {length[0], length[1], length[0] * length[1]};
		for (std::size_t i = 0; i < p.count(); ++i)
		{
			const bool in_x = fraction(p.points[i].x - from[0]) < length[0];
			const bool in_y = fraction(p.points[i].y - from[1]) < length[1];
			error[0] -= in_x ? p.weights[i] : 0.0;
			error[1] -= in_y ? p.weights[i] : 0.0;
			error[2] -= in_x && in_y ? p.weights[i] : 0.0;
		}
		sum += (error[0] * error[0] + error[1] * error[1] + error[2] * error[2]) / (3.0 * count);
	}
	return sum;
}

} // namespace

TEST_CASE("tile: the error of slices is that over periodic intervals and boxes, with its gradient", "[pattern]")
{
	Pattern slices = slicePattern(5);
	slices.points[1] = {0.83, 0.05, 0.0};
	CHECK(planeErrorOf(slices) == Approx(std::sqrt(squaredErrorByIntervals(slices, 100000))).epsilon(2e-3));
	EnergyGradient gradient;
	squaredError(slices.domain, Ensemble::plane, Part::whole, slices.points, slices.weights, &gradient);
	for (const int axis : {0, 1})
	{
		constexpr double h = 1e-6;
		Pattern moved = slices;
		moved.points[1][axis] += h;
		const double above = planeErrorOf(moved);
		moved.points[1][axis] -= 2.0 * h;
		const double below = planeErrorOf(moved);
		CHECK(gradient.points[1][axis] == Approx((above * above - below * below) / (2.0 * h)).margin(1e-8));
	}
}

TEST_CASE("tile: slices are better behind a filter than those of the kernel, and over frames", "[pattern]")
{
	PatternTile kernels; // nookSliceVariant and its reversed bits, as azimuth and jitter
	kernels.domain = Domain::slice;
	kernels.size = 4;
	for (const unsigned place : {0u, 8u, 2u, 10u, 12u, 4u, 14u, 6u, 3u, 11u, 1u, 9u, 15u, 7u, 13u, 5u})
	{
		Pattern one = slicePattern(1);
		one.points[0] = {(place + 0.5) / 16.0, radicalInverse(place, 2) + 0.5 / 16.0, 0.0};
		kernels.variants.push_back(one);
	}
	const auto [name, share] =
		GENERATE(table<const char*, double>({{"box:3", 0.8}, {"binomial:3", 0.72}, {"bilateral:5", 0.98}, {"box:4", 1.0}}));
	INFO(name);
	TileRecipe recipe;
	recipe.filters = {tileFilterNamed(name)};
	const TileShares shares = sharesOf(4, recipe.filters[0]);
	const PatternTile tile = generateTile(slicePattern(1), recipe, RunSettings{2, {}});
	CHECK(std::sqrt(errorOf(tile, shares)) <= share * std::sqrt(errorOf(kernels, shares)));
	CHECK(generateTile(slicePattern(1), recipe, RunSettings{1, {}}).variants[7].points == tile.variants[7].points);
	for (const Pattern& variant : tile.variants)
	{
		CHECK((variant.points[0].x >= 0.0 && variant.points[0].x < 1.0 && variant.points[0].y >= 0.0 && variant.points[0].y < 1.0));
	}
	recipe.frames = 16;
	const PatternTile frames = generateTile(slicePattern(1), recipe, RunSettings{2, {}});
	const TileTime time{16, 0.1, {}};
	// Sixteen independent frames with those weights would have about a third of one frame's error.
	CHECK(std::sqrt(errorOf(frames, sharesOf(4, recipe.filters[0], time, 0))) <
		  0.3 * std::sqrt(errorOf(frames, sharesOf(4, recipe.filters[0], time))));
	CHECK(std::sqrt(errorOf(frames, sharesOf(4, recipe.filters[0], time))) < 1.5 * std::sqrt(errorOf(tile, shares)));
	recipe.kind = TileKind::even;
	recipe.filters.clear();
	recipe.frames = 1;
	CHECK_THROWS_AS(generateTile(slicePattern(1), recipe), Error);
}

TEST_CASE("tile: larger tiles are no worse than copies of smaller ones, and every seed makes another", "[pattern]")
{
	const RunSettings run{2, {}};
	const Pattern disk = generatePattern(recipeOf(Domain::disk, 3), run);
	for (const Pattern& base : {slicePattern(1), slicePattern(2), disk})
	{
		for (const char* const filter : {"box:4", "binomial:3", "none", ""})
		{
			INFO(nameOf(base.domain) << ' ' << base.count() << " samples, filter '" << filter << "'");
			double least = std::numeric_limits<double>::infinity();
			for (const int size : {2, 4, 8})
			{
				TileRecipe recipe;
				recipe.size = size;
				if (*filter != '\0')
				{
					recipe.filters = {tileFilterNamed(filter)};
				}
				TileShares seen{size, 1, std::vector<double>(static_cast<std::size_t>(size * size), 1.0 / (size * size))};
				seen = *filter != '\0' ? sharesOf(size, recipe.filters[0]) : seen;
				const PatternTile tile = generateTile(base, recipe, run);
				const double error = errorOf(tile, seen);
				CHECK(error <= least * (1.0 + 1e-9));
				least = std::min(least, error);
				recipe.seed = 2;
				CHECK(generateTile(base, recipe, run).variants.back().points != tile.variants.back().points);
			}
		}
	}
}

TEST_CASE("tile: copies of a smaller tile where frames move it, and turned ones keep their transforms", "[pattern]")
{
	const RunSettings run{2, {}};
	TileRecipe recipe;
	recipe.size = 6;
	recipe.filters = {tileFilterNamed("box:2")};
	recipe.frames = 4;
	recipe.moves = true;
	const PatternTile moved = generateTile(slicePattern(1), recipe, run);
	CHECK((moved.variants.size() == 36 && moved.moves.size() == 4));
	recipe = {};
	recipe.size = 6;
	recipe.kind = TileKind::transform;
	recipe.starts = 1;
	const Pattern disk = generatePattern(recipeOf(Domain::disk, 3), run);
	const PatternTile turned = generateTile(disk, recipe, run);
	REQUIRE(turned.transforms.size() == 36);
	for (std::size_t v = 0; v < 36; ++v)
	{
		const TileTransform& t = turned.transforms[v];
		const double x = t.scale * (t.cos * disk.points[0].x - t.sin * t.handedness * disk.points[0].y);
		CHECK(turned.variants[v].points[0].x == Approx(x).margin(1e-6));
	}
}
