// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image_codec.h"

#include "core/error.h"
#include "core/lists.h"

#include <array>

namespace nook
{
namespace
{

// `colours` is the number of channels before alpha; `alpha` is its index, or -1.
ChannelPlace placeOf(MaskChannel channel, int colours, int alpha)
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
uint8_t maskValue(const uint8_t* at, ChannelPlace place)
{
	return place.count < 3 ? at[0] : static_cast<uint8_t>((2126U * at[0] + 7152U * at[1] + 722U * at[2] + 5000U) / 10000U);
}

// This work is based on: Khronos Group, "KTX File Format Specification", version 2.0, sections 3.1 to 3.9.

constexpr std::string_view kIdentifier("\xABKTX 20\xBB\r\n\x1A\n", 12);
constexpr std::size_t kHeader = 80; // bytes before the level index
constexpr std::size_t kLevel = 24;  // bytes per level in the index

// Vulkan formats with 8-bit channels, _UNORM and _SRGB of each: R8, R8G8, R8G8B8, B8G8R8, R8G8B8A8, B8G8R8A8.
struct PlainFormat
{
	uint32_t code;
	std::size_t channels;
};
constexpr std::array<PlainFormat, 12> kPlainFormats{
	{{9, 1}, {15, 1}, {16, 2}, {22, 2}, {23, 3}, {29, 3}, {30, 3}, {36, 3}, {37, 4}, {43, 4}, {44, 4}, {50, 4}}};

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
	const auto* const plain = firstWhere(kPlainFormats, [&](const PlainFormat& known) { return known.code == format; });
	refuseInputIf(scheme != 0 || plain == nullptr, name + ": KTX2", schemeName(scheme, format),
				  "uncompressed ones, as `ktx transcode --target rgba8 IN.ktx2 OUT.ktx2` makes them", ExitCode::unsupported);
	return plain->channels;
}

} // namespace

void answerImage(ValueReader& from, ValueWriter& answer,
				 Decoded<Image> (*decode)(const std::string& bytes, const std::string& name))
{
	const std::string name = from.text();
	std::string bytes;
	from.values(bytes, kMaxFileBytes);
	send(decode(bytes, name), answer);
}

void answerAlphas(ValueReader& from, ValueWriter& answer,
				  Decoded<AlphaImage> (*decode)(std::string_view bytes, const EncodedAlpha& picture, std::size_t max_texels))
{
	const auto max_texels = from.value<std::size_t>();
	std::vector<EncodedAlpha> pictures(from.value<std::size_t>());
	for (EncodedAlpha& picture : pictures)
	{
		receive(picture, from);
	}
	for (const EncodedAlpha& picture : pictures)
	{
		const std::string read = picture.path.empty() ? std::string() : readFile(picture.path);
		send(decode(picture.path.empty() ? picture.bytes : read, picture, max_texels), answer);
	}
}

std::size_t checkedTexels(int width_px, int height_px, int channels, std::size_t most, const std::string& name, const char* option)
{
	const auto texels = static_cast<std::size_t>(std::max(width_px, 0)) * static_cast<std::size_t>(std::max(height_px, 0));
	refuseInputIf(texels > most, name, std::to_string(texels) + " texels", "at most " + std::to_string(most) + option);
	if (texels == 0 || channels < 1 || texels > kMaxImageValues / static_cast<std::size_t>(channels))
	{
		refuseInput(name,
					std::to_string(width_px) + "x" + std::to_string(height_px) + " pixels of " + std::to_string(channels) +
						" channels",
					"an image that can be read");
	}
	return texels;
}

std::optional<AlphaImage> readAlpha(const PictureSize& size, const EncodedAlpha& picture, std::size_t max_texels,
									const ReadRow& read)
{
	AlphaImage image{size.width_px, size.height_px, {}};
	image.alpha.resize(checkedTexels(size.width_px, size.height_px, std::min(size.channels, 1), max_texels, picture.name), 255);
	const ChannelPlace place = placeOf(picture.channel, size.channels - (size.alpha >= 0 ? 1 : 0), size.alpha);
	const auto count = static_cast<std::size_t>(place.count);
	std::vector<uint8_t> values(count * static_cast<std::size_t>(size.width_px));
	for (std::size_t texel = 0; texel < image.alpha.size() && count > 0;)
	{
		if (!read(place, values))
		{
			return std::nullopt;
		}
		for (std::size_t i = 0; i < values.size(); i += count)
		{
			image.alpha[texel++] = maskValue(&values[i], place);
		}
	}
	return image;
}

bool isKtx2(std::string_view bytes)
{
	return bytes.starts_with(kIdentifier);
}

Decoded<AlphaImage> alphaOfKtx2(std::string_view bytes, const EncodedAlpha& picture, std::size_t max_texels)
{
	const std::string& name = picture.name;
	refuseInputIf(bytes.size() < kHeader + kLevel, name + ": KTX2", std::to_string(bytes.size()) + " bytes",
				  "at least " + std::to_string(kHeader + kLevel));
	const std::size_t channels = channelsOf(bytes, name);
	const uint64_t width = littleEndian(bytes, 20, 4);
	const uint64_t height = littleEndian(bytes, 24, 4);
	const uint64_t depth = littleEndian(bytes, 28, 4);
	const uint64_t layers = littleEndian(bytes, 32, 4);
	const uint64_t faces = littleEndian(bytes, 36, 4);
	if (width < 1 || height < 1 || depth > 0 || layers > 1 || faces != 1)
	{
		refuseInput(name + ": KTX2",
					std::to_string(width) + "x" + std::to_string(height) + " texels, depth " + std::to_string(depth) + ", " +
						std::to_string(layers) + " layers, " + std::to_string(faces) + " faces",
					"one picture");
	}
	refuseInputIf(height > max_texels / width || std::max(width, height) > INT32_MAX, name,
				  std::to_string(width) + "x" + std::to_string(height) + " texels",
				  "at most " + std::to_string(max_texels) + " (max-texels)");
	const uint64_t offset = littleEndian(bytes, kHeader, 8);
	const uint64_t length = littleEndian(bytes, kHeader + 8, 8);
	const uint64_t texels = width * height;
	if (length < texels * channels || offset > bytes.size() || length > bytes.size() - offset)
	{
		refuseInput(name + ": KTX2",
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
