// SPDX-License-Identifier: GPL-3.0-or-later
// Between core/image.cpp and the workers that OpenImageIO and OpenEXR are linked to (core/image_worker.cpp, core/exr_worker.cpp):
// what is asked, and what comes back. OpenImageIO brings some 250 libraries, which take thirty times as long to load as everything
// else of nook: its worker starts with the first picture that is no OpenEXR of ours, and stays for the next.
#pragma once

#include "core/image.h"
#include "core/value_stream.h"

#include <cstddef>
#include <string>
#include <vector>

namespace nook
{

inline constexpr const char* kImageWorker = "nook_image_worker";
inline constexpr const char* kExrWorker = "nook_exr_worker";
inline constexpr const char* kEncode = "encode";              // ImageToEncode and its pixels → bytes of a file
inline constexpr const char* kDecode = "decode";              // a name (not of kExrWorker) and bytes of a file → Image
inline constexpr const char* kDecodeAlphas = "decode alphas"; // a number of EncodedAlpha → an AlphaImage of each

inline constexpr std::size_t kMostNames = 10000; // OpenImageIO takes time by the square of their number

enum class PixelType
{
	uint8,   // PNG
	uint16,  // PNG
	float32, // OpenEXR
};

struct ImageToEncode
{
	int width_px = 0;
	int height_px = 0;
	PixelType type = PixelType::float32;
	std::vector<std::string> channels{}; // names; count where empty
	int count = 0;                       // of channels
	Notes attributes{};                  // texts, the format's own included ("compression")
	bool unassociated = false;           // the fourth channel is not multiplied into the others
	std::vector<ImageMatrix> matrices{};

	int channelCount() const
	{
		return channels.empty() ? count : static_cast<int>(channels.size());
	}
	// Of the pixels, which follow: rows from the top.
	std::size_t bytes() const
	{
		return (type == PixelType::uint8    ? 1U
				: type == PixelType::uint16 ? 2U
											: 4U) *
			   static_cast<std::size_t>(channelCount()) * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
	}
};

void send(const ImageToEncode& image, ValueWriter& to);
void send(const Image& image, ValueWriter& to);
void send(const EncodedAlpha& mask, ValueWriter& to);
void send(const AlphaImage& image, ValueWriter& to);

void receive(ImageToEncode& image, ValueReader& from);
void receive(Image& image, ValueReader& from);
void receive(EncodedAlpha& mask, ValueReader& from);
void receive(AlphaImage& image, ValueReader& from);

} // namespace nook
