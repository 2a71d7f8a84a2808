// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image.h"

#include "core/error.h"
#include "core/file.h"
#include "core/image_codec.h"
#include "core/isolate.h"
#include "core/lists.h"
#include "core/system.h"

#include <cassert>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>

#include <png.h>

namespace nook
{
namespace
{

constexpr std::size_t kTables = std::size_t{256} << 20U; // memory a decoder may use in addition to the picture
constexpr int kTime_s = 30; // per picture, plus one per half megabyte: a tenth of the slowest rate measured
constexpr std::size_t kBytesPerSecond = 500000;
constexpr std::size_t kMostReadingMemory = std::size_t{6} << 30U; // kMaxImageValues floats, three times

// Masks are not decoded as floats of all channels, so this suffices for the largest one.
constexpr std::size_t kAlphaMemory = std::size_t{1} << 30U;
constexpr std::size_t kMaxTexelsInAll = 4; // in multiples of the limit for one picture
constexpr std::size_t kTexelsPerByte = 64; // above any painted mask; a procedural one may reach a thousand
// Processor time: far above what small pictures need, and a tenth of the slowest rate measured (PNG).
constexpr int kAlphaTime_s = 60;
constexpr std::size_t kAlphaBytesPerSecond = 200000;

Isolated ask(const char* worker, const char* function)
{
	return {worker, function, true};
}

std::size_t valuesOf(int width_px, int height_px, int channels)
{
	return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * static_cast<std::size_t>(channels);
}

std::size_t storedBytes(const std::vector<EncodedAlpha>& pictures)
{
	const auto bytesOf = [](const EncodedAlpha& picture)
	{
		std::error_code failed;
		const std::uintmax_t size =
			picture.path.empty() ? picture.bytes.size() : std::filesystem::file_size(nativePath(picture.path), failed);
		return failed ? 0 : static_cast<std::size_t>(size);
	};
	return sumOver(pictures, bytesOf);
}

// For a file that the worker that is to read it declines, or that a missing OpenImageIO would read.
[[noreturn]] void refuseDeclined(const std::string& name, const std::string& defect)
{
	refuseInputIf(!defect.empty(), name, oneLine(defect), "an image that can be read");
	refuseInput(name, "a picture that only OpenImageIO reads, and none of the version that nook was built with",
				"PNG, JPEG, TGA, BMP, EXR or uncompressed KTX2", ExitCode::unsupported);
}

// Writes nook's pictures as PNG with libpng, byte for byte what OpenImageIO 2.4 writes. Needs no worker because it reads no file.

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
	append(all, notes);
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
	refuseIf(!written, std::string("image: ") + (writer.problem[0] == '\0' ? "libpng does not start" : writer.problem.data()),
			 ExitCode::runtime);
	return std::move(writer.bytes);
}

} // namespace

Image decodeImage(std::string_view bytes, const std::string& name)
{
	// Deflate expands at most 1032 times, and each byte becomes a 4-byte float.
	const IsolationLimits limits{std::min(kTables + 4200 * bytes.size(), kMostReadingMemory),
								 kTime_s + static_cast<int>(bytes.size() / kBytesPerSecond)};
	Decoded<Image> decoded;
	for (const char* const worker : {kPictureWorker, kImageWorker})
	{
		if (worker == kImageWorker && !hasWorker(worker))
		{
			break;
		}
		isolate(
			ask(worker, kDecode), name, limits,
			[&](ValueWriter& to)
			{
				to.text(name);
				to.values(bytes);
			},
			[&](ValueReader& from) { receive(decoded, from); });
		if (decoded.image)
		{
			return std::move(*decoded.image);
		}
	}
	refuseDeclined(name, decoded.defect);
}

