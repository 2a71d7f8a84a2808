// SPDX-License-Identifier: GPL-3.0-or-later
// Builders of patterns: cells against closed forms of slabs, the squared error against sums in 80 bits, tiles.
#include "core/math.h"
#include "measure/quality.h"
#include "pattern/cells.h"
#include "pattern/energy.h"
#include "pattern/tile.h"
#include "stress/case.h"
#include "stress/numbers.h"

#include <algorithm>
#include <array>
#include <vector>

namespace nook::stress
{
namespace
{

using Long = long double;

// Share of the ball (and of the disk's lines) on the near side of a plane at that signed distance: (1 + c)² (2 − c) / 4.
Long ballShare(Long c)
{
	const Long inside = std::clamp(c, -1.0L, 1.0L);
	return (1.0L + inside) * (1.0L + inside) * (2.0L - inside) / 4.0L;
}

void notePoints(Case& one, const std::vector<glm::dvec3>& points)
{
	if (one.shown())
	{
		for (const glm::dvec3& point : points)
		{
			one.note("point", point);
		}
	}
}

double sumOf(const std::vector<double>& values)
{
	double sum = 0.0;
	for (const double value : values)
	{
		sum += value;
	}
	return sum;
}

// Points on one line through the middle: cells are slabs, whose shares are known. Distances between them down to 2⁻¹⁷, 7.6·10⁻⁶.
void runSlabs(Case& one)
{
	const Domain domain = one.random.below(2) == 0 ? Domain::disk : Domain::ball;
	glm::dvec3 along = hardDirection(one.random);
	if (domain == Domain::disk)
	{
		along.z = 0.0;
		along = glm::dot(along, along) > 1e-6 ? glm::normalize(along) : glm::dvec3(1, 0, 0);
	}
	std::vector<double> places(2 + one.random.below(12));
	for (double& place : places)
	{
		place = between(one.random, -1.0, 1.0);
		if (one.random.below(3) == 0)
		{
			place = std::clamp(places[0] + signOf(one.random) * octaves(one.random, -17.0, 0.0), -1.0, 1.0);
		}
	}
	std::sort(places.begin(), places.end());
	places.erase(std::unique(places.begin(), places.end()), places.end());
	std::vector<glm::dvec3> points;
	for (const double place : places)
	{
		points.push_back(place * along);
	}
	notePoints(one, points);
	// Rounding of two points turns the plane between them by this over their distance.
	double least = 1.0;
	for (std::size_t i = 1; i < places.size(); ++i)
	{
		least = std::min(least, places[i] - places[i - 1]);
	}
	const double unit = std::max(1.0, 1e-3 / least);
	one.note("least distance", least);
	const Cells cells = exactCells(domain, points);
	one.compare("sum", sumOf(cells.integrals), 1.0L);
	for (std::size_t i = 0; i < places.size(); ++i)
	{
		const Long lower = i == 0 ? -1.0L : (static_cast<Long>(places[i - 1]) + static_cast<Long>(places[i])) / 2.0L;
		const Long upper = i + 1 == places.size() ? 1.0L : (static_cast<Long>(places[i]) + static_cast<Long>(places[i + 1])) / 2.0L;
		one.result("integral", cells.integrals[i], 0.0, 1.0 + 1e-12);
		one.compare("integral", cells.integrals[i], ballShare(upper) - ballShare(lower), unit);
	}
}

// Anything: the same point twice, points on the rim, in clusters; whole and no share below 0.
void runCells(Case& one)
{
	const auto domain = static_cast<Domain>(one.random.below(3)); // disk, ball, sphere
	std::vector<glm::dvec3> points(1 + one.random.below(24));
	const double cluster = octaves(one.random, -17.0, 0.0);
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		glm::dvec3& point = points[i];
		point = hardDirection(one.random) * (domain == Domain::sphere || one.random.below(4) == 0 ? 1.0 : one.random.uniform());
		if (one.random.below(5) == 0)
		{
			point = points[0] + cluster * hardDirection(one.random);
		}
		point.z = domain == Domain::disk ? 0.0 : point.z;
		const double length = glm::length(point);
		if (domain == Domain::sphere || length > 1.0)
		{
			point = length > 0.0 ? point / length : glm::dvec3(0, 0, 1);
		}
		// Either the same or 10⁻⁶ away: closer pairs, which no 32-bit pattern holds, are merged by rounding here and not there.
		for (std::size_t k = 0; k < i; ++k)
		{
			point = glm::distance(point, points[k]) < 1e-6 ? points[k] : point;
		}
		if (i > 0 && one.random.below(5) == 0)
		{
			point = points[one.random.below(static_cast<uint32_t>(i))];
		}
	}
	notePoints(one, points);
	const Cells cells = exactCells(domain, points);
	one.compare("sum", sumOf(cells.integrals), 1.0L);
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		one.result("integral", cells.integrals[i], 0.0, 1.0 + 1e-12);
		// A moment to 1e-16 or so, over the share.
		one.result("centroid", glm::length(cells.centroids[i]), 0.0, 1.0 + 1e-9 + 1e-15 / std::max(cells.integrals[i], 1e-12));
	}
}

