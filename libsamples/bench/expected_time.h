// SPDX-License-Identifier: GPL-3.0-or-later
// How long a picture would take to draw, from drawings of it that are much smaller.
#pragma once

#include "core/error.h"

#include <functional>

namespace nook
{

// A candidate that is not drawn, since that would take too long.
struct TooSlow : Error
{
	TooSlow(double expected, double limit);

	double expected_s;
};

// Seconds of a picture of that size, by two drawings of a sixteenth and an eighth of its sides and one of a quarter, and the line
// through the last two: a part of each drawing does not depend on the pixels. As soon as one tells of more than the limit, no
// larger one is drawn. 0 for a picture that is too small for that (less than 64 pixels high).
double expectedSeconds(const std::function<double(int width_px, int height_px)>& draw, int width_px, int height_px, double limit_s);

} // namespace nook
