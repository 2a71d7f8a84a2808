// SPDX-License-Identifier: GPL-3.0-or-later
// Variants with their own points and weights, found by one descent over all of them.
#include "core/lists.h"
#include "core/math.h"
#include "core/parallel.h"
#include "core/round.h"
#include "pattern/methods.h"
#include "pattern/tile_parts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

namespace nook
{
namespace
{

constexpr double kPairsAtOnce = 0x1p24; // of samples in one evaluation; above this, which takes seconds, use moments
constexpr int kMemoryByMoments = 5;     // step pairs: a large tile is limited by memory

int iterationLimit(bool moments, std::size_t variants, std::size_t points)
{
	// 64 × 64 pixels in each of 32 frames take 340 s of processor time; four times as many may not take ten minutes on two cores.
	return moments ? (variants <= (std::size_t{1} << 17U) ? 200 : 60) : points <= 512 ? 2000 : points <= 1024 ? 600 : 200;
}

// Variables: for each variant its layout's variables, then the logarithms of its weights, one per point or opposite pair.
class FreeTile final : public TileProblem
{
public:
	FreeTile(const Pattern& base, std::size_t variants, bool open)
		: m_base(base), m_layout(structureOf(base)), m_variants(variants), m_count(base.count()), m_open(open)
	{
		const std::size_t centre = m_layout.has_centre ? 1 : 0;
		m_slot =
			listOf(m_count, [&](std::size_t i) { return i < centre           ? 0
														: m_layout.symmetric ? centre + (i - centre) / 2
																			 : i; });
	}

	std::vector<double> start(std::size_t, Random& random) const override
	{
		std::vector<double> x;
		for (std::size_t v = 0; v < m_variants; ++v)
		{
			append(turnedCopy(v, random), m_base.weights, x);
		}
		return x;
	}

	std::vector<double> startNear(std::span<const Pattern> variants, Random& random) const override
	{
		std::vector<double> x;
		for (const Pattern& variant : variants)
		{
			append(shaken(variant.points, random), variant.weights, x);
		}
		return x;
	}

