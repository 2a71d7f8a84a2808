// SPDX-License-Identifier: GPL-3.0-or-later
// nook bake: a level → the same file with visibility at its vertices or in a texture, or the visibility of probes.
#include "bake_options.h"
#include "call.h"

#include "bake/auto.h"
#include "bake/probes.h"
#include "core/image.h"
#include "core/lists.h"
#include "core/math.h"
#include "core/system.h"
#include "core/text.h"
#include "core/words.h"
#include "core/work_units.h"
#include "format/pattern_file.h"
#include "scene/camera_choice.h"
#include "scene/level_glb.h"
#include "scene/load_parts.h"
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

constexpr std::array<std::string_view, 5> kBakeFormats{".glb", ".gltf", ".csv", ".npy", ".json"};
constexpr std::array<std::string_view, 5> kTextureFormats{".glb", ".gltf", ".png", ".exr", ".ktx2"};
constexpr std::array<std::string_view, 2> kAutoFormats{".glb", ".gltf"};
constexpr std::array<std::string_view, 2> kProbeFormats{".ktx2", ".glsl"};
constexpr std::size_t kCheckPoints = 4096;
constexpr const char* kProgram = "nook " NOOK_VERSION;

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
	std::vector<uint8_t> turned;    // 1 for each receiving triangle that was flipped before the bake; empty: none
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
	GltfBake bake = options.form;
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

// Throws if it cannot take the bake. `as_read`: becomes the level before it was cleaned, whose vertices the places then have.
BakeFile fileOf(const BakeOptions& options, const BakeInput& input, const Level& level, const GltfBake& bake,
				const RunSettings& how, Level* as_read = nullptr)
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
		made.file = openGlb(levelGlb(level, kProgram, &made.places), level.name);
		std::erase_if(made.places, [&input](const GltfPlace& place) { return input.part && input.receivers[place.triangle] == 0; });
	}
	checkTarget(made.file, made.places, bake);
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
	std::erase_if(outputs, [](const std::string& path) { return isValues(path) || isTextureName(path); });
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
		if (!isTextureName(path))
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

