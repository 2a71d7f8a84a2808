// SPDX-License-Identifier: GPL-3.0-or-later
// nook volumes: a level → its ambient occlusion volumes, for programs that draw them.
#include "call.h"
#include "scene_options.h"

#include "core/decimal.h"
#include "core/lists.h"
#include "core/work_units.h"
#include "scene/tracer.h"
#include "version.h"
#include "volume/build.h"
#include "volume/receivers.h"
#include "volume/volume_glb.h"
#include "volume/volumes.h"

#include <array>
#include <optional>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kVolumeFormats{".glb"};
constexpr std::array<std::string_view, 2> kLayouts{"polygons", "prisms"};          // of VolumeLayout, in its order
constexpr std::array<std::string_view, 2> kCurveMeasures{"eq14", "rmse"};          // of CurveMeasure
constexpr std::array<std::string_view, 3> kSides{"auto", "oriented", "two-sided"}; // of Sides

struct VolumeOptions
{
	LevelOptions level;
	VolumeSettings settings;
	CurveMeasure measure = CompensateSettings{}.measure; // that --compensate fits to
	bool no_drop = false;
	bool outside = false; // a camera may be anywhere outside the level's bounds
	VolumeFileSettings file;
	std::vector<std::string> occluders;
	std::vector<std::string> receivers;
	Outputs outputs;
};

// "1/512" or "0.002".
double shareOfText(const std::string& option, const std::string& text, bool whole_too)
{
	const std::size_t slash = text.find('/');
	const double whole = slash == std::string::npos ? 1.0 : numberFrom<double>(text.substr(slash + 1)).value_or(0.0);
	const double share = numberFrom<double>(text.substr(0, slash)).value_or(0.0) / whole;
	refuseValueIf(!(whole > 0.0 && share > 0.0 && (share < 1.0 || (whole_too && share <= 1.0))), option, text,
				  std::string("a share above 0, ") + (whole_too ? "at most" : "below") + " 1: 0.002 or 1/512");
	return share;
}
double shareUpToOne(const std::string& option, const std::string& text)
{
	return shareOfText(option, text, true);
}

// "2", or "none" as 0.
void takeExtent(const std::string& option, const std::string& text, OccluderSettings& settings)
{
	const double extent = numberFrom<double>(text).value_or(0.0);
	refuseValueIf(text != "none" && !(extent >= 0.1 && extent <= 1e6), option, text, "0.1 or more, at most 1e6, or none");
	settings.extent = extent;
	settings.extent_always = true;
}

// "0.02", "auto", "auto:0.1".
void takeDetail(const std::string& option, const std::string& text, VolumeSettings& settings)
{
	constexpr std::string_view kAuto = "auto";
	if (!text.starts_with(kAuto))
	{
		settings.occluders.detail = shareOfText(option, text, false);
		return;
	}
	double& more = settings.detail_more.emplace(0.0);
	if (text != kAuto)
	{
		more = shareUpToOne(option, text.starts_with("auto:") ? text.substr(kAuto.size() + 1) : text);
	}
}

double flatOf(const std::string& option, const std::string& text)
{
	const double flat = numberFrom<double>(text).value_or(0.0);
	refuseValueIf(!(flat >= 1e-6 && flat <= 0.05), option, text, "a share from 1e-6 to 0.05");
	return flat;
}

std::vector<OptionRow> occluderRows(OccluderSettings& occluders, VolumeSettings& settings)
{
	return {
		{"--sides", takesChoice(kSides, occluders.sides),
		 "Which sides of a polygon darken: the front of closed opaque surfaces and both of all others (auto, default), the front "
		 "alone, or both"},
		{"--no-merge", takesFlag(occluders.merge, false),
		 "A polygon for each triangle; else neighbours in one plane become one, or a few that are convex",
		 excludes("--flat or --extent", "one or the other", "with --flat or --extent")},
		{"--flat", takesParsed("SHARE", occluders.flat, flatOf),
		 "How far off their plane merged neighbours may lie, as a share of the distance, 1e-6 to 0.05 (default 1e-4; what is "
		 "two-sided at most 5e-5)"},
		{"--extent", takesParsed("X", [&](const std::string& name, const std::string& text) { takeExtent(name, text, occluders); }),
		 "Cuts merged polygons in halves until they are at most this many times the distance long, 0.1 or more, or none (default "
		 "2, or twice, four times … that where a quarter more polygons would not do): smaller ones fall off sideways, which is "
		 "nearer to what rays give"},
		{"--detail",
		 takesParsed("SHARE", [&](const std::string& name, const std::string& text) { takeDetail(name, text, settings); }),
		 "Simplifies surfaces that darken on one side only, moving them by about this share at most of the distance, below 1; "
		 "auto: as far as errors at sampled points grow by a twentieth at most (with --masks a quarter), auto:SHARE: by that share "
		 "(default: not)"}};
}

