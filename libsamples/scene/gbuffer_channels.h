// SPDX-License-Identifier: GPL-3.0-or-later
// Recognises a G-buffer's channels by the names that programs give them.
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

// The layer `wanted`; if that is empty: N, else the only one whose last name part is n, normal or normals (case-insensitive). Its
// channels end in X, Y, Z or R, G, B. Throws Error (invalid_input) with the list of channels.
NormalChannels normalChannels(const Image& image, const std::string& path, const std::string& wanted);

// True if a depth channel and normals can be recognised by name.
bool looksLikeGBuffer(const Image& image);

} // namespace nook
