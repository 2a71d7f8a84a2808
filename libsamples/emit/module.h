// SPDX-License-Identifier: GPL-3.0-or-later
// Screen-space methods and their patterns → one GLSL file for an engine's shaders, and a C++ header or a JavaScript module that
// fills its uniform block.
//
// The GLSL is a file to include, without #version, for an engine prepends its own; with `main` it is a whole fragment shader.
// Numbers of samples, windows and features are constants in it, so that loops unroll and what was not asked for is not there.
#pragma once

#include "format/notes.h"
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

enum class GlslTarget
{
	gl330,  // OpenGL 3.3 and later
	gl430,  // OpenGL 4.3 and later: explicit bindings
	es300,  // OpenGL ES 3.0 and later
	vulkan, // Vulkan: GLSL 4.50 with descriptor sets and bindings
};
std::span<const std::string_view> glslTargets(); // 330 430 es300 vulkan

// Where the samples of a tile are: every pixel of a window has its own, so that the threads of a warp read different ones.
enum class TilePlace
{
	texture, // the one that `nook tile -o FILE.exr` makes, and whose numbers the C++ header holds
	array,   // constants in the GLSL: nothing to load and to bind
};

struct ModuleMethod
{
	ShadeMethod method{};
	std::vector<Pattern> variants; // one, or one for each pixel of a window; of the method's domain and of one count. None for a
								   // method that takes no pattern
	std::optional<ShadeSettings> shade{}; // features of its own; none: the module's
	std::optional<MethodRecipe> recipe{}; // what its features and its nook_…_settings(reach) came from; none: the paper's
	int frames = 1;                       // of a cycle of tiles, one after the other, or of the tile's moves
	std::vector<glm::ivec2> moves{};      // as PatternTile's
};

// How many tiles one after the other its variants are.
int layersOf(const ModuleMethod& method);

struct ModuleSettings
{
	std::vector<ModuleMethod> methods; // at least one, each once
	GlslTarget target = GlslTarget::gl330;
	TilePlace tile = TilePlace::texture;
	ShadeSettings shade;       // features and filters; numbers that the block holds, and the method, are of no matter. A window
							   // requires tiles of one size for all methods
	bool gather = false;       // nookGather as well, for renderers with several samples a pixel
	bool main = false;         // a whole fragment shader of the one method
	bool device_depth = false; // depth as a depth buffer holds it, 0 to 1, of any projection
	bool normals_from_depth = false; // no picture of normals is read
	bool float_block = false;        // every integer of the block, and of nook_pass, is a float
	std::string header_namespace; // of the header's tiles and settings, so that one program may have several with a method; or none
};

// What nook_pass must hold while a pass is drawn: what its block has and a module's has not.
glm::ivec4 modulePassOf(const ShadeBlock& block, std::string_view call);

struct ShadePass;

// The module's function of a pass, of a texel; of the pixel of its cell where it packs nothing ("nookVoLine", "nookVoLineLinked").
std::string moduleCallOf(const ShadePass& pass);

// Whether normals are asked for at all.
bool readsNormals(const ModuleSettings& settings);

// The same bytes for the same arguments.
std::string moduleGlsl(const ModuleSettings& settings, const EmitContext& context);

// Plain C++17 without dependencies: struct nook_block as the GLSL's block lies in memory, nook_fill, settings of each method, which
// know of its recipe and of device depth, and the texels of the tiles that the GLSL reads from textures.
std::string moduleHeader(const ModuleSettings& settings, const EmitContext& context);

// The same as a JavaScript module without dependencies: fill(projection, settings), whose bytes are those of nook_fill, the members
// of the block, the texels and the settings of recipes; and the GLSL, where there is some.
std::string moduleScript(const ModuleSettings& settings, const EmitContext& context, std::string_view glsl);

} // namespace nook
