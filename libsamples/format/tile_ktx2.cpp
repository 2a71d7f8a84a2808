// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Khronos, "KTX File Format Specification", version 2.0, and "Khronos Data Format Specification", version
// 1.3 (the basic descriptor block). All numbers are little-endian.
#include "format/tile_ktx2.h"

#include "core/bits.h"
#include "format/tile_texture.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace nook
{
namespace
{

constexpr std::string_view kIdentifier = "\xABKTX 20\xBB\r\n\x1A\n";
constexpr uint32_t kFloats = 109; // VK_FORMAT_R32G32B32A32_SFLOAT
constexpr uint32_t kTexelBytes = 16;
constexpr uint64_t kIndexEnd = 80 + 24; // the header, and the place of one level

void add(std::string& bytes, uint64_t number, int width)
{
	for (int i = 0; i < width; ++i)
	{
		bytes += static_cast<char>((number >> (8 * i)) & 0xFFU);
	}
}

void add32(std::string& bytes, uint64_t number)
{
	add(bytes, number, 4);
}

void pad(std::string& bytes, std::size_t alignment)
{
	bytes.resize((bytes.size() + alignment - 1) / alignment * alignment, '\0');
}

// Data format, section 5: four signed floats that are no colours.
std::string descriptor()
{
	std::string block;
	add32(block, 0);                                 // vendor Khronos, the basic descriptor
	add(block, 2, 2);                                // version 1.3
	add(block, 24 + 4 * 16, 2);                      // this block's bytes
	add32(block, 0x00010001);                        // RGBSDA, no primaries, linear, straight alpha
	add32(block, 0);                                 // blocks of one texel
	add(block, kTexelBytes, 8);                      // in the first plane, nothing in the other seven
	for (const uint32_t channel : {0U, 1U, 2U, 15U}) // red, green, blue, alpha
	{
		const uint32_t bit = channel == 15U ? 96 : 32 * channel;
		add32(block, bit | (31U << 16U) | ((0xC0U | channel) << 24U)); // 32 bits, a signed float
		add32(block, 0);                                               // of the texel's corner
		add32(block, bitsAs<uint32_t>(-1.0f));
		add32(block, bitsAs<uint32_t>(1.0f));
	}
	std::string bytes;
	add32(bytes, 4 + block.size());
	return bytes + block;
}

// KTX2, section 3.11: sorted by their keys, each with its length, at multiples of four bytes.
std::string keysAndValues(Notes notes)
{
	std::sort(notes.begin(), notes.end(), [](const Note& a, const Note& b) { return a.key < b.key; });
	std::string bytes;
	for (const Note& note : notes)
	{
		add32(bytes, note.key.size() + note.value.size() + 2);
		bytes += note.key + '\0' + note.value + '\0';
		pad(bytes, 4);
	}
	return bytes;
}

} // namespace

std::string tileKtx2(const PatternTile& tile, const TileQuality& quality, const EmitContext& context)
{
	const TileTexture texture = textureOf(tile, true);
	const int layers = texture.height_px / texture.layer_height_px;
	Notes notes = notesOf(context, measuresOf(quality));
	notes.push_back({"Layout", texture.layout});
	notes.push_back({"KTXorientation", "rd"}); // rows from the top
	notes.push_back({"KTXwriter", "nook " + context.version});
	const std::string format = descriptor();
	const std::string words = keysAndValues(std::move(notes));
	std::string bytes(kIdentifier);
	for (const uint64_t number :
		 {uint64_t{kFloats}, uint64_t{4}, static_cast<uint64_t>(texture.width_px), static_cast<uint64_t>(texture.layer_height_px),
		  uint64_t{0}, static_cast<uint64_t>(layers > 1 ? layers : 0), uint64_t{1}, uint64_t{1}, uint64_t{0}, kIndexEnd,
		  uint64_t{format.size()}, kIndexEnd + format.size(), uint64_t{words.size()}})
	{
		add32(bytes, number); // type size 4; depth 0 and, but for arrays, layers 0: it has none; one face, one level, as it stands
	}
	add(bytes, 0, 8); // no data of a supercompression, from nowhere
	add(bytes, 0, 8);
	const uint64_t texels = (kIndexEnd + format.size() + words.size() + kTexelBytes - 1) / kTexelBytes * kTexelBytes;
	for (const uint64_t number : {texels, uint64_t{4 * texture.rgba.size()}, uint64_t{4 * texture.rgba.size()}})
	{
		add(bytes, number, 8);
	}
	bytes += format + words;
	pad(bytes, kTexelBytes);
	for (const float value : texture.rgba)
	{
		add32(bytes, bitsAs<uint32_t>(value));
	}
	return bytes;
}

} // namespace nook
