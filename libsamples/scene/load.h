// SPDX-License-Identifier: GPL-3.0-or-later
// A level's name → the level, clean, with its diagnosis.
#pragma once

#include "core/image.h"
#include "core/progress.h"
#include "scene/diagnosis.h"
#include "scene/level.h"

#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <string_view>

namespace nook
{

enum class UpAxis
{
	file, // as the format or the file says: glTF y; FBX its own; others y
	x,
	y,
	z,
};

// Which shape a skinned or morphed mesh is read in.
enum class Pose
{
	file, // as the file shows it: glTF node transforms and default weights; FBX the same
	rest, // the vertices as they are stored, without skin and morph targets
};

// The meaning of Tr in an MTL file that has no d beside it.
enum class TrMeaning
{
	automatic,    // transparency, as the format has it; but 1 is opaque
	transparency, // 1 too: not there
	opacity,      // as some programs write it
};

struct LoadSettings
{
	double unit_m = 0.0; // metres of one unit of the file; 0: as the format or the file says (glTF 1, FBX its own, others 1)
	UpAxis up = UpAxis::file;
	bool strict = false;                   // findings are errors
	std::uint64_t max_texels = kMaxTexels; // of a picture that acts as a mask, before it is decoded
	bool allow_outside = false;            // files that the level names may lie outside its folder
	Pose pose = Pose::file;
	TrMeaning tr = TrMeaning::automatic;
};

struct LoadedLevel
{
	Level level;
	Diagnosis diagnosis;
};

// A level among several that become one.
struct PlacedLevel
{
	std::string name;
	glm::dvec3 move{0.0}; // metres, after the file's unit and axes
};

// True for "builtin:…" and for files whose ending is one of a level.
bool isLevelName(const std::string& name);

// A file (.gltf .glb .obj .fbx .ply .stl) or "builtin:NAME". Throws Error: file where something cannot be read, naming it;
// invalid_input where it cannot be understood, has no triangle, has findings under `strict`, or names a file outside its folder;
// unsupported for a glTF that requires an extension which changes its triangles. Files are read in a worker (core/isolate.h). Same
// bytes for any thread count.
LoadedLevel loadLevel(const std::string& name, const LoadSettings& settings, const RunSettings& run);

// The same of several, one behind the other, cleaned and diagnosed together: a wall that two of them have is there once. Requires
// one at least. Throws as well where all of them together have more triangles than a level may have.
LoadedLevel loadLevels(std::span<const PlacedLevel> levels, const LoadSettings& settings, const RunSettings& run);

} // namespace nook
