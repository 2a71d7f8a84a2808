// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake_options.h"

#include "core/lists.h"
#include "core/text.h"
#include "scene/sample_set.h"
#include "volume/evaluate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 9> kAllBakeFormats{".glb", ".gltf", ".csv",  ".npy", ".json",
														  ".png", ".exr",  ".ktx2", ".glsl"};
constexpr std::array<std::string_view, 2> kBakeFits{"surface", "points"};                    // of BakeFit
constexpr std::array<std::string_view, 2> kBakeSides{"separate", "mean"};                    // of BakeSides
constexpr std::array<std::string_view, 2> kBakeNormals{"geometric", "interpolated"};         // of NormalKind
constexpr std::array<std::string_view, 3> kBakeInstances{"separate", "shared", "attribute"}; // of BakeInstances
constexpr std::array<std::string_view, 6> kBakeTargets{"visibility", "color", "color-alpha", "texcoord", "custom", "texture"};
constexpr int kMostSet = 7;             // of texture coordinates
constexpr int kStandardTexture = 1024;  // texels across
constexpr double kStandardError = 0.03; // of --auto

// Letters, digits and _.
bool isPlainName(std::string_view name)
{
	return std::all_of(name.begin(), name.end(),
					   [](char c)
					   { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; });
}

// "visibility", "texcoord:2", "custom:AO".
void takeTarget(BakeOptions& options, const std::string& name, const std::string& text)
{
	const std::size_t colon = text.find(':');
	const std::string rest = colon == std::string::npos ? "" : text.substr(colon + 1);
	const auto word = std::find(kBakeTargets.begin(), kBakeTargets.end(), text.substr(0, colon));
	const auto target = static_cast<BakeTarget>(word - kBakeTargets.begin());
	const bool set = target == BakeTarget::texcoord && rest.size() == 1 && rest[0] >= '0' && rest[0] <= '0' + kMostSet;
	const bool custom = target == BakeTarget::custom && !rest.empty() && isPlainName(rest);
	const bool plain =
		target != BakeTarget::texcoord && target != BakeTarget::custom && (colon == std::string::npos || text == "texture:orm");
	refuseValueIf(word == kBakeTargets.end() || !(set || custom || plain), name, text,
				  "visibility, color, color-alpha, texcoord:0 to texcoord:7, custom:NAME, texture or texture:orm");
	options.to = text;
	options.form.target = target;
	options.form.attribute = set ? "TEXCOORD_" + rest : custom ? (rest[0] == '_' ? "" : "_") + rest : "";
}

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
	excludes.push_back({"--auto", "one of them, since it chooses by itself"});
	return {.excludes = std::move(excludes), .needs = std::move(needs)};
}

} // namespace

