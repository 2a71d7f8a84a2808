// SPDX-License-Identifier: GPL-3.0-or-later
// The named arrays of four floats that C, GLSL, HLSL and CSV files hold for a pattern or tile, and those files.
#pragma once

#include "core/text.h"
#include "format/notes.h"

#include <array>
#include <cstdint>
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

// The formula for a pixel's variant, "(y % 4) * 4 + x % 4" plus the frame's offset. side: the 4 in it, a number or a name.
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

// A C/C++ header; compiles as C11 and as C++17 without warnings; has include guards. Rows are float[4]; constants are macros.
std::string headerText(const Source& source);

// For GLSL 1.30 and later and GLSL ES 3.00 and later. Has no #version of its own, so that any shader may include it; compiled
// alone, where the version is then 1.00 or 1.10, it declares nothing, since those have no constant arrays. The arrays are highp, so
// a fragment shader of ES needs no default precision.
std::string glslText(const Source& source);

std::string hlslText(const Source& source);

// The four floats, comma-separated.
std::string rowText(const Sample& sample);

// A tile as a four-channel texture: OpenEXR (32-bit floats, exact) or PNG (16 bits).
//
// Tiles with transforms: size × size texels; the texel of a window pixel holds its transform: R, G, B, A = cos, sin, scale,
// handedness (ball: x, y, z of the axis, scale).
// Tiles with their own points: size² × count texels; column = variant = row · size + column of the window, row = sample; R, G, B, A
// = x, y, half length, weight (disk) or x, y, z, weight.
// PNG: value = (v − 32768) / 32767 · range of its channel, with v the 16-bit number; error at most range / 65534. The file's notes
// give the ranges: 1 for coordinates, the greatest value for scales and weights.
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

// A KTX2 file with one texture.
enum class Ktx2Texel
{
	rgba32_float,
	rgba8_unorm, // data, not colour
	bc4_unorm,   // blocks of 4 x 4 texels with one channel, in eight bytes each
};

struct Ktx2Texture
{
	Ktx2Texel texel = Ktx2Texel::rgba32_float;
	uint32_t width = 1;
	uint32_t height = 1;
	uint32_t depth = 0;              // 0: not a 3D texture
	uint32_t layers = 0;             // 0: not an array
	Notes notes;                     // key-value data, in any order
	std::string bytes;               // texels: x fastest, then y, z and layers; little-endian
	std::vector<std::string> mips{}; // smaller levels likewise, the largest first
};

std::string ktx2Bytes(const Ktx2Texture& texture);

} // namespace nook
