// SPDX-License-Identifier: GPL-3.0-or-later
// A clean level → what it is like, which asset suits it, and about what that takes, before any of it is made.
#pragma once

#include "scene/level.h"

#include <cstddef>
#include <cstdint>

namespace nook
{

// A round length: a fortieth of the level's diagonal, at most 1.5 m (AOV §6).
double suggestedRadius(const Level& level);

struct LevelFacts
{
	std::size_t components = 0; // of triangles that share edges, vertices of one place taken as one
	std::size_t closed = 0;     // of these: every edge has two triangles, which run along it in opposite ways
	std::size_t open_triangles = 0;
	std::size_t places = 0;     // different positions
	std::size_t sharing = 0;    // vertices whose position an earlier one has
	std::size_t patches = 0;    // neighbours in one plane count as one
	double median_edge_m = 0.0; // of a square of the area that the triangle has in which the middle of the surface lies
	double coarse_share = 0.0;  // of the area: triangles larger than a square of half the suggested radius
	double radius_m = 0.0;      // suggested
	double diagonal_m = 0.0;
};
LevelFacts levelFacts(const Level& level, int threads);

// About what an asset takes. Fitted to measurements (docs/measurements/bake.md has them, and how far off these are).
struct AssetEstimate
{
	double bytes = 0.0;
	double seconds = 0.0; // of one core, as here
	double memory_bytes = 0.0;
};
AssetEstimate volumesEstimate(const Level& level, const LevelFacts& facts);
AssetEstimate bakeEstimate(const Level& level, int rays);

enum class Asset
{
	volumes,
	bake,
};
struct Advice
{
	Asset asset = Asset::volumes;
	const char* why = ""; // a clause, "since …"
	bool split = false;   // a bake needs --max-error: a quarter of the surface lies in large triangles
};
Advice adviceFor(const LevelFacts& facts, const AssetEstimate& volumes, const AssetEstimate& bake);

enum class ScaleDoubt
{
	none,
	small, // the diagonal is below a metre: maybe it is in other units
	large, // beyond 5 km
};
ScaleDoubt scaleDoubt(const LevelFacts& facts);

} // namespace nook
