// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/load.h"

#include "core/content_hash.h"
#include "core/decimal.h"
#include "core/file.h"
#include "core/lists.h"
#include "core/parallel.h"
#include "core/system.h"
#include "core/words.h"
#include "core/work_units.h"
#include "scene/builtin.h"
#include "scene/gltf_edit.h"
#include "scene/level_glb.h"
#include "scene/load_parts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <tuple>
#include <unordered_set>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 6> kEndings{".gltf", ".glb", ".obj", ".fbx", ".ply", ".stl"};

// Reports the system's reason before a reader hides it. Rejects pipes and devices, which have no end, and UTF-16 text, which
// readers take for no text at all.
void checkReadable(const std::string& path)
{
	std::error_code failed;
	const std::filesystem::file_status status = std::filesystem::status(nativePath(path), failed);
	refuseInputIf(std::filesystem::exists(status) && !std::filesystem::is_regular_file(status), path + ": cannot be read",
				  "a folder or device", "a file", ExitCode::file);
	const std::uintmax_t size = std::filesystem::file_size(nativePath(path), failed);
	refuseIf(!failed && size > kMaxFileBytes, path + ": cannot be read: " + std::strerror(EFBIG), ExitCode::file);
	const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(openFile(path, "rb"), &std::fclose);
	refuseIf(file == nullptr, path + ": cannot be read: " + std::strerror(errno), ExitCode::file);
	std::array<unsigned char, 2> start{};
	refuseInputIf(std::fread(start.data(), 1, start.size(), file.get()) == start.size() && endingOf(path) == ".obj" &&
					  ((start[0] == 0xFE && start[1] == 0xFF) || (start[0] == 0xFF && start[1] == 0xFE)),
				  path, "UTF-16 text", "UTF-8");
}

bool isGltfName(const std::string& path)
{
	const std::string ending = endingOf(path);
	return !path.starts_with(kBuiltinPrefix) && (ending == ".gltf" || ending == ".glb");
}

// Leaves findings, second coordinates and places in `source`.
Level readLevel(const std::string& path, const LoadSettings& settings, LevelSource& source, std::optional<uint32_t> second_set = {})
{
	checkReadable(path);
	Level level;
	if (isGltfName(path))
	{
		source = readGltf(path, settings, level, second_set);
	}
	else
	{
		addOnce(source.files, path);
		readGeometry(path, settings, source, level);
	}
	level.name = nativePath(path).filename().string();
	refuseInputIf(level.triangles.empty(), path, "no triangle", "a surface");
	finishMaterials(settings, source, level);
	Tally missing;
	const std::filesystem::path parent = nativePath(path).parent_path();
	const std::string folder = parent.empty() ? "" : parent.generic_string() + "/";
	std::unordered_set<std::string> seen;
	for (const std::string& file : source.missing)
	{
		const bool is_new = seen.insert(file).second;
		missing.add(file.starts_with(folder) ? file.substr(folder.size()) : file, is_new ? 1 : 0); // as the level names it
	}
	report(source.findings, "missing-file", missing);
	level.files = std::move(source.files);
	return level;
}

void dropTriangles(Level& level, std::span<const uint8_t> keep)
{
	std::size_t to = 0;
	std::vector<Mesh> meshes;
	for (const Mesh& mesh : level.meshes)
	{
		const std::size_t begin = to;
		for (std::size_t i = mesh.first_triangle; i < mesh.first_triangle + mesh.triangle_count; ++i)
		{
			if (keep[i] != 0)
			{
				level.triangles[to] = level.triangles[i];
				level.materials[to] = level.materials[i];
				to += 1;
			}
		}
		if (to > begin)
		{
			Mesh& kept = meshes.emplace_back(mesh);
			kept.first_triangle = begin;
			kept.triangle_count = to - begin;
		}
	}
	level.triangles.resize(to);
	level.materials.resize(to);
	level.meshes = std::move(meshes);
}

