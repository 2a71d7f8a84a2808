// SPDX-License-Identifier: GPL-3.0-or-later
#include "testing.h"

#include "pattern/energy.h"
#include "pattern/pattern.h"
#include "pattern/recipe.h"
#include "pattern/tile.h"
#include "pattern/tile_parts.h"

namespace
{

Recipe recipeOf(Domain domain, int count)
{
	Recipe recipe{.domain = domain, .count = count};
	return recipe;
}

double planeErrorOf(const Pattern& p)
{
	return std::sqrt(squaredError(p.domain, Ensemble::plane, Part::whole, p.points, p.weights));
}

// A tile of random, unoptimised points.
PatternTile scattered(Domain domain, int size, const TileTime& time, std::size_t count)
{
	PatternTile tile;
	tile.domain = domain;
	tile.size = size;
	tile.frames = time.frames;
	tile.moves = time.moves;
	unsigned index = 1;
	for (int v = 0; v < size * size * layersOf(tile); ++v)
	{
		Pattern variant;
		variant.domain = domain;
		for (std::size_t i = 0; i < count; ++i, ++index)
		{
			variant.points.emplace_back(radicalInverse(index, 2) - 0.5, radicalInverse(index, 3) - 0.5,
										domain == Domain::ball ? radicalInverse(index, 5) - 0.5 : 0.0);
			variant.weights.push_back((1.0 + radicalInverse(index, 7)));
		}
		const double sum = std::accumulate(variant.weights.begin(), variant.weights.end(), 0.0);
		for (double& w : variant.weights)
		{
			w /= sum;
		}
		tile.variants.push_back(variant);
	}
	return tile;
}

double errorOf(const PatternTile& tile, const TileShares& shares, EnergyGradient* gradient = nullptr)
{
	std::vector<glm::dvec3> points;
	std::vector<double> weights;
	for (const Pattern& variant : tile.variants)
	{
		points.insert(points.end(), variant.points.begin(), variant.points.end());
		weights.insert(weights.end(), variant.weights.begin(), variant.weights.end());
	}
	return tileSquaredError(tile.domain, shares, points, weights, gradient);
}

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
		for (const TileKind kind : {TileKind::points, TileKind::even, TileKind::random})
		{
			TileRecipe settings{.size = size, .kind = kind, .starts = kind == TileKind::points ? 1 : 0};
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
		TileRecipe settings{.starts = 1};
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
		TileRecipe settings{.starts = 1};
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
	TileRecipe settings{.kind = TileKind::even, .progressive = true};
	CHECK_THROWS(generateTile(generatePattern(recipeOf(Domain::disk, 4)), settings));
}

TEST_CASE("tile: more memory than may be taken is refused before work", "[pattern]")
{
	const Pattern base = generatePattern(recipeOf(Domain::disk, 4));
	TileRecipe recipe{.size = 128, .filters = {tileFilterNamed("binomial:3")}, .frames = 32};
	const uint64_t need = tileMemory(recipe, base, 2);
	CHECK_NOTHROW(checkTileSize(recipe, base, need, 2));
	CHECK_NOTHROW(checkTileSize(recipe, base, 0, 2));
	CHECK_THROWS_WITH(checkTileSize(recipe, base, uint64_t{1} << 30U, 2),
					  Catch::StartsWith("memory: found a need of about ") &&
						  Catch::EndsWith(" MiB for 2097152 samples, expected at most 1024 MiB; or a tile that moves"));
	recipe.moves = true;
	CHECK(tileMemory(recipe, base, 2) < need / 8);
}

TEST_CASE("tile moments: nearly the exact error, between frames alike and not alike in time, and of one tile that moves",
		  "[pattern]")
{
	const TileFilter filter = tileFilterNamed("binomial:3");
	const Domain domain = GENERATE(Domain::disk, Domain::ball, Domain::hemisphere);
	const bool moves = GENERATE(false, true);
	const TileTime time{4, 0.3, moves ? tileMoves(3, 4) : std::vector<glm::ivec2>{}};
	PatternTile tile = scattered(domain, 3, time, 4);
	for (Pattern& variant : tile.variants)
	{
		for (glm::dvec3& p : variant.points)
		{
			p.z = domain == Domain::hemisphere ? std::sqrt(1.0 - p.x * p.x - p.y * p.y) : p.z;
		}
	}
	const glm::ivec2 pan = GENERATE(glm::ivec2(0, 0), glm::ivec2(1, 0)); // a pan makes the weights asymmetric in time
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
		difference2 += domain == Domain::hemisphere ? 0.0 : glm::dot(gradient.points[i] - by_point, gradient.points[i] - by_point);
		all2 += glm::dot(by_point, by_point);
	}
	CHECK(difference2 < 0.01 * all2);
}

