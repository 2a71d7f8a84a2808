// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of assets that are made of a level before it is drawn, one row each. The reports and `nook tune` read
// the rows and name no kind. A new kind is a row here, its code and a test.
#pragma once

#include "emit/module.h"
#include "methods/candidate_axes.h"
#include "scene/load.h"
#include "shade/aov.h"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// Which volumes of a level are drawn.
enum class VolumeRecipe
{
	triangles, // AOV §5: all triangles, one volume each, with the paper's curve
	built,     // merged, dropped, trimmed to kBuiltTrim, with a curve fitted to the level
	masks,     // merged and dropped, as far as the reference's rays reach (distance = radius)
};
template <> inline constexpr std::array<std::string_view, 3> kNamesOf<VolumeRecipe>{"triangles", "built", "masks"};
inline constexpr double kBuiltTrim = 0.15;

// How an asset is made and drawn; each kind reads its own settings.
struct AssetSettings
{
	AovSettings aov;
	VolumeRecipe volumes = VolumeRecipe::built;
	double bake_error = 0.0; // BakeSettings::max_error; 0: the level's vertices
};

struct AssetCandidate
{
	Origin origin = Origin::ours;
	AssetSettings settings;
};

// The input of an asset.
struct AssetSource
{
	const Level& level;
	const Tracer& tracer;  // of that level
	double radius_m = 1.0; // reach of the rays that it stands for, with linear falloff
	double few = 0.0;      // BakeSettings::few
};

// The command and the level that an asset's file names.
struct AssetFile
{
	std::string_view version; // of nook
	std::string command;      // that makes the file, for its record
	const std::string& level; // file or builtin level
	const LoadSettings& load; // how it was read
	const RunSettings& run;
};

class LevelAsset
{
public:
	virtual ~LevelAsset() = default;

	// Throws Error (unsupported) if the device cannot.
	virtual AovShaded draw(const GBuffer& gbuffer, const AssetSettings& settings, bool gl, const RunSettings& run,
						   const DrawSettings& drawing) const = 0;

	// Size of its file, or of what it adds to the level's.
	virtual uint64_t bytes() = 0;

	// Its file, and a short description of it.
	virtual std::string file(const AssetFile& of, std::string& what) const = 0;
};

struct EmittedFile
{
	std::string name;
	std::string bytes;
	std::string what; // a few words
};

// A level that an asset is made of, on the command line.
struct AssetLevel
{
	std::string words; // its file and how that is read
	double radius_m = 1.0;
};

// Everything that an engine needs in order to draw an asset.
struct AssetEmission
{
	AssetSettings settings;
	GlslTarget target = GlslTarget::gl330;
	bool device_depth = false;
	std::string version;
	std::function<void()> add_levels; // appends each level's file and command

	std::vector<EmittedFile> files{};
	std::vector<std::string> commands{}; // make the files again, in order
	std::vector<std::string> use{};      // what the engine has to set or do, one line each
};

struct AssetKind
{
	std::string_view name{};                                            // on the command line and in candidates: "aov"
	std::string_view what{};                                            // "occlusion volumes"
	std::string_view ending{};                                          // of its files
	std::string_view option{};                                          // of `nook shade`, for its file: "--bake"
	bool slow = false;                                                  // may take seconds per picture
	bool with_level = false;                                            // drawn with the level, which takes no extra time
	double pixel_s = 0.0;                                               // rough seconds to draw a pixel, on one thread
	double (*make_s)(const AssetSettings&, double triangles) = nullptr; // likewise to make it

	std::vector<AssetCandidate> (*candidates)(GridSize) = nullptr;
	std::string (*words)(const AssetSettings&) = nullptr;           // after its name in candidates: " built third"
	std::string (*key)(const AssetSettings&) = nullptr;             // equal for settings that need the same asset
	std::string_view (*resolution)(const AssetSettings&) = nullptr; // "third"; null: always "full"
	AssetSettings (*definition)(const AssetSettings&) = nullptr;    // at the best that it can do; null: it is that
	std::unique_ptr<LevelAsset> (*make)(const AssetSource&, const AssetSettings&, const RunSettings&) = nullptr;
	std::string (*command)(const AssetSettings&, const AssetLevel&) = nullptr; // makes the file, without -o
	void (*emit)(AssetEmission&) = nullptr;                                    // for `nook tune`; calls add_levels
};

// Volumes and masks, bakes, then others.
std::span<const AssetKind> assetTable();

// Null if no kind has that name.
const AssetKind* assetNamed(std::string_view name);

// The kinds that have no row in the method table (method_table.h).
std::vector<const AssetKind*> kindsBesideMethods();

// Their names, each after a comma: ", bake".
std::string namesBesideMethods();

} // namespace nook
