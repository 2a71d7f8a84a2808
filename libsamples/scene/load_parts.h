// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the parts of loadLevel(): contents of a level's files before masks are decoded and triangles are cleaned.
#pragma once

#include "core/file.h"
#include "core/isolate.h"
#include "core/progress.h"
#include "scene/level.h"
#include "scene/load.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// More is a mistake or an attack: instances multiply a small file. 1.5 GiB of triangles alone.
inline constexpr std::size_t kMaxTriangles = std::size_t{1} << 26U;

// How a picture is applied as a mask.
struct MaskUse
{
	Wrap wrap_u = Wrap::repeat;
	Wrap wrap_v = Wrap::repeat;
	MaskChannel channel = MaskChannel::alpha;
	double base = 0.0; // mask = base + gain × channel, clamped to 0…1: MTL's -mm
	double gain = 1.0;

	bool operator==(const MaskUse&) const = default;
};

// A mask picture, still encoded.
struct MaskSource : MaskUse
{
	std::string name;  // for errors and Mask::name
	std::string path;  // file to read; empty: use `bytes`
	std::string bytes; // file contents, if embedded in another file
	bool nearest = false;
	bool ramp = false; // no picture: alpha is u, for surfaces with vertex alphas
};

// A picture, and how its coordinates follow from a set.
struct PlacedPicture : MaskSource
{
	glm::dmat3 uv_of_set{1.0};
};

// A material of a format with polygons, as its reader sends it.
struct FileMaterial
{
	std::string name;
	float alpha = 1.0F; // opacity
	bool two_sided = false;
	glm::vec3 colour{1.0F};
	PlacedPicture opacity; // an empty name means none
	PlacedPicture picture; // of the colour, likewise
};
inline void visit(Archive& archive, PlacedPicture& picture)
{
	archive(picture.name, picture.wrap_u, picture.wrap_v, picture.channel, picture.base, picture.gain, picture.uv_of_set,
			picture.bytes);
}
inline void visit(Archive& archive, FileMaterial& material)
{
	archive(material.name, material.alpha, material.two_sided, material.colour, material.opacity, material.picture);
}

struct SourceMaterial
{
	Material material;      // complete except for mask, mean_alpha and coverage
	int mask = -1;          // index of a MaskSource
	bool transmits = false; // light passes through what is present
	uint32_t uv_set = 0;    // texture coordinate set of the mask
	uint32_t occlusion_set = 0;
	glm::dmat3 uv_of_set{1.0}; // KHR_texture_transform, MTL's -s and -o: from the set's (u, v, 1) to the mask's
};

// A primitive of a glTF file at one place in its scene, and where its vertices are in the level.
struct GltfPlace
{
	std::size_t node = 0;
	std::optional<std::size_t> instance;                 // by EXT_mesh_gpu_instancing
	std::size_t primitive = 0;                           // of the node's mesh
	std::size_t count = 0;                               // vertices of the primitive, used or not
	std::size_t triangle = 0;                            // its first one of the level as read
	std::vector<uint32_t> triangles;                     // all of them, in the order of the file
	std::size_t mesh = 0;                                // of the node
	bool mirrored = false;                               // the level has its corners in the other order
	std::vector<std::pair<uint32_t, uint32_t>> vertices; // number in the primitive, and in the level; each used one once
	std::vector<glm::uvec3> corners;                     // of the triangles: numbers in the primitive, in the order of the file
};

struct LevelSource
{
	std::vector<SourceMaterial> materials;
	std::vector<MaskSource> masks;
	std::vector<LevelCamera> cameras;
	std::vector<Finding> findings;     // from reading
	std::vector<std::string> missing;  // files that are named but missing, although not needed; may have duplicates
	std::vector<std::string> files;    // files read, in order, without duplicates; the level first
	std::vector<glm::vec2> second_uvs; // one per vertex if a second set was requested
	std::vector<GltfPlace> places;     // with kPlacesSet
};

// Counts occurrences of one kind and keeps the first location.
struct Tally
{
	uint64_t count = 0;
	std::string first;

	void add(const std::string& place, uint64_t times = 1)
	{
		if (count == 0 && times > 0)
		{
			first = place;
		}
		count += times;
	}
};

// Reports parts that a level rarely needs: collision meshes and skies, by their names; skies and strays, by their place.
void findUndrawn(const Level& level, std::vector<Finding>& findings);

// Adds a finding if the tally is not empty; diagnosis.cpp's table gives its action.
void report(std::vector<Finding>& findings, std::string_view id, const Tally& tally);

// Merges findings from reading into those of the triangles, in the table's order.
void addFindings(Diagnosis& diagnosis, const std::vector<Finding>& findings);

// Adds the file to `missing` if it does not exist.
void noteMissingFile(LevelSource& source, const std::string& path);

// "wall.png" referenced by "levels/house.obj" → "levels/wall.png"; converts backslashes to slashes.
std::string besideLevel(const std::string& level_path, std::string name);

// Rejects an existing file that is not in the level's folder or below, after following links; `reference` says who names it:
// "level.obj: mtllib". Throws Error (invalid_input) unless `allow_outside`.
void checkInside(const std::string& level_path, const std::string& reference, const std::string& path,
				 const LoadSettings& settings);
