// SPDX-License-Identifier: GPL-3.0-or-later
// A tile as a four-channel texture: OpenEXR (32-bit floats, exact) or PNG (16 bits).
//
// Tiles with transforms: size × size texels; the texel of a window pixel holds its transform: R, G, B, A = cos, sin, scale,
// handedness (ball: x, y, z of the axis, scale).
// Tiles with their own points: size² × count texels; column = variant = row · size + column of the window, row = sample; R, G, B, A
// = x, y, half length, weight (disk) or x, y, z, weight.
// PNG: value = (v − 32768) / 32767 · range of its channel, with v the 16-bit number; error at most range / 65534. The file's notes
// give the ranges: 1 for coordinates, the greatest value for scales and weights.
#pragma once

#include "format/notes.h"

#include <array>
#include <string>
#include <vector>

namespace nook
{

struct TileTexture
{
	int width_px = 0;
	int height_px = 0;
	int layer_height_px = 0;    // height of one frame's layer, stacked vertically; else the full height
	std::vector<float> rgba;    // rows from the top
	std::array<float, 4> range; // per channel, for PNG
	std::string layout;         // described in words
};

// layered: stacks frames that have their own tiles vertically, instead of placing all variants side by side.
TileTexture textureOf(const PatternTile& tile, bool layered = false);

std::string tileExr(const PatternTile& tile, const TileQuality& quality, const EmitContext& context);
std::string tilePng(const PatternTile& tile, const TileQuality& quality, const EmitContext& context);

} // namespace nook
