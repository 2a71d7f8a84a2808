// SPDX-License-Identifier: GPL-3.0-or-later
// nook level: any level that nook reads, as one file that other programs read.
#include "level_options.h"
#include "options.h"
#include "scene_summary.h"
#include "summary.h"

#include "emit/level_glb.h"
#include "scene/load.h"
#include "version.h"

#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kFormats{".glb"};

struct ConvertOptions
{
	LevelOptions level;
	Outputs outputs;
	int threads = 0;
};

void run(const ConvertOptions& options)
{
	checkOutputs(options.outputs, kFormats, {options.level.level});
	const LoadedLevel loaded = loadLevel(options.level.level, options.level.load, runSettings(options.threads));
	OutputSet files;
	if (!options.outputs.files.empty())
	{
		const std::string bytes = levelGlb(loaded.level, "nook " NOOK_VERSION);
		for (const std::string& path : options.outputs.files)
		{
			files.add(path, bytes);
		}
	}
	Summary summary("level");
	addLevelFacts(summary, loaded);
	addSide(files, options.outputs, summary.json(), loaded.level.files);
	files.commit();
}

} // namespace

Verb addLevelVerb(CLI::App& nook)
{
	const auto options = std::make_shared<ConvertOptions>();
	CLI::App* const app =
		nook.add_subcommand("level", "Writes a level as one binary glTF file: triangles, masks and cameras, cleaned and in metres");
	addLevelOptions(*app, options->level);
	addOutputs(*app, options->outputs, kFormats);
	addThreads(*app, options->threads);
	return {app, [options]
			{
				run(*options);
			}};
}

} // namespace nook
