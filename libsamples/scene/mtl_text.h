// SPDX-License-Identifier: GPL-3.0-or-later
// The text of an MTL file → what a level needs of its materials. Assimp 5.2.5 takes the last of d and Tr and drops most options of
// textures, so it gets the names alone.
#pragma once

#include "scene/load_parts.h"

#include <map>
#include <optional>
#include <string>

namespace nook
{

// Assimp drops names of 1024 bytes and more; it gets so many of them.
inline constexpr std::size_t kMaxMaterialName = 1000;

struct MtlMaterial
{
	std::string name;        // all of it
	std::optional<float> d;  // opacity, 0 to 1
	std::optional<float> tr; // 0 to 1: transparency by the format, opacity by some programs
	MaskSource mask;         // map_d; its name is empty where there is none
	glm::dmat3 uv_of_set{1.0};
	std::string ignored; // the first option of map_d that is not applied
	std::string colour;  // map_Kd
};

using MtlMaterials = std::map<std::string, MtlMaterial>; // by the beginning of their names

// Adds the file's materials to `materials`; returns text that names them to Assimp. Throws Error (invalid_input or unsupported)
// that names the line.
std::string readMtl(const std::string& text, const std::string& path, MtlMaterials& materials);

// d, else Tr as `meaning` says. `inverted`: set where Tr contradicts d, or is 1 by itself and taken for opaque.
float opacityOf(const MtlMaterial& material, TrMeaning meaning, bool& inverted);

} // namespace nook
