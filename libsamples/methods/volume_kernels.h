// SPDX-License-Identifier: GPL-3.0-or-later
// The shared kernels of volumes (*.glsl) as C++: one object per receiver and polygon.
#pragma once

#include "core/round.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <span>

namespace nook::volume_kernels
{

using glm::abs;
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::floor;
using glm::max;
using glm::min;
using glm::sqrt;
using glm::uint;
using glm::vec2;
using glm::vec3;
using glm::vec4;

class Kernels
{
public:
	std::span<const glm::vec3> corners; // of the polygon, relative to the receiver, metres

	std::span<const glm::vec4> directions; // for masks

	// GLM's version reads a float through an integer pointer, which violates strict aliasing.
	static uint floatBitsToUint(float value)
	{
		return bitsAs<uint>(value);
	}
	static float uintBitsToFloat(uint bits)
	{
		return bitsAs<float>(bits);
	}
	vec4 nookDirection(int i) const
	{
		return directions[static_cast<std::size_t>(i)];
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