// Vertices stay until the level is cleaned.
void ignoreParts(Level& level, const LoadSettings& settings)
{
	if (settings.ignore.empty())
	{
		return;
	}
	std::vector<uint8_t> keep = chosenTriangles(level, settings.ignore, "ignore");
	std::transform(keep.begin(), keep.end(), keep.begin(), [](uint8_t chosen) { return chosen == 0 ? 1 : 0; });
	dropTriangles(level, keep);
	refuseInputIf(level.triangles.empty(), level.name + ": ignore", "every part", "one that is left");
}

// Cleans a level that was read again; returns the earlier index of each vertex.
std::vector<uint32_t> cleanAgain(Level& again, const std::string& name, const LoadSettings& settings, const Level& level,
								 const RunSettings& run)
{
	std::vector<uint32_t> before;
	ignoreParts(again, settings);
	cleanLevel(again, silent(run), &before);
	// Triangles may be flipped by now (bake/bake.h).
	refuseInputIf(again.positions != level.positions, name, "other vertices when reading it again", "an unchanged file");
	return before;
}

// Texture coordinates, or the values in their place; empty if no vertex has any.
std::vector<glm::vec2> secondSet(const std::string& name, const LoadSettings& settings, const Level& level, uint32_t set,
								 const RunSettings& run)
{
	LevelSource source;
	Level again = readLevel(name, settings, source, set);
	const std::vector<glm::vec2> second =
		mapped(cleanAgain(again, name, settings, level, run), [&](uint32_t before) { return source.second_uvs[before]; });
	const bool none = std::all_of(second.begin(), second.end(), [](glm::vec2 uv) { return std::isnan(uv.x); });
	return none ? std::vector<glm::vec2>{} : second;
}

// Not yet cleaned; adds findings from reading.
Level readNamed(const std::string& name, const LoadSettings& settings, std::vector<Finding>& findings)
{
	if (name.starts_with(kBuiltinPrefix))
	{
		refuseIf(settings.unit_m != 0.0 || settings.up != UpAxis::file,
				 std::string(settings.unit_m != 0.0 ? "unit" : "up") + ": found with " + name +
					 ", which is in metres with y up, expected the file of a level");
		return builtinLevel(std::string_view(name).substr(kBuiltinPrefix.size()));
	}
	refuseInputIf(!isLevelName(name), name, "the ending '" + endingOf(name) + "'",
				  ".gltf, .glb, .obj, .fbx, .ply, .stl or builtin:NAME");
	LevelSource source;
	Level level = readLevel(name, settings, source);
	findings.insert(findings.begin(), source.findings.begin(),
					source.findings.end()); // the last of a kind gives the first place (addFindings)
	return level;
}

void checkCleaned(const LoadedLevel& loaded, const std::string& name, const LoadSettings& settings)
{
	const std::vector<Finding>& findings = loaded.diagnosis.findings;
	if (loaded.level.triangles.empty())
	{
		refuseInput(name + ": " + findings.front().first, findings.front().id + " and no triangle that is left", "a surface");
	}
	if (settings.strict && !findings.empty())
	{
		const std::string more =
			findings.size() == 1 ? "" : " and " + std::to_string(findings.size() - 1) + " more kinds of findings";
		refuseInput(name + ": " + findings.front().first,
					findings.front().id + " (" + std::to_string(findings.front().count) + ")" + more, "none (strict)");
	}
}

// Returns the earlier index of each vertex that is left.
std::vector<uint32_t> dropVertices(Level& level, int threads)
{
	std::vector<uint32_t> moved(level.positions.size(), 0); // 1 for used ones, then their new indices
	for (const glm::uvec3& t : level.triangles)
	{
		moved[t.x] = moved[t.y] = moved[t.z] = 1;
	}
	std::vector<uint32_t> before;
	for (uint32_t i = 0; i < moved.size(); ++i)
	{
		if (moved[i] != 0)
		{
			moved[i] = static_cast<uint32_t>(before.size());
			before.push_back(i);
		}
	}
	if (before.size() == moved.size())
	{
		return before;
	}
	const auto take = [&before](auto& values)
	{
		for (std::size_t i = 0; i < before.size() && !values.empty(); ++i)
		{
			values[i] = values[before[i]];
		}
		values.resize(values.empty() ? 0 : before.size());
	};
	take(level.positions);
	take(level.normals);
	take(level.uvs);
	take(level.colours);
	take(level.sources);
	parallelForAll(level.triangles.size(), threads,
				   [&](std::size_t i)
				   {
					   glm::uvec3& t = level.triangles[i];
					   t = {moved[t.x], moved[t.y], moved[t.z]};
				   });
	return before;
}

