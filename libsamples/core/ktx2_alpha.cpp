// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Khronos Group, "KTX File Format Specification", version 2.0, sections 3.1 to 3.9.
#include "core/image_codec.h"

#include "core/error.h"

#include <algorithm>
#include <array>

namespace nook
{
namespace
{

constexpr std::string_view kIdentifier("\xABKTX 20\xBB\r\n\x1A\n", 12);
constexpr std::size_t kHeader = 80; // bytes before the level index
constexpr std::size_t kLevel = 24;  // bytes per level in the index

// Vulkan formats with 8-bit channels.
struct PlainFormat
{
	uint32_t code;
	std::size_t channels;
};
constexpr std::array<PlainFormat, 12> kPlainFormats{{{9, 1},
													 {15, 1}, // R8_UNORM, _SRGB
													 {16, 2},
													 {22, 2}, // R8G8
													 {23, 3},
													 {29, 3}, // R8G8B8
													 {30, 3},
													 {36, 3}, // B8G8R8
													 {37, 4},
													 {43, 4}, // R8G8B8A8
													 {44, 4},
													 {50, 4}}}; // B8G8R8A8

[[noreturn]] void refuse(const std::string& name, const std::string& found, const std::string& expected)
{
	throw Error(ExitCode::invalid_input, name + ": KTX2: found " + found + ", expected " + expected);
}

std::string schemeName(uint64_t scheme, uint64_t format)
{
	constexpr std::array<std::string_view, 4> kSchemes{"", "BasisLZ", "Zstandard", "ZLIB"};
	if (scheme > 0)
	{
		return "texels compressed by " +
			   (scheme < kSchemes.size() ? std::string(kSchemes[scheme]) : "scheme " + std::to_string(scheme));
	}
	return format == 0 ? "texels of UASTC or another codec" : "texels of Vulkan's format " + std::to_string(format);
}

std::size_t channelsOf(std::string_view bytes, const std::string& name)
{
	const uint64_t format = littleEndian(bytes, 12, 4);
	const uint64_t scheme = littleEndian(bytes, 44, 4);
	const auto* const plain =
		std::find_if(kPlainFormats.begin(), kPlainFormats.end(), [&](const PlainFormat& known) { return known.code == format; });
	if (scheme != 0 || plain == kPlainFormats.end())
	{
		throw Error(ExitCode::unsupported,
					name + ": KTX2: found " + schemeName(scheme, format) +
						", expected uncompressed ones, as `ktx transcode --target rgba8 IN.ktx2 OUT.ktx2` makes them");
	}
	return plain->channels;
}

} // namespace

bool isKtx2(std::string_view bytes)
{
	return bytes.starts_with(kIdentifier);
}

Decoded<AlphaImage> alphaOfKtx2(std::string_view bytes, const EncodedAlpha& picture, std::size_t max_texels)
{
	const std::string& name = picture.name;
	if (bytes.size() < kHeader + kLevel)
	{
		refuse(name, std::to_string(bytes.size()) + " bytes", "at least " + std::to_string(kHeader + kLevel));
	}
	const std::size_t channels = channelsOf(bytes, name);
	const uint64_t width = littleEndian(bytes, 20, 4);
	const uint64_t height = littleEndian(bytes, 24, 4);
	const uint64_t depth = littleEndian(bytes, 28, 4);
	const uint64_t layers = littleEndian(bytes, 32, 4);
	const uint64_t faces = littleEndian(bytes, 36, 4);
	if (width < 1 || height < 1 || depth > 0 || layers > 1 || faces != 1)
	{
		refuse(name,
			   std::to_string(width) + "x" + std::to_string(height) + " texels, depth " + std::to_string(depth) + ", " +
				   std::to_string(layers) + " layers, " + std::to_string(faces) + " faces",
			   "one picture");
	}
	if (height > max_texels / width || std::max(width, height) > INT32_MAX)
	{
		throw Error(ExitCode::invalid_input, name + ": found " + std::to_string(width) + "x" + std::to_string(height) +
												 " texels, expected at most " + std::to_string(max_texels) + " (max-texels)");
	}
	const uint64_t offset = littleEndian(bytes, kHeader, 8);
	const uint64_t length = littleEndian(bytes, kHeader + 8, 8);
	const uint64_t texels = width * height;
	if (length < texels * channels || offset > bytes.size() || length > bytes.size() - offset)
	{
		refuse(name,
			   "a level of " + std::to_string(length) + " bytes from byte " + std::to_string(offset) + " of " +
				   std::to_string(bytes.size()),
			   std::to_string(texels * channels) + " bytes of it");
	}
	const uint64_t format = littleEndian(bytes, 12, 4);
	const bool blue_first = format == 30 || format == 36 || format == 44 || format == 50; // B8G8R8 and B8G8R8A8
	const auto* texel = reinterpret_cast<const uint8_t*>(bytes.data() + offset);
	const auto readRow = [&](ChannelPlace place, std::vector<uint8_t>& values)
	{
		for (auto value = values.begin(); value != values.end(); texel += channels)
		{
			for (int channel = place.first; channel < place.first + place.count; ++channel)
			{
				*value++ = texel[blue_first && channel < 3 ? 2 - channel : channel];
			}
		}
		return true;
	};
	const int count = static_cast<int>(channels);
	return {
		readAlpha({static_cast<int>(width), static_cast<int>(height), count, count == 4 ? 3 : -1}, picture, max_texels, readRow),
		{}};
}

} // namespace nook
