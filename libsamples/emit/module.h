// SPDX-License-Identifier: GPL-3.0-or-later
// Emits screen-space methods and their patterns as one GLSL or HLSL file for an engine's shaders, and the code or data in C++,
// JavaScript, C#, Python or JSON that fills its uniform block.
//
// The file is for inclusion, and GLSL has no #version, since engines prepend their own; with `main` it is a complete shader.
// Sample counts, windows and features are constants, so that loops unroll and unused features are absent.
#pragma once

#include "format/notes.h"
#include "methods/aov_text.h"
#include "methods/kernels.h"
#include "methods/recipes.h"
#include "methods/settings.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// Versions as options take them; WGSL has none.
template <> inline constexpr std::array<std::string_view, 6> kNamesOf<GlslTarget>{"330", "430", "es300", "vulkan", "60", ""};
inline std::span<const std::string_view> glslTargets()
{
	return namesOf<GlslTarget>().first(4);
}
inline std::span<const std::string_view> hlslTargets()
{
	return namesOf<GlslTarget>().subspan(4, 1);
}

// Complete shaders with the entry point `main`. The macro NOOK_PASS selects the pass: 0, the default, is the first one.
enum class ModuleMain
{
	fragment,
	compute, // writes to a storage image
};
bool hasCompute(GlslTarget target);

// How a module reads the pictures that it does not compute itself.
enum class ModuleTextures
{
	fixed,    // depth, normals and visibility through macros that an engine may define first; tiles and packed pictures directly
	macros,   // all of them through macros
	separate, // likewise; Vulkan: textures and one sampler, bound separately
};

// Where a tile's samples are stored. Every pixel of a window has its own, so the threads of a warp read different ones.
enum class TilePlace
{
	texture, // the texture that `nook tile -o FILE.exr` makes; the C++ header has its texels
	array,   // constants in the GLSL: nothing to load or bind
};

struct ModuleMethod
{
	ShadeMethod method{};
	std::vector<Pattern> variants; // one, or one per pixel of a window; all of the method's domain with equal counts. Empty if the
								   // method takes no pattern
	std::optional<ShadeSettings> shade{}; // overrides the module's features
	std::optional<MethodRecipe> recipe{}; // recipe of its features and of its nook_…_settings(reach); none: the paper's
	int frames = 1;                       // length of the cycle of tiles, stored one after the other, or of the tile's moves
	std::vector<glm::ivec2> moves{};      // as in PatternTile
};

// Number of tile layers among the variants.
int layersOf(const ModuleMethod& method);

struct ModuleSettings
{
	std::vector<ModuleMethod> methods; // at least one, no duplicates
	GlslTarget target = GlslTarget::gl330;
	TilePlace tile = TilePlace::texture;
	ShadeSettings shade; // features and filters; the method and the numbers in the block are ignored. A window requires tiles of
						 // one size for all methods
	bool gather = false; // also emit nookGather, for renderers with several samples per pixel
	std::optional<ModuleMain> main{}; // a complete shader, of one method and without nookGather; none: functions to include
	ModuleTextures textures = ModuleTextures::fixed; // HLSL: always separate
	bool device_depth = false;                       // read depth as stored in a depth buffer, 0 to 1, for any projection
	bool normals_from_depth = false;                 // reconstruct normals instead of reading them
	bool float_block = false;                        // make all integers of the block and of nook_pass floats
	std::string header_namespace; // namespace of the header's tiles and settings, so that a program may include several with one
								  // method; empty: none
};

// The value of nook_pass while a pass is drawn: constants that shade blocks hold but module blocks do not.
glm::ivec4 modulePassOf(const ShadeBlock& block, std::string_view call);

struct ShadeFrame;
struct ShadePass;
struct ShadeSamples;

// The module's function for a pass over texels; over the pixel of its cell if it packs nothing ("nookVoLine", "nookVoLineLinked").
std::string moduleCallOf(const ShadePass& pass);

// The passes of one picture with their pictures, samples and uniform block, for modules with std140 blocks: "schema":
// "nook.passes/1", one line. The same bytes for the same arguments.
std::string passesJson(const ShadeFrame& frame, const ShadeSamples& samples, const ShadeSettings& settings,
					   std::string_view version);

// Whether normals are asked for at all.
bool readsNormals(const ModuleSettings& settings);

// Fills the method's variants, or their first `count` samples; returns the file's command. Throws Error (file; invalid_input).
std::string readSamples(const std::string& path, std::optional<std::size_t> count, const ShadeSettings& shade,
						ModuleMethod& method);

// Throws Error (invalid_input) where a window filter would find no window, or more than one.
void checkWindows(const ModuleSettings& settings);

// The module in its target's language. Its bytes depend on the arguments alone.
std::string moduleGlsl(const ModuleSettings& settings, const EmitContext& context);

// Plain C++17 without dependencies: struct nook_block with the memory layout of the GLSL's block, nook_fill, settings of each
// method (preset by its recipe and for device depth), and the texels of the tiles that the GLSL reads from textures.
std::string moduleHeader(const ModuleSettings& settings, const EmitContext& context);

// These contents as a JavaScript module without dependencies: fill(projection, settings), with the same bytes as nook_fill, the
// members of the block, the texels, the recipes' settings, and the GLSL if given.
std::string moduleScript(const ModuleSettings& settings, const EmitContext& context, std::string_view glsl);

// The script in C#, for Unity among others, and in Python.
std::string moduleSharp(const ModuleSettings& settings, const EmitContext& context);
std::string modulePython(const ModuleSettings& settings, const EmitContext& context);

// "schema": "nook.module/1", one line: the members of the block with types and offsets, settings per method, and texels.
std::string moduleJson(const ModuleSettings& settings, const EmitContext& context);

// Masks need logic operations on render targets, which WebGL and WebGPU lack.
constexpr bool drawsVolumes(GlslTarget target, bool masks)
{
	return !masks || (target != GlslTarget::es300 && target != GlslTarget::wgsl);
}

// The shader text that `nook shade --device gl` uses, with instructions for engines. Deterministic.
std::string volumesGlsl(const AovTextSettings& settings, const EmitContext& context);

} // namespace nook