void appendMaterials(Level& to, Level& from)
{
	std::vector<int> masks;
	for (Mask& mask : from.masks)
	{
		masks.push_back(static_cast<int>(addOnce(to.masks, std::move(mask))));
	}
	std::vector<uint32_t> materials;
	for (Material& material : from.material_list)
	{
		material.mask = material.mask < 0 ? -1 : masks[static_cast<std::size_t>(material.mask)];
		materials.push_back(static_cast<uint32_t>(addOnce(to.material_list, std::move(material))));
	}
	for (const uint32_t material : from.materials)
	{
		to.materials.push_back(materials[material]);
	}
}

// Appends the triangles, meshes, materials, masks, cameras and files of `from` to `to`, moved by `move` metres. Equal masks and
// materials are shared. Cameras are renamed to be unique. Requires that the total numbers of vertices and triangles fit 32 bits.
void appendLevel(Level& to, Level from, glm::dvec3 move)
{
	assert(to.positions.size() + from.positions.size() <= UINT32_MAX && to.triangles.size() + from.triangles.size() <= UINT32_MAX);
	const auto vertices = static_cast<uint32_t>(to.positions.size());
	const std::size_t triangles = to.triangles.size();
	for (const glm::dvec3& position : from.positions)
	{
		to.positions.push_back(position + move);
	}
	append(to.normals, from.normals);
	append(to.uvs, from.uvs);
	if (!to.colours.empty() || !from.colours.empty())
	{
		to.colours.resize(vertices, glm::vec3(1.0F));
		append(to.colours, from.colours);
		to.colours.resize(to.positions.size(), glm::vec3(1.0F));
	}
	to.sources.clear();
	for (const glm::uvec3& triangle : from.triangles)
	{
		// An out-of-range index stays out of range, for the diagnosis.
		const bool inside = std::max({triangle.x, triangle.y, triangle.z}) < from.positions.size();
		to.triangles.push_back(inside ? triangle + vertices : glm::uvec3(UINT32_MAX));
	}
	const auto nodes = static_cast<int>(to.nodes.size());
	for (PartNode& node : from.nodes)
	{
		node.parent += node.parent < 0 ? 0 : nodes;
		to.nodes.push_back(std::move(node));
	}
	for (Mesh& mesh : from.meshes)
	{
		mesh.first_triangle += triangles;
		mesh.node += mesh.node < 0 ? 0 : nodes;
		to.meshes.push_back(std::move(mesh));
	}
	appendMaterials(to, from);
	for (LevelCamera& camera : from.cameras)
	{
		camera.world_from_camera[3] += glm::dvec4(move, 0.0);
		to.cameras.push_back(std::move(camera));
	}
	nameCameras(to.cameras);
	for (const std::string& file : from.files)
	{
		addOnce(to.files, file);
	}
}

