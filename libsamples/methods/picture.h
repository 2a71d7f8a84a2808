// SPDX-License-Identifier: GPL-3.0-or-later
// Formats of the pictures that passes write and read, and their storage on the CPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace nook
{

enum class PictureFormat
{
	scalar, // one 32-bit float: R32F
	quad,   // four of them: RGBA32F
	counts, // four unsigned 32-bit integers: RGBA32UI; always an array texture
};

struct PictureShape
{
	PictureFormat format = PictureFormat::scalar;
	int width = 0; // of level 0; level l has max(1, width >> l), as in OpenGL
	int height = 0;
	int levels = 1;
	int layers = 1; // more than 1 requires counts
};

inline int levelSide(int side, int level)
{
	return side >> level > 1 ? side >> level : 1;
}

inline int channelsOf(PictureFormat format)
{
	return format == PictureFormat::scalar ? 1 : 4;
}

// One level of one layer, rows from the top.
struct PicturePlane
{
	int width = 0;
	int height = 0;
	int channels = 1;
	std::vector<float> values;         // for scalar and quad
	std::vector<std::uint32_t> counts; // for counts

	std::size_t index(int x, int y) const
	{
		return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
			   static_cast<std::size_t>(channels);
	}
};

} // namespace nook
