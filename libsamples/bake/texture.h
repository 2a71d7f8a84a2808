// SPDX-License-Identifier: GPL-3.0-or-later
// A level with coordinates for a texture of its own → visibility at that texture's texels.
#pragma once

#include "bake/bake.h"

#include <glm/vec2.hpp>

#include <span>
#include <vector>

namespace nook
{

inline constexpr int kLeastTexture_px = 16;
inline constexpr int kMostTexture_px = 8192;

struct TextureBake
{
	int size_px = 0;
	std::vector<uint8_t> values; // size × size, rows from the top; 255 is open
	std::size_t charts = 0;
	std::size_t covered = 0; // texels that a chart covers, in part at least
	std::size_t shared = 0;  // of these, where two charts meet: the larger part counts
	std::size_t buried = 0;  // of these, that lie inside matter; filled from their neighbours
	std::size_t missed = 0;  // triangles so small that they cover no sample of any texel
	std::size_t rays = 0;
	double standard_error = 0.0; // root mean square over texels, of the rays
};

// `uvs`: one a vertex; v grows downward. Each texel takes the mean over those of its four by four samples that lie on one chart,
// and `rays` are shared out over them. What no chart covers is filled from the nearest: ring by ring, then smoothly. Throws Error
// (invalid_input): where there are no coordinates, some lie outside [0, 1], or charts overlap. Same bytes for any thread count.
// Stage "texels".
TextureBake bakeTexture(const Tracer& tracer, std::span<const glm::vec2> uvs, int size_px, const BakeSettings& settings,
						const RunSettings& run);

// As checkBake, of the texture as a texture unit reads it: bilinear.
BakeCheck checkTexture(const Tracer& tracer, std::span<const glm::vec2> uvs, const TextureBake& bake, const BakeSettings& settings,
					   std::size_t points, const RunSettings& run);

} // namespace nook
