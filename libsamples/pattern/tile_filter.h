// SPDX-License-Identifier: GPL-3.0-or-later
// Models what an engine does after the pass that reads the variants, a filter over pixels and a mean over frames, as weights of the
// pairs of samples of any two pixels of the tile (TileShares, energy.h).
//
// The mean at a pixel under a filter with weights k, sum 1, is one weighted pattern: the samples of the pixels under it, their
// weights times k. Its squared error is an energy distance like a single pattern's; its mean over all pixels differs only in the
// weights of the pairs: the autocorrelation of k at the offset of their pixels, folded to the tile's period. An exponential mean
// over frames, α(1 − α)^j for j frames ago, adds one more axis to the same sum.
#pragma once

#include "pattern/energy.h"

#include <glm/vec2.hpp>

#include <string>
#include <utility>
#include <vector>

namespace nook
{

inline constexpr int kMaxTileSize = 128;
inline constexpr int kMaxTileFrames = 64;
inline constexpr int kMaxTaps = 65;              // along each axis
inline constexpr double kMaxShareSteps = 0x1p31; // limit of stepsOfShares: seconds
inline constexpr double kQuickSteps = 0x1p24;    // limit for nook info unless asked for more: some tenths of a second

struct TileFilter
{
	std::string name;         // "binomial:3", as on the command line
	double share = 1.0;       // relative to the other filters
	int width = 1;            // taps, odd or even
	std::vector<double> taps; // width × height, row by row from the top, sum 1
};

// "none", "box:N", "binomial:N" (N × N taps, N 1 to 64), "gauss:SIGMA" (pixels, 0.1 to 8; taps to 4 σ) or "bilateral:N" (nook's
// filter where all taps see one surface; N taps along each axis, odd, 3 to 33). Throws Error (usage).
TileFilter tileFilterNamed(const std::string& name);

// "binomial:3@2" → its name and its share: above 0, at most 1e6, 1 by default. Throws Error (usage).
std::pair<std::string, double> nameAndShare(const std::string& text);

// Normalises taps whose sum is above 0.
TileFilter tileFilterOf(std::string name, int width, std::vector<double> taps);

// The remainder of a filter if a straight edge through its middle cuts off half of its taps, at sixteen angles; normalised.
std::vector<TileFilter> halvesOf(const TileFilter& filter);

// The mean over the frames of a cycle. Either each frame has its own tile, or one tile moves.
struct TileTime
{
	int frames = 1;
	double ema = 1.0;                // weight α of the newest frame, above 0, at most 1
	std::vector<glm::ivec2> moves{}; // frame f reads the variant of pixel p + moves[f]; empty: one tile per frame
};

// For F frames, 1 to size²: rows of a small block of pixels, so that frames close in time are close in space.
std::vector<glm::ivec2> tileMoves(int size, int frames);

// Pair weights of a filter followed by a mean over the last `last` frames (0: all of them, by α). Their sum is 1. `pan`: whole
// pixels by which the picture moves per frame, with a history that follows.
TileShares sharesOf(int size, const TileFilter& filter, const TileTime& time = {}, int last = 1, glm::ivec2 pan = {0, 0});

// Cost in steps of sharesOf, and of tileSquaredError for `count` samples per variant, so that nobody waits for hours.
double stepsOfShares(int size, const TileFilter& filter, const TileTime& time, bool panned = false);
double stepsOfError(const TileShares& shares, std::size_t count);

// into += scale · added
void addShares(TileShares& into, const TileShares& added, double scale);

} // namespace nook
