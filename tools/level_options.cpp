// SPDX-License-Identifier: GPL-3.0-or-later
#include "level_options.h"

#include <array>

namespace nook
{
namespace
{

// Names of UpAxis, in its order without `file`.
constexpr std::array<std::string_view, 3> kUpAxes{"x", "y", "z"};

// Names of Pose, in its order.
constexpr std::array<std::string_view, 2> kPoses{"file", "rest"};

// Names of TrMeaning, in its order.
constexpr std::array<std::string_view, 3> kTrMeanings{"auto", "transparency", "opacity"};

} // namespace

std::vector<CLI::Option*> addLoadOptions(CLI::App& app, LoadSettings& load)
{
	CLI::Option* const unit = addNumber(app, "--unit", load.unit_m, 1e-9, 1e9,
										"Metres of one unit of the level's file (default: glTF 1, FBX its own, others 1)");
	CLI::Option* const up = addChoiceText(
		app, "--up", kUpAxes, [&load](std::size_t i) { load.up = static_cast<UpAxis>(i + 1); },
		"Axis of the level's file that points up (default: FBX its own, others y)");
	CLI::Option* const strict =
		app.add_flag("--strict", load.strict, "Anything odd that is found in the level is an error (exit code 3)");
	CLI::Option* const texels = addLong(
		app, "--max-texels", [&load](uint64_t most) { load.max_texels = most; }, 1, kMostTexels,
		"Texels that a picture which acts as a mask may have (default " + std::to_string(kMaxTexels) + ")");
	CLI::Option* const outside = app.add_flag("--allow-outside", load.allow_outside,
											  "Files that the level names may lie outside its folder and those below it");
	CLI::Option* const pose = addChoiceText(
		app, "--pose", kPoses, [&load](std::size_t i) { load.pose = static_cast<Pose>(i); },
		"Skinned and morphed meshes as the level's file shows them, or in their rest pose (default: file)");
	CLI::Option* const tr = addChoiceText(
		app, "--tr", kTrMeanings, [&load](std::size_t i) { load.tr = static_cast<TrMeaning>(i); },
		"Meaning of Tr in the level's MTL files, where there is no d (default: auto, transparency but that 1 is opaque)");
	return {unit, up, strict, texels, outside, pose, tr};
}

void addLevelOptions(CLI::App& app, LevelOptions& options)
{
	addText(app, "LEVEL", options.level, "LEVEL", "A level (.gltf .glb .obj .fbx .ply .stl) or builtin:NAME")->required();
	addLoadOptions(app, options.load);
}

} // namespace nook
