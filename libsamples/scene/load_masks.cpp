// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures that act as masks → alpha; materials and cameras as the level has them.
#include "scene/load_parts.h"

#include "core/error.h"
#include "core/file.h"
#include "core/image.h"
#include "core/isolate.h"

#include <filesystem>
#include <unordered_map>

namespace nook
{
namespace
{

// Of one mask, and of all that a level has: 16384 x 16384 pixels, four times over. A megabyte of PNG can hold the first.
constexpr std::size_t kMaxPixels = std::size_t{1} << 28U;
constexpr std::size_t kMaxPixelsInAll = 4 * kMaxPixels;

// A picture is not decoded as floats of all its channels, so that this is what the largest needs.
constexpr std::size_t kDecodingMemory = std::size_t{1} << 30U;

// Processor time: what small pictures never come near, and a tenth of the slowest rate measured (PNG).
constexpr int kTimeFloor_s = 60;
constexpr std::size_t kBytesPerSecond = 200000;

// Bytes of the masks as they are stored; refuses one that is not there.
std::size_t storedBytes(const LevelSource& source, const std::string& level_path)
{
	std::size_t bytes = 0;
	for (const MaskSource& mask : source.masks)
	{
		std::error_code failed;
		if (!mask.path.empty() && !std::filesystem::is_regular_file(mask.path, failed))
		{
			throw Error(ExitCode::file, level_path + ": found no file " + mask.path + ", expected the mask of a material");
		}
		const std::uintmax_t size = mask.path.empty() ? mask.bytes.size() : std::filesystem::file_size(mask.path, failed);
		bytes += failed ? 0 : static_cast<std::size_t>(size);
	}
	return bytes;
}

// For each mask the first one of the same picture: only the wrap modes differ.
std::vector<std::size_t> firstOfPictures(const LevelSource& source)
{
	std::unordered_map<std::string, std::size_t> firsts;
	std::vector<std::size_t> first;
	for (std::size_t i = 0; i < source.masks.size(); ++i)
	{
		first.push_back(firsts.try_emplace(source.masks[i].path + '\n' + source.masks[i].name, i).first->second);
	}
	return first;
}

// All in one child process: thousands of small pictures would take their time to start one each.
void decodeMasks(const LevelSource& source, Level& level)
{
	const std::string& path = source.files.front();
	const std::size_t stored = storedBytes(source, path);
	const std::vector<std::size_t> first = firstOfPictures(source);
	const auto nameOf = [&](std::size_t i)
	{
		const MaskSource& mask = source.masks[i];
		return mask.path.empty() ? path + ": " + mask.name : mask.path;
	};
	loadImageCodec();
	std::string name; // of the picture that is being decoded
	std::size_t pixels = 0;
	const auto work = [&](IsolatedWriter& to)
	{
		for (std::size_t i = 0; i < source.masks.size(); ++i)
		{
			if (first[i] == i)
			{
				const MaskSource& mask = source.masks[i];
				const AlphaImage image = decodeAlpha(mask.path.empty() ? mask.bytes : readFile(mask.path), nameOf(i), mask.scalar);
				to.value(image.width_px);
				to.value(image.height_px);
				to.values(image.alpha);
			}
		}
	};
	const auto take = [&](IsolatedReader& from)
	{
		for (std::size_t i = 0; i < source.masks.size(); ++i)
		{
			name = nameOf(i);
			Mask mask;
			if (first[i] == i)
			{
				mask.width_px = from.value<int>();
				mask.height_px = from.value<int>();
				from.values(mask.alpha, kMaxPixels);
			}
			else
			{
				mask = level.masks[first[i]];
			}
			mask.name = source.masks[i].name;
			mask.wrap_u = source.masks[i].wrap_u;
			mask.wrap_v = source.masks[i].wrap_v;
			pixels += mask.alpha.size();
			if (pixels > kMaxPixelsInAll)
			{
				throw Error(ExitCode::invalid_input, path + ": found masks of more than " + std::to_string(kMaxPixelsInAll) +
														 " pixels in all, expected fewer or smaller ones");
			}
			level.masks.push_back(std::move(mask));
		}
	};
	isolate(name, {kDecodingMemory, kTimeFloor_s + static_cast<int>(stored / kBytesPerSecond)}, work, take);
}

} // namespace

void finishMaterials(LevelSource& source, Level& level)
{
	if (!source.masks.empty())
	{
		decodeMasks(source, level);
	}
	std::vector<AlphaCounts> counts;
	for (std::size_t i = 0; i < source.masks.size(); ++i)
	{
		counts.push_back(countAlpha(level.masks[i]));
		if (!source.masks[i].path.empty())
		{
			addFile(source.files, source.masks[i].path);
		}
	}
	for (const SourceMaterial& from : source.materials)
	{
		Material& material = level.material_list.emplace_back(from.material);
		material.mask = from.mask;
		measureAlpha(material, from.mask < 0 ? AlphaCounts{} : counts[static_cast<std::size_t>(from.mask)]);
	}
	if (level.material_list.empty())
	{
		level.material_list.emplace_back().name = "default";
	}
	for (uint32_t& material : level.materials)
	{
		material = material < level.material_list.size() ? material : static_cast<uint32_t>(level.material_list.size() - 1);
	}
	level.cameras = source.cameras;
	nameCameras(level.cameras);
}

} // namespace nook
