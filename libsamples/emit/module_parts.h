// SPDX-License-Identifier: GPL-3.0-or-later
// What the emitted GLSL and the emitted header both name.
#pragma once

#include "emit/module.h"
#include "format/arrays.h"

#include <map>

namespace nook
{

// One row a method: everything by which the module knows it.
struct MethodRow
{
	ShadeMethod method;
	std::string_view option; // "vo-line"
	const char* entry;       // "nookVoLine"
	const char* stem;        // of arrays and textures: "nook_vo_line"
	const char* macro;       // of macros: "NOOK_VO_LINE"
	const char* what;        // what comes out, for the file's head
	int tile_binding;        // of its tile in OpenGL 4.3 and Vulkan
};
const MethodRow& rowOf(ShadeMethod method);

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
	std::map<std::string, std::string> constants; // "nook.count.x" → "9"; what differs between passes → "nook_pass.x"
};

// Of one method with its filter, in the order of the passes, each once.
std::vector<ModuleEntry> entriesOf(const ModuleSettings& settings, const ModuleMethod& method);

// What the file's head says of the functions and of the passes to draw.
std::string introductionOf(const ModuleSettings& settings);

} // namespace nook
