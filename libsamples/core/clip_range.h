// SPDX-License-Identifier: GPL-3.0-or-later
// What a depth buffer's 0 to 1 stand for.
#pragma once

namespace nook
{

enum class ClipRange
{
	minus_one_to_one, // z_ndc = 2 × device − 1: OpenGL's default
	zero_to_one,      // z_ndc = device: Direct3D, Vulkan, Metal, and reversed depth
};

} // namespace nook
