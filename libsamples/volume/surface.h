// SPDX-License-Identifier: GPL-3.0-or-later
// Finds a level's triangles that block light, their coplanar neighbours, and the closed pieces of surface.
#pragma once

#include "core/progress.h"
#include "scene/level.h"
#include "volume/occluders.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace nook::detail
{

inline constexpr uint32_t kNone = UINT32_MAX;

// The triangles to merge: those of a level, or their proxies.
struct Soup
{
	const Level* level = nullptr;
	std::span<const glm::uvec3> triangles; // vertices of the level
	std::span<const uint32_t> materials;   // per triangle
	std::span<const uint32_t> sources;     // level triangle that each represents; empty: its own number
};

struct Surface
{
	std::vector<glm::uvec3> triangles; // corners welded to the first vertex at each position
	std::vector<uint8_t> kept;         // 0: dropped as a duplicate, a back, or thin
	std::vector<uint8_t> two_sided;    // its back darkens too
	std::vector<uint32_t> opposite;    // for half-edge 3 t + c, from corner c to the next: the coplanar one across it, or kNone
};

Surface surfaceOf(const Soup& soup, const OccluderSettings& settings, const RunSettings& run, OccluderCounts& counts);

// 0 for opaque, else the material number plus one: only triangles of one kind are joined.
uint32_t kindOf(const Soup& soup, std::size_t triangle);

// Tolerance in metres for coplanarity of triangles with coordinates up to `coordinate_m` (occluders.h).
double flatness(double coordinate_m, bool two_sided, const OccluderSettings& settings);

// Normal of the front with a length of twice the area.
glm::dvec3 areaOf(std::span<const glm::dvec3> positions, const glm::uvec3& triangle);

// A triangle's texture coordinates as a function of position in its plane.

// Exact at the triangle's corners, constant perpendicular to its plane.
struct TextureMap
{
	glm::dvec3 origin{0.0};
	glm::dvec2 at_origin{0.0};
	glm::dvec3 u{0.0}; // gradients, 1/m
	glm::dvec3 v{0.0};

	glm::dvec2 at(glm::dvec3 position) const;
};
TextureMap textureMapOf(const Soup& soup, std::size_t triangle);

// Bounds the area of holes in a piece of surface from its open edges.

// An edge with triangles on one side only, in the direction of its triangle.
struct OpenEdge
{
	uint32_t piece = 0;
	uint32_t from = 0; // vertices, welded by position
	uint32_t to = 0;
};

// Adds to holes[piece] twice the area in m² that its open edges can bound at most: for each loop the smaller of L² / (4 π), L being
// its length, and the cone over it from its first vertex. A slit has no area, such as where cleaned-up scans lost degenerate
// triangles. The edges of a piece must be consecutive.
// If edges do not balance at a vertex, open walks count as if they closed.
void addHoles(std::span<const OpenEdge> edges, std::span<const glm::dvec3> positions, std::span<double> holes);

// Coverage of a masked polygon, ᾱ of AOV eq. 5.

// Fraction of a polygon that blocks light, in [0, 1]; `corners` are its texture coordinates, which must be convex and an affine
// image of it. Uses 64 to 1024 even samples, about four per covered texel: the error is 0.3 % of the area on leaves, at most 2 %
// (measured by tests).
double coverageOf(const Level& level, const Material& material, std::span<const glm::dvec2> corners);

// Groups connected coplanar triangles into flat regions and extracts their outlines.

struct Region
{
	std::vector<uint32_t> triangles;
	glm::dvec3 normal{0.0}; // unit
	double flat_m = 0.0;    // maximum distance of its corners from the plane
	double area_m2 = 0.0;
};

// Splits triangles connected by Surface::opposite into regions whose corners lie in one plane within flatness(): a single region if
// that holds for all, else grown from the largest triangles. labels[t] becomes equal for the triangles of a region and distinct
// between the regions of a group. `group` is ascending.
std::vector<Region> flatRegions(std::span<const uint32_t> group, const Soup& soup, const Surface& surface,
								const OccluderSettings& settings, std::span<uint32_t> labels);

// Axes of a plane with the given unit normal: x × y = normal.
struct PlaneAxes
{
	glm::dvec3 origin{0.0};
	glm::dvec3 x{0.0};
	glm::dvec3 y{0.0};

	PlaneAxes(glm::dvec3 origin, glm::dvec3 normal);
	glm::dvec2 of(glm::dvec3 position) const;
};

using Loop = std::vector<uint32_t>; // vertices; the region is on the left

// Closed loops that bound a region; empty if they do not close (a triangle's edges on both sides).
std::vector<Loop> outlineOf(const Region& region, const Surface& surface, std::span<const uint32_t> labels,
							std::span<const glm::dvec3> positions);

// Removes corners within `flat_m` of the line between remaining ones (Douglas and Peucker, 1973). Each loop then starts at its
// least corner (by x, y, z), and loops without area are removed, so that later steps depend only on the corners.
void simplifyOutline(std::vector<Loop>& loops, glm::dvec3 normal, double flat_m, std::span<const glm::dvec3> positions);

// Partitions a flat outline, possibly with holes, into convex polygons.

using Piece = std::vector<uint32_t>; // corners, counter-clockwise

// Lines may touch in corners but not cross. Pieces use only corners of the outline, given as indices into the points of all loops
// in a row, and have at most `most_corners` ≥ 3. Empty if lines cross.
std::vector<Piece> convexPieces(std::span<const std::vector<glm::dvec2>> loops, std::size_t most_corners);

// Joins counter-clockwise triangles of a mesh over common edges while they stay convex. Only looks at the triangles, so overlaps
// and crossing lines do not matter. `neighbours`: pairs of triangles with a common edge.
std::vector<Piece> joinTriangles(std::span<const glm::dvec2> points, std::vector<Piece> triangles,
								 std::span<const std::pair<uint32_t, uint32_t>> neighbours, std::size_t most_corners);

// True for a loop that turns left at every corner, by 360° in total.
bool isConvex(std::span<const glm::dvec2> loop);

// A convex polygon with corners 0 to count − 1, cut from corner to corner until no piece has more than `most_corners`.
std::vector<Piece> cutConvex(std::size_t count, std::size_t most_corners);

} // namespace nook::detail
