// SPDX-License-Identifier: GPL-3.0-or-later
// The names that programs give the channels of a G-buffer → which is which.
#pragma once

#include "core/image.h"

#include <string>

namespace nook
{

// Three channels of one layer.
struct NormalChannels
{
	std::string name; // "N", "ViewLayer.Normal"
	int x = -1;
	int y = -1;
	int z = -1;
};

// The layer `wanted`; where that is empty: N, else the only one whose last name part is n, normal or normals, in any case. Its
// channels end in X, Y, Z or R, G, B. Throws Error (invalid_input) with the channels that there are.
NormalChannels normalChannels(const Image& image, const std::string& path, const std::string& wanted);

// Whether a depth channel and normals can be told by name: what a G-buffer is known by.
bool looksLikeGBuffer(const Image& image);

} // namespace nook
