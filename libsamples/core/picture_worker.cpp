// SPDX-License-Identifier: GPL-3.0-or-later
// Worker of core/image_codec.h for PNG, JPEG, TGA, BMP, KTX2 and OpenEXR files, without OpenImageIO, which takes thirty times as
// long to load as these libraries. It reads the same values.
#include "core/image_codec.h"

#include "core/error.h"
#include "core/isolate.h"

#include <cstdio> // jpeglib.h needs it

#include <jpeglib.h>
#include <png.h>

#include <array>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <span>

namespace nook
{
namespace
{

// An opened picture whose rows are not yet read. libpng and libjpeg jump back out of their errors, so each function that calls them
// returns false then, and holds nothing with a destructor.
class PictureReader
{
public:
	PictureReader& operator=(PictureReader&&) = delete;
	virtual ~PictureReader() = default;

	// Reads the next row, and what follows the last; values of 16 bits are big-endian.
	virtual bool readRow(uint8_t* row) = 0;

	int width_px = 0;
	int height_px = 0;
	int channels = 0;
	int bits = 8; // per value
	bool cropped = false;
	Notes texts; // stored before the pixels

	// The library's own words for a broken file.
	std::string defect() const
	{
		return m_defect.data();
	}

protected:
	std::array<char, JMSG_LENGTH_MAX> m_defect{};
	std::jmp_buf m_back{};
};

class PngReader : public PictureReader
{
public:
	explicit PngReader(std::string_view bytes) : m_bytes(bytes)
	{
		m_png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, onError, [](png_structp, png_const_charp) {});
		m_info = m_png == nullptr ? nullptr : png_create_info_struct(m_png);
	}
	~PngReader() override
	{
		png_destroy_read_struct(&m_png, &m_info, nullptr);
	}

	// Interlaced files, palettes and small integers give the values that a plain file would.
	bool readHeader()
	{
		if (m_info == nullptr || setjmp(m_back) != 0)
		{
			return false;
		}
		png_set_read_fn(m_png, this, onRead);
		png_read_info(m_png, m_info);
		m_passes = png_set_interlace_handling(m_png);
		png_set_expand(m_png);
		png_read_update_info(m_png, m_info);
		width_px = static_cast<int>(png_get_image_width(m_png, m_info));
		height_px = static_cast<int>(png_get_image_height(m_png, m_info));
		channels = png_get_channels(m_png, m_info);
		bits = png_get_bit_depth(m_png, m_info);
		cropped = png_get_x_offset_pixels(m_png, m_info) != 0 || png_get_y_offset_pixels(m_png, m_info) != 0;
		return true;
	}
	void readTexts()
	{
		png_textp all = nullptr;
		const int count = png_get_text(m_png, m_info, &all, nullptr);
		for (const png_text& text : std::span<const png_text>(all, static_cast<std::size_t>(count)))
		{
			texts.push_back({text.key, text.text});
		}
	}
	bool readRow(uint8_t* row) override
	{
		const std::size_t size = png_get_rowbytes(m_png, m_info);
		m_rows.resize(m_passes > 1 ? size * static_cast<std::size_t>(height_px) : 0);
		if (setjmp(m_back) != 0)
		{
			return false;
		}
		if (m_passes > 1) // all rows at the first one
		{
			for (int i = 0; m_row == 0 && i < m_passes * height_px; ++i)
			{
				png_read_row(m_png, m_rows.data() + size * static_cast<std::size_t>(i % height_px), nullptr);
			}
			std::memcpy(row, m_rows.data() + size * static_cast<std::size_t>(m_row), size);
		}
		else
		{
			png_read_row(m_png, row, nullptr);
		}
		m_row += 1;
		if (m_row == height_px)
		{
			png_read_end(m_png, nullptr);
		}
		return true;
	}

private:
	[[noreturn]] static void onError(png_structp png, png_const_charp message)
	{
		auto& self = *static_cast<PngReader*>(png_get_error_ptr(png));
		std::snprintf(self.m_defect.data(), self.m_defect.size(), "%s", message);
		std::longjmp(self.m_back, 1);
	}
	static void onRead(png_structp png, png_bytep to, std::size_t count)
	{
		auto& self = *static_cast<PngReader*>(png_get_io_ptr(png));
		if (self.m_bytes.size() - self.m_at < count)
		{
			png_error(png, "end of the file");
		}
		std::memcpy(to, self.m_bytes.data() + self.m_at, count);
		self.m_at += count;
	}