// Mean distance between random points of the lines |z| ≤ a and |z| ≤ b, apart by ρ in the plane, in 80 bits
// (docs/reference/measures.md).
Long lineDistance(Long rho2, Long a, Long b)
{
	const auto g = [rho2](Long t)
	{
		const Long s = std::sqrt(rho2 + t * t);
		const Long l = rho2 > 0.0L ? std::asinh(t / std::sqrt(rho2)) : 0.0L;
		return s * s * s / 6.0L + rho2 * (t * l - s) / 2.0L;
	};
	if (a < 1e-6L || b < 1e-6L)
	{
		const Long t = std::max(a, b);
		if (t < 1e-6L)
		{
			return std::sqrt(rho2);
		}
		const Long s = std::sqrt(rho2 + t * t);
		return 0.5L * (s + (rho2 > 0.0L ? rho2 * std::asinh(t / std::sqrt(rho2)) / t : 0.0L));
	}
	return (g(a + b) - g(std::fabs(a - b))) / (2.0L * a * b);
}

// ¼ (Σ w_i U_i − ½ Σ w_i w_j K_ij − ½ C), C = 36/35: the squared error over all half-spaces.
Long energyTwin(Domain domain, const std::vector<glm::dvec3>& points, const std::vector<double>& weights)
{
	Long own = 0.0L;
	Long pairs = 0.0L;
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		const auto squared = [](const glm::dvec3& p)
		{
			return static_cast<Long>(p.x) * static_cast<Long>(p.x) + static_cast<Long>(p.y) * static_cast<Long>(p.y) +
				   static_cast<Long>(p.z) * static_cast<Long>(p.z);
		};
		const Long r2 = squared(points[i]);
		const Long a2 = std::max(1.0L - r2, 0.0L);
		const Long fourth = r2 * r2 + 2.0L / 3.0L * r2 * a2 + a2 * a2 / 5.0L; // mean of |p|⁴ over the line
		const Long u =
			domain == Domain::ball ? 0.75L + r2 / 2.0L - r2 * r2 / 20.0L : 0.75L + (r2 + a2 / 3.0L) / 2.0L - fourth / 20.0L;
		own += static_cast<Long>(weights[i]) * u;
		for (std::size_t j = 0; j < points.size(); ++j)
		{
			const Long rho2 = squared(points[i] - points[j]);
			const Long b2 = std::max(1.0L - squared(points[j]), 0.0L);
			const Long k = domain == Domain::ball ? std::sqrt(rho2) : lineDistance(rho2, std::sqrt(a2), std::sqrt(b2));
			pairs += static_cast<Long>(weights[i]) * static_cast<Long>(weights[j]) * k;
		}
	}
	return (own - pairs / 2.0L - 36.0L / 70.0L) / 4.0L;
}

