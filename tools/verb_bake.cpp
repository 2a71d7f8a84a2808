// SPDX-License-Identifier: GPL-3.0-or-later
// nook bake: a level → the same level with visibility at its vertices or in a texture, or the visibility of probes.
#include "call.h"
#include "feature_options.h"
#include "scene_options.h"

#include "bake/bake.h"
#include "bake/probes.h"
#include "bake/texture.h"
#include "core/decimal.h"
#include "core/image.h"
#include "core/math.h"
#include "core/text.h"
#include "core/work_units.h"
#include "format/pattern_file.h"
#include "scene/level_glb.h"
#include "scene/load_parts.h"
#include "scene/sample_set.h"
#include "version.h"
#include "volume/evaluate.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 3> kAllBakeFormats{".glb", ".ktx2", ".glsl"};
constexpr std::array<std::string_view, 1> kBakeFormats{".glb"};
constexpr std::array<std::string_view, 2> kProbeFormats{".ktx2", ".glsl"};
constexpr std::array<std::string_view, 3> kBakeFalloffs{"hard", "linear", "alchemy"}; // of Falloff, in its order
constexpr std::array<std::string_view, 2> kBakeFits{"surface", "points"};             // of BakeFit
constexpr std::array<std::string_view, 2> kBakeSides{"separate", "mean"};             // of BakeSides
constexpr std::array<std::string_view, 2> kBakeNormals{"geometric", "interpolated"};  // of NormalKind
constexpr std::size_t kCheckPoints = 4096;
constexpr const char* kProgram = "nook " NOOK_VERSION;

struct BakeOptions
{
	LevelOptions level;
	BakeSettings settings;
	std::optional<double> falloff_u_m;
	double probes_m = 0.0; // spacing; 0: vertices
	int texture_px = 0;    // 0: vertices
	std::string volumes;   // drawn as well; empty: none
	bool mask = false;     // how they are drawn
	int directions = 128;
	bool color = false;
	Outputs outputs;
};

// How the volumes are drawn, by their place in the table.
std::span<const std::string_view> volumesBy()
{
	static const std::array<std::string_view, 2> names{volumeRow(false).name, volumeRow(true).name};
	return names;
}

// Rules of options that vertices alone have.
OptionRules ofVertices(std::vector<OptionRule> excludes = {}, std::vector<OptionRule> needs = {})
{
	excludes.push_back({"--texture or --probes", "one of them, since it is of vertices"});
	return {.excludes = std::move(excludes), .needs = std::move(needs)};
}