	std::string_view m_bytes;
	std::size_t m_at = 0;
	png_structp m_png = nullptr;
	png_infop m_info = nullptr;
	int m_passes = 1;
	std::vector<uint8_t> m_rows; // of an interlaced picture
	int m_row = 0;
};

class JpegReader : public PictureReader
{
public:
	JpegReader(std::string_view bytes, std::string name) : m_bytes(bytes), m_name(std::move(name))
	{
		m_jpeg.err = jpeg_std_error(&m_errors);
		m_jpeg.client_data = this;
		m_errors.error_exit = onError;
		m_errors.output_message = [](j_common_ptr) {
		};
	}
	~JpegReader() override
	{
		jpeg_destroy_decompress(&m_jpeg);
	}

	bool readHeader()
	{
		if (setjmp(m_back) != 0)
		{
			return false;
		}
		jpeg_create_decompress(&m_jpeg);
		m_jpeg.progress = &m_progress;
		m_progress.progress_monitor = onProgress;
		jpeg_mem_src(&m_jpeg, reinterpret_cast<const unsigned char*>(m_bytes.data()), static_cast<unsigned long>(m_bytes.size()));
		jpeg_read_header(&m_jpeg, TRUE);
		width_px = static_cast<int>(m_jpeg.image_width);
		height_px = static_cast<int>(m_jpeg.image_height);
		channels = m_jpeg.num_components;
		return true;
	}
	bool readRow(uint8_t* row) override
	{
		if (setjmp(m_back) != 0)
		{
			if (m_jpeg.input_scan_number > kMostScans)
			{
				throw Error(ExitCode::invalid_input,
							m_name + ": found more than " + std::to_string(kMostScans) + " scans, expected fewer");
			}
			return false;
		}
		if (!m_started)
		{
			m_started = true;
			jpeg_start_decompress(&m_jpeg);
		}
		jpeg_read_scanlines(&m_jpeg, &row, 1);
		return true; // where a file ends early, the rest is grey
	}

private:
	[[noreturn]] static void onError(j_common_ptr jpeg)
	{
		auto& self = *static_cast<JpegReader*>(jpeg->client_data);
		jpeg->err->format_message(jpeg, self.m_defect.data());
		std::longjmp(self.m_back, 1);
	}

	static constexpr int kMostScans = 100; // a scan of few bytes may pass over all texels
	static void onProgress(j_common_ptr jpeg)
	{
		auto& self = *static_cast<JpegReader*>(jpeg->client_data);
		if (self.m_jpeg.input_scan_number > kMostScans)
		{
			std::longjmp(self.m_back, 1);
		}
	}

	std::string_view m_bytes;
	std::string m_name;
	jpeg_progress_mgr m_progress{};
	jpeg_decompress_struct m_jpeg{};
	jpeg_error_mgr m_errors{};
	bool m_started = false;
};

// TGA and BMP files with 24 or 32 bits per texel, and with 8: grey (TGA), or indices of a palette (BMP).
class RasterReader : public PictureReader
{
public:
	explicit RasterReader(std::string_view bytes) : m_bytes(bytes) {}

