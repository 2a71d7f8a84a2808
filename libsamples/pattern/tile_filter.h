// SPDX-License-Identifier: GPL-3.0-or-later
// What an engine does with the variants behind the pass that reads them, a filter over pixels and a mean over frames → how much the
// samples of any two pixels of the tile count together (TileShares, energy.h).
//
// The mean that a filter of weights k, sum 1, makes at a pixel is one weighted pattern: the samples of the pixels under it, their
// weights times k. Its squared error is an energy distance like a single pattern's, and the mean of that over all pixels differs
// only in how much pairs of samples count: with the autocorrelation of k at the offset of their pixels, folded to the tile's
// period. An exponential mean over frames, α(1 − α)^j for j frames ago, is one more axis of the same sum.
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
inline constexpr double kMaxShareSteps = 0x1p31; // of stepsOfShares: seconds
inline constexpr double kQuickSteps = 0x1p24;    // what nook info takes without being asked: some tenths of a second

struct TileFilter
{
	std::string name;         // "binomial:3", as on the command line
	double share = 1.0;       // among several filters
	int width = 1;            // taps, odd or even
	std::vector<double> taps; // width × height, row by row from the top, sum 1
};

// "none", "box:N", "binomial:N" (N × N taps, N 1 to 64), "gauss:SIGMA" (pixels, 0.1 to 8; taps to 4 σ) or "bilateral:N" (nook's
// filter where all of its taps show one surface; N taps along each axis, odd, 3 to 33). Throws Error (usage).
TileFilter tileFilterNamed(const std::string& name);

// "binomial:3@2" → its name and its share, 1 where none stands there, above 0 to 1e6. Throws Error (usage).
std::pair<std::string, double> nameAndShare(const std::string& text);

// Taps with a sum above 0, normalised.
TileFilter tileFilterOf(std::string name, int width, std::vector<double> taps);

// What is left of a filter where a straight edge through its middle cuts off half of its taps, at sixteen angles; normalised.
std::vector<TileFilter> halvesOf(const TileFilter& filter);

// The mean over frames of a cycle, and what changes from frame to frame: either each has a tile of its own, or one tile moves.
struct TileTime
{
	int frames = 1;
	double ema = 1.0;                // weight α of the newest frame, above 0, at most 1
	std::vector<glm::ivec2> moves{}; // frame f reads the variant of pixel p + moves[f]; empty: a tile a frame
};

// For F frames, 1 to size²: rows of a small block of pixels, so that near frames are near pixels.
std::vector<glm::ivec2> tileMoves(int size, int frames);

// The shares of a filter behind which the last `last` frames are averaged (0: all of them, by α). Their sum is 1. `pan`: whole
// pixels by which the picture moves each frame, with a history that follows.
TileShares sharesOf(int size, const TileFilter& filter, const TileTime& time = {}, int last = 1, glm::ivec2 pan = {0, 0});

// Steps that sharesOf takes, and those of tileSquaredError for `count` samples a variant behind it: so that nobody waits for hours.
double stepsOfShares(int size, const TileFilter& filter, const TileTime& time, bool panned = false);
double stepsOfError(const TileShares& shares, std::size_t count);

// into += scale · added
void addShares(TileShares& into, const TileShares& added, double scale);

} // namespace nook
