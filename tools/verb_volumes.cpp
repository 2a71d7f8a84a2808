// SPDX-License-Identifier: GPL-3.0-or-later
// nook volumes: a level → its ambient occlusion volumes, for programs that draw them.
#include "level_options.h"
#include "options.h"
#include "scene_summary.h"
#include "summary.h"

#include "core/error.h"
#include "emit/volume_glb.h"
#include "scene/load.h"
#include "version.h"
#include "volume/clusters.h"

#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kFormats{".glb"};
constexpr std::array<std::string_view, 2> kLayouts{"polygons", "prisms"}; // of VolumeLayout, in its order

struct VolumeOptions
{
	LevelOptions level;
	double distance_m = 0.0;
	VolumeFileSettings file;
	Outputs outputs;
	int threads = 0;
};

void run(const VolumeOptions& options)
{
	checkOutputs(options.outputs, kFormats, {options.level.level});
	const RunSettings settings = runSettings(options.threads);
	const LoadedLevel loaded = loadLevel(options.level.level, options.level.load, settings);
	VolumeSet set;
	set.distance_m = options.distance_m;
	set.ray_distance_m = options.distance_m / 0.6;
	const Level& level = loaded.level;
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		Occluder& polygon = set.occluders.polygons.emplace_back();
		polygon.first_corner = static_cast<uint32_t>(set.occluders.corners.size());
		polygon.triangle = static_cast<uint32_t>(t);
		polygon.alpha = static_cast<float>(level.material_list[level.materials[t]].mean_alpha);
		polygon.two_sided = level.material_list[level.materials[t]].two_sided;
		for (int i = 0; i < 3; ++i)
		{
			set.occluders.corners.push_back(level.positions[level.triangles[t][i]]);
		}
	}
	clusterVolumes(set, {}, settings);
	const VolumeFile file = volumeGlb(set, options.file, level.name, "nook " NOOK_VERSION, settings);
	OutputSet files;
	for (const std::string& path : options.outputs.files)
	{
		files.add(path, file.bytes);
	}
	Summary summary("volumes");
	addLevelFacts(summary, loaded);
	summary.number("distance_m", options.distance_m);
	summary.whole("polygons", file.packed.polygons.size());
	summary.whole("clusters", file.packed.clusters.size());
	summary.whole("bytes", file.bytes.size());
	summary.number("quantisation_error_m", file.packed.greatest_error_m);
	addSide(files, options.outputs, summary.json(), level.files);
	files.commit();
}

} // namespace

Verb addVolumesVerb(CLI::App& nook)
{
	const auto options = std::make_shared<VolumeOptions>();
	CLI::App* const app =
		nook.add_subcommand("volumes", "Makes a level's static ambient occlusion volumes: polygons that a GPU draws as volumes");
	addLevelOptions(*app, options->level);
	addNumber(*app, "--distance", options->distance_m, 1e-6, 1e9, "How far a polygon darkens what lies before it, metres")
		->type_name("M")
		->required();
	addChoiceText(
		*app, "--layout", kLayouts, [options](std::size_t i) { options->file.layout = static_cast<VolumeLayout>(i); },
		"polygons: compact, a vertex shader makes the volumes (default); prisms: their points and triangles, too");
	app->add_flag("--compress", options->file.compress, "Compresses the file's arrays (EXT_meshopt_compression)");
	addOutputs(*app, options->outputs, kFormats);
	addThreads(*app, options->threads);
	return {app, [options]
			{
				run(*options);
			}};
}

} // namespace nook
