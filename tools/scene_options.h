// SPDX-License-Identifier: GPL-3.0-or-later
// Options that several verbs share: levels and how they are read, cameras, pictures, G-buffers, and features of methods.
#pragma once

#include "options.h"

#include "methods/feature_checks.h"
#include "scene/camera_choice.h"
#include "scene/gbuffer.h"
#include "scene/load.h"
#include "scene/reference.h"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr const char* kLevelHelp = "A level (.gltf .glb .obj .fbx .ply .stl) or builtin:NAME";
inline constexpr std::array<std::string_view, 8> kLoadOptions{"--unit",          "--up",   "--strict", "--max-texels",
															  "--allow-outside", "--pose", "--tr",     "--ignore"};

struct LevelOptions
{
	std::string level; // a file, or builtin:NAME
	LoadSettings load;
};

// LEVEL and kLoadOptions.
void addLevelOptions(CLI::App& app, LevelOptions& options);

// A list of patterns of parts of the level (chosenTriangles), after the option's name.
OptionRow partsRow(const std::string& name, std::vector<std::string>& patterns, const std::string& help, OptionRules rules = {});

// kLoadOptions alone, for verbs whose file may be something else.
void addLoadOptions(CLI::App& app, LoadSettings& load);

inline constexpr std::array<std::string_view, 3> kFalloffs{"hard", "linear", "alchemy"}; // of Falloff, in its order
OptionRow falloffUnitRow(std::optional<double>& unit_m);

// The unit that is given, or that of the radius. Throws Error (usage) for a radius out of range, or where there is none.
double falloffUnit(const std::optional<double>& unit_m, double radius_m, Falloff falloff);

// Name, triangles, and the findings as "id count".
void addLevelFacts(Facts& facts, const LoadedLevel& loaded);

// "X,Y,Z", metres, each from −1e15 to 1e15. Throws Error (usage) of `option`.
glm::dvec3 positionOf(const std::string& option, const std::string& text);

// "WxH", pixels. Throws Error (usage) of `option`.
glm::ivec2 sizeOf(const std::string& option, const std::string& text);

// "X,Y,Z,X,Y,Z": the least corner first, which the other is nowhere below. Throws Error (usage) of `option`.
Bounds boxOf(const std::string& option, const std::string& text);

// Likewise, or "outside" as none.
std::optional<Bounds> cameraBoxOf(const std::string& option, const std::string& text);

// --camera, --eye, --target, --fov, --near, --projection, --world-to-camera, --size, --allow-inside. Then checkCameras().
void addCameraOptions(CLI::App& app, CameraOptions& options);

// --camera alone; --size alone, whose numbers have their defaults.
OptionRow cameraRow(CameraOptions& options);
OptionRow sizeRow(int& width_px, int& height_px);

// --depth, --clip, --sky-depth, --depth-channel, --normal-channels, --normal-space, --normal-range: what the file's channels hold.
inline constexpr std::array<std::string_view, 7> kChannelOptions{
	"--depth", "--clip", "--sky-depth", "--depth-channel", "--normal-channels", "--normal-space", "--normal-range"};
void addGBufferChannels(CLI::App& app, GBufferImport& import);

// kChannelOptions, --normals, --viewport, --projection, --world-to-camera, for readGBuffer(); the file's values by default.
void addGBufferImport(CLI::App& app, GBufferImport& import);

// Before any work: refuses options that contradict each other. Throws Error (usage).
void checkGBufferImport(const GBufferImport& import);

// Features (feature_table.h) and --recipe as options of nook shade and nook emit; options that name the volumes' methods.

inline constexpr std::array<std::string_view, 2> kModuleDepths{"linear", "device"}; // that a module reads

// One of the table's rows. `more` ends its line of help.
OptionRow featureOption(const FeatureRow& row, ShadeSettings& settings, const std::string& more = {}, OptionRules rules = {});

// Those of a place (kInShade, kInEmit) that fit, in the table's order.
std::vector<OptionRow> featureOptions(unsigned place, const std::function<bool(const FeatureRow&)>& fits, ShadeSettings& settings,
									  const OptionRules& rules = {});

// Those of a place that were given.
GivenFeatures givenFeatures(const CLI::App& app, unsigned place);

// The given options as words of a command: " --cut --filter window".
std::string featuresText(const CLI::App& app, const GivenFeatures& features);

OptionRow recipeRow(std::string& name, OptionRules rules = {});

// The methods that draw volumes: all, the one that adds them up, the one that masks.
std::string volumeMethods(const std::string& between);
std::string sumMethod();
std::string maskMethod();

// --directions of the method that masks, a multiple of 32.
OptionRow directionsRow(int& directions, OptionRules rules = {});

} // namespace nook