void runEnergy(Case& one)
{
	const Domain domain = one.random.below(2) == 0 ? Domain::disk : Domain::ball;
	std::vector<glm::dvec3> points(1 + one.random.below(16));
	std::vector<double> weights;
	double sum = 0.0;
	for (glm::dvec3& point : points)
	{
		point =
			hardDirection(one.random) * (one.random.below(6) == 0 ? 1.0 - octaves(one.random, -50.0, -1.0) : one.random.uniform());
		point.z = domain == Domain::disk ? 0.0 : point.z;
		if (one.random.below(6) == 0)
		{
			point = points[0] * (1.0 - octaves(one.random, -40.0, -1.0));
		}
		weights.push_back(one.random.uniform());
		sum += weights.back();
	}
	for (double& weight : weights)
	{
		weight = sum > 0.0 ? weight / sum : 1.0 / static_cast<double>(points.size());
	}
	notePoints(one, points);
	EnergyGradient gradient;
	const double found = squaredError(domain, Ensemble::plane, Part::whole, points, weights, &gradient);
	one.result("squared error", found, -1e-13, 1.0);
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		one.result("gradient", glm::length(gradient.points[i]), 0.0, 1e12);
		one.result("by weight", gradient.weights[i], -10.0, 10.0);
	}
	one.compare("squared error", found, energyTwin(domain, points, weights));
}

// Tiles of small patterns: weights and places of all variants; with points of their own now and then, since that takes a search.
void runTile(Case& one)
{
	Pattern base;
	base.domain = one.random.below(2) == 0 ? Domain::disk : Domain::hemisphere;
	const auto count = 1 + one.random.below(4);
	for (uint32_t i = 0; i < count; ++i)
	{
		const double r = one.random.below(6) == 0 ? (one.random.below(2) == 0 ? 0.0 : 1.0) : std::sqrt(one.random.uniform());
		const SinCos angle = sinCosOf(between(one.random, 0.0, 2.0 * kPi));
		const double z = base.domain == Domain::disk ? 0.0 : std::sqrt(std::max(0.0, 1.0 - r * r));
		base.points.emplace_back(r * angle.cos, r * angle.sin, z);
		base.weights.push_back(1.0 / count);
	}
	TileRecipe recipe;
	recipe.size = 2;
	recipe.seed = one.random.next();
	recipe.kind = one.index() % 8 == 0 ? TileKind::points : one.index() % 2 == 0 ? TileKind::even : TileKind::random;
	recipe.starts = recipe.kind == TileKind::points ? 1 : 0;
	notePoints(one, base.points);
	one.note("kind", static_cast<int>(recipe.kind));
	const PatternTile tile = generateTile(base, recipe);
	one.require("four variants", tile.variants.size() == 4);
	for (const Pattern& variant : tile.variants)
	{
		one.compare("sum of weights", sumOf(variant.weights), 1.0L);
		for (std::size_t i = 0; i < variant.points.size(); ++i)
		{
			const double least = base.domain == Domain::hemisphere ? 1.0 - 1e-6 : 0.0; // directions are of length 1
			one.result("length", glm::length(variant.points[i]), least, 1.0 + 1e-6);
			one.result("weight", variant.weights[i], 0.0, 1.0 + 1e-6);
		}
	}
}

constexpr std::array kPatternsKernels{
	StressKernel{"cells-slabs", "builders", "closed forms of slabs in 80 bits", "share of the domain, for 1/1000 between points",
				 8e-15, 2, 1, runSlabs},
	StressKernel{"cells", "builders", "their sum: points twice, in clusters down to 8e-6, on the rim", "share of the domain",
				 2.5e-10, 2, 1, runCells},
	StressKernel{"energy", "builders", "the energy distance in 80 bits", "squared error", 2e-5, 20, 1, runEnergy},
	StressKernel{"tile", "builders", "the sum of its weights", "weight", 2.5e-7, 1, 1, runTile},
};

} // namespace

std::span<const StressKernel> patternKernels()
{
	return kPatternsKernels;
}

} // namespace nook::stress
