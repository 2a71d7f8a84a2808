// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures that act as masks → alpha; materials and cameras as the level has them.
#include "scene/load_parts.h"

#include "core/error.h"
#include "core/file.h"
#include "core/image.h"
#include "core/isolate.h"

#include <filesystem>

namespace nook
{
namespace
{

// A picture is not decoded as floats of all its channels, so that this is what 16384 × 16384 pixels need.
constexpr std::size_t kMaxPixels = std::size_t{1} << 28U;
constexpr std::size_t kDecodingMemory = std::size_t{1} << 30U;
constexpr int kDecodingTime_s = 60;

std::string encodedBytes(const MaskSource& source, const std::string& level_path)
{
	if (source.path.empty())
	{
		return source.bytes;
	}
	std::error_code failed;
	if (!std::filesystem::is_regular_file(source.path, failed))
	{
		throw Error(ExitCode::file, level_path + ": found no file " + source.path + ", expected the mask of a material");
	}
	return readFile(source.path);
}

Mask decoded(const MaskSource& source, const std::string& level_path)
{
	Mask mask;
	mask.name = source.name;
	mask.wrap_u = source.wrap_u;
	mask.wrap_v = source.wrap_v;
	const std::string bytes = encodedBytes(source, level_path);
	const std::string name = source.path.empty() ? level_path + ": " + source.name : source.path;
	isolate(
		name, {kDecodingMemory, kDecodingTime_s},
		[&](IsolatedWriter& to)
		{
			const AlphaImage image = decodeAlpha(bytes, name, source.scalar);
			to.value(image.width_px);
			to.value(image.height_px);
			to.values(image.alpha);
		},
		[&](IsolatedReader& from)
		{
			mask.width_px = from.value<int>();
			mask.height_px = from.value<int>();
			from.values(mask.alpha, kMaxPixels);
		});
	return mask;
}

} // namespace

void finishMaterials(LevelSource& source, Level& level)
{
	const std::string& path = source.files.front();
	for (const MaskSource& mask : source.masks)
	{
		level.masks.push_back(decoded(mask, path));
		if (!mask.path.empty())
		{
			addFile(source.files, mask.path);
		}
	}
	for (const SourceMaterial& from : source.materials)
	{
		Material& material = level.material_list.emplace_back(from.material);
		material.mask = from.mask;
		measureAlpha(material, level.masks);
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
