// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Khronos, "KTX File Format Specification", version 2.0, and "Khronos Data Format Specification", version
// 1.3 (the basic descriptor block). All numbers are little-endian.
#include "format/ktx2.h"

#include "core/round.h"

#include <algorithm>
#include <string_view>

namespace nook
{
namespace
{

constexpr std::string_view kIdentifier = "\xABKTX 20\xBB\r\n\x1A\n";
constexpr uint64_t kIndexEnd = 80 + 24; // the header and the index of one level

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

// Properties of a texel format.
struct TexelFacts
{
	uint32_t format;    // VkFormat
	uint32_t type_size; // bytes per value
	uint32_t flags;     // channel flags: signed and float, or none
	uint32_t least;     // stored value of −1 or 0
	uint32_t most;      // stored value of 1
};

TexelFacts factsOf(Ktx2Texel texel)
{
	return texel == Ktx2Texel::rgba32_float ? TexelFacts{109, 4, 0xC0U, bitsAs<uint32_t>(-1.0f), bitsAs<uint32_t>(1.0f)}
											: TexelFacts{37, 1, 0U, 0U, 255U};
}

// Data format, section 5: four channels that are not colours.
std::string descriptor(const TexelFacts& facts)
{
	const uint32_t bits = 8 * facts.type_size;
	std::string block;
	add32(block, 0);                                 // vendor Khronos, the basic descriptor
	add(block, 2, 2);                                // version 1.3
	add(block, 24 + 4 * 16, 2);                      // size of this block in bytes
	add32(block, 0x00010001);                        // RGBSDA, no primaries, linear, straight alpha
	add32(block, 0);                                 // blocks of one texel
	add(block, 4 * facts.type_size, 8);              // first plane; the other seven are empty
	for (const uint32_t channel : {0U, 1U, 2U, 15U}) // red, green, blue, alpha
	{
		const uint32_t bit = channel == 15U ? 3 * bits : bits * channel;
		add32(block, bit | ((bits - 1) << 16U) | ((facts.flags | channel) << 24U));
		add32(block, 0); // sample position: the texel's corner
		add32(block, facts.least);
		add32(block, facts.most);
	}
	std::string bytes;
	add32(bytes, 4 + block.size());
	return bytes + block;
}

// KTX2, section 3.11: sorted by key, each entry prefixed with its length and aligned to four bytes.
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

std::string ktx2Bytes(const Ktx2Texture& texture)
{
	const TexelFacts facts = factsOf(texture.texel);
	const uint64_t texel_bytes = 4 * uint64_t{facts.type_size};
	const std::string format = descriptor(facts);
	const std::string words = keysAndValues(texture.notes);
	std::string bytes(kIdentifier);
	for (const uint64_t number :
		 {uint64_t{facts.format}, uint64_t{facts.type_size}, uint64_t{texture.width}, uint64_t{texture.height},
		  uint64_t{texture.depth}, uint64_t{texture.layers}, uint64_t{1}, uint64_t{1}, uint64_t{0}, kIndexEnd,
		  uint64_t{format.size()}, kIndexEnd + format.size(), uint64_t{words.size()}})
	{
		add32(bytes, number); // one face, one level, no supercompression
	}
	add(bytes, 0, 8); // no supercompression data
	add(bytes, 0, 8);
	const uint64_t texels = (kIndexEnd + format.size() + words.size() + texel_bytes - 1) / texel_bytes * texel_bytes;
	for (const uint64_t number : {texels, uint64_t{texture.bytes.size()}, uint64_t{texture.bytes.size()}})
	{
		add(bytes, number, 8);
	}
	bytes += format + words;
	pad(bytes, static_cast<std::size_t>(texel_bytes));
	return bytes + texture.bytes;
}

} // namespace nook
