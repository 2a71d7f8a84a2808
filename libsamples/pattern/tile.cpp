// SPDX-License-Identifier: GPL-3.0-or-later
// The mean over the window of K variants' estimates is the estimate of all their points together with weights / K. So the window's
// squared error is the energy distance of the union, and a tile is made by one descent on window² + λ · mean of the variants'
// plane².
#include "pattern/tile.h"

#include "core/error.h"
#include "core/math.h"
#include "core/parallel.h"
#include "core/round.h"
#include "pattern/lbfgs.h"
#include "pattern/methods.h"
#include "pattern/starts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace nook
{

template <> std::span<const std::string_view> namesOf<TileKind>()
{
	static constexpr std::array<std::string_view, 4> names{"points", "transform", "even", "random"};
	return names;
}

namespace
{

constexpr double kPointsLambda = 0.05;
constexpr double kTransformLambda = 0.15; // below, the scales spread so far that single variants suffer
constexpr int kDefaultStarts = 4;

double lambdaOf(const TileRecipe& recipe)
{
	return recipe.lambda > 0.0 ? recipe.lambda : recipe.kind == TileKind::points ? kPointsLambda : kTransformLambda;
}

// The points' structure, read off the points: variants keep the symmetry and the centre of their base.
Recipe structureOf(const Pattern& base)
{
	Recipe structure;
	structure.domain = base.domain;
	structure.count = static_cast<int>(base.count());
	structure.centre = !isDirectional(base.domain) && base.points.front() == glm::dvec3(0.0);
	const std::size_t first = structure.centre ? 1 : 0;
	bool symmetric = base.domain != Domain::hemisphere && base.count() > first && (base.count() - first) % 2 == 0;
	for (std::size_t i = first; symmetric && i + 1 < base.count(); i += 2)
	{
		symmetric = base.points[i] == -base.points[i + 1] && base.weights[i] == base.weights[i + 1];
	}
	structure.symmetric = symmetric;
	return structure;
}

int iterationLimit(std::size_t points)
{
	return points <= 512 ? 2000 : points <= 1024 ? 600 : 200;
}

// All points of all variants, one variant after the other.
struct Union
{
	Points points;
	std::vector<double> weights; // of sum 1 in each variant
};

// window² + λ · mean plane², and its gradient by every point and weight.
double tileError(Domain domain, const Union& all, std::size_t variants, double lambda, EnergyGradient& gradient, int threads)
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

// ---- Variants with points of their own.

// Variables: for each variant its layout's variables, then the logarithms of its weights, one for a point or an opposite pair.
class FreeTile
{
public:
	FreeTile(const Pattern& base, std::size_t variants) : m_layout(structureOf(base)), m_variants(variants), m_count(base.count())
	{
		const std::size_t centre = m_layout.hasCentre() ? 1 : 0;
		for (std::size_t i = 0; i < m_count; ++i)
		{
			m_slot.push_back(i < centre ? 0 : m_layout.symmetric() ? centre + (i - centre) / 2 : i);
		}
	}

	std::vector<double> start(const Pattern& base, Random& random) const
	{
		std::vector<double> x;
		for (std::size_t v = 0; v < m_variants; ++v)
		{
			const Points turned = turnedCopy(base, v, random);
			const std::vector<double> part = m_layout.variables(turned);
			x.insert(x.end(), part.begin(), part.end());
			std::vector<double> logs(slots());
			for (std::size_t i = 0; i < m_count; ++i)
			{
				logs[m_slot[i]] = logOf(std::max(base.weights[i], 1e-6));
			}
			x.insert(x.end(), logs.begin(), logs.end());
		}
		return x;
	}

	bool unpack(std::span<const double> x, Union& all) const
	{
		all.points.clear();
		all.weights.clear();
		Points points;
		for (std::size_t v = 0; v < m_variants; ++v)
		{
			if (!m_layout.points(pointPart(x, v), points))
			{
				return false;
			}
			all.points.insert(all.points.end(), points.begin(), points.end());
			const std::span<const double> logs = logPart(x, v);
			double sum = 0.0;
			for (std::size_t i = 0; i < m_count; ++i)
			{
				if (!(std::fabs(logs[m_slot[i]]) < 30.0))
				{
					return false;
				}
				all.weights.push_back(expOf(logs[m_slot[i]]));
				sum += all.weights.back();
			}
			for (std::size_t i = 0; i < m_count; ++i)
			{
				all.weights[v * m_count + i] /= sum;
			}
		}
		return true;
	}

	void pullBack(std::span<const double> x, const Union& all, const EnergyGradient& by_all, std::span<double> gradient) const
	{
		for (std::size_t v = 0; v < m_variants; ++v)
		{
			const std::size_t first = v * m_count;
			const std::span<const glm::dvec3> points(all.points.data() + first, m_count);
			const std::span<const glm::dvec3> by_points(by_all.points.data() + first, m_count);
			m_layout.pullBack(pointPart(x, v), points, by_points, gradient.subspan(v * size(), pointSize()));
			double mean = 0.0;
			for (std::size_t i = 0; i < m_count; ++i)
			{
				mean += all.weights[first + i] * by_all.weights[first + i];
			}
			const std::span<double> logs = gradient.subspan(v * size() + pointSize(), slots());
			std::fill(logs.begin(), logs.end(), 0.0);
			for (std::size_t i = 0; i < m_count; ++i)
			{
				logs[m_slot[i]] += all.weights[first + i] * (by_all.weights[first + i] - mean);
			}
		}
	}

private:
	std::size_t slots() const
	{
		return m_slot.back() + 1;
	}
	std::size_t pointSize() const
	{
		return m_layout.dimension() * m_layout.freeCount();
	}
	std::size_t size() const
	{
		return pointSize() + slots();
	}
	std::span<const double> pointPart(std::span<const double> x, std::size_t v) const
	{
		return x.subspan(v * size(), pointSize());
	}
	std::span<const double> logPart(std::span<const double> x, std::size_t v) const
	{
		return x.subspan(v * size() + pointSize(), slots());
	}

	// The base turned by the variant's share of a turn, spread a little in radius, and shaken so that no two variants are alike.
	Points turnedCopy(const Pattern& base, std::size_t v, Random& random) const
	{
		const SinCos turn = sinCosOf(2.0 * kPi * (static_cast<double>(v) + random.uniform()) / static_cast<double>(m_variants));
		const double scale = 0.9 + 0.15 * random.uniform();
		const double shake = 0.1 / std::sqrt(static_cast<double>(m_count));
		Points points = base.points;
		for (glm::dvec3& p : points)
		{
			glm::dvec3 q(turn.cos * p.x - turn.sin * p.y, turn.sin * p.x + turn.cos * p.y, p.z);
			for (int axis = 0; axis < 3; ++axis)
			{
				q[axis] = scale * q[axis] + shake * (random.uniform() - 0.5);
			}
			p = placeInDomain(m_layout.domain(), q);
		}
		Points placed = m_layout.expand(m_layout.freePoints(points));
		return placed;
	}

	Layout m_layout;
	std::size_t m_variants;
	std::size_t m_count;
	std::vector<std::size_t> m_slot;
};

PatternTile freeTile(const Pattern& base, const TileRecipe& recipe, const RunSettings& run)
{
	const auto variants = static_cast<std::size_t>(recipe.size * recipe.size);
	const auto starts = static_cast<std::size_t>(recipe.starts != 0 ? recipe.starts : kDefaultStarts);
	const FreeTile problem(base, variants);
	std::vector<std::vector<double>> ends(starts);
	std::vector<double> values(starts);
	const int inner_threads = starts == 1 ? run.threads : 1;
	ProgressCounter progress(run.progress, "starts", starts);
	parallelFor(starts, run.threads,
				[&](std::size_t k)
				{
					Random random(recipe.seed, k);
					ends[k] = problem.start(base, random);
					Union all;
					EnergyGradient by_all;
					const Objective objective = [&](std::span<const double> x, std::span<double> gradient)
					{
						if (!problem.unpack(x, all))
						{
							return std::numeric_limits<double>::infinity();
						}
						const double value = tileError(base.domain, all, variants, lambdaOf(recipe), by_all, inner_threads);
						problem.pullBack(x, all, by_all, gradient);
						return value;
					};
					LbfgsSettings settings;
					settings.max_iterations = iterationLimit(variants * base.count());
					settings.relative_decrease = 1e-5;
					values[k] = minimise(objective, ends[k], settings);
					progress.finishOne();
				});
	const std::size_t best = static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin());
	Union all;
	problem.unpack(ends[best], all);
	PatternTile tile;
	for (std::size_t v = 0; v < variants; ++v)
	{
		const auto first = static_cast<std::ptrdiff_t>(v * base.count());
		const auto last = first + static_cast<std::ptrdiff_t>(base.count());
		Pattern variant;
		variant.domain = base.domain;
		variant.points.assign(all.points.begin() + first, all.points.begin() + last);
		variant.weights.assign(all.weights.begin() + first, all.weights.begin() + last);
		tile.variants.push_back(variant);
	}
	return tile;
}

// ---- Variants that are transformed copies of the base.

Points transformed(Domain domain, std::span<const glm::dvec3> points, const TileTransform& t)
{
	Points result;
	for (const glm::dvec3& p : points)
	{
		if (domain == Domain::ball)
		{
			result.push_back(p - 2.0 * glm::dot(t.axis, p) * t.axis);
			continue;
		}
		const double y = t.handedness * p.y;
		glm::dvec3 q(t.scale * (t.cos * p.x - t.sin * y), t.scale * (t.sin * p.x + t.cos * y), 0.0);
		if (domain == Domain::hemisphere)
		{
			q.z = std::sqrt(std::max(0.0, 1.0 - glm::dot(q, q)));
		}
		result.push_back(q);
	}
	return result;
}

double greatestRadius(std::span<const glm::dvec3> points)
{
	double greatest = 0.0;
	for (const glm::dvec3& p : points)
	{
		greatest = std::max(greatest, std::sqrt(p.x * p.x + p.y * p.y));
	}
	return greatest;
}

std::vector<TileTransform> evenTransforms(std::size_t variants)
{
	std::vector<TileTransform> result(variants);
	for (std::size_t v = 0; v < variants; ++v)
	{
		const SinCos turn = sinCosOf(2.0 * kPi * static_cast<double>(v) / static_cast<double>(variants));
		result[v].cos = v == 0 ? 1.0 : turn.cos;
		result[v].sin = v == 0 ? 0.0 : turn.sin;
	}
	return result;
}

// VO §4.5: reflections about random directions, in the plane or in space.
std::vector<TileTransform> randomReflections(Domain domain, std::size_t variants, uint32_t seed)
{
	Random random(seed, 0);
	std::vector<TileTransform> result(variants);
	for (TileTransform& t : result)
	{
		const SinCos turn = sinCosOf(2.0 * kPi * random.uniform());
		if (domain == Domain::ball)
		{
			const double z = 1.0 - 2.0 * random.uniform();
			const double r = std::sqrt(std::max(0.0, (1.0 - z) * (1.0 + z)));
			t.axis = {r * turn.cos, r * turn.sin, z};
		}
		t.cos = turn.cos;
		t.sin = turn.sin;
		t.handedness = -1.0;
	}
	return result;
}

// Angles and scales by descent; every second variant is a reflection.
std::vector<TileTransform> descendedTransforms(const Pattern& base, const TileRecipe& recipe, const RunSettings& run)
{
	const auto variants = static_cast<std::size_t>(recipe.size * recipe.size);
	const auto starts = static_cast<std::size_t>(recipe.starts != 0 ? recipe.starts : 4 * kDefaultStarts);
	const double largest = std::min(1.5, 0.999 / greatestRadius(base.points));
	const auto transformOf = [&](std::span<const double> x, std::size_t v)
	{
		const SinCos turn = sinCosOf(x[2 * v]);
		return TileTransform{turn.cos, turn.sin, x[2 * v + 1], v % 2 == 0 ? 1.0 : -1.0, {}};
	};
	std::vector<std::vector<double>> ends(starts);
	std::vector<double> values(starts);
	ProgressCounter progress(run.progress, "starts", starts);
	parallelFor(starts, run.threads,
				[&](std::size_t k)
				{
					Random random(recipe.seed, k);
					for (std::size_t v = 0; v < variants; ++v)
					{
						ends[k].push_back(2.0 * kPi * random.uniform());
						ends[k].push_back(std::min(largest, 0.8 + 0.4 * random.uniform()));
					}
					EnergyGradient by_all;
					const Objective objective = [&](std::span<const double> x, std::span<double> gradient)
					{
						Union all;
						for (std::size_t v = 0; v < variants; ++v)
						{
							if (!(x[2 * v + 1] > 0.5 && x[2 * v + 1] <= largest && std::fabs(x[2 * v]) < 1000.0))
							{
								return std::numeric_limits<double>::infinity();
							}
							const Points points = transformed(base.domain, base.points, transformOf(x, v));
							all.points.insert(all.points.end(), points.begin(), points.end());
							all.weights.insert(all.weights.end(), base.weights.begin(), base.weights.end());
						}
						const double value = tileError(base.domain, all, variants, lambdaOf(recipe), by_all, 1);
						std::fill(gradient.begin(), gradient.end(), 0.0);
						for (std::size_t i = 0; i < all.points.size(); ++i)
						{
							const std::size_t v = i / base.count();
							const glm::dvec3& p = all.points[i];
							glm::dvec3 g = by_all.points[i];
							if (base.domain == Domain::hemisphere)
							{
								g -= g.z / p.z * p;
							}
							gradient[2 * v] += g.y * p.x - g.x * p.y;
							gradient[2 * v + 1] += (g.x * p.x + g.y * p.y) / x[2 * v + 1];
						}
						return value;
					};
					LbfgsSettings settings;
					settings.relative_decrease = 1e-5;
					values[k] = minimise(objective, ends[k], settings);
					progress.finishOne();
				});
	const std::size_t best = static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin());
	std::vector<TileTransform> result;
	for (std::size_t v = 0; v < variants; ++v)
	{
		result.push_back(transformOf(ends[best], v));
	}
	return result;
}

