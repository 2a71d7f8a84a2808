// SPDX-License-Identifier: GPL-3.0-or-later
// The shared kernels (*.glsl) as C++: one object a picture, whose members are what the GLSL module has as globals.
#pragma once

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "shade/picture.h"

#include <cstddef>
#include <span>

#define NOOK_SKY 1e30f

namespace nook
{

// The uniform block, std140: sixteen bytes a member, in this order.
struct ShadeBlock
{
	glm::vec4 size{};     // width, height in pixels; 1/width, 1/height
	glm::vec4 across_x{}; // camera.glsl
	glm::vec4 across_y{};
	glm::vec4 w{};
	glm::vec4 radius{};          // metres
	glm::vec4 alchemy{};         // σ, k, β, ε
	glm::ivec4 count{};          // samples a variant, side of the window of variants, 1 with the normal, 1 with Alchemy's cut
	glm::ivec4 grid{1, 0, 0, 0}; // side of a cell of visibility in pixels; taps on each side and axis of a pass (reconstruct.glsl)
	// Of methods to compare with (rivals_*.glsl), which are never emitted:
	glm::ivec4 march{};
	glm::vec4 rival{};
};

namespace shade_kernels
{

using glm::abs;
using glm::clamp;
using glm::cos;
using glm::dot;
using glm::exp;
using glm::floor;
using glm::ivec2;
using glm::log2;
using glm::max;
using glm::min;
using glm::pow;
using glm::sin;
using glm::sqrt;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

class Kernels
{
public:
	ShadeBlock nook;
	std::span<const float> depths;        // rows from the top
	std::span<const glm::vec3> normals;   // view space
	std::span<const glm::vec4> samples;   // one variant after the other
	const PicturePlane* cells = nullptr;  // visibility so far, of cells of nook.grid.x pixels
	std::span<const PicturePlane> levels; // of a picture with mip levels
	std::span<const PicturePlane> tables; // layers

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
		const ivec2 cell(pixel.x / nook.grid.x, pixel.y / nook.grid.x);
		return (cell.y % nook.count.y) * nook.count.y + cell.x % nook.count.y;
	}
	vec4 nookSample(int row, int i) const
	{
		return samples[static_cast<std::size_t>(row * nook.count.x + i)];
	}
	float nookVisibility(ivec2 cell) const
	{
		return cells->values[cells->index(cell.x, cell.y)];
	}
	// Quads, or scalars in x.
	vec4 nookLevel(ivec2 texel, int level) const
	{
		const PicturePlane& plane = levels[static_cast<std::size_t>(level)];
		const std::size_t i = plane.index(texel.x, texel.y);
		if (plane.channels == 1)
		{
			return vec4(plane.values[i], 0.0F, 0.0F, 1.0F);
		}
		return vec4(plane.values[i], plane.values[i + 1], plane.values[i + 2], plane.values[i + 3]);
	}
	uvec4 nookTable(ivec2 texel, int table) const
	{
		const PicturePlane& plane = tables[static_cast<std::size_t>(table)];
		const std::size_t i = plane.index(texel.x, texel.y);
		return uvec4(plane.counts[i], plane.counts[i + 1], plane.counts[i + 2], plane.counts[i + 3]);
	}

#include "shade/alchemy.glsl"
#include "shade/camera.glsl"
#include "shade/reconstruct.glsl"
#include "shade/rivals_crytek.glsl"
#include "shade/rivals_hbao.glsl"
#include "shade/rivals_sao.glsl"
#include "shade/rivals_volumetric.glsl"
#include "shade/vo.glsl"

private:
	std::size_t index(ivec2 pixel) const
	{
		return static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(nook.size.x) + static_cast<std::size_t>(pixel.x);
	}
};

} // namespace shade_kernels
} // namespace nook
