// SPDX-License-Identifier: GPL-3.0-or-later
// The mean of K variants' estimates over the window is the estimate of all their points together with weights / K. So the window's
// squared error is the energy distance of the union, and a tile is made by one descent on window² + λ · mean of the variants'
// plane².
#include "pattern/tile.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/lists.h"
#include "core/round.h"
#include "core/text.h"
#include "pattern/tile_parts.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>

namespace nook
{

namespace
{

constexpr double kPointsLambda = 0.05;
constexpr double kFilterLambda = 0.12; // with less, single variants exceed 1.25 times the base's error behind a binomial filter
constexpr double kFramesLambda = 1.0;  // with less, single variants exceed 1.25 times the base's error
constexpr double kPrefix = 0.3;        // weight of the means of 2, 4, 8, … frames relative to that of all
constexpr int kPannedSize = 8; // panning brings distant pixels together; in a large tile that involves every pair of variants

std::string tileCommandOn(const TileRecipe& recipe, const std::string& base)
{
	const TileRecipe plain;
	std::string command = "nook tile " + base + " --size " + std::to_string(recipe.size);
	command += recipe.kind != plain.kind ? " --kind " + std::string(nameOf(recipe.kind)) : "";
	command += recipe.lambda != plain.lambda ? " --lambda " + numberText(recipe.lambda) : "";
	for (const TileFilter& filter : recipe.filters)
	{
		command += " --filter " + filter.name + (filter.share != 1.0 ? "@" + numberText(filter.share) : "");
	}
	command += recipe.robust ? " --robust" : "";
	command += recipe.frames > 1 ? " --frames " + std::to_string(recipe.frames) + " --ema " + numberText(recipe.ema) : "";
	command += recipe.moves ? " --moves" : "";
	command += recipe.progressive ? " --progressive" : "";
	command += recipe.starts != plain.starts ? " --starts " + std::to_string(recipe.starts) : "";
	command += recipe.seed != plain.seed ? " --seed " + std::to_string(recipe.seed) : "";
	return command;
}

// Memory per sample of the finished tile, its measurement and its text, measured: docs/measurements/patterns.md.
constexpr uint64_t kFinishedBytes = 400;

TileTime timeOf(const TileRecipe& recipe)
{
	return {recipe.frames, recipe.ema, recipe.moves ? tileMoves(recipe.size, recipe.frames) : std::vector<glm::ivec2>{}};
}

void checkTileFilters(const TileRecipe& recipe)
{
	for (const TileFilter& filter : recipe.filters)
	{
		refuseIf(stepsOfShares(recipe.size, filter, timeOf(recipe)) > kMaxShareSteps,
				 "filter: found " + filter.name + " with " + std::to_string(filter.taps.size()) +
					 " taps, expected fewer, or fewer frames, for a tile of this size",
				 ExitCode::invalid_input);
	}
}

void checkTime(const TileRecipe& recipe)
{
	refuseIf(recipe.frames < 1 || recipe.frames > kMaxTileFrames, "frames: expected a whole number from 1 to 64");
	refuseIf(!(recipe.ema > 0.0 && recipe.ema <= 1.0), "ema: expected a number above 0, at most 1");
	refuseIf(recipe.filters.empty() && (recipe.robust || recipe.frames > 1),
			 "robust frames: found without a filter, expected what blurs the frames, or none");
	refuseIf(!recipe.filters.empty() && recipe.kind != TileKind::points,
			 "filter: found with the kind " + std::string(nameOf(recipe.kind)) + ", expected variants with points of their own");
	refuseIf(recipe.progressive && recipe.kind != TileKind::points,
			 "progressive: found with the kind " + std::string(nameOf(recipe.kind)) +
				 ", whose order is the pattern's, expected variants with points of their own");
	refuseIf(recipe.moves && (recipe.frames < 2 || recipe.frames > recipe.size * recipe.size),
			 "moves: found " + std::to_string(recipe.frames) + " frames, expected from 2 to " +
				 std::to_string(recipe.size * recipe.size) + ", the pixels of the tile");
}

void roundTile(PatternTile& tile)
{
	for (Pattern& variant : tile.variants)
	{
		for (glm::dvec3& p : variant.points)
		{
			p = glm::dvec3(roundToFloat(p.x), roundToFloat(p.y), roundToFloat(p.z));
			p = tile.domain == Domain::slice ? glm::dvec3(p.x < 1.0 ? p.x : 0.0, p.y < 1.0 ? p.y : 0.0, 0.0) : p;
		}
		for (double& w : variant.weights)
		{
			w = roundToFloat(w);
		}
	}
}

// Repeats a tile to a multiple of its size.
PatternTile repeated(const PatternTile& small, int size)
{
	PatternTile tile = small;
	tile.size = size;
	tile.variants.clear();
	for (int v = 0; v < size * size * layersOf(small); ++v)
	{
		const int layer = v / (size * size);
		const int from = (layer * small.size + v / size % size % small.size) * small.size + v % size % small.size;
		tile.variants.push_back(small.variants[static_cast<std::size_t>(from)]);
	}
	return tile;
}

// The squared error to be minimised, without the single variants' part: exact when it is reported, else approximate.
double seenError(const PatternTile& tile, const TileShares& seen, int threads)
{
	const Pattern all = unionOf(tile, 1.0);
	EnergyGradient unused;
	return stepsOfError(seen, tile.variants.front().count()) <= kMaxShareSteps
			   ? tileSquaredError(tile.domain, seen, all.points, all.weights, nullptr, threads)
			   : TileMoments(tile.domain, seen)(all.points, all.weights, unused, threads);
}

// The best tile made of copies of a smaller one; none if there is no smaller one.
std::optional<PatternTile> bestCopies(const std::vector<PatternTile>& smaller, const TileRecipe& recipe, int threads)
{
	std::optional<PatternTile> best;
	double least = std::numeric_limits<double>::infinity();
	for (const PatternTile& small : smaller)
	{
		if (recipe.size % small.size == 0)
		{
			PatternTile copies = repeated(small, recipe.size);
			const double error = seenError(copies, seenShares(recipe), threads);
			best = error < least ? std::move(copies) : std::move(best);
			least = std::min(least, error);
		}
	}
	return best;
}

// Sizes to make in turn: those that divide the recipe's size and have its frames; its own last. With frames, middle sizes above 4
// are skipped: a 6 × 6 tile of 16 samples over 8 frames takes eight times as long as the 12 × 12 tile that copies it.
std::vector<int> sizesOf(const TileRecipe& recipe)
{
	std::vector<int> sizes;
	for (int size = 2; recipe.kind == TileKind::points && size < recipe.size; ++size)
	{
		if (recipe.size % size == 0 && (size <= kLargestAlone || recipe.frames == 1) &&
			(!recipe.moves || recipe.frames <= size * size))
		{
			sizes.push_back(size);
		}
	}
	sizes.push_back(recipe.size);
	return sizes;
}

// One tile by descent, or the copies if it is no better.
PatternTile descendedTile(const Pattern& base, const TileRecipe& recipe, const std::optional<PatternTile>& copies,
						  const RunSettings& run)
{
	const std::span<const Pattern> near =
		copies && recipe.size > kLargestAlone ? std::span<const Pattern>(copies->variants) : std::span<const Pattern>{};
	PatternTile tile = recipe.kind == TileKind::points ? pointsTile(base, recipe, near, run) : transformedTile(base, recipe);
	tile.domain = base.domain;
	tile.size = recipe.size;
	tile.frames = recipe.frames;
	tile.moves = timeOf(recipe).moves;
	roundTile(tile);
	const TileShares seen = seenShares(recipe);
	return copies && seenError(*copies, seen, run.threads) < seenError(tile, seen, run.threads) ? *copies : tile;
}

} // namespace

Pattern unionOf(const PatternTile& tile, double divisor)
{
	Pattern all;
	all.domain = tile.domain;
	for (const Pattern& variant : tile.variants)
	{
		append(all.points, variant.points);
		std::transform(variant.weights.begin(), variant.weights.end(), std::back_inserter(all.weights),
					   [divisor](double w) { return w / divisor; });
	}
	return all;
}

double lambdaOf(const TileRecipe& recipe)
{
	return recipe.lambda > 0.0      ? recipe.lambda
		   : recipe.filters.empty() ? kPointsLambda
		   : recipe.frames > 1      ? kFramesLambda
									: kFilterLambda;
}

double tileError(Domain domain, const VariantUnion& all, std::size_t variants, double lambda, EnergyGradient& gradient, int threads)
{
	const auto k = static_cast<double>(variants);
	const std::size_t count = all.points.size() / variants;
	std::vector<double> shares(all.weights);
	for (double& w : shares)
	{
		w /= k;
	}
	double value = squaredError(domain, Ensemble::plane, Part::whole, all.points, shares, &gradient, threads);
	for (double& g : gradient.weights)
	{
		g /= k;
	}
	EnergyGradient own;
	for (std::size_t v = 0; v < variants; ++v)
	{
		const std::span<const glm::dvec3> points(all.points.data() + v * count, count);
		const std::span<const double> weights(all.weights.data() + v * count, count);
		value += lambda / k * squaredError(domain, Ensemble::plane, Part::whole, points, weights, &own, 1);
		for (std::size_t i = 0; i < count; ++i)
		{
			gradient.points[v * count + i] += lambda / k * own.points[i];
			gradient.weights[v * count + i] += lambda / k * own.weights[i];
		}
	}
	return value;
}

TileShares seenShares(const TileRecipe& recipe)
{
	TileShares all;
	if (recipe.filters.empty())
	{
		const auto pixels = static_cast<std::size_t>(recipe.size * recipe.size);
		return {recipe.size, 1, std::vector<double>(pixels, 1.0 / static_cast<double>(pixels))};
	}
	const TileTime time = timeOf(recipe);
	// Normalises an error by that of equally many independent variants.
	const auto add = [&all](const TileShares& shares, double scale)
	{
		addShares(all, shares, scale / shares.pairs[0]);
	};
	const double sum = sumOver(recipe.filters, [](const TileFilter& filter) { return filter.share; });
	for (const TileFilter& filter : recipe.filters)
	{
		const double share = filter.share / sum;
		add(sharesOf(recipe.size, filter, time), share);
		const std::vector<TileFilter> halves = recipe.robust ? halvesOf(filter) : std::vector<TileFilter>{};
		for (const TileFilter& half : halves)
		{
			add(sharesOf(recipe.size, half, time), share / static_cast<double>(halves.size()));
		}
		if (recipe.frames > 1)
		{
			add(sharesOf(recipe.size, filter, time, 0), share);
			for (int last = 2; last < recipe.frames; last *= 2) // after a camera cut
			{
				add(sharesOf(recipe.size, filter, time, last), share * kPrefix);
			}
		}
	}
	if (recipe.frames > 1)
	{
		// Single pixels, where the filter finds no similar neighbours: with a still and with a panning camera.
		const std::vector<glm::ivec2> pans =
			recipe.size <= kPannedSize ? std::vector<glm::ivec2>{{0, 0}, {1, 0}, {0, 1}, {1, 1}} : std::vector<glm::ivec2>{{0, 0}};
		for (const glm::ivec2 pan : pans)
		{
			add(sharesOf(recipe.size, tileFilterNamed("none"), time, 0, pan), 1.0 / static_cast<double>(pans.size()));
		}
	}
	return all;
}

TileShares sharesOf(const TileRecipe& recipe)
{
	TileShares all = seenShares(recipe);
	all.pairs[0] += lambdaOf(recipe);
	return all;
}

int variantOfFrame(const PatternTile& tile, int frame)
{
	const int f = frame % tile.frames;
	if (tile.moves.empty())
	{
		return f * tile.size * tile.size;
	}
	const glm::ivec2 move = tile.moves[static_cast<std::size_t>(f)];
	return move.y % tile.size * tile.size + move.x % tile.size;
}

uint64_t tileMemory(const TileRecipe& recipe, const Pattern& base, int threads)
{
	constexpr uint64_t kProgram = uint64_t{20} << 20U; // huge pages round each heap up to 2 MiB
	return kProgram + std::max(pointsMemory(base, recipe, threads), variantsOf(recipe) * base.count() * kFinishedBytes);
}

void checkTileSize(const TileRecipe& recipe, const Pattern& base, uint64_t memory_bytes, int threads)
{
	checkTileFilters(recipe);
	refuseIf(
		base.domain == Domain::slice && !recipe.filters.empty() && stepsOfError(sharesOf(recipe), base.count()) > kMaxShareSteps,
		"size frames: found " + std::to_string(variantsOf(recipe) * base.count()) + " slices, expected fewer; or one that moves",
		ExitCode::invalid_input);
	const uint64_t need = memory_bytes > 0 ? tileMemory(recipe, base, threads) : 0;
	refuseIf(need > memory_bytes,
			 "memory: found a need of about " + needText(need) + " for " + std::to_string(variantsOf(recipe) * base.count()) +
				 " samples, expected at most " + capText(memory_bytes) +
				 (recipe.frames > 1 && !recipe.moves ? "; or a tile that moves" : ""),
			 ExitCode::runtime);
}

void checkTileRecipe(const TileRecipe& recipe, Domain domain)
{
	refuseIf(recipe.size < 2 || recipe.size > kMaxTileSize, "size: expected a whole number from 2 to 128");
	refuseIf(recipe.size > 8 && recipe.filters.empty(),
			 "size: found " + std::to_string(recipe.size) + ", expected at most 8, or a filter");
	checkTime(recipe);
	refuseIf(recipe.starts < 0 || recipe.starts > 1000, "starts: expected a whole number from 1 to 1000");
	refuseIf(recipe.lambda != -1.0 && !(recipe.lambda > 0.0 && recipe.lambda <= 1e6),
			 "lambda: expected a number above 0, at most 1e6");
	refuseIf(recipe.kind != TileKind::points && (recipe.lambda != -1.0 || recipe.starts != 0),
			 "lambda starts: the kinds even and random are not optimised; expected points");
	refuseIf(domain == Domain::sphere,
			 "a tile of sphere patterns: rotations leave no error on the sphere; expected disk, ball or hemisphere",
			 ExitCode::unsupported);
	refuseIf(domain == Domain::slice && recipe.kind != TileKind::points,
			 "kind " + std::string(nameOf(recipe.kind)) + ": slices have azimuths and jitters of their own; expected points",
			 ExitCode::unsupported);
	refuseIf(domain == Domain::ball && recipe.kind == TileKind::even,
			 "kind even: rotations about the view axis are for disk and hemisphere; expected points or random",
			 ExitCode::unsupported);
}

std::string tileCommand(const TileRecipe& recipe, const std::string& pattern_file)
{
	return tileCommandOn(recipe, "--pattern " + pattern_file);
}

std::string sliceTileCommand(const TileRecipe& recipe, std::size_t count)
{
	return tileCommandOn(recipe, "--domain slice --count " + std::to_string(count));
}

PatternTile generateTile(const Pattern& base, const TileRecipe& recipe, const RunSettings& run)
{
	checkTileRecipe(recipe, base.domain);
	checkTileSize(recipe, base, 0, run.threads);
	const std::vector<int> sizes = sizesOf(recipe);
	ProgressCounter progress(run.progress, "sizes", countIfSeveral(sizes.size()));
	std::vector<PatternTile> made; // of the sizes that divide the recipe's, smallest first
	for (const int size : sizes)
	{
		TileRecipe one = recipe;
		one.size = size;
		made.push_back(descendedTile(base, one, bestCopies(made, one, run.threads), run));
		progress.finishOne();
	}
	PatternTile tile = std::move(made.back());
	if (recipe.progressive)
	{
		orderProgressively(base, recipe, tile.variants, run);
	}
	return tile;
}

} // namespace nook
