// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: C. Lawson and R. Hanson, "Solving Least Squares Problems", 1974, chapter 23 (the active set).
#include "core/error.h"
#include "core/lists.h"
#include "core/math.h"
#include "pattern/methods.h"

#include <glm/geometric.hpp>

#include <algorithm>

// Eigen's solvers with the same rounding on every processor. On ARM64 Eigen uses fused multiply-add intrinsics regardless of
// compiler flags, where SSE2 rounds twice; this replaces them with separate operations.
#ifdef __aarch64__
#include <arm_neon.h>
#define vfmaq_f64(sum, a, b) vaddq_f64(sum, vmulq_f64(a, b))
#define vfmaq_n_f64(sum, a, b) vaddq_f64(sum, vmulq_n_f64(a, b))
#define vfmaq_laneq_f64(sum, a, b, lane) vaddq_f64(sum, vmulq_laneq_f64(a, b, lane))
#endif

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace nook
{
namespace
{

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Minimises lᵀw + ½wᵀAw with Σw = 1 over the chosen indices; also returns the multiplier of the sum.
struct Solution
{
	Vector weights;
	double multiplier = 0.0;
};

Solution solveOn(const Matrix& a, const Vector& l, const std::vector<int>& chosen)
{
	const auto n = static_cast<Eigen::Index>(chosen.size());
	Matrix part(n, n);
	Vector rhs(n);
	for (Eigen::Index i = 0; i < n; ++i)
	{
		for (Eigen::Index j = 0; j < n; ++j)
		{
			part(i, j) = a(chosen[static_cast<std::size_t>(i)], chosen[static_cast<std::size_t>(j)]);
		}
		rhs(i) = l(chosen[static_cast<std::size_t>(i)]);
	}
	const Eigen::LDLT<Matrix> factors(part);
	const Vector from_one = factors.solve(Vector::Ones(n));
	const Vector from_l = factors.solve(rhs);
	Solution solution;
	solution.multiplier = (1.0 + from_l.sum()) / from_one.sum();
	solution.weights = solution.multiplier * from_one - from_l;
	return solution;
}

// Moves towards the solution until a weight would turn negative; weights that reach 0 leave the chosen set. True if it arrives.
bool stepTowards(const Solution& solution, Vector& w, std::vector<int>& chosen)
{
	double step = 1.0;
	for (std::size_t k = 0; k < chosen.size(); ++k)
	{
		const double now = w(chosen[k]);
		const double next = solution.weights(static_cast<Eigen::Index>(k));
		if (next < 0.0)
		{
			step = std::min(step, now / (now - next));
		}
	}
	std::vector<int> kept;
	for (std::size_t k = 0; k < chosen.size(); ++k)
	{
		const int i = chosen[k];
		const double next = solution.weights(static_cast<Eigen::Index>(k));
		w(i) += step * (next - w(i));
		if (step < 1.0 && next < 0.0 && w(i) <= 1e-15)
		{
			w(i) = 0.0;
		}
		else
		{
			kept.push_back(i);
		}
	}
	chosen.swap(kept);
	return step == 1.0;
}

// Index at 0 whose weight would lower the form most; −1 if none would.
int mostWanted(const Vector& slope, double multiplier, const Vector& w, const std::vector<int>& chosen)
{
	int wanted = -1;
	double least = -1e-12;
	for (int i = 0; i < static_cast<int>(w.size()); ++i)
	{
		const double reduced = slope(i) - multiplier;
		if (w(i) == 0.0 && reduced < least && !std::binary_search(chosen.begin(), chosen.end(), i))
		{
			least = reduced;
			wanted = i;
		}
	}
	return wanted;
}

// This work is based on: J. Kitagawa, Q. Mérigot, B. Thibert, "Convergence of a Newton algorithm for semi-discrete optimal
// transport", 2019, and F. de Goes et al., "Blue noise through optimal transport", 2012.

struct Residual
{
	Cells cells;
	double error = 0.0; // greatest |integral − 1/count| · count
	double least = 0.0; // least integral · count
};

Residual residualOf(Domain domain, std::span<const glm::dvec3> points, const std::vector<double>& powers)
{
	Residual residual{.cells = exactCells(domain, points, powers)};
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

std::vector<double> fittedWeights(Domain domain, std::span<const glm::dvec3> points)
{
	// Eigen chooses block sizes by the processor's caches; fixed sizes keep the sums, and so the bytes, the same everywhere.
	Eigen::setCpuCacheSizes(32 * 1024, 512 * 1024, 4 * 1024 * 1024);
	const QuadraticForm form = quadraticForm(domain, Ensemble::plane, points);
	const auto n = static_cast<Eigen::Index>(points.size());
	Matrix a(n, n);
	Vector l(n);
	for (Eigen::Index i = 0; i < n; ++i)
	{
		l(i) = form.linear[static_cast<std::size_t>(i)];
		for (Eigen::Index j = 0; j < n; ++j)
		{
			// −pairs is positive definite only for weights of sum 0; adding a constant makes it so for all and shifts the form by a
			// constant. The diagonal gets 1e-13 so that duplicate points share their weight.
			a(i, j) = 1.0 - form.pairs[static_cast<std::size_t>(i * n + j)] + (i == j ? 1e-13 : 0.0);
		}
	}
	std::vector<int> chosen = countingFrom(0, points.size());
	Vector w = Vector::Constant(n, 1.0 / static_cast<double>(n));
	for (int round = 0; round < 10 * static_cast<int>(n) + 10; ++round)
	{
		const Solution solution = solveOn(a, l, chosen);
		if (!stepTowards(solution, w, chosen))
		{
			continue;
		}
		const int wanted = mostWanted(a * w + l, solution.multiplier, w, chosen);
		if (wanted < 0)
		{
			break;
		}
		chosen.insert(std::lower_bound(chosen.begin(), chosen.end(), wanted), wanted);
	}
	return {w.data(), w.data() + n};
}

std::vector<double> weightsFor(const Recipe& recipe, const Layout& layout, std::span<const glm::dvec3> points)
{
	std::vector<double> weights(points.size(), 1.0 / static_cast<double>(points.size()));
	if (recipe.weights == WeightRule::voronoi && recipe.method != Method::equal)
	{
		weights = exactCells(recipe.domain, points).integrals;
	}
	else if (recipe.weights == WeightRule::fitted)
	{
		weights = fittedWeights(recipe.domain, points);
	}
	layout.symmetrise(weights);
	const double sum = sumOver(weights);
	for (double& w : weights)
	{
		w /= sum;
	}
	return weights;
}

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
	refuseIf(!(residual.error < 1e-9),
			 "equal cells: Newton's method stopped at a relative error of " + std::to_string(residual.error) +
				 ", expected 1e-9; are there duplicate points?",
			 ExitCode::runtime);
	const double mean = sumOver(powers, [&powers](double power) { return power / static_cast<double>(powers.size()); });
	for (double& power : powers)
	{
		power -= mean;
	}
	return powers;
}

} // namespace nook
