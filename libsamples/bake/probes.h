// SPDX-License-Identifier: GPL-3.0-or-later
// Bakes a grid of probes, visibility as a function of the normal, for moving objects.
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
inline constexpr int kMostProbesAlong = 2048; // per axis: the 3D texture size that every GPU supports

// Visibility for the normal n is approximated as c0 + c · n. A probe has four bytes: 255 (c + ½), rounded, and 1 + 254 c0. The
// fourth is 0 if the probe lies inside matter. |c| ≤ ½ holds for any surroundings.
struct ProbeGrid
{
	glm::dvec3 origin{0.0}; // first probe, world space
	double spacing_m = 1.0;
	glm::ivec3 count{1};
	std::vector<std::array<uint8_t, 4>> texels; // x fastest, then y and z
	std::size_t buried = 0;
	std::size_t rays = 0;
	double standard_error = 0.0; // root mean square, of c0
};

// The grid is centred in the level's bounding box, with at least one probe per axis and none further than half a spacing from its
// sides. Traces the reference's rays, a sixth of settings.rays for each of six normals along the axes. Throws Error (usage) for
// more than kMostProbes or kMostProbesAlong. Same bytes for any thread count. Progress stage "probes".
ProbeGrid bakeProbes(const Tracer& tracer, double spacing_m, const BakeSettings& settings, const RunSettings& run);

// Visibility as a shader reads it (matches probesGlsl's function step by step): the eight probes around a point with trilinear
// weights, without those inside matter and with little weight for those behind the surface. 1 if all are inside matter. `normal` is
// unit.
double visibilityAt(const ProbeGrid& grid, glm::dvec3 position, glm::dvec3 normal);

// Checks the grid against 1024 rays at random points of the level's bounding box that lie in the open, with random normals.
BakeCheck checkProbes(const Tracer& tracer, const ProbeGrid& grid, const BakeSettings& settings, std::size_t points,
					  const RunSettings& run);

// A KTX2 file: a 3D texture with four bytes per texel (VK_FORMAT_R8G8B8A8_UNORM) and the grid's position in its key-value data.
std::string probesKtx2(const ProbeGrid& grid, std::string_view writer);

// A function in GLSL 3.30 or later and ES 3.00 or later that reads this grid.
std::string probesGlsl(const ProbeGrid& grid, std::string_view writer);

} // namespace nook
