// SPDX-License-Identifier: GPL-3.0-or-later
// The named arrays of four floats that C, GLSL, HLSL and CSV files hold for a pattern or tile.
#pragma once

#include "format/notes.h"

#include <array>
#include <string>
#include <vector>

namespace nook
{

// Disk: x, y, half length √(1 − x² − y²) of the line, weight. Ball and directions: x, y, z, weight.
using Sample = std::array<float, 4>;

std::vector<Sample> samplesOf(const Pattern& pattern);

// Column names: "x,y,half_length,weight" or "x,y,z,weight".
const char* columnsOf(Domain domain);

// Disk and hemisphere: cosine, sine, scale, handedness. Ball: x, y, z of the axis, scale.
std::vector<Sample> transformsOf(const PatternTile& tile);
const char* transformColumnsOf(Domain domain);

// The formula for a pixel's variant in a tile, "(y % 4) * 4 + x % 4" plus the frame's offset. side: the 4 in it, a number or a name.
std::string variantText(const PatternTile& tile, const std::string& side);

struct SourceConstant
{
	std::string name; // "NOOK_DISK9_COUNT"
	int value = 0;
	std::string comment;
};

struct SourceArray
{
	std::string name;      // "nook_disk9_points"
	std::string size_name; // the constant that holds its length
	std::string comment;   // one line
	std::vector<Sample> rows;
};

// A source file, independent of the language.
struct Source
{
	Notes notes;
	std::string guard; // "NOOK_DISK9"
	std::vector<SourceConstant> constants;
	std::vector<SourceArray> arrays;
};

// Throws Error (usage) if context.name is not an identifier.
Source sourceOf(const Pattern& pattern, const Recipe* recipe, const Quality& quality, const EmitContext& context);
Source sourceOf(const PatternTile& tile, const TileQuality& quality, const EmitContext& context);

} // namespace nook