void declare(CLI::App& app, BakeOptions& options)
{
	BakeSettings& settings = options.settings;
	const OptionRule volumes{"--volumes", "--volumes", "no volumes"};
	addLevelOptions(app, options.level);
	addOptions(
		app,
		{{"--radius",
		  takesNumber(settings.radius_m, 1e-6, std::numeric_limits<double>::infinity()),
		  "Metres that a ray reaches, to 1e9; inf: without end",
		  {.required = true}},
		 {"--falloff", takesChoice(kBakeFalloffs, settings.falloff),
		  "Weight of a surface at distance t: hard 1 (default), linear 1 - t/radius, alchemy u t / max(u, t)^2"},
		 {"--falloff-u",
		  takesNumber(options.falloff_u_m, 1e-9, 1e9),
		  "u of --falloff alchemy, metres (default: a tenth of the radius)",
		  {.needs = {{"--falloff alchemy", "both or none"}}}},
		 {"--rays", takesWhole(settings.rays, 1, kMaxSamples), "Rays a vertex, a texel or a probe (default 256)"},
		 {"--fit", takesChoice(kBakeFits, settings.fit),
		  "surface: values whose interpolation is nearest to rays all over the triangles (default); points: those at the vertices",
		  ofVertices()},
		 {"--normals",
		  takesChoice(kBakeNormals, settings.normals),
		  "Rays lie around the triangles' own normals (default) or around those of the vertices, interpolated",
		  {.excludes = {{"--probes", "none, since probes have all normals"}}}},
		 {"--max-error", takesNumber(settings.max_error, 1e-3, 1.0),
		  "Splits triangles whose root mean square error is above that, and neighbours, so that no crack opens",
		  ofVertices({{"--fit points", "--fit surface, whose error it is"}})},
		 {"--max-vertices", takesWhole(settings.max_vertices, 3, 100'000'000),
		  "With --max-error: no more vertices than that (default 2000000)", ofVertices({}, {{"--max-error", "both or none"}})},
		 {"--color", takesFlag(options.color), "Visibility as COLOR_0, too, which viewers multiply their colours by", ofVertices()},
		 {"--sides", takesChoice(kBakeSides, settings.sides),
		  "Materials with two sides: a value for each of them (default), or the mean of both", ofVertices()},
		 {"--bent", takesFlag(settings.bent), "Bent normals as well, the mean directions of what is open: _BENT_NORMAL",
		  ofVertices()},
		 {"--volumes", takesText(options.volumes, "FILE.glb"),
		  "Occlusion volumes of the level that are drawn as well: what is baked is the difference to add to them",
		  ofVertices({{"--color or --bent or --fit points", "one of them, since what is baked is a difference over the surface"}})},
		 {"--volumes-by",
		  takesChoice(volumesBy(), options.mask),
		  "With --volumes: how they are drawn: " + sumMethod() + " (default) or " + maskMethod(),
		  {.needs = {volumes}}},
		 directionsRow(options.directions,
					   {.needs = {volumes, {"--volumes-by " + maskMethod(), maskMethod(), "with another method"}}}),
		 {"--texture",
		  takesWhole(options.texture_px, kLeastTexture_px, kMostTexture_px),
		  "Texels across of an occlusion texture, in place of values at vertices; by the level's second texture coordinates or by "
		  "the first",
		  {.excludes = {{"--probes"}}}},
		 {"--probes", takesNumber(options.probes_m, 1e-6, 1e9),
		  "Metres between the probes of a grid, for what moves, in place of vertices: a texture (.ktx2) and its reader (.glsl)"}});
	addSeed(app, settings.seed);
	addOutputs(app, options.outputs, kAllBakeFormats);
	addRun(app, options.outputs, true);
}

// Options whose values contradict each other; defaults that depend on others.
void settle(BakeOptions& options)
{
	BakeSettings& settings = options.settings;
	if (std::isinf(settings.radius_m) && settings.falloff == Falloff::linear)
	{
		refuse("--radius: found 'inf', expected metres, since --falloff linear is a share of it");
	}
	if (std::isfinite(settings.radius_m) && settings.radius_m > 1e9)
	{
		refuseValue("--radius", numberText(settings.radius_m), "metres from 0.000001 to 1000000000, or inf");
	}
	if (options.outputs.share && settings.max_error > 0.0)
	{
		refuse("--share: found with --max-error, expected one of them, since what is split next depends on all so far");
	}
	if (!options.falloff_u_m && settings.falloff == Falloff::alchemy && std::isinf(settings.radius_m))
	{
		refuse("--falloff-u: found none, expected metres, since the radius is without end");
	}
	settings.falloff_u_m = options.falloff_u_m.value_or(0.1 * settings.radius_m);
}

void addSettings(Facts& facts, const BakeOptions& options)
{
	const BakeSettings& settings = options.settings;
	const bool probes = options.probes_m > 0.0;
	const bool texture = options.texture_px > 0;
	facts.text("kind", probes ? "probes" : texture ? "texture" : "vertices");
	if (!options.volumes.empty())
	{
		facts.text("beside", volumesBy()[options.mask ? 1 : 0]);
	}
	facts.text("falloff", kBakeFalloffs[static_cast<std::size_t>(settings.falloff)]);
	facts.number("radius_m", settings.radius_m);
	if (settings.falloff == Falloff::alchemy)
	{
		facts.number("falloff_u_m", settings.falloff_u_m);
	}
	facts.whole(probes ? "rays_a_probe" : texture ? "rays_a_texel" : "rays_a_vertex", settings.rays);
	facts.whole("seed", settings.seed);
	if (!probes)
	{
		facts.text("normals", kBakeNormals[static_cast<std::size_t>(settings.normals)]);
	}
	if (!probes && !texture)
	{
		facts.text("fit", kBakeFits[static_cast<std::size_t>(settings.fit)]);
		facts.text("sides", kBakeSides[static_cast<std::size_t>(settings.sides)]);
	}
	if (settings.max_error > 0.0)
	{
		facts.number("max_error", settings.max_error);
		facts.whole("max_vertices", settings.max_vertices);
	}
}

