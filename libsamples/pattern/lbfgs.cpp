// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: J. Nocedal, "Updating quasi-Newton matrices with limited storage", 1980 (the two-loop recursion).
#include "pattern/methods.h"

#include <cmath>
#include <deque>
#include <numeric>

namespace nook
{
namespace
{

double dot(std::span<const double> a, std::span<const double> b)
{
	return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

struct Pair
{
	std::vector<double> s;
	std::vector<double> y;
	double rho = 0.0;
};

// Turns the gradient into the quasi-Newton step (not yet negated).
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

// State of one descent, with its history of steps.
class Descent
{
public:
	Descent(const Objective& objective, std::vector<double>& x, int memory)
		: m_objective(objective), m_x(x), m_memory(static_cast<std::size_t>(memory)), m_gradient(x.size()), m_direction(x.size()),
		  m_new_x(x.size()), m_new_gradient(x.size())
	{
		m_value = m_objective(m_x, m_gradient);
	}

	double value() const
	{
		return m_value;
	}

	// One iteration; false if the value cannot decrease further.
	bool advance()
	{
		double step = 1.0;
		if (!chooseDirection(step))
		{
			return false;
		}
		const double slope = -dot(m_direction, m_gradient);
		// Not a descent direction (or NaN), or no decrease along it: restart from the gradient.
		if (!(slope < 0.0) || !search(step, slope))
		{
			const bool again = !m_pairs.empty();
			m_pairs.clear();
			return again;
		}
		remember();
		m_x.swap(m_new_x);
		m_gradient.swap(m_new_gradient);
		m_value = m_new_value;
		m_moved = true;
		return true;
	}

	// True if the last iteration moved.
	bool moved() const
	{
		return m_moved;
	}

private:
	bool chooseDirection(double& step)
	{
		m_moved = false;
		m_direction = m_gradient;
		if (!m_pairs.empty())
		{
			applyInverseHessian(m_pairs, m_direction);
			return true;
		}
		const double norm = std::sqrt(dot(m_gradient, m_gradient));
		step = 0.02 / norm; // first step: a fiftieth of the domain's radius in total
		return norm != 0.0;
	}

	// Backtracks until the value decreases enough.
	bool search(double step, double slope)
	{
		bool accepted = false;
		for (int trial = 0; trial < 30 && !accepted; ++trial)
		{
			for (std::size_t i = 0; i < m_x.size(); ++i)
			{
				m_new_x[i] = m_x[i] - step * m_direction[i];
			}
			m_new_value = m_objective(m_new_x, m_new_gradient);
			accepted = m_new_value <= m_value + 1e-4 * step * slope;
			step *= trial < 3 ? 0.5 : 0.2;
		}
		return accepted;
	}

	void remember()
	{
		const std::size_t size = m_x.size();
		Pair pair{std::vector<double>(size), std::vector<double>(size), 0.0};
		for (std::size_t i = 0; i < size; ++i)
		{
			pair.s[i] = m_new_x[i] - m_x[i];
			pair.y[i] = m_new_gradient[i] - m_gradient[i];
		}
		const double curvature = dot(pair.s, pair.y);
		if (curvature > 1e-12 * std::sqrt(dot(pair.s, pair.s) * dot(pair.y, pair.y)))
		{
			pair.rho = 1.0 / curvature;
			m_pairs.push_back(std::move(pair));
			if (m_pairs.size() > m_memory)
			{
				m_pairs.pop_front();
			}
		}
	}

	const Objective& m_objective;
	std::vector<double>& m_x;
	std::size_t m_memory;
	std::vector<double> m_gradient;
	std::vector<double> m_direction;
	std::vector<double> m_new_x;
	std::vector<double> m_new_gradient;
	std::deque<Pair> m_pairs;
	double m_value = 0.0;
	double m_new_value = 0.0;
	bool m_moved = false;
};

} // namespace

double minimise(const Objective& objective, std::vector<double>& x, const LbfgsSettings& settings)
{
	Descent descent(objective, x, settings.memory);
	double checkpoint = descent.value();
	for (int iteration = 1; iteration <= settings.max_iterations && descent.advance(); ++iteration)
	{
		if (settings.seen)
		{
			settings.seen(x);
		}
		if (iteration % 10 == 0 && descent.moved())
		{
			if (checkpoint - descent.value() <= settings.relative_decrease * std::fabs(descent.value()))
			{
				break;
			}
			checkpoint = descent.value();
		}
	}
	return descent.value();
}

} // namespace nook
