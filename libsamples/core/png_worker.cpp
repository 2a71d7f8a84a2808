// SPDX-License-Identifier: GPL-3.0-or-later
// Worker of core/image_codec.h for plain PNG files: libpng loads thirty times faster than OpenImageIO. It reads the same values.
#include "core/image_codec.h"

#include "core/file.h"
#include "core/isolate.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{
namespace
{

constexpr std::size_t kSignature = 8; // bytes before the first chunk

struct PngBytes
{
	std::string_view bytes;
	std::size_t at = 0;
};

[[noreturn]] void onError(png_structp png, png_const_charp /*message*/)
{
	png_longjmp(png, 1); // OpenImageIO reports the error
}

void onWarning(png_structp /*png*/, png_const_charp /*message*/) {}

void onRead(png_structp png, png_bytep to, std::size_t count)
{
	auto& from = *static_cast<PngBytes*>(png_get_io_ptr(png));
	if (from.bytes.size() - from.at < count)
	{
		png_error(png, "end of the file");
	}
	std::memcpy(to, from.bytes.data() + from.at, count);
	from.at += count;
}

uint32_t bigEndian(std::string_view bytes, std::size_t at)
{
	uint32_t value = 0;
	for (std::size_t i = 0; i < sizeof value; ++i)
	{
		value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
	}
	return value;
}

// True if only the header, texts and pixels affect what is read, as in files of nook, libpng's simple interface and browsers.
bool hasPlainChunks(std::string_view bytes)
{
	constexpr std::size_t kAround = 12; // chunk overhead in bytes
	constexpr std::array<std::string_view, 8> kPlain{"IHDR", "gAMA", "sRGB", "cHRM", "sBIT", "tEXt", "IDAT", "IEND"};
	std::size_t texts = 0;
	for (std::size_t at = kSignature; at < bytes.size();)
	{
		if (bytes.size() - at < kAround || bytes.size() - at - kAround < bigEndian(bytes, at))
		{
			return false;
		}
		const std::size_t size = bigEndian(bytes, at);
		const std::string_view type = bytes.substr(at + 4, 4);
		const std::string_view content = bytes.substr(at + 8, size);
		const bool moved = type == "oFFs" && content.find_first_not_of('\0') != std::string_view::npos;
		if ((std::find(kPlain.begin(), kPlain.end(), type) == kPlain.end() && type != "oFFs") || moved)
		{
			return false;
		}
		texts += type == "tEXt" ? 1U : 0U;
		at += kAround + size;
	}
	return texts <= kMostNames;
}

// A libpng reader at the start of a file.
class PngReader
{
public:
	explicit PngReader(std::string_view bytes) : m_from{bytes}
	{
		m_png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, onError, onWarning);
		m_info = m_png == nullptr ? nullptr : png_create_info_struct(m_png);
		if (m_info != nullptr)
		{
			png_set_read_fn(m_png, &m_from, onRead);
		}
	}
	PngReader(const PngReader&) = delete;
	PngReader& operator=(const PngReader&) = delete;
	~PngReader()
	{
		png_destroy_read_struct(&m_png, &m_info, nullptr);
	}

	// Returns false if libpng jumped back; so do the next two.
	bool readHeader()
	{
		if (m_info == nullptr)
		{
			return false;
		}
		if (setjmp(png_jmpbuf(m_png)) != 0)
		{
			return false;
		}
		png_read_info(m_png, m_info);
		return true;
	}
	bool readRow(png_bytep row)
	{
		if (setjmp(png_jmpbuf(m_png)) != 0)
		{
			return false;
		}
		png_read_row(m_png, row, nullptr);
		return true;
	}
	bool readEnd()
	{
		if (setjmp(png_jmpbuf(m_png)) != 0)
		{
			return false;
		}
		png_read_end(m_png, nullptr);
		return true;
	}

	int width_px() const
	{
		return static_cast<int>(png_get_image_width(m_png, m_info));
	}
	int height_px() const
	{
		return static_cast<int>(png_get_image_height(m_png, m_info));
	}
	int channels() const
	{
		return png_get_channels(m_png, m_info);
	}
	int bits() const
	{
		return png_get_bit_depth(m_png, m_info);
	}
	bool isInterlaced() const
	{
		return png_get_interlace_type(m_png, m_info) != PNG_INTERLACE_NONE;
	}
	bool hasPalette() const
	{
		return png_get_color_type(m_png, m_info) == PNG_COLOR_TYPE_PALETTE;
	}
	// Texts stored before the pixels.
	Notes texts() const
	{
		png_textp texts = nullptr;
		const int count = png_get_text(m_png, m_info, &texts, nullptr);
		Notes notes;
		for (const png_text& text : std::span<const png_text>(texts, static_cast<std::size_t>(count)))
		{
			notes.push_back({text.key, text.text});
		}
		return notes;
	}

private:
	PngBytes m_from;
	png_structp m_png = nullptr;
	png_infop m_info = nullptr;
};

