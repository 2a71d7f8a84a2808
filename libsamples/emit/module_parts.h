// SPDX-License-Identifier: GPL-3.0-or-later
// What the emitted GLSL and the emitted header both name.
#pragma once

#include "emit/module.h"
#include "format/arrays.h"
#include "methods/block_layout.h"
#include "methods/method_table.h"

#include <map>
#include <utility>

namespace nook
{

// A method's names in a module.
inline const char* entryOf(const MethodRow& row) // "nookVoLine"
{
	return row.kernel.call;
}
std::string stemOf(const MethodRow& row);  // of arrays and textures: "nook_vo_line"
std::string macroOf(const MethodRow& row); // of macros: "NOOK_VO_LINE"

// Describes the function of a method's settings and the names and values that it sets, whose lengths are factors of `reach`.
std::string settingsMeaning(const ModuleMethod& method);
std::vector<std::pair<std::string, std::string>> presetsOf(const ModuleSettings& settings, const ModuleMethod& method);

// Whether the language's own API has NDC z from 0 to 1, which depth buffers are preset to.
inline bool hasUnitClip(const ModuleSettings& settings)
{
	return settings.target == GlslTarget::vulkan;
}

// Features of a method.
inline const ShadeSettings& shadeOf(const ModuleSettings& settings, const ModuleMethod& method)
{
	return method.shade ? *method.shade : settings.shade;
}

// Side of the window: 1 for a single pattern.
int windowOf(const ModuleMethod& method);

bool fromTexture(const ModuleSettings& settings, const ModuleMethod& method);

// "NOOK_VO_LINE_ALCHEMY"
std::string guardOf(const ModuleSettings& settings);

// The samples as the texture of `nook tile` has them (column = variant, row = sample), or else one variant after the other.
std::vector<Sample> texelsOf(const ModuleMethod& method);
std::vector<Sample> rowsOf(const ModuleMethod& method);

// A function that a pass calls, and what is known of its block.
struct ModuleEntry
{
	std::string call;
	std::map<std::string, std::string> constants; // "NOOK_SAMPLES" → "9"; what differs between passes → "nook_pass.x"
	ShadePacking packing = ShadePacking::none;
	bool of_pixel = false; // takes the pixel of its cell
};

// Of one method with its filter, in the order of the passes, each once.
std::vector<ModuleEntry> entriesOf(const ModuleSettings& settings, const ModuleMethod& method);

// The one that shades a pixel: its row's, or that of bent normals.
std::string entryOf(const ModuleSettings& settings, const ModuleMethod& method);
bool hasBentNormals(const ModuleSettings& settings, const ModuleMethod& method);

// The members of the block as the GLSL declares them, the uniform nook_pass, and the functions with what reads them as integers.
std::string membersText(const ModuleSettings& settings);
std::string typeOf(const ModuleSettings& settings, const BlockMember& member);
std::string withIntegers(const ModuleSettings& settings, const std::string& functions);

// What the file's head says of the functions and of the passes to draw.
std::string introductionOf(const ModuleSettings& settings);

} // namespace nook
