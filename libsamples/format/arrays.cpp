// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/arrays.h"

#include "core/error.h"
#include "core/image.h"
#include "core/lists.h"
#include "core/round.h"
#include "format/tile_json.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace nook
{
namespace
{

float toFloat(double value)
{
	return static_cast<float>(value);
}

std::string stemOf(const EmitContext& context, const std::string& derived)
{
	if (context.name.empty())
	{
		return "nook_" + derived;
	}
	refuseIf(!isIdentifier(context.name),
			 "name: found " + jsonText(context.name) + ", expected letters, digits and single underscores, a letter first");
	return context.name;
}

// Macros share one global namespace, so all begin with NOOK_.
std::string macroStem(const std::string& stem)
{
	std::string macro = stem;
	std::transform(macro.begin(), macro.end(), macro.begin(),
				   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
	return macro.starts_with("NOOK_") ? macro : "NOOK_" + macro;
}

std::string sampleComment(Domain domain)
{
	switch (domain)
	{
	case Domain::disk: return "x, y, half length of the line sqrt(1 - x^2 - y^2), weight; the weights sum to 1";
	case Domain::ball: return "x, y, z in the unit ball, weight; the weights sum to 1";
	case Domain::sphere: return "unit direction x, y, z, weight; the weights sum to 1";
	case Domain::hemisphere: return "unit direction x, y, z with z >= 0 (cosine-weighted), weight; the weights sum to 1";
	case Domain::slice: return "azimuth in half turns and jitter in steps, both in [0, 1), 0, weight; the weights are equal";
	}
	return {};
}

void setTexel(TileTexture& texture, int x, int y, const Sample& sample)
{
	const std::size_t at =
		4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width_px) + static_cast<std::size_t>(x));
	std::copy(sample.begin(), sample.end(), texture.rgba.begin() + static_cast<std::ptrdiff_t>(at));
}

// 1 for channels within −1…1; for scales and weights, given by index, their greatest value.
void setRange(TileTexture& texture, std::size_t channel)
{
	texture.range = {1.0f, 1.0f, 1.0f, 1.0f};
	float greatest = 0.0f;
	for (std::size_t i = channel; i < texture.rgba.size(); i += 4)
	{
		greatest = std::max(greatest, std::fabs(texture.rgba[i]));
	}
	texture.range[channel] = greatest > 0.0f ? greatest : 1.0f;
}

Notes textureNotes(const TileTexture& texture, const TileQuality& quality, const EmitContext& context)
{
	Notes notes = notesOf(context, measuresOf(quality));
	notes.push_back({"Layout", texture.layout});
	return notes;
}

// This work is based on: Khronos, "KTX File Format Specification", version 2.0, and "Khronos Data Format Specification", version
// 1.3 (the basic descriptor block). All numbers are little-endian.

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
	uint32_t bytes;     // per texel or block
	uint32_t flags;     // channel flags: signed and float, or none
	uint32_t least;     // stored value of −1 or 0
	uint32_t most;      // stored value of 1
};

TexelFacts factsOf(Ktx2Texel texel)
{
	return texel == Ktx2Texel::rgba32_float  ? TexelFacts{109, 4, 16, 0xC0U, bitsAs<uint32_t>(-1.0f), bitsAs<uint32_t>(1.0f)}
		   : texel == Ktx2Texel::rgba8_unorm ? TexelFacts{37, 1, 4, 0U, 0U, 255U}
											 : TexelFacts{139, 1, 8, 0U, 0U, ~0U};
}

