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

#include "methods/picture.h"

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
	glm::vec4 w{};                // and what device depth is at the far end
	glm::vec4 origin{};           // the picture's first pixel in the texture
	glm::ivec4 rect{};            // first and last pixel with depth: x, y, x, y
	glm::vec4 depth{};            // depth.glsl
	glm::vec4 error{};            // of depth: half a step for w = 1, share of it; of normals: sine
	glm::vec4 radius{};           // metres
	glm::vec4 alchemy{};          // σ, k, β, ε
	glm::vec4 volume{};           // thickness, second radius: metres
	glm::vec4 limits{};           // of the bands: radii in pixels; most and least pixels of a radius
	glm::ivec4 count{};           // samples a variant, side of the window of variants, 1 with the normal, 1 with Alchemy's cut
	glm::ivec4 features{};        // two radii (TwoRadii), 1 quadratic falloff, 1 paired, 1 with a thickness
	glm::ivec4 bands{0, 0, 1, 0}; // samples of the first band, of the first two, bands
	glm::ivec4 grid{1, 0, 0, 0};  // side of a cell of visibility in pixels; taps on each side and axis of a pass
								  // (reconstruct.glsl), or level that it makes; coarser levels of depth or its moments
	glm::vec4 statvo{};           // statvo_tables.glsl
	glm::ivec4 layers{};
	glm::ivec4 table{};
	glm::vec4 slices{}; // slices.glsl: thickness, in radii
	// Never a member in modules: steps of a slice or of a direction (slices.glsl, rivals_hbao.glsl), and of methods to compare with;
	// march.w: how many variants further than its own a pixel takes
	// (--debug noise).
	glm::ivec4 march{};
	glm::vec4 rival{};
};

namespace shade_kernels
{

using glm::abs;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::floor;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::log2;
using glm::max;
using glm::min;
using glm::pow;
using glm::sin;
using glm::sqrt;
using glm::uint;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

class Kernels
{
public:
	ShadeBlock nook;
	int stride = 0;                       // pixels from row to row of the next two; 0: as wide as the picture
	std::span<const float> depths;        // rows from the top
	std::span<const glm::vec3> normals;   // view space
	std::span<const glm::vec4> samples;   // one variant after the other
	const PicturePlane* cells = nullptr;  // visibility so far, of cells of nook.grid.x pixels
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
		const ivec2 cell(pixel.x / nook.grid.x, pixel.y / nook.grid.x);
		const int own = (cell.y % nook.count.y) * nook.count.y + cell.x % nook.count.y;
		return (own + nook.march.w) % (nook.count.y * nook.count.y);
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

	vec4 nookRange(int i) const
	{
		const std::size_t at = range->index(i, 0);
		return vec4(range->values[at], range->values[at + 1], range->values[at + 2], range->values[at + 3]);
	}

#include "methods/kernels/alchemy.glsl"
#include "methods/kernels/aov_sparse.glsl"
#include "methods/kernels/camera.glsl"
#include "methods/kernels/debug.glsl"
#include "methods/kernels/debug_statvo.glsl"
#include "methods/kernels/depth.glsl"
#include "methods/kernels/depth_levels.glsl"
#include "methods/kernels/reconstruct.glsl"
#include "methods/kernels/rivals_crytek.glsl"
#include "methods/kernels/rivals_hbao.glsl"
#include "methods/kernels/rivals_sao.glsl"
#include "methods/kernels/rivals_volumetric.glsl"
#include "methods/kernels/slices.glsl"
#include "methods/kernels/statvo.glsl"
#include "methods/kernels/statvo_flags.glsl"
#include "methods/kernels/statvo_tables.glsl"
#include "methods/kernels/tables.glsl"
#include "methods/kernels/vo.glsl"
#include "methods/kernels/vo_area.glsl"

private:
	std::size_t index(ivec2 pixel) const
	{
		const auto row = static_cast<std::size_t>(stride > 0 ? stride : static_cast<int>(nook.size.x));
		return static_cast<std::size_t>(pixel.y) * row + static_cast<std::size_t>(pixel.x);
	}
};

} // namespace shade_kernels
} // namespace nook
