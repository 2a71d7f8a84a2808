// SPDX-License-Identifier: GPL-3.0-or-later
// What the command line of nook emit says, for modules of screen-space methods and of volumes.
#pragma once

#include "feature_options.h"
#include "options.h"
#include "recipe_options.h"

#include "emit/module.h"
#include "format/pattern_file.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr std::array<std::string_view, 3> kModuleFormats{".glsl", ".h", ".js"};
inline constexpr std::array<std::string_view, 2> kModuleDepths{"linear", "device"}; // what a module reads
inline constexpr std::array<std::string_view, 2> kModuleNormals{"texture", "from-depth"};
inline constexpr std::array<std::string_view, 2> kModuleBlocks{"mixed", "floats"};

struct EmitOptions
{
	std::string methods;
	std::string patterns;
	std::string counts;
	ModuleSettings settings;
	int directions = 128;
	CLI::Option* directions_option = nullptr;
	CLI::Option* glsl = nullptr;
	CLI::Option* tile = nullptr;
	CLI::Option* depth = nullptr;
	CLI::Option* normals = nullptr;
	CLI::Option* block = nullptr;
	CLI::Option* space = nullptr;
	CLI::Option* gather = nullptr;
	CLI::Option* main = nullptr;
	std::vector<FeatureOption> features;
	RecipeOption recipe;
	CLI::Option* recipe_option = nullptr;
	Outputs outputs;
};

// Standard output gets the module.
inline bool isGlsl(const std::string& path)
{
	return formatOf(path, kModuleFormats) != ".h" && formatOf(path, kModuleFormats) != ".js";
}

inline bool isScript(const std::string& path)
{
	return formatOf(path, kModuleFormats) == ".js";
}

inline bool isHeader(const std::string& path)
{
	return formatOf(path, kModuleFormats) == ".h";
}

} // namespace nook