// Reads the header and returns whether this worker handles the file; all others are left to OpenImageIO.
bool begins(std::string_view bytes, PngReader& reader, std::size_t max_texels)
{
	if (!hasPlainChunks(bytes) || !reader.readHeader() || reader.isInterlaced() || reader.hasPalette() || reader.bits() < 8)
	{
		return false;
	}
	const std::size_t texels = static_cast<std::size_t>(reader.width_px()) * static_cast<std::size_t>(reader.height_px());
	return texels <= max_texels && texels <= kMaxImageValues / static_cast<std::size_t>(reader.channels());
}

// Calls `use` with each row of 8-bit or big-endian 16-bit values; false if the file is broken.
bool forRows(PngReader& reader, const std::function<void(const std::vector<png_byte>&)>& use)
{
	std::vector<png_byte> row(static_cast<std::size_t>(reader.width_px()) * static_cast<std::size_t>(reader.channels()) *
							  static_cast<std::size_t>(reader.bits() / 8));
	for (int y = 0; y < reader.height_px(); ++y)
	{
		if (!reader.readRow(row.data()))
		{
			return false;
		}
		use(row);
	}
	return reader.readEnd();
}

// True if OpenImageIO would keep all texts unchanged: it renames some, and keeps one per case-insensitive key.
bool arePlain(const Notes& texts)
{
	std::set<std::string> keys{"", "description", "author", "title", "xml:com.adobe.xmp"};
	return std::all_of(texts.begin(), texts.end(),
					   [&](const Note& text)
					   {
						   std::string key = text.key;
						   std::transform(key.begin(), key.end(), key.begin(),
										  [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
						   return !key.starts_with("raw profile") && keys.insert(key).second;
					   });
}

std::optional<Image> plain(std::string_view bytes)
{
	PngReader reader(bytes);
	if (!begins(bytes, reader, kMaxTexels))
	{
		return std::nullopt;
	}
	Image image;
	image.notes = reader.texts();
	if (!arePlain(image.notes))
	{
		return std::nullopt;
	}
	image.width_px = reader.width_px();
	image.height_px = reader.height_px();
	constexpr std::array<const char*, 4> kNames{"Y", "YA", "RGB", "RGBA"};
	for (const char* name = kNames[static_cast<std::size_t>(reader.channels() - 1)]; *name != '\0'; ++name)
	{
		image.channels.emplace_back(1, *name);
	}
	image.halves.resize(image.channels.size(), 0);
	const bool wide = reader.bits() == 16;
	image.values.reserve(static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px) *
						 image.channels.size());
	const bool whole =
		forRows(reader,
				[&](const std::vector<png_byte>& row)
				{
					for (std::size_t i = 0; i < row.size(); i += wide ? 2 : 1)
					{
						image.values.push_back(wide ? static_cast<float>(row[i] << 8U | row[i + 1]) * (1.0F / 65535.0F)
													: static_cast<float>(row[i]) * (1.0F / 255.0F));
					}
				});
	return whole ? std::optional(std::move(image)) : std::nullopt;
}

void decode(ValueReader& request, ValueWriter& answer)
{
	std::string bytes;
	request.values(bytes, kMaxFileBytes);
	send(plain(bytes), answer);
}

std::optional<AlphaImage> plainAlpha(std::string_view bytes, MaskChannel channel, std::size_t max_texels)
{
	PngReader reader(bytes);
	if (!begins(bytes, reader, max_texels) || reader.bits() != 8)
	{
		return std::nullopt;
	}
	AlphaImage image{reader.width_px(), reader.height_px(), {}};
	const auto channels = static_cast<std::size_t>(reader.channels());
	const std::size_t texels = static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
	const bool has_alpha = channels % 2 == 0;
	const int colours = reader.channels() - (has_alpha ? 1 : 0);
	const ChannelPlace place = placeOf(channel, colours, has_alpha ? colours : -1);
	if (place.count == 0)
	{
		image.alpha.resize(texels, 255);
		return image;
	}
	image.alpha.reserve(texels);
	const auto takeRow = [&](const std::vector<png_byte>& row)
	{
		if (channels == 1)
		{
			image.alpha.insert(image.alpha.end(), row.begin(), row.end());
			return;
		}
		for (auto i = static_cast<std::size_t>(place.first); i < row.size(); i += channels)
		{
			image.alpha.push_back(maskValue(row.data() + i, place));
		}
	};
	return forRows(reader, takeRow) ? std::optional(std::move(image)) : std::nullopt;
}

void decodeAlphas(ValueReader& from, ValueWriter& answer)
{
	AlphaRequest request;
	receive(request, from);
	for (const EncodedAlpha& picture : request.pictures)
	{
		const std::string read = picture.path.empty() ? std::string() : readFile(picture.path);
		send(plainAlpha(picture.path.empty() ? picture.bytes : read, picture.channel, request.max_texels), answer);
	}
}

} // namespace
} // namespace nook

int main(int argc, char** argv)
{
	using namespace nook;
	constexpr std::array<WorkerFunction, 2> kFunctions{{{kDecode, decode}, {kDecodeAlphas, decodeAlphas}}};
	return serveRequests(argc, argv, kFunctions);
}
