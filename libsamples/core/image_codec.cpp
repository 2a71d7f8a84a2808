// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image_codec.h"

#include "core/file.h"

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

void receive(AlphaRequest& request, ValueReader& from)
{
	request.max_texels = from.value<std::size_t>();
	request.pictures.resize(from.value<std::size_t>());
	for (EncodedAlpha& picture : request.pictures)
	{
		receive(picture, from);
	}
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
