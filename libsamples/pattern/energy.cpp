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
#include "pattern/energy_kernels.h"

#include <array>
#include <cassert>

#include <glm/geometric.hpp>

namespace nook
{
namespace
{

// Contributions of samples to the squared error and its gradient, one row per sample: from the domain, and from pairs of samples.

using namespace kernels;

struct Setup
{
	Domain domain;
	Ensemble ensemble;
	double factor;
	double self; // C

	bool lines() const
	{
		return domain == Domain::disk && ensemble == Ensemble::plane;
	}
};

Setup makeSetup(Domain domain, Ensemble ensemble)
{
	if (ensemble == Ensemble::cliff)
	{
		assert(domain == Domain::disk);
		return {domain, ensemble, 1.0 / kPi, 0.5 * kPi * 18.0 / 35.0};
	}
	switch (domain)
	{
	case Domain::disk:
	case Domain::ball: return {domain, ensemble, 0.25, 36.0 / 35.0};
	case Domain::sphere: return {domain, ensemble, 0.25, 4.0 / 3.0};
	case Domain::slice: return {domain, ensemble, 1.0 / 3.0, -2.0 * kTorusMean};
	case Domain::hemisphere: break;
	}
	return {domain, ensemble, 0.25, cosineSeries().self};
}

struct Sample
{
	glm::dvec3 p;
	double half; // half length of the line, 0 for points
	double weight;
};

std::vector<Sample> makeSamples(const Setup& setup, std::span<const glm::dvec3> points, std::span<const double> weights)
{
	const auto sampleOf = [&](std::size_t i)
	{
		const double a2 = 1.0 - glm::dot(points[i], points[i]);
		return Sample{points[i], setup.lines() && a2 > 0.0 ? std::sqrt(a2) : 0.0, weights[i]};
	};
	return listOf(points.size(), sampleOf);
}

struct RowTerms
{
	double potential = 0.0;   // U_i
	double pairs = 0.0;       // Σ_j w_j K_ij
	glm::dvec3 gradient{0.0}; // derivative of U_i − Σ_j w_j K_ij by p_i
};

void addPotential(const Setup& setup, const Sample& sample, RowTerms& row)
{
	const double r2 = glm::dot(sample.p, sample.p);
	if (setup.domain == Domain::slice)
	{
		row.potential = -2.0 * kTorusMean;
		return;
	}
	if (setup.domain == Domain::sphere)
	{
		row.potential = 4.0 / 3.0;
		return;
	}
	if (setup.domain == Domain::hemisphere)
	{
		const Potential u = hemispherePotential(sample.p.z);
		row.potential = u.value;
		row.gradient.z += u.slope;
		return;
	}
	const Potential u = setup.ensemble == Ensemble::cliff ? cliffPotential(r2)
						: setup.domain == Domain::disk    ? linePotential(r2)
														  : ballPotential(r2);
	row.potential = u.value;
	row.gradient += 2.0 * u.slope * sample.p;
}

// Adds scale · w_j · K(p_i, q) and its gradient, where q is sample j or a rotated copy of it. `same` marks i = j.
void addPair(const Setup& setup, const Sample& i, const glm::dvec3& q, const Sample& j, bool same, double scale, RowTerms& row)
{
	const double w = scale * j.weight;
	if (setup.domain == Domain::slice)
	{
		const TorusDistance k = torusDistance(i.p - q);
		row.pairs += w * k.value;
		row.gradient -= same ? glm::dvec3(0.0) : w * k.gradient;
		return;
	}
	if (same)
	{
		row.pairs += w * 2.0 / 3.0 * i.half; // mean |z − z'| within one line
		if (i.half > 0.0)
		{
			// ½w²K_ii depends on p_i once; the row convention counts ∂₁K, half of the total derivative.
			row.gradient += w / (3.0 * i.half) * i.p;
		}
		return;
	}
	const glm::dvec3 difference = i.p - q;
	const double rho2 = glm::dot(difference, difference);
	const PairDistance k = setup.lines() ? lineDistance(rho2, i.half, j.half) : pointDistance(rho2);
	row.pairs += w * k.value;
	row.gradient -= 2.0 * w * k.by_rho2 * difference;
	if (k.by_a != 0.0)
	{
		row.gradient += w * k.by_a / i.half * i.p; // ∂a/∂p = −p/a
	}
}

// Adds share · K(a, b) of two different samples, with its gradient, to both rows.
void addPairBothWays(const Setup& setup, const Sample& a, const Sample& b, double share, RowTerms& row_a, RowTerms& row_b)
{
	const glm::dvec3 difference = a.p - b.p;
	const double weight_a = share * a.weight;
	const double weight_b = share * b.weight;
	if (setup.domain == Domain::slice)
	{
		const TorusDistance k = torusDistance(difference);
		row_a.pairs += weight_b * k.value;
		row_b.pairs += weight_a * k.value;
		row_a.gradient -= weight_b * k.gradient;
		row_b.gradient += weight_a * k.gradient;
		return;
	}
	const PairDistance k = pointDistance(glm::dot(difference, difference));
	row_a.pairs += weight_b * k.value;
	row_b.pairs += weight_a * k.value;
	row_a.gradient -= (2.0 * weight_b * k.by_rho2) * difference;
	row_b.gradient += (2.0 * weight_a * k.by_rho2) * difference;
}

// Adds pairs of samples to both rows in the order in which they came; batches pairs of lines.
class PairSum
{
public:
	PairSum(const Setup& setup, std::span<const Sample> samples, std::span<RowTerms> rows)
		: m_setup(setup), m_samples(samples), m_rows(rows)
	{
	}
	PairSum& operator=(PairSum&&) = delete;
	~PairSum()
	{
		addLines();
	}