	bool readTgaHeader()
	{
		constexpr std::size_t kHeader = 18;
		if (m_bytes.size() < kHeader)
		{
			return false;
		}
		const uint64_t kind = littleEndian(m_bytes, 2, 1); // 2: colours, 3: grey; + 8: run lengths
		const uint64_t placement = littleEndian(m_bytes, 17, 1);
		m_bits = littleEndian(m_bytes, 16, 1);
		m_runs = (kind & 8U) != 0;
		m_up = (placement & 0x20U) == 0;
		m_rows_at = kHeader + littleEndian(m_bytes, 0, 1);
		width_px = static_cast<int>(littleEndian(m_bytes, 12, 2));
		height_px = static_cast<int>(littleEndian(m_bytes, 14, 2));
		channels = static_cast<int>(m_bits / 8);
		m_row_bytes = static_cast<std::size_t>(width_px) * m_bits / 8;
		const bool is_known = (kind & ~8U) == 2 ? m_bits == 24 || m_bits == 32 : (kind & ~8U) == 3 && m_bits == 8;
		return is_known && (placement & 0xD0U) == 0 && m_bytes[1] == '\0'; // from the left, no palette
	}
	bool readBmpHeader()
	{
		constexpr std::size_t kFileHeader = 14;
		constexpr std::size_t kHeader = 40; // at least
		if (m_bytes.size() < kFileHeader + kHeader)
		{
			return false;
		}
		m_bits = littleEndian(m_bytes, 28, 2);
		m_rows_at = littleEndian(m_bytes, 10, 4);
		width_px = static_cast<int>(littleEndian(m_bytes, 18, 4));
		height_px = static_cast<int>(littleEndian(m_bytes, 22, 4)); // below 0: stored from the top
		m_up = height_px > 0;
		height_px = std::max(height_px, -INT32_MAX) * (m_up ? 1 : -1);
		channels = m_bits == 32 ? 4 : 3;
		m_row_bytes = (static_cast<std::size_t>(std::max(width_px, 0)) * m_bits + 31) / 32 * 4;
		const std::size_t palette_at = kFileHeader + littleEndian(m_bytes, 14, 4);
		const uint64_t colours = littleEndian(m_bytes, 46, 4);
		m_palette_size = m_bits != 8 ? 0 : colours > 0 ? colours : 256;
		if ((m_bits != 8 && m_bits != 24 && m_bits != 32) || littleEndian(m_bytes, 30, 4) != 0 ||
			palette_at < kFileHeader + kHeader || m_palette_size > 256 || m_rows_at > m_bytes.size() ||
			palette_at + 4 * m_palette_size > m_rows_at)
		{
			return false; // also: compressed
		}
		m_palette = m_bytes.substr(palette_at, 4 * m_palette_size);
		return true;
	}
	bool readRow(uint8_t* row) override
	{
		if (m_row == 0 && m_runs)
		{
			expandRuns();
		}
		const std::size_t place = m_rows_at + m_row_bytes * (m_up ? static_cast<std::size_t>(height_px) - 1 - m_row : m_row);
		if (m_bytes.size() < place || m_bytes.size() - place < m_row_bytes)
		{
			return refused("end of the file");
		}
		const std::string_view stored = m_bytes.substr(place, m_row_bytes);
		const auto stride = static_cast<std::size_t>(channels);
		m_row += 1;
		for (std::size_t x = 0; x < static_cast<std::size_t>(width_px); ++x)
		{
			std::string_view texel = stored.substr(x * m_bits / 8, m_bits / 8);
			if (m_palette_size > 0)
			{
				const std::size_t index = littleEndian(texel, 0, 1);
				if (index >= m_palette_size)
				{
					return refused("an index beyond the palette");
				}
				texel = m_palette.substr(4 * index, 3);
			}
			for (std::size_t c = 0; c < stride; ++c)
			{
				const std::size_t from = stride > 1 && c < 3 ? 2 - c : c; // blue comes first
				row[x * stride + c] = static_cast<uint8_t>(texel[from]);
			}
		}
		return true;
	}

private:
	bool refused(const char* why)
	{
		std::snprintf(m_defect.data(), m_defect.size(), "%s", why);
		return false;
	}
	// Replaces the file by its texels without run lengths, as far as they go.
	void expandRuns()
	{
		const std::size_t texel = m_bits / 8;
		const std::size_t whole = m_row_bytes * static_cast<std::size_t>(height_px);
		m_expanded.reserve(whole);
		for (std::size_t at = m_rows_at; at < m_bytes.size() && m_expanded.size() < whole;)
		{
			const uint64_t head = littleEndian(m_bytes, at, 1);
			const std::size_t count = (head & 0x7FU) + 1;
			const std::string_view stored = m_bytes.substr(at + 1, (head & 0x80U) != 0 ? texel : count * texel);
			for (std::size_t i = 0; i < ((head & 0x80U) != 0 ? count : 1U); ++i)
			{
				m_expanded += stored;
			}
			at += 1 + stored.size();
		}
		m_bytes = m_expanded;
		m_rows_at = 0;
	}

