// SPDX-License-Identifier: GPL-3.0-or-later
#include "tile_errors.h"

#include "pattern/recipe.h"
#include "pattern/tile_parts.h"

#include <catch2/catch.hpp>

#include <glm/geometric.hpp>

using namespace nook;

namespace
{

// Like errorOf, by moments between variants.
double errorByMoments(const PatternTile& tile, TileMoments& by_moments, EnergyGradient& gradient, int threads = 1)
{
	std::vector<glm::dvec3> points;
	std::vector<double> weights;
	for (const Pattern& variant : tile.variants)
	{
		points.insert(points.end(), variant.points.begin(), variant.points.end());
		weights.insert(weights.end(), variant.weights.begin(), variant.weights.end());
	}
	return by_moments(points, weights, gradient, threads);
}

} // namespace

TEST_CASE("tile moments: nearly the exact error, between frames alike and not alike in time, and of one tile that moves",
		  "[pattern]")
{
	const TileFilter filter = tileFilterNamed("binomial:3");
	for (const Domain domain : {Domain::disk, Domain::ball, Domain::hemisphere})
	{
		for (const bool moves : {false, true})
		{
			const TileTime time{4, 0.3, moves ? tileMoves(3, 4) : std::vector<glm::ivec2>{}};
			PatternTile tile = scattered(domain, 3, time, 4);
			for (Pattern& variant : tile.variants)
			{
				for (glm::dvec3& p : variant.points)
				{
					p.z = domain == Domain::hemisphere ? std::sqrt(1.0 - p.x * p.x - p.y * p.y) : p.z;
				}
			}
			for (const glm::ivec2 pan : {glm::ivec2(0, 0), glm::ivec2(1, 0)}) // a pan makes the weights asymmetric in time
			{
				const TileShares shares = sharesOf(3, filter, time, 0, pan);
				EnergyGradient exact_gradient;
				EnergyGradient gradient;
				const double exact = errorOf(tile, shares, &exact_gradient);
				INFO(nameOf(domain) << ", moves " << moves << ", pan " << pan.x);
				// Half-spaces that only the dropped part of the kernel distinguishes: a few per cent of the variants' errors.
				TileMoments by_moments(domain, shares);
				CHECK(errorByMoments(tile, by_moments, gradient) == Approx(exact).epsilon(0.03));
				double difference2 = 0.0;
				double all2 = 0.0;
				for (std::size_t i = 0; i < gradient.points.size(); ++i)
				{
					const glm::dvec3 flat(1.0, 1.0, domain == Domain::ball ? 1.0 : 0.0); // z is determined on the hemisphere
					const glm::dvec3 by_point = flat * exact_gradient.points[i];
					difference2 +=
						domain == Domain::hemisphere ? 0.0 : glm::dot(gradient.points[i] - by_point, gradient.points[i] - by_point);
					all2 += glm::dot(by_point, by_point);
				}
				CHECK(difference2 < 0.01 * all2);
			}
		}
	}
}

TEST_CASE("tile moments: the gradient of finite differences, whatever the threads", "[pattern]")
{
	for (const Domain domain : {Domain::disk, Domain::ball})
	{
		const TileTime time{3, 0.3, {}};
		const TileShares shares = sharesOf(2, tileFilterNamed("gauss:0.7"), time, 0);
		PatternTile tile = scattered(domain, 2, time, 3);
		EnergyGradient gradient;
		EnergyGradient other;
		TileMoments by_moments(domain, shares);
		const double value = errorByMoments(tile, by_moments, gradient);
		CHECK(value == errorByMoments(tile, by_moments, other, 3));
		CHECK(gradient.points == other.points);
		CHECK(gradient.weights == other.weights);
		for (const std::size_t i : {0U, 7U, 35U})
		{
			glm::dvec3& point = tile.variants[i / 3].points[i % 3];
			constexpr double h = 1e-6;
			for (int axis = 0; axis < (domain == Domain::ball ? 3 : 2); ++axis)
			{
				point[axis] += h;
				const double above = errorByMoments(tile, by_moments, other);
				point[axis] -= 2.0 * h;
				CHECK(gradient.points[i][axis] ==
					  Approx((above - errorByMoments(tile, by_moments, other)) / (2.0 * h)).margin(1e-9));
				point[axis] += h;
			}
		}
	}
}

TEST_CASE("tile: very many samples are made by moments, about as good and the same on any number of threads", "[pattern]")
{
	const Pattern base = generatePattern(recipeOf(Domain::disk, 16), RunSettings{2, {}});
	TileRecipe recipe;
	recipe.size = 12;
	recipe.filters = {tileFilterNamed("binomial:3")};
	recipe.frames = 8;
	REQUIRE(stepsOfError(sharesOf(12, recipe.filters[0], {8, 0.1, {}}, 0), 16) > 0x1p24);
	const PatternTile tile = generateTile(base, recipe, RunSettings{2, {}});
	REQUIRE(tile.variants.size() == 1152);
	const TileFilter none = tileFilterNamed("none");
	const TileTime time{8, 0.1, {}};
	CHECK(std::sqrt(errorOf(tile, sharesOf(12, none, time))) < 1.4 * planeErrorOf(base));
	CHECK(std::sqrt(errorOf(tile, sharesOf(12, recipe.filters[0], time))) < 0.38 * planeErrorOf(base));
	CHECK(generateTile(base, recipe, RunSettings{1, {}}).variants[700].points == tile.variants[700].points);
}
