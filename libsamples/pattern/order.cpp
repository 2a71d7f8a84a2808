// SPDX-License-Identifier: GPL-3.0-or-later
// Orders each variant's samples so that prefixes have small errors. The full set is unchanged, so this costs nothing.
//
// The squared error of a prefix, its weights divided by their sum W, is Σ w_i l_i / W − ½ Σ w_i w_j K_ij / W² + constant
// (QuadraticForm). Variants are ordered one after the other. Each next sample minimises this error together with that of the
// neighbouring variants' prefixes that are already ordered, because no filter can correct an error they all share. Opposite samples
// stay together, and a centre stays first.
#include "core/lists.h"
#include "core/random.h"
#include "pattern/energy.h"
#include "pattern/methods.h"
#include "pattern/tile_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace nook
{
namespace
{

// Samples that stay together: one, or a pair.
using Unit = std::vector<std::size_t>;

// A set of units, and the squared error of the pattern they form.
class Prefix
{
public:
	Prefix(const QuadraticForm& form, const std::vector<double>& weights)
		: m_form(form), m_weights(weights), m_rows(weights.size(), 0.0)
	{
	}

	double errorWith(const Unit& unit) const
	{
		const Sums sums = sumsWith(unit);
		return sums.weight > 0.0 ? sums.linear / sums.weight - 0.5 * sums.pairs / (sums.weight * sums.weight) + m_form.constant
								 : std::numeric_limits<double>::max(); // units without weight come last
	}

	void take(const Unit& unit)
	{
		m_sums = sumsWith(unit);
		const std::size_t count = m_weights.size();
		for (const std::size_t i : unit)
		{
			for (std::size_t j = 0; j < count; ++j)
			{
				m_rows[j] += m_weights[i] * m_form.pairs[i * count + j];
			}
		}
	}

private:
	struct Sums
	{
		double weight = 0.0;
		double linear = 0.0;
		double pairs = 0.0;
	};

	Sums sumsWith(const Unit& unit) const
	{
		Sums sums = m_sums;
		for (const std::size_t i : unit)
		{
			sums.weight += m_weights[i];
			sums.linear += m_weights[i] * m_form.linear[i];
			sums.pairs += 2.0 * m_weights[i] * m_rows[i];
			for (const std::size_t j : unit)
			{
				sums.pairs += m_weights[i] * m_weights[j] * m_form.pairs[i * m_weights.size() + j];
			}
		}
		return sums;
	}

	const QuadraticForm& m_form;
	const std::vector<double>& m_weights;
	std::vector<double> m_rows; // Σ w_j K_ij over the included samples
	Sums m_sums;
};

// A neighbouring variant that is already ordered, and the weight of its error.
struct Met
{
	const Pattern* variant;
	double share; // weight of the pair, both ways, relative to that of a variant with itself
};

// Error that sample i adds for each prefix length of the neighbours: ½ Σ share (l_i − Σ_j w_j K_ij / W), samples × lengths.
std::vector<double> crossTerms(const Pattern& variant, const QuadraticForm& form, const std::vector<Met>& around)
{
	const std::size_t count = variant.count();
	std::vector<double> terms(count * count, 0.0);
	for (const Met& met : around)
	{
		const std::vector<double> pairs = pairTerms(variant.domain, variant.points, met.variant->points);
		for (std::size_t i = 0; i < count; ++i)
		{
			double weight = 0.0;
			double sum = 0.0;
			for (std::size_t length = 1; length <= count; ++length)
			{
				weight += met.variant->weights[length - 1];
				sum += met.variant->weights[length - 1] * pairs[i * count + length - 1];
				terms[i * count + length - 1] += weight > 0.0 ? 0.5 * met.share * (form.linear[i] - sum / weight) : 0.0;
			}
		}
	}
	return terms;
}

// The units in their new order; `fixed` ones stay first.
std::vector<std::size_t> ordered(const Pattern& variant, const std::vector<Unit>& units, std::size_t fixed,
								 const std::vector<Met>& around)
{
	const QuadraticForm form = quadraticForm(variant.domain, Ensemble::plane, variant.points);
	const std::vector<double> cross = crossTerms(variant, form, around);
	Prefix prefix(form, variant.weights);
	std::vector<std::size_t> order;
	std::vector<char> taken(units.size(), 0);
	std::vector<std::size_t> samples;
	// The mean of the samples' terms if the prefix ended with this unit.
	const auto crossWith = [&](const Unit& unit)
	{
		const std::size_t length = samples.size() + unit.size();
		double weight = 0.0;
		double sum = 0.0;
		const auto add = [&](std::size_t i)
		{
			weight += variant.weights[i];
			sum += variant.weights[i] * cross[i * variant.count() + length - 1];
		};
		std::for_each(samples.begin(), samples.end(), add);
		std::for_each(unit.begin(), unit.end(), add);
		return weight > 0.0 ? sum / weight : 0.0;
	};
	while (order.size() < units.size())
	{
		std::size_t best = order.size();
		double least = std::numeric_limits<double>::infinity();
		for (std::size_t u = 0; u < units.size() && order.size() >= fixed; ++u)
		{
			const double error = taken[u] == 0 ? prefix.errorWith(units[u]) + crossWith(units[u]) : 0.0;
			if (taken[u] == 0 && error < least)
			{
				least = error;
				best = u;
			}
		}
		prefix.take(units[best]);
		taken[best] = 1;
		append(samples, units[best]);
		order.push_back(best);
	}
	return order;
}

std::vector<Unit> unitsOf(const Recipe& structure, std::size_t count)
{
	std::vector<Unit> units;
	if (structure.centre)
	{
		units.push_back({0});
	}
	for (std::size_t i = structure.centre ? 1 : 0; i < count; i += structure.symmetric ? 2 : 1)
	{
		units.push_back(structure.symmetric ? Unit{i, i + 1} : Unit{i});
	}
	return units;
}

// Every variant has its own azimuths and jitters with equal weights.

constexpr double kGolden = 0.6180339887498949;
constexpr double kShake = 0.02; // fraction of a period

// Position of a pixel of a 4 × 4 block, row by row, in a Bayer matrix (nookSliceVariant).
unsigned bayer(unsigned pixel)
{
	const unsigned x = pixel % 4;
	const unsigned y = pixel / 4;
	return 4 * (2 * ((x + y) % 2) + y % 2) + 2 * ((x / 2 + y / 2) % 2) + y / 2;
}

double periodic(double x)
{
	const double inside = x - std::floor(x);
	return inside < 1.0 ? inside : 0.0;
}

// Variables: azimuth and jitter of each slice of each variant; unbounded, since both are periodic.
class SliceTile final : public TileProblem
{
public:
	SliceTile(const Pattern& base, const TileRecipe& recipe, std::size_t variants)
		: m_base(base), m_known(recipe.size == 4), m_azimuth(radicalInverse(recipe.seed - 1, 2)),
		  m_jitter(radicalInverse(recipe.seed - 1, 3)), m_variants(variants)
	{
	}

	// The base, shifted as a whole in each variant: at random or, for the first start, as the kernel shifts it without a tile,
	// which has period 4 × 4. A common shift of all variants changes no error; seeds choose it, the first seed none.
	std::vector<double> start(std::size_t number, Random& random) const override
	{
		std::vector<double> x;
		const auto count = static_cast<double>(m_base.count());
		for (std::size_t v = 0; v < m_variants; ++v)
		{
			const unsigned place = bayer(static_cast<unsigned>(v % 16));
			const bool known = number == 0 && m_known;
			const double azimuth = known ? (place + 0.5) / (16.0 * count) + m_azimuth : random.uniform();
			const double jitter = known ? radicalInverse(place, 2) + 0.5 / 16.0 + m_jitter : random.uniform();
			for (const glm::dvec3& p : m_base.points)
			{
				x.push_back(p.x + azimuth);
				x.push_back(p.y + jitter);
			}
		}
		return x;
	}

	std::vector<double> startNear(std::span<const Pattern> variants, Random& random) const override
	{
		std::vector<double> x;
		for (const Pattern& variant : variants)
		{
			for (const glm::dvec3& p : variant.points)
			{
				x.push_back(p.x + kShake * (random.uniform() - 0.5));
				x.push_back(p.y + kShake * (random.uniform() - 0.5));
			}
		}
		return x;
	}

	bool unpack(std::span<const double> x, VariantUnion& all) const override
	{
		all.points.clear();
		all.weights.clear();
		for (std::size_t i = 0; i < x.size(); i += 2)
		{
			if (!(std::fabs(x[i]) < 1e6 && std::fabs(x[i + 1]) < 1e6))
			{
				return false;
			}
			all.points.emplace_back(periodic(x[i]), periodic(x[i + 1]), 0.0);
			all.weights.push_back(1.0 / static_cast<double>(m_base.count()));
		}
		return true;
	}

	void pullBack(std::span<const double>, const VariantUnion&, const EnergyGradient& by_all,
				  std::span<double> gradient) const override
	{
		for (std::size_t i = 0; i < by_all.points.size(); ++i)
		{
			gradient[2 * i] = by_all.points[i].x;
			gradient[2 * i + 1] = by_all.points[i].y;
		}
	}

private:
	const Pattern& m_base;
	bool m_known;
	double m_azimuth;
	double m_jitter;
	std::size_t m_variants;
};

// This work is based on: T. Gonzalez, "Clustering to minimize the maximum intercluster distance", 1985 (farthest-first order).

// Each next point is the one farthest from all previous ones; the first is nearest to the centre.
std::vector<std::size_t> farthestFirst(const Layout& layout, const Points& free)
{
	// A point and its opposite move together: the distance between two such pairs is the smallest between their points.
	const auto distance = [&](std::size_t a, std::size_t b)
	{
		const double straight = glm::distance(free[a], free[b]);
		return layout.symmetric ? std::min(straight, glm::distance(free[a], -free[b])) : straight;
	};
	const glm::dvec3 middle(0.0, 0.0, isDirectional(layout.domain) ? 1.0 : 0.0);
	std::vector<double> gap(free.size());
	std::size_t next = 0;
	for (std::size_t i = 0; i < free.size(); ++i)
	{
		gap[i] = layout.has_centre ? glm::length(free[i]) : 4.0;
		if (glm::distance(free[i], middle) < glm::distance(free[next], middle))
		{
			next = i;
		}
	}
	if (layout.has_centre && !free.empty())
	{
		next = static_cast<std::size_t>(std::max_element(gap.begin(), gap.end()) - gap.begin());
	}
	std::vector<std::size_t> order;
	std::vector<char> taken(free.size(), 0);
	while (order.size() < free.size())
	{
		order.push_back(next);
		taken[next] = 1;
		std::size_t farthest = next;
		double greatest = -1.0;
		for (std::size_t i = 0; i < free.size(); ++i)
		{
			gap[i] = std::min(gap[i], distance(i, order.back()));
			if (taken[i] == 0 && gap[i] > greatest)
			{
				greatest = gap[i];
				farthest = i;
			}
		}
		next = farthest;
	}
	return order;
}

} // namespace

void orderProgressively(const Pattern& base, const TileRecipe& recipe, std::vector<Pattern>& variants, const RunSettings& run)
{
	const Recipe structure = structureOf(base);
	const std::vector<Unit> units = unitsOf(structure, base.count());
	const TileShares shares = sharesOf(recipe); // offsets within one frame: the mean over frames has the same weight
	const auto size = static_cast<std::size_t>(recipe.size);
	const std::vector<std::size_t> offsets = shares.offsets(size * size);
	ProgressCounter progress(run.progress, "order", variants.size());
	for (std::size_t v = 0; v < variants.size(); ++v)
	{
		std::vector<Met> around;
		for (const std::size_t offset : offsets)
		{
			const std::size_t other =
				v / (size * size) * size * size + (v / size + offset / size) % size * size + (v + offset) % size;
			if (other < v)
			{
				around.push_back({&variants[other], 2.0 * shares.pairs[offset] / shares.pairs[0]});
			}
		}
		Pattern sorted = variants[v];
		std::size_t next = 0;
		for (const std::size_t u : ordered(variants[v], units, structure.centre ? 1 : 0, around))
		{
			for (const std::size_t i : units[u])
			{
				sorted.points[next] = variants[v].points[i];
				sorted.weights[next] = variants[v].weights[i];
				next += 1;
			}
		}
		variants[v] = std::move(sorted);
		progress.finishOne();
	}
}

std::unique_ptr<TileProblem> sliceProblem(const Pattern& base, const TileRecipe& recipe, std::size_t variants)
{
	return std::make_unique<SliceTile>(base, recipe, variants);
}

Pattern slicePattern(int count)
{
	Pattern pattern;
	pattern.domain = Domain::slice;
	for (int i = 0; i < count; ++i)
	{
		pattern.points.emplace_back((i + 0.5) / count, periodic((i + 0.5) * kGolden), 0.0);
		pattern.weights.push_back(1.0 / count);
	}
	return pattern;
}

Points reorder(Order order, const Layout& layout, const Points& points)
{
	if (order == Order::none)
	{
		return points;
	}
	const Points free = layout.freePoints(points);
	return layout.expand(mapped(farthestFirst(layout, free), [&free](std::size_t i) { return free[i]; }));
}

} // namespace nook
