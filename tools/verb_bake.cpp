// SPDX-License-Identifier: GPL-3.0-or-later
// nook bake: a level → the same file with visibility at its vertices or in a texture, or the visibility of probes.
#include "call.h"
#include "scene_options.h"

#include "bake/bake.h"
#include "bake/probes.h"
#include "bake/texture.h"
#include "bake/unwrap.h"
#include "core/decimal.h"
#include "core/image.h"
#include "core/lists.h"
#include "core/math.h"
#include "core/system.h"
#include "core/text.h"
#include "core/words.h"
#include "core/work_units.h"
#include "format/pattern_file.h"
#include "scene/camera_choice.h"
#include "scene/gltf_edit.h"
#include "scene/level_glb.h"
#include "scene/load_parts.h"
#include "scene/sample_set.h"
#include "version.h"
#include "volume/evaluate.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 9> kAllBakeFormats{".glb", ".gltf", ".csv",  ".npy", ".json",
														  ".png", ".exr",  ".ktx2", ".glsl"};
constexpr std::array<std::string_view, 5> kBakeFormats{".glb", ".gltf", ".csv", ".npy", ".json"};
constexpr std::array<std::string_view, 5> kTextureFormats{".glb", ".gltf", ".png", ".exr", ".ktx2"};
constexpr std::array<std::string_view, 2> kProbeFormats{".ktx2", ".glsl"};
constexpr std::array<std::string_view, 2> kBakeFits{"surface", "points"};                    // of BakeFit
constexpr std::array<std::string_view, 2> kBakeSides{"separate", "mean"};                    // of BakeSides
constexpr std::array<std::string_view, 2> kBakeNormals{"geometric", "interpolated"};         // of NormalKind
constexpr std::array<std::string_view, 3> kBakeInstances{"separate", "shared", "attribute"}; // of BakeInstances
constexpr std::array<std::string_view, 6> kBakeTargets{"visibility", "color", "color-alpha", "texcoord", "custom", "texture"};
constexpr int kMostSet = 7;            // of texture coordinates
constexpr int kStandardTexture = 1024; // texels across
constexpr std::size_t kCheckPoints = 4096;
constexpr const char* kProgram = "nook " NOOK_VERSION;

struct BakeOptions
{
	LevelOptions level;
	BakeSettings settings;
	std::optional<double> falloff_u_m;
	double probes_m = 0.0; // spacing; 0: vertices
	int texture_px = 0;    // 0: vertices
	bool unwrap = false;   // texture coordinates of its own
	UnwrapSettings charts; // for that
	std::string volumes;   // drawn as well; empty: none
	bool mask = false;     // how they are drawn
	int directions = 128;
	bool color = false;
	std::string to = "visibility";
	BakeTarget target = BakeTarget::visibility;
	std::string attribute; // that the target names
	BakeInstances instances = BakeInstances::separate;
	std::vector<std::string> occluders;
	std::vector<std::string> receivers;
	std::string from; // the detailed level; empty: none
	const CLI::App* app = nullptr;
	Outputs outputs;
};

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
	if (word == kBakeTargets.end() || !(set || custom || plain))
	{
		refuseValue(name, text, "visibility, color, color-alpha, texcoord:0 to texcoord:7, custom:NAME, texture or texture:orm");
	}
	options.to = text;
	options.target = target;
	options.attribute = set ? "TEXCOORD_" + rest : custom ? (rest[0] == '_' ? "" : "_") + rest : "";
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
	return {.excludes = std::move(excludes), .needs = std::move(needs)};
}