Made makeVertices(const BakeOptions& options, const BakeInput& input, Facts& facts, const RunSettings& how)
{
	BakeSettings settings = options.settings;
	const Level& receiving = input.part ? input.part->level : input.level();
	settings.receivers = &receiving;
	GltfBake in = bakeOf(options);
	VertexBake bake;
	const bool splits = settings.max_error > 0.0 && (input.in_place || input.part);
	in.split.how = splits ? &bake.split : nullptr;
	BakeFile target = fileOf(options, input, input.level(), in, how);
	bake = bakeVertices(input.tracer, settings, how);
	std::vector<glm::uvec3> split; // triangles
	if (splits)
	{
		split = bake.refined->triangles;
		in.split = {&bake.split, receiving.triangles, split, receiving.positions.size()};
	}
	else if (bake.refined)
	{
		target = fileOf(options, input, *bake.refined, in, how);
	}
	std::optional<Level> turned;
	if (!input.turned.empty())
	{
		turnBack(bake.refined ? *bake.refined : turned.emplace(receiving), bake, input.turned);
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
		const std::vector<float> all = bake.refined ? *values : spread(input, *values);
		give<float>(name, all, {all.size()});
	}
	for (const auto& [name, values] : {std::pair("bent", &bake.bent), {"bent_back", &bake.bent_back}})
	{
		const std::vector<glm::vec3> all = bake.refined ? *values : spread(input, *values);
		give<float>(name, all, {all.size(), 3});
	}
	if (bake.refined)
	{
		give<double>("positions", level.positions, {level.positions.size(), 3});
		give<uint32_t>("triangles", level.triangles, {level.triangles.size(), 3});
	}
	addBakeResult(facts, options, bake);
	addBakeCheck(facts, options, check, "other points of the surface");
	facts.when(settings.base != nullptr).number("rmse_of_volumes", check.rmse_without);
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
		if (!isTextureName(path))
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

Made makeUnwrapped(const BakeOptions& options, const BakeInput& input, Facts& facts, const RunSettings& how)
{
	Level as_read;
	GltfBake in = bakeOf(options);
	in.charts.resize(1);
	const BakeFile target = fileOf(options, input, input.level(), in, how, &as_read);
	const Level& level = input.in_place ? as_read : input.level();
	const Unwrapped unwrapped = unwrap(level, piecesOf(target.places), options.charts, how);
	BakeSettings settings = options.settings;
	const std::vector<TextureBake> pages = bakePages(input.tracer, unwrapped, settings, how);
	const LevelPart solid =
		partOf(unwrapped.level, mapped(unwrapped.page_of, [](uint32_t page) { return uint8_t{page != kNoPage}; }), how.threads);
	std::vector<uint32_t> page_of = unwrapped.page_of;
	std::erase(page_of, kNoPage);
	settings.receivers = &solid.level;
	const BakeCheck check = checkTexture(input.tracer, solid.level.uvs, pages, page_of, settings, kCheckPoints, how);
	if (isShare(how))
	{
		return {};
	}
	in.charts = chartsOf(target.places, unwrapped, false);
	in.pages = mapped(pages, pngOf);
	Made made;
	const GltfBaked baked = write(options, target, level, in, made);
	facts.text("coordinates", "unwrapped");
	facts.whole("pages", unwrapped.pages);
	facts.number("texel_size_m", unwrapped.texel_m);
	facts.number("coverage", unwrapped.coverage);
	facts.number("stretch", unwrapped.stretch);
	facts.line("unwrapped: " + std::to_string(unwrapped.charts) + " charts on " + counted(unwrapped.pages, "page", "pages") +
			   ", texels of " + roundedText(unwrapped.texel_m, 3) + " m, coverage " + roundedText(unwrapped.coverage, 3) +
			   ", stretch " + roundedText(unwrapped.stretch, 3));
	addBakeTextures(facts, pages, sumOver(in.pages, [](const std::string& png) { return png.size(); }));
	addBakeCheck(facts, options, check, "points of the surface");
	addFile(facts, input, baked);
	addTextureFiles(options, pages, made);
	return made;
}

// The triangles of a level as the file has them: 1 for each one of the pieces in order that aligning its sheets turns.
std::vector<uint8_t> turnSheets(Level& level, std::span<const UnwrapPiece> pieces, int threads)
{
	const std::vector<glm::uvec3> before = level.triangles;
	std::vector<uint8_t> turned;
	for (const bool any = alignSheets(level, threads) > 0; const UnwrapPiece& piece : pieces)
	{
		for (std::size_t i = 0; any && i < piece.triangles.size(); ++i)
		{
			turned.push_back(before[piece.triangles[i]] == level.triangles[piece.triangles[i]] ? 0 : 1);
		}
	}
	return turned;
}

// Refuses a limit that values at the vertices alone exceed, however they turn out.
void checkBytes(const BakeOptions& options, const BakeFile& target, const Level& level, GltfBake in)
{
	const std::vector<float> values = listOf(level.positions.size(), [&](std::size_t v)
											 { return static_cast<float>(v) / static_cast<float>(level.positions.size()); });
	in.visibility = values;
	in.back = options.settings.sides == BakeSides::separate ? in.visibility : std::span<const float>();
	const std::size_t bytes = bakeInto(target.file, target.places, in, {}).bytes_added;
	refuseIf(options.max_bytes > 0 && bytes > options.max_bytes, "--max-bytes: found " + std::to_string(options.max_bytes) +
																	 ", expected at least " + std::to_string(bytes) +
																	 ", which values at the vertices take");
}

// Two rows of a table, and the same for programs.
void addShares(Facts& facts, const AutoBake& bake)
{
	std::vector<Facts> items;
	const std::size_t more = bake.bytes - std::min(bake.bytes, bake.value_bytes);
	for (const auto& [name, share, bytes] :
		 {std::tuple("texture", &bake.textured, more), {"vertices", &bake.at_vertices, bake.bytes - more}})
	{
		Facts& item = items.emplace_back();
		item.text("kind", name);
		item.whole("triangles", share->triangles);
		item.number("area_m2", share->area_m2);
		item.whole("bytes", bytes);
		item.number("rmse", share->rmse);
		facts.line(std::string(name) + ": " + std::to_string(share->triangles) + " triangles, " + roundedText(share->area_m2, 3) +
				   " m2, " + std::to_string(bytes) + " bytes, RMSE " + roundedText(share->rmse, 3));
	}
	facts.items("choices", items);
}

Made makeAuto(const BakeOptions& options, const BakeInput& input, Facts& facts, const RunSettings& how)
{
	Level level;
	GltfBake in = bakeOf(options);
	const BakeFile target = fileOf(options, input, input.level(), in, how, &level);
	level = input.in_place ? std::move(level) : input.level();
	const std::vector<UnwrapPiece> pieces = piecesOf(target.places);
	const std::vector<uint8_t> turned = turnSheets(level, pieces, how.threads);
	checkBytes(options, target, level, in);
	std::vector<GltfPlace> nodes = target.places;
	std::erase_if(nodes, [](const GltfPlace& place) { return place.instance.has_value(); });
	in.charts.resize(1);
	checkTarget(target.file, nodes, in);
	BakeSettings settings = options.settings;
	settings.max_error = 0.0;
	const AutoSettings wanted{options.settings.max_error, options.max_bytes, options.charts.margin_px,
							  settings.sides == BakeSides::mean};
	const std::vector<GltfCost> costs = costsOf(target.file, target.places);
	const std::size_t value_bytes = settings.sides == BakeSides::separate ? 8 : 4;
	const auto costOf = [&](std::size_t i)
	{
		const GltfPlace& place = target.places[i];
		return AutoPiece{{costs[i].vertex_bytes + value_bytes, costs[i].has_list}, place.count, !place.instance};
	};
	Made made;
	std::optional<GltfBaked> baked;
	const auto bytesOf = [&](const AutoBake& bake)
	{
		Unwrapped unwrapped = bake.unwrapped;
		VertexBake vertices = bake.vertices;
		turnBack(unwrapped.level, vertices, turned);
		in.visibility = vertices.visibility;
		in.back = vertices.back;
		in.charts = chartsOf(target.places, unwrapped, true);
		in.pages = mapped(bake.pages, pngOf);
		in.record["pages"] = in.pages.size();
		made = {};
		baked = write(options, target, unwrapped.level, in, made);
		return baked->bytes_added;
	};
	const AutoBake bake =
		bakeAuto(input.tracer, level, pieces, listOf(pieces.size(), costOf), turned, settings, wanted, bytesOf, how);
	bytesOf(bake);
	const std::size_t png_bytes = sumOver(in.pages, [](const std::string& png) { return png.size(); });
	facts.whole("pages", bake.pages.size());
	facts.whole("png_bytes", png_bytes);
	if (!bake.pages.empty())
	{
		facts.whole("texels_across", bake.unwrapped.size_px);
		facts.whole("charts", bake.unwrapped.charts);
		facts.number("coverage", bake.unwrapped.coverage);
		facts.line("texture: " + std::to_string(bake.unwrapped.charts) + " charts on " +
				   counted(bake.pages.size(), "page", "pages") + " of " + std::to_string(bake.unwrapped.size_px) + " texels, " +
				   std::to_string(png_bytes) + " bytes as PNG");
	}
	addShares(facts, bake);
	addBakeResult(facts, options, bake.vertices);
	addBakeCheck(facts, options, bake.check, "points of the surface");
	facts.number("expected_rmse", bake.expected_rmse);
	addFile(facts, input, *baked);
	if (bake.is_short)
	{
		made.warnings.push_back("--max-error: found an RMSE of " + roundedText(bake.expected_rmse, 3) + ", expected " +
								roundedText(options.settings.max_error, 3) +
								" at most; texels are no smaller than a 32nd of the radius" +
								(bake.vertices.back.empty() ? "" : ", and backs have values at the vertices only"));
	}
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
	GltfBake in = bakeOf(options);
	const BakeFile target = fileOf(options, input, input.level(), in, how);
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
	addBakeTextures(facts, pages, png.size());
	addBakeCheck(facts, options, check, "points of the surface");
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
	made.bytes =
		mapped(options.outputs.files, [&grid](const std::string& path)
			   { return formatOf(path, kProbeFormats) == ".glsl" ? probesGlsl(grid, kProgram) : probesKtx2(grid, kProgram); });
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
	addBakeCheck(facts, options, check, "points in the open");
	return made;
}

void run(BakeOptions& options, VerbProgress& progress)
{
	settleBake(options);
	const bool probes = options.probes_m > 0.0;
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
				 : options.automatic      ? std::span<const std::string_view>(kAutoFormats)
				 : options.texture_px > 0 ? std::span<const std::string_view>(kTextureFormats)
										  : kBakeFormats,
				 others({options.level.level, options.volumes, options.from}));
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
		append(read, detailed->level.files);
	}
	addInputs(read, how);
	const bool in_place = takesValues(options.level.level, loaded.level);
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
	addBakeSettings(facts, options);
	const Made made = probes                   ? makeProbes(options, input, facts, how)
					  : options.automatic      ? makeAuto(options, input, facts, how)
					  : options.unwrap         ? makeUnwrapped(options, input, facts, how)
					  : options.texture_px > 0 ? makeTexture(options, input, facts, how)
											   : makeVertices(options, input, facts, how);
	if (isShare(how))
	{
		return;
	}
	const Outputs outputs = expanded(
		options.outputs, [&made](const std::string& path)
		{ return isTextureName(path) ? pictureFiles(path, static_cast<int>(made.pages)) : std::vector<std::string>{path}; });
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
		declareBake, run);
}

} // namespace nook
