// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles → points spread over them, and the visibility that rays find there.
#pragma once

#include "bake/bake.h"

#include <functional>
#include <span>
#include <vector>

namespace nook
{

struct SurfaceSample
{
	uint32_t triangle = 0; // of the level that is baked
	float b = 0.0F;        // weights of its second and third vertex
	float c = 0.0F;
	float visibility = 1.0F;
	float standard_error = 0.0F;
	glm::vec3 bent{0.0F}; // with BakeSettings::bent
	bool back = false;    // seen from the clockwise side
	bool buried = false;  // inside matter
	bool shut = false;    // a gap so tight that hardly a ray gets out of it
};

// Square metres of each triangle.
std::vector<double> areasOf(const Level& level);

// `count` points, shared out over the triangles of these areas: half of them evenly, half by area, and at least one each.
std::vector<std::size_t> samplesOfTriangles(std::span<const double> areas, std::size_t count);

// counts[t] points on triangle t. On materials with two sides they come in pairs, one a side, maybe one more for that. In the order
// of the triangles; within one a sequence of low discrepancy. Values are not filled.
class SamplePlaces
{
public:
	SamplePlaces(const Level& level, std::span<const std::size_t> counts, uint32_t seed);

	std::size_t count() const
	{
		return m_first.back();
	}
	void place(std::size_t first, std::span<SurfaceSample> samples) const; // those from `first` on
	std::vector<SurfaceSample> all() const;

private:
	const Level& m_level;
	uint32_t m_seed;
	std::vector<std::size_t> m_first; // of each triangle, and the end
};

// Points for that many values with `rays` rays each, of kRaysOfPoint rays or all of them.
std::size_t samplesFor(std::size_t values, int rays);

std::size_t buriedOf(std::span<const SurfaceSample> samples);
std::size_t shutOf(std::span<const SurfaceSample> samples); // those in the open

// `count` points even by area, in the order of the triangles; both sides of materials with two are as likely.
std::vector<SurfaceSample> placeByArea(const Level& level, std::span<const double> areas, std::size_t count, uint32_t seed);

// Fills visibility, standard error, buried and shut, with `rays` rays a sample. `level` has the tracer's surfaces, maybe in more
// triangles. Stage `stage`.
void traceSamples(const Tracer& tracer, const Level& level, std::span<SurfaceSample> samples, const BakeSettings& settings,
				  int rays, uint32_t seed, const RunSettings& run, const char* stage);

// As above, of `count` samples that are not all there at once. block_at(first, size): where so many lie meanwhile.
using BlockAt = std::function<std::span<SurfaceSample>(std::size_t first, std::size_t size)>;
void traceSamples(const Tracer& tracer, const Level& level, std::size_t count, const BlockAt& block_at,
				  const BakeSettings& settings, int rays, uint32_t seed, const RunSettings& run, const char* stage);

// Any values of a surface against rays, as checkBake has those of vertices.
BakeCheck checkValues(const Tracer& tracer, const Level& baked, const std::function<double(const SurfaceSample&)>& valueOf,
					  const BakeSettings& settings, std::size_t points, const RunSettings& run,
					  const std::function<glm::dvec3(const SurfaceSample&)>& bentOf = {});

} // namespace nook