void declare(CLI::App& app, BakeOptions& options)
{
	BakeSettings& settings = options.settings;
	const OptionRule volumes{"--volumes", "--volumes", "no volumes"};
	const OptionRule unwrap{"--unwrap", "--unwrap", "without it"};
	const auto take_target = [&options](const std::string& name, const std::string& text)
	{
		takeTarget(options, name, text);
	};
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
		 {"--max-error", takesNumber(settings.max_error, 1e-3, 1.0),
		  "Splits triangles whose root mean square error is above that, and neighbours, so that no crack opens",
		  ofVertices({{"--fit points", "--fit surface, whose error it is"}})},
		 {"--max-vertices", takesWhole(settings.max_vertices, 3, 100'000'000),
		  "With --max-error: no more vertices than that (default 2000000)", ofVertices({}, {{"--max-error", "both or none"}})},
		 {"--to",
		  takesParsed("TARGET", take_target),
		  "Where the file has it: visibility, an attribute (default), color, color-alpha, texcoord:N, custom:NAME, texture, "
		  "texture:orm",
		  {.excludes = {{"--probes"}, {"--volumes", "one of them, since a difference has its own attribute"}}}},
		 {"--instances", takesChoice(kBakeInstances, options.instances),
		  "A mesh at several nodes: values for each (default), shared: their mean, attribute: their mean and factors",
		  ofVertices({{"--bent", "separate, since bent normals are of one place"},
					  {"--max-error", "none, since each place is split by itself"}})},
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
		  "With --unwrap: texels around each chart that no other has (default 3, which keeps two mipmaps apart)",
		  {.needs = {unwrap}}},
		 {"--probes", takesNumber(options.probes_m, 1e-6, 1e9),
		  "Metres between the probes of a grid, for what moves, in place of vertices: a texture (.ktx2) and its reader (.glsl)"},
		 seedRow(settings.seed)});
	addOutputs(app, options.outputs, kAllBakeFormats);
	addRun(app, options.outputs, true);
}

// A texture alone.
bool isTexture(const std::string& path)
{
	const std::string ending = endingOf(path);
	return ending == ".png" || ending == ".exr" || ending == ".ktx2";
}

// Options whose values contradict each other; defaults that depend on others.
void settle(BakeOptions& options)
{
	BakeSettings& settings = options.settings;
	if (options.target != BakeTarget::texture && options.texture_px > 0 && isGiven(*options.app, "--to"))
	{
		refuse("--to: found '" + options.to + "' with --texture, expected --to texture");
	}
	if (options.target == BakeTarget::texture && isGiven(*options.app, "--max-error"))
	{
		refuse("--max-error: found with --to texture, expected vertices");
	}
	if (options.unwrap && options.target != BakeTarget::texture && isGiven(*options.app, "--to"))
	{
		refuse("--unwrap: found with --to " + options.to + ", expected --to texture");
	}
	const std::vector<std::string>& files = options.outputs.files;
	if (options.unwrap && !files.empty() && std::all_of(files.begin(), files.end(), isTexture))
	{
		refuse("--unwrap: found only textures to write, expected a level as well, which has the coordinates");
	}
	options.charts.size_px = options.texture_px > 0 || options.charts.texel_m > 0.0 ? options.texture_px : kStandardTexture;
	if ((options.target == BakeTarget::texture || options.unwrap) && options.texture_px == 0)
	{
		options.texture_px = kStandardTexture;
	}
	if (options.texture_px > 0)
	{
		options.to = options.target == BakeTarget::texture ? options.to : std::string(kBakeTargets.back());
		options.target = BakeTarget::texture;
	}
	const std::string ending = endingOf(options.level.level);
	for (const std::string& path : options.outputs.files)
	{
		if (endingOf(path) == ".gltf" && ending != ".gltf")
		{
			refuse(path + ": found the ending of a glTF in text, expected .glb, since the level is none");
		}
	}
	if (std::isinf(settings.radius_m) && settings.falloff == Falloff::linear)
	{
		refuse("--radius: found 'inf', expected metres, since --falloff linear is a share of it");
	}
	if (options.outputs.share && settings.max_error > 0.0)
	{
		refuse("--share: found with --max-error, expected one of them, since what is split next depends on all so far");
	}
	settings.falloff_u_m = falloffUnit(options.falloff_u_m, settings.radius_m, settings.falloff);
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
	facts.text("falloff", kFalloffs[static_cast<std::size_t>(settings.falloff)]);
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
		facts.text("to", options.to);
	}
	if (!probes && !texture)
	{
		facts.text("instances", kBakeInstances[static_cast<std::size_t>(options.instances)]);
		facts.text("fit", kBakeFits[static_cast<std::size_t>(settings.fit)]);
		facts.text("sides", kBakeSides[static_cast<std::size_t>(settings.sides)]);
	}
	if (settings.max_error > 0.0)
	{
		facts.number("max_error", settings.max_error);
		facts.whole("max_vertices", settings.max_vertices);
	}
	for (const auto& [name, patterns] : {std::pair("occluders", &options.occluders), {"receivers", &options.receivers}})
	{
		if (!patterns->empty())
		{
			facts.texts(name, *patterns);
		}
	}
}

