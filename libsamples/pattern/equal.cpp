// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: J. Kitagawa, Q. Mérigot, B. Thibert, "Convergence of a Newton algorithm for semi-discrete optimal
// transport", 2019, and F. de Goes et al., "Blue noise through optimal transport", 2012.
#include "core/error.h"
#include "core/math.h"
#include "pattern/eigen.h"
#include "pattern/methods.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace nook
{
namespace
{

struct Residual
{
	Cells cells;
	double error = 0.0; // greatest |integral − 1/count| · count
	double least = 0.0; // least integral · count
};

Residual residualOf(Domain domain, std::span<const glm::dvec3> points, const std::vector<double>& powers)
{
	Residual residual;
	residual.cells = exactCells(domain, points, powers);
	const auto count = static_cast<double>(points.size());
	residual.least = count;
	for (const double integral : residual.cells.integrals)
	{
		residual.error = std::max(residual.error, std::fabs(integral * count - 1.0));
		residual.least = std::min(residual.least, integral * count);
	}
	return residual;
}

// How fast a border's mass changes when one of the two powers grows.
double stiffness(Domain domain, std::span<const glm::dvec3> points, const std::vector<double>& powers, const Facet& facet)
{
	const auto a = static_cast<std::size_t>(facet.a);
	const auto b = static_cast<std::size_t>(facet.b);
	if (domain == Domain::sphere) // on the sphere the border is where x·(q_a − q_b) = 0, q = e^power p
	{
		const glm::dvec3 qa = expOf(powers[a]) * glm::normalize(points[a]);
		const glm::dvec3 qb = expOf(powers[b]) * glm::normalize(points[b]);
		return 0.5 * glm::dot(qa + qb, facet.moment) / glm::length(qa - qb);
	}
	glm::dvec3 difference = points[a] - points[b];
	difference.z = isPlanar(domain) ? 0.0 : difference.z;
	return 0.5 * facet.mass / glm::length(difference);
}

// The Newton step: solves the graph Laplacian of the borders with one power fixed.
std::vector<double> newtonStep(Domain domain, std::span<const glm::dvec3> points, const std::vector<double>& powers,
							   const Cells& cells)
{
	const auto n = static_cast<Eigen::Index>(points.size());
	std::vector<Eigen::Triplet<double>> entries;
	for (const Facet& facet : cells.facets)
	{
		const double k = stiffness(domain, points, powers, facet);
		const Eigen::Index held = n - 1;
		if (facet.a != held)
		{
			entries.emplace_back(facet.a, facet.a, k);
		}
		if (facet.b != held)
		{
			entries.emplace_back(facet.b, facet.b, k);
		}
		if (facet.a != held && facet.b != held)
		{
			entries.emplace_back(facet.a, facet.b, -k);
			entries.emplace_back(facet.b, facet.a, -k);
		}
	}
	Eigen::SparseMatrix<double> laplacian(n - 1, n - 1);
	laplacian.setFromTriplets(entries.begin(), entries.end());
	Eigen::VectorXd wanted(n - 1);
	for (Eigen::Index i = 0; i + 1 < n; ++i)
	{
		wanted(i) = 1.0 / static_cast<double>(n) - cells.integrals[static_cast<std::size_t>(i)];
	}
	const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(laplacian);
	if (factors.info() != Eigen::Success)
	{
		return {};
	}
	const Eigen::VectorXd step = factors.solve(wanted);
	std::vector<double> result(step.data(), step.data() + step.size());
	result.push_back(0.0);
	return result;
}

} // namespace

std::vector<double> equalisingPowers(Domain domain, std::span<const glm::dvec3> points)
{
	std::vector<double> powers(points.size(), 0.0);
	if (points.size() == 1)
	{
		return powers;
	}
	Residual residual = residualOf(domain, points, powers);
	const double floor = 0.5 * std::min(residual.least, 1.0);
	for (int round = 0; round < 100 && residual.error > 1e-12; ++round)
	{
		const std::vector<double> step = newtonStep(domain, points, powers, residual.cells);
		bool accepted = false;
		std::vector<double> candidate(powers.size());
		for (double damping = 1.0; !step.empty() && damping > 1e-6 && !accepted; damping *= 0.5)
		{
			for (std::size_t i = 0; i < powers.size(); ++i)
			{
				candidate[i] = powers[i] + damping * step[i];
			}
			Residual next = residualOf(domain, points, candidate);
			// No cell may shrink below half the smallest initial one, and the error must fall in proportion to the damping.
			accepted = next.least >= floor && next.error <= (1.0 - 0.5 * damping) * residual.error;
			if (accepted)
			{
				residual = std::move(next);
				powers = candidate;
			}
		}
		if (!accepted)
		{
			break;
		}
	}
	if (!(residual.error < 1e-9))
	{
		throw Error(ExitCode::runtime, "equal cells: Newton's method stopped at a relative error of " +
										   std::to_string(residual.error) + ", expected 1e-9; are there duplicate points?");
	}
	double mean = 0.0;
	for (const double power : powers)
	{
		mean += power / static_cast<double>(powers.size());
	}
	for (double& power : powers)
	{
		power -= mean;
	}
	return powers;
}

void relaxEqual(const Layout& layout, Points& points, int rounds, const Seen& seen)
{
	for (int round = 0; round < rounds; ++round)
	{
		const std::vector<double> powers = equalisingPowers(layout.domain(), points);
		const Cells cells = exactCells(layout.domain(), points, powers);
		const Points target = centroidsOf(layout, cells);
		const double move = greatestMove(points, target);
		points = target;
		if (seen)
		{
			seen(points);
		}
		if (move < 1e-6)
		{
			break;
		}
	}
}

} // namespace nook
