// SPDX-License-Identifier: GPL-3.0-or-later
// Extracts the visibility from an image file of any kind.
#pragma once

#include "core/image.h"
#include "core/words.h"
#include "image/compare.h"

#include <glm/vec3.hpp>

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

// Throws Error (invalid_input) if the sizes of two pictures with path, width_px and height_px differ.
template <class Picture> void checkSameSize(const Picture& test, const Picture& reference)
{
	const auto sizeText = [](const Picture& picture)
	{
		return std::to_string(picture.width_px) + "x" + std::to_string(picture.height_px) + " pixels";
	};
	refuseInputIf(test.width_px != reference.width_px || test.height_px != reference.height_px, test.path + ": size",
				  sizeText(test), sizeText(reference) + " as " + reference.path);
}

// Root mean square of the standard error over the counted pixels; none without that channel.
std::optional<double> ownUncertainty(const VisibilityImage& image, std::span<const uint8_t> counted);

// Angles between the bent normals of two pictures.

struct BentImage
{
	std::string path;
	int width_px = 0;
	int height_px = 0;
	std::string channel;            // "bent" or "N"
	std::vector<glm::dvec3> bent{}; // unit, rows from the top; 0 where the file has 0 (sky)
};

// Reads the channels bent.X, bent.Y and bent.Z, or else N.X, N.Y and N.Z, the normals of a G-buffer. Throws Error (invalid_input),
// naming the file and its channels, if neither set is there or a value is not finite.
BentImage bentOf(const Image& image, const std::string& path);

struct BentAngles
{
	std::size_t pixels = 0; // compared pixels: a surface in both pictures
	double mean_deg = 0.0;  // unweighted mean over pixels
	double rmse_deg = 0.0;
	double p95_deg = 0.0;
	double max_deg = 0.0;
	int worst_x = 0;
	int worst_y = 0;
};

// counted: 1 for pixels to compare; empty: all. Throws Error (invalid_input) if the sizes differ or no pixel remains.
BentAngles anglesBetween(const BentImage& test, const BentImage& reference, std::span<const uint8_t> counted);

} // namespace nook
