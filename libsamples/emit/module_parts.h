// SPDX-License-Identifier: GPL-3.0-or-later
// Names shared by the emitted GLSL and header.
#pragma once

#include "emit/module.h"
#include "format/arrays.h"
#include "methods/block.h"
#include "methods/method_table.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace nook
{

// Names of a method in a module.
inline const char* entryOf(const MethodRow& row) // "nookVoLine"
{
	return row.kernel.call;
}
std::string stemOf(const MethodRow& row);  // arrays and textures: "nook_vo_line"
std::string macroOf(const MethodRow& row); // macros: "NOOK_VO_LINE"

// Describes the function that presets a method's settings, and the values it sets; lengths are factors of `reach`.
std::string settingsMeaning(const ModuleMethod& method);
std::vector<std::pair<std::string, std::string>> presetsOf(const ModuleSettings& settings, const ModuleMethod& method);

// True if the language's API has NDC z from 0 to 1, the preset for depth buffers.
inline bool hasUnitClip(const ModuleSettings& settings)
{
	return settings.target == GlslTarget::vulkan || settings.target == GlslTarget::hlsl60 || settings.target == GlslTarget::wgsl;
}

// Features of a method.
inline ShadeSettings shadeOf(const ModuleSettings& settings, const ModuleMethod& method)
{
	ShadeSettings shade = method.shade.value_or(settings.shade);
	shade.method = method.method;
	return shade;
}

// Side of the window; 1 for a single pattern.
int windowOf(const ModuleMethod& method);

bool fromTexture(const ModuleSettings& settings, const ModuleMethod& method);

// "NOOK_VO_LINE_ALCHEMY"
std::string guardOf(const ModuleSettings& settings);

// Samples in the layout of `nook tile` textures (column = variant, row = sample), or one variant after the other.
std::vector<Sample> texelsOf(const ModuleMethod& method);
std::vector<Sample> rowsOf(const ModuleMethod& method);

// A function called by a pass, and its constants.
struct ModuleEntry
{
	std::string call;
	std::map<std::string, std::string> constants; // "NOOK_SAMPLES" → "9"; values that differ between passes → "nook_pass.x"
	ShadePacking packing = ShadePacking::none;
	bool of_pixel = false; // takes the pixel of its cell
};

// Functions of one method and its filter in pass order, without duplicates.
std::vector<ModuleEntry> entriesOf(const ModuleSettings& settings, const ModuleMethod& method);

// The function that shades a pixel: the method's, or its variant with bent normals.
std::string entryOf(const ModuleSettings& settings, const ModuleMethod& method);
bool hasBentNormals(const ModuleSettings& settings, const ModuleMethod& method);

// GLSL declarations of the block's members and of the uniform nook_pass, and accessors for integers stored as floats.
std::string membersText(const ModuleSettings& settings);
std::string typeOf(const ModuleSettings& settings, const BlockMember& member);
std::string withIntegers(const ModuleSettings& settings, const std::string& functions);

// The main functions of a complete shader: one per pass of the introduction's list.
struct ModulePass
{
	std::string call;   // at the texel `at`
	std::string type;   // vec4
	std::string format; // of a storage image: rgba8
};
std::vector<ModulePass> mainPasses(const ModuleSettings& settings);

// The module in WGSL, with its bindings in one place, and with an entry point per pass if it is a complete shader. Throws Error
// (unsupported) for GLSL that is not translated.
std::string moduleWgsl(const ModuleSettings& settings, const EmitContext& context);
std::string wgslOf(const std::string& glsl);      // of functions for Vulkan
std::string volumesWgsl(const std::string& glsl); // of aovText

// The file's introduction: its functions and the passes to draw.
std::string introductionOf(const ModuleSettings& settings);

} // namespace nook
