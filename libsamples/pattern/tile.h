// SPDX-License-Identifier: GPL-3.0-or-later
// Pattern → one variant for each pixel of the blur window, made together so that the window's mean is close to exact, or what is
// seen behind a filter and a mean over frames.
#pragma once

#include "core/progress.h"
#include "pattern/recipe.h"
#include "pattern/tile_filter.h"

#include <vector>

namespace nook
{

enum class TileKind
{
	points,    // every variant has points and weights of its own
	transform, // every variant is the base pattern turned or reflected, and scaled
	even,      // the base pattern turned by even steps (the comparison of FORMULAS, "Windows")
	random,    // the base pattern reflected about random directions: the paper's texture
};
template <> std::span<const std::string_view> namesOf<TileKind>();

struct TileRecipe
{
	int size = 4; // 2 to 128; the window is size × size pixels
	TileKind kind = TileKind::points;
	double lambda = -1.0; // weight of the variants' own plane² against window², > 0; −1: the default of the kind
	int starts = 0;       // 1 to 1000; 0: the default
	uint32_t seed = 1;
	// Kind points alone: made for what is seen behind these filters, after a mean over frames; none: for the window's mean.
	std::vector<TileFilter> filters{};
	bool robust = false;      // also where an edge cuts off half of a filter's taps
	int frames = 1;           // of a cycle, 1 to 64
	double ema = 0.1;         // TileTime's, with frames
	bool moves = false;       // one tile that moves, in place of one a frame; frames ≤ size²
	bool progressive = false; // kind points: every prefix of a variant's samples is as good as their order makes it
};

// A rotation or reflection with a scale: x' = scale · (c −s·h; s c·h) x, h = −1 for a reflection. Disk and hemisphere only;
// for the ball a reflection about the direction (x, y, z) of `axis`.
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
	int frames = 1;                        // of a cycle
	std::vector<glm::ivec2> moves;         // one a frame where the tile moves: frame f reads pixel p + moves[f]; else empty
	std::vector<Pattern> variants;         // size² row by row, without moves for frame after frame, each of the base's count
	std::vector<TileTransform> transforms; // one a variant, or empty where the variants have points of their own
};

// How many tiles one after the other the variants are.
inline int layersOf(const PatternTile& tile)
{
	return tile.moves.empty() ? tile.frames : 1;
}

// What makes a pixel's variant that of a frame: variants of whole tiles to skip, then rows and columns of the tile to move by,
// (layer · size + y) · size + x.
int variantOfFrame(const PatternTile& tile, int frame);

void checkTileRecipe(const TileRecipe& recipe, Domain domain);

// Throws Error: invalid_input where a filter has too many taps for a tile of this size; runtime where the work may take more than
// `memory_bytes` (0: no limit), an upper estimate.
void checkTileSize(const TileRecipe& recipe, const Pattern& base, uint64_t memory_bytes, int threads);

// That estimate: what making the tile takes, and it as text.
uint64_t tileMemory(const TileRecipe& recipe, const Pattern& base, int threads);

// "nook tile --pattern FILE --size 4 …", without outputs; only what differs from the defaults.
std::string commandOf(const TileRecipe& recipe, const std::string& pattern_file);
std::string sliceCommandOf(const TileRecipe& recipe, std::size_t count);

inline constexpr int kMostSlices = 16;

// Slices of one pixel, 1 to kMostSlices: even azimuths, jitters by the golden ratio. The base of tiles of slices.
Pattern slicePattern(int count);

// Offered for disk, ball, hemisphere and slice. Rounded and deterministic as generatePattern.
PatternTile generateTile(const Pattern& base, const TileRecipe& recipe, const RunSettings& run = {});

} // namespace nook
