// SPDX-License-Identifier: GPL-3.0-or-later
// The shared kernels (*.glsl) as C++: one object a picture, whose members are what the GLSL module has as globals.
#pragma once

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

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
	glm::vec4 radius{};  // metres
	glm::vec4 alchemy{}; // σ, k, β, ε
	glm::ivec4 count{};  // samples a variant, side of the window of variants, 1 with the normal, 1 with Alchemy's cut
};

namespace shade_kernels
{

using glm::clamp;
using glm::dot;
using glm::floor;
using glm::ivec2;
using glm::max;
using glm::min;
using glm::pow;
using glm::vec2;
using glm::vec3;
using glm::vec4;

class Kernels
{
public:
	ShadeBlock nook;
	std::span<const float> depths;      // rows from the top
	std::span<const glm::vec3> normals; // view space
	std::span<const glm::vec4> samples; // one variant after the other

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
		return (pixel.y % nook.count.y) * nook.count.y + pixel.x % nook.count.y;
	}
	vec4 nookSample(int row, int i) const
	{
		return samples[static_cast<std::size_t>(row * nook.count.x + i)];
	}

#include "shade/alchemy.glsl"
#include "shade/camera.glsl"
#include "shade/vo.glsl"

private:
	std::size_t index(ivec2 pixel) const
	{
		return static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(nook.size.x) + static_cast<std::size_t>(pixel.x);
	}
};

} // namespace shade_kernels
} // namespace nook
