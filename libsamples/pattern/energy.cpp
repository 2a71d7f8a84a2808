// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: G. Székely and M. Rizzo, "Energy statistics: a class of statistics based on distances", 2013, and K.
// Stolarsky, "Sums of distances between points on a sphere II", 1973.
//
// For one direction n, the pattern's free share of the half-space n·x > c, as a function of c, is the distribution function of the
// pattern projected on n; the exact share V(c) is that of the domain. The mean square over c is Cramér's distance of the two, and
// ∫(F − G)² dc = E|X − Y| − ½E|X − X'| − ½E|Y − Y'|, X from the pattern, Y from the domain. Averaged over the directions of space,
// |n·v| becomes |v|/2 (in the plane: 2|v|/π), and c is uniform over an interval of length 2, so
//     plane² = ¼ (Σ w_i U_i − ½ Σ w_i w_j K_ij − ½ C),     cliff² = 1/π (the same with distances in the plane),
// with U_i the mean distance from sample i to the domain, K_ij that between two samples, and C that within the domain. A line
// sample is a segment: its mean distances are integrals of √(ρ² + t²). So the error needs no grid of half-spaces and has a smooth
// gradient.
//
// Slices: the open part along an azimuth and at a jitter of the steps is modelled as a random periodic interval of azimuths, of
// jitters, or a box of both; plane² is the mean square over the three. That is a third of the wrap-around discrepancy of F.
// Hickernell, "Lattice rules: how well do they measure up?", 1998: Σ w_i w_j Π (3/2 − d(1 − d)) − (4/3)², with d the distance along
// each axis.
#include "pattern/energy.h"

#include "core/lists.h"
#include "core/parallel.h"
#include "pattern/energy_rows.h"

