// SPDX-License-Identifier: GPL-3.0-or-later
// Spreads sample points over triangles and traces their visibility.
#pragma once

#include "bake/bake.h"
#include "scene/ray_triangle.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace nook
{

struct SurfaceSample
{
	uint32_t triangle = 0; // index in the baked level
	float b = 0.0F;        // barycentric weights of the second and third vertex
	float c = 0.0F;
	float visibility = 1.0F;
	float standard_error = 0.0F;
	glm::vec3 bent{0.0F}; // with BakeSettings::bent
	bool back = false;    // on the clockwise side
	bool buried = false;  // inside matter
	bool shut = false;    // in a gap so narrow that hardly any ray escapes
	bool missed = false;  // met no detailed surface
};

// The triangles that get values.
inline const Level& surfaceOf(const Tracer& tracer, const BakeSettings& settings)
{
	return settings.receivers != nullptr ? *settings.receivers : tracer.level();
}

// Distributes `count` points over triangles with these areas: half of them evenly, half by area, at least one each.
std::vector<std::size_t> samplesOfTriangles(std::span<const double> areas, std::size_t count);

// counts[t] points on triangle t. On two-sided materials they come in pairs, one per side, rounded up. Ordered by triangle; within
// a triangle a low-discrepancy sequence. Values are not filled in.
class SamplePlaces
{
public:
	SamplePlaces(const Level& level, std::span<const std::size_t> counts, uint32_t seed);

	std::size_t count() const
	{
		return m_first.back();
	}
	void place(std::size_t first, std::span<SurfaceSample> samples) const; // starting with number `first`
	std::vector<SurfaceSample> all() const;

private:
	const Level& m_level;
	uint32_t m_seed;
	std::vector<std::size_t> m_first; // start of each triangle's samples, and the end
};

// Where a point's rays start, with BakeSettings::cage_m on the detailed surface; `along` is the smooth normal, `missed` set if
// given.
ReferencePoint startOf(const Tracer& tracer, const ReferencePoint& point, glm::dvec3 along, const BakeSettings& settings,
					   bool* missed = nullptr);

// Counts the samples inside matter, and of the others those in gaps.
void countUnseen(std::span<const SurfaceSample> samples, VertexBake& bake);

// Rays as the bake's settings say, to measure obscurance.
ReferenceSettings raysOf(const BakeSettings& settings, int rays, uint32_t seed);

// The value at the barycentric weights b and c of a triangle's second and third corner.
template <class List, class Number> auto interpolated(const List& values, glm::uvec3 triangle, Number b, Number c)
{
	return (Number{1} - b - c) * values[triangle.x] + b * values[triangle.y] + c * values[triangle.z];
}

// Barycentric weights of a point in the plane of a triangle; not finite if it has no area.
inline glm::dvec3 weightsIn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 p)
{
	const glm::dvec2 u = b - a;
	const glm::dvec2 v = c - a;
	const glm::dvec2 w = p - a;
	const double area = u.x * v.y - u.y * v.x;
	const double of_b = (w.x * v.y - w.y * v.x) / area;
	const double of_c = (u.x * w.y - u.y * w.x) / area;
	return {1.0 - of_b - of_c, of_b, of_c};
}

// `count` points uniform by area, ordered by triangle; both sides of two-sided materials are equally likely.
std::vector<SurfaceSample> placeByArea(const Level& level, std::span<const double> areas, std::size_t count, uint32_t seed);

// Fills visibility, standard error, buried and shut, with `rays` rays per sample. `level` has the tracer's surfaces, possibly
// subdivided. Progress stage `stage`.
void traceSamples(const Tracer& tracer, const Level& level, std::span<SurfaceSample> samples, const BakeSettings& settings,
				  int rays, uint32_t seed, const RunSettings& run, const char* stage);

// Likewise for `count` samples that are not all in memory at once. block_at(first, size) returns where a block is stored.
using BlockAt = std::function<std::span<SurfaceSample>(std::size_t first, std::size_t size)>;
void traceSamples(const Tracer& tracer, const Level& level, std::size_t count, const BlockAt& block_at,
				  const BakeSettings& settings, int rays, uint32_t seed, const RunSettings& run, const char* stage);

// Checks any values of a surface against rays, like checkBake for vertices.
BakeCheck checkValues(const Tracer& tracer, const Level& baked, const std::function<double(const SurfaceSample&)>& valueOf,
					  const BakeSettings& settings, std::size_t points, const RunSettings& run,
					  const std::function<glm::dvec3(const SurfaceSample&)>& bentOf = {});

// Vertices with equal position and normal share one value, so that seams of textures and meshes are invisible.

struct Unknowns
{
	std::vector<uint32_t> of_vertex; // index of its value; values are numbered by their first vertex
	std::vector<uint32_t> of_back;   // value of its other side; the same index if it has only one
	bool has_sides = false;          // some vertices have two values
	std::size_t count = 0;
	std::vector<uint32_t> place_of_vertex; // position index: equal for vertices at the same place
};

// Unit vertex normals; without them the area-weighted mean of the triangles' normals. Zero for vertices without triangles.
std::vector<glm::vec3> vertexNormals(const Level& level);

// Vertices share a value if their positions are equal and their normals differ by less than 2.6 degrees. Unused ones have values
// too. BakeSides::separate: those of two-sided materials have two; the backs come last, in the order of the fronts. `places`: those
// of weldPositions(), which are found if it is empty.
Unknowns unknownsOf(const Level& level, BakeSides sides = BakeSides::mean, std::vector<uint32_t> places = {});

// Alternates fitting and subdivision until no triangle's error exceeds settings.max_error. Requires max_error > 0 and
// BakeFit::surface.
VertexBake refineBake(const Tracer& tracer, const BakeSettings& settings, const RunSettings& run);

struct FittedValues
{
	std::vector<float> values;    // one per unknown; 1 without a triangle
	std::vector<glm::dvec3> bent; // one per unknown: visibility times direction, not normalised; empty if not requested
	double standard_error = 0.0;  // root mean square effect of the samples' standard errors
};

// Area-weighted least squares with bounded values. Samples are ordered by triangle, at least one each. Values that no sample
// determines are smooth. Samples inside matter or in gaps have a thousandth of the weight, so they decide only where there are no
// others. Values are at most 1, and at least 0, or −1 with BakeSettings::base.
FittedValues fitValues(const Level& level, std::span<const double> areas, const Unknowns& unknowns,
					   std::span<const SurfaceSample> samples, const BakeSettings& settings);

// Stores the vertices' values and standard error. Bent normals are normalised; the vertex normal replaces a zero.
void take(VertexBake& bake, const Level& level, const Unknowns& unknowns, const FittedValues& fitted);

} // namespace nook
