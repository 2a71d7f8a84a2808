// SPDX-License-Identifier: GPL-3.0-or-later
// Makes one variant of a pattern per pixel of the blur window, jointly, so that the mean over the window, or behind a filter and a
// mean over frames, is close to exact.
#pragma once

#include "core/progress.h"
#include "pattern/recipe.h"
#include "pattern/tile_filter.h"

#include <vector>

namespace nook
{

enum class TileKind
{
	points, // every variant has its own points and weights
	even,   // the base pattern rotated by even steps
	random, // the base pattern reflected about random directions: the paper's texture
};
template <> inline constexpr std::array<std::string_view, 3> kNamesOf<TileKind>{"points", "even", "random"};

struct TileRecipe
{
	int size = 4; // 2 to 128; the window is size × size pixels
	TileKind kind = TileKind::points;
	double lambda = -1.0; // weight of the variants' own plane² relative to window², > 0; −1: by filters and frames
	int starts = 0;       // 1 to 1000; 0: the default
	uint32_t seed = 1;
	// Kind points only: optimise for these filters after a mean over frames; empty: for the window's mean.
	std::vector<TileFilter> filters{};
	bool robust = false;      // also where an edge cuts off half of a filter's taps
	int frames = 1;           // length of the cycle, 1 to 64
	double ema = 0.1;         // see TileTime; used with frames
	bool moves = false;       // one moving tile instead of one per frame; frames ≤ size²
	bool progressive = false; // kind points: order the samples so that every prefix of a variant is as good as possible
};

// A rotation or reflection with a scale: x' = scale · (c −s·h; s c·h) x, h = −1 for a reflection. Disk and hemisphere only; for the
// ball a reflection about the direction `axis`.
struct TileTransform
{
	double cos = 1.0;
	double sin = 0.0;
	double scale = 1.0;
	double handedness = 1.0;
	glm::dvec3 axis{0.0}; // ball only
};

struct PatternTile
{
	Domain domain = Domain::disk;
	int size = 0;
	int frames = 1;                        // length of the cycle
	std::vector<glm::ivec2> moves;         // one per frame if the tile moves: frame f reads pixel p + moves[f]; else empty
	std::vector<Pattern> variants;         // size² row by row, without moves repeated per frame; each has the base's count
	std::vector<TileTransform> transforms; // one per variant; empty if the variants have their own points
};

// Number of tile layers stored one after the other.
inline int layersOf(const PatternTile& tile)
{
	return tile.moves.empty() ? tile.frames : 1;
}

// The samples of all variants, with their weights divided.
Pattern unionOf(const PatternTile& tile, double divisor);

// Offset of a frame's variants: whole layers to skip, then rows and columns to move by, (layer · size + y) · size + x.
int variantOfFrame(const PatternTile& tile, int frame);

void checkTileRecipe(const TileRecipe& recipe, Domain domain);

// Throws Error: invalid_input if a filter has too many taps for the tile; runtime if it may take more than memory_bytes (0: any).
void checkTileSize(const TileRecipe& recipe, const Pattern& base, uint64_t memory_bytes, int threads);

// Upper estimate of the memory for making the tile, including its text.
uint64_t tileMemory(const TileRecipe& recipe, const Pattern& base, int threads);

// "nook tile --pattern FILE --size 4 …", without outputs; defaults are left out.
std::string tileCommand(const TileRecipe& recipe, const std::string& pattern_file);
std::string sliceTileCommand(const TileRecipe& recipe, std::size_t count);

inline constexpr int kMostSlices = 16;

// Slices of one pixel, 1 to kMostSlices: even azimuths, golden-ratio jitters. The base of slice tiles.
Pattern slicePattern(int count);

// Supports disk, ball, hemisphere and slice. Rounded and deterministic like generatePattern.
PatternTile generateTile(const Pattern& base, const TileRecipe& recipe, const RunSettings& run = {});

} // namespace nook
