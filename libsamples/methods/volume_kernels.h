// SPDX-License-Identifier: GPL-3.0-or-later
// The shared kernels of volumes (*.glsl) as C++: one object per receiver and polygon.
#pragma once

#include "core/round.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/ext/vector_uint4.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <span>

namespace nook::volume_kernels
{

using namespace glm; // names of GLSL

class Kernels
{
public:
	std::span<const glm::vec3> corners; // of the polygon, relative to the receiver, metres

	std::span<const glm::vec3> rays;         // for masks: multiples of 128
	std::span<const glm::uvec4> half_spaces; // their table, rows of texels, one table after the other

	// GLM's version reads a float through an integer pointer, which violates strict aliasing.
	static uint floatBitsToUint(float value)
	{
		return bitsAs<uint>(value);
	}
	static float uintBitsToFloat(uint bits)
	{
		return bitsAs<float>(bits);
	}
	vec3 nookRay(int i) const
	{
		return rays[static_cast<std::size_t>(i)];
	}
	uvec4 nookHalfSpace(ivec2 texel, int four)
	{
		return half_spaces[static_cast<std::size_t>((four * nookHalfSpaces() + texel.y) * nookHalfSpaces() + texel.x)];
	}
	vec3 nookCorner(int i) const
	{
		return corners[static_cast<std::size_t>(i)];
	}

#include "methods/kernels/form_factor.glsl"
#include "methods/kernels/mask.glsl"
#include "methods/kernels/volume.glsl"
};

} // namespace nook::volume_kernels
