// SPDX-License-Identifier: GPL-3.0-or-later
// Extracts the visibility from an image file of any kind.
#pragma once

#include "core/image.h"
#include "image/compare.h"

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
	std::string channel;               // channel that the values come from; "R,G,B" for a gray picture
	std::vector<float> values;         // finite; rows from the top
	std::vector<float> standard_error; // from the channel of that name; empty if the file has none

	VisibilityPlane plane() const
	{
		return {width_px, height_px, values};
	}
};

// Selects the channel `wanted`. If that is empty: "visibility", else the only channel (not counting opacity A), else Y, else R, G,
// B if all pixels are gray. Integers are scaled to 0…1. Throws Error (invalid_input) if the channel does not exist (listing those
// that do) or a value is not finite.
VisibilityImage visibilityOf(const Image& image, const std::string& path, const std::string& wanted);

// Throws Error (invalid_input) if the sizes differ.
void checkSameSize(const VisibilityImage& test, const VisibilityImage& reference);

// Root mean square of the standard error over the counted pixels; none without that channel.
std::optional<double> ownUncertainty(const VisibilityImage& image, std::span<const uint8_t> counted);

} // namespace nook
