// SPDX-License-Identifier: GPL-3.0-or-later
// Serves the files that Assimp 5.2.5 asks for, with changes where it would misread them, and records them.
#pragma once

#include "core/error.h"
#include "scene/load.h"
#include "scene/mtl_text.h"

#include <assimp/DefaultIOSystem.h>

#include <optional>
#include <string>
#include <vector>

namespace nook
{

class AssimpFiles : public Assimp::DefaultIOSystem
{
public:
	AssimpFiles(std::string level_path, const LoadSettings& settings) : m_level_path(std::move(level_path)), m_settings(settings) {}

	bool Exists(const char* file) const override;
	Assimp::IOStream* Open(const char* file, const char* mode) override;

	std::vector<std::string> opened;  // without duplicates
	std::vector<std::string> missing; // without duplicates
	std::optional<Error> refused;     // reason for the first file that was rejected

	// Read here because Assimp does not provide it:
	MtlMaterials materials;
	std::vector<glm::dvec3> exact;   // positions; empty: Assimp's 32 bits suffice. For OBJ by number, else in order
	std::vector<std::string> solids; // names in an STL file, one per mesh

private:
	std::optional<std::string> levelText();
	Assimp::IOStream* streamOfFile(const std::string& path, const char* mode);

	std::string m_level_path;
	LoadSettings m_settings;
	bool m_has_read = false;           // the level's file
	std::optional<std::string> m_text; // the level's text for Assimp; none: the file itself
	std::string m_names;               // of the materials in the current MTL file
};

} // namespace nook
