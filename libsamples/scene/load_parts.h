// SPDX-License-Identifier: GPL-3.0-or-later
// Between the parts of loadLevel(): what a level's files hold, before masks are decoded and triangles are cleaned.
#pragma once

#include "core/isolate.h"
#include "core/uri.h"
#include "scene/diagnosis.h"
#include "scene/load.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// More is a mistake or an attack: instances multiply what little a file holds. 1.5 GiB of triangles alone.
inline constexpr std::size_t kMaxTriangles = std::size_t{1} << 26U;

// How a picture acts as a mask.
struct MaskUse
{
	Wrap wrap_u = Wrap::repeat;
	Wrap wrap_v = Wrap::repeat;
	MaskChannel channel = MaskChannel::alpha;
	double base = 0.0; // the mask is base + gain × the channel, within 0 to 1: MTL's -mm
	double gain = 1.0;

	bool operator==(const MaskUse&) const = default;
};

// A picture that acts as a mask, still encoded.
struct MaskSource : MaskUse
{
	std::string name;  // for errors and Mask::name
	std::string path;  // of its file; empty: `bytes` holds it
	std::string bytes; // the file's bytes, where it lies inside another file
	bool nearest = false;
	bool ramp = false; // no picture: alpha is u, for a surface whose vertices have alphas
};

struct SourceMaterial
{
	Material material;         // all but mask, mean_alpha and coverage
	int mask = -1;             // index of a MaskSource
	bool transmits = false;    // light passes through what is there
	uint32_t uv_set = 0;       // of the mesh, that the mask uses
	glm::dmat3 uv_of_set{1.0}; // KHR_texture_transform, MTL's -s and -o: (u, v, 1) of the mask from the set's
};

struct LevelSource
{
	std::vector<SourceMaterial> materials;
	std::vector<MaskSource> masks;
	std::vector<LevelCamera> cameras;
	std::vector<Finding> findings;     // of reading
	std::vector<std::string> missing;  // files that are named and not there, though nothing here needs them; some more than once
	std::vector<std::string> files;    // read, in order, each once; the level's own first
	std::vector<glm::vec2> second_uvs; // one a vertex where a second set was asked for
};

// Counts occurrences of one kind and keeps the first place.
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

// Adds a finding where there is anything to report; its action is that of the table in diagnosis.cpp.
void report(std::vector<Finding>& findings, std::string_view id, const Tally& tally);

// Adds findings of reading to those of the triangles, in the table's order.
void addFindings(Diagnosis& diagnosis, const std::vector<Finding>& findings);

// Adds a path that is not there yet.
void addFile(std::vector<std::string>& files, const std::string& path);

// To `missing`, where there is no such file.
void noteMissingFile(LevelSource& source, const std::string& path);

// "wall.png" beside "levels/house.obj" → "levels/wall.png"; back-slashes of other systems become slashes.
std::string besideLevel(const std::string& level_path, std::string name);

// Refuses a file that is there but not in the level's folder or one below it, links followed; `reference` says who names it:
// "level.obj: mtllib". Throws Error (invalid_input) unless `allow_outside`.
void checkInside(const std::string& level_path, const std::string& reference, const std::string& path,
				 const LoadSettings& settings);

// The axes and the unit of `settings` as one matrix: metres, y up, from the file's coordinates (y up where the file says nothing).
glm::dmat4 worldFromFile(const LoadSettings& settings);

// The same for a file that says itself how it lies (FBX): which of its axes, and which way, points right, up and to the viewer.
struct FileAxes
{
	std::array<int, 3> axes{0, 1, 2};
	std::array<int, 3> signs{1, 1, 1};
	double unit_m = 1.0;
};
glm::dmat4 worldFromFile(const LoadSettings& settings, const FileAxes& file);

// What turns normals as `world` turns surfaces, and faces them outward where it mirrors: its cofactors, the transposed inverse but
// for a factor.
glm::dmat3 normalsFrom(const glm::dmat4& world);

// The length stays the file's, for the diagnosis; NaN where there is none: among others that is as wrong as one that is no number.
glm::vec3 turnedNormal(const glm::dmat3& turn, glm::dvec3 normal);

// Rotation and translation of a matrix that may also scale, shear or mirror.
glm::dmat4 rigidOf(const glm::dmat4& matrix);

// "camera 2" where a name is missing; a name that occurs again gets a number.
void nameCameras(std::vector<LevelCamera>& cameras);

// In place of a number of texture coordinates: values of nook bake, of front and back; of BakedKind, in its order.
inline constexpr std::array<uint32_t, 3> kBakedSets{0xfffffffdU, 0xfffffffeU, 0xffffffffU};
inline constexpr std::array<std::string_view, 3> kBakedNames{"_VISIBILITY", "_DIFFERENCE", "_DIFFERENCE_MASK"};

// A checked glTF file: triangles into `level`; materials, masks that are still encoded, cameras and findings are returned.
// `second_set`: the number of texture coordinates that second_uvs returns as they stand, NaN for vertices without. The level is the
// same with and without it.
LevelSource readGltf(const std::string& path, const LoadSettings& settings, Level& level, std::optional<uint32_t> second_set = {});

// Any other format: triangles into `level`, reading in a worker; materials and cameras into `source`.
void readGeometry(const std::string& path, const LoadSettings& settings, LevelSource& source, Level& level);

// Its worker (load_assimp.cpp, fbx_source.cpp): a path and LoadSettings → what readGeometry() takes, in that order.
inline constexpr const char* kLevelWorker = "nook_level_worker";
inline constexpr const char* kReadLevel = "read level";

// What reading so many bytes of a level may take of memory and time.
IsolationLimits levelLimits(std::size_t bytes);

// Findings that it counts while it reads, in the order in which it sends them.
inline constexpr std::array<std::string_view, 7> kSentFindings{
	"hidden-nodes", "lower-lods", "posed-meshes", "not-applied", "inverted-transparency", "points-or-lines", "bad-polygons"};
using SentTallies = std::map<std::string_view, Tally>;

// What is sent of a mesh before its arrays.
struct MeshHead
{
	uint32_t material = 0;
	bool none = false; // the last mesh came before
};

// ".gltf", in lower case.
std::string endingOf(const std::string& path);

// Decodes the masks and hands materials and cameras to the level.
void finishMaterials(const LoadSettings& settings, LevelSource& source, Level& level);

} // namespace nook