LoadedLevel readLevels(std::span<const PlacedLevel> levels, const LoadSettings& settings, const RunSettings& run)
{
	LoadedLevel loaded;
	std::vector<Finding> findings;
	std::optional<ProgressCounter> stage(std::in_place, run.progress, "level", levels.size());
	for (const PlacedLevel& placed : levels)
	{
		Level level = readNamed(placed.name, settings, findings);
		const std::string name = loaded.level.name.empty() ? level.name : loaded.level.name;
		if (&placed == &levels.front() && placed.move == glm::dvec3(0.0))
		{
			loaded.level = std::move(level);
		}
		else
		{
			checkCounts(placed.name, loaded.level.triangles.size() + level.triangles.size(),
						loaded.level.positions.size() + level.positions.size(), " with the levels before it");
			appendLevel(loaded.level, std::move(level), placed.move);
		}
		loaded.level.name = name;
		stage->finishOne();
	}
	if (levels.size() > 1)
	{
		loaded.level.name += " and " + std::to_string(levels.size() - 1) + " more";
	}
	stage.emplace(run.progress, "triangles");
	ignoreParts(loaded.level, settings);
	loaded.diagnosis = cleanLevel(loaded.level, run);
	findUndrawn(loaded.level, findings);
	addFindings(loaded.diagnosis, findings);
	checkCleaned(loaded, levels.size() == 1 ? levels.front().name : loaded.level.name, settings);
	return loaded;
}

// Empty if a file cannot be read; reading the level reports why.
std::vector<std::string> hashesOf(const std::vector<std::string>& files)
{
	std::vector<std::string> hashes;
	for (const std::string& file : files)
	{
		std::error_code failed;
		if (!std::filesystem::is_regular_file(nativePath(file), failed))
		{
			return {};
		}
		try
		{
			hashes.push_back(hashOfFile(file));
		}
		catch (const Error&)
		{
			return {};
		}
	}
	return hashes;
}

std::string keyOf(std::span<const PlacedLevel> levels, const LoadSettings& settings)
{
	ContentHash key;
	key.add("level");
	for (const PlacedLevel& placed : levels)
	{
		key.add(placed.name);
		key.add(placed.move.x, placed.move.y, placed.move.z);
	}
	key.add(settings.unit_m, static_cast<int>(settings.up), settings.strict, settings.max_texels, settings.allow_outside,
			settings.undo_bake, static_cast<int>(settings.pose), static_cast<int>(settings.tr));
	for (const std::string& pattern : settings.ignore)
	{
		key.add(pattern);
	}
	return key.text();
}

// Adds the textures that bakeInto() gave materials.
void addPages(const std::string& path, const Level& level, const RunSettings& run, BakedValues& baked)
{
	GltfFile file = openGltf(path);
	for (const Material& material : level.material_list)
	{
		const auto image = static_cast<std::size_t>(std::max(material.occlusion, 0));
		const JsonValue item = material.occlusion < 0 ? file.root() : file.root().item("images", image);
		if (item.text("name") != kBakedImage || !item.has("bufferView") ||
			(image < baked.pages.size() && baked.pages[image].width_px > 0))
		{
			continue;
		}
		const std::string bytes(viewBytes(file, static_cast<std::size_t>(item.at("bufferView").whole(UINT32_MAX))));
		std::vector<AlphaImage> read = decodeAlphas({{"visibility.png", "", bytes, MaskChannel::red}}, path);
		baked.pages.resize(std::max(baked.pages.size(), image + 1));
		baked.pages[image] = {"", read[0].width_px, read[0].height_px, Wrap::clamp, Wrap::clamp, std::move(read[0].alpha)};
	}
	baked.uvs = secondSet(path, {}, level, kOcclusionSet, run);
	if (baked.uvs.empty())
	{
		baked.pages.clear();
	}
}

} // namespace

bool isLevelName(const std::string& name)
{
	return name.starts_with(kBuiltinPrefix) || std::find(kEndings.begin(), kEndings.end(), endingOf(name)) != kEndings.end();
}

LoadedLevel loadLevel(const std::string& name, const LoadSettings& settings, const RunSettings& run)
{
	const PlacedLevel placed{name, glm::dvec3(0.0)};
	return loadLevels({&placed, 1}, settings, run);
}