PatternTile transformedTile(const Pattern& base, std::vector<TileTransform> transforms)
{
	PatternTile tile;
	for (TileTransform& t : transforms)
	{
		t.cos = roundToFloat(t.cos);
		t.sin = roundToFloat(t.sin);
		t.scale = roundToFloat(t.scale);
		t.axis = glm::dvec3(roundToFloat(t.axis.x), roundToFloat(t.axis.y), roundToFloat(t.axis.z));
		Pattern variant;
		variant.domain = base.domain;
		variant.points = transformed(base.domain, base.points, t);
		variant.weights = base.weights;
		tile.variants.push_back(variant);
	}
	tile.transforms = std::move(transforms);
	return tile;
}

} // namespace

void checkTileRecipe(const TileRecipe& recipe, Domain domain)
{
	constexpr std::array<int, 5> kSizes{2, 3, 4, 5, 8};
	if (std::find(kSizes.begin(), kSizes.end(), recipe.size) == kSizes.end())
	{
		throw Error(ExitCode::usage, "--size: expected 2, 3, 4, 5 or 8");
	}
	if (recipe.starts < 0 || recipe.starts > 1000)
	{
		throw Error(ExitCode::usage, "--starts: expected a whole number from 1 to 1000");
	}
	if (recipe.lambda != -1.0 && !(recipe.lambda > 0.0 && recipe.lambda <= 1e6))
	{
		throw Error(ExitCode::usage, "--lambda: expected a number above 0, at most 1e6");
	}
	const bool descends = recipe.kind == TileKind::points || recipe.kind == TileKind::transform;
	if (!descends && (recipe.lambda != -1.0 || recipe.starts != 0))
	{
		throw Error(ExitCode::usage,
					"--lambda --starts: --kind even and random are not optimised; expected --kind points or transform");
	}
	if (domain == Domain::sphere)
	{
		throw Error(ExitCode::unsupported,
					"a tile of sphere patterns: rotations leave no error on the sphere; expected disk, ball or hemisphere");
	}
	if (domain == Domain::ball && (recipe.kind == TileKind::transform || recipe.kind == TileKind::even))
	{
		throw Error(ExitCode::unsupported,
					"--kind " + std::string(nameOf(recipe.kind)) +
						": rotations about the view axis are for disk and hemisphere; expected --kind points or random");
	}
}