// How far the bake is from rays; `where` they were asked.
void addCheck(Facts& facts, const BakeCheck& check, const std::string& where)
{
	facts.whole("check_points", check.points);
	facts.whole("check_buried", check.buried);
	facts.whole("check_shut", check.shut);
	facts.whole("check_rays", check.rays);
	facts.number("check_standard_error", check.standard_error);
	facts.number("rmse", check.rmse);
	facts.number("rmse_seen", check.rmse_seen);
	facts.number("bias", check.bias);
	facts.line("error: RMSE " + roundedText(check.rmse, 3) + ", bias " + roundedText(check.bias, 3) + " against rays at " +
			   std::to_string(check.points) + " " + where);
}

void addResult(Facts& facts, const BakeOptions& options, const VertexBake& bake, std::size_t bytes)
{
	double sum = 0.0;
	for (const float value : bake.visibility)
	{
		sum += static_cast<double>(value);
	}
	if (bake.refined)
	{
		facts.whole("baked_triangles", bake.refined->triangles.size());
		facts.whole("triangles_above", bake.above);
		facts.number("area_above_m2", bake.area_above_m2);
		facts.text("stopped_by", bake.capped ? "max-vertices" : bake.above > 0 ? "shortest-edge" : "max-error");
		facts.line("refined: " + std::to_string(bake.refined->triangles.size()) + " triangles, " + std::to_string(bake.above) +
				   " of them with errors above " + roundedText(options.settings.max_error, 3) + ", " +
				   roundedText(bake.area_above_m2, 3) + " m2");
	}
	facts.whole("vertices", bake.visibility.size());
	facts.whole("values", bake.unknowns);
	facts.whole("points", bake.points);
	facts.whole("buried_points", bake.buried);
	facts.whole("shut_points", bake.shut);
	facts.whole("rays", bake.rays);
	facts.whole("bytes", bytes);
	facts.number(options.volumes.empty() ? "mean_visibility" : "mean_difference",
				 sum / static_cast<double>(bake.visibility.size()));
	facts.number("rms_standard_error", bake.standard_error);
	facts.line("bake: " + std::to_string(bake.visibility.size()) + " vertices, " + std::to_string(bake.rays) + " rays from " +
			   std::to_string(bake.points) + " points (" + std::to_string(bake.buried) + " inside matter, " +
			   std::to_string(bake.shut) + " shut in)");
	facts.line("standard error: " + roundedText(bake.standard_error, 3) + " at the vertices");
}

// The result of a run.
struct Made
{
	std::vector<std::string> bytes; // a file each of the outputs, in their order
	std::vector<std::string> warnings;
};

