// SPDX-License-Identifier: GPL-3.0-or-later
// Image files in and out (OpenImageIO, OpenEXR, libpng); the same input gives the same bytes, without a date or a path in them.
// What reads runs in workers, with limits (core/isolate.h), and so does what writes OpenEXR: it prints, starts threads, and may
// crash or ask for gigabytes. PNG files are written here.
#pragma once

#include "core/notes.h"

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
	bool wide = false; // 64 bits in the file, else 32
};

// Channels of 32-bit floats.
struct Image
{
	int width_px = 0;
	int height_px = 0;
	std::vector<std::string> channels; // names
	std::vector<float> values;         // channels of a pixel side by side, rows from the top
	Notes notes;
	std::vector<ImageMatrix> matrices;
	bool cropped = false; // read from a file that holds only a part of its picture, or more (EXR: data and display window differ)
	std::vector<uint8_t> halves{}; // read from a file: 1 for channels that it holds as 16-bit floats; else empty

	// Index of a channel, or −1.
	int channel(std::string_view name) const;
	// Matrix of that key, in any case, or null.
	const ImageMatrix* matrix(std::string_view key) const;
	float at(std::size_t pixel, int channel_index) const
	{
		return values[pixel * channels.size() + static_cast<std::size_t>(channel_index)];
	}
};

inline constexpr std::size_t kMaxImageValues = std::size_t{1} << 29U; // pixels × channels; more is a mistake or an attack

inline constexpr std::size_t kMaxTexels = std::size_t{1} << 28U;      // of one picture: 16384 x 16384, which a megabyte can hold
inline constexpr std::uint64_t kMostTexels = std::uint64_t{1} << 32U; // that anybody may ask for

// Any format that OpenImageIO reads; integers become 0 to 1. The first part and level of files that have several.
// Throws Error: file where it cannot be opened, invalid_input where it is not a whole image.
Image readImage(const std::string& path);

// The same from memory; `name` says what it is in errors, its ending picks the format first tried.
Image decodeImage(std::string_view bytes, const std::string& name);

// How opaque each pixel of a picture is, and nothing else of it.
struct AlphaImage
{
	int width_px = 0;
	int height_px = 0;
	std::vector<uint8_t> alpha; // rows from the top; 255 is opaque
};

// The channel that says it. A picture of one colour has it as red, green and blue.
enum class MaskChannel : uint8_t
{
	alpha,          // opaque where there is none
	alpha_or_first, // the first channel where there is none
	red,
	green,
	blue,
	luminance, // ITU-R BT.709, of the numbers as they are stored
};

struct EncodedAlpha
{
	std::string name;  // for errors; its ending picks the format first tried
	std::string path;  // of its file; empty: `bytes` holds it
	std::string bytes; // of a file inside another
	MaskChannel channel = MaskChannel::alpha;
	std::size_t uses = 1; // copies that are made of it; they count
};

// The alpha channels at 8 bits, in order. Throws as decodeImage; an Error of `all`, what has these pictures, where they are larger
// than `max_texels` and what their files' size calls for together. One call for many: a small one takes less time than asking for
// it.
std::vector<AlphaImage> decodeAlphas(const std::vector<EncodedAlpha>& pictures, const std::string& all,
									 std::size_t max_texels = kMaxTexels);

// 32-bit floats, scan lines, zip compression.
std::string exrBytes(const Image& image);

// 8-bit sRGB; 3 bytes a pixel, rows from the top.
std::string pngBytes(int width_px, int height_px, std::span<const uint8_t> rgb, const Notes& notes);

// 8-bit; colour is white, alpha as given: one byte a pixel, rows from the top.
std::string alphaPngBytes(int width_px, int height_px, std::span<const uint8_t> alpha);

// 16-bit numbers, no colour: 4 a pixel, the fourth is not an opacity and nothing is multiplied by it.
std::string pngBytes(int width_px, int height_px, std::span<const uint16_t> rgba, const Notes& notes);

// 32-bit floats, 4 a pixel, uncompressed scan lines.
std::string exrBytes(int width_px, int height_px, std::span<const float> rgba, const Notes& notes);

} // namespace nook
