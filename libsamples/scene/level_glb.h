// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a level as one binary glTF file, for programs that cannot read its original format.
#pragma once

#include "scene/level.h"
#include "scene/load.h"
#include "scene/load_parts.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// glTF 2.0 binary without extensions and without other files: one mesh and node per mesh, in order; one primitive per material,
// with 32-bit indices, POSITION, NORMAL and COLOR_0 if present, TEXCOORD_0 for masks; materials with base colour, alphaMode,
// alphaCutoff and doubleSided; masks as PNG with white colour; one node per camera with its name.
//
// Positions are in world space, and mesh nodes have no transform. Only if a coordinate is 8192 m or more, where 32-bit numbers
// resolve a millimetre at best, positions are relative to the level's centre, and all mesh nodes have that translation.
//
// For a cell (cutCell), "extras" of nodes mark surroundings and closed surfaces: "nook_around", "nook_closed". With a bake,
// surroundings are omitted.
//
// loadLevel() reads the same triangles in the same order, except that meshes with several materials are grouped by material.
// Requires a triangle. Throws Error (unsupported) if the file would exceed readFile's limit. `generator`: "nook 0.1.0".
//
// `places` gets where the level's vertices are in the file, which then has no surroundings, but base colour textures, by names
// relative to the current folder; a mask's PNG has these colours.
std::string levelGlb(const Level& level, std::string_view generator, std::vector<GltfPlace>* places = nullptr);

// Throws Error (invalid_input) if that would read a picture which is not to be read.
void checkPictures(const Level& level);

// A binary glTF of a JSON text, a binary chunk and further chunks, with their heads. Throws Error (unsupported) above 1 GiB.
std::string glbContainer(std::string text, std::string_view chunk, std::string_view others, const std::string& name);

// A PNG of a picture with a mask, scaled to its size, as one of its channels: red 0 … alpha 3.
std::string pngWithChannel(const Image& image, std::size_t channel, const Mask& mask);

// Returns their centre in whole metres; 0 if all coordinates are smaller or the bounds are empty. Files of a level have the origin
// of preciseBounds().
glm::dvec3 glbOrigin(const Bounds& bounds);

// Meaning of baked values.
enum class BakedKind
{
	visibility,            // _VISIBILITY, 0 to 1
	volume_difference,     // _DIFFERENCE, −1 to 1: added to the visibility of volumes (aov)
	mask_volume_difference // _DIFFERENCE_MASK: likewise for aov-mask
};

// Baked values to store with the level.
struct GlbBake
{
	std::span<const float> visibility{}; // empty, or one per vertex, in [0, 1]: attribute _VISIBILITY, 32-bit floats
	bool color = false;                  // also store as COLOR_0: grey, 8 bits, opaque; viewers multiply their colours by it

	// An occlusionTexture for all materials: one coordinate per vertex, TEXCOORD_0 for materials without a mask and TEXCOORD_1 for
	// others; a PNG file.
	std::span<const glm::vec2> uvs{};
	std::string_view png{};

	// The clockwise side of two-sided materials, _VISIBILITY_BACK; COLOR_0 then has the mean of both sides.
	std::span<const float> back{};
	std::span<const glm::vec3> bent{};      // empty, or one per vertex, unit, world space: _BENT_NORMAL, three 32-bit floats
	std::span<const glm::vec3> bent_back{}; // for `back`: _BENT_NORMAL_BACK
	BakedKind kind = BakedKind::visibility; // determines attribute names and range
};

// The vertex values of a file made by nook bake.
struct BakedValues
{
	BakedKind kind = BakedKind::visibility;
	std::vector<float> front; // one per vertex of the level; NaN for vertices without a value
	std::vector<float> back;  // the clockwise side; same as the front if the file has only one
	std::vector<Mask> pages;  // textures that multiply the front, by Material::occlusion; empty: none
	std::vector<glm::vec2> uvs;
};

// `level`: the result of loadLevel() for the same file. Throws Error (invalid_input) if the file has no values or one is out of
// range; otherwise like loadSecondUvs().
BakedValues loadBakedValues(const std::string& path, const Level& level, const RunSettings& run);

} // namespace nook
