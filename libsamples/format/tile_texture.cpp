// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/tile_texture.h"

#include "core/image.h"
#include "core/text.h"
#include "format/arrays.h"

#include <algorithm>
#include <cmath>

namespace nook
{
namespace
{

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

} // namespace

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
	for (std::size_t f = 0; f < tile.moves.size(); ++f)
	{
		texture.layout += (f == 0 ? "; moves " : " ") + std::to_string(tile.moves[f].x) + "," + std::to_string(tile.moves[f].y);
	}
	return texture;
}

std::string tileExr(const PatternTile& tile, const TileQuality& quality, const EmitContext& context)
{
	const TileTexture texture = textureOf(tile);
	return exrBytes(texture.width_px, texture.height_px, texture.rgba, textureNotes(texture, quality, context));
}

std::string tilePng(const PatternTile& tile, const TileQuality& quality, const EmitContext& context)
{
	const TileTexture texture = textureOf(tile);
	std::vector<uint16_t> numbers(texture.rgba.size());
	for (std::size_t i = 0; i < numbers.size(); ++i)
	{
		const double share = double{texture.rgba[i]} / double{texture.range[i % 4]};
		numbers[i] = static_cast<uint16_t>(32768.0 + std::floor(32767.0 * std::clamp(share, -1.0, 1.0) + 0.5));
	}
	Notes notes = textureNotes(texture, quality, context);
	std::string ranges;
	for (const float range : texture.range)
	{
		ranges += (ranges.empty() ? "" : ", ") + floatText(range);
	}
	notes.push_back({"Encoding", "value = (v - 32768) / 32767 * range, v = 0 to 65535; range of RGBA = " + ranges});
	return pngBytes(texture.width_px, texture.height_px, numbers, notes);
}

} // namespace nook
