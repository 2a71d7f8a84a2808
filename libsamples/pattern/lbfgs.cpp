// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: J. Nocedal, "Updating quasi-Newton matrices with limited storage", 1980 (the two-loop recursion).
#include "pattern/lbfgs.h"

#include <cmath>
#include <deque>

namespace nook
{
namespace
{

double dot(std::span<const double> a, std::span<const double> b)
{
	double sum = 0.0;
	for (std::size_t i = 0; i < a.size(); ++i)
	{
		sum += a[i] * b[i];
	}
	return sum;
}

struct Pair
{
	std::vector<double> s;
	std::vector<double> y;
	double rho = 0.0;
};

// Replaces the gradient by the quasi-Newton step (not yet negated).
void applyInverseHessian(const std::deque<Pair>& pairs, std::vector<double>& direction)
{
	std::vector<double> alpha(pairs.size());
	for (std::size_t k = pairs.size(); k-- > 0;)
	{
		alpha[k] = pairs[k].rho * dot(pairs[k].s, direction);
		for (std::size_t i = 0; i < direction.size(); ++i)
		{
			direction[i] -= alpha[k] * pairs[k].y[i];
		}
	}
	const Pair& last = pairs.back();
	const double scale = 1.0 / (last.rho * dot(last.y, last.y));
	for (double& d : direction)
	{
		d *= scale;
	}
	for (std::size_t k = 0; k < pairs.size(); ++k)
	{
		const double beta = pairs[k].rho * dot(pairs[k].y, direction);
		for (std::size_t i = 0; i < direction.size(); ++i)
		{
			direction[i] += (alpha[k] - beta) * pairs[k].s[i];
		}
	}
}

} // namespace

double minimise(const Objective& objective, std::vector<double>& x, const LbfgsSettings& settings)
{
	const std::size_t size = x.size();
	std::vector<double> gradient(size);
	std::vector<double> new_x(size);
	std::vector<double> new_gradient(size);
	std::vector<double> direction(size);
	std::deque<Pair> pairs;
	double value = objective(x, gradient);
	double checkpoint = value;
	for (int iteration = 1; iteration <= settings.max_iterations; ++iteration)
	{
		direction = gradient;
		double step = 1.0;
		if (pairs.empty())
		{
			const double norm = std::sqrt(dot(gradient, gradient));
			if (norm == 0.0)
			{
				break;
			}
			step = 0.02 / norm; // the first move: a fiftieth of the domain's radius in all
		}
		else
		{
			applyInverseHessian(pairs, direction);
		}
		const double slope = -dot(direction, gradient);
		if (!(slope < 0.0)) // not a descent direction (or no number): start over from the gradient
		{
			if (pairs.empty())
			{
				break;
			}
			pairs.clear();
			continue;
		}
		double new_value = 0.0;
		bool accepted = false;
		for (int trial = 0; trial < 30 && !accepted; ++trial)
		{
			for (std::size_t i = 0; i < size; ++i)
			{
				new_x[i] = x[i] - step * direction[i];
			}
			new_value = objective(new_x, new_gradient);
			accepted = new_value <= value + 1e-4 * step * slope;
			step *= accepted ? 1.0 : trial < 3 ? 0.5 : 0.2;
		}
		if (!accepted)
		{
			if (pairs.empty())
			{
				break;
			}
			pairs.clear();
			continue;
		}
		Pair pair{std::vector<double>(size), std::vector<double>(size), 0.0};
		for (std::size_t i = 0; i < size; ++i)
		{
			pair.s[i] = new_x[i] - x[i];
			pair.y[i] = new_gradient[i] - gradient[i];
		}
		const double curvature = dot(pair.s, pair.y);
		if (curvature > 1e-12 * std::sqrt(dot(pair.s, pair.s) * dot(pair.y, pair.y)))
		{
			pair.rho = 1.0 / curvature;
			pairs.push_back(std::move(pair));
			if (pairs.size() > static_cast<std::size_t>(settings.memory))
			{
				pairs.pop_front();
			}
		}
		x.swap(new_x);
		gradient.swap(new_gradient);
		value = new_value;
		if (iteration % 10 == 0)
		{
			if (checkpoint - value <= settings.relative_decrease * std::fabs(value))
			{
				break;
			}
			checkpoint = value;
		}
	}
	return value;
}

} // namespace nook