// Data format, section 5: four channels that are not colours, or one of blocks.
std::string descriptor(const TexelFacts& facts, bool is_block)
{
	const uint32_t bits = is_block ? 64 : 8 * facts.type_size;
	const std::vector<uint32_t> channels = is_block ? std::vector<uint32_t>{0U} : std::vector<uint32_t>{0U, 1U, 2U, 15U};
	std::string block;
	add32(block, 0);                                  // vendor Khronos, the basic descriptor
	add(block, 2, 2);                                 // version 1.3
	add(block, 24 + channels.size() * 16, 2);         // size of this block in bytes
	add32(block, is_block ? 0x00010083 : 0x00010001); // BC4 or RGBSDA, no primaries, linear, straight alpha
	add32(block, is_block ? 0x0303 : 0);              // blocks of 4 x 4 texels or of one
	add(block, facts.bytes, 8);                       // first plane; the other seven are empty
	for (const uint32_t channel : channels)           // red, green, blue, alpha
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

std::vector<Sample> samplesOf(const Pattern& pattern)
{
	const auto sampleOf = [&pattern](std::size_t i)
	{
		const glm::dvec3& p = pattern.points[i];
		const double third = pattern.domain == Domain::disk ? std::sqrt(std::max(0.0, 1.0 - p.x * p.x - p.y * p.y)) : p.z;
		return Sample{toFloat(p.x), toFloat(p.y), toFloat(third), toFloat(pattern.weights[i])};
	};
	return listOf(pattern.count(), sampleOf);
}

const char* columnsOf(Domain domain)
{
	return domain == Domain::disk    ? "x,y,half_length,weight"
		   : domain == Domain::slice ? "azimuth,jitter,zero,weight"
									 : "x,y,z,weight";
}

std::vector<Sample> transformsOf(const PatternTile& tile)
{
	const auto sampleOf = [&tile](const TileTransform& t)
	{
		return tile.domain == Domain::ball ? Sample{toFloat(t.axis.x), toFloat(t.axis.y), toFloat(t.axis.z), toFloat(t.scale)}
										   : Sample{toFloat(t.cos), toFloat(t.sin), toFloat(t.scale), toFloat(t.handedness)};
	};
	return mapped(tile.transforms, sampleOf);
}

const char* transformColumnsOf(Domain domain)
{
	return domain == Domain::ball ? "x,y,z,scale" : "cos,sin,scale,handedness";
}

std::string variantText(const PatternTile& tile, const std::string& side)
{
	const bool moves = !tile.moves.empty();
	const std::string own = moves ? "((y + move.y) % " + side + ") * " + side + " + (x + move.x) % " + side
								  : "(y % " + side + ") * " + side + " + x % " + side;
	const std::string frame = "frame % " + std::to_string(tile.frames);
	return own + (moves ? ", move that of " + frame : tile.frames > 1 ? " + (" + frame + ") * " + side + " * " + side : "");
}

Source sourceOf(const Pattern& pattern, const Recipe* recipe, const Quality& quality, const EmitContext& context)
{
	const std::string stem = stemOf(context, shortName(pattern.domain, pattern.count(), recipe));
	const std::string macro = macroStem(stem);
	Source source;
	source.notes = notesOf(context, measuresOf(quality));
	source.guard = macro;
	source.constants.push_back({macro + "_COUNT", static_cast<int>(pattern.count()), "samples"});
	source.arrays.push_back({stem + "_points", macro + "_COUNT", sampleComment(pattern.domain), samplesOf(pattern)});
	return source;
}

Source sourceOf(const PatternTile& tile, const TileQuality& quality, const EmitContext& context)
{
	const std::size_t count = tile.variants.front().count();
	const std::string size = std::to_string(tile.size);
	const std::string stem = stemOf(context, shortName(tile.domain, count, nullptr) + "_tile" + size);
	const std::string macro = macroStem(stem);
	Source source;
	source.notes = notesOf(context, measuresOf(quality));
	source.guard = macro;
	const int variants = static_cast<int>(tile.variants.size());
	source.constants.push_back({macro + "_SIZE", tile.size, "pixels along a side of the window"});
	source.constants.push_back({macro + "_VARIANTS", variants, "variant of a pixel = " + variantText(tile, "SIZE")});
	if (tile.frames > 1)
	{
		source.constants.push_back({macro + "_FRAMES", tile.frames, "of a cycle"});
	}
	if (!tile.moves.empty())
	{
		SourceArray moves{stem + "_moves", macro + "_FRAMES", "pixels x, y that the tile moves by in each frame", {}};
		moves.rows = mapped(tile.moves,
							[](const glm::ivec2& move) {
								return Sample{static_cast<float>(move.x), static_cast<float>(move.y), 0.0f, 0.0f};
							});
		source.arrays.push_back(std::move(moves));
	}
	source.constants.push_back({macro + "_COUNT", static_cast<int>(count), "samples of a variant"});
	source.constants.push_back({macro + "_TOTAL", variants * static_cast<int>(count), "samples of all variants"});
	if (!tile.transforms.empty())
	{
		const bool ball = tile.domain == Domain::ball;
		source.arrays.push_back(
			{stem + "_transforms", macro + "_VARIANTS",
			 ball ? "reflects the base pattern about this direction: x, y, z, scale; one a variant"
				  : "turns the base pattern: cos c, sin s, scale k, handedness h: k (c x - s h y, s x + c h y); one a variant",
			 transformsOf(tile)});
	}
	SourceArray points{
		stem + "_points", macro + "_TOTAL", sampleComment(tile.domain) + " in each variant; index = variant * COUNT + sample", {}};
	for (const Pattern& variant : tile.variants)
	{
		append(points.rows, samplesOf(variant));
	}
	source.arrays.push_back(std::move(points));
	return source;
}

TileTexture textureOf(const PatternTile& tile, bool layered)
{
	TileTexture texture;
	const std::string size = std::to_string(tile.size);
	const auto allocate = [&](int width_px, int height_px)
	{
		texture.width_px = width_px;
		texture.height_px = height_px;
		texture.layer_height_px = height_px;
		texture.rgba.resize(4 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
	};
	if (!tile.transforms.empty())
	{
		allocate(tile.size, tile.size);
		const std::vector<Sample> transforms = transformsOf(tile);
		for (int i = 0; i < tile.size * tile.size; ++i)
		{
			setTexel(texture, i % tile.size, i / tile.size, transforms[static_cast<std::size_t>(i)]);
		}
		setRange(texture, tile.domain == Domain::ball ? 3 : 2);
		texture.layout = "texel = (x mod " + size + ", y mod " + size + "); RGBA = " + transformColumnsOf(tile.domain);
		return texture;
	}
	const int count = static_cast<int>(tile.variants.front().count());
	const int variants = static_cast<int>(tile.variants.size());
	const int layers = layered ? layersOf(tile) : 1;
	allocate(variants / layers, count * layers);
	texture.layer_height_px = count;
	for (int v = 0; v < variants; ++v)
	{
		const std::vector<Sample> samples = samplesOf(tile.variants[static_cast<std::size_t>(v)]);
		for (int i = 0; i < count; ++i)
		{
			setTexel(texture, v % texture.width_px, v / texture.width_px * count + i, samples[static_cast<std::size_t>(i)]);
		}
	}
	setRange(texture, 3);
	PatternTile one_layer; // to describe
	one_layer.frames = layers > 1 ? 1 : tile.frames;
	one_layer.moves = tile.moves;
	std::string variant = variantText(one_layer, size);
	for (std::size_t at = variant.find(" % "); at != std::string::npos; at = variant.find(" % "))
	{
		variant.replace(at, 3, " mod ");
	}
	texture.layout = "column = variant = " + variant + (layers > 1 ? ", layer = frame mod " + std::to_string(layers) : "") +
					 ", row = sample; RGBA = " + columnsOf(tile.domain);
	texture.layout += tile.moves.empty() ? "" : "; moves ";
	texture.layout +=
		joinedText(tile.moves, " ", [](const glm::ivec2& move) { return std::to_string(move.x) + "," + std::to_string(move.y); });
	return texture;
}

std::string tileExr(const PatternTile& tile, const TileQuality& quality, const EmitContext& context)
{
	TileTexture texture = textureOf(tile);
	const Notes notes = textureNotes(texture, quality, context);
	return exrBytes({texture.width_px, texture.height_px, {"R", "G", "B", "A"}, std::move(texture.rgba), notes, {}}, "none");
}

std::string tilePng(const PatternTile& tile, const TileQuality& quality, const EmitContext& context)
{
	const TileTexture texture = textureOf(tile);
	const auto numberOf = [&texture](std::size_t i)
	{
		const double share = double{texture.rgba[i]} / double{texture.range[i % 4]};
		return static_cast<uint16_t>(32768.0 + std::floor(32767.0 * std::clamp(share, -1.0, 1.0) + 0.5));
	};
	const std::vector<uint16_t> numbers = listOf(texture.rgba.size(), numberOf);
	Notes notes = textureNotes(texture, quality, context);
	const std::string ranges = joinedText(texture.range, ", ", [](float range) { return floatText(range); });
	notes.push_back({"Encoding", "value = (v - 32768) / 32767 * range, v = 0 to 65535; range of RGBA = " + ranges});
	return pngBytes(texture.width_px, texture.height_px, numbers, notes);
}

std::string tileKtx2(const PatternTile& tile, const TileQuality& quality, const EmitContext& context)
{
	const TileTexture texture = textureOf(tile, true);
	const int layers = texture.height_px / texture.layer_height_px;
	Ktx2Texture made;
	made.width = static_cast<uint32_t>(texture.width_px);
	made.height = static_cast<uint32_t>(texture.layer_height_px);
	made.layers = static_cast<uint32_t>(layers > 1 ? layers : 0);
	made.notes = textureNotes(texture, quality, context);
	made.notes.push_back({"KTXorientation", "rd"}); // rows from the top
	made.notes.push_back({"KTXwriter", "nook " + context.version});
	made.bytes.reserve(4 * texture.rgba.size());
	for (const float value : texture.rgba)
	{
		add32(made.bytes, bitsAs<uint32_t>(value));
	}
	return ktx2Bytes(made);
}

std::string ktx2Bytes(const Ktx2Texture& texture)
{
	const TexelFacts facts = factsOf(texture.texel);
	const std::string format = descriptor(facts, texture.texel == Ktx2Texel::bc4_unorm);
	const uint64_t head_end = kIndexEnd + 24 * texture.mips.size();
	const std::string words = keysAndValues(texture.notes);
	std::string bytes(kIdentifier);
	for (const uint64_t number :
		 {uint64_t{facts.format}, uint64_t{facts.type_size}, uint64_t{texture.width}, uint64_t{texture.height},
		  uint64_t{texture.depth}, uint64_t{texture.layers}, uint64_t{1}, uint64_t{1 + texture.mips.size()}, uint64_t{0}, head_end,
		  uint64_t{format.size()}, head_end + format.size(), uint64_t{words.size()}})
	{
		add32(bytes, number); // one face, no supercompression
	}
	add(bytes, 0, 8); // no supercompression data
	add(bytes, 0, 8);
	std::string levels(static_cast<std::size_t>(head_end) + format.size() + words.size(), '\0'); // the smallest comes first
	std::vector<std::size_t> begins(1 + texture.mips.size());
	for (std::size_t i = begins.size(); i-- > 0;)
	{
		pad(levels, facts.bytes);
		begins[i] = levels.size();
		levels += i == 0 ? texture.bytes : texture.mips[i - 1];
	}
	for (std::size_t i = 0; i < begins.size(); ++i)
	{
		const std::size_t size = i == 0 ? texture.bytes.size() : texture.mips[i - 1].size();
		for (const std::size_t number : {begins[i], size, size})
		{
			add(bytes, number, 8);
		}
	}
	bytes += format + words;
	return bytes + levels.substr(bytes.size());
}

} // namespace nook
