// SPDX-License-Identifier: GPL-3.0-or-later
// Two visibility images → a picture of test − reference: blue where the test is darker, red where it is lighter, a legend below.
#pragma once

#include "core/notes.h"
#include "measure/compare.h"

#include <cstdint>
#include <span>
#include <string>

namespace nook
{

// A round range (1, 2 or 5 × a power of ten, 0.001 to 1) that holds 99 % of the |differences| of the pixels that count.
double differenceRange(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted);

// A PNG file: white is 0, the strongest colours are ±range and beyond, gray pixels do not count. Small pictures are enlarged by a
// whole factor, so that the legend has room. Requires equal sizes and range > 0.
std::string differencePng(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
						  double range, const Notes& notes);

} // namespace nook