std::vector<OptionRow> dropRows(VolumeOptions& options)
{
	DropSettings& drop = options.settings.drop;
	const auto takeCameras = [&](const std::string& name, const std::string& text)
	{
		const std::optional<Bounds> box = cameraBoxOf(name, text);
		if (box)
		{
			drop.visible_from.push_back(*box);
		}
		options.outside = options.outside || !box;
	};
	return {{"--no-drop", takesFlag(options.no_drop), "All volumes: the three --keep options in one",
			 excludes("--drop-below or --flat-normals or --visible-from")},
			{"--keep-unlit", takesFlag(drop.no_receiver, false),
			 "Also volumes that darken nothing: no surface within them sees their polygon",
			 excludes("--visible-from or --flat-normals")},
			{"--keep-sides", takesFlag(drop.sides, false), "Also the sides of two-sided polygons that darken nothing"},
			{"--keep-inside", takesFlag(drop.inside, false), "Also what lies inside solids, where no camera comes"},
			{"--flat-normals", takesFlag(drop.smooth_normals, false),
			 "For renderers that shade with the triangles' normals: what would darken nothing but surfaces whose normals are "
			 "interpolated between vertices is dropped, too"},
			{"--drop-below", takesParsed("SHARE", drop.below, shareUpToOne),
			 "Drops the least contributions, as long as no receiver loses more occlusion than this in all: 1/512 (default: none)"},
			{"--visible-from", takesEach("BOX", takeCameras),
			 "A box that holds cameras, X,Y,Z,X,Y,Z, or outside, for cameras anywhere outside the level's bounds; may be repeated: "
			 "volumes that darken only what none of them sees are dropped (default: cameras may be anywhere)"}};
}

void declare(CLI::App& app, VolumeOptions& options)
{
	VolumeSettings& settings = options.settings;
	addLevelOptions(app, options.level);
	addOptions(app, {{"--distance", takesNumber(settings.distance_m, 1e-6, 1e9, "M"),
					  "How far a polygon darkens what lies before it, metres", kRequired},
					 {"--ray-distance", takesNumber(settings.ray_distance_m, 1e-6, 1e10, "M"),
					  "Radius of the ray-traced reference with linear falloff that they stand for, metres (default: distance / "
					  "0.6, or fitted by "
					  "--compensate)"},
					 {"--masks", takesFlag(settings.masks),
					  "For masks of directions (aov-mask): rays of the distance itself, no curve, and --detail auto judges masks",
					  excludes("--ray-distance or --compensate")},
					 partsRow("--occluders", options.occluders,
							  "The only parts of the level that get volumes, chosen as by --ignore (default: all)"),
					 partsRow("--receivers", options.receivers,
							  "The only parts to darken, chosen as by --ignore: volumes that darken none of them are dropped "
							  "(default: all)",
							  excludes("--no-drop or --keep-unlit"))});
	addOptions(app, occluderRows(settings.occluders, settings));
	addOptions(app, dropRows(options));
	addOptions(
		app,
		{{"--trim",
		  takesParsed("SHARE", [&settings](const std::string& name, const std::string& text)
					  { settings.trim.emplace().share = shareUpToOne(name, text); }),
		  "Makes volumes lower and narrower where no sampled point loses more than this share of the sum of all volumes by that "
		  "(or of 0.05, where that is more): fewer fragments; 0.1, 0.15 (default: not)"},
		 {"--compensate", takesFlag([&settings] { settings.compensate.emplace(); }),
		  "Fits the curve from sums of volumes to occlusion to this level, by rays (default: the paper's curve)"},
		 {"--compensate-measure", takesChoice(kCurveMeasures, options.measure),
		  "What --compensate fits the curve to: the values' RMSE (default), or AOV's eq. 14, mostly differences of neighbours",
		  needs("--compensate")},
		 {"--verify", takesFlag([&settings] { settings.verify.emplace(); }),
		  "Evaluates all volumes and those kept at sampled points, and says how far they differ"},
		 {"--exact-bounds", takesFlag(settings.exact_bounds),
		  "Volumes hold every point that they darken; else sharp corners are cut at twice the distance"},
		 {"--memory", takesBytes(settings.memory_bytes),
		  "2GiB: refuses a level that may take more, before work starts (default: no limit)"},
		 {"--degrade", takesFlag(settings.degrade),
		  "With --memory: leaves out steps, with a warning, until the level takes no more; refuses it only where that is not "
		  "enough",
		  needs("--memory")},
		 {"--layout", takesChoice(kLayouts, options.file.layout),
		  "polygons: compact, a vertex shader makes the volumes (default); prisms: their points and triangles, too"},
		 {"--compress", takesFlag(options.file.compress), "Compresses the file's arrays (EXT_meshopt_compression)"}});
	addOutputs(app, options.outputs, kVolumeFormats);
	addRun(app, options.outputs, true);
}

