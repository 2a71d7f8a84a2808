// SPDX-License-Identifier: GPL-3.0-or-later
// Plans the passes that make a picture, for the CPU and for OpenGL.
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

// One kernel in both languages. Its return type is its picture's format: scalar, quad, counts.
struct ShadeKernel
{
	using Kernels = shade_kernels::Kernels;
	std::string name;      // display name
	const char* call = ""; // GLSL function
	std::variant<float (Kernels::*)(glm::ivec2), glm::vec4 (Kernels::*)(glm::ivec2), glm::uvec4 (Kernels::*)(glm::ivec2)> function;
};

// Name under which a kernel reads a picture of an earlier pass.
enum class ShadeSlot
{
	cells,  // nookVisibility: scalar
	packed, // nookPacked: quad
	levels, // nookLevel: quad, or scalar in x; with mip levels
	tables, // nookTable: counts, with layers
	range,  // nookRange: quad, one row
};

struct ShadeRead
{
	ShadeSlot slot = ShadeSlot::cells;
	std::size_t picture = 0;
};

// Values that a pass packs into a quad with its kernel's visibility.
enum class ShadePacking
{
	none,
	links,   // nookLinked
	surface, // nookOfSurface
};

// The packing function, called with a cell and its visibility; null for none.
const char* packingCall(ShadePacking packing);

struct ShadePass
{
	ShadeKernel kernel;
	ShadePacking packing = ShadePacking::none;
	bool of_pixel = false; // takes the pixel of its cell instead of the cell
	bool leaves = false;   // discards negative results, for the next pass to fill
	bool fills = false;    // fills what the previous pass discarded, in the same picture
	std::vector<ShadeRead> reads;
	std::size_t picture = 0; // picture that it fills
	int level = 0;           // level of that picture; it may read others
	int layer = 0;
	bool scans = false; // replaces the kernel: prefix sums of the counts along nook.axis
	ShadeBlock block;
};

struct ShadePlan
{
	std::vector<PictureShape> pictures;
	std::vector<ShadePass> passes; // never empty; the last one fills level 0 of a scalar, the result, or of a quad with bent
								   // normals in xyz and visibility in w

	std::size_t addPicture(const PictureShape& shape)
	{
		pictures.push_back(shape);
		return pictures.size() - 1;
	}

	ShadePass& addPass(const ShadeKernel& kernel, const std::vector<ShadeRead>& reads, std::size_t picture, const ShadeBlock& block)
	{
		ShadePass& pass = passes.emplace_back();
		pass.kernel = kernel;
		pass.reads = reads;
		pass.picture = picture;
		pass.block = block;
		return pass;
	}
};

// True if the last pass outputs bent normals with visibility.
bool hasBentNormals(const ShadeSettings& settings);

// `compute`: passes may be scans. Throws like blockOf.
ShadePlan planOf(const ShadeFrame& frame, const ShadeSamples& samples, const ShadeSettings& settings, bool compute = false);

// Generates the OpenGL 3.3 fragment shader of a pass.

// Contains only the functions that the pass reaches, with its block's integers as constants, as in an emitted module: loops unroll,
// and unused features cost nothing.
std::string glSourceOf(const ShadePass& pass, PictureFormat format);

} // namespace nook
