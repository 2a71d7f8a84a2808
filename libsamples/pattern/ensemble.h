// SPDX-License-Identifier: GPL-3.0-or-later
// The occluders that patterns are judged by, and a pattern's estimate for each.
#pragma once

#include "pattern/pattern.h"

#include <vector>

namespace nook
{

// The exact fraction of the domain's measure where n·x ≤ c. n is a unit vector; only the hemisphere depends on its z.
double freeShare(Domain domain, double n_z, double c);

// A pattern prepared for many evaluations.
class Estimator
{
public:
	explicit Estimator(const Pattern& pattern);

	// The pattern's estimate of that fraction. Lines are clipped analytically (n_z > 0); a point on the plane counts half.
	double estimate(const glm::dvec3& n, double c) const;

	// Lines against a vertical plane: total weight of those with m·p > d, half where equal. m is a unit vector in the plane.
	double estimateBeyond(double m_x, double m_y, double d) const;

	// Lines against two half-spaces through the centre whose union is occupied: n1, n2 with n_z > 0.
	double estimateCorner(const glm::dvec3& n1, const glm::dvec3& n2) const;

private:
	double linesFree(const glm::dvec3& n, double c) const;

	bool m_lines;
	std::vector<double> m_x;
	std::vector<double> m_y;
	std::vector<double> m_z;    // points only
	std::vector<double> m_half; // half length of the line
	std::vector<double> m_weight;
};

} // namespace nook
