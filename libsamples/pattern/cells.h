// SPDX-License-Identifier: GPL-3.0-or-later
// Points (and power weights) → the exact integrals of their Voronoi or power cells over the domain's measure,
// with what their derivatives need.
#pragma once

#include "pattern/pattern.h"

#include <span>
#include <utility>
#include <vector>

namespace nook
{

// The common border of the cells of `a` and `b` (a < b), weighted by the domain's density (total measure 1).
struct Facet
{
	int a = 0;
	int b = 0;
	double mass = 0.0;      // ∫ density over the border
	glm::dvec3 moment{0.0}; // ∫ x · density over the border
};

struct Cells
{
	std::vector<double> integrals;     // one a point, sum 1 up to rounding; 0 for a hidden or doubled point
	std::vector<glm::dvec3> centroids; // mean position over the cell (for the sphere not normalised); the point itself where the
									   // integral is below 1e-12
	std::vector<Facet> facets;         // sorted by (a, b)
};

// Exact cells: neighbours by CGAL's regular triangulation (exact predicates), every integral in closed form.
// Errors: below 1e-13 absolute for each integral. powers: empty, or one a point: cell i of disk and ball is where
// |x − p_i|² − powers_i is least; of the sphere where e^{powers_i} x·p_i is greatest.
Cells exactCells(Domain domain, std::span<const glm::dvec3> points, std::span<const double> powers = {});

// The paper's discrete cells (VO §4.5): 512² squares of the disk, 128³ cubes of the ball; for directions 512² pieces of equal
// measure. Integrals and centroids only. Error of an integral: about the measure of one cell layer along its border.
Cells discreteCells(Domain domain, std::span<const glm::dvec3> points);

// The derivative of Σ_i gradient_i · integral_i by every point of a Voronoi diagram (no powers), given the facets of its cells.
// For directions on the sphere the result still has to be projected to the tangent plane.
void addCellGradient(Domain domain, std::span<const glm::dvec3> points, std::span<const Facet> facets,
					 std::span<const double> integral_gradient, std::span<glm::dvec3> point_gradient);

// Relative standard deviation of the integrals: the pattern measure "spread".
double relativeSpread(std::span<const double> integrals);

namespace detail
{
// Integrals are exact to less than this; of a cell that is smaller nothing else is known.
inline constexpr double kLeastCell = 1e-12;

// Which cells touch; a point that is hidden (its power cell is empty) or doubled is not visible and has no neighbours.
struct Neighbours
{
	explicit Neighbours(std::size_t count) : lists(count), visible(count, 0) {}
	void link(int a, int b);
	void sort();

	std::vector<std::vector<int>> lists; // sorted
	std::vector<char> visible;
};

// Plane points (z ignored), points in space, directions scaled by e^power.
Neighbours planeNeighbours(std::span<const glm::dvec3> points, std::span<const double> powers);
Neighbours spaceNeighbours(std::span<const glm::dvec3> points, std::span<const double> powers);
Neighbours directionNeighbours(std::span<const glm::dvec3> scaled_directions);

Cells planeCells(Domain domain, std::span<const glm::dvec3> points, std::span<const double> powers);
Cells spaceCells(std::span<const glm::dvec3> points, std::span<const double> powers);
Cells directionCells(std::span<const glm::dvec3> points, std::span<const double> powers);
} // namespace detail

} // namespace nook
