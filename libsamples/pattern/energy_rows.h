// SPDX-License-Identifier: GPL-3.0-or-later
// Contributions of samples to the squared error and its gradient, one row per sample: from the domain, and from pairs of samples.
// For energy.cpp, which states the formulas.
#pragma once

#include "pattern/energy.h"
#include "pattern/energy_kernels.h"
#include "pattern/line_pairs.h"

#include <array>
#include <cassert>
#include <span>
#include <vector>

#include <glm/geometric.hpp>

namespace nook::energy
{

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

inline Setup makeSetup(Domain domain, Ensemble ensemble)
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

inline std::vector<Sample> makeSamples(const Setup& setup, std::span<const glm::dvec3> points, std::span<const double> weights)
{
	std::vector<Sample> samples(points.size());
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		const double a2 = 1.0 - glm::dot(points[i], points[i]);
		samples[i] = {points[i], setup.lines() && a2 > 0.0 ? std::sqrt(a2) : 0.0, weights[i]};
	}
	return samples;
}

struct RowTerms
{
	double potential = 0.0;   // U_i
	double pairs = 0.0;       // Σ_j w_j K_ij
	glm::dvec3 gradient{0.0}; // derivative of U_i − Σ_j w_j K_ij by p_i
};

inline void addPotential(const Setup& setup, const Sample& sample, RowTerms& row)
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
inline void addPair(const Setup& setup, const Sample& i, const glm::dvec3& q, const Sample& j, bool same, double scale,
					RowTerms& row)
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
inline void addPairBothWays(const Setup& setup, const Sample& a, const Sample& b, double share, RowTerms& row_a, RowTerms& row_b)
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
	PairSum(const PairSum&) = delete;
	PairSum& operator=(const PairSum&) = delete;
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

} // namespace nook::energy
