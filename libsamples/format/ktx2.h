// SPDX-License-Identifier: GPL-3.0-or-later
// Texels → a KTX2 file of one texture with one level, without compression.
#pragma once

#include "core/notes.h"

#include <cstdint>
#include <string>

namespace nook
{

enum class Ktx2Texel
{
	rgba32_float,
	rgba8_unorm, // no colours
};

struct Ktx2Texture
{
	Ktx2Texel texel = Ktx2Texel::rgba32_float;
	uint32_t width = 1;
	uint32_t height = 1;
	uint32_t depth = 0;  // 0: not one of three dimensions
	uint32_t layers = 0; // 0: no array
	Notes notes;         // keys and values, in any order
	std::string bytes;   // of the texels: x fastest, then y, z and layers; numbers are little-endian
};

std::string ktx2Bytes(const Ktx2Texture& texture);

} // namespace nook
