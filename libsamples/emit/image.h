// SPDX-License-Identifier: GPL-3.0-or-later
// Pixels and notes → the bytes of an image file; the same input gives the same bytes, without a date or a path in them.
#pragma once

#include "emit/notes.h"

#include <cstdint>
#include <span>
#include <string>

namespace nook
{

// 8-bit sRGB; 3 bytes a pixel, rows from the top.
std::string pngBytes(int width_px, int height_px, std::span<const uint8_t> rgb, const Notes& notes);

// 16-bit numbers, no colour: 4 a pixel, the fourth is not an opacity and nothing is multiplied by it.
std::string pngBytes(int width_px, int height_px, std::span<const uint16_t> rgba, const Notes& notes);

// 32-bit floats, 4 a pixel, uncompressed scan lines.
std::string exrBytes(int width_px, int height_px, std::span<const float> rgba, const Notes& notes);

} // namespace nook
