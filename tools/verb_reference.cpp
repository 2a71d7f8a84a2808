// SPDX-License-Identifier: GPL-3.0-or-later
// nook reference: a level and the pixels of a G-buffer, or given points → visibility by rays, with its standard error.
#include "call.h"
#include "scene_options.h"

#include "core/decimal.h"
#include "core/lists.h"
#include "core/work_units.h"
#include "format/pattern_file.h"
#include "scene/reference.h"
#include "scene/sample_set.h"
#include "version.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 2> kImageFormats{".exr", ".png"};
constexpr std::array<std::string_view, 1> kPointFormats{".csv"};
constexpr std::array<std::string_view, 3> kAllFormats{".exr", ".png", ".csv"};
constexpr std::array<std::string_view, 5> kMeasures{"obscurance", "sphere", "hemisphere", "box", "bent"};
constexpr std::array<std::string_view, 2> kSources{"geometry", "depth"};

struct ReferenceOptions
{
	std::string level; // may be empty where the depth alone decides
	LoadSettings load;
	std::string gbuffer;
	std::string points;
	GBufferImport import;
	ReferenceSettings settings;
	std::optional<double> falloff_u_m;
	std::optional<int> rays;
	std::vector<std::string> occluders;
	Outputs outputs;
};

void declare(CLI::App& app, ReferenceOptions& options)
{
	ReferenceSettings& settings = options.settings;
	const std::string volumes = "--measure sphere|hemisphere|box";
	addOptions(app, {{"LEVEL", takesText(options.level, "LEVEL"), kLevelHelp}});
	addLoadOptions(app, options.load);
	addOptions(
		app,
		{{"--gbuffer", takesText(options.gbuffer, "FILE.exr"), "The pixels to work on"},
		 {"--points", takesText(options.points, "FILE.csv"),
		  "The points to work on, one a line: x,y,z,nx,ny,nz (position in metres and normal, world space)"},
		 {"--radius", takesNumber(settings.radius_m, 1e-6, std::numeric_limits<double>::infinity()),
		  "Metres that a ray reaches, or radius of the volume (box: half its side), to 1e9; inf: without end", kRequired},
		 {"--measure", takesChoice(kMeasures, settings.measure),
		  "Obscurance by rays over the hemisphere (default), or the open share of a volume around the point: the sphere, its half "
		  "above the surface, the box along the camera's axes; bent: obscurance, and the mean direction of what is open"},
		 {"--falloff", takesChoice(kFalloffs, settings.falloff),
		  "Weight of a surface at distance t: hard 1 (default), linear 1 - t/radius, alchemy u t / max(u, t)^2",
		  excludes(volumes, "--measure obscurance or bent", "with the open share of a volume")},
		 falloffUnitRow(options.falloff_u_m),
		 {"--from",
		  takesChoice(kSources, settings.source),
		  "What the volume holds: the level's solids (default), or whatever is behind the depth buffer, which needs no LEVEL",
		  {.excludes = {{"--measure obscurance|bent", "sphere, hemisphere or box"}},
		   .needs = {{volumes, "sphere, hemisphere or box", "with --measure obscurance"}}}},
		 {"--rays", takesWhole(options.rays, 1, kMaxSamples),
		  "Rays, or samples of the volume, a point (default 256; with --max-error the most, default 4096)"},
		 {"--max-error", takesNumber(settings.max_error, 1e-5, 1.0), "Stop at a point once its standard error is this small"},
		 {"--lift", takesNumber(settings.lift_m, 0.0, 1e6),
		  "Metres by which points may be off the level's surface beside rounding, as levels of detail are (default 0): rays begin "
		  "that much above them",
		  excludes("--from depth", "none, since no ray begins anywhere")},
		 partsRow("--occluders", options.occluders,
				  "The only parts of the level that rays meet, chosen as by --ignore (default: all)",
				  excludes("--from depth", "none, since no ray meets the level")),
		 seedRow(settings.seed)});
	addGBufferImport(app, options.import);
	addOutputs(app, options.outputs, kAllFormats);
	addRun(app, options.outputs, true);
}

