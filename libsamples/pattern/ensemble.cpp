// SPDX-License-Identifier: GPL-3.0-or-later
#include "pattern/ensemble.h"

#include "core/math.h"

#include <algorithm>

namespace nook
{
namespace
{

double acosOf(double x)
{
	x = std::clamp(x, -1.0, 1.0);
	return atan2Of(std::sqrt((1.0 - x) * (1.0 + x)), x);
}

// Cosine-weighted measure of the cap n·x > c above the horizon, over π: the area of its projection on the ground, by Green's
// theorem over the part of its circle above the horizon (|t| ≤ t0) and the part of the horizon inside it (|ψ| ≤ ψ0).
double cosineCap(double n_z, double c)
{
	const double sine = std::sqrt(std::max(0.0, (1.0 - n_z) * (1.0 + n_z)));
	const double s = std::sqrt(std::max(0.0, (1.0 - c) * (1.0 + c)));
	if (sine < 1e-12) // straight up or down
	{
		return n_z > 0.0 ? (c >= 0.0 ? s * s : 1.0) : (c >= 0.0 ? 0.0 : 1.0 - s * s);
	}
	const double psi0 = acosOf(c / sine);
	if (s < 1e-12)
	{
		return psi0 / kPi;
	}
	const double t0 = acosOf(-c * n_z / (s * sine));
	return (t0 * s * s * n_z - c * s * sine * sinCosOf(t0).sin + psi0) / kPi;
}

} // namespace

double freeShare(Domain domain, double n_z, double c)
{
	switch (domain)
	{
	case Domain::sphere: return 0.5 * (1.0 + c);
	case Domain::hemisphere: return 1.0 - cosineCap(n_z, c);
	case Domain::disk:
	case Domain::ball:
	case Domain::slice: break;
	}
	return 0.25 * (1.0 + c) * (1.0 + c) * (2.0 - c);
}

Estimator::Estimator(const Pattern& pattern) : m_lines(pattern.domain == Domain::disk), m_weight(pattern.weights)
{
	for (const glm::dvec3& p : pattern.points)
	{
		m_x.push_back(p.x);
		m_y.push_back(p.y);
		m_z.push_back(p.z);
		// A line at the rim has zero length; a tiny one keeps the quotient finite and makes it a step.
		m_half.push_back(std::sqrt(std::max(1e-18, 1.0 - p.x * p.x - p.y * p.y)));
	}
}

double Estimator::linesFree(const glm::dvec3& n, double c) const
{
	double sum = 0.0;
	const double scale = 0.5 / n.z;
	for (std::size_t i = 0; i < m_weight.size(); ++i)
	{
		const double share = 0.5 + (c - n.x * m_x[i] - n.y * m_y[i]) * scale / m_half[i];
		sum += m_weight[i] * std::min(1.0, std::max(0.0, share));
	}
	return sum;
}

double Estimator::estimate(const glm::dvec3& n, double c) const
{
	if (m_lines)
	{
		return linesFree(n, c);
	}
	double sum = 0.0;
	for (std::size_t i = 0; i < m_weight.size(); ++i)
	{
		const double gap = c - (n.x * m_x[i] + n.y * m_y[i] + n.z * m_z[i]);
		sum += m_weight[i] * (gap > 0.0 ? 1.0 : gap == 0.0 ? 0.5 : 0.0);
	}
	return sum;
}

double Estimator::estimateBeyond(double m_x_axis, double m_y_axis, double d) const
{
	double sum = 0.0;
	for (std::size_t i = 0; i < m_weight.size(); ++i)
	{
		const double gap = m_x_axis * m_x[i] + m_y_axis * m_y[i] - d;
		sum += m_weight[i] * (gap > 0.0 ? 1.0 : gap == 0.0 ? 0.5 : 0.0);
	}
	return sum;
}

double Estimator::estimateCorner(const glm::dvec3& n1, const glm::dvec3& n2) const
{
	double sum = 0.0;
	for (std::size_t i = 0; i < m_weight.size(); ++i)
	{
		const double depth1 = -(n1.x * m_x[i] + n1.y * m_y[i]) / n1.z;
		const double depth2 = -(n2.x * m_x[i] + n2.y * m_y[i]) / n2.z;
		const double share = 0.5 + 0.5 * std::min(depth1, depth2) / m_half[i];
		sum += m_weight[i] * std::min(1.0, std::max(0.0, share));
	}
	return sum;
}

} // namespace nook