void declareBake(CLI::App& app, BakeOptions& options)
{
	BakeSettings& settings = options.settings;
	const OptionRule volumes{"--volumes", "--volumes", "no volumes"};
	const OptionRule unwrap{"--unwrap", "--unwrap", "without it"};
	options.app = &app;
	addLevelOptions(app, options.level);
	addOptions(
		app,
		{{"--radius", takesNumber(settings.radius_m, 1e-6, std::numeric_limits<double>::infinity()),
		  "Metres that a ray reaches, to 1e9; inf: without end", kRequired},
		 {"--falloff", takesChoice(kFalloffs, settings.falloff),
		  "Weight of a surface at distance t: hard 1 (default), linear 1 - t/radius, alchemy u t / max(u, t)^2"},
		 falloffUnitRow(options.falloff_u_m),
		 {"--rays", takesWhole(settings.rays, 1, kMaxSamples), "Rays a vertex, a texel or a probe (default 256)"},
		 {"--fit", takesChoice(kBakeFits, settings.fit),
		  "surface: values whose interpolation is nearest to rays all over the triangles (default); points: those at the vertices",
		  ofVertices()},
		 {"--normals", takesChoice(kBakeNormals, settings.normals),
		  "Rays lie around the triangles' own normals (default) or around those of the vertices, interpolated",
		  excludes("--probes", "none, since probes have all normals")},
		 {"--max-error",
		  takesNumber(settings.max_error, 1e-3, 1.0),
		  "Splits triangles whose root mean square error is above that, and neighbours, so that no crack opens; with --auto: the "
		  "root mean square error of the surface (default 0.03)",
		  {.excludes = {{"--fit points", "--fit surface, whose error it is"}, {"--texture or --probes", "one of them"}}}},
		 {"--auto", takesFlag(options.automatic),
		  "A texture for the surfaces where values at vertices are far off, and values at the vertices of the rest, with the least "
		  "bytes for --max-error or the least error for --max-bytes",
		  excludes("--texture or --unwrap or --probes")},
		 {"--max-bytes",
		  takesWhole(options.max_bytes, 1, kMaxFileBytes),
		  "With --auto: no more bytes than that are added to the level",
		  {.excludes = {{"--max-error", "one of them"}}, .needs = {{"--auto", "both or none"}}}},
		 {"--max-vertices", takesWhole(settings.max_vertices, 3, 100'000'000),
		  "With --max-error: no more vertices than that (default 2000000)", ofVertices({}, {{"--max-error", "both or none"}})},
		 {"--to",
		  takesParsed("TARGET", [&options](const std::string& name, const std::string& text) { takeTarget(options, name, text); }),
		  "Where the file has it: visibility, an attribute (default), color, color-alpha, texcoord:N, custom:NAME, texture, "
		  "texture:orm",
		  {.excludes = {{"--probes"}, {"--volumes", "one of them, since a difference has its own attribute"}}}},
		 {"--instances", takesChoice(kBakeInstances, options.form.instances),
		  "A mesh at several nodes: values for each (default), shared: their mean, attribute: their mean and factors",
		  ofVertices({{"--bent", "separate, since bent normals are of one place"},
					  {"--max-error", "none, since each place is split by itself"}})},
		 {"--color", takesFlag(options.form.color), "Visibility as COLOR_0, too, which viewers multiply their colours by",
		  ofVertices()},
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
		 partsRow("--occluders", options.occluders,
				  "The only parts of the level that rays meet, chosen as by --ignore (default: all)"),
		 partsRow("--receivers", options.receivers,
				  "The only parts that get values, chosen as by --ignore, or whose box has probes; the others stay as they are "
				  "(default: all)"),
		 {"--from",
		  takesText(options.from, "FILE"),
		  "A detailed level that this one stands for: values are those of its surface, and rays meet it alone",
		  {.excludes = {{"--probes or --volumes or --occluders", "one of them, since rays meet only the detailed level"}},
		   .needs = {{"--cage", "both or none"}}}},
		 {"--cage",
		  takesNumber(settings.cage_m, 1e-6, 1e9),
		  "With --from: metres within which the detailed surface lies on either side, along the normals of vertices",
		  {.needs = {{"--from", "both or none"}}}},
		 {"--texture", takesWhole(options.texture_px, kLeastTexture_px, kMostTexture_px),
		  "Texels across of an occlusion texture, in place of values at vertices; by the level's second texture coordinates or by "
		  "the first",
		  excludes("--probes")},
		 {"--unwrap", takesFlag(options.unwrap),
		  "A texture with coordinates of its own, which the file gets as its next set: charts that do not overlap",
		  excludes("--probes")},
		 {"--texel-size",
		  takesNumber(options.charts.texel_m, 1e-6, 1e6),
		  "With --unwrap: metres across a texel (default: as many texels as --texture holds)",
		  {.needs = {unwrap}}},
		 {"--pages",
		  takesWhole(options.charts.pages, 1, 64),
		  "With --unwrap: so many textures at most (default 1)",
		  {.needs = {unwrap}}},
		 {"--margin",
		  takesWhole(options.charts.margin_px, 0, kMostMargin_px),
		  "With --unwrap or --auto: texels around each chart that no other has (default 3, which keeps two mipmaps apart)",
		  {.needs = {{"--unwrap or --auto", "--unwrap or --auto", "without them"}}}},
		 {"--probes", takesNumber(options.probes_m, 1e-6, 1e9),
		  "Metres between the probes of a grid, for what moves, in place of vertices: a texture (.ktx2) and its reader (.glsl)"},
		 seedRow(settings.seed)});
	addOutputs(app, options.outputs, kAllBakeFormats);
	addRun(app, options.outputs, true);
}