std::vector<AlphaImage> decodeAlphas(const std::vector<EncodedAlpha>& pictures, const std::string& all, std::size_t max_texels)
{
	const std::size_t stored = storedBytes(pictures);
	const std::size_t most_in_all = std::min(kMaxTexelsInAll * max_texels, max_texels + kTexelsPerByte * stored);
	const IsolationLimits limits{std::max(kAlphaMemory, 4 * max_texels) + stored,
								 kAlphaTime_s + static_cast<int>(stored / kAlphaBytesPerSecond)};
	std::vector<Decoded<AlphaImage>> decoded(pictures.size());
	std::size_t texels = 0; // of those that are decoded, with their copies
	for (const char* const worker : {kPictureWorker, kImageWorker})
	{
		const std::vector<std::size_t> asked = indicesWhere(pictures.size(), [&](std::size_t i) { return !decoded[i].image; });
		if (asked.empty() || (worker == kImageWorker && !hasWorker(worker)))
		{
			break;
		}
		const std::size_t before = texels;
		std::string name = pictures[asked.front()].name; // of the picture being decoded
		const auto send_all = [&](ValueWriter& to)
		{
			to.value(max_texels);
			to.value(asked.size());
			for (const std::size_t i : asked)
			{
				send(pictures[i], to);
			}
		};
		const auto take = [&](ValueReader& from)
		{
			texels = before;
			for (const std::size_t i : asked)
			{
				name = pictures[i].name;
				receive(decoded[i], from);
				texels += decoded[i].image ? pictures[i].uses * decoded[i].image->alpha.size() : 0;
				refuseInputIf(texels > most_in_all, all, "masks of more than " + std::to_string(most_in_all) + " texels in all",
							  "fewer or smaller ones (max-texels)");
			}
		};
		isolate(ask(worker, kDecodeAlphas), name, limits, send_all, take);
	}
	std::vector<AlphaImage> images;
	for (Decoded<AlphaImage>& one : decoded)
	{
		if (!one.image)
		{
			refuseDeclined(pictures[images.size()].name, one.defect);
		}
		images.push_back(std::move(*one.image));
	}
	return images;
}

Image readImage(const std::string& path)
{
	return decodeImage(readFile(path), path); // throws with the system's reason
}

// Runs without limits, since the picture is our own.
std::string exrBytes(Image image, const char* compression)
{
	assert(image.values.size() == valuesOf(image.width_px, image.height_px, static_cast<int>(image.channels.size())));
	image.notes.insert(image.notes.begin(), {{"compression", compression}, {"capDate", ""}});
	std::string bytes;
	isolate(
		ask(kPictureWorker, kEncode), "image", std::nullopt, [&](ValueWriter& to) { send(image, to); },
		[&](ValueReader& from)
		{
			bytes.clear();
			from.values(bytes, kTables + 4 * sizeof(float) * image.values.size());
		});
	return bytes;
}

std::string pngBytes(int width_px, int height_px, std::span<const uint8_t> values, const Notes& notes)
{
	const int channels = values.size() == valuesOf(width_px, height_px, 4) ? 4 : 3;
	assert(values.size() == valuesOf(width_px, height_px, channels));
	return fileOf({width_px, height_px, channels, 8, values.data()}, "sRGB", notes);
}

std::string alphaPngBytes(int width_px, int height_px, std::span<const uint8_t> alpha)
{
	assert(alpha.size() == valuesOf(width_px, height_px, 1));
	std::vector<uint8_t> rgba(4 * alpha.size(), 255);
	for (std::size_t i = 0; i < alpha.size(); ++i)
	{
		rgba[4 * i + 3] = alpha[i];
	}
	return pngBytes(width_px, height_px, std::span<const uint8_t>(rgba), {});
}

std::string pngBytes(int width_px, int height_px, std::span<const uint16_t> rgba, const Notes& notes)
{
	assert(rgba.size() == valuesOf(width_px, height_px, 4));
	return fileOf({width_px, height_px, 4, 16, reinterpret_cast<const png_byte*>(rgba.data())}, "Linear", notes);
}

} // namespace nook
