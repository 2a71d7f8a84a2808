// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a level's materials, masks and optional occlusion texture to the JSON and pictures of a binary glTF file.
#pragma once

#include "scene/level.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace nook
{

class GlbMaterials
{
public:
	// Both arguments must outlive this object. `occlusion_png`: empty, or the occlusionTexture of all materials.
	GlbMaterials(const Level& level, std::string_view occlusion_png);

	// The file's number of a level's material, created on first use.
	int indexOf(uint32_t material);

	nlohmann::ordered_json materials = nlohmann::ordered_json::array();
	nlohmann::ordered_json textures = nlohmann::ordered_json::array();
	nlohmann::ordered_json samplers = nlohmann::ordered_json::array();
	nlohmann::ordered_json images = nlohmann::ordered_json::array(); // "bufferView" is set later
	std::vector<std::string> pictures;                               // PNG files of the images

private:
	int textureOf(std::size_t mask);
	int occlusionTexture();

	const Level& m_level;
	std::string_view m_occlusion_png;
	int m_occlusion = -1;        // number of the occlusion texture; -1: not created yet
	std::vector<int> m_material; // file number of each material and mask, or −1
	std::vector<int> m_mask;
};

} // namespace nook
