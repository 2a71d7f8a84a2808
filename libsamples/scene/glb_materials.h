// SPDX-License-Identifier: GPL-3.0-or-later
// A level's materials and masks, and a texture of occlusion, as the JSON and the pictures of a binary glTF file.
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
	// Both must outlive it. `occlusion_png`: none, or the occlusionTexture of all materials.
	GlbMaterials(const Level& level, std::string_view occlusion_png);

	// The number in the file of a material of the level, which is made where it is first asked for.
	int indexOf(uint32_t material);

	nlohmann::ordered_json materials = nlohmann::ordered_json::array();
	nlohmann::ordered_json textures = nlohmann::ordered_json::array();
	nlohmann::ordered_json samplers = nlohmann::ordered_json::array();
	nlohmann::ordered_json images = nlohmann::ordered_json::array(); // "bufferView" is still to be set
	std::vector<std::string> pictures;                               // of the images, PNG

private:
	int textureOf(std::size_t mask);
	int occlusionTexture();

	const Level& m_level;
	std::string_view m_occlusion_png;
	int m_occlusion = -1;        // the occlusion texture's number, or none yet
	std::vector<int> m_material; // of each material and mask the number in the file, or −1
	std::vector<int> m_mask;
};

} // namespace nook