namespace nook
{
namespace
{

using namespace energy;

// Number of rotations that approximate all of them: the mean over the angle is smooth, and the trapezoid rule's error at 48 is
// below 1e-6 of plane².
constexpr int kBiasRotations = 48;

// All rows of the whole part at once; each pair is computed once for both of its samples.
void addPairsBothWays(const Setup& setup, std::span<const Sample> samples, std::span<RowTerms> rows)
{
	PairSum sum(setup, samples, rows);
	for (std::size_t i = 0; i < samples.size(); ++i)
	{
		for (std::size_t j = i; j < samples.size(); ++j)
		{
			sum.add(i, j, 1.0);
		}
	}
}

// One row of the mean over rotations about z. The whole part uses only the identity.
void addPlanarRow(const Setup& setup, std::span<const Sample> samples, std::size_t i, std::span<const SinCos> turns, double sign,
				  RowTerms& row)
{
	const double scale = sign / static_cast<double>(turns.size());
	for (std::size_t j = 0; j < samples.size(); ++j)
	{
		const glm::dvec3& p = samples[j].p;
		for (std::size_t m = 0; m < turns.size(); ++m)
		{
			const SinCos& turn = turns[m];
			const glm::dvec3 q(turn.cos * p.x - turn.sin * p.y, turn.sin * p.x + turn.cos * p.y, p.z);
			addPair(setup, samples[i], q, samples[j], i == j && m == 0, scale, row);
		}
	}
}

// One row of the mean over all rotations in space.
void addShellRow(std::span<const Sample> samples, std::size_t i, double sign, RowTerms& row)
{
	const double r2 = glm::dot(samples[i].p, samples[i].p);
	for (const Sample& other : samples)
	{
		const PairDistance k = shellDistance(r2, glm::dot(other.p, other.p));
		row.pairs += sign * other.weight * k.value;
		row.gradient -= 2.0 * sign * other.weight * k.by_rho2 * samples[i].p;
	}
}

std::vector<SinCos> evenTurns(int count)
{
	std::vector<SinCos> turns;
	for (int m = 0; m < count; ++m)
	{
		turns.push_back(m == 0 ? SinCos{0.0, 1.0} : sinCosOf(2.0 * kPi * m / count));
	}
	return turns;
}

// Pairs of one group's samples with each other and with the groups at half of the offsets; the opposite offset is the same pair
// seen from the other group.
void addGroupPairs(const Setup& setup, const TileShares& shares, std::span<const std::size_t> offsets,
				   std::span<const Sample> samples, std::size_t group, std::size_t count, std::span<RowTerms> rows)
{
	const auto size = static_cast<std::size_t>(shares.size);
	const auto frames = static_cast<std::size_t>(shares.frames);
	const std::size_t first = group * count;
	PairSum sum(setup, samples, rows);
	for (std::size_t i = first; i < first + count && shares.pairs[0] != 0.0; ++i)
	{
		for (std::size_t j = i; j < first + count; ++j)
		{
			sum.add(i, j, shares.pairs[0]);
		}
	}
	for (const std::size_t offset : offsets)
	{
		const std::size_t dx = offset % size;
		const std::size_t dy = offset / size % size;
		const std::size_t df = offset / (size * size);
		const std::size_t opposite = ((frames - df) % frames * size + (size - dy) % size) * size + (size - dx) % size;
		const std::size_t other =
			((group / (size * size) + df) % frames * size + (group / size % size + dy) % size) * size + (group % size + dx) % size;
		// An offset that is its own opposite occurs in both groups; count it once.
		if (offset > opposite || (offset == opposite && other < group))
		{
			continue;
		}
		for (std::size_t i = first; i < first + count; ++i)
		{
			for (std::size_t j = other * count; j < (other + 1) * count; ++j)
			{
				sum.add(i, j, shares.pairs[offset]);
			}
		}
	}
}

// Sums run in a fixed order for any number of threads. Each task holds sums of all samples: 80 MB per million.
std::size_t tileTasks(std::size_t samples)
{
	return samples <= 1024 ? 1 : samples <= (std::size_t{1} << 18U) ? 16 : 2;
}

} // namespace

double squaredError(Domain domain, Ensemble ensemble, Part part, std::span<const glm::dvec3> points,
					std::span<const double> weights, EnergyGradient* gradient, int threads)
{
	assert(points.size() == weights.size());
	const Setup setup = makeSetup(domain, ensemble);
	const std::vector<Sample> samples = makeSamples(setup, points, weights);
	const bool spatial = domain == Domain::ball || domain == Domain::sphere;
	const std::vector<SinCos> identity = evenTurns(1);
	const std::vector<SinCos> turns =
		part == Part::whole ? identity : evenTurns(part == Part::window ? kWindowRotations : kBiasRotations);

	// Small sets compute each pair once; large ones compute it twice, in rows that can run in parallel. Only the count decides.
	const bool small = samples.size() <= 1024;
	const bool noise = part == Part::noise;
	const bool paired = part == Part::whole || noise;
	std::vector<RowTerms> rows(samples.size());
	if (small && paired)
	{
		addPairsBothWays(setup, samples, rows);
	}
	const auto finish_row = [&](std::size_t i)
	{
		if (!noise) // the variance over rotations has no linear part
		{
			addPotential(setup, samples[i], rows[i]);
		}
		if (!small && paired)
		{
			addPlanarRow(setup, samples, i, identity, 1.0, rows[i]);
		}
		if (part != Part::whole && spatial)
		{
			addShellRow(samples, i, noise ? -1.0 : 1.0, rows[i]);
		}
		else if (part != Part::whole)
		{
			addPlanarRow(setup, samples, i, turns, noise ? -1.0 : 1.0, rows[i]);
		}
	};
	parallelFor(samples.size(), small ? 1 : threads, finish_row);

	double sum = part == Part::noise ? 0.0 : -0.5 * setup.self;
	for (std::size_t i = 0; i < samples.size(); ++i)
	{
		sum += weights[i] * (rows[i].potential - 0.5 * rows[i].pairs);
	}
	if (gradient != nullptr)
	{
		gradient->points.resize(samples.size());
		gradient->weights.resize(samples.size());
		for (std::size_t i = 0; i < samples.size(); ++i)
		{
			gradient->points[i] = setup.factor * weights[i] * rows[i].gradient;
			gradient->weights[i] = setup.factor * (rows[i].potential - rows[i].pairs);
		}
	}
	return setup.factor * sum;
}

QuadraticForm quadraticForm(Domain domain, Ensemble ensemble, std::span<const glm::dvec3> points)
{
	const Setup setup = makeSetup(domain, ensemble);
	const std::size_t count = points.size();
	const std::vector<double> ones(count, 1.0);
	const std::vector<Sample> samples = makeSamples(setup, points, ones);
	QuadraticForm form;
	form.linear.resize(count);
	form.pairs.resize(count * count);
	form.constant = -0.5 * setup.factor * setup.self;
	for (std::size_t i = 0; i < count; ++i)
	{
		RowTerms row;
		addPotential(setup, samples[i], row);
		form.linear[i] = setup.factor * row.potential;
		for (std::size_t j = 0; j < count; ++j)
		{
			RowTerms pair;
			addPair(setup, samples[i], samples[j].p, samples[j], i == j, 1.0, pair);
			form.pairs[i * count + j] = setup.factor * pair.pairs;
		}
	}
	return form;
}

std::vector<double> pairTerms(Domain domain, std::span<const glm::dvec3> first, std::span<const glm::dvec3> second)
{
	const Setup setup = makeSetup(domain, Ensemble::plane);
	const std::vector<Sample> rows = makeSamples(setup, first, std::vector<double>(first.size(), 1.0));
	const std::vector<Sample> columns = makeSamples(setup, second, std::vector<double>(second.size(), 1.0));
	std::vector<double> pairs;
	pairs.reserve(first.size() * second.size());
	for (const Sample& row : rows)
	{
		for (const Sample& column : columns)
		{
			RowTerms pair;
			addPair(setup, row, column.p, column, false, 1.0, pair);
			pairs.push_back(setup.factor * pair.pairs);
		}
	}
	return pairs;
}

// Squared error of means over the variants of a tile. The formulas are in energy.cpp.

using namespace energy;

std::vector<std::size_t> TileShares::offsets(std::size_t end) const
{
	std::vector<std::size_t> weighted;
	for (std::size_t offset = 1; offset < end; ++offset)
	{
		if (pairs[offset] != 0.0)
		{
			weighted.push_back(offset);
		}
	}
	return weighted;
}

double tileSquaredError(Domain domain, const TileShares& shares, std::span<const glm::dvec3> points,
						std::span<const double> weights, EnergyGradient* gradient, int threads, ProgressCounter* progress)
{
	const std::size_t groups = shares.pairs.size();
	assert(points.size() == weights.size() && points.size() % groups == 0);
	const Setup setup = makeSetup(domain, Ensemble::plane);
	const std::vector<Sample> samples = makeSamples(setup, points, weights);
	const std::size_t tasks = tileTasks(samples.size());
	const std::vector<std::size_t> offsets = shares.offsets(groups);
	std::vector<std::vector<RowTerms>> parts(tasks, std::vector<RowTerms>(samples.size()));
	parallelFor(tasks, threads,
				[&](std::size_t task)
				{
					for (std::size_t group = groups * task / tasks; group < groups * (task + 1) / tasks; ++group)
					{
						addGroupPairs(setup, shares, offsets, samples, group, samples.size() / groups, parts[task]);
						if (progress != nullptr)
						{
							progress->finishOne();
						}
					}
				});
	double total = sumOver(shares.pairs);
	if (gradient != nullptr)
	{
		gradient->points.resize(samples.size());
		gradient->weights.resize(samples.size());
	}
	const double factor = setup.factor / static_cast<double>(groups);
	double sum = -0.5 * setup.self * total * static_cast<double>(groups);
	for (std::size_t i = 0; i < samples.size(); ++i)
	{
		RowTerms row = parts[0][i];
		for (std::size_t task = 1; task < tasks; ++task)
		{
			row.pairs += parts[task][i].pairs;
			row.gradient += parts[task][i].gradient;
		}
		RowTerms own;
		addPotential(setup, samples[i], own);
		sum += weights[i] * (total * own.potential - 0.5 * row.pairs);
		if (gradient != nullptr)
		{
			gradient->points[i] = factor * weights[i] * (total * own.gradient + row.gradient);
			gradient->weights[i] = factor * (total * own.potential - row.pairs);
		}
	}
	return factor * sum;
}

} // namespace nook