bool fromDepth(const ReferenceSettings& settings)
{
	return !isByRays(settings.measure) && settings.source == MatterSource::depth;
}

// Options that contradict each other; defaults that depend on others.
void settle(ReferenceOptions& options)
{
	ReferenceSettings& settings = options.settings;
	const bool volume = !isByRays(settings.measure);
	refuseIf(options.gbuffer.empty() == options.points.empty(),
			 "reference: found " + std::string(options.gbuffer.empty() ? "no" : "two") +
				 " lists of points, expected --gbuffer FILE.exr or --points FILE.csv");
	refuseIf(std::isinf(settings.radius_m) && (volume || settings.falloff == Falloff::linear),
			 "--radius: found 'inf', expected metres, since what is measured is a share of it");
	refuseIf(!options.points.empty() && (fromDepth(settings) || settings.measure == ReferenceMeasure::box),
			 "--points: found with a measure that needs a camera, expected --gbuffer FILE.exr");
	refuseIf(options.level.empty() && !fromDepth(settings),
			 "LEVEL: found none, expected a level, or --from depth with --measure sphere, hemisphere or box");
	refuseIf(!options.level.empty() && fromDepth(settings),
			 "LEVEL: found with --from depth, expected none, since the depth buffer alone decides");
	settings.falloff_u_m = falloffUnit(options.falloff_u_m, settings.radius_m, settings.falloff);
	settings.rays = options.rays.value_or(settings.max_error > 0.0 ? 4096 : settings.rays);
	checkGBufferImport(options.import);
}

// Facts about a whole run, for the file's notes.
Notes notesOf(const ReferenceOptions& options)
{
	const ReferenceSettings& settings = options.settings;
	Notes notes{{"Software", "nook " NOOK_VERSION},
				{"nook:measure", std::string(kMeasures[static_cast<std::size_t>(settings.measure)])},
				{"nook:radius_m", numberText(settings.radius_m)},
				{"nook:rays", std::to_string(settings.rays)},
				{"nook:seed", std::to_string(settings.seed)}};
	if (isByRays(settings.measure))
	{
		notes.push_back({"nook:falloff", std::string(kFalloffs[static_cast<std::size_t>(settings.falloff)])});
		if (settings.falloff == Falloff::alchemy)
		{
			notes.push_back({"nook:falloff_u_m", numberText(settings.falloff_u_m)});
		}
	}
	else
	{
		notes.push_back({"nook:from", std::string(kSources[static_cast<std::size_t>(settings.source)])});
	}
	if (settings.max_error > 0.0)
	{
		notes.push_back({"nook:max_error", numberText(settings.max_error)});
	}
	if (settings.lift_m > 0.0)
	{
		notes.push_back({"nook:lift_m", numberText(settings.lift_m)});
	}
	return notes;
}

void addSettings(Facts& facts, const ReferenceOptions& options)
{
	const ReferenceSettings& settings = options.settings;
	facts.text("measure", kMeasures[static_cast<std::size_t>(settings.measure)]);
	if (isByRays(settings.measure))
	{
		facts.text("falloff", kFalloffs[static_cast<std::size_t>(settings.falloff)]);
	}
	else
	{
		facts.text("from", kSources[static_cast<std::size_t>(settings.source)]);
	}
	facts.number("radius_m", settings.radius_m);
	facts.when(settings.falloff == Falloff::alchemy).number("falloff_u_m", settings.falloff_u_m);
	facts.whole("rays_a_point", settings.rays);
	facts.when(settings.max_error > 0.0).number("max_error", settings.max_error);
	facts.when(settings.lift_m > 0.0).number("lift_m", settings.lift_m);
	facts.when(!options.occluders.empty()).texts("occluders", options.occluders);
	facts.whole("seed", settings.seed);
}