	// Accepts i = j.
	void add(std::size_t i, std::size_t j, double share)
	{
		const Sample& a = m_samples[i];
		const Sample& b = m_samples[j];
		if (!m_setup.lines())
		{
			i == j ? addPair(m_setup, a, a.p, a, true, share, m_rows[i])
				   : addPairBothWays(m_setup, a, b, share, m_rows[i], m_rows[j]);
			return;
		}
		const glm::dvec3 difference = a.p - b.p;
		m_index[m_count] = {i, j};
		m_share[m_count] = share;
		m_lines.rho2[m_count] = glm::dot(difference, difference);
		m_lines.half_a[m_count] = a.half;
		m_lines.half_b[m_count] = b.half;
		m_lines.weight_a[m_count] = share * a.weight;
		m_lines.weight_b[m_count] = share * b.weight;
		if (++m_count == LinePairs::kMost)
		{
			addLines();
		}
	}

private:
	void addLines()
	{
		findTerms(m_lines, m_count);
		for (std::size_t k = 0; k < m_count; ++k)
		{
			const auto [i, j] = m_index[k];
			const glm::dvec3& a = m_samples[i].p;
			const glm::dvec3& b = m_samples[j].p;
			RowTerms& row_a = m_rows[i];
			RowTerms& row_b = m_rows[j];
			if (i == j)
			{
				addPair(m_setup, m_samples[i], a, m_samples[i], true, m_share[k], row_a);
				continue;
			}
			row_a.pairs += m_lines.weight_b[k] * m_lines.distance[k];
			row_b.pairs += m_lines.weight_a[k] * m_lines.distance[k];
			row_a.gradient -= m_lines.along_a[k] * (a - b);
			row_b.gradient += m_lines.along_b[k] * (a - b);
			row_a.gradient += m_lines.turn_a[k] * a;
			row_b.gradient += m_lines.turn_b[k] * b;
		}
		m_count = 0;
	}

	const Setup& m_setup;
	std::span<const Sample> m_samples;
	std::span<RowTerms> m_rows;
	LinePairs m_lines;
	LinePairs::Of<std::array<std::size_t, 2>> m_index;
	LinePairs::Of<double> m_share;
	std::size_t m_count = 0;
};

// Rotations that approximate all: the mean over the angle is smooth, and the trapezoid rule's error is below 1e-6 of plane².
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
	return listOf(static_cast<std::size_t>(count),
				  [count](std::size_t m) {
					  return m == 0 ? SinCos{0.0, 1.0} : sinCosOf(2.0 * kPi * static_cast<double>(m) / count);
				  });
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

// Squared error of means over the variants of a tile.

std::vector<std::size_t> TileShares::offsets(std::size_t end) const
{
	return indicesWhere(end, [&](std::size_t offset) { return offset > 0 && pairs[offset] != 0.0; });
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