bool isInside(const std::string& level_path, const std::string& path); // or missing

// Axes and unit of `settings` as one matrix from the file's coordinates (y up by default) to metres, y up.
glm::dmat4 worldFromFile(const LoadSettings& settings);

// For a file that states its axes (FBX): which axis, in which direction, points right, up and to the viewer.
struct FileAxes
{
	std::array<int, 3> axes{0, 1, 2};
	std::array<int, 3> signs{1, 1, 1};
	double unit_m = 1.0;
};
glm::dmat4 worldFromFile(const LoadSettings& settings, const FileAxes& file);

// Transforms normals along with `world`, and keeps them outward under reflections: its cofactors, proportional to the transposed
// inverse.
glm::dmat3 normalsFrom(const glm::dmat4& world);

// Keeps the file's length, for the diagnosis. NaN for a missing normal: among existing ones that is as wrong as a non-finite one.
glm::vec3 turnedNormal(const glm::dmat3& turn, glm::dvec3 normal);

// Rotation and translation of a matrix that may also scale, shear or mirror.
glm::dmat4 rigidOf(const glm::dmat4& matrix);

// Names unnamed cameras "camera 2", and numbers repeated names.
void nameCameras(std::vector<LevelCamera>& cameras);

// Special values for a texture coordinate set: values of nook bake, front and back; indexed by BakedKind.
inline constexpr std::array<uint32_t, 3> kBakedSets{0xfffffffdU, 0xfffffffeU, 0xffffffffU};
// Likewise: no coordinates, but LevelSource::places.
inline constexpr uint32_t kPlacesSet = 0xfffffffcU;

// Likewise, for the set that each material's occlusionTexture uses.
inline constexpr uint32_t kOcclusionSet = 0xfffffffbU;
inline constexpr std::array<std::string_view, 3> kBakedNames{"_VISIBILITY", "_DIFFERENCE", "_DIFFERENCE_MASK"};

// Reads a checked glTF file: appends triangles to `level`; returns materials, encoded masks, cameras and findings. `second_set`:
// the texture coordinate set to return in second_uvs unchanged, NaN for vertices without. Does not affect the level.
LevelSource readGltf(const std::string& path, const LoadSettings& settings, Level& level, std::optional<uint32_t> second_set = {});

// Any other format: reads in a worker; appends triangles to `level`, and materials and cameras to `source`.
void readGeometry(const std::string& path, const LoadSettings& settings, LevelSource& source, Level& level);

// Worker protocol (level_worker.cpp, fbx_source.cpp): a path and FileSettings → what readGeometry() expects, in that order.
inline constexpr const char* kLevelWorker = "nook_level_worker";
inline constexpr const char* kReadLevel = "read level";

// Memory and time limits for reading that many bytes of a level.
IsolationLimits levelLimits(std::size_t bytes);

// Findings counted while reading, in the order in which they are sent.
inline constexpr std::array<std::string_view, 7> kSentFindings{
	"hidden-nodes", "lower-lods", "posed-meshes", "not-applied", "inverted-transparency", "points-or-lines", "bad-polygons"};
using SentTallies = std::map<std::string_view, Tally>;
void sendTallies(SentTallies& tallies, ValueWriter& to);

// Precedes a mesh's arrays.
struct MeshHead
{
	uint32_t material = 0;
	bool none = false; // there are no more meshes
};

// Throws Error (invalid_input) for more triangles, or three times as many vertices, than a level may have. `counted` says which
// ones: ", counting every instance".
void checkCounts(const std::string& where, uint64_t triangles, uint64_t vertices, const std::string& counted);

// Extension in lower case: ".gltf".
std::string endingOf(const std::string& path);

// Decodes the masks and moves materials and cameras to the level.
void finishMaterials(const LoadSettings& settings, LevelSource& source, Level& level);

// Drops the triangles with keep[i] = 0, vertices that no other triangle uses (their indices may be out of range), and meshes that
// become empty. Preserves the order. Returns the earlier index of each vertex that is left.
std::vector<uint32_t> compactLevel(Level& level, std::span<const uint8_t> keep, int threads);

// TEXCOORD_1 of a glTF, or another set, one per vertex of `level`, the result of loadLevel() for the same name and settings; NaN
// for vertices without. The level's vertices do not depend on these coordinates.
// Empty if nothing has any, and for other formats. Reads the file again; throws like loadLevel(), and Error (invalid_input) if the
// file has changed.
std::vector<glm::vec2> loadSecondUvs(const std::string& name, const LoadSettings& settings, const Level& level,
									 const RunSettings& run, uint32_t set = 1);

// Where the vertices of `level`, loaded from a glTF file, are in that file. A vertex of dropped triangles alone gets the level's
// vertex at its position, with the nearest normal; none if there is none. Reads the file again, as loadSecondUvs() does.
// `receivers`: patterns of the places to return (chosenTriangles); empty: all. `as_read`: becomes the level before it was cleaned,
// which the vertices then belong to.
std::vector<GltfPlace> loadPlaces(const std::string& name, const LoadSettings& settings, const Level& level,
								  std::span<const std::string> receivers, const RunSettings& run, Level* as_read = nullptr);

} // namespace nook
