// SPDX-License-Identifier: GPL-3.0-or-later
// Protocol between core/image.cpp and the workers that link OpenImageIO, OpenEXR and libpng (core/image_worker.cpp,
// core/exr_worker.cpp, core/png_worker.cpp). OpenImageIO brings some 250 libraries, which take thirty times as long to load as the
// rest of nook, so its worker starts only for a picture that the others decline, and is then kept.
#pragma once

#include "core/image.h"
#include "core/value_stream.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr const char* kImageWorker = "nook_image_worker";
inline constexpr const char* kExrWorker = "nook_exr_worker";
inline constexpr const char* kPngWorker = "nook_png_worker";
inline constexpr const char* kEncode = "encode"; // ImageToEncode and its pixels → file bytes; kExrWorker only
// A name (for kImageWorker) and file bytes → Image. The other two workers first answer whether they accept the file.
inline constexpr const char* kDecode = "decode";
// AlphaRequest → for each picture, whether it is accepted (kImageWorker accepts all), and an AlphaImage.
inline constexpr const char* kDecodeAlphas = "decode alphas";

inline constexpr std::size_t kMostNames = 10000; // OpenImageIO takes quadratic time in their number

// Image to encode as OpenEXR with 32-bit floats.
struct ImageToEncode
{
	int width_px = 0;
	int height_px = 0;
	std::vector<std::string> channels{}; // channel names
	Notes attributes{};                  // including the format's own ("compression")
	std::vector<ImageMatrix> matrices{};

	// Size of the pixel data that follows: rows from the top.
	std::size_t bytes() const
	{
		return sizeof(float) * channels.size() * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
	}
};

void send(const ImageToEncode& image, ValueWriter& to);
void send(const Image& image, ValueWriter& to);
void send(const EncodedAlpha& mask, ValueWriter& to);
void send(const AlphaImage& image, ValueWriter& to);

// Sends whether the worker accepts the file, then the value.
template <class T> void send(const std::optional<T>& taken, ValueWriter& to)
{
	to.value(taken.has_value());
	if (taken)
	{
		send(*taken, to);
	}
}

// Request of kDecodeAlphas. Wire format: the limit, the number of pictures, then each picture.
struct AlphaRequest
{
	std::size_t max_texels = kMaxTexels;
	std::vector<EncodedAlpha> pictures;
};

void receive(AlphaRequest& request, ValueReader& from);
void receive(ImageToEncode& image, ValueReader& from);
void receive(Image& image, ValueReader& from);
void receive(EncodedAlpha& mask, ValueReader& from);
void receive(AlphaImage& image, ValueReader& from);

// Reads opacity from uncompressed KTX2 files, such as `ktx transcode --target rgba8` makes from Basis Universal.

// True if the bytes begin like a KTX2 file.
bool isKtx2(std::string_view bytes);

// Reads the largest level of a 2D texture with 8 bits per channel. `name` appears in errors. Throws Error: unsupported for
// compressed texels, naming the command that decompresses them; invalid_input if the file is truncated or has more than
// `max_texels`.
AlphaImage alphaOfKtx2(std::string_view bytes, const std::string& name, MaskChannel channel, std::size_t max_texels);

// Locates the opacity channel of a picture in a texel and reads it. Shared by the image workers.

// Channels [first, first + count) of a texel: one, or three for luminance; none if fully opaque.
struct ChannelPlace
{
	int first = 0;
	int count = 0;
};

// `colours` is the number of channels before alpha; `alpha` is its index, or -1.
inline ChannelPlace placeOf(MaskChannel channel, int colours, int alpha)
{
	const int colour = static_cast<int>(channel) - static_cast<int>(MaskChannel::red);
	switch (channel)
	{
	case MaskChannel::alpha: return {alpha, alpha >= 0 ? 1 : 0};
	case MaskChannel::alpha_or_first: return {alpha >= 0 ? alpha : 0, 1};
	case MaskChannel::luminance: return {0, colours >= 3 ? 3 : 1};
	case MaskChannel::red:
	case MaskChannel::green:
	case MaskChannel::blue: break;
	}
	return {colour < colours ? colour : 0, 1};
}

// `at` points to the first of these channels, 8 bits each. ITU-R BT.709 item 3.2.
inline uint8_t maskValue(const uint8_t* at, ChannelPlace place)
{
	return place.count < 3 ? at[0] : static_cast<uint8_t>((2126U * at[0] + 7152U * at[1] + 722U * at[2] + 5000U) / 10000U);
}

} // namespace nook