void settleBake(BakeOptions& options)
{
	BakeSettings& settings = options.settings;
	refuseIf(options.form.target != BakeTarget::texture && options.texture_px > 0 && isGiven(*options.app, "--to"),
			 "--to: found '" + options.to + "' with --texture, expected --to texture");
	refuseIf(options.form.target == BakeTarget::texture && (isGiven(*options.app, "--max-error") || options.automatic),
			 (options.automatic ? "--auto" : "--max-error") + std::string(": found with --to texture, expected vertices"));
	refuseIf(options.unwrap && options.form.target != BakeTarget::texture && isGiven(*options.app, "--to"),
			 "--unwrap: found with --to " + options.to + ", expected --to texture");
	const std::vector<std::string>& files = options.outputs.files;
	refuseIf(options.unwrap && !files.empty() && std::all_of(files.begin(), files.end(), isTextureName),
			 "--unwrap: found only textures to write, expected a level as well, which has the coordinates");
	options.charts.size_px = options.texture_px > 0 || options.charts.texel_m > 0.0 ? options.texture_px : kStandardTexture;
	if ((options.form.target == BakeTarget::texture || options.unwrap) && options.texture_px == 0)
	{
		options.texture_px = kStandardTexture;
	}
	if (options.texture_px > 0)
	{
		options.to = options.form.target == BakeTarget::texture ? options.to : std::string(kBakeTargets.back());
		options.form.target = BakeTarget::texture;
	}
	const std::string ending = endingOf(options.level.level);
	for (const std::string& path : options.outputs.files)
	{
		refuseIf(endingOf(path) == ".gltf" && ending != ".gltf",
				 path + ": found the ending of a glTF in text, expected .glb, since the level is none");
	}
	refuseIf(std::isinf(settings.radius_m) && settings.falloff == Falloff::linear,
			 "--radius: found 'inf', expected metres, since --falloff linear is a share of it");
	refuseIf(options.outputs.share && (settings.max_error > 0.0 || options.automatic),
			 "--share: found with " + std::string(options.automatic ? "--auto" : "--max-error") +
				 ", expected one of them, since what is next depends on all so far");
	if (options.automatic)
	{
		settings.max_error = options.max_bytes > 0 || settings.max_error > 0.0 ? settings.max_error : kStandardError;
		const bool one_value = options.form.target == BakeTarget::color || options.form.target == BakeTarget::color_alpha;
		settings.sides = one_value ? BakeSides::mean : settings.sides;
	}
	settings.falloff_u_m = falloffUnit(options.falloff_u_m, settings.radius_m, settings.falloff);
}