TEST_CASE("tile moments: the gradient of finite differences, whatever the threads", "[pattern]")
{
	const Domain domain = GENERATE(Domain::disk, Domain::ball);
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
	const std::size_t i = GENERATE(0U, 7U, 35U);
	glm::dvec3& point = tile.variants[i / 3].points[i % 3];
	constexpr double h = 1e-6;
	for (int axis = 0; axis < (domain == Domain::ball ? 3 : 2); ++axis)
	{
		point[axis] += h;
		const double above = errorByMoments(tile, by_moments, other);
		point[axis] -= 2.0 * h;
		CHECK(gradient.points[i][axis] == Approx((above - errorByMoments(tile, by_moments, other)) / (2.0 * h)).margin(1e-9));
		point[axis] += h;
	}
}

TEST_CASE("tile: very many samples are made by moments, about as good and the same on any number of threads", "[pattern]")
{
	Recipe spiral = recipeOf(Domain::disk, 200);
	spiral.method = Method::vogel;
	const Pattern base = generatePattern(spiral, RunSettings{2, {}});
	TileRecipe recipe{.size = 3, .filters = {tileFilterNamed("binomial:3")}, .frames = 4};
	REQUIRE(stepsOfError(sharesOf(3, recipe.filters[0], {4, 0.1, {}}, 0), 200) > 0x1p24);
	const PatternTile tile = generateTile(base, recipe, RunSettings{2, {}});
	REQUIRE(tile.variants.size() == 36);
	const TileFilter none = tileFilterNamed("none");
	const TileTime time{4, 0.1, {}};
	CHECK(std::sqrt(errorOf(tile, sharesOf(3, none, time))) < 1.4 * planeErrorOf(base));
	CHECK(std::sqrt(errorOf(tile, sharesOf(3, recipe.filters[0], time))) < 0.38 * planeErrorOf(base));
	CHECK(generateTile(base, recipe, RunSettings{1, {}}).variants[20].points == tile.variants[20].points);
}

TEST_CASE("tile: the error of slices is that over periodic intervals and boxes, with its gradient", "[pattern]")
{
	Pattern slices = slicePattern(5);
	slices.points[1] = {0.83, 0.05, 0.0};
	CHECK(planeErrorOf(slices) == Approx(std::sqrt(squaredErrorByIntervals(slices, 100000))).epsilon(2e-3));
	EnergyGradient gradient;
	squaredError(slices.domain, Ensemble::plane, Part::whole, slices.points, slices.weights, &gradient);
	const int axis = GENERATE(0, 1);
	constexpr double h = 1e-6;
	Pattern moved = slices;
	moved.points[1][axis] += h;
	const double above = planeErrorOf(moved);
	moved.points[1][axis] -= 2.0 * h;
	const double below = planeErrorOf(moved);
	CHECK(gradient.points[1][axis] == Approx((above * above - below * below) / (2.0 * h)).margin(1e-8));
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
		GENERATE(table<const char*, double>({{"box:3", 0.8}, {"binomial:3", 0.72}, {"bilateral:5", 1.0}, {"box:4", 1.0}}));
	INFO(name);
	TileRecipe recipe{.filters = {tileFilterNamed(name)}};
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
				TileRecipe recipe{.size = size};
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
				CHECK((size == 8 || generateTile(base, recipe, run).variants.back().points != tile.variants.back().points));
			}
		}
	}
}

TEST_CASE("tile: copies of a smaller tile where frames move it, and transforms that make the variants", "[pattern]")
{
	const RunSettings run{2, {}};
	TileRecipe recipe{.size = 6, .filters = {tileFilterNamed("box:2")}, .frames = 4, .moves = true};
	const PatternTile moved = generateTile(slicePattern(1), recipe, run);
	CHECK((moved.variants.size() == 36 && moved.moves.size() == 4));
	recipe = {};
	recipe.size = 6;
	recipe.kind = TileKind::random;
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

// Errors behind a filter and over frames, and the tiles optimised for them.

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
	const std::size_t i = GENERATE(0u, 7u, 23u);
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

TEST_CASE("tile: filters' tiles are good behind them, and their variants by themselves", "[pattern]")
{
	const Pattern base = generatePattern(recipeOf(Domain::disk, 9), RunSettings{2, {}});
	const auto [filter, limit] = GENERATE(table<const char*, double>(
		{{"box:3", 0.0036}, {"binomial:3", 0.0037}, {"gauss:1", 0.0023}, {"bilateral:5", 0.00125}, {"box:4", 0.00125}}));
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
	const Domain domain = GENERATE(Domain::ball, Domain::hemisphere);
	const Pattern base = generatePattern(recipeOf(domain, 5), RunSettings{2, {}});
	TileRecipe recipe{.filters = {tileFilterNamed("box:4")}, .frames = 16};
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