std::string commandOf(const TileRecipe& recipe, const std::string& pattern_file)
{
	const TileRecipe plain;
	std::string command = "nook tile --pattern " + pattern_file + " --size " + std::to_string(recipe.size);
	if (recipe.kind != plain.kind)
	{
		command += " --kind " + std::string(nameOf(recipe.kind));
	}
	if (recipe.lambda != plain.lambda)
	{
		std::array<char, 32> buffer{};
		const std::to_chars_result end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), recipe.lambda);
		command += " --lambda " + std::string(buffer.data(), end.ptr);
	}
	if (recipe.starts != plain.starts)
	{
		command += " --starts " + std::to_string(recipe.starts);
	}
	if (recipe.seed != plain.seed)
	{
		command += " --seed " + std::to_string(recipe.seed);
	}
	return command;
}

PatternTile generateTile(const Pattern& base, const TileRecipe& recipe, const RunSettings& run)
{
	checkTileRecipe(recipe, base.domain);
	const auto variants = static_cast<std::size_t>(recipe.size * recipe.size);
	PatternTile tile;
	switch (recipe.kind)
	{
	case TileKind::points: tile = freeTile(base, recipe, run); break;
	case TileKind::transform: tile = transformedTile(base, descendedTransforms(base, recipe, run)); break;
	case TileKind::even: tile = transformedTile(base, evenTransforms(variants)); break;
	case TileKind::random: tile = transformedTile(base, randomReflections(base.domain, variants, recipe.seed)); break;
	}
	tile.domain = base.domain;
	tile.size = recipe.size;
	for (Pattern& variant : tile.variants)
	{
		for (glm::dvec3& p : variant.points)
		{
			p = glm::dvec3(roundToFloat(p.x), roundToFloat(p.y), roundToFloat(p.z));
		}
		for (double& w : variant.weights)
		{
			w = roundToFloat(w);
		}
	}
	return tile;
}

} // namespace nook