LoadedLevel loadLevels(std::span<const PlacedLevel> levels, const LoadSettings& settings, const RunSettings& run)
{
	assert(!levels.empty());
	if (settings.tr != TrMeaning::automatic &&
		std::none_of(levels.begin(), levels.end(), [](const PlacedLevel& placed) { return endingOf(placed.name) == ".obj"; }))
	{
		refuseInput("tr", "with " + levels.front().name, "an OBJ file, whose MTL files it is for", ExitCode::usage);
	}
	if (run.units == nullptr)
	{
		return readLevels(levels, settings, run);
	}
	// The parts of a command share what one of them read, unless a named file is missing.
	LoadedLevel loaded;
	std::vector<std::string> hashes;
	const ProgressCounter stage(run.progress, "level");
	run.units->store().once(
		keyOf(levels, settings),
		[&]
		{
			loaded = readLevels(levels, settings, run);
			hashes = hashesOf(loaded.level.files);
			return hashes.size() == loaded.level.files.size() &&
				   std::none_of(loaded.diagnosis.findings.begin(), loaded.diagnosis.findings.end(),
								[](const Finding& finding) { return finding.id == "missing-file"; });
		},
		[&](Archive& archive)
		{
			archive(hashes, loaded);
			archive.require(!archive.reads() || hashes == hashesOf(loaded.level.files));
		});
	return loaded;
}

LoadedLevel loadLevel(Level level, bool strict, std::vector<uint32_t>& vertices, const RunSettings& run)
{
	LoadedLevel loaded{std::move(level), {}};
	loaded.diagnosis = cleanLevel(loaded.level, run, &vertices);
	LoadSettings settings;
	settings.strict = strict;
	checkCleaned(loaded, loaded.level.name, settings);
	return loaded;
}

std::vector<glm::vec2> loadSecondUvs(const std::string& name, const LoadSettings& settings, const Level& level,
									 const RunSettings& run, uint32_t set)
{
	if (!isGltfName(name))
	{
		return {};
	}
	const ProgressCounter stage(run.progress, "texture coordinates");
	return secondSet(name, settings, level, set, run);
}

std::vector<GltfPlace> loadPlaces(const std::string& name, const LoadSettings& settings, const Level& level,
								  std::span<const std::string> receivers, const RunSettings& run, Level* as_read)
{
	const ProgressCounter stage(run.progress, "places");
	LevelSource source;
	Level again = readLevel(name, settings, source, kPlacesSet);
	const std::vector<glm::dvec3> positions = again.positions;
	const std::vector<glm::vec3> normals = again.normals;
	for (const auto& [patterns, kept, option] :
		 {std::tuple(std::span<const std::string>(settings.ignore), 0, "ignore"), {receivers, 1, "receivers"}})
	{
		if (!patterns.empty())
		{
			const std::vector<uint8_t> chosen = chosenTriangles(again, patterns, option);
			std::erase_if(source.places, [&chosen, kept = kept](const GltfPlace& place)
						  { return place.vertices.empty() || chosen[place.triangle] != kept; });
		}
	}
	if (as_read != nullptr)
	{
		*as_read = again;
	}
	const std::vector<uint32_t> before = cleanAgain(again, name, settings, level, run);
	if (as_read != nullptr)
	{
		return std::move(source.places);
	}
	std::vector<uint32_t> now(positions.size(), UINT32_MAX);
	for (uint32_t i = 0; i < before.size(); ++i)
	{
		now[before[i]] = i;
	}
	std::map<std::array<double, 3>, std::vector<uint32_t>> at; // the level's vertices by position, if any is looked for
	const auto nearest = [&](glm::dvec3 position, glm::vec3 normal)
	{
		for (uint32_t i = 0; at.empty() && i < again.positions.size(); ++i)
		{
			at[{again.positions[i].x, again.positions[i].y, again.positions[i].z}].push_back(i);
		}
		const std::vector<uint32_t>& there = at[{position.x, position.y, position.z}];
		const auto further = [&](uint32_t a, uint32_t b)
		{
			return glm::dot(again.normals[a], normal) < glm::dot(again.normals[b], normal);
		};
		return there.empty() ? UINT32_MAX : *std::max_element(there.begin(), there.end(), further);
	};
	for (GltfPlace& place : source.places)
	{
		for (auto& [of_file, of_level] : place.vertices)
		{
			const uint32_t read = of_level;
			of_level = now[read];
			if (of_level == UINT32_MAX && glm::all(glm::lessThan(glm::abs(positions[read]), glm::dvec3(kFarthest_m))))
			{
				of_level = nearest(positions[read], normals[read]);
			}
		}
		std::erase_if(place.vertices, [](const auto& vertex) { return vertex.second == UINT32_MAX; });
	}
	return std::move(source.places);
}

