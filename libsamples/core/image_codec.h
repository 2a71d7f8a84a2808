// SPDX-License-Identifier: GPL-3.0-or-later
// Protocol between core/image.cpp and the workers: core/exr_worker.cpp (OpenEXR), core/picture_worker.cpp (libpng, libjpeg)
// and core/image_worker.cpp (OpenImageIO). OpenImageIO brings some 250 libraries, which take thirty times as long to load as the
// rest of nook and may be missing, so its worker starts only for a picture that the others decline, and is then kept.
#pragma once

#include "core/archive.h"
#include "core/file.h"
#include "core/image.h"
#include "core/value_stream.h"
#include "core/words.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr const char* kImageWorker = "nook_image_worker";
inline constexpr const char* kExrWorker = "nook_exr_worker";
inline constexpr const char* kPictureWorker = "nook_picture_worker";
inline constexpr const char* kEncode = "encode"; // ImageToEncode and its pixels → file bytes; kExrWorker only
inline constexpr const char* kDecode = "decode"; // a name and file bytes → Decoded<Image>
// A limit of texels and EncodedAlphas → Decoded<AlphaImage> for each. kImageWorker declines no picture.
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

// A picture, or why the worker declines it: the defect of a broken file, or nothing for a kind of file that it does not read.
template <class T> struct Decoded
{
	std::optional<T> image;
	std::string defect;
};

// Writes or reads the members of a value, by one visitor per type for both directions.
template <class Stream> class Members
{
public:
	explicit Members(Stream& stream) : m_stream(stream) {}

	template <class... Values> void operator()(Values&... values)
	{
		(pass(values), ...);
	}

private:
	static constexpr bool kReads = std::is_same_v<Stream, ValueReader>;
	static constexpr std::size_t kMostBytes = kMostTexels; // of a list

	template <class Values> void list(Values& values)
	{
		if constexpr (kReads)
		{
			values.clear();
			m_stream.values(values, kMostBytes / sizeof(typename Values::value_type));
		}
		else
		{
			m_stream.values(values);
		}
	}
	template <class Value> void pass(Value& value)
	{
		if constexpr (!IsPlain<Value>::value)
		{
			visit(*this, value);
		}
		else if constexpr (kReads)
		{
			value = m_stream.template value<Value>();
		}
		else
		{
			m_stream.value(value);
		}
	}
	void pass(std::string& text)
	{
		list(text);
	}
	template <class Item> void pass(std::vector<Item>& items)
	{
		if constexpr (IsPlain<Item>::value)
		{
			list(items);
			return;
		}
		std::size_t count = items.size();
		pass(count);
		if (count > kMostNames)
		{
			throw StreamEnded{};
		}
		items.resize(count);
		for (Item& item : items)
		{
			pass(item);
		}
	}
	template <class Value> void pass(std::optional<Value>& value)
	{
		bool there = value.has_value();
		pass(there);
		value = !there ? std::nullopt : kReads ? std::optional<Value>(std::in_place) : std::move(value);
		if (there)
		{
			pass(*value);
		}
	}

	Stream& m_stream;
};

template <class Io> void visit(Io& io, Note& note)
{
	io(note.key, note.value);
}
template <class Io> void visit(Io& io, ImageMatrix& matrix)
{
	io(matrix.key, matrix.values, matrix.wide);
}
template <class Io> void visit(Io& io, ImageToEncode& image)
{
	io(image.width_px, image.height_px, image.channels, image.attributes, image.matrices);
}
template <class Io> void visit(Io& io, Image& image)
{
	io(image.width_px, image.height_px, image.cropped, image.channels, image.halves, image.values, image.notes, image.matrices);
}
template <class Io> void visit(Io& io, EncodedAlpha& mask)
{
	io(mask.name, mask.path, mask.bytes, mask.channel);
}
template <class Io> void visit(Io& io, AlphaImage& image)
{
	io(image.width_px, image.height_px, image.alpha);
}
template <class Io, class T> void visit(Io& io, Decoded<T>& decoded)
{
	io(decoded.image, decoded.defect);
}

template <class Value> void send(const Value& value, ValueWriter& to)
{
	Members<ValueWriter> write(to);
	write(const_cast<Value&>(value)); // NOLINT: writing changes nothing
}
template <class Value> void receive(Value& value, ValueReader& from)
{
	Members<ValueReader> read(from);
	read(value);
}

// kDecodeAlphas of a worker that decodes one picture with `decode`.
using DecodeAlpha = Decoded<AlphaImage> (*)(std::string_view bytes, const EncodedAlpha& picture, std::size_t max_texels);
void answerAlphas(ValueReader& from, ValueWriter& answer, DecodeAlpha decode);
template <DecodeAlpha decode> void answerAlphas(ValueReader& from, ValueWriter& answer)
{
	answerAlphas(from, answer, decode);
}

// Likewise kDecode.
using DecodeImage = Decoded<Image> (*)(const std::string& bytes, const std::string& name);
template <DecodeImage decode> void answerImage(ValueReader& from, ValueWriter& answer)
{
	const std::string name = from.text();
	std::string bytes;
	from.values(bytes, kMaxFileBytes);
	send(decode(bytes, name), answer);
}

// The number of texels. Throws Error (invalid_input) if it is 0, above `most` (set by `option`), or there are too many values.
std::size_t checkedTexels(int width_px, int height_px, int channels, std::size_t most, const std::string& name,
						  const char* option = " (max-texels)");

inline bool looksPng(std::string_view bytes)
{
	return bytes.starts_with("\x89PNG\r\n\x1A\n");
}

inline bool looksExr(std::string_view bytes)
{
	return bytes.starts_with("\x76\x2F\x31\x01");
}

// A value in 0…1 as 8 bits, rounded as OpenImageIO does.
inline uint8_t byteOf(float value)
{
	return value > 0.0F ? static_cast<uint8_t>(std::min(value * 255.0F + 0.5F, 255.0F)) : uint8_t{0};
}

// Reads opacity from uncompressed KTX2 files, such as `ktx transcode --target rgba8` makes from Basis Universal.

// True if the bytes begin like a KTX2 file.
bool isKtx2(std::string_view bytes);

// Reads the largest level of a 2D texture with 8 bits per channel. Throws Error: unsupported for compressed texels, naming the
// command that decompresses them; invalid_input if the file is truncated or has more than `max_texels`.
Decoded<AlphaImage> alphaOfKtx2(std::string_view bytes, const EncodedAlpha& picture, std::size_t max_texels);

// Locates the opacity channel of a picture in a texel and reads it.

// Channels [first, first + count) of a texel: one, or three for luminance; none if fully opaque.
struct ChannelPlace
{
	int first = 0;
	int count = 0;
};

struct PictureSize
{
	int width_px = 0;
	int height_px = 0;
	int channels = 0;
	int alpha = -1; // index of the channel of opacity
};

// The opacities of a picture. `read` gets the next row's values of that place, 8 bits each; where it returns false, there is
// nothing. It is not called for an opaque picture. Throws as checkedTexels().
using ReadRow = std::function<bool(ChannelPlace place, std::vector<uint8_t>& values)>;
std::optional<AlphaImage> readAlpha(const PictureSize& size, const EncodedAlpha& picture, std::size_t max_texels,
									const ReadRow& read);

} // namespace nook