Made makeVertices(const BakeOptions& options, const Tracer& tracer, Facts& facts, const RunSettings& how)
{
	const BakeSettings& settings = options.settings;
	const VertexBake bake = bakeVertices(tracer, settings, how);
	const Level& baked = bake.refined ? *bake.refined : tracer.level();
	const BakeCheck check = checkBake(tracer, baked, bake, settings, kCheckPoints, how);
	if (isShare(how))
	{
		return {};
	}
	const BakedKind kind = options.volumes.empty() ? BakedKind::visibility
						   : options.mask          ? BakedKind::mask_volume_difference
												   : BakedKind::volume_difference;
	const std::string bytes =
		levelGlb(baked, kProgram, {bake.visibility, options.color, {}, {}, bake.back, bake.bent, bake.bent_back, kind});
	give<float>("visibility", bake.visibility, {bake.visibility.size()});
	give<float>("back", bake.back, {bake.back.size()});
	give<float>("bent", bake.bent, {bake.bent.size(), 3});
	give<float>("bent_back", bake.bent_back, {bake.bent_back.size(), 3});
	if (bake.refined)
	{
		give<double>("positions", baked.positions, {baked.positions.size(), 3});
		give<uint32_t>("triangles", baked.triangles, {baked.triangles.size(), 3});
	}
	addResult(facts, options, bake, bytes.size());
	addCheck(facts, check, "other points of the surface");
	if (settings.base)
	{
		facts.number("rmse_of_volumes", check.rmse_without);
	}
	facts.line("file: " + std::to_string(bytes.size()) + " bytes");
	if (settings.bent)
	{
		const double angle_deg = check.angle_rad * 180.0 / kPi;
		facts.number("bent_angle_deg", angle_deg);
		facts.line("bent normals: " + roundedText(angle_deg, 3) + " degrees from those of rays in the mean");
	}
	Made made{std::vector<std::string>(options.outputs.files.size(), bytes), {}};
	if (bake.capped)
	{
		made.warnings.push_back("--max-vertices: " + std::to_string(settings.max_vertices) + " left " + std::to_string(bake.above) +
								" triangles with errors above " + roundedText(settings.max_error, 3));
	}
	if (settings.base && !(check.rmse < check.rmse_without))
	{
		made.warnings.push_back(options.volumes + ": found an RMSE of " + roundedText(check.rmse, 3) +
								" with the difference baked, expected less than the " + roundedText(check.rmse_without, 3) +
								" of the volumes alone; more --rays may help");
	}
	return made;
}

Made makeTexture(const BakeOptions& options, const Tracer& tracer, Facts& facts, const RunSettings& how)
{
	const Level& level = tracer.level();
	const std::vector<glm::vec2> second = loadSecondUvs(options.level.level, options.level.load, level, how);
	const std::vector<glm::vec2>& uvs = second.empty() ? level.uvs : second;
	const TextureBake bake = bakeTexture(tracer, uvs, options.texture_px, options.settings, how);
	const BakeCheck check = checkTexture(tracer, uvs, bake, options.settings, kCheckPoints, how);
	if (isShare(how))
	{
		return {};
	}
	std::vector<uint8_t> rgb;
	rgb.reserve(3 * bake.values.size());
	for (const uint8_t value : bake.values)
	{
		rgb.insert(rgb.end(), {value, value, value});
	}
	const std::string png = pngBytes(bake.size_px, bake.size_px, rgb, {});
	const std::string bytes = levelGlb(level, kProgram, {{}, false, uvs, png, {}, {}, {}});
	give<uint8_t>("texels", bake.values, {static_cast<std::size_t>(bake.size_px), static_cast<std::size_t>(bake.size_px)});
	facts.text("coordinates", second.empty() ? "first" : "second");
	facts.whole("texels_across", bake.size_px);
	facts.whole("charts", bake.charts);
	facts.whole("covered_texels", bake.covered);
	facts.whole("shared_texels", bake.shared);
	facts.whole("buried_texels", bake.buried);
	facts.line("texture: " + std::to_string(bake.size_px) + " x " + std::to_string(bake.size_px) + " texels, " +
			   std::to_string(bake.covered) + " of them in " + std::to_string(bake.charts) + " charts, " +
			   std::to_string(bake.shared) + " in more than one, " + std::to_string(bake.buried) + " inside matter");
	facts.whole("missed_triangles", bake.missed, "triangles without a texel");
	facts.whole("rays", bake.rays);
	facts.whole("bytes", bytes.size());
	facts.whole("png_bytes", png.size());
	facts.number("rms_standard_error", bake.standard_error);
	facts.line("standard error: " + roundedText(bake.standard_error, 3) + " of a texel");
	addCheck(facts, check, "points of the surface");
	facts.line("file: " + std::to_string(bytes.size()) + " bytes");
	return {std::vector<std::string>(options.outputs.files.size(), bytes), {}};
}

