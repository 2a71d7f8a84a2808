// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/load_parts.h"

#include <algorithm>
#include <cassert>

namespace nook
{
namespace
{

bool areSame(const Mask& a, const Mask& b)
{
	return a.name == b.name && a.width_px == b.width_px && a.height_px == b.height_px && a.wrap_u == b.wrap_u &&
		   a.wrap_v == b.wrap_v && a.nearest == b.nearest && a.alpha == b.alpha;
}

bool areSame(const Material& a, const Material& b)
{
	return a.name == b.name && a.alpha_mode == b.alpha_mode && a.cutoff == b.cutoff && a.alpha == b.alpha && a.mask == b.mask &&
		   a.mean_alpha == b.mean_alpha && a.coverage == b.coverage && a.two_sided == b.two_sided;
}

// Index of `item` in `list`; appends it if there is no equal one.
template <class Item> std::size_t addOnce(std::vector<Item>& list, Item item)
{
	const auto same = std::find_if(list.begin(), list.end(), [&](const Item& other) { return areSame(other, item); });
	const auto index = static_cast<std::size_t>(same - list.begin());
	if (same == list.end())
	{
		list.push_back(std::move(item));
	}
	return index;
}

void appendMaterials(Level& to, Level& from)
{
	std::vector<int> masks;
	for (Mask& mask : from.masks)
	{
		masks.push_back(static_cast<int>(addOnce(to.masks, std::move(mask))));
	}
	std::vector<uint32_t> materials;
	for (Material& material : from.material_list)
	{
		material.mask = material.mask < 0 ? -1 : masks[static_cast<std::size_t>(material.mask)];
		materials.push_back(static_cast<uint32_t>(addOnce(to.material_list, std::move(material))));
	}
	for (const uint32_t material : from.materials)
	{
		to.materials.push_back(materials[material]);
	}
}

} // namespace

void appendLevel(Level& to, Level from, glm::dvec3 move)
{
	assert(to.positions.size() + from.positions.size() <= UINT32_MAX && to.triangles.size() + from.triangles.size() <= UINT32_MAX);
	const auto vertices = static_cast<uint32_t>(to.positions.size());
	const std::size_t triangles = to.triangles.size();
	for (const glm::dvec3& position : from.positions)
	{
		to.positions.push_back(position + move);
	}
	to.normals.insert(to.normals.end(), from.normals.begin(), from.normals.end());
	to.uvs.insert(to.uvs.end(), from.uvs.begin(), from.uvs.end());
	for (const glm::uvec3& triangle : from.triangles)
	{
		// An out-of-range index stays out of range, for the diagnosis.
		const bool inside = std::max({triangle.x, triangle.y, triangle.z}) < from.positions.size();
		to.triangles.push_back(inside ? triangle + vertices : glm::uvec3(UINT32_MAX));
	}
	for (Mesh& mesh : from.meshes)
	{
		mesh.first_triangle += triangles;
		to.meshes.push_back(std::move(mesh));
	}
	appendMaterials(to, from);
	for (LevelCamera& camera : from.cameras)
	{
		camera.world_from_camera[3] += glm::dvec4(move, 0.0);
		to.cameras.push_back(std::move(camera));
	}
	nameCameras(to.cameras);
	for (const std::string& file : from.files)
	{
		addFile(to.files, file);
	}
}

} // namespace nook
