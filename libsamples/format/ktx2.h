// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a KTX2 file with one uncompressed texture of one level.
#pragma once

#include "core/text.h"

#include <cstdint>
#include <string>

namespace nook
{

enum class Ktx2Texel
{
	rgba32_float,
	rgba8_unorm, // data, not colour
};

struct Ktx2Texture
{
	Ktx2Texel texel = Ktx2Texel::rgba32_float;
	uint32_t width = 1;
	uint32_t height = 1;
	uint32_t depth = 0;  // 0: not a 3D texture
	uint32_t layers = 0; // 0: not an array
	Notes notes;         // key-value data, in any order
	std::string bytes;   // texels: x fastest, then y, z and layers; little-endian
};

std::string ktx2Bytes(const Ktx2Texture& texture);

} // namespace nook
