// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image_codec.h"

#include "core/file.h"
#include "core/words.h"

namespace nook
{
namespace
{

std::size_t count(ValueReader& from)
{
	const auto number = from.value<std::size_t>();
	if (number > kMostNames)
	{
		throw StreamEnded{};
	}
	return number;
}

void send(const std::vector<std::string>& names, ValueWriter& to)
{
	to.value(names.size());
	for (const std::string& name : names)
	{
		to.text(name);
	}
}

void receive(std::vector<std::string>& names, ValueReader& from)
{
	names.resize(count(from));
	for (std::string& name : names)
	{
		name = from.text();
	}
}

void send(const Notes& notes, ValueWriter& to)
{
	to.value(notes.size());
	for (const Note& note : notes)
	{
		to.text(note.key);
		to.text(note.value);
	}
}

void receive(Notes& notes, ValueReader& from)
{
	notes.resize(count(from));
	for (Note& note : notes)
	{
		note.key = from.text();
		note.value = from.text();
	}
}

void send(const std::vector<ImageMatrix>& matrices, ValueWriter& to)
{
	to.value(matrices.size());
	for (const ImageMatrix& matrix : matrices)
	{
		to.text(matrix.key);
		to.value(matrix.values);
		to.value(matrix.wide);
	}
}

void receive(std::vector<ImageMatrix>& matrices, ValueReader& from)
{
	matrices.resize(count(from));
	for (ImageMatrix& matrix : matrices)
	{
		matrix.key = from.text();
		matrix.values = from.value<std::array<double, 16>>();
		matrix.wide = from.value<bool>();
	}
}

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

} // namespace

void send(const ImageToEncode& image, ValueWriter& to)
{
	to.value(image.width_px);
	to.value(image.height_px);
	send(image.channels, to);
	send(image.attributes, to);
	send(image.matrices, to);
}

void receive(ImageToEncode& image, ValueReader& from)
{
	image.width_px = from.value<int>();
	image.height_px = from.value<int>();
	receive(image.channels, from);
	receive(image.attributes, from);
	receive(image.matrices, from);
}

void send(const Image& image, ValueWriter& to)
{
	to.value(image.width_px);
	to.value(image.height_px);
	to.value(image.cropped);
	send(image.channels, to);
	to.values(image.halves);
	to.values(image.values);
	send(image.notes, to);
	send(image.matrices, to);
}

void receive(Image& image, ValueReader& from)
{
	image.width_px = from.value<int>();
	image.height_px = from.value<int>();
	image.cropped = from.value<bool>();
	receive(image.channels, from);
	from.values(image.halves, kMostNames);
	from.values(image.values, kMaxImageValues);
	receive(image.notes, from);
	receive(image.matrices, from);
}

void send(const EncodedAlpha& mask, ValueWriter& to)
{
	to.text(mask.name);
	to.text(mask.path);
	to.values(mask.bytes);
	to.value(mask.channel);
}

void receive(EncodedAlpha& mask, ValueReader& from)
{
	mask.name = from.text();
	mask.path = from.text();
	from.values(mask.bytes, kMaxFileBytes);
	mask.channel = from.value<MaskChannel>();
}

void answerAlphas(ValueReader& from, ValueWriter& answer, DecodeAlpha decode)
{
	AlphaRequest request;
	request.max_texels = from.value<std::size_t>();
	request.pictures.resize(from.value<std::size_t>());
	for (EncodedAlpha& picture : request.pictures)
	{
		receive(picture, from);
	}
	for (const EncodedAlpha& picture : request.pictures)
	{
		const std::string read = picture.path.empty() ? std::string() : readFile(picture.path);
		send(decode(picture.path.empty() ? picture.bytes : read, picture, request.max_texels), answer);
	}
}

std::size_t checkedTexels(int width_px, int height_px, int channels, std::size_t most, const std::string& name, const char* option)
{
	const auto texels = static_cast<std::size_t>(std::max(width_px, 0)) * static_cast<std::size_t>(std::max(height_px, 0));
	if (texels > most)
	{
		refuseInput(name, std::to_string(texels) + " texels", "at most " + std::to_string(most) + option);
	}
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

void send(const AlphaImage& image, ValueWriter& to)
{
	to.value(image.width_px);
	to.value(image.height_px);
	to.values(image.alpha);
}

void receive(AlphaImage& image, ValueReader& from)
{
	image.width_px = from.value<int>();
	image.height_px = from.value<int>();
	from.values(image.alpha, kMostTexels);
}

} // namespace nook
