// SPDX-License-Identifier: GPL-3.0-or-later
// A level → a grid of probes: visibility by the normal, for what moves through it.
#pragma once

#include "bake/bake.h"

#include <glm/vec3.hpp>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr std::size_t kMostProbes = std::size_t{1} << 24U;
inline constexpr int kMostProbesAlong = 2048; // an axis: what every GPU has for textures of three dimensions

// Visibility for the normal n is taken as c0 + c · n. Of each probe four bytes: 255 (c + ½), rounded, and 1 + 254 c0. The fourth is
// 0 where the probe lies inside matter. |c| ≤ ½ holds for any surroundings.
struct ProbeGrid
{
	glm::dvec3 origin{0.0}; // of the first probe, world space
	double spacing_m = 1.0;
	glm::ivec3 count{1};
	std::vector<std::array<uint8_t, 4>> texels; // x fastest, then y and z
	std::size_t buried = 0;
	std::size_t rays = 0;
	double standard_error = 0.0; // root mean square, of c0
};

// In the middle of the level's box, at least one each way and no further than half a spacing from its sides. Rays are those of
// the reference, a sixth of settings.rays for each of six normals along the axes. Throws Error (usage) for more than kMostProbes or
// kMostProbesAlong. Same bytes for any thread count. Stage "probes".
ProbeGrid bakeProbes(const Tracer& tracer, double spacing_m, const BakeSettings& settings, const RunSettings& run);

// What a shader reads (probesGlsl's function, step by step): the eight probes around a point, by trilinear weights, those inside
// matter left out, those behind the surface faint. 1 where all of them are inside matter. `normal` is unit.
double visibilityAt(const ProbeGrid& grid, glm::dvec3 position, glm::dvec3 normal);

// Of the grid against 1024 rays, at points anywhere in the level's box that lie in the open, with normals any way.
BakeCheck checkProbes(const Tracer& tracer, const ProbeGrid& grid, const BakeSettings& settings, std::size_t points,
					  const RunSettings& run);

// KTX2, a texture of three dimensions of four bytes (VK_FORMAT_R8G8B8A8_UNORM), with the grid's place among its keys.
std::string probesKtx2(const ProbeGrid& grid, std::string_view writer);

// A function in GLSL 3.30 and up, ES 3.00 and up, that reads this grid.
std::string probesGlsl(const ProbeGrid& grid, std::string_view writer);

} // namespace nook
