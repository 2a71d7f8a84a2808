// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles with texture coordinates → which triangle each sample of a texture lies on.
#pragma once

#include "scene/level.h"

#include <glm/vec2.hpp>

#include <span>
#include <vector>

namespace nook
{

inline constexpr uint32_t kNoTriangle = ~uint32_t{0};
inline constexpr int kSamplesAcross = 4; // of a texel, each way

// Triangles that share vertices, or places with the same coordinates, are one chart; its number by triangle, from 0.
std::vector<uint32_t> chartsOf(const Level& level, std::span<const glm::vec2> uvs, std::size_t& count);

// Of each sample of the rows [first_row, first_row + rows) of texels the triangle, or kNoTriangle: kSamplesAcross × size_px a row.
// Adds to `overlaps` the samples that lie well inside two triangles, and marks in `hit` the triangles that have one.
std::vector<uint32_t> rasterise(const Level& level, std::span<const glm::vec2> uvs, int size_px, int first_row, int rows,
								std::size_t& overlaps, std::vector<uint8_t>& hit);

// Weights of a triangle's vertices at a place of the texture; not finite where the triangle has no area there.
glm::dvec3 weightsAt(const Level& level, std::span<const glm::vec2> uvs, std::size_t triangle, glm::dvec2 uv);

} // namespace nook
