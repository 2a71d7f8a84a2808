// SPDX-License-Identifier: GPL-3.0-or-later
// A level → one binary glTF file, for whoever has no reader of the format that it came in.
#pragma once

#include "scene/baked_values.h"
#include "scene/level.h"

#include <span>
#include <string>
#include <string_view>

namespace nook
{

// glTF 2.0 binary, without extensions and without other files: a mesh and a node for each mesh, in their order; a primitive for
// each of its materials, with indices of 32 bits, POSITION, NORMAL where the level has them, TEXCOORD_0 where a mask is put on;
// materials with alphaMode, alphaCutoff and doubleSided, masks as PNG whose colour is white; a node for each camera, that carries
// its name.
//
// Positions are world space, and nodes of meshes have no transform. Only where a coordinate is 8192 m or more, which 32-bit numbers
// keep to a millimetre at best, positions count from the middle of the level, and all nodes of meshes have that translation.
//
// Of a cell (cell.h) nodes say in "extras" what is around it and what was closed: "nook_around", "nook_closed". With a bake, what
// is around is left out.
//
// loadLevel() reads the same triangles again, in their order but for meshes of several materials, where each comes in turn.
// Requires a triangle. Throws Error (unsupported) for a level whose file would be larger than readFile takes in. `generator`: "nook
// 0.1.0".
std::string levelGlb(const Level& level, std::string_view generator);

// Returns that middle, in whole metres; 0 where all coordinates are smaller.
glm::dvec3 glbOrigin(const Bounds& bounds);

// What was baked, to be written beside the level.
struct GlbBake
{
	std::span<const float> visibility{}; // none, or one a vertex, in [0, 1]: attribute _VISIBILITY, 32-bit floats
	bool color = false;                  // also as COLOR_0: grey, 8 bits, opaque; viewers multiply their colours by it

	// An occlusionTexture for all materials: coordinates one a vertex, TEXCOORD_0 of what has no mask and TEXCOORD_1 of what has;
	// bytes of a PNG.
	std::span<const glm::vec2> uvs{};
	std::string_view png{};

	// Of materials with two sides the clockwise one, _VISIBILITY_BACK; COLOR_0 has the mean of both there.
	std::span<const float> back{};
	std::span<const glm::vec3> bent{};      // none, or one a vertex, unit, world space: _BENT_NORMAL, three 32-bit floats
	std::span<const glm::vec3> bent_back{}; // as `back`: _BENT_NORMAL_BACK
	BakedKind kind = BakedKind::visibility; // else names and range are its own
};
std::string levelGlb(const Level& level, std::string_view generator, const GlbBake& bake);

} // namespace nook
