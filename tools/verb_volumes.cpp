// SPDX-License-Identifier: GPL-3.0-or-later
// nook volumes: a level → its ambient occlusion volumes, for programs that draw them.
#include "level_options.h"
#include "options.h"
#include "scene_summary.h"
#include "summary.h"
#include "volume_info.h"
#include "volume_options.h"

#include "core/error.h"
#include "core/system.h"
#include "core/text.h"
#include "core/work_units.h"
#include "scene/load.h"
#include "scene/tracer.h"
#include "version.h"
#include "volume/build.h"
#include "volume/clusters.h"
#include "volume/verify.h"
#include "volume/volume_glb.h"

#include <array>
#include <chrono>
#include <cstdio>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kVolumeFormats{".glb"};
constexpr std::array<std::string_view, 2> kLayouts{"polygons", "prisms"}; // of VolumeLayout, in its order

struct VerbOptions
{
	LevelOptions level;
	VolumeOptions volumes;
	VolumeFileSettings file;
	Outputs outputs;
	int threads = 0;
};

// Seconds of each step, a line on stderr where that is a terminal.
class Times
{
public:
	void step(const char* name)
	{
		const auto now = std::chrono::steady_clock::now();
		char text[64];
		std::snprintf(text, sizeof text, "%s%s %.2f s", m_line.empty() ? "" : ", ", name,
					  std::chrono::duration<double>(now - m_last).count());
		m_line += text;
		m_last = now;
	}
	void say() const
	{
		if (isTerminal())
		{
			std::fprintf(stderr, "\r\033[K%s\n", m_line.c_str());
		}
	}

private:
	std::chrono::steady_clock::time_point m_last = std::chrono::steady_clock::now();
	std::string m_line;
};

// Without them every part would do all of the work.
void checkShared(const VolumeSettings& settings)
{
	const DropSettings& drop = settings.drop;
	if (!drop.no_receiver && !drop.sides && !drop.inside && !drop.hidden && drop.below <= 0.0 && !settings.compensate)
	{
		throw Error(ExitCode::usage, "--part: found with --no-drop and without --compensate, which leave nothing to share out, "
									 "expected one run");
	}
}

void run(VerbOptions options, VerbProgress& progress)
{
	settleVolumeOptions(options.volumes);
	if (options.outputs.part)
	{
		checkShared(options.volumes.settings);
	}
	options.volumes.settings.written_bytes = writtenBytes(options.file.layout);
	options.volumes.settings.leave_out = !options.level.load.strict;
	checkOutputs(options.outputs, kVolumeFormats, {options.level.level});
	const VolumeSettings& settings = options.volumes.settings;
	const RunSettings how = progress.start("volumes", options.threads, options.outputs.progress);
	Times times;
	const LoadedLevel loaded = loadLevel(options.level.level, options.level.load, how);
	checkRead(options.outputs, loaded.level.files);
	times.step("level");
	addInputs(loaded.level.files, how);
	BuiltVolumes built = buildVolumes(loaded.level, settings, how);
	finishUnits(how);
	times.step("volumes");
	clusterVolumes(built.set, {}, how);
	const VolumeFile file = volumeGlb(built.set, options.file, loaded.level.name, "nook " NOOK_VERSION, how);
	times.step("file");
	std::optional<VerifyResult> quantised;
	if (built.verified)
	{
		const Tracer tracer(loaded.level, how);
		const VolumeSet rounded = unpacked(file.packed, built.set);
		quantised = verifyVolumes(built.set, rounded, sampleReceivers(tracer, settings.distance_m, *settings.verify, how), how);
		times.step("16-bit numbers");
	}

	Summary summary("volumes");
	addLevelFacts(summary, loaded);
	const std::string lines = describeBuilt(built, file, settings, quantised, summary);
	OutputSet files;
	for (const std::string& path : options.outputs.files)
	{
		files.add(path, file.bytes);
	}
	addSide(files, options.outputs, summary.json(), loaded.level.files);
	if (options.outputs.json.empty() && isStdoutFree(options.outputs))
	{
		files.add("-", lines);
	}
	files.commit();
	times.say();
	for (const std::string& warning : built.warnings)
	{
		std::fprintf(stderr, "nook: warning: %s\n", oneLine(warning).c_str());
	}
	if (built.dropped.hidden_lost && options.level.load.strict)
	{
		throw Error(ExitCode::difference, loaded.level.name + ": drop-hidden: found a loss above what was asked, expected none");
	}
}

} // namespace

Verb addVolumesVerb(CLI::App& nook)
{
	const auto options = std::make_shared<VerbOptions>();
	CLI::App* const app =
		nook.add_subcommand("volumes", "Makes a level's static ambient occlusion volumes: polygons that a GPU draws as volumes");
	addLevelOptions(*app, options->level);
	addVolumeOptions(*app, options->volumes);
	addChoiceText(
		*app, "--layout", kLayouts, [options](std::size_t i) { options->file.layout = static_cast<VolumeLayout>(i); },
		"polygons: compact, a vertex shader makes the volumes (default); prisms: their points and triangles, too");
	app->add_flag("--compress", options->file.compress, "Compresses the file's arrays (EXT_meshopt_compression)");
	addOutputs(*app, options->outputs, kVolumeFormats);
	addThreads(*app, options->threads);
	addProgress(*app, options->outputs.progress);
	addPart(*app, options->outputs.part);
	addUnitCache(*app);
	return {app, [options](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

} // namespace nook