BakedValues loadBakedValues(const std::string& path, const Level& level, const RunSettings& run)
{
	const ProgressCounter stage(run.progress, "baked values");
	for (std::size_t kind = 0; isGltfName(path) && kind < kBakedSets.size(); ++kind)
	{
		const std::vector<glm::vec2> values = secondSet(path, {}, level, kBakedSets[kind], run);
		if (values.empty())
		{
			continue;
		}
		BakedValues baked;
		baked.kind = static_cast<BakedKind>(kind);
		const float least = baked.kind == BakedKind::visibility ? 0.0F : -1.0F;
		for (const glm::vec2 value : values)
		{
			for (const float side : {value.x, value.y})
			{
				if (!std::isnan(value.x) && !(side >= least && side <= 1.0F))
				{
					throw Error(ExitCode::invalid_input, path + ": " + std::string(kBakedNames[kind]) + ": found " +
															 numberText(static_cast<double>(side)) + ", expected values from " +
															 (least < 0.0F ? "-1" : "0") + " to 1");
				}
			}
			baked.front.push_back(value.x);
			baked.back.push_back(value.y);
		}
		if (const nlohmann::ordered_json record = bakeRecordOf(path); record.is_object() && numberIn(record, "pages", 0) > 0)
		{
			addPages(path, level, run, baked);
		}
		return baked;
	}
	refuseInput(path, "no attribute _VISIBILITY", "a file of nook bake");
}

std::vector<uint32_t> compactLevel(Level& level, std::span<const uint8_t> keep, int threads)
{
	assert(keep.size() == level.triangles.size());
	if (std::find(keep.begin(), keep.end(), 0) != keep.end() ||
		std::any_of(level.meshes.begin(), level.meshes.end(), [](const Mesh& mesh) { return mesh.triangle_count == 0; }))
	{
		dropTriangles(level, keep);
	}
	return dropVertices(level, threads);
}

void visit(Archive& archive, Material& material)
{
	archive(material.name, material.alpha_mode, material.cutoff, material.alpha, material.mask, material.mean_alpha,
			material.coverage, material.two_sided, material.extras, material.colour, material.picture, material.wraps[0],
			material.wraps[1], material.picture_outside);
}

void visit(Archive& archive, Mask& mask)
{
	archive(mask.name, mask.width_px, mask.height_px, mask.wrap_u, mask.wrap_v, mask.nearest, mask.alpha);
}

void visit(Archive& archive, Mesh& mesh)
{
	archive(mesh.name, mesh.first_triangle, mesh.triangle_count, mesh.around, mesh.closed, mesh.node);
}

void visit(Archive& archive, PartNode& node)
{
	archive(node.name, node.parent, node.extras);
}

void visit(Archive& archive, LevelCamera& camera)
{
	archive(camera.name, camera.world_from_camera, camera.lens.orthographic, camera.lens.fov_y_rad, camera.lens.half_height_m,
			camera.lens.near_m, camera.lens.far_m);
}

void visit(Archive& archive, Finding& finding)
{
	archive(finding.id, finding.count, finding.first, finding.action);
}

void visit(Archive& archive, LoadedLevel& loaded)
{
	Level& level = loaded.level;
	archive(level.files, level.name, level.positions, level.normals, level.uvs, level.colours, level.sources, level.source_count,
			level.triangles, level.materials, level.meshes, level.nodes, level.material_list, level.masks, level.cameras,
			loaded.diagnosis.findings);
}

} // namespace nook
