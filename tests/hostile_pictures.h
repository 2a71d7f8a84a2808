// SPDX-License-Identifier: GPL-3.0-or-later
// Small picture files with large demands: many pixels in few bytes, or very many attributes.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace nook
{

inline void appendBigEndian(std::string& bytes, uint32_t value)
{
	for (const unsigned shift : {24U, 16U, 8U, 0U})
	{
		bytes.push_back(static_cast<char>(static_cast<unsigned char>(value >> shift)));
	}
}

// Bits of a deflate stream: numbers start with their lowest bit, codes with their highest.
class DeflateBits
{
public:
	void number(uint32_t value, unsigned bits)
	{
		for (unsigned i = 0; i < bits; ++i)
		{
			bit((value >> i) & 1U);
		}
	}
	void code(uint32_t value, unsigned bits)
	{
		for (unsigned i = bits; i > 0; --i)
		{
			bit((value >> (i - 1U)) & 1U);
		}
	}
	std::string whole()
	{
		number(0, (8U - m_bits) % 8U);
		return m_bytes;
	}

private:
	void bit(uint32_t value)
	{
		m_byte = static_cast<uint8_t>(m_byte | (value << m_bits));
		m_bits += 1;
		if (m_bits == 8)
		{
			m_bytes.push_back(static_cast<char>(m_byte));
			m_byte = 0;
			m_bits = 0;
		}
	}

	std::string m_bytes;
	uint8_t m_byte = 0;
	unsigned m_bits = 0;
};

// A zlib stream of `count` zeros with fixed Huffman codes: 13 bits repeat the previous byte 258 times.
inline std::string zlibZeros(uint64_t count)
{
	DeflateBits bits;
	bits.number(1, 1); // last block
	bits.number(1, 2); // with fixed codes
	uint64_t left = count;
	const auto zero = [&]
	{
		bits.code(0x30, 8);
		left -= 1;
	};
	zero();
	while (left >= 258)
	{
		bits.code(0xC5, 8); // match of length 258
		bits.code(0, 5);    // at distance 1
		left -= 258;
	}
	while (left > 0)
	{
		zero();
	}
	bits.code(0, 7); // end of block
	std::string stream = "\x78\x01" + bits.whole();
	appendBigEndian(stream, static_cast<uint32_t>(count % 65521U) << 16U | 1U); // Adler checksum of zeros
	return stream;
}

inline uint32_t crc32Of(std::string_view bytes)
{
	uint32_t crc = ~0U;
	for (const char byte : bytes)
	{
		crc ^= static_cast<unsigned char>(byte);
		for (int i = 0; i < 8; ++i)
		{
			crc = crc >> 1U ^ (0xEDB88320U & (0U - (crc & 1U)));
		}
	}
	return ~crc;
}

inline void appendPngChunk(std::string& png, std::string_view type, std::string_view data)
{
	appendBigEndian(png, static_cast<uint32_t>(data.size()));
	const std::string body = std::string(type) + std::string(data);
	png += body;
	appendBigEndian(png, crc32Of(body));
}

// A PNG of zeros with `channels` values of `bits` bits per pixel.
inline std::string zerosPng(uint32_t width_px, uint32_t height_px, char bits, char colour_type, uint32_t channels)
{
	std::string head;
	appendBigEndian(head, width_px);
	appendBigEndian(head, height_px);
	head += {bits, colour_type, 0, 0, 0};
	std::string png = "\x89PNG\r\n\x1A\n";
	appendPngChunk(png, "IHDR", head);
	const uint64_t row_bits = uint64_t{width_px} * channels * static_cast<uint64_t>(bits);
	appendPngChunk(png, "IDAT", zlibZeros(uint64_t{height_px} * (1 + (row_bits + 7) / 8)));
	appendPngChunk(png, "IEND", "");
	return png;
}

// Black pixels with one bit each: 1600 pixels per byte of the file.
inline std::string blackPng(uint32_t width_px, uint32_t height_px)
{
	return zerosPng(width_px, height_px, 1, 0, 1);
}

// A complete OpenEXR of one pixel at 1 m with that many text attributes.
inline std::string textsExr(int count)
{
	std::string exr("\x76\x2F\x31\x01\x02\x00\x00\x00", 8);
	const auto number = [&exr](auto value)
	{
		std::array<char, sizeof value> raw{};
		std::memcpy(raw.data(), &value, sizeof value);
		exr.append(raw.data(), raw.size());
	};
	const auto attribute = [&](const std::string& name, const char* type, int32_t size)
	{
		exr += name + '\0' + type + '\0';
		number(size);
	};
	attribute("channels", "chlist", 19);
	exr += std::string("Z\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0", 19); // Z, 32-bit floats, no subsampling; end of list
	attribute("compression", "compression", 1);
	exr.push_back('\0');
	for (const char* const window : {"dataWindow", "displayWindow"})
	{
		attribute(window, "box2i", 16);
		exr.append(16, '\0');
	}
	attribute("lineOrder", "lineOrder", 1);
	exr.push_back('\0');
	attribute("pixelAspectRatio", "float", 4);
	number(1.0F);
	attribute("screenWindowCenter", "v2f", 8);
	exr.append(8, '\0');
	attribute("screenWindowWidth", "float", 4);
	number(1.0F);
	for (int i = 0; i < count; ++i)
	{
		attribute("text" + std::to_string(i), "string", 4);
		exr += "some";
	}
	exr.push_back('\0');
	number(uint64_t{exr.size()} + 8); // start of the only line
	number(int32_t{0});
	number(int32_t{4});
	number(1.0F);
	return exr;
}

} // namespace nook
