// SPDX-License-Identifier: GPL-3.0-or-later
// OpenEXR files in the worker of core/picture_worker.cpp, and the only file that uses OpenEXR. It writes the same bytes and reads
// the same values as OpenImageIO.
#include "core/image_codec.h"

#include "core/error.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <array>
#include <exception>
#include <tuple>

namespace nook
{
namespace
{

// A slice of a picture with `channels` interleaved floats.
Imf::Slice sliceOf(float* values, std::size_t channel, std::size_t channels, int width_px)
{
	const std::size_t pixel = channels * sizeof(float);
	return {Imf::FLOAT, reinterpret_cast<char*>(values + channel), pixel, pixel * static_cast<std::size_t>(width_px)};
}

template <class T> Imath::Matrix44<T> matrixOf(const ImageMatrix& matrix)
{
	Imath::Matrix44<T> made;
	std::transform(matrix.values.begin(), matrix.values.end(), made.getValue(), [](double v) { return static_cast<T>(v); });
	return made;
}

Imf::Header headerOf(const Image& image)
{
	Imf::Header header(image.width_px, image.height_px);
	header.compression() = Imf::NO_COMPRESSION;
	for (const Note& note : image.notes)
	{
		if (note.key == "compression")
		{
			header.compression() = note.value == "zip" ? Imf::ZIP_COMPRESSION : Imf::NO_COMPRESSION;
		}
		else
		{
			header.insert(note.key, Imf::StringAttribute(note.value));
		}
	}
	for (const ImageMatrix& matrix : image.matrices)
	{
		if (matrix.wide)
		{
			header.insert(matrix.key, Imf::M44dAttribute(matrixOf<double>(matrix)));
		}
		else
		{
			header.insert(matrix.key, Imf::M44fAttribute(matrixOf<float>(matrix)));
		}
	}
	return header;
}

// Lower-case part of a channel's name after its layer.
std::string suffixOf(const std::string& name)
{
	return lowered(name.substr(name.rfind('.') + 1));
}

// Orders channel names as OpenImageIO does: by layer (the part before the last dot), colours first, then by name.
bool isBefore(const std::string& a, const std::string& b)
{
	const auto place = [](const std::string& name)
	{
		constexpr std::array<std::string_view, 17> kFirst{"r",     "red", "g",  "green", "b",  "blue", "real", "imag", "a",
														  "alpha", "ar",  "ra", "ag",    "ga", "ab",   "ba",   "z"};
		const std::size_t dot = name.rfind('.');
		const std::string layer = dot == std::string::npos ? "" : name.substr(0, dot);
		const auto end = layer.empty() ? kFirst.end() : kFirst.end() - 1; // N.Z comes after N.X and N.Y
		return std::tuple(layer, std::find(kFirst.begin(), end, suffixOf(name)) - kFirst.begin(), name);
	};
	return place(a) < place(b);
}

// The channels' names in that order; none if one is not of floats or not sampled once per pixel, or the picture is deep.
std::vector<std::string> channelNames(const Imf::Header& header)
{
	std::vector<std::string> names;
	if (header.hasType() && Imf::isDeepData(header.type()))
	{
		return names;
	}
	for (auto at = header.channels().begin(); at != header.channels().end(); ++at)
	{
		const Imf::Channel& channel = at.channel();
		if (channel.type == Imf::UINT || channel.xSampling != 1 || channel.ySampling != 1 || names.size() >= kMostNames)
		{
			return {};
		}
		names.emplace_back(at.name());
	}
	std::sort(names.begin(), names.end(), isBefore);
	return names;
}

// Copies a text or a matrix into the image.
void takeAttribute(const std::string& name, const Imf::Attribute& attribute, Image& image)
{
	const auto add = [&](const auto* numbers, bool wide)
	{
		std::copy_n(numbers, 16, image.matrices.emplace_back(ImageMatrix{name, {}, wide}).values.begin());
	};
	if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute); text != nullptr && !text->value().empty())
	{
		image.notes.push_back({name, text->value()});
	}
	else if (const auto* narrow = dynamic_cast<const Imf::M44fAttribute*>(&attribute))
	{
		add(narrow->value().getValue(), false);
	}
	else if (const auto* wide = dynamic_cast<const Imf::M44dAttribute*>(&attribute))
	{
		add(wide->value().getValue(), true);
	}
}

Imath::V2i sizeOf(const Imf::Header& header)
{
	const Imath::Box2i window = header.dataWindow();
	return window.max - window.min + Imath::V2i(1, 1);
}