// How far the bake is from rays; `where` they were asked.
void addCheck(Facts& facts, const BakeOptions& options, const BakeCheck& check, const std::string& where)
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

void addResult(Facts& facts, const BakeOptions& options, const VertexBake& bake)
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

// The result of a run.
struct Made
{
	std::vector<std::string> bytes; // a file each of the outputs, in their order, or for textures each of their pages
	std::size_t pages = 1;
	std::vector<std::string> warnings;
};

// A level and the file to write values into.
struct BakeInput
{
	Tracer tracer;
	std::vector<uint8_t> turned;    // 1 for each receiving triangle that the file has the other way round; empty: none
	bool in_place = false;          // the level's own glTF file takes the values
	std::vector<uint8_t> receivers; // 1 for each triangle that gets values; empty: all
	std::optional<LevelPart> part;  // these triangles
	std::optional<Level> coarse{};  // that stands for the tracer's level (--from)

	const Level& level() const
	{
		return coarse ? *coarse : tracer.level();
	}
};

// Values per vertex of the level: NaN where it receives none.
template <class Value> std::vector<Value> spread(const BakeInput& input, const std::vector<Value>& values)
{
	if (!input.part || values.empty())
	{
		return values;
	}
	const std::vector<uint32_t>& vertices = input.part->vertices;
	return listOf(vertices.size(), [&](std::size_t v)
				  { return vertices[v] == UINT32_MAX ? Value(std::numeric_limits<float>::quiet_NaN()) : values[vertices[v]]; });
}

// The record in asset.extras: the same for the same command, wherever it runs.
GltfBake bakeOf(const BakeOptions& options)
{
	const BakeSettings& settings = options.settings;
	GltfBake bake;
	bake.target = options.target;
	bake.attribute = options.attribute;
	bake.instances = options.instances;
	bake.color = options.color;
	bake.in_red = options.to.ends_with(":orm");
	bake.others_stay = !options.level.load.ignore.empty() || !options.receivers.empty();
	bake.kind = options.volumes.empty() ? BakedKind::visibility
				: options.mask          ? BakedKind::mask_volume_difference
										: BakedKind::volume_difference;
	std::string command = "nook";
	for (const std::string& word : commandWords(*options.app))
	{
		const bool path = word == options.level.level || word == options.volumes || word == options.from;
		command += " " + (path ? nativePath(word).filename().string() : word);
	}
	bake.record = {
		{"to", options.to},
		{"radius_m", std::isinf(settings.radius_m) ? nlohmann::ordered_json() : nlohmann::ordered_json(settings.radius_m)},
		{"falloff", kFalloffs[static_cast<std::size_t>(settings.falloff)]},
		{"rays", settings.rays},
		{"version", NOOK_VERSION},
		{"command", command}};
	return bake;
}

// Values alone, in place of a level with them.
bool isValues(const std::string& path)
{
	const std::string ending = endingOf(path);
	return ending == ".csv" || ending == ".npy" || ending == ".json";
}

