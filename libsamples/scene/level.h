// SPDX-License-Identifier: GPL-3.0-or-later
// A level: triangles in world space, the materials that let light through, and cameras.
#pragma once

#include "scene/camera.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace nook
{

// Beyond any level. Rays are 32-bit numbers, whose squares overflow from 2e19 on.
inline constexpr double kFarthest_m = 1e15;

enum class AlphaMode
{
	opaque, // alpha is ignored
	mask,   // there where alpha ≥ cut-off
	blend,  // mixed with what lies behind; rays take it as a mask with cut-off ½
};

enum class Wrap
{
	repeat,
	mirror,
	clamp,
};

// The alpha channel of a texture.
struct Mask
{
	std::string name; // the file, or "texture 3" for one inside the level's file
	int width_px = 0;
	int height_px = 0;
	Wrap wrap_u = Wrap::repeat;
	Wrap wrap_v = Wrap::repeat;
	std::vector<uint8_t> alpha; // width × height, rows from the top; 255 is opaque
	bool nearest = false;       // magnification filter "nearest": texels are squares; else bilinear
};

struct Material
{
	std::string name;
	AlphaMode alpha_mode = AlphaMode::opaque;
	double cutoff = 0.5;     // of mask and blend
	double alpha = 1.0;      // factor of the whole surface
	int mask = -1;           // index into Level::masks; −1: alpha is the factor alone
	double mean_alpha = 1.0; // ᾱ of AOV eq. 5: the mean of factor × mask over the texture; 1 where opaque
	double coverage = 1.0;   // share of the texture that passes the cut-off; 1 where opaque
	bool two_sided = false;
};

// Triangles of one mesh of the file, in one place of it.
struct Mesh
{
	std::string name;
	std::size_t first_triangle = 0;
	std::size_t triangle_count = 0;

	// Of a cell that was cut out of a level (cell.h):
	bool around = false; // its surroundings: occludes, but is another cell's
	bool closed = false; // of a closed surface, of which the cell may have a part: its back is seen from nowhere
};

struct Level
{
	std::string name; // file name without its folder, or "builtin:NAME"

	// Vertices. Positions are double: a level far from the origin, or a small mesh moved there by its node, keeps its shape.
	std::vector<glm::dvec3> positions; // world space, metres, y up
	std::vector<glm::vec3> normals;    // unit, or zero where the file has none; one a vertex
	std::vector<glm::vec2> uvs;        // v grows downward from the top row, as in glTF; one a vertex

	std::vector<glm::uvec3> triangles; // vertices, counter-clockwise seen from the front
	std::vector<uint32_t> materials;   // one a triangle, index into material_list
	std::vector<Mesh> meshes;          // cover the triangles in order, without gaps
	std::vector<Material> material_list;
	std::vector<Mask> masks;
	std::vector<LevelCamera> cameras;
	std::vector<std::string> files; // read for this level, the level's own first; none for builtin levels
};

// Smallest box of all vertices in use; least > most where there is no triangle.
struct Bounds
{
	glm::dvec3 least{1e300};
	glm::dvec3 most{-1e300};
};
Bounds boundsOf(const Level& level);
Bounds boundsOf(const Level& level, std::size_t triangle);

// Alpha of a mask at texture coordinates (u, v), in [0, 1], as a texture unit magnifies it with the mask's filter.
double alphaAt(const Mask& mask, glm::dvec2 uv);

// True where the surface is there for a ray: factor × mask ≥ cut-off; always true for opaque materials.
bool isSolidAt(const Level& level, const Material& material, glm::dvec2 uv);

// How many pixels of a mask have each of the 256 values.
using AlphaCounts = std::array<uint64_t, 256>;
AlphaCounts countAlpha(const Mask& mask);

// Sets mean_alpha and coverage from factor, cut-off and mask; the second form spares many materials of one mask its pixels.
void measureAlpha(Material& material, const std::vector<Mask>& masks);
void measureAlpha(Material& material, const AlphaCounts& counts);

} // namespace nook
