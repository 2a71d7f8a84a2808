// SPDX-License-Identifier: GPL-3.0-or-later
// An image file of any kind → the visibility that it shows.
#pragma once

#include "core/image.h"
#include "measure/compare.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace nook
{

struct VisibilityImage
{
	std::string path;
	int width_px = 0;
	int height_px = 0;
	std::string channel;               // where the values come from; "R,G,B" for a gray picture
	std::vector<float> values;         // finite; rows from the top
	std::vector<float> standard_error; // of the channel of that name; empty: the file has none

	VisibilityPlane plane() const
	{
		return {width_px, height_px, values};
	}
};

// The channel `wanted`; where that is empty: "visibility", else the only one (an opacity A does not count), else Y, else R, G, B
// where all pixels are gray. Integers of a file become 0 to 1. Throws Error (invalid_input), naming the file and the channel or
// the pixel, where there is no such channel (with a list of those there are) or a value is not finite.
VisibilityImage visibilityOf(const Image& image, const std::string& path, const std::string& wanted);

// Throws Error (invalid_input) where the sizes differ.
void checkSameSize(const VisibilityImage& test, const VisibilityImage& reference);

// Root mean square of the standard error over the pixels that count; none without that channel.
std::optional<double> ownUncertainty(const VisibilityImage& image, std::span<const uint8_t> counted);

} // namespace nook
