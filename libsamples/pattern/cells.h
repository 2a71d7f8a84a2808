// SPDX-License-Identifier: GPL-3.0-or-later
// Exact integrals of the points' Voronoi or power cells over the domain's measure,
// and what their derivatives need.
#pragma once

#include "pattern/pattern.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include <span>
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
	std::vector<double> integrals; // one per point, sum 1 up to rounding; 0 for a hidden or duplicate point
	std::vector<glm::dvec3>
		centroids; // mean position over the cell (sphere: not normalised); the point itself if the integral is below 1e-12
	std::vector<Facet> facets; // sorted by (a, b)
};

// Exact cells: neighbours from CGAL's regular triangulation (exact predicates), every integral in closed form.
// Absolute error of an integral: below 1e-13. `powers` is empty or has one value per point: in disk and ball, cell i is where
// |x − p_i|² − powers_i is least; on the sphere, where e^{powers_i} x·p_i is greatest.
Cells exactCells(Domain domain, std::span<const glm::dvec3> points, std::span<const double> powers = {});

// Adds the derivative of Σ_i gradient_i · integral_i by every point of a Voronoi diagram (no powers), given its facets. For
// directions the result must still be projected to the sphere's tangent plane.
void addCellGradient(Domain domain, std::span<const glm::dvec3> points, std::span<const Facet> facets,
					 std::span<const double> integral_gradient, std::span<glm::dvec3> point_gradient);

// Relative standard deviation of the integrals, reported as "spread".
double relativeSpread(std::span<const double> integrals);

namespace detail
{
// Integrals are exact to less than this; smaller cells are indistinguishable from empty ones.
inline constexpr double kLeastCell = 1e-12;

// Adjacent cells. A hidden point (empty power cell) or a duplicate is not visible and has no neighbours.
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

using CellPolygon = std::vector<glm::dvec2>; // an outline, empty if the point has no cell

// Cells of the disk and of the hemisphere's projection, one per point, clipped to the unit circle (as a polygon of 192 sides).
std::vector<CellPolygon> planeCellPolygons(const Pattern& pattern);

// The ball's cells cut by the plane z = 0: a power diagram of the plane, |x − p|² = |x_xy − p_xy|² + p_z².
std::vector<CellPolygon> sectionPolygons(const Pattern& pattern);

// The sphere's cells that face the viewer, in parallel projection: the rows of `view` are the picture's x and y axes and the
// direction to the viewer. Great circles become chains of segments.
std::vector<CellPolygon> spherePolygons(const Pattern& pattern, const glm::dmat3& view);

} // namespace nook