void summarise(Facts& facts, std::span<const ReferenceValue> values)
{
	double visibility = 0.0;
	double squared_error = 0.0;
	double greatest = 0.0;
	std::size_t rays = 0;
	std::size_t points = 0;
	for (const ReferenceValue& value : values)
	{
		if (value.rays > 0) // not sky
		{
			points += 1;
			rays += static_cast<std::size_t>(value.rays);
			visibility += value.visibility;
			squared_error += value.standard_error * value.standard_error;
			greatest = std::max(greatest, value.standard_error);
		}
	}
	const auto count = static_cast<double>(std::max<std::size_t>(points, 1));
	facts.whole("points", points);
	facts.whole("rays", rays);
	facts.number("mean_visibility", points > 0 ? visibility / count : 1.0);
	facts.number("rms_standard_error", std::sqrt(squared_error / count));
	facts.number("greatest_standard_error", greatest);
}

std::string imageBytes(std::string_view ending, const GBuffer& gbuffer, std::span<const ReferenceValue> values, bool bent,
					   const Notes& notes)
{
	if (bent)
	{
		return ending == ".png" ? bentPng(gbuffer.width_px, gbuffer.height_px, values, notes)
								: bentExr(gbuffer.width_px, gbuffer.height_px, values, notes);
	}
	return ending == ".png" ? visibilityPng(gbuffer.width_px, gbuffer.height_px, values, notes)
							: visibilityExr(gbuffer.width_px, gbuffer.height_px, values, notes);
}

void run(ReferenceOptions& options, VerbProgress& progress)
{
	settle(options);
	const bool image = !options.gbuffer.empty();
	const std::span<const std::string_view> formats = image ? std::span<const std::string_view>(kImageFormats) : kPointFormats;
	const std::string input = image ? options.gbuffer : options.points;
	checkOutputs(options.outputs, formats, {input, options.level});
	const RunSettings run_settings = progress.start("reference", options.outputs.threads, options.outputs.progress);

	std::vector<std::string> read{input};
	const GBuffer gbuffer = image ? readGBuffer(input, options.import) : GBuffer{};
	const std::vector<ReferencePoint> points = image               ? std::vector<ReferencePoint>{}
											   : t_call != nullptr ? std::move(t_call->points)
																   : readPoints(input);
	std::shared_ptr<const LoadedLevel> loaded;
	std::optional<Tracer> tracer;
	Facts facts = verbFacts("reference");
	if (!options.level.empty())
	{
		loaded = levelOf(options.level, options.load, run_settings);
		checkRead(options.outputs, loaded->level.files);
		const std::optional<Vicinity> near = image ? reachOf(loaded->level, gbuffer, options.settings) : std::nullopt;
		tracer.emplace(loaded->level, run_settings, near ? &*near : nullptr,
					   chosenTriangles(loaded->level, options.occluders, "occluders"));
		append(read, loaded->level.files);
		addLevelFacts(facts, *loaded);
	}
	addInputs(read, run_settings);
	const std::vector<ReferenceValue> values =
		image ? referenceOfGBuffer(tracer ? &*tracer : nullptr, gbuffer, options.settings, run_settings)
			  : referenceAtPoints(*tracer, points, options.settings, run_settings);
	if (isShare(run_settings))
	{
		return;
	}

	const Notes notes = notesOf(options);
	const bool bent = options.settings.measure == ReferenceMeasure::bent;
	addSettings(facts, options);
	summarise(facts, values);
	give("visibility", values, &ReferenceValue::visibility);
	give("standard_error", values, &ReferenceValue::standard_error);
	give("rays", values, &ReferenceValue::rays);
	if (bent)
	{
		give<float>("bent", mapped(values, [](const ReferenceValue& value) { return value.bent; }), {values.size(), 3});
	}
	const auto bytesOf = [&](const std::string& path)
	{
		return image  ? imageBytes(formatOf(path, formats), gbuffer, values, bent, notes)
			   : bent ? bentCsv(values)
					  : visibilityCsv(values);
	};
	writeOutputs(options.outputs, bytesOf, facts.json(), read);
}

} // namespace

Verb addReferenceVerb(CLI::App& nook)
{
	return addVerb<ReferenceOptions>(nook, "reference", "Visibility by ray tracing, with its standard error", declare, run);
}

} // namespace nook
