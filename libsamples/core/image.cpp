// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image.h"

#include "core/error.h"
#include "core/file.h"
#include "core/image_codec.h"
#include "core/isolate.h"

#include <dlfcn.h>

#include <algorithm>
#include <cassert>
#include <functional>

namespace nook
{
namespace
{

constexpr std::size_t kTables = std::size_t{256} << 20U; // what a picture may take beside what its size calls for
constexpr int kTime_s = 300;

// The module, loaded with the first call. Loading starts no thread; what it offers runs in child processes only.
const ImageCodec& codec()
{
	static const ImageCodec* const loaded = []
	{
		void* const module = dlopen(NOOK_IMAGE_MODULE, RTLD_LAZY | RTLD_LOCAL); // beside the program, or where it was built
		void* const symbol = module == nullptr ? nullptr : dlsym(module, kImageCodecName);
		if (symbol == nullptr)
		{
			throw Error(ExitCode::file, std::string(dlerror()) + ": expected the part of nook that reads and writes pictures");
		}
		return reinterpret_cast<const ImageCodec* (*)()>(symbol)(); // NOLINT: what dlsym is for
	}();
	return *loaded;
}

std::size_t pixelBytes(PixelType type)
{
	return type == PixelType::uint8 ? 1 : type == PixelType::uint16 ? 2 : 4;
}

std::string encoded(ImageToEncode image, const Notes& notes)
{
	image.attributes.insert(image.attributes.end(), notes.begin(), notes.end());
	const ImageCodec& encoder = codec();
	const auto work = [&](IsolatedWriter& to)
	{
		to.values(encoder.encode(image));
	};
	const std::size_t most = kTables + 4 * pixelBytes(image.type) * static_cast<std::size_t>(image.channelCount()) *
										   static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
	std::string bytes;
	isolate("image", {most, kTime_s}, work,
			[&](IsolatedReader& from)
			{
				std::vector<unsigned char> values;
				from.values(values, most);
				bytes.assign(values.begin(), values.end());
			});
	return bytes;
}

[[maybe_unused]] std::size_t valuesOf(int width_px, int height_px, int channels)
{
	return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * static_cast<std::size_t>(channels);
}

constexpr std::size_t kMostReadingMemory = std::size_t{6} << 30U; // kMaxImageValues as floats, three times over
constexpr std::size_t kMostNames = 100000;

void send(const Image& image, IsolatedWriter& to)
{
	to.value(image.width_px);
	to.value(image.height_px);
	to.value(image.cropped);
	to.value(image.channels.size());
	for (const std::string& channel : image.channels)
	{
		to.text(channel);
	}
	to.values(image.halves);
	to.values(image.values);
	to.value(image.notes.size());
	for (const Note& note : image.notes)
	{
		to.text(note.key);
		to.text(note.value);
	}
	to.value(image.matrices.size());
	for (const ImageMatrix& matrix : image.matrices)
	{
		to.text(matrix.key);
		to.value(matrix.values);
		to.value(matrix.wide);
	}
}

Image received(IsolatedReader& from)
{
	const auto count = [&from]
	{
		const auto number = from.value<std::size_t>();
		if (number > kMostNames)
		{
			throw IsolatedReader::Ended{};
		}
		return number;
	};
	Image image;
	image.width_px = from.value<int>();
	image.height_px = from.value<int>();
	image.cropped = from.value<bool>();
	image.channels.resize(count());
	for (std::string& channel : image.channels)
	{
		channel = from.text();
	}
	from.values(image.halves, kMostNames);
	from.values(image.values, kMaxImageValues);
	image.notes.resize(count());
	for (Note& note : image.notes)
	{
		note.key = from.text();
		note.value = from.text();
	}
	image.matrices.resize(count());
	for (ImageMatrix& matrix : image.matrices)
	{
		matrix.key = from.text();
		matrix.values = from.value<std::array<double, 16>>();
		matrix.wide = from.value<bool>();
	}
	return image;
}

// Versions of OpenImageIO differ in how they spell worldToCamera.
bool sameKey(std::string_view a, std::string_view b)
{
	const auto lower = [](char c)
	{
		return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
	};
	return std::equal(a.begin(), a.end(), b.begin(), b.end(), [lower](char x, char y) { return lower(x) == lower(y); });
}

} // namespace

int Image::channel(std::string_view name) const
{
	const auto found = std::find(channels.begin(), channels.end(), name);
	return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

const ImageMatrix* Image::matrix(std::string_view key) const
{
	const auto found = std::find_if(matrices.begin(), matrices.end(), [key](const ImageMatrix& m) { return sameKey(m.key, key); });
	return found == matrices.end() ? nullptr : &*found;
}

void loadImageCodec()
{
	codec();
}

Image decodeImage(std::string_view bytes, const std::string& name)
{
	Image image;
	// Deflate makes at most 1032 bytes of one, and a byte becomes a float of four.
	const IsolationLimits limits{std::min(kTables + 4200 * bytes.size(), kMostReadingMemory), kTime_s};
	const ImageCodec& decoder = codec();
	const auto work = [&](IsolatedWriter& to)
	{
		send(decoder.decode(bytes, name), to);
	};
	isolate(name, limits, work, [&](IsolatedReader& from) { image = received(from); });
	return image;
}

AlphaImage decodeAlpha(std::string_view bytes, const std::string& name, bool else_first)
{
	return codec().decode_alpha(bytes, name, else_first);
}

Image readImage(const std::string& path)
{
	return decodeImage(readFile(path), path); // the system's reason where it cannot be opened
}

std::string exrBytes(const Image& image)
{
	assert(image.values.size() == valuesOf(image.width_px, image.height_px, static_cast<int>(image.channels.size())));
	ImageToEncode exr{.ending = "nook.exr", .width_px = image.width_px, .height_px = image.height_px};
	exr.channels = image.channels;
	exr.z_channel = image.channel("Z");
	exr.pixels = image.values.data();
	exr.attributes = {{"compression", "zip"}, {"oiio:ColorSpace", "Linear"}, {"DateTime", ""}}; // else it writes the time of day
	exr.matrices = image.matrices;
	return encoded(std::move(exr), image.notes);
}

std::string pngBytes(int width_px, int height_px, std::span<const uint8_t> rgb, const Notes& notes)
{
	assert(rgb.size() == valuesOf(width_px, height_px, 3));
	ImageToEncode png{.ending = "nook.png", .width_px = width_px, .height_px = height_px, .type = PixelType::uint8};
	png.count = 3;
	png.pixels = rgb.data();
	png.attributes = {{"oiio:ColorSpace", "sRGB"}};
	return encoded(std::move(png), notes);
}

std::string alphaPngBytes(int width_px, int height_px, std::span<const uint8_t> alpha)
{
	assert(alpha.size() == valuesOf(width_px, height_px, 1));
	std::vector<uint8_t> rgba(4 * alpha.size(), 255);
	for (std::size_t i = 0; i < alpha.size(); ++i)
	{
		rgba[4 * i + 3] = alpha[i];
	}
	ImageToEncode png{.ending = "nook.png", .width_px = width_px, .height_px = height_px, .type = PixelType::uint8};
	png.count = 4;
	png.pixels = rgba.data();
	png.attributes = {{"oiio:ColorSpace", "sRGB"}};
	png.unassociated = true;
	return encoded(std::move(png), {});
}

std::string pngBytes(int width_px, int height_px, std::span<const uint16_t> rgba, const Notes& notes)
{
	assert(rgba.size() == valuesOf(width_px, height_px, 4));
	ImageToEncode png{.ending = "nook.png", .width_px = width_px, .height_px = height_px, .type = PixelType::uint16};
	png.count = 4;
	png.pixels = rgba.data();
	png.attributes = {{"oiio:ColorSpace", "Linear"}};
	png.unassociated = true;
	return encoded(std::move(png), notes);
}

std::string exrBytes(int width_px, int height_px, std::span<const float> rgba, const Notes& notes)
{
	assert(rgba.size() == valuesOf(width_px, height_px, 4));
	ImageToEncode exr{.ending = "nook.exr", .width_px = width_px, .height_px = height_px};
	exr.count = 4;
	exr.pixels = rgba.data();
	exr.attributes = {{"compression", "none"}, {"oiio:ColorSpace", "Linear"}, {"DateTime", ""}};
	return encoded(std::move(exr), notes);
}

} // namespace nook
