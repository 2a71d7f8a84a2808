// SPDX-License-Identifier: GPL-3.0-or-later
// Bakes visibility into a texture, for levels with unique texture coordinates.
#pragma once

#include "bake/bake.h"
#include "scene/level.h"

#include <glm/vec2.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr int kLeastTexture_px = 16;
inline constexpr int kMostTexture_px = 8192;

struct TextureBake
{
	int size_px = 0;
	std::vector<float> texels;   // size × size, rows from the top: visibility; until finishTextures() below 0 without a chart
	std::vector<uint8_t> values; // the same in 8 bits, by finishTextures()
	std::size_t charts = 0;
	std::size_t covered = 0; // texels covered by a chart, at least partly
	std::size_t shared = 0;  // covered texels where two charts meet; the larger part counts
	std::size_t buried = 0;  // covered texels inside matter, filled from their neighbours
	std::size_t missed = 0;  // triangles too small to cover any texel sample
	std::size_t rays = 0;
	double standard_error = 0.0; // root mean square over texels, due to the rays' noise
};

// `uvs`: one per vertex; v grows downward. Each texel is the mean over those of its 4 × 4 samples that lie in one chart, and `rays`
// are distributed over them. Throws Error (invalid_input) if there are no coordinates, some lie outside [0, 1], or charts overlap.
// Same bytes for any thread count. Progress stage "texels".
TextureBake bakeTexture(const Tracer& tracer, std::span<const glm::vec2> uvs, int size_px, const BakeSettings& settings,
						const RunSettings& run);

// Makes bilinear values on both sides of each smooth seam agree, across pages as well, and then fills the texels without a chart
// from the nearest ones: ring by ring, then smoothly. `page_of`: the page of each triangle; empty:
// the first.
void finishTextures(const Level& level, std::span<const glm::vec2> uvs, std::span<const uint32_t> page_of,
					std::vector<TextureBake>& pages, int threads);

// A finished texture as a file: ".png" in 8 bits, ".exr" in 32 bits, ".ktx2" in blocks (BC4) with all mipmaps. `writer`: of KTX2.
std::string textureFile(const TextureBake& bake, std::string_view ending, std::string_view writer);

// The finished textures as the masks that a texture unit reads, one per page.
std::vector<Mask> masksOf(std::span<const TextureBake> pages);

// Like checkBake, for the texture sampled bilinearly as by a texture unit.
BakeCheck checkTexture(const Tracer& tracer, std::span<const glm::vec2> uvs, std::span<const TextureBake> pages,
					   std::span<const uint32_t> page_of, const BakeSettings& settings, std::size_t points, const RunSettings& run);

// Fills uncovered texels from those around, so that filters and mipmaps do not bleed darkness at the borders of charts.

// Values below 0 are empty. Four rings take the mean of their filled neighbours; the rest comes from coarser levels (S. Gortler, R.
// Grzeszczuk, R. Szeliski, M. Cohen, "The Lumigraph", 1996: push and pull). All become 1 if all are empty.
void fillEmpty(std::vector<float>& values, int size_px);

} // namespace nook