// The level's own file, or one made of a level, and where the vertices of receiving parts are in it.
struct BakeFile
{
	GltfFile file;
	std::vector<GltfPlace> places;
};

// `as_read`: becomes the level before it was cleaned, whose vertices the places then have.
BakeFile fileOf(const BakeOptions& options, const BakeInput& input, const Level& level, const RunSettings& how,
				Level* as_read = nullptr)
{
	BakeFile made;
	if (input.in_place)
	{
		made.places = loadPlaces(options.level.level, options.level.load, input.level(), options.receivers, how, as_read);
		made.file = openGltf(options.level.level);
		made.file.settings = options.level.load;
	}
	else
	{
		made.file = openGlb(levelGlb(level, kProgram, made.places), level.name);
		std::erase_if(made.places, [&input](const GltfPlace& place) { return input.part && input.receivers[place.triangle] == 0; });
	}
	const bool maps = input.part && (as_read == nullptr);
	for (std::size_t i = 0; maps && i < made.places.size(); ++i)
	{
		for (auto& [of_file, of_level] : made.places[i].vertices)
		{
			of_level = input.part->vertices[of_level];
		}
		std::erase_if(made.places[i].vertices, [](const auto& vertex) { return vertex.second == UINT32_MAX; });
	}
	return made;
}

// Adds values to the file.
GltfBaked write(const BakeOptions& options, const BakeFile& target, const Level& level, const GltfBake& bake, Made& made)
{
	std::vector<std::string> outputs = options.outputs.files;
	std::erase_if(outputs, [](const std::string& path) { return isValues(path) || isTexture(path); });
	outputs.resize(std::max<std::size_t>(outputs.size(), 1), "-"); // its size is reported in any case
	GltfBaked baked = bakeInto(target.file, target.places, bake, outputs);
	if (!level.sources.empty())
	{
		baked.places.assign(1, {});
		baked.places.front().count = level.source_count;
		for (std::size_t v = 0; v < level.sources.size(); ++v)
		{
			baked.places.front().vertices.emplace_back(level.sources[v], static_cast<uint32_t>(v));
		}
	}
	for (std::size_t i = 0, next = 0; i < options.outputs.files.size(); ++i)
	{
		const std::string& path = options.outputs.files[i];
		if (!isTexture(path))
		{
			made.bytes.push_back(isValues(path) ? placeValues(baked.places, baked.front, baked.back, endingOf(path))
												: baked.files[next++]);
		}
	}
	if (baked.kept_alpha > 0)
	{
		made.warnings.push_back("--to color-alpha: " + std::to_string(baked.kept_alpha) +
								" materials have no value, since their alpha is coverage");
	}
	return baked;
}

void addFile(Facts& facts, const BakeInput& input, const GltfBaked& baked)
{
	facts.text("file", input.in_place ? "the level's, with additions" : "a new one");
	facts.whole("bytes_added", baked.bytes_added);
	facts.whole("bytes", baked.files.front().size());
	if (baked.shared_meshes + baked.copies > 0)
	{
		facts.whole("shared_meshes", baked.shared_meshes, "meshes at several places");
		facts.whole("mesh_copies", baked.copies, "meshes added for their values");
	}
	facts.line("file: " + std::to_string(baked.files.front().size()) + " bytes, " + std::to_string(baked.bytes_added) +
			   " of them values");
	if (!baked.compression.empty())
	{
		const std::string repack = "gltf-transform " + baked.compression + " IN.glb OUT.glb";
		facts.text("repack", repack);
		facts.line("compression: the input's " + baked.compression + " is undone; `" + repack + "` packs the output");
	}
}

