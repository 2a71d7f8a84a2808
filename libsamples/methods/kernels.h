// SPDX-License-Identifier: GPL-3.0-or-later
// The shared kernels (*.glsl, converted by cmake/twin.cmake) as C++: one object per picture, whose members correspond to the GLSL
// module's globals.
#pragma once

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/round.h"
#include "methods/block_members.h"
#include "methods/picture.h"

#include <bit>
#include <cstddef>
#include <span>

#define NOOK_SKY 1e30f

namespace nook
{

// The uniform block in std140 layout, and a shader's constants (block_members.h).
struct alignas(16) ShadeBlock
{
	using vec2 = glm::vec2;
	using vec3 = glm::vec3;
	using vec4 = glm::vec4;
	using ivec2 = glm::ivec2;

#define NOOK_FIELD(type, name, meaning) type name{};
	NOOK_MODULE_MEMBERS(NOOK_FIELD)
	NOOK_OWN_MEMBERS(NOOK_FIELD)
#undef NOOK_FIELD
#define NOOK_FIELD(name, value, meaning) int name = value;
	NOOK_SHADE_CONSTANTS(NOOK_FIELD)
#undef NOOK_FIELD
};

namespace shade_kernels
{

using namespace glm; // names of GLSL

class Kernels
{
public:
	ShadeBlock nook;
	int stride = 0;                       // row pitch of the next two in pixels; 0: the picture's width
	std::span<const float> depths;        // rows from the top
	std::span<const glm::vec3> normals;   // view space
	std::span<const glm::vec4> samples;   // consecutive variants
	const PicturePlane* cells = nullptr;  // visibility so far, one value per cell of nook.cell pixels
	const PicturePlane* packed = nullptr; // quads: visibility so far and other values of each cell
	std::span<const PicturePlane> levels; // of a picture with mip levels
	std::span<const PicturePlane> tables; // layers
	const PicturePlane* range = nullptr;  // quads

	float nookDepth(ivec2 pixel) const
	{
		return depths[index(pixel)];
	}
	vec3 nookNormal(ivec2 pixel) const
	{
		return normals[index(pixel)];
	}
	int nookVariant(ivec2 pixel) const
	{
		const bool below = nook.across_y.x < 0.0F; // nookRow
		const int row = below ? static_cast<int>(2.0F * nook.origin.y + nook.size.y) - 1 - pixel.y : pixel.y;
		const ivec2 cell(pixel.x / nook.cell, row / nook.cell);
		const int own = (cell.y + nook.variant / nook.window) % nook.window * nook.window + (cell.x + nook.variant) % nook.window;
		return nook.variant / (nook.window * nook.window) * (nook.window * nook.window) + own;
	}
	vec4 nookSample(int row, int i) const
	{
		return samples[static_cast<std::size_t>(row * nook.samples + i)];
	}
	float nookVisibility(ivec2 cell) const
	{
		return cells->values[cells->index(cell.x, cell.y)];
	}
	vec4 nookPacked(ivec2 cell) const
	{
		const std::size_t i = packed->index(cell.x, cell.y);
		return vec4(packed->values[i], packed->values[i + 1], packed->values[i + 2], packed->values[i + 3]);
	}
	// Quads, or scalars in x.
	vec4 nookLevel(ivec2 texel, int level) const
	{
		const PicturePlane& plane = levels[static_cast<std::size_t>(level)];
		const std::size_t i = plane.index(texel.x, texel.y);
		return plane.channels == 1 ? vec4(plane.values[i], 0.0F, 0.0F, 1.0F)
								   : vec4(plane.values[i], plane.values[i + 1], plane.values[i + 2], plane.values[i + 3]);
	}
	uvec4 nookTable(ivec2 texel, int table) const
	{
		const PicturePlane& plane = tables[static_cast<std::size_t>(table)];
		const std::size_t i = plane.index(texel.x, texel.y);
		return uvec4(plane.counts[i], plane.counts[i + 1], plane.counts[i + 2], plane.counts[i + 3]);
	}

	vec4 nookRange(int i) const
	{
		const std::size_t at = range->index(i, 0);
		return vec4(range->values[at], range->values[at + 1], range->values[at + 2], range->values[at + 3]);
	}

	// GLM's versions read a float through an integer pointer, which violates strict aliasing.
	static uint floatBitsToUint(float value)
	{
		return bitsAs<uint>(value);
	}
	static float uintBitsToFloat(uint bits)
	{
		return bitsAs<float>(bits);
	}
	static int bitCount(uint bits)
	{
		return std::popcount(bits);
	}

#include "methods/twins/aov_sparse.h"
#include "methods/twins/screen.h"

private:
	std::size_t index(ivec2 pixel) const
	{
		const auto row = static_cast<std::size_t>(stride > 0 ? stride : static_cast<int>(nook.size.x));
		return static_cast<std::size_t>(pixel.y) * row + static_cast<std::size_t>(pixel.x);
	}
};

} // namespace shade_kernels
} // namespace nook
