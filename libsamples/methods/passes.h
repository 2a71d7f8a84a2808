// SPDX-License-Identifier: GPL-3.0-or-later
// Settings → the passes that make the picture, one after the other, for the CPU and for OpenGL.
#pragma once

#include "methods/block.h"
#include "methods/kernels.h"
#include "methods/picture.h"
#include "methods/settings.h"

#include <string>
#include <variant>
#include <vector>

namespace nook
{

// One kernel in both languages. What it returns is what its picture holds: scalar, quad, counts.
struct ShadeKernel
{
	using Kernels = shade_kernels::Kernels;
	std::string name;      // for people
	const char* call = ""; // in GLSL
	std::variant<float (Kernels::*)(glm::ivec2), glm::vec4 (Kernels::*)(glm::ivec2), glm::uvec4 (Kernels::*)(glm::ivec2)> function;
};

// Where a kernel finds a picture of an earlier pass.
enum class ShadeSlot
{
	cells,  // nookVisibility: scalar
	packed, // nookPacked: quad
	levels, // nookLevel: quad, or scalar in x; with mip levels
	tables, // nookTable: counts, with layers
	range,  // nookRange: quad, of one row
};

struct ShadeRead
{
	ShadeSlot slot = ShadeSlot::cells;
	std::size_t picture = 0;
};

// What a pass writes beside the visibility that its kernel returns, into a quad.
enum class ShadePacking
{
	none,
	links,   // nookLinked
	surface, // nookOfSurface
};

// Its function, of a cell and its visibility; null for none.
const char* packingCall(ShadePacking packing);

struct ShadePass
{
	ShadeKernel kernel;
	ShadePacking packing = ShadePacking::none;
	bool of_pixel = false; // takes the pixel of its cell, not the cell
	bool leaves = false;   // what is negative, for the pass after it
	bool fills = false;    // draws what the pass before it left, into the same picture
	std::vector<ShadeRead> reads;
	std::size_t picture = 0; // that it fills
	int level = 0;           // of that picture, which it may read at other levels
	int layer = 0;
	bool scans = false; // instead of the kernel: running sums of the counts that it reads, along nook.axis
	ShadeBlock block;
};

struct ShadePlan
{
	std::vector<PictureShape> pictures;
	std::vector<ShadePass> passes; // never empty; the last one fills level 0 of a scalar, the result; of a quad with bent normals:
								   // these as xyz, visibility as w
};

// Whether the last pass has them beside visibility.
bool hasBentNormals(const ShadeSettings& settings);

// `compute`: passes may be scans. Throws as blockOf.
ShadePlan planOf(const ShadeFrame& frame, const ShadeSamples& samples, const ShadeSettings& settings, bool compute = false);

} // namespace nook
