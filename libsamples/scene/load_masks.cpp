// SPDX-License-Identifier: GPL-3.0-or-later
// Decodes mask pictures and converts materials and cameras to the level's form.
#include "scene/load_parts.h"

#include "core/error.h"
#include "core/image.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <unordered_map>

namespace nook
{
namespace
{

// Rejects a file that is missing, or outside the level's folder.
void checkThere(const LoadSettings& settings, const LevelSource& source, const std::string& level_path)
{
	for (const MaskSource& mask : source.masks)
	{
		std::error_code failed;
		if (!mask.path.empty() && !std::filesystem::is_regular_file(mask.path, failed))
		{
			throw Error(ExitCode::file, level_path + ": found no file " + mask.path + ", expected the mask of a material");
		}
		if (!mask.path.empty())
		{
			checkInside(level_path, "mask '" + mask.name + "'", mask.path, settings);
		}
	}
}

void applyGain(const MaskUse& use, std::vector<uint8_t>& alpha)
{
	if (use.base == 0.0 && use.gain == 1.0)
	{
		return;
	}
	for (uint8_t& texel : alpha)
	{
		texel = static_cast<uint8_t>(255.0 * std::clamp(use.base + use.gain * (texel / 255.0), 0.0, 1.0) + 0.5);
	}
}

void decodeMasks(const LoadSettings& settings, LevelSource& source, Level& level)
{
	const std::string& path = source.files.front();
	checkThere(settings, source, path);
	std::vector<EncodedAlpha> pictures; // each channel once: masks of one channel differ only in wrap modes and gains
	std::unordered_map<std::string, std::size_t> indices;
	std::vector<std::size_t> picture_of_mask;
	for (MaskSource& mask : source.masks)
	{
		if (mask.ramp)
		{
			picture_of_mask.push_back(0);
			continue;
		}
		const std::string channel = std::to_string(static_cast<int>(mask.channel));
		const auto [found, is_new] = indices.try_emplace(channel + mask.path + '\n' + mask.name, pictures.size());
		picture_of_mask.push_back(found->second);
		if (is_new)
		{
			pictures.push_back(
				{mask.path.empty() ? path + ": " + mask.name : mask.path, mask.path, std::move(mask.bytes), mask.channel, 0});
		}
		pictures[found->second].uses += 1;
	}
	std::vector<AlphaImage> images = decodeAlphas(pictures, path, settings.max_texels);
	for (std::size_t i = 0; i < source.masks.size(); ++i)
	{
		Mask& mask = level.masks.emplace_back();
		if (source.masks[i].ramp)
		{
			mask.width_px = 256;
			mask.height_px = 1;
			mask.alpha.resize(256);
			std::iota(mask.alpha.begin(), mask.alpha.end(), uint8_t{0});
		}
		else
		{
			AlphaImage& image = images[picture_of_mask[i]];
			std::size_t& uses = pictures[picture_of_mask[i]].uses;
			uses -= 1;
			mask.width_px = image.width_px;
			mask.height_px = image.height_px;
			mask.alpha = uses > 0 ? image.alpha : std::move(image.alpha);
			applyGain(source.masks[i], mask.alpha);
		}
		mask.name = source.masks[i].name;
		mask.wrap_u = source.masks[i].wrap_u;
		mask.wrap_v = source.masks[i].wrap_v;
		mask.nearest = source.masks[i].nearest;
	}
}

// For a ramp, how many corners of its triangles have each alpha; the ramp's own values if it has no triangle.
AlphaCounts countCorners(const Level& level, const LevelSource& source, int mask)
{
	const Mask& ramp = level.masks[static_cast<std::size_t>(mask)];
	AlphaCounts counts{};
	bool any = false;
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		const uint32_t material = level.materials[i];
		for (int corner = 0; corner < 3 && material < source.materials.size() && source.materials[material].mask == mask; ++corner)
		{
			const double alpha = alphaAt(ramp, level.uvs[level.triangles[i][corner]]);
			counts[static_cast<std::size_t>(std::lround(255.0 * alpha))] += 1;
			any = true;
		}
	}
	return any ? counts : countAlpha(ramp);
}

// Removes cameras at non-finite or impossibly far positions.
void dropFarCameras(Level& level, std::vector<Finding>& findings)
{
	Tally dropped;
	std::erase_if(level.cameras,
				  [&](const LevelCamera& camera)
				  {
					  const glm::dvec3 eye(camera.world_from_camera[3]);
					  const bool far = !(std::max({std::fabs(eye.x), std::fabs(eye.y), std::fabs(eye.z)}) <= kFarthest_m);
					  if (far)
					  {
						  dropped.add("camera '" + camera.name + "'");
					  }
					  return far;
				  });
	report(findings, "far-cameras", dropped);
}

} // namespace

void finishMaterials(const LoadSettings& settings, LevelSource& source, Level& level)
{
	if (!source.masks.empty())
	{
		decodeMasks(settings, source, level);
	}
	std::vector<AlphaCounts> counts;
	for (std::size_t i = 0; i < source.masks.size(); ++i)
	{
		counts.push_back(source.masks[i].ramp ? countCorners(level, source, static_cast<int>(i)) : countAlpha(level.masks[i]));
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
	dropFarCameras(level, source.findings);
}

} // namespace nook
