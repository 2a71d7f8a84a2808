// SPDX-License-Identifier: GPL-3.0-or-later
// A level, or an image → the facts that `nook info` prints.
#pragma once

#include "core/facts.h"
#include "core/image.h"
#include "scene/level.h"
#include "scene/load.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace nook
{

// Whether a name ends as an image does: .exr .png .jpg .jpeg .tif .tiff .hdr .tga .bmp, in any case.
bool isImageName(const std::string& path);

// A G-buffer, visibility or any other picture.
void describeImage(const Image& image, Facts& facts);

// A round length: a fortieth of the level's diagonal, at most 1.5 m (AOV §6).
double suggestedRadius(const Level& level);

struct LevelFacts
{
	std::size_t components = 0; // of triangles that share edges, after welding
	std::size_t closed = 0;     // components whose edges all have two triangles in opposite directions
	std::size_t open_triangles = 0;
	std::size_t places = 0;     // distinct positions
	std::size_t sharing = 0;    // vertices at the position of an earlier one
	std::size_t patches = 0;    // coplanar neighbours count as one
	double median_edge_m = 0.0; // edge of a square with the area of the area-weighted median triangle
	double coarse_share = 0.0;  // area fraction of triangles larger than a square of half the suggested radius
	double radius_m = 0.0;      // suggested
	double diagonal_m = 0.0;
	std::size_t sheets = 0;         // triangles of two-sided materials
	double near = 0.0;              // triangles within the suggested distance of a point of the surface: their mean number
	double near_cover = 0.0;        // area of the alpha-tested ones among them, in discs of that radius
	std::vector<uint32_t> place_of; // per vertex: the first one at its position
	std::vector<uint32_t> flat_of;  // per triangle: the lowest one of the flat piece of surface that is one volume or a few
};
LevelFacts levelFacts(const Level& level, int threads);

// Approximate cost of an asset at the suggested distance: masksEstimate() and bakeEstimate(). docs/measurements/bake.md compares
// them with measurements.
struct AssetEstimate
{
	double bytes = 0.0;
	double seconds = 0.0; // on one core of this speed
	double memory_bytes = 0.0;
};

struct Advice
{
	bool bake = false;    // else volumes
	const char* why = ""; // a clause, "since …"
	bool split = false;   // a bake needs --max-error, since a quarter of the surface lies in large triangles
};
Advice adviceFor(const LevelFacts& facts, const AssetEstimate& masks);

// With its diagnosis, and the asset that suits it.
void describeLevel(const LoadedLevel& loaded, const LevelFacts& found, const AssetEstimate& masks, const AssetEstimate& bake,
				   Facts& facts);

// Whether the level's size is plausible in metres.
std::string scaleText(const LevelFacts& facts);

} // namespace nook