	bool unpack(std::span<const double> x, VariantUnion& all) const override
	{
		all.points.clear();
		all.weights.clear();
		Points points;
		for (std::size_t v = 0; v < m_variants; ++v)
		{
			if (!m_layout.points(placed(pointPart(x, v)), points))
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

	void pullBack(std::span<const double> x, const VariantUnion& all, const EnergyGradient& by_all,
				  std::span<double> gradient) const override
	{
		for (std::size_t v = 0; v < m_variants; ++v)
		{
			const std::size_t first = v * m_count;
			const std::span<const glm::dvec3> points(all.points.data() + first, m_count);
			const std::span<const glm::dvec3> by_points(by_all.points.data() + first, m_count);
			const std::span<double> by_variables = gradient.subspan(v * size(), pointSize());
			const std::vector<double> at = placed(pointPart(x, v));
			m_layout.pullBack(at, points, by_points, by_variables);
			for (std::size_t i = 0; i < at.size() && m_open; i += m_layout.dimension())
			{
				// p = u / √(1 + u²): ∂p/∂u = √(1 − p²) (1 − p pᵀ).
				const std::span<const double> p(at.data() + i, m_layout.dimension());
				const std::span<double> g = by_variables.subspan(i, p.size());
				const double along = std::inner_product(p.begin(), p.end(), g.begin(), 0.0);
				for (std::size_t a = 0; a < p.size(); ++a)
				{
					g[a] -= along * p[a];
				}
				scale(g, std::sqrt(1.0 - squareOf(p)));
			}
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
	static double squareOf(std::span<const double> p)
	{
		return sumOver(p, [](double x) { return x * x; });
	}
	static void scale(std::span<double> p, double factor)
	{
		for (double& x : p)
		{
			x *= factor;
		}
	}

	// Positions as the layout has them: with m_open the variables are u = p / √(1 − p²), so that no step leaves the domain.
	std::vector<double> placed(std::span<const double> variables) const
	{
		std::vector<double> at(variables.begin(), variables.end());
		for (std::size_t i = 0; i < at.size() && m_open; i += m_layout.dimension())
		{
			const std::span<double> u(at.data() + i, m_layout.dimension());
			scale(u, 1.0 / std::sqrt(1.0 + squareOf(u)));
		}
		return at;
	}

	std::size_t slots() const
	{
		return m_slot.back() + 1;
	}
	std::size_t pointSize() const
	{
		return m_layout.dimension() * m_layout.free_count;
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

	// Appends the variables of one variant.
	void append(const Points& points, std::span<const double> weights, std::vector<double>& x) const
	{
		std::vector<double> part = m_layout.variables(points);
		for (std::size_t i = 0; i < part.size() && m_open; i += m_layout.dimension())
		{
			const std::span<double> p(part.data() + i, m_layout.dimension());
			scale(p, 1.0 / std::sqrt(std::max(1.0 - squareOf(p), 1e-4)));
		}
		x.insert(x.end(), part.begin(), part.end());
		std::vector<double> logs(slots());
		for (std::size_t i = 0; i < m_count; ++i)
		{
			logs[m_slot[i]] = logOf(std::max(weights[i], 1e-6));
		}
		x.insert(x.end(), logs.begin(), logs.end());
	}

	// Perturbed slightly, so that no two variants are alike.
	Points shaken(Points points, Random& random) const
	{
		const double shake = 0.1 / std::sqrt(static_cast<double>(m_count));
		for (glm::dvec3& p : points)
		{
			for (int axis = 0; axis < 3; ++axis)
			{
				p[axis] += shake * (random.uniform() - 0.5);
			}
			p = placeInDomain(m_layout.domain, p);
		}
		return m_layout.expand(m_layout.freePoints(points));
	}

	// The base rotated by the variant's share of a turn, spread slightly in radius, and perturbed.
	Points turnedCopy(std::size_t v, Random& random) const
	{
		const SinCos turn = sinCosOf(2.0 * kPi * (static_cast<double>(v) + random.uniform()) / static_cast<double>(m_variants));
		const double scale = 0.9 + 0.15 * random.uniform();
		Points points = m_base.points;
		for (glm::dvec3& p : points)
		{
			p = scale * glm::dvec3(turn.cos * p.x - turn.sin * p.y, turn.sin * p.x + turn.cos * p.y, p.z);
		}
		return shaken(std::move(points), random);
	}

	const Pattern& m_base;
	Layout m_layout;
	std::size_t m_variants;
	std::size_t m_count;
	bool m_open;
	std::vector<std::size_t> m_slot;
};

std::size_t startsOf(Domain domain, const TileRecipe& recipe, std::size_t samples)
{
	const bool large = !recipe.filters.empty() && samples > 1024; // many variants make up for few starts
	// A descent of few slices takes a millisecond, and its result varies widely.
	const double pairs = static_cast<double>(samples) * static_cast<double>(samples);
	const int tried = domain == Domain::slice ? static_cast<int>(std::clamp(0x1p18 / pairs, 1.0, 1024.0))
					  : large                 ? 1
											  : kDefaultTileStarts;
	return static_cast<std::size_t>(recipe.starts != 0 ? recipe.starts : tried);
}

// Slices cannot use moments: their kernel is not smooth.
bool byMoments(Domain domain, const TileShares& shares, std::size_t count)
{
	return domain != Domain::slice && stepsOfError(shares, count) > kPairsAtOnce;
}

PatternTile tileOf(const Pattern& base, const VariantUnion& all, std::size_t variants)
{
	PatternTile tile;
	for (std::size_t v = 0; v < variants; ++v)
	{
		const auto first = static_cast<std::ptrdiff_t>(v * base.count());
		const auto last = first + static_cast<std::ptrdiff_t>(base.count());
		tile.variants.push_back({.domain = base.domain,
								 .points = {all.points.begin() + first, all.points.begin() + last},
								 .weights = {all.weights.begin() + first, all.weights.begin() + last},
								 .powers = {}});
	}
	return tile;
}

// Variants that are transformed copies of the base: even rotations, or random reflections.

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

PatternTile copiesOf(const Pattern& base, std::vector<TileTransform> transforms)
{
	PatternTile tile;
	for (TileTransform& t : transforms)
	{
		t.cos = roundToFloat(t.cos);
		t.sin = roundToFloat(t.sin);
		t.scale = roundToFloat(t.scale);
		t.axis = glm::dvec3(roundToFloat(t.axis.x), roundToFloat(t.axis.y), roundToFloat(t.axis.z));
		tile.variants.push_back(
			{.domain = base.domain, .points = transformed(base.domain, base.points, t), .weights = base.weights, .powers = {}});
	}
	tile.transforms = std::move(transforms);
	return tile;
}

} // namespace

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

uint64_t pointsMemory(const Pattern& base, const TileRecipe& recipe, int threads)
{
	const TileShares shares = recipe.filters.empty() ? TileShares{} : sharesOf(recipe);
	const uint64_t variants = variantsOf(recipe);
	const uint64_t samples = variants * base.count();
	const bool moments = byMoments(base.domain, shares, base.count());
	const bool near = recipe.size > kLargestAlone;
	const uint64_t starts = startsOf(base.domain, recipe, static_cast<std::size_t>(samples));
	const bool slices = base.domain == Domain::slice;
	const Recipe structure = structureOf(base);
	const uint64_t slots = slices ? base.count() : Layout(structure).free_count + (structure.centre ? 1U : 0U);
	const uint64_t numbers = variants * slots * (slices ? 2 : isPlanar(base.domain) ? 3 : 4);
	// L-BFGS: position, gradient, direction, the next two, and the step pairs plus one under construction.
	const uint64_t descent =
		8 * numbers * (4 + 2 * (1 + static_cast<uint64_t>(moments ? kMemoryByMoments : LbfgsSettings{}.memory)));
	const uint64_t kUnion = 32;     // point and weight; the gradient takes the same again
	const uint64_t kSums = 40 + 40; // tileSquaredError, per sample: itself, and the sums of each task
	const uint64_t error = moments ? formBytes(base.domain) + variants * momentBytes(base.domain, shares)
								   : samples * (kSums + (samples > 1024 ? 15 * 40 : 0));
	return std::min<uint64_t>(starts, static_cast<uint64_t>(threads)) * (descent + 2 * kUnion * samples + error) +
		   starts * 8 * numbers + (near ? kUnion * samples + variants * sizeof(Pattern) : 0);
}

PatternTile pointsTile(const Pattern& base, const TileRecipe& recipe, std::span<const Pattern> near, const RunSettings& run)
{
	const TileShares shares = recipe.filters.empty() ? TileShares{} : sharesOf(recipe);
	const std::size_t variants = variantsOf(recipe);
	const bool moments = byMoments(base.domain, shares, base.count());
	const std::size_t starts = startsOf(base.domain, recipe, variants * base.count());
	const std::size_t drawn = starts - (near.empty() ? 0 : 1);
	// Among many points of the ball or the hemisphere, one is always near the border and would hold up all others.
	const bool open = !recipe.filters.empty() && base.domain != Domain::disk;
	const std::unique_ptr<TileProblem> problem =
		base.domain == Domain::slice ? sliceProblem(base, recipe, variants) : std::make_unique<FreeTile>(base, variants, open);
	std::vector<std::vector<double>> ends(starts);
	std::vector<double> values(starts);
	const int inner_threads = starts == 1 ? run.threads : 1;
	LbfgsSettings settings{.max_iterations = iterationLimit(moments, variants, variants * base.count()), .relative_decrease = 1e-5};
	settings.memory = moments ? kMemoryByMoments : settings.memory;
	ProgressCounter progress(run.progress, "starts", starts * stepsOf(settings));
	parallelFor(starts, run.threads,
				[&](std::size_t k)
				{
					Random random(recipe.seed, k);
					ends[k] = k < drawn ? problem->start(k, random) : problem->startNear(near, random);
					VariantUnion all;
					EnergyGradient by_all;
					std::optional<TileMoments> by_moments;
					if (moments)
					{
						by_moments.emplace(base.domain, shares);
					}
					const Objective objective = [&](std::span<const double> x, std::span<double> gradient)
					{
						if (!problem->unpack(x, all))
						{
							return std::numeric_limits<double>::infinity();
						}
						const double value =
							by_moments ? (*by_moments)(all.points, all.weights, by_all, inner_threads)
							: shares.pairs.empty()
								? tileError(base.domain, all, variants, lambdaOf(recipe), by_all, inner_threads)
								: tileSquaredError(base.domain, shares, all.points, all.weights, &by_all, inner_threads);
						problem->pullBack(x, all, by_all, gradient);
						return value;
					};
					StartProgress start_progress(progress, stepsOf(settings));
					LbfgsSettings watched = settings;
					watched.seen = [&start_progress](std::span<const double>)
					{
						start_progress.step();
					};
					values[k] = minimise(objective, ends[k], watched);
				});
	VariantUnion all;
	problem->unpack(ends[static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin())], all);
	return tileOf(base, all, variants);
}

PatternTile transformedTile(const Pattern& base, const TileRecipe& recipe)
{
	const auto variants = static_cast<std::size_t>(recipe.size * recipe.size);
	return copiesOf(base, recipe.kind == TileKind::even ? evenTransforms(variants)
														: randomReflections(base.domain, variants, recipe.seed));
}

} // namespace nook
