// SPDX-License-Identifier: GPL-3.0-or-later
// Parses MTL files. Assimp 5.2.5 takes the last of d and Tr and ignores most texture options, so it only gets the names.
#pragma once

#include "scene/load_parts.h"

#include <map>
#include <optional>
#include <string>

namespace nook
{

// Assimp ignores names of 1024 bytes and more; this is the length it gets.
inline constexpr std::size_t kMaxMaterialName = 1000;

struct MtlMaterial
{
	std::string name;        // full name
	std::optional<float> d;  // opacity, 0 to 1
	std::optional<float> tr; // 0 to 1: transparency by the specification, opacity in some programs
	MaskSource mask;         // map_d; an empty name means none
	glm::dmat3 uv_of_set{1.0};
	std::string ignored; // the first unsupported option of map_d
	std::string colour;  // map_Kd
};

using MtlMaterials = std::map<std::string, MtlMaterial>; // sorted by their truncated names

// Adds the file's materials to `materials` and returns text that declares their names to Assimp. Throws Error (invalid_input or
// unsupported) naming the line.
std::string readMtl(const std::string& text, const std::string& path, MtlMaterials& materials);

// d, else Tr interpreted by `meaning`. Sets `inverted` if Tr contradicts d, or is 1 without d and treated as opaque.
float opacityOf(const MtlMaterial& material, TrMeaning meaning, bool& inverted);

} // namespace nook
