// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Khronos Group, "Khronos Data Format Specification 1.3", section 20.4, BC4.
#include "bake/texture.h"

#include "core/image.h"
#include "core/lists.h"
#include "format/arrays.h"

#include <algorithm>
#include <cmath>

namespace nook
{
namespace
{

// Blocks of 4 × 4 texels: the greatest and the least value, and which of eight between them each texel has.
std::string blocksOf(const std::vector<float>& texels, std::size_t size)
{
	std::string bytes;
	for (std::size_t i = 0, across = (size + 3) / 4; i < across * across; ++i)
	{
		const auto valueAt = [&](std::size_t j)
		{
			const std::size_t x = std::min(i % across * 4 + j % 4, size - 1);
			const std::size_t y = std::min(i / across * 4 + j / 4, size - 1);
			return 255.0F * std::clamp(texels[y * size + x], 0.0F, 1.0F);
		};
		const std::vector<float> values = listOf(16, valueAt);
		const auto [least, most] = std::minmax_element(values.begin(), values.end());
		const auto low = std::lround(*least);
		const auto high = std::lround(*most);
		auto block = static_cast<uint64_t>(high) | static_cast<uint64_t>(low) << 8U;
		for (std::size_t j = 0; j < values.size() && high > low; ++j)
		{
			const float share = (static_cast<float>(high) - values[j]) / static_cast<float>(high - low);
			const auto step = static_cast<uint64_t>(std::clamp(std::lround(7.0F * share), 0L, 7L));
			block |= (step == 0 ? 0 : step == 7 ? 1 : step + 1) << (16 + 3 * j); // the least is number 1
		}
		for (unsigned shift = 0; shift < 64; shift += 8)
		{
			bytes += static_cast<char>(block >> shift & 255U);
		}
	}
	return bytes;
}

// The next mipmap: each texel is the mean of those that it covers, at least partly.
std::vector<float> halved(const std::vector<float>& texels, std::size_t size)
{
	const std::size_t half = size / 2;
	const auto meanAt = [&](std::size_t i)
	{
		float sum = 0.0F;
		float count = 0.0F;
		for (std::size_t y = i / half * size / half; y * half < (i / half + 1) * size; ++y)
		{
			for (std::size_t x = i % half * size / half; x * half < (i % half + 1) * size; ++x)
			{
				sum += texels[y * size + x];
				count += 1.0F;
			}
		}
		return sum / count;
	};
	return listOf(half * half, meanAt);
}

} // namespace

std::string textureFile(const TextureBake& bake, std::string_view ending, std::string_view writer)
{
	if (ending == ".png")
	{
		return pngBytes(bake.size_px, bake.size_px,
						listOf(3 * bake.values.size(), [&](std::size_t i) { return bake.values[i / 3]; }), {});
	}
	if (ending == ".exr")
	{
		Image image;
		image.width_px = image.height_px = bake.size_px;
		image.channels = {"Y"};
		image.values = bake.texels;
		return exrBytes(image);
	}
	Ktx2Texture texture;
	texture.texel = Ktx2Texel::bc4_unorm;
	texture.width = texture.height = static_cast<uint32_t>(bake.size_px);
	texture.notes = {{"KTXorientation", "rd"}, {"KTXswizzle", "rrr1"}, {"KTXwriter", std::string(writer)}};
	auto size = static_cast<std::size_t>(bake.size_px);
	texture.bytes = blocksOf(bake.texels, size);
	for (std::vector<float> level = bake.texels; size > 1; size /= 2)
	{
		level = halved(level, size);
		texture.mips.push_back(blocksOf(level, size / 2));
	}
	return ktx2Bytes(texture);
}

} // namespace nook
