// SPDX-License-Identifier: GPL-3.0-or-later
// nook bake: a level → the same level with visibility at its vertices.
#include "level_options.h"
#include "options.h"
#include "scene_summary.h"
#include "summary.h"

#include "bake/bake.h"
#include "core/error.h"
#include "core/number.h"
#include "core/text.h"
#include "scene/level_glb.h"
#include "scene/sample_set.h"
#include "version.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kBakeFormats{".glb"};
constexpr std::array<std::string_view, 3> kBakeFalloffs{"hard", "linear", "alchemy"}; // of Falloff, in its order
constexpr std::array<std::string_view, 2> kBakeFits{"surface", "points"};             // of BakeFit
constexpr std::array<std::string_view, 2> kBakeNormals{"geometric", "interpolated"};  // of NormalKind
constexpr std::size_t kCheckPoints = 4096;

struct BakeOptions
{
	LevelOptions level;
	BakeSettings settings;
	bool has_u = false;
	bool has_cap = false;
	bool color = false;
	Outputs outputs;
	int threads = 0;
};

void declare(CLI::App& app, BakeOptions& options)
{
	BakeSettings& settings = options.settings;
	addLevelOptions(app, options.level);
	addNumber(app, "--radius", settings.radius_m, 1e-6, std::numeric_limits<double>::infinity(),
			  "Metres that a ray reaches, to 1e9; inf: without end")
		->required();
	addChoiceText(
		app, "--falloff", kBakeFalloffs, [&settings](std::size_t i) { settings.falloff = static_cast<Falloff>(i); },
		"Weight of a surface at distance t: hard 1 (default), linear 1 - t/radius, alchemy u t / max(u, t)^2");
	addNumber(app, "--falloff-u", settings.falloff_u_m, 1e-9, 1e9,
			  "u of --falloff alchemy, metres (default: a tenth of the radius)")
		->each([&options](const std::string&) { options.has_u = true; });
	addWhole(app, "--rays", settings.rays, 1, kMaxSamples, "Rays a vertex (default 256)");
	addChoiceText(
		app, "--fit", kBakeFits, [&settings](std::size_t i) { settings.fit = static_cast<BakeFit>(i); },
		"surface: values whose interpolation is nearest to rays all over the triangles (default); points: those at the vertices");
	addChoiceText(
		app, "--normals", kBakeNormals, [&settings](std::size_t i) { settings.normals = static_cast<NormalKind>(i); },
		"Rays lie around the triangles' own normals (default) or around those of the vertices, interpolated");
	addNumber(app, "--max-error", settings.max_error, 1e-3, 1.0,
			  "Splits triangles whose root mean square error is above that, and neighbours, so that no crack opens");
	addLong(
		app, "--max-vertices",
		[&options](uint64_t most)
		{
			options.settings.max_vertices = static_cast<std::size_t>(most);
			options.has_cap = true;
		},
		3, 100'000'000, "With --max-error: no more vertices than that (default 2000000)");
	app.add_flag("--color", options.color, "Visibility as COLOR_0, too, which viewers multiply their colours by");
	addSeed(app, settings.seed);
	addOutputs(app, options.outputs, kBakeFormats);
	addThreads(app, options.threads);
	addProgress(app, options.outputs.progress);
}

[[noreturn]] void refuseBake(const std::string& message)
{
	throw Error(ExitCode::usage, message);
}

// Options that contradict each other; defaults that depend on others.
void settle(BakeOptions& options)
{
	BakeSettings& settings = options.settings;
	if (options.has_u && settings.falloff != Falloff::alchemy)
	{
		refuseBake("--falloff-u: found without --falloff alchemy, expected both or none");
	}
	if (std::isinf(settings.radius_m) && settings.falloff == Falloff::linear)
	{
		refuseBake("--radius: found 'inf', expected metres, since --falloff linear is a share of it");
	}
	if (std::isfinite(settings.radius_m) && settings.radius_m > 1e9)
	{
		refuseValue("--radius", numberText(settings.radius_m), "metres from 0.000001 to 1000000000, or inf");
	}
	if (options.has_cap && settings.max_error == 0.0)
	{
		refuseBake("--max-vertices: found without --max-error, expected both or none");
	}
	if (settings.max_error > 0.0 && settings.fit == BakeFit::points)
	{
		refuseBake("--max-error: found with --fit points, expected --fit surface, whose error it is");
	}
	if (!options.has_u)
	{
		if (settings.falloff == Falloff::alchemy && std::isinf(settings.radius_m))
		{
			refuseBake("--falloff-u: found none, expected metres, since the radius is without end");
		}
		settings.falloff_u_m = 0.1 * settings.radius_m;
	}
}

