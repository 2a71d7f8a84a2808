// SPDX-License-Identifier: GPL-3.0-or-later
// Between core/image.cpp and the workers that OpenImageIO, OpenEXR and libpng are linked to (core/image_worker.cpp,
// core/exr_worker.cpp, core/png_worker.cpp): what is asked, and what comes back. OpenImageIO brings some 250 libraries, which take
// thirty times as long to load as everything else of nook: its worker starts with the first picture that the others leave to it,
// and stays for the next.
#pragma once

#include "core/image.h"
#include "core/value_stream.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

inline constexpr const char* kImageWorker = "nook_image_worker";
inline constexpr const char* kExrWorker = "nook_exr_worker";
inline constexpr const char* kPngWorker = "nook_png_worker";
inline constexpr const char* kEncode = "encode"; // ImageToEncode and its pixels → bytes of a file; kExrWorker alone
// A name (for kImageWorker) and bytes of a file → Image. The other two say before it whether they take the file.
inline constexpr const char* kDecode = "decode";
// An AlphaRequest → of each picture, whether it takes the file (kImageWorker: all), and an AlphaImage.
inline constexpr const char* kDecodeAlphas = "decode alphas";

inline constexpr std::size_t kMostNames = 10000; // OpenImageIO takes time by the square of their number

// An OpenEXR of 32-bit floats.
struct ImageToEncode
{
	int width_px = 0;
	int height_px = 0;
	std::vector<std::string> channels{}; // names
	Notes attributes{};                  // texts, the format's own included ("compression")
	std::vector<ImageMatrix> matrices{};

	// Of the pixels, which follow: rows from the top.
	std::size_t bytes() const
	{
		return sizeof(float) * channels.size() * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
	}
};

void send(const ImageToEncode& image, ValueWriter& to);
void send(const Image& image, ValueWriter& to);
void send(const EncodedAlpha& mask, ValueWriter& to);
void send(const AlphaImage& image, ValueWriter& to);

// Whether a worker takes a file, and what it is then.
template <class T> void send(const std::optional<T>& taken, ValueWriter& to)
{
	to.value(taken.has_value());
	if (taken)
	{
		send(*taken, to);
	}
}

// What kDecodeAlphas asks. Sent it is the limit, the number of pictures, and each of these.
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

} // namespace nook
