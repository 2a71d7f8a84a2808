// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and writes image files (OpenImageIO, OpenEXR, libpng). Output is deterministic: no dates or paths. Decoding, and OpenEXR
// encoding, run in workers with limits (core/isolate.h), because the libraries print, start threads, crash or ask for gigabytes.
// PNG files are written in this process.
#pragma once

#include "core/text.h"
#include "core/words.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// A 4×4 matrix of an EXR header, column-major for column vectors (the same 16 numbers as Imath's row vectors).
struct ImageMatrix
{
	std::string key;
	std::array<double, 16> values{};
	bool wide = false; // stored as 64 bits, else 32
};

// Channels of 32-bit floats.
struct Image
{
	int width_px = 0;
	int height_px = 0;
	std::vector<std::string> channels; // channel names
	std::vector<float> values;         // interleaved, rows from the top
	Notes notes;
	std::vector<ImageMatrix> matrices;
	bool cropped = false;          // the file's data and display windows differ (EXR)
	std::vector<uint8_t> halves{}; // when read: 1 for channels stored as 16-bit floats; else empty

	// Index of a channel, or −1.
	int channel(std::string_view name) const
	{
		const auto found = std::find(channels.begin(), channels.end(), name);
		return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
	}
	// Matrix with that key, or null. OpenImageIO versions spell worldToCamera differently.
	const ImageMatrix* matrix(std::string_view key) const
	{
		const auto found =
			std::find_if(matrices.begin(), matrices.end(), [key](const auto& m) { return lowered(m.key) == lowered(key); });
		return found == matrices.end() ? nullptr : &*found;
	}
	float at(std::size_t pixel, int channel_index) const
	{
		return values[pixel * channels.size() + static_cast<std::size_t>(channel_index)];
	}
};

inline constexpr std::size_t kMaxImageValues = std::size_t{1} << 29U; // pixels × channels; more is a mistake or an attack

inline constexpr std::size_t kMaxTexels = std::size_t{1} << 28U; // per picture: 16384 x 16384, which can compress to a megabyte
inline constexpr std::uint64_t kMostTexels = std::uint64_t{1} << 32U; // upper bound of that limit for any caller

// Reads any format that OpenImageIO reads; integers are scaled to 0…1. Takes the first part and level of multi-part files. Throws
// Error: file if it cannot be opened, invalid_input if it is not a whole image.
Image readImage(const std::string& path);

// Decodes from memory; `name` appears in errors, and its extension picks the format tried first.
Image decodeImage(std::string_view bytes, const std::string& name);

// Opacity of each pixel of a picture.
struct AlphaImage
{
	int width_px = 0;
	int height_px = 0;
	std::vector<uint8_t> alpha; // rows from the top; 255 is opaque
};

// The channel that holds opacity. In a greyscale picture, red, green and blue are equal.
enum class MaskChannel : uint8_t
{
	alpha,          // opaque if absent
	alpha_or_first, // first channel if absent
	red,
	green,
	blue,
	luminance, // ITU-R BT.709 applied to the stored values
};

struct EncodedAlpha
{
	std::string name;  // for errors; its extension picks the format tried first
	std::string path;  // file to read; empty: use `bytes`
	std::string bytes; // a file embedded in another
	MaskChannel channel = MaskChannel::alpha;
	std::size_t uses = 1; // number of copies made of it, for the limit
};

// Decodes 8-bit opacity, in order. Throws as decodeImage; throws an Error naming `all`, their container, if together they exceed
// `max_texels` and what their file sizes justify. Batched because a call costs more than a small picture.
std::vector<AlphaImage> decodeAlphas(const std::vector<EncodedAlpha>& pictures, const std::string& all,
									 std::size_t max_texels = kMaxTexels);

// 32-bit floats, scan lines, with that compression: zip or none.
std::string exrBytes(Image image, const char* compression = "zip");

// 8-bit sRGB, or sRGB and opacity: 3 or 4 bytes per pixel, rows from the top.
std::string pngBytes(int width_px, int height_px, std::span<const uint8_t> values, const Notes& notes);

// White with the given alpha: one byte per pixel.
std::string alphaPngBytes(int width_px, int height_px, std::span<const uint8_t> alpha);

// 16-bit data, not colour: 4 values per pixel; the fourth is not opacity and nothing is premultiplied.
std::string pngBytes(int width_px, int height_px, std::span<const uint16_t> rgba, const Notes& notes);

} // namespace nook
