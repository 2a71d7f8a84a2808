// SPDX-License-Identifier: GPL-3.0-or-later
// The shaders that draw ambient occlusion volumes: the same text for `nook shade` and for an engine (`nook emit`).
#pragma once

#include <string>

namespace nook
{

struct AovTextSettings
{
	bool storage_buffers = false; // OpenGL 4.3's, else buffer textures for 3.3
	int directions = 0;           // of aov-mask: 32 to 256, a multiple of 32; 0: sums of occlusion
	bool device_depth = false;    // depth as a depth buffer holds it, else along the view direction, metres
};

// One file for all stages, without #version: an engine says NOOK_VERTEX, NOOK_FRAGMENT or NOOK_RESOLVE before it.
std::string aovText(const AovTextSettings& settings);

} // namespace nook
