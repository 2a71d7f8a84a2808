// SPDX-License-Identifier: GPL-3.0-or-later
// What core/image.cpp asks of the module that OpenImageIO is linked to. That library brings some 250 others, which take
// thirty times as long to load as everything else of nook: they are loaded with the first picture, and not for a pattern.
#pragma once

#include "core/image.h"

namespace nook
{

enum class PixelType
{
	uint8,
	uint16,
	float32,
};

struct ImageToEncode
{
	const char* ending = ""; // "nook.exr": its ending picks the format
	int width_px = 0;
	int height_px = 0;
	PixelType type = PixelType::float32;
	std::vector<std::string> channels{}; // names; count where empty
	int count = 0;                       // of channels
	int z_channel = -1;
	const void* pixels = nullptr; // rows from the top
	Notes attributes{};           // texts, the format's own included ("compression")
	bool unassociated = false;    // the fourth channel is not multiplied into the others
	std::vector<ImageMatrix> matrices{};

	int channelCount() const
	{
		return channels.empty() ? count : static_cast<int>(channels.size());
	}
};

// Each of them only in a child process (core/isolate.h). Throw Error.
struct ImageCodec
{
	std::vector<unsigned char> (*encode)(const ImageToEncode& image);
	Image (*decode)(std::string_view bytes, const std::string& name);
	AlphaImage (*decode_alpha)(std::string_view bytes, const std::string& name, bool else_first);
};

inline constexpr const char* kImageCodecName = "nook_image_codec"; // of the module's `const ImageCodec*()` with C linkage

} // namespace nook