void settle(VolumeOptions& options)
{
	VolumeSettings& settings = options.settings;
	settings.occluders.distance_m = settings.distance_m;
	if (settings.compensate)
	{
		settings.compensate->measure = options.measure;
	}
	if (options.no_drop)
	{
		settings.drop.no_receiver = false;
		settings.drop.sides = false;
		settings.drop.inside = false;
	}
}

void run(VolumeOptions& options, VerbProgress& progress)
{
	settle(options);
	const DropSettings& drop = options.settings.drop;
	const bool alone = !drop.no_receiver && !drop.sides && !drop.inside && drop.below <= 0.0 && !options.settings.compensate;
	refuseIf(options.outputs.share && alone, // every share would do all of the work
			 "--share: found with --no-drop and without --compensate, which leave nothing to share out, expected one run");
	options.settings.written_bytes = writtenBytes(options.file.layout);
	checkOutputs(options.outputs, kVolumeFormats, {options.level.level});
	VolumeSettings& settings = options.settings;
	const RunSettings how = progress.start("volumes", options.outputs.threads, options.outputs.progress);
	const std::shared_ptr<const LoadedLevel> shared = levelOf(options.level.level, options.level.load, how);
	const LoadedLevel& loaded = *shared;
	checkRead(options.outputs, loaded.level.files);
	addInputs(loaded.level.files, how);
	const std::vector<uint8_t> occluding = chosenTriangles(loaded.level, options.occluders, "occluders");
	std::optional<LevelPart> part;
	if (!occluding.empty())
	{
		settings.occluding = &part.emplace(partOf(loaded.level, occluding, how.threads)).level;
	}
	if (options.outside)
	{
		append(settings.drop.visible_from, boxesAround(loaded.level));
	}
	settings.drop.receivers = chosenTriangles(loaded.level, options.receivers, "receivers");
	BuiltVolumes built = buildVolumes(loaded.level, settings, how);
	if (isShare(how))
	{
		return;
	}
	clusterVolumes(built.set, settings.masks ? kMaskClusters : ClusterSettings{}, how);
	const VolumeFile file = volumeGlb(built.set, options.file, loaded.level.name, "nook " NOOK_VERSION, how);
	std::optional<VerifyResult> quantised;
	if (built.verified)
	{
		const Tracer tracer(loaded.level, how);
		const VolumeSet rounded = unpacked(file.packed, built.set);
		quantised = verifyVolumes(built.set, rounded, sampleReceivers(tracer, settings.distance_m, *settings.verify, how), how);
	}

	const Occluders& occluders = built.set.occluders;
	give<double>("corners", occluders.corners, {occluders.corners.size(), 3});
	give("first_corner", occluders.polygons, &Occluder::first_corner);
	give("corner_count", occluders.polygons, &Occluder::corner_count);
	give("alpha", occluders.polygons, &Occluder::alpha);
	Facts facts = verbFacts("volumes");
	addLevelFacts(facts, loaded);
	describeBuilt(built, file, settings, quantised, facts);
	writeOutputs(
		options.outputs, [&](const std::string&) { return file.bytes; }, facts.json(), loaded.level.files,
		options.outputs.json.empty() ? facts.lines() : "");
	for (const std::string& warning : built.warnings)
	{
		warn(warning);
	}
}

} // namespace

Verb addVolumesVerb(CLI::App& nook)
{
	return addVerb<VolumeOptions>(
		nook, "volumes", "Makes a level's static ambient occlusion volumes: polygons that a GPU draws as volumes", declare, run);
}

} // namespace nook
