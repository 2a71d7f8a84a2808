// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake_options.h"

#include "volume_methods.h"

#include "bake/texture.h"
#include "core/error.h"
#include "core/number.h"
#include "scene/sample_set.h"

#include <cmath>
#include <limits>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 3> kAllBakeFormats{".glb", ".ktx2", ".glsl"};
constexpr std::array<std::string_view, 3> kBakeFalloffs{"hard", "linear", "alchemy"}; // of Falloff, in its order
constexpr std::array<std::string_view, 2> kBakeFits{"surface", "points"};             // of BakeFit
constexpr std::array<std::string_view, 2> kBakeSides{"separate", "mean"};             // of BakeSides
constexpr std::array<std::string_view, 2> kBakeNormals{"geometric", "interpolated"};  // of NormalKind

} // namespace

void addBakeOptions(CLI::App& app, BakeOptions& options)
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
	addWhole(app, "--rays", settings.rays, 1, kMaxSamples, "Rays a vertex, a texel or a probe (default 256)");
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
	addChoiceText(
		app, "--sides", kBakeSides, [&settings](std::size_t i) { settings.sides = static_cast<BakeSides>(i); },
		"Materials with two sides: a value for each of them (default), or the mean of both");
	app.add_flag("--bent", settings.bent, "Bent normals as well, the mean directions of what is open: _BENT_NORMAL");
	addBesideOptions(app, options.beside);
	for (const char* const name : {"--fit", "--max-error", "--max-vertices", "--color", "--sides", "--bent", "--volumes"})
	{
		app.get_option(name)->each([&options, name](const std::string&) { options.of_vertices = name; });
	}
	addWhole(app, "--texture", options.texture_px, kLeastTexture_px, kMostTexture_px,
			 "Texels across of an occlusion texture, in place of values at vertices; by the level's second texture coordinates or "
			 "by the first");
	addNumber(
		app, "--probes", options.probes_m, 1e-6, 1e9,
		"Metres between the probes of a grid, for what moves, in place of vertices: a texture (.ktx2) and its reader (.glsl)");
	addSeed(app, settings.seed);
	addOutputs(app, options.outputs, kAllBakeFormats);
	addThreads(app, options.threads);
	addProgress(app, options.outputs.progress);
	addPart(app, options.outputs.part);
	addUnitCache(app);
}

void settleBake(BakeOptions& options)
{
	BakeSettings& settings = options.settings;
	if (options.has_u && settings.falloff != Falloff::alchemy)
	{
		refuse("--falloff-u: found without --falloff alchemy, expected both or none");
	}
	if (std::isinf(settings.radius_m) && settings.falloff == Falloff::linear)
	{
		refuse("--radius: found 'inf', expected metres, since --falloff linear is a share of it");
	}
	if (std::isfinite(settings.radius_m) && settings.radius_m > 1e9)
	{
		refuseValue("--radius", numberText(settings.radius_m), "metres from 0.000001 to 1000000000, or inf");
	}
	if (options.probes_m > 0.0 && options.texture_px > 0)
	{
		refuse("--texture: found with --probes, expected one of them");
	}
	if (options.probes_m > 0.0 && settings.normals != NormalKind::geometric)
	{
		refuse("--normals: found with --probes, expected none, since probes have all normals");
	}
	if ((options.probes_m > 0.0 || options.texture_px > 0) && !options.of_vertices.empty())
	{
		refuse(options.of_vertices + ": found with " + (options.texture_px > 0 ? "--texture" : "--probes") +
			   ", expected one of them, since it is of vertices");
	}
	if (options.outputs.part && settings.max_error > 0.0)
	{
		refuse("--part: found with --max-error, expected one of them, since what is split next depends on all so far");
	}
	checkBeside(options.beside);
	if (!options.beside.path.empty() && (options.color || settings.bent || settings.fit == BakeFit::points))
	{
		refuse("--volumes: found with " +
			   std::string(options.color   ? "--color"
						   : settings.bent ? "--bent"
										   : "--fit points") +
			   ", expected one of them, since what is baked is a difference over the surface");
	}
	if (options.has_cap && settings.max_error == 0.0)
	{
		refuse("--max-vertices: found without --max-error, expected both or none");
	}
	if (settings.max_error > 0.0 && settings.fit == BakeFit::points)
	{
		refuse("--max-error: found with --fit points, expected --fit surface, whose error it is");
	}
	if (!options.has_u)
	{
		if (settings.falloff == Falloff::alchemy && std::isinf(settings.radius_m))
		{
			refuse("--falloff-u: found none, expected metres, since the radius is without end");
		}
		settings.falloff_u_m = 0.1 * settings.radius_m;
	}
}

void addBakeSettings(Summary& summary, const BakeOptions& options)
{
	const BakeSettings& settings = options.settings;
	const bool probes = options.probes_m > 0.0;
	const bool texture = options.texture_px > 0;
	summary.text("kind", probes ? "probes" : texture ? "texture" : "vertices");
	if (!options.beside.path.empty())
	{
		summary.text("beside", options.beside.mask ? maskMethod() : sumMethod());
	}
	summary.text("falloff", kBakeFalloffs[static_cast<std::size_t>(settings.falloff)]);
	summary.number("radius_m", settings.radius_m);
	if (settings.falloff == Falloff::alchemy)
	{
		summary.number("falloff_u_m", settings.falloff_u_m);
	}
	summary.whole(probes ? "rays_a_probe" : texture ? "rays_a_texel" : "rays_a_vertex", static_cast<std::size_t>(settings.rays));
	summary.whole("seed", settings.seed);
	if (!probes)
	{
		summary.text("normals", kBakeNormals[static_cast<std::size_t>(settings.normals)]);
	}
	if (!probes && !texture)
	{
		summary.text("fit", kBakeFits[static_cast<std::size_t>(settings.fit)]);
		summary.text("sides", kBakeSides[static_cast<std::size_t>(settings.sides)]);
	}
	if (settings.max_error > 0.0)
	{
		summary.number("max_error", settings.max_error);
		summary.whole("max_vertices", settings.max_vertices);
	}
}

} // namespace nook
