// SPDX-License-Identifier: GPL-3.0-or-later
// A level: triangles in world space, materials, masks and cameras.
#pragma once

#include "scene/camera.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace nook
{

// Beyond any level. Rays use 32-bit numbers, whose squares overflow from 2e19 on.
inline constexpr double kFarthest_m = 1e15;

enum class AlphaMode
{
	opaque, // alpha is ignored
	mask,   // present where alpha ≥ cut-off
	blend,  // blended with the background; rays treat it as a mask with cut-off ½
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
	std::string name; // the file, or "texture 3" if embedded in the level's file
	int width_px = 0;
	int height_px = 0;
	Wrap wrap_u = Wrap::repeat;
	Wrap wrap_v = Wrap::repeat;
	std::vector<uint8_t> alpha; // width × height, rows from the top; 255 is opaque
	bool nearest = false;       // magnification filter "nearest"; else bilinear

	bool operator==(const Mask&) const = default;
};

struct Material
{
	std::string name;
	AlphaMode alpha_mode = AlphaMode::opaque;
	double cutoff = 0.5;     // for mask and blend
	double alpha = 1.0;      // constant factor
	int mask = -1;           // index into Level::masks; −1: only the factor
	double mean_alpha = 1.0; // ᾱ of AOV eq. 5: the mean of factor × mask over the texture; 1 if opaque
	double coverage = 1.0;   // fraction of the texture that passes the cut-off; 1 if opaque
	bool two_sided = false;
	int occlusion = -1;              // image of a glTF's occlusionTexture
	std::vector<std::string> extras; // "key=value", for choosing parts

	// Base colour, of formats other than glTF.
	glm::vec3 colour{1.0F};                                // linear
	std::string picture;                                   // replaces it: a file, or "data:…" if embedded; empty: none
	std::array<Wrap, 2> wraps{Wrap::repeat, Wrap::repeat}; // of the picture, along u and v
	bool picture_outside = false;                          // it lies outside the level's folder, and is not to be read

	bool operator==(const Material&) const = default;
};

// A node of the file's tree, or a mesh below its node.
struct PartNode
{
	std::string name;
	int parent = -1;                 // index into Level::nodes; −1: none
	std::vector<std::string> extras; // "key=value"
};

// Triangles of one placement of a mesh of the file.
struct Mesh
{
	std::string name;
	std::size_t first_triangle = 0;
	std::size_t triangle_count = 0;

	// For a cell cut out of a level (cutCell):
	bool around = false; // surroundings: occludes, but belongs to another cell
	bool closed = false; // part of a closed surface, possibly cut: its back is never visible

	int node = -1; // index into Level::nodes; −1: the file has no tree
};

struct Level
{
	std::string name; // file name without its folder, or "builtin:NAME"

	// Vertices. Positions are double, so that a level far from the origin, or a small mesh moved there by its node, keeps its
	// shape.
	std::vector<glm::dvec3> positions; // world space, metres, y up
	std::vector<glm::vec3> normals;    // per vertex; unit, or zero if the file has none
	std::vector<glm::vec2> uvs;        // per vertex; v grows downward from the top row, as in glTF
	std::vector<glm::vec3> colours;    // per vertex, linear; empty: none in the file
	std::vector<uint32_t> sources;     // per vertex: its number in the file; empty: unknown
	std::size_t source_count = 0;      // vertices of the file, used or not

	std::vector<glm::uvec3> triangles; // vertex indices, counter-clockwise seen from the front
	std::vector<uint32_t> materials;   // per triangle, index into material_list
	std::vector<Mesh> meshes;          // cover the triangles in order, without gaps
	std::vector<PartNode> nodes;       // parents first
	std::vector<Material> material_list;
	std::vector<Mask> masks;
	std::vector<LevelCamera> cameras;
	std::vector<std::string> files; // files read for this level, its own first; empty for builtin levels
};

// Bounding box of all used vertices; least > most without triangles.
struct Bounds
{
	glm::dvec3 least{1e300};
	glm::dvec3 most{-1e300};
};
Bounds boundsOf(const Level& level);
Bounds boundsOf(const Level& level, std::size_t triangle);
Bounds boundsOf(const Level& level, const Mesh& mesh);

// The box that 32-bit positions go by: that of everything, or if strays with up to a twentieth of the area at each end make it a
// thousand times as large, that of the rest. Also for `count` boxes, with weights for areas.
using BoxOf = std::function<Bounds(std::size_t)>;
using WeightOf = std::function<double(std::size_t)>;
Bounds preciseBounds(const Level& level);
Bounds preciseBounds(std::size_t count, const BoxOf& boxOf, const WeightOf& weightOf);

// Also without strays that are closer: drops the triangles at both ends of each axis, 1/2000 of the area each, as long as that more
// than halves the diagonal.
Bounds mainBounds(const Level& level);

// Alpha of a mask at texture coordinates (u, v), in [0, 1], magnified like a texture unit with the mask's filter.
double alphaAt(const Mask& mask, glm::dvec2 uv);

// True if the surface exists for a ray: factor × mask ≥ cut-off; always true for opaque materials.
bool isSolidAt(const Level& level, const Material& material, glm::dvec2 uv);

// Number of a mask's pixels with each of the 256 values.
using AlphaCounts = std::array<uint64_t, 256>;
AlphaCounts countAlpha(const Mask& mask);

// Sets mean_alpha and coverage from factor, cut-off and mask; the second form avoids rereading the pixels for many materials with
// one mask.
void measureAlpha(Material& material, const std::vector<Mask>& masks);
void measureAlpha(Material& material, const AlphaCounts& counts);

// Returns 1 for each triangle that one of the patterns chooses. A pattern chooses nodes by name, with everything below them, and
// meshes: "Lamp", "Lamp*"; by path: "/Room/**/Lamp", "Room/*"; "material:GLOB"; "extras:KEY" or "extras:KEY=VALUE" of nodes,
// meshes and materials. Empty without patterns. Throws Error (usage) for a pattern that chooses no triangle; `option` names it.
std::vector<uint8_t> chosenTriangles(const Level& level, std::span<const std::string> patterns, const std::string& option);

// "/Room/Lamp/Cube": what a pattern for this mesh alone may be.
std::string pathOf(const Level& level, const Mesh& mesh);

// The triangles of a level that are marked with 1, and their vertices.
struct LevelPart
{
	Level level;
	std::vector<uint32_t> vertices; // per vertex of the whole level: its index in the part, or UINT32_MAX
};
LevelPart partOf(const Level& level, std::span<const uint8_t> marks, int threads);

// How triangles of a level were split at the middles of edges.
struct LevelSplit
{
	std::vector<uint32_t> origins;                      // per triangle: the one before that it is a part of, ascending
	std::vector<std::pair<uint32_t, uint32_t>> middles; // per vertex behind those before: the two that it lies between
};

// Cuts a box out of a level, with the surroundings needed for the same light as in the whole level.

struct CellSettings
{
	Bounds box;            // world, metres
	double around_m = 0.0; // ≥ 0: how far surroundings extend beyond the box and the cell's own triangles
};

// Keeps the triangles whose centre is in the box (lower faces included, upper ones excluded), so that each triangle of a level is
// in exactly one cell of a grid. Adds meshes with the surroundings (Mesh::around): triangles whose bounds are that close. No
// triangle is cut. `closed`: 1 for triangles of closed surfaces (Mesh::closed); empty: none is known. Keeps cameras in the box.
// The result is empty if no triangle is in the box.
Level cutCell(const Level& level, const CellSettings& settings, std::span<const uint8_t> closed, int threads);

// Boxes of a grid of counts.x × counts.y × counts.z equal cells over a level's bounds, x fastest, then y and z. The last ones
// extend slightly further, so that every triangle is in one.
std::vector<Bounds> gridOf(const Level& level, glm::uvec3 counts);

} // namespace nook
