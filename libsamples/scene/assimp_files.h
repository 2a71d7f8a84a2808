// SPDX-License-Identifier: GPL-3.0-or-later
// Files as Assimp 5.2.5 asks for them → their bytes, changed where it would take them wrongly; and which were there.
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

	std::vector<std::string> opened;  // each once
	std::vector<std::string> missing; // each once
	std::optional<Error> refused;     // the first file that was not opened for what it is, or where

	// Read here, since Assimp does not hand it on:
	MtlMaterials materials;
	std::vector<glm::dvec3> exact;   // positions; empty: Assimp's 32 bits do. OBJ: by number, others: in order
	std::vector<std::string> solids; // names in an STL file, one a mesh

private:
	std::optional<std::string> levelText();
	Assimp::IOStream* streamOfFile(const std::string& path, const char* mode);

	std::string m_level_path;
	LoadSettings m_settings;
	bool m_has_read = false;           // the level's file
	std::optional<std::string> m_text; // that of the level's file for Assimp; none: the file itself
	std::string m_names;               // of the materials of the MTL file that is open
};

} // namespace nook
