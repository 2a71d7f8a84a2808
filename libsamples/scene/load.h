// SPDX-License-Identifier: GPL-3.0-or-later
// Loads, cleans and diagnoses a level.
#pragma once

#include "core/image.h"
#include "core/progress.h"
#include "scene/level.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace nook
{

// From here on adjacent 32-bit numbers are at least 2^13 × 2^-23 m ≈ 0.98 mm apart.
inline constexpr double kLarge_m = 8192.0;

struct Finding
{
	std::string id;     // stable: "non-finite-vertices"
	uint64_t count = 0; // ≥ 1
	std::string first;  // first occurrence: "mesh 'wall', triangle 12"
	std::string action; // what was done: "dropped", "welded", "kept"
};

struct Diagnosis
{
	std::vector<Finding> findings; // in the order of the table in docs/reference/levels.md; empty: no findings
};

enum class UpAxis
{
	file, // as the format or file states: glTF y; FBX its own; others y
	x,
	y,
	z,
};

// The shape of skinned and morphed meshes.
enum class Pose
{
	file, // as the file shows it: node transforms and default weights
	rest, // stored vertices, without skins and morph targets
};

// Meaning of Tr in an MTL file without d.
enum class TrMeaning
{
	automatic,    // transparency, as specified; but 1 is opaque
	transparency, // transparency, and 1 is invisible
	opacity,      // opacity, as some programs write it
};

// How a file is read.
struct FileSettings
{
	double unit_m = 0.0; // metres per unit of the file; 0: as the format or the file states (glTF 1, FBX its own, others 1)
	UpAxis up = UpAxis::file;
	bool strict = false;                   // findings become errors
	std::uint64_t max_texels = kMaxTexels; // limit for a mask picture, checked before decoding
	bool allow_outside = false;            // files that the level names may be outside its folder
	Pose pose = Pose::file;
	TrMeaning tr = TrMeaning::automatic;
};

struct LoadSettings : FileSettings
{
	std::vector<std::string> ignore; // patterns of parts that are left out (chosenTriangles)
	bool undo_bake = false;          // a glTF file as it was before nook bake, if it has not changed since
};

struct LoadedLevel
{
	Level level;
	Diagnosis diagnosis;
};

// One of several levels to join.
struct PlacedLevel
{
	std::string name;
	glm::dvec3 move{0.0}; // metres, after applying the file's unit and axes
};

// True for "builtin:…" and for files with a level's extension.
bool isLevelName(const std::string& name);

// A file (.gltf .glb .obj .fbx .ply .stl) or "builtin:NAME". Throws Error: file if something cannot be read, naming it;
// invalid_input if it is malformed, has no triangle, has findings under `strict`, or names a file outside its folder; unsupported
// for a glTF that requires an unsupported extension which changes its triangles. Files are read in a worker (core/isolate.h). Same
// bytes for any thread count.
LoadedLevel loadLevel(const std::string& name, const LoadSettings& settings, const RunSettings& run);

// Likewise for several levels, joined in order and cleaned and diagnosed together: a wall that two of them contain is kept once.
// Requires at least one. Also throws if together they have more triangles than a level may have.
LoadedLevel loadLevels(std::span<const PlacedLevel> levels, const LoadSettings& settings, const RunSettings& run);

// Cleans and diagnoses a level from memory, whose indices are in range. `vertices`: for each vertex that is left, its index before.
// Throws Error (invalid_input) if no triangle is left, or there are findings under `strict`.
LoadedLevel loadLevel(Level level, bool strict, std::vector<uint32_t>& vertices, const RunSettings& run);

// Drops unusable triangles and reports oddities. Keeps every triangle that a ray can hit, once. `before`: becomes the earlier index
// of each vertex that is left.
Diagnosis cleanLevel(Level& level, const RunSettings& run, std::vector<uint32_t>* before = nullptr);

} // namespace nook