Made makeProbes(const BakeOptions& options, const Tracer& tracer, Facts& facts, const RunSettings& how)
{
	const ProbeGrid grid = bakeProbes(tracer, options.probes_m, options.settings, how);
	const BakeCheck check = checkProbes(tracer, grid, options.settings, kCheckPoints, how);
	if (isShare(how))
	{
		return {};
	}
	Made made;
	for (const std::string& path : options.outputs.files)
	{
		made.bytes.push_back(formatOf(path, kProbeFormats) == ".glsl" ? probesGlsl(grid, kProgram) : probesKtx2(grid, kProgram));
	}
	const glm::dvec3 count(grid.count);
	const glm::uvec3 along(grid.count);
	give<uint8_t>("texels", grid.texels, {along.z, along.y, along.x, 4});
	give<double>("origin", std::vector{grid.origin}, {3});
	facts.number("spacing_m", grid.spacing_m);
	facts.numbers("origin_m", {grid.origin.x, grid.origin.y, grid.origin.z});
	facts.numbers("count", {count.x, count.y, count.z});
	facts.whole("probes", grid.texels.size());
	facts.whole("buried_probes", grid.buried);
	facts.whole("rays", grid.rays);
	facts.whole("bytes", 4 * grid.texels.size());
	facts.line("probes: " + std::to_string(grid.count.x) + " x " + std::to_string(grid.count.y) + " x " +
			   std::to_string(grid.count.z) + ", " + std::to_string(grid.buried) + " inside matter, " +
			   std::to_string(4 * grid.texels.size()) + " bytes");
	facts.number("rms_standard_error", grid.standard_error);
	facts.line("standard error: " + roundedText(grid.standard_error, 3) + " of the mean over normals");
	addCheck(facts, check, "points in the open");
	return made;
}

void run(BakeOptions& options, VerbProgress& progress)
{
	settle(options);
	const bool probes = options.probes_m > 0.0;
	std::vector<std::string> inputs{options.level.level, options.volumes};
	std::erase(inputs, "");
	checkOutputs(options.outputs, probes ? std::span<const std::string_view>(kProbeFormats) : kBakeFormats, inputs);
	const RunSettings how = progress.start("bake", options.outputs.threads, options.outputs.progress);
	LoadedLevel loaded = t_call != nullptr ? *t_call->level : loadLevel(options.level.level, options.level.load, how);
	checkRead(options.outputs, loaded.level.files);
	std::vector<std::string> read = loaded.level.files;
	if (!options.volumes.empty())
	{
		options.settings.base = visibilityByVolumes(options.volumes, options.mask ? options.directions : 0, how);
		read.push_back(options.volumes);
	}
	addInputs(read, how);
	const std::size_t turned = alignSheets(loaded.level, how.threads);
	const Tracer tracer(loaded.level, how);
	Facts facts = verbFacts("bake");
	addLevelFacts(facts, loaded);
	facts.whole("turned_triangles", turned);
	addSettings(facts, options);
	const Made made = probes                   ? makeProbes(options, tracer, facts, how)
					  : options.texture_px > 0 ? makeTexture(options, tracer, facts, how)
											   : makeVertices(options, tracer, facts, how);
	if (isShare(how))
	{
		return;
	}
	OutputSet files;
	for (std::size_t i = 0; i < made.bytes.size(); ++i)
	{
		files.add(options.outputs.files[i], made.bytes[i]);
	}
	addSide(files, options.outputs, facts.json(), read);
	if (options.outputs.json.empty() && isStdoutFree(options.outputs))
	{
		files.add("-", facts.lines());
	}
	files.commit();
	for (const std::string& warning : made.warnings)
	{
		warn(warning);
	}
}

} // namespace

Verb addBakeVerb(CLI::App& nook)
{
	return addVerb<BakeOptions>(
		nook, "bake", "Visibility by rays, at a level's vertices, fitted to its surface, in a texture, or at probes of a grid",
		declare, run);
}

} // namespace nook