// In the file, triangles that were turned for the bake show their other sides.
void turnBack(const BakeInput& input, Level& level, VertexBake& bake)
{
	std::vector<uint8_t> seen(level.positions.size(), 0); // 1: by a triangle that was not turned
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		glm::uvec3& corner = level.triangles[t];
		const bool is_turned = input.turned[bake.refined ? bake.split.origins[t] : t] != 0;
		for (int k = 0; k < 3; ++k)
		{
			seen[corner[k]] |= is_turned ? 2U : 1U;
		}
		is_turned ? std::swap(corner.y, corner.z) : void();
	}
	for (std::size_t v = 0; v < seen.size() && !bake.back.empty(); ++v)
	{
		if (seen[v] == 2)
		{
			std::swap(bake.visibility[v], bake.back[v]);
			if (!bake.bent_back.empty())
			{
				std::swap(bake.bent[v], bake.bent_back[v]);
			}
		}
	}
}

Made makeVertices(const BakeOptions& options, const BakeInput& input, Facts& facts, const RunSettings& how)
{
	BakeSettings settings = options.settings;
	const Level& receiving = input.part ? input.part->level : input.level();
	settings.receivers = &receiving;
	BakeFile target = fileOf(options, input, input.level(), how);
	GltfBake in = bakeOf(options);
	VertexBake bake;
	const bool splits = settings.max_error > 0.0 && (input.in_place || input.part);
	in.split.how = splits ? &bake.split : nullptr;
	checkTarget(target.file, target.places, in);
	bake = bakeVertices(input.tracer, settings, how);
	std::vector<glm::uvec3> split; // triangles
	if (splits)
	{
		split = bake.refined->triangles;
		in.split = {&bake.split, receiving.triangles, split, receiving.positions.size()};
	}
	else if (bake.refined)
	{
		target = fileOf(options, input, *bake.refined, how);
	}
	std::optional<Level> turned;
	if (!input.turned.empty())
	{
		turnBack(input, bake.refined ? *bake.refined : turned.emplace(receiving), bake);
	}
	const Level& level = bake.refined ? *bake.refined : turned ? *turned : receiving;
	Made made;
	std::optional<GltfBaked> baked;
	if (!isShare(how))
	{
		in.visibility = bake.visibility;
		in.back = bake.back;
		in.bent = bake.bent;
		in.bent_back = bake.bent_back;
		baked = write(options, target, level, in, made);
		bake.visibility = baked->front;
		bake.back = baked->back;
	}
	const BakeCheck check = checkBake(input.tracer, level, bake, settings, kCheckPoints, how);
	if (isShare(how))
	{
		return {};
	}
	for (const auto& [name, values] : {std::pair("visibility", &bake.visibility), {"back", &bake.back}})
	{
		const std::vector<float> all = spread(input, *values);
		give<float>(name, all, {all.size()});
	}
	for (const auto& [name, values] : {std::pair("bent", &bake.bent), {"bent_back", &bake.bent_back}})
	{
		const std::vector<glm::vec3> all = spread(input, *values);
		give<float>(name, all, {all.size(), 3});
	}
	if (bake.refined)
	{
		give<double>("positions", level.positions, {level.positions.size(), 3});
		give<uint32_t>("triangles", level.triangles, {level.triangles.size(), 3});
	}
	addResult(facts, options, bake);
	addCheck(facts, options, check, "other points of the surface");
	if (settings.base)
	{
		facts.number("rmse_of_volumes", check.rmse_without);
	}
	addFile(facts, input, *baked);
	if (settings.bent)
	{
		const double angle_deg = check.angle_rad * 180.0 / kPi;
		facts.number("bent_angle_deg", angle_deg);
		facts.line("bent normals: " + roundedText(angle_deg, 3) + " degrees from those of rays in the mean");
	}
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

std::string pngOf(const TextureBake& bake)
{
	return textureFile(bake, ".png", kProgram);
}

// Textures as files of their own take their places between the outputs, a file for each page.
void addTextureFiles(const BakeOptions& options, const std::vector<TextureBake>& pages, Made& made)
{
	std::vector<std::string> levels = std::exchange(made.bytes, {});
	made.pages = pages.size();
	std::size_t next = 0;
	for (const std::string& path : options.outputs.files)
	{
		const std::string ending = endingOf(path);
		if (!isTexture(path))
		{
			made.bytes.push_back(std::move(levels[next++]));
			continue;
		}
		for (const TextureBake& page : pages)
		{
			made.bytes.push_back(textureFile(page, ending, kProgram));
		}
	}
}

void addTexture(Facts& facts, const std::vector<TextureBake>& pages, std::size_t png_bytes)
{
	const auto sum = [&pages](std::size_t TextureBake::*member)
	{
		return std::accumulate(pages.begin(), pages.end(), std::size_t{0},
							   [member](std::size_t all, const TextureBake& page) { return all + page.*member; });
	};
	double squares = 0.0;
	for (const TextureBake& page : pages)
	{
		squares += page.standard_error * page.standard_error / static_cast<double>(pages.size());
	}
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

Made makeUnwrapped(const BakeOptions& options, const BakeInput& input, Facts& facts, const RunSettings& how)
{
	Level as_read;
	const auto [file, places] = fileOf(options, input, input.level(), how, &as_read);
	GltfBake in = bakeOf(options);
	in.charts.resize(places.size());
	checkTarget(file, places, in);
	const Level& level = input.in_place ? as_read : input.level();
	const Unwrapped unwrapped = unwrap(level, piecesOf(places), options.charts, how);
	BakeSettings settings = options.settings;
	const auto marksOf = [&](const auto& isWanted)
	{
		return mapped(unwrapped.page_of, [&](uint32_t page) { return static_cast<uint8_t>(isWanted(page) ? 1 : 0); });
	};
	std::vector<TextureBake> pages;
	for (std::size_t page = 0; page < unwrapped.pages; ++page)
	{
		const LevelPart part = partOf(unwrapped.level, marksOf([page](uint32_t of) { return of == page; }), how.threads);
		settings.receivers = &part.level;
		pages.push_back(bakeTexture(input.tracer, part.level.uvs, unwrapped.size_px, settings, how));
	}
	const LevelPart solid = partOf(unwrapped.level, marksOf([](uint32_t of) { return of != kNoPage; }), how.threads);
	std::vector<uint32_t> page_of = unwrapped.page_of;
	std::erase(page_of, kNoPage);
	settings.receivers = &solid.level;
	finishTextures(solid.level, solid.level.uvs, page_of, pages, how.threads);
	const BakeCheck check = checkTexture(input.tracer, solid.level.uvs, pages, page_of, settings, kCheckPoints, how);
	if (isShare(how))
	{
		return {};
	}
	in.charts = chartsOf(places, unwrapped);
	in.pages = mapped(pages, pngOf);
	Made made;
	std::vector<std::string> outputs = options.outputs.files;
	std::erase_if(outputs, isTexture);
	outputs.resize(std::max<std::size_t>(outputs.size(), 1), "-");
	GltfBaked baked = bakeInto(file, places, in, outputs);
	facts.text("coordinates", "unwrapped");
	facts.whole("pages", unwrapped.pages);
	facts.number("texel_size_m", unwrapped.texel_m);
	facts.number("coverage", unwrapped.coverage);
	facts.number("stretch", unwrapped.stretch);
	facts.line("unwrapped: " + std::to_string(unwrapped.charts) + " charts on " + counted(unwrapped.pages, "page", "pages") +
			   ", texels of " + roundedText(unwrapped.texel_m, 3) + " m, coverage " + roundedText(unwrapped.coverage, 3) +
			   ", stretch " + roundedText(unwrapped.stretch, 3));
	addTexture(facts, pages,
			   std::accumulate(in.pages.begin(), in.pages.end(), std::size_t{0},
							   [](std::size_t all, const std::string& png) { return all + png.size(); }));
	addCheck(facts, options, check, "points of the surface");
	addFile(facts, input, baked);
	made.bytes = std::move(baked.files);
	addTextureFiles(options, pages, made);
	return made;
}

Made makeTexture(const BakeOptions& options, const BakeInput& input, Facts& facts, const RunSettings& how)
{
	const Level& level = input.part ? input.part->level : input.level();
	BakeSettings settings = options.settings;
	settings.receivers = &level;
	uint32_t set = 1;
	std::vector<glm::vec2> of_file = loadSecondUvs(options.level.level, options.level.load, input.level(), how, set);
	const bool second = !of_file.empty();
	if (!second && input.in_place)
	{
		set = 0;
		of_file = loadSecondUvs(options.level.level, options.level.load, input.level(), how, set);
	}
	if (input.part && !of_file.empty())
	{
		const std::vector<glm::vec2> of_level = std::exchange(of_file, std::vector<glm::vec2>(level.positions.size()));
		for (std::size_t v = 0; v < of_level.size(); ++v)
		{
			if (input.part->vertices[v] != UINT32_MAX)
			{
				of_file[input.part->vertices[v]] = of_level[v];
			}
		}
	}
	const std::vector<glm::vec2>& uvs = of_file.empty() ? level.uvs : of_file;
	const BakeFile target = fileOf(options, input, input.level(), how);
	GltfBake in = bakeOf(options);
	checkTarget(target.file, target.places, in);
	std::vector<TextureBake> pages{bakeTexture(input.tracer, uvs, options.texture_px, settings, how)};
	finishTextures(level, uvs, {}, pages, how.threads);
	const BakeCheck check = checkTexture(input.tracer, uvs, pages, {}, settings, kCheckPoints, how);
	if (isShare(how))
	{
		return {};
	}
	const auto size = static_cast<std::size_t>(options.texture_px);
	give<uint8_t>("texels", pages.front().values, {size, size});
	const std::string png = pngOf(pages.front());
	in.png = png;
	in.uv_set = set;
	if (!input.in_place)
	{
		in.uvs = uvs;
	}
	Made made;
	const GltfBaked baked = write(options, target, level, in, made);
	addTextureFiles(options, pages, made);
	facts.text("coordinates", second ? "second" : "first");
	addTexture(facts, pages, png.size());
	addCheck(facts, options, check, "points of the surface");
	addFile(facts, input, baked);
	return made;
}

Made makeProbes(const BakeOptions& options, const BakeInput& input, Facts& facts, const RunSettings& how)
{
	BakeSettings settings = options.settings;
	settings.receivers = input.part ? &input.part->level : nullptr;
	const ProbeGrid grid = bakeProbes(input.tracer, options.probes_m, settings, how);
	const BakeCheck check = checkProbes(input.tracer, grid, settings, kCheckPoints, how);
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
	addCheck(facts, options, check, "points in the open");
	return made;
}

void run(BakeOptions& options, VerbProgress& progress)
{
	settle(options);
	const bool probes = options.probes_m > 0.0;
	std::vector<std::string> inputs{options.level.level, options.volumes, options.from};
	std::erase(inputs, "");
	const std::string ending = endingOf(options.level.level);
	const bool is_gltf = ending == ".gltf" || ending == ".glb";
	const bool replaces =
		is_gltf && !probes && options.outputs.depfile.empty() &&
		std::any_of(options.outputs.files.begin(), options.outputs.files.end(),
					[id = fileIdentity(options.level.level)](const auto& path) { return fileIdentity(path) == id; });
	const auto others = [&](std::vector<std::string> files) // without a level that its bake replaces
	{
		std::erase_if(files, [&](const std::string& path) { return replaces && path == options.level.level; });
		return files;
	};
	checkOutputs(options.outputs,
				 probes                   ? std::span<const std::string_view>(kProbeFormats)
				 : options.texture_px > 0 ? std::span<const std::string_view>(kTextureFormats)
										  : kBakeFormats,
				 others(inputs));
	const RunSettings how = progress.start("bake", options.outputs.threads, options.outputs.progress);
	options.level.load.undo_bake = t_call == nullptr;
	LoadedLevel loaded = t_call != nullptr ? *t_call->level : loadLevel(options.level.level, options.level.load, how);
	checkRead(options.outputs, others(loaded.level.files));
	std::vector<std::string> read = loaded.level.files;
	if (!options.volumes.empty())
	{
		options.settings.base = visibilityByVolumes(options.volumes, options.mask ? options.directions : 0, how);
		read.push_back(options.volumes);
	}
	std::optional<LoadedLevel> detailed;
	if (!options.from.empty())
	{
		LoadSettings load = options.level.load;
		load.ignore.clear(); // parts of the other level
		detailed = loadLevel(options.from, load, how);
		read.insert(read.end(), detailed->level.files.begin(), detailed->level.files.end());
	}
	addInputs(read, how);
	const bool is_cell =
		std::any_of(loaded.level.meshes.begin(), loaded.level.meshes.end(), [](const Mesh& mesh) { return mesh.around; });
	const bool in_place = is_gltf && !is_cell;
	if (!in_place)
	{
		checkPictures(loaded.level);
	}
	const std::vector<glm::uvec3> triangles = in_place ? loaded.level.triangles : std::vector<glm::uvec3>();
	const std::size_t turned = alignSheets(loaded.level, how.threads);
	const std::vector<uint8_t> occluders = chosenTriangles(loaded.level, options.occluders, "occluders");
	BakeInput input{Tracer(detailed ? detailed->level : loaded.level, how, nullptr, occluders),
					{},
					in_place,
					chosenTriangles(loaded.level, options.receivers, "receivers"),
					{}};
	if (detailed)
	{
		input.coarse = loaded.level;
	}
	if (!input.receivers.empty())
	{
		input.part = partOf(loaded.level, input.receivers, how.threads);
	}
	for (std::size_t t = 0; turned > 0 && t < triangles.size(); ++t)
	{
		if (!input.part || input.receivers[t] != 0)
		{
			input.turned.push_back(triangles[t] == loaded.level.triangles[t] ? 0 : 1);
		}
	}
	Facts facts = verbFacts("bake");
	addLevelFacts(facts, loaded);
	facts.whole("turned_triangles", turned);
	addSettings(facts, options);
	const Made made = probes                   ? makeProbes(options, input, facts, how)
					  : options.unwrap         ? makeUnwrapped(options, input, facts, how)
					  : options.texture_px > 0 ? makeTexture(options, input, facts, how)
											   : makeVertices(options, input, facts, how);
	if (isShare(how))
	{
		return;
	}
	const Outputs outputs =
		expanded(options.outputs, [&made](const std::string& path)
				 { return isTexture(path) ? pictureFiles(path, static_cast<int>(made.pages)) : std::vector<std::string>{path}; });
	checkRead(outputs, others(read));
	OutputSet files;
	for (std::size_t i = 0; i < made.bytes.size(); ++i)
	{
		files.add(outputs.files[i], made.bytes[i]);
	}
	addSide(files, outputs, facts.json(), read, outputs.json.empty() ? facts.lines() : "");
	files.commit();
	for (const std::string& warning : made.warnings)
	{
		warn(warning);
	}
	for (const Material& material : in_place ? std::vector<Material>() : input.level().material_list)
	{
		const std::string kind = material.picture.starts_with("data:") ? ".png" : endingOf(material.picture);
		if (!material.picture.empty() && material.mask < 0 && kind != ".png" && kind != ".jpg" && kind != ".jpeg")
		{
			warn(material.picture + ": found a picture that few glTF viewers read, expected PNG or JPEG");
		}
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