void addBakeSettings(Facts& facts, const BakeOptions& options)
{
	const BakeSettings& settings = options.settings;
	const bool probes = options.probes_m > 0.0;
	const bool texture = options.texture_px > 0;
	facts.text("kind", probes ? "probes" : texture ? "texture" : options.automatic ? "auto" : "vertices");
	facts.when(!options.volumes.empty()).text("beside", volumesBy()[options.mask ? 1 : 0]);
	facts.text("falloff", kFalloffs[static_cast<std::size_t>(settings.falloff)]);
	facts.number("radius_m", settings.radius_m);
	facts.when(settings.falloff == Falloff::alchemy).number("falloff_u_m", settings.falloff_u_m);
	facts.whole(probes ? "rays_a_probe" : texture ? "rays_a_texel" : "rays_a_vertex", settings.rays);
	facts.whole("seed", settings.seed);
	if (!probes)
	{
		facts.text("normals", kBakeNormals[static_cast<std::size_t>(settings.normals)]);
		facts.text("to", options.to);
	}
	if (!probes && !texture)
	{
		facts.text("instances", kBakeInstances[static_cast<std::size_t>(options.form.instances)]);
		facts.text("fit", kBakeFits[static_cast<std::size_t>(settings.fit)]);
		facts.text("sides", kBakeSides[static_cast<std::size_t>(settings.sides)]);
	}
	if (settings.max_error > 0.0)
	{
		facts.number("max_error", settings.max_error);
		facts.when(!options.automatic).whole("max_vertices", settings.max_vertices);
	}
	facts.when(options.max_bytes > 0).whole("max_bytes", options.max_bytes);
	for (const auto& [name, patterns] : {std::pair("occluders", &options.occluders), {"receivers", &options.receivers}})
	{
		facts.when(!patterns->empty()).texts(name, *patterns);
	}
}

void addBakeCheck(Facts& facts, const BakeOptions& options, const BakeCheck& check, const std::string& where)
{
	if (!options.from.empty())
	{
		facts.text("from", options.from);
		facts.number("cage_m", options.settings.cage_m);
		facts.whole("check_missed", check.missed);
		facts.line("cage: " + std::to_string(check.missed) + " of " + std::to_string(check.points + check.buried) +
				   " points met no front of the detailed surface");
	}
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

void addBakeResult(Facts& facts, const BakeOptions& options, const VertexBake& bake)
{
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
	facts.number(options.volumes.empty() ? "mean_visibility" : "mean_difference", meanOf(bake.visibility));
	facts.number("rms_standard_error", bake.standard_error);
	facts.line("bake: " + std::to_string(bake.visibility.size()) + " vertices, " + std::to_string(bake.rays) + " rays from " +
			   std::to_string(bake.points) + " points (" + std::to_string(bake.buried) + " inside matter, " +
			   std::to_string(bake.shut) + " shut in)");
	facts.line("standard error: " + roundedText(bake.standard_error, 3) + " at the vertices");
}

bool isTextureName(const std::string& path)
{
	const std::string ending = endingOf(path);
	return ending == ".png" || ending == ".exr" || ending == ".ktx2";
}

void addBakeTextures(Facts& facts, const std::vector<TextureBake>& pages, std::size_t png_bytes)
{
	const auto sum = [&pages](std::size_t TextureBake::*member)
	{
		return sumOver(pages, [member](const TextureBake& page) { return page.*member; });
	};
	const double squares = sumOver(pages, [&pages](const TextureBake& page)
								   { return page.standard_error * page.standard_error / static_cast<double>(pages.size()); });
	const std::string across = std::to_string(pages.front().size_px);
	facts.whole("texels_across", pages.front().size_px);
	facts.whole("charts", sum(&TextureBake::charts));
	facts.whole("covered_texels", sum(&TextureBake::covered));
	facts.whole("shared_texels", sum(&TextureBake::shared));
	facts.whole("buried_texels", sum(&TextureBake::buried));
	facts.line("texture: " + across + " x " + across + " texels, " + std::to_string(sum(&TextureBake::covered)) + " of them in " +
			   std::to_string(sum(&TextureBake::charts)) + " charts, " + std::to_string(sum(&TextureBake::shared)) +
			   " in more than one, " + std::to_string(sum(&TextureBake::buried)) + " inside matter");
	facts.whole("missed_triangles", sum(&TextureBake::missed), "triangles without a texel");
	facts.whole("rays", sum(&TextureBake::rays));
	facts.whole("png_bytes", png_bytes);
	facts.number("rms_standard_error", std::sqrt(squares));
	facts.line("standard error: " + roundedText(std::sqrt(squares), 3) + " of a texel");
}

} // namespace nook
