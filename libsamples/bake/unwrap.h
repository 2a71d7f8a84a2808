// SPDX-License-Identifier: GPL-3.0-or-later
// Gives every triangle a place of its own in a texture: charts, their coordinates, and where they lie on the texture's pages.
#pragma once

#include "bake/texture.h"
#include "core/progress.h"
#include "scene/gltf_edit.h"
#include "scene/level.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace nook
{

struct UnwrapSettings
{
	double texel_m = 0.0; // metres per texel; 0: the smallest that fits
	int size_px = 0;      // texels across a page; 0, with texel_m: the smallest power of two that fits
	std::size_t pages = 1;
	int margin_px = 3; // texels around a chart that are its own: 1.5 · 2^n keep n + 1 mipmaps apart
};
inline constexpr int kMostMargin_px = 64;

// Triangles of a level that share no chart with others.
struct UnwrapPiece
{
	std::vector<uint32_t> triangles; // without an area if their points are equal, in a line or not finite
	std::size_t like = SIZE_MAX;     // an earlier piece with the same triangles at another place: its charts are used
};

struct Unwrapped
{
	Level level;                   // the pieces' triangles in order, with vertices of their own in each chart; uvs: on the page
	std::vector<uint32_t> page_of; // per triangle; kNoPage without an area
	std::size_t charts = 0;
	std::size_t pages = 0;
	int size_px = 0;
	double texel_m = 0.0;
	double coverage = 0.0; // area of the charts in that of the pages
	double stretch = 1.0;  // root mean square over the area, 1: none (P. Sander et al. 2001)
};
inline constexpr uint32_t kNoPage = UINT32_MAX;
inline constexpr uint32_t kNoIndex = UINT32_MAX;

// A chart in metres, between (0, 0) and `size`.
struct FlatChart
{
	glm::dvec2 size{0.0};
	std::vector<glm::dvec2> points;
	std::vector<glm::uvec3> triangles;
};

// One of the charts, larger by a factor.
struct ScaledChart
{
	std::size_t chart = 0;
	double scale = 1.0;
};

// Charts of a level's pieces at all their places, before they have a place in a texture.
struct ChartedLevel
{
	std::vector<FlatChart> flat;
	std::vector<ScaledChart> scaled;   // each as large as its triangles at that place
	std::vector<uint32_t> of_triangle; // per triangle of the pieces in order: index into `scaled`; kNoIndex without an area
	std::vector<uint32_t> number;      // and its number in that chart
	std::vector<double> areas_m2;      // per entry of `scaled`
	std::vector<double> stretches;     // sums of squares by area, likewise
};
ChartedLevel chartLevel(const Level& level, std::span<const UnwrapPiece> pieces, const RunSettings& run);

// Packs them. `densities`: factor of the texels per metre of each entry of `scaled`, 0 for those without a place, whose triangles
// have kNoPage and share vertices as in the level; empty: 1 for all.
Unwrapped packLevel(const Level& level, std::span<const UnwrapPiece> pieces, const ChartedLevel& charted,
					std::span<const double> densities, const UnwrapSettings& settings, const RunSettings& run);

// Triangles of a chart have the same orientation in the texture and do not overlap. Throws Error (invalid_input) if the pages are
// too small. Same result for any thread count. Progress stages "charts" and "pages".
Unwrapped unwrap(const Level& level, std::span<const UnwrapPiece> pieces, const UnwrapSettings& settings, const RunSettings& run);

// Textures of the pages, finished. Progress stage "texels".
std::vector<TextureBake> bakePages(const Tracer& tracer, const Unwrapped& unwrapped, BakeSettings settings, const RunSettings& run);

// A glTF file's primitives at their places as pieces, and what they become; `with_rest`: for a bake that has values at the vertices
// of triangles without a page. Not for instances, which share their coordinates.
std::vector<UnwrapPiece> piecesOf(std::span<const GltfPlace> places);
std::vector<GltfCharts> chartsOf(std::span<const GltfPlace> places, const Unwrapped& unwrapped, bool with_rest);

// Shared by its parts.

struct Chart
{
	std::vector<uint32_t> triangles;
	FlatChart flat;
	double area = 0.0;
	double stretch = 0.0; // sum of squares by area
};

// Charts of the pieces that have charts of their own (`charted`: the piece that has each piece's). Triangles are numbered through
// these pieces.
std::vector<Chart> chartsOf(const Level& level, std::span<const UnwrapPiece> pieces, std::span<const std::size_t> charted,
							int threads);

inline double crossOf(glm::dvec2 a, glm::dvec2 b)
{
	return a.x * b.y - a.y * b.x;
}

inline double areaIn(std::span<const glm::dvec2> points, glm::uvec3 t)
{
	return 0.5 * crossOf(points[t.y] - points[t.x], points[t.z] - points[t.x]);
}

// A chart on a page, in texels.
struct ChartPlace
{
	uint32_t page = 0;
	bool turned = false; // by 90 degrees
	double scale = 1.0;  // texels per metre
	glm::dvec2 corner{0.0};

	glm::dvec2 at(glm::dvec2 point) const
	{
		return corner + scale * (turned ? glm::dvec2(-point.y, point.x) : point);
	}
};

// Places for charts at so many texels per metre, without common texels within the margin; none if they do not fit.
std::optional<std::vector<ChartPlace>> packCharts(std::span<const FlatChart> charts, std::span<const ScaledChart> scaled,
												  double texels_per_m, const UnwrapSettings& settings, int threads);

// Improves coordinates towards those that keep the triangles' shapes and sizes.
void flattenRigid(std::span<const glm::uvec3> triangles, std::span<const glm::dvec3> positions, std::vector<glm::dvec2>& points);

} // namespace nook