	std::string_view m_bytes;
	std::string m_expanded;
	std::string_view m_palette;     // blue, green, red and one more byte each
	std::size_t m_palette_size = 0; // colours; 0: none
	std::size_t m_rows_at = 0;
	std::size_t m_row_bytes = 0;
	std::size_t m_row = 0;
	uint64_t m_bits = 8; // per texel
	bool m_runs = false;
	bool m_up = true; // the last row is stored first
};

// Opens a file of a format known here. Returns nothing for others and for those that are broken from the start, with the defect.
std::unique_ptr<PictureReader> openedPicture(std::string_view bytes, const std::string& name, std::string& defect)
{
	if (bytes.starts_with("\x89PNG\r\n\x1A\n"))
	{
		auto png = std::make_unique<PngReader>(bytes);
		if (!png->readHeader())
		{
			defect = png->defect();
			return nullptr;
		}
		png->readTexts();
		return png;
	}
	if (bytes.starts_with("\xFF\xD8\xFF"))
	{
		auto jpeg = std::make_unique<JpegReader>(bytes, name);
		const bool begins = jpeg->readHeader();
		defect = jpeg->defect();
		return begins && (jpeg->channels == 1 || jpeg->channels == 3) ? std::move(jpeg) : nullptr; // not CMYK
	}
	const bool is_tga = lowered(name).ends_with(".tga");
	auto raster = std::make_unique<RasterReader>(bytes);
	return (bytes.starts_with("BM") ? raster->readBmpHeader() : is_tga && raster->readTgaHeader()) ? std::move(raster) : nullptr;
}

// The number that the value at that place of a row stands for.
float valueAt(const std::vector<uint8_t>& row, std::size_t i, int bits)
{
	return bits == 16 ? static_cast<float>(row[2 * i] << 8U | row[2 * i + 1]) * (1.0F / 65535.0F)
					  : static_cast<float>(row[i]) * (1.0F / 255.0F);
}

bool looksExr(std::string_view bytes)
{
	return bytes.starts_with("\x76\x2F\x31\x01");
}

Decoded<Image> decoded(const std::string& bytes, const std::string& name)
{
	if (looksExr(bytes))
	{
		return decodeExr(bytes, name);
	}
	Decoded<Image> answer;
	const std::unique_ptr<PictureReader> reader = openedPicture(bytes, name, answer.defect);
	if (reader == nullptr)
	{
		return answer;
	}
	const std::size_t texels = checkedTexels(reader->width_px, reader->height_px, reader->channels, kMaxTexels, name, "");
	Image image;
	image.notes = std::move(reader->texts);
	image.width_px = reader->width_px;
	image.height_px = reader->height_px;
	image.cropped = reader->cropped;
	constexpr std::array<const char*, 4> kNames{"Y", "YA", "RGB", "RGBA"};
	for (const char* letter = kNames[static_cast<std::size_t>(reader->channels - 1)]; *letter != '\0'; ++letter)
	{
		image.channels.emplace_back(1, *letter);
	}
	image.halves.resize(image.channels.size(), 0);
	const std::size_t count = image.channels.size() * static_cast<std::size_t>(image.width_px);
	image.values.reserve(texels * image.channels.size());
	std::vector<uint8_t> row(count * static_cast<std::size_t>(reader->bits / 8));
	for (int y = 0; y < image.height_px; ++y)
	{
		if (!reader->readRow(row.data()))
		{
			answer.defect = reader->defect();
			return answer;
		}
		for (std::size_t i = 0; i < count; ++i)
		{
			image.values.push_back(valueAt(row, i, reader->bits));
		}
	}
	answer.image = std::move(image);
	return answer;
}

Decoded<AlphaImage> decodedAlpha(std::string_view bytes, const EncodedAlpha& picture, std::size_t max_texels)
{
	if (isKtx2(bytes) || looksExr(bytes))
	{
		return (isKtx2(bytes) ? alphaOfKtx2 : alphaOfExr)(bytes, picture, max_texels);
	}
	Decoded<AlphaImage> answer;
	const std::unique_ptr<PictureReader> reader = openedPicture(bytes, picture.name, answer.defect);
	if (reader == nullptr)
	{
		return answer;
	}
	const auto channels = static_cast<std::size_t>(reader->channels);
	std::vector<uint8_t> row;
	const auto readRow = [&](ChannelPlace place, std::vector<uint8_t>& values)
	{
		const auto first = static_cast<std::size_t>(place.first);
		const auto count = static_cast<std::size_t>(place.count);
		row.resize(static_cast<std::size_t>(reader->width_px) * channels * static_cast<std::size_t>(reader->bits / 8));
		const bool whole = reader->readRow(row.data());
		for (std::size_t i = 0; i < values.size(); ++i)
		{
			const std::size_t at = i / count * channels + first + i % count;
			values[i] = reader->bits == 16 ? byteOf(valueAt(row, at, 16)) : row[at];
		}
		return whole;
	};
	answer.image = readAlpha({reader->width_px, reader->height_px, reader->channels, channels % 2 == 0 ? reader->channels - 1 : -1},
							 picture, max_texels, readRow);
	answer.defect = reader->defect();
	return answer;
}

} // namespace
} // namespace nook

int main(int argc, char** argv)
{
	using namespace nook;
	static constexpr WorkerFunction kFunctions[]{{kEncode, encodeExr},
												 {kDecode,
												  [](ValueReader& from, ValueWriter& answer)
												  {
													  answerImage(from, answer, decoded);
												  }},
												 {kDecodeAlphas, [](ValueReader& from, ValueWriter& answer)
												  {
													  answerAlphas(from, answer, decodedAlpha);
												  }}};
	return serveRequests(argc, argv, kFunctions);
}
