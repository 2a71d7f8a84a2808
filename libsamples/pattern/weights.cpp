// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: C. Lawson and R. Hanson, "Solving Least Squares Problems", 1974, chapter 23 (the active set).
#include "pattern/eigen.h"
#include "pattern/methods.h"

#include <algorithm>
#include <numeric>

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
	std::vector<int> chosen(points.size());
	std::iota(chosen.begin(), chosen.end(), 0);
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

Cells voronoiCells(Domain domain, VoronoiMode mode, std::span<const glm::dvec3> points)
{
	return mode == VoronoiMode::exact ? exactCells(domain, points) : discreteCells(domain, points);
}

std::vector<double> weightsFor(const Recipe& recipe, const Layout& layout, std::span<const glm::dvec3> points)
{
	std::vector<double> weights(points.size(), 1.0 / static_cast<double>(points.size()));
	if (recipe.weights == WeightRule::voronoi && recipe.method != Method::equal)
	{
		weights = voronoiCells(recipe.domain, recipe.voronoi, points).integrals;
	}
	else if (recipe.weights == WeightRule::fitted)
	{
		weights = fittedWeights(recipe.domain, points);
	}
	layout.symmetrise(weights);
	double sum = 0.0;
	for (const double w : weights)
	{
		sum += w;
	}
	for (double& w : weights)
	{
		w /= sum;
	}
	return weights;
}

} // namespace nook