void addSettings(Summary& summary, const BakeSettings& settings)
{
	summary.text("fit", kBakeFits[static_cast<std::size_t>(settings.fit)]);
	summary.text("normals", kBakeNormals[static_cast<std::size_t>(settings.normals)]);
	summary.text("falloff", kBakeFalloffs[static_cast<std::size_t>(settings.falloff)]);
	summary.number("radius_m", settings.radius_m);
	if (settings.falloff == Falloff::alchemy)
	{
		summary.number("falloff_u_m", settings.falloff_u_m);
	}
	summary.whole("rays_a_vertex", static_cast<std::size_t>(settings.rays));
	if (settings.max_error > 0.0)
	{
		summary.number("max_error", settings.max_error);
		summary.whole("max_vertices", settings.max_vertices);
	}
	summary.whole("seed", settings.seed);
}

void addResult(Summary& summary, const VertexBake& bake, const BakeCheck& check, std::size_t bytes)
{
	double sum = 0.0;
	for (const float value : bake.visibility)
	{
		sum += static_cast<double>(value);
	}
	if (bake.refined)
	{
		summary.whole("baked_triangles", bake.refined->triangles.size());
		summary.whole("triangles_above", bake.above);
		summary.number("area_above_m2", bake.area_above_m2);
		summary.text("stopped_by", bake.capped ? "max-vertices" : bake.above > 0 ? "shortest-edge" : "max-error");
	}
	summary.whole("vertices", bake.visibility.size());
	summary.whole("values", bake.unknowns);
	summary.whole("points", bake.points);
	summary.whole("buried_points", bake.buried);
	summary.whole("rays", bake.rays);
	summary.number("mean_visibility", sum / static_cast<double>(bake.visibility.size()));
	summary.number("rms_standard_error", bake.standard_error);
	summary.whole("check_points", check.points);
	summary.whole("check_buried", check.buried);
	summary.whole("check_rays", check.rays);
	summary.number("check_standard_error", check.standard_error);
	summary.number("rmse", check.rmse);
	summary.number("bias", check.bias);
	summary.whole("bytes", bytes);
}

std::string refinementLine(const VertexBake& bake, double max_error)
{
	if (!bake.refined)
	{
		return "";
	}
	return "refined: " + std::to_string(bake.refined->triangles.size()) + " triangles, " + std::to_string(bake.above) +
		   " of them with errors above " + roundedText(max_error, 3) + ", " + roundedText(bake.area_above_m2, 3) + " m2\n";
}

std::string describe(const VertexBake& bake, const BakeCheck& check, std::size_t bytes)
{
	return "bake: " + std::to_string(bake.visibility.size()) + " vertices, " + std::to_string(bake.rays) + " rays from " +
		   std::to_string(bake.points) + " points (" + std::to_string(bake.buried) + " inside matter)\n" +
		   "standard error: " + roundedText(bake.standard_error, 3) + " at the vertices\n" + "error: RMSE " +
		   roundedText(check.rmse, 3) + ", bias " + roundedText(check.bias, 3) + " against rays at " +
		   std::to_string(check.points) + " other points of the surface\n" + "file: " + std::to_string(bytes) + " bytes\n";
}

void run(BakeOptions& options, VerbProgress& progress)
{
	settle(options);
	checkOutputs(options.outputs, kBakeFormats, {options.level.level});
	const RunSettings how = progress.start("bake", options.threads, options.outputs.progress);
	const LoadedLevel loaded = loadLevel(options.level.level, options.level.load, how);
	checkRead(options.outputs, loaded.level.files);
	const Level& level = loaded.level;
	const Tracer tracer(level, how);
	const VertexBake bake = bakeVertices(tracer, options.settings, how);
	const Level& baked = bake.refined ? *bake.refined : level;
	const BakeCheck check = checkBake(tracer, baked, bake.visibility, options.settings, kCheckPoints, how);
	const std::string bytes = levelGlb(baked, "nook " NOOK_VERSION, {bake.visibility, options.color});

	Summary summary("bake");
	addLevelFacts(summary, loaded);
	addSettings(summary, options.settings);
	addResult(summary, bake, check, bytes.size());
	OutputSet files;
	for (const std::string& path : options.outputs.files)
	{
		files.add(path, bytes);
	}
	addSide(files, options.outputs, summary.json(), level.files);
	if (options.outputs.json.empty() && isStdoutFree(options.outputs))
	{
		files.add("-", refinementLine(bake, options.settings.max_error) + describe(bake, check, bytes.size()));
	}
	files.commit();
	if (bake.capped)
	{
		std::fprintf(stderr, "nook: warning: %s\n",
					 oneLine("--max-vertices: " + std::to_string(options.settings.max_vertices) + " left " +
							 std::to_string(bake.above) + " triangles with errors above " +
							 roundedText(options.settings.max_error, 3))
						 .c_str());
	}
}

} // namespace

Verb addBakeVerb(CLI::App& nook)
{
	const auto options = std::make_shared<BakeOptions>();
	CLI::App* const app = nook.add_subcommand("bake", "Visibility at a level's vertices, by rays, fitted to its surface");
	declare(*app, *options);
	return {app, [options](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

} // namespace nook