std::optional<Image> imageOf(const std::string& bytes, const std::string& name)
{
	Imf::StdISStream memory;
	memory.str(bytes);
	Imf::InputFile input(memory, 0);
	const Imf::Header& header = input.header();
	Image image;
	for (auto at = header.begin(); at != header.end(); ++at)
	{
		takeAttribute(at.name(), at.attribute(), image);
		refuseInputIf(image.notes.size() + image.matrices.size() > kMostNames, name,
					  "more than " + std::to_string(kMostNames) + " attributes", "fewer");
	}
	image.channels = channelNames(header);
	if (image.channels.empty())
	{
		return std::nullopt;
	}
	const Imath::Box2i window = header.dataWindow();
	image.width_px = sizeOf(header).x;
	image.height_px = sizeOf(header).y;
	image.cropped = window != header.displayWindow();
	constexpr std::array<const char*, Imf::NUM_COMPRESSION_METHODS> kCompressions{"none",  "rle", "zips", "zip",  "piz",
																				  "pxr24", "b44", "b44a", "dwaa", "dwab"};
	image.notes.insert(image.notes.begin(), {"compression", kCompressions[static_cast<std::size_t>(header.compression())]});
	const std::size_t count = image.channels.size();
	image.values.resize(checkedTexels(image.width_px, image.height_px, static_cast<int>(count), kMaxTexels, name, "") * count);
	const std::ptrdiff_t begin =
		(window.min.x + std::ptrdiff_t{window.min.y} * image.width_px) * static_cast<std::ptrdiff_t>(count);
	Imf::FrameBuffer buffer;
	for (std::size_t i = 0; i < count; ++i)
	{
		image.halves.push_back(header.channels()[image.channels[i]].type == Imf::HALF ? 1 : 0);
		buffer.insert(image.channels[i], sliceOf(image.values.data() - begin, i, count, image.width_px));
	}
	input.setFrameBuffer(buffer);
	input.readPixels(window.min.y, window.max.y);
	return image;
}

// The answer of `read`; nothing for a broken file.
template <class T, class Read> Decoded<T> unlessBroken(const Read& read)
{
	try
	{
		return {read(), {}};
	}
	catch (const Iex::BaseExc& error)
	{
		return {std::nullopt, error.what()};
	}
}

std::optional<AlphaImage> alphaOf(const std::string& bytes, const EncodedAlpha& picture, std::size_t max_texels)
{
	Imf::StdISStream memory;
	memory.str(bytes);
	Imf::InputFile input(memory, 0);
	const std::vector<std::string> names = channelNames(input.header());
	const auto alpha = std::find_if(names.begin(), names.end(),
									[](const std::string& name) { return suffixOf(name) == "a" || suffixOf(name) == "alpha"; });
	const Imath::V2i size = sizeOf(input.header());
	Imath::V2i next = input.header().dataWindow().min;
	std::vector<float> row;
	const auto readRow = [&](ChannelPlace place, std::vector<uint8_t>& values)
	{
		if (row.empty())
		{
			row.resize(values.size());
			Imf::FrameBuffer buffer;
			for (int i = 0; i < place.count; ++i) // each row at the same place
			{
				buffer.insert(names[static_cast<std::size_t>(place.first + i)],
							  sliceOf(row.data() - std::ptrdiff_t{next.x} * place.count, static_cast<std::size_t>(i),
									  static_cast<std::size_t>(place.count), 0));
			}
			input.setFrameBuffer(buffer);
		}
		input.readPixels(next.y++);
		std::transform(row.begin(), row.end(), values.begin(), byteOf);
		return true;
	};
	if (names.empty())
	{
		return std::nullopt;
	}
	return readAlpha(
		{size.x, size.y, static_cast<int>(names.size()), alpha == names.end() ? -1 : static_cast<int>(alpha - names.begin())},
		picture, max_texels, readRow);
}

} // namespace

void encodeExr(ValueReader& request, ValueWriter& answer)
{
	Image image;
	receive(image, request, SIZE_MAX);
	const std::vector<std::string>& names = image.channels;
	Imf::Header header = headerOf(image);
	Imf::FrameBuffer buffer;
	for (std::size_t i = 0; i < names.size(); ++i)
	{
		header.channels().insert(names[i], Imf::Channel(Imf::FLOAT));
		buffer.insert(names[i], sliceOf(image.values.data(), i, names.size(), image.width_px));
	}
	Imf::StdOSStream memory;
	try
	{
		Imf::OutputFile output(memory, header, 0);
		output.setFrameBuffer(buffer);
		output.writePixels(image.height_px);
	}
	catch (const std::exception& error)
	{
		throw Error(ExitCode::runtime, std::string("image: ") + error.what());
	}
	answer.values(memory.str());
}

Decoded<Image> decodeExr(const std::string& bytes, const std::string& name)
{
	return unlessBroken<Image>([&] { return imageOf(bytes, name); });
}

Decoded<AlphaImage> alphaOfExr(std::string_view bytes, const EncodedAlpha& picture, std::size_t max_texels)
{
	return unlessBroken<AlphaImage>([&] { return alphaOf(std::string(bytes), picture, max_texels); });
}

} // namespace nook
