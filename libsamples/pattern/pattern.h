// SPDX-License-Identifier: GPL-3.0-or-later
// A pattern: weighted sample points that integrate over a domain.
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace nook
{

enum class Domain
{
	disk,       // line samples: (x, y, 0) in the unit disk, measure 2√(1−r²) dA / (4π/3)
	ball,       // point samples: (x, y, z) in the unit ball, measure dV / (4π/3)
	sphere,     // unit directions, measure dω / 4π
	hemisphere, // unit directions with z ≥ 0, measure cos θ dω / π; handled as its projection (x, y), where the measure is dA / π
	slice,      // planes through the view ray: (half turns, jitter in steps, 0), periodic in [0, 1), measure dx dy; only in tiles
};

struct Pattern
{
	Domain domain = Domain::disk;
	std::vector<glm::dvec3> points; // in the unit ball; unit length for directions
	std::vector<double> weights;    // one per point, ≥ 0, sum 1
	std::vector<double> powers; // power-diagram weights (squared lengths; for the sphere logarithms of scale), or empty: Voronoi

	std::size_t count() const
	{
		return points.size();
	}
};

inline bool isDirectional(Domain domain)
{
	return domain == Domain::sphere || domain == Domain::hemisphere;
}

// True if the cells are those of plane points (x, y) in the unit disk.
inline bool isPlanar(Domain domain)
{
	return domain == Domain::disk || domain == Domain::hemisphere;
}

} // namespace nook
