// SPDX-License-Identifier: GPL-3.0-or-later
// Writes nook's pictures as PNG with libpng, byte for byte what OpenImageIO 2.4 writes. Needs no worker because it reads no file.
#include "core/error.h"
#include "core/image.h"

#include <png.h>

#include <array>
#include <cassert>
#include <csetjmp>
#include <cstdio>
#include <exception>

namespace nook
{
namespace
{

struct PngPicture
{
	int width_px = 0;
	int height_px = 0;
	int channels = 3; // 3: RGB, 4: RGBA
	int bits = 8;     // per value
	const png_byte* rows = nullptr;
};

struct PngWriter
{
	std::string bytes;
	std::array<char, 200> problem{};
};

[[noreturn]] void onError(png_structp png, png_const_charp message)
{
	std::array<char, 200>& problem = static_cast<PngWriter*>(png_get_error_ptr(png))->problem;
	std::snprintf(problem.data(), problem.size(), "%s", message);
	png_longjmp(png, 1);
}

void onWarning(png_structp /*png*/, png_const_charp /*message*/) {}

void onBytes(png_structp png, png_bytep bytes, std::size_t count)
{
	bool taken = false;
	try
	{
		static_cast<PngWriter*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<const char*>(bytes), count);
		taken = true;
	}
	catch (const std::exception&) // exceptions must not cross libpng
	{
	}
	if (!taken)
	{
		png_error(png, "out of memory");
	}
}

void onFlush(png_structp /*png*/) {}

// Returns false if libpng jumped back. Nothing here may have a destructor.
bool write(png_structp png, png_infop info, const PngPicture& picture, std::span<const png_text> texts)
{
	if (setjmp(png_jmpbuf(png)) != 0)
	{
		return false;
	}
	png_set_compression_level(png, 6);
	png_set_compression_strategy(png, 0); // plain deflate, also for filtered lines
	png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width_px), static_cast<png_uint_32>(picture.height_px), picture.bits,
				 picture.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
				 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
	if (picture.bits == 8)
	{
		png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
	}
	else
	{
		png_set_gAMA(png, info, 1.0);
	}
	png_set_oFFs(png, info, 0, 0, PNG_OFFSET_PIXEL);
	png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
	png_write_info(png, info);
	if (picture.bits == 16)
	{
		png_set_swap(png); // values here are little-endian
	}
	const std::size_t row =
		static_cast<std::size_t>(picture.width_px) * static_cast<std::size_t>(picture.channels * picture.bits / 8);
	for (int y = 0; y < picture.height_px; ++y)
	{
		png_write_row(png, picture.rows + row * static_cast<std::size_t>(y));
	}
	png_write_end(png, info);
	return true;
}

// Notes follow `colours`, the colour space in OpenImageIO's words.
std::string fileOf(const PngPicture& picture, const char* colours, const Notes& notes)
{
	Notes all{{"oiio:ColorSpace", colours}};
	all.insert(all.end(), notes.begin(), notes.end());
	std::vector<png_text> texts;
	for (Note& note : all)
	{
		png_text& text = texts.emplace_back();
		text.compression = PNG_TEXT_COMPRESSION_NONE;
		text.key = note.key.data();
		text.text = note.value.data();
		text.text_length = note.value.size();
	}
	PngWriter writer;
	png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, onError, onWarning);
	png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
	if (info != nullptr)
	{
		png_set_write_fn(png, &writer, onBytes, onFlush);
	}
	const bool written = info != nullptr && write(png, info, picture, texts);
	png_destroy_write_struct(&png, &info);
	if (!written)
	{
		throw Error(ExitCode::runtime,
					std::string("image: ") + (writer.problem[0] == '\0' ? "libpng does not start" : writer.problem.data()));
	}
	return std::move(writer.bytes);
}

[[maybe_unused]] std::size_t valuesOfPng(int width_px, int height_px, int channels)
{
	return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * static_cast<std::size_t>(channels);
}

} // namespace

std::string pngBytes(int width_px, int height_px, std::span<const uint8_t> rgb, const Notes& notes)
{
	assert(rgb.size() == valuesOfPng(width_px, height_px, 3));
	return fileOf({width_px, height_px, 3, 8, rgb.data()}, "sRGB", notes);
}

std::string alphaPngBytes(int width_px, int height_px, std::span<const uint8_t> alpha)
{
	assert(alpha.size() == valuesOfPng(width_px, height_px, 1));
	std::vector<uint8_t> rgba(4 * alpha.size(), 255);
	for (std::size_t i = 0; i < alpha.size(); ++i)
	{
		rgba[4 * i + 3] = alpha[i];
	}
	return fileOf({width_px, height_px, 4, 8, rgba.data()}, "sRGB", {});
}

std::string pngBytes(int width_px, int height_px, std::span<const uint16_t> rgba, const Notes& notes)
{
	assert(rgba.size() == valuesOfPng(width_px, height_px, 4));
	return fileOf({width_px, height_px, 4, 16, reinterpret_cast<const png_byte*>(rgba.data())}, "Linear", notes);
}

} // namespace nook
