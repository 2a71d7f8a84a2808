// SPDX-License-Identifier: GPL-3.0-or-later
// A level and one view of it → triangles to draw from anywhere, and depth, normals and rays of that view.
#include "live_report/live_parts.h"
#include "shade/shade.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <map>
#include <tuple>

namespace nook
{
namespace
{

LiveJson matrixJson(const glm::dmat4& matrix)
{
	LiveJson numbers = LiveJson::array();
	for (int i = 0; i < 16; ++i)
	{
		numbers.push_back(glm::value_ptr(matrix)[i]);
	}
	return numbers;
}

LiveJson maskJson(const Mask& mask)
{
	return {{"width", mask.width_px},
			{"height", mask.height_px},
			{"wrap_u", static_cast<int>(mask.wrap_u)},
			{"wrap_v", static_cast<int>(mask.wrap_v)},
			{"alpha", packed(mask.alpha)}};
}

// Positions are from the camera's, so that 32 bits are enough near it.
LiveJson trianglesJson(const Level& level, glm::dvec3 eye)
{
	std::vector<float> positions;
	std::vector<float> uvs;
	for (std::size_t i = 0; i < level.positions.size(); ++i)
	{
		const glm::dvec3 p = level.positions[i] - eye;
		positions.insert(positions.end(), {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
		const glm::vec2 uv = i < level.uvs.size() ? level.uvs[i] : glm::vec2(0.0F);
		uvs.insert(uvs.end(), {uv.x, uv.y});
	}
	std::map<uint32_t, std::vector<uint32_t>> by_material;
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		const Material& material = level.material_list[level.materials[t]];
		const bool masked = material.alpha_mode != AlphaMode::opaque;
		std::vector<uint32_t>& indices = by_material[masked ? level.materials[t] + 1 : 0];
		for (int k = 0; k < 3; ++k)
		{
			indices.push_back(level.triangles[t][k]);
		}
	}
	LiveJson groups = LiveJson::array();
	for (const auto& [key, indices] : by_material)
	{
		LiveJson group{{"indices", packed(indices)}};
		if (key > 0)
		{
			const Material& material = level.material_list[key - 1];
			group["mask"] = material.mask;
			group["alpha"] = material.alpha;
			group["cutoff"] = material.cutoff;
		}
		groups.push_back(std::move(group));
	}
	return {{"positions", packed(positions)}, {"uvs", packed(uvs)}, {"groups", std::move(groups)}};
}

// Few surfaces have normals of their own: each one once, and which one a pixel has.
LiveJson normalsJson(const std::vector<glm::vec3>& normals)
{
	std::map<std::tuple<float, float, float>, uint32_t> known;
	std::vector<float> list;
	std::vector<uint32_t> indices;
	for (const glm::vec3& n : normals)
	{
		const auto [place, is_new] = known.try_emplace({n.x, n.y, n.z}, static_cast<uint32_t>(known.size()));
		if (is_new)
		{
			list.insert(list.end(), {n.x, n.y, n.z});
		}
		indices.push_back(place->second);
	}
	if (known.size() > 65536)
	{
		return {{"list", packed(list)}, {"indices", packed(indices)}, {"bytes", 4}};
	}
	const std::vector<uint16_t> small(indices.begin(), indices.end());
	return {{"list", packed(list)}, {"indices", packed(small)}, {"bytes", 2}};
}

} // namespace

LiveJson liveView(const LevelCamera& camera, const LevelBench& level, ViewBench& view)
{
	const GBuffer& gbuffer = view.gbuffer();
	const Reference& reference = view.reference();
	std::vector<uint8_t> seen;
	for (const float value : reference.visibility)
	{
		seen.push_back(static_cast<uint8_t>(std::clamp(255.0F * value + 0.5F, 0.0F, 255.0F)));
	}
	LiveJson masks = LiveJson::array();
	for (const Mask& mask : level.level().masks)
	{
		masks.push_back(maskJson(mask));
	}
	return {{"level", level.level().name},
			{"camera", camera.name},
			{"triangle_count", level.level().triangles.size()},
			{"width", gbuffer.width_px},
			{"height", gbuffer.height_px},
			{"radius_m", level.radiusM()},
			{"reference_error", reference.error},
			{"projection", matrixJson(gbuffer.view.projection)},
			{"world_from_camera", matrixJson(camera.world_from_camera)},
			{"depth", packed(finiteDepths(gbuffer))},
			{"normals", normalsJson(gbuffer.normals)},
			{"reference", packed(seen)},
			{"triangles", trianglesJson(level.level(), glm::dvec3(camera.world_from_camera[3]))},
			{"masks", std::move(masks)}};
}

} // namespace nook
