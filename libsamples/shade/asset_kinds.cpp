// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/asset_kinds.h"

#include "bake/bake.h"
#include "core/decimal.h"
#include "core/error.h"
#include "core/lists.h"
#include "methods/method_table.h"
#include "scene/gltf_edit.h"
#include "scene/load_parts.h"
#include "volume/assets.h"
#include "volume/build.h"
#include "volume/volume_glb.h"
#include "volume/volumes.h"

#include <algorithm>
#include <array>
#include <optional>

namespace nook
{

namespace
{

// Volumes and masks.

class VolumeAsset : public LevelAsset
{
public:
	VolumeAsset(VolumeSet set, std::string level, const RunSettings& run)
		: m_set(std::move(set)), m_level(std::move(level)), m_run(run)
	{
	}

	AovShaded draw(const GBuffer& gbuffer, const AssetSettings& settings, bool gl, const RunSettings& run,
				   const DrawSettings& drawing) const override
	{
		return gl ? aovOnGl(gbuffer, m_set, settings.aov, drawing) : aovOnCpu(gbuffer, m_set, settings.aov, run, drawing);
	}

	uint64_t bytes() override
	{
		m_bytes = m_bytes ? m_bytes : volumeGlb(m_set, {}, m_level, "nook", m_run).bytes.size();
		return *m_bytes;
	}

	std::string file(const AssetFile& of, std::string& what) const override
	{
		what = "volumes of " + m_level + ": " + std::to_string(m_set.occluders.polygons.size());
		return volumeGlb(m_set, {}, m_level, "nook " + std::string(of.version), m_run).bytes;
	}

private:
	VolumeSet m_set;
	std::string m_level;
	RunSettings m_run;
	std::optional<uint64_t> m_bytes;
};

// δ_AOV = 0.6 δ_ray (AOV §6); masks have the rays' own falloff.
double volumeDistance(VolumeRecipe recipe, double radius_m)
{
	return recipe == VolumeRecipe::masks ? radius_m : kPaperRayRatio * radius_m;
}

std::unique_ptr<LevelAsset> makeVolumes(const AssetSource& source, const AssetSettings& asset, const RunSettings& run)
{
	VolumeSettings settings;
	settings.distance_m = volumeDistance(asset.volumes, source.radius_m);
	settings.ray_distance_m = source.radius_m;
	settings.masks = asset.volumes == VolumeRecipe::masks;
	settings.occluders.distance_m = settings.distance_m;
	if (asset.volumes == VolumeRecipe::triangles)
	{
		settings.occluders.merge = false;
		settings.drop.no_receiver = false;
		settings.drop.sides = false;
		settings.drop.inside = false;
	}
	if (asset.volumes == VolumeRecipe::built)
	{
		settings.trim.emplace().share = kBuiltTrim;
		settings.compensate.emplace();
	}
	BuiltVolumes built = buildVolumes(source.level, settings, run);
	clusterVolumes(built.set, settings.masks ? kMaskClusters : ClusterSettings{}, run);
	return std::make_unique<VolumeAsset>(std::move(built.set), source.level.name, run);
}

std::string_view volumeResolution(const AssetSettings& settings)
{
	return settings.aov.every_px == 3 ? "third" : settings.aov.every_px == 5 ? "fifth" : "full";
}

AssetSettings volumeDefinition(const AssetSettings& settings)
{
	AssetSettings best = settings;
	best.aov.every_px = 1;
	return best;
}

std::string volumeWords(const AssetSettings& settings)
{
	const AovSettings& aov = settings.aov;
	std::string words = aov.mask ? " " + std::to_string(aov.directions) : "";
	words += !aov.mask || settings.volumes != VolumeRecipe::masks ? " " + std::string(nameOf(settings.volumes)) : "";
	words += !aov.mask && !aov.compensate ? " sum" : "";
	return words + (aov.every_px > 1 ? " " + std::string(volumeResolution(settings)) : "");
}

AssetCandidate volumeCandidate(Origin origin, VolumeRecipe recipe, int directions, int every_px)
{
	AssetCandidate candidate{origin, {}};
	candidate.settings.volumes = recipe;
	candidate.settings.aov.mask = directions > 0;
	candidate.settings.aov.directions = directions > 0 ? directions : candidate.settings.aov.directions;
	candidate.settings.aov.every_px = every_px;
	return candidate;
}

const std::vector<int> kEveryPx{1, 3, 5}; // AOV §5.5: one pixel of n²

std::vector<AssetCandidate> sumCandidates(GridSize size)
{
	std::vector<AssetCandidate> all = mapped(upTo<int>(size, {1, 3}, kEveryPx, kEveryPx), [](const int n)
											 { return volumeCandidate(Origin::paper, VolumeRecipe::triangles, 0, n); });
	for (const int n : kEveryPx)
	{
		all.push_back(volumeCandidate(Origin::ours, VolumeRecipe::built, 0, n));
	}
	return all;
}

// Masks are Laine and Karras', here with nook's polygons.
std::vector<AssetCandidate> maskCandidates(GridSize size)
{
	std::vector<AssetCandidate> all;
	for (const int directions : upTo<int>(size, {128}, {64, 128, 256}, {32, 64, 128, 256}))
	{
		for (const int n : upTo<int>(size, {3}, kEveryPx, kEveryPx))
		{
			all.push_back(volumeCandidate(Origin::ours, VolumeRecipe::masks, directions, n));
		}
	}
	return all;
}

std::string volumeCommand(const AssetSettings& settings, const AssetLevel& level)
{
	return "nook volumes " + level.words + " --distance " + numberText(volumeDistance(settings.volumes, level.radius_m)) +
		   (settings.volumes == VolumeRecipe::masks ? " --masks" : " --ray-distance " + numberText(level.radius_m)) +
		   (settings.volumes == VolumeRecipe::built ? " --trim " + numberText(kBuiltTrim) + " --compensate" : "");
}

void emitVolumes(AssetEmission& made)
{
	const AovSettings& aov = made.settings.aov;
	const std::string method(volumeRow(aov.mask).name);
	const std::string target(nameOf(made.target));
	refuseIf(!drawsVolumes(made.target, aov.mask),
			 "glsl: found " + target + " with " + method + " as the pick, expected 330, 430 or vulkan, or methods without it",
			 ExitCode::unsupported);
	constexpr const char* kModule = "nook_aov.glsl";
	std::string command = "nook emit --methods " + method + (made.device_depth ? " --depth device" : "");
	command += aov.mask ? " --directions " + std::to_string(aov.directions) : "";
	command += " --glsl " + target;
	const AovTextSettings text{made.target, aov.mask ? aov.directions : 0, made.device_depth};
	made.files.push_back(
		{kModule, volumesGlsl(text, {command, made.version, {}, {}}), "the stages that draw volumes; its head says how"});
	made.commands.push_back(command + " -o " + kModule);
	made.add_levels();
	made.files.push_back({"nook_volumes.h", std::string(assets::nook_volumes_h), "C++: reads the volumes"});
	made.files.push_back({"nook_volumes_draw.h", std::string(assets::nook_volumes_draw_h), "C++: what a frame needs of them"});
	made.use.push_back("nook_volumes::Camera::every = " + std::to_string(aov.every_px) +
					   (aov.every_px > 1 ? ", and the stage NOOK_SPARSE over the whole picture" : ""));
	made.use.emplace_back(
		"they are of static geometry: for what moves take a screen-space method as well, and the lesser visibility of the two");
}

// Bakes.

class BakeAsset : public LevelAsset
{
public:
	// `turned`: 1 for each triangle that was flipped before the bake; empty: none.
	BakeAsset(Level level, std::vector<uint8_t> turned, VertexBake bake, uint64_t bytes, const BakeSettings& settings,
			  const RunSettings& run)
		: m_level(std::move(level)), m_turned(std::move(turned)), m_bake(std::move(bake)), m_bytes(bytes), m_settings(settings),
		  m_tracer(baked(), run)
	{
	}

	// On the CPU, whatever the device: the values are interpolated with what draws the level.
	AovShaded draw(const GBuffer& gbuffer, const AssetSettings& /*settings*/, bool /*gl*/, const RunSettings& run,
				   const DrawSettings& /*drawing*/) const override
	{
		BakedValues values;
		values.front = m_bake.visibility;
		values.back = m_bake.back.empty() ? m_bake.visibility : m_bake.back;
		const BakedPicture picture = bakedPicture(m_tracer, values, gbuffer, run);
		AovShaded drawn;
		drawn.shaded.renderer = "CPU";
		PassTime none{"none"};
		none.drawings.push_back(0.0);
		drawn.shaded.passes = {none};
		drawn.shaded.visibility = listOf(picture.values.size(),
										 [&picture](std::size_t i) { return picture.is_baked[i] != 0 ? picture.values[i] : 1.0F; });
		return drawn;
	}

	uint64_t bytes() override
	{
		return m_bytes;
	}

	std::string file(const AssetFile& of, std::string& what) const override
	{
		what = m_level.name + " with visibility at its vertices: " + std::to_string(baked().positions.size());
		GltfBake bake;
		bake.record = {{"to", "visibility"},      {"radius_m", m_settings.radius_m}, {"falloff", "linear"},
					   {"rays", m_settings.rays}, {"version", of.version},           {"command", of.command}};
		std::vector<GltfPlace> places;
		GltfFile file;
		VertexBake values = m_bake;
		if (takesValues(of.level, m_level))
		{
			places = loadPlaces(of.level, of.load, m_level, {}, of.run);
			file = openGltf(of.level);
			file.settings = of.load;
			if (m_bake.refined)
			{
				bake.split = {&m_bake.split, m_level.triangles, m_bake.refined->triangles, m_level.positions.size()};
			}
			Level turned = baked();
			turnBack(turned, values, m_turned);
		}
		else
		{
			std::string bytes = levelGlb(baked(), "nook " + std::string(of.version), &places);
			file = openGlb(std::move(bytes), m_level.name);
		}
		bake.visibility = values.visibility;
		bake.back = values.back;
		return bakeInto(file, places, bake, std::array<std::string, 1>{"level.glb"}).files.front();
	}

private:
	const Level& baked() const
	{
		return m_bake.refined ? *m_bake.refined : m_level;
	}

	Level m_level;
	std::vector<uint8_t> m_turned;
	VertexBake m_bake;
	uint64_t m_bytes;
	BakeSettings m_settings;
	Tracer m_tracer; // of baked()
};

std::unique_ptr<LevelAsset> makeBake(const AssetSource& source, const AssetSettings& asset, const RunSettings& run)
{
	BakeSettings settings{
		.radius_m = source.radius_m, .falloff = Falloff::linear, .max_error = asset.bake_error, .few = source.few};
	Level level = source.level; // as nook bake does it
	std::vector<uint8_t> turned;
	std::optional<Tracer> of_aligned;
	if (alignSheets(level, run.threads) > 0)
	{
		of_aligned.emplace(level, run);
		turned = listOf(level.triangles.size(),
						[&](std::size_t t) -> uint8_t { return level.triangles[t] == source.level.triangles[t] ? 0 : 1; });
	}
	VertexBake made = bakeVertices(of_aligned ? *of_aligned : source.tracer, settings, run);
	of_aligned.reset();
	// Four bytes per value; for vertices that were added 36 (position, normal, uv, value) and their indices.
	const Level& baked = made.refined ? *made.refined : level;
	const std::size_t values = made.visibility.size() + made.back.size();
	const std::size_t more_vertices = baked.positions.size() - level.positions.size();
	const std::size_t more_triangles = baked.triangles.size() - level.triangles.size();
	return std::make_unique<BakeAsset>(std::move(level), std::move(turned), std::move(made),
									   4 * values + 32 * more_vertices + 12 * more_triangles, settings, run);
}

std::string bakeWords(const AssetSettings& settings)
{
	return settings.bake_error > 0.0 ? " " + numberText(settings.bake_error) : "";
}

// Budgets of bytes: the level's vertices, and as many as an error asks for.
std::vector<AssetCandidate> bakeCandidates(GridSize size)
{
	std::vector<AssetCandidate> all;
	for (const double error : upTo<double>(size, {0.0, 0.1}, {0.0, 0.1, 0.05}, {0.0, 0.2, 0.1, 0.05}))
	{
		all.emplace_back().settings.bake_error = error;
	}
	return all;
}

std::string bakeCommand(const AssetSettings& settings, const AssetLevel& level)
{
	return "nook bake " + level.words + " --radius " + numberText(level.radius_m) + " --falloff linear" +
		   (settings.bake_error > 0.0 ? " --max-error " + numberText(settings.bake_error) : "");
}

// The level with visibility at its vertices: engines multiply their ambient light by it.
void emitBake(AssetEmission& made)
{
	made.add_levels();
	made.use.emplace_back(
		"multiply ambient light by the vertices' _VISIBILITY; where a material has two sides and gl_FrontFacing is "
		"false, by _VISIBILITY_BACK");
	made.use.emplace_back("a glTF level is your own file with these values added; other levels are new files with their materials");
	made.use.emplace_back("a bake is of static geometry: for what moves take a screen-space method as well, which darkens by "
						  "screen / screen without what moves");
}

std::vector<AssetKind> assetKinds()
{
	const AssetKind sums{.name = "aov",
						 .what = "occlusion volumes",
						 .ending = ".volumes.glb",
						 .slow = true,
						 .pixel_s = 2e-6,
						 .make_s = [](const AssetSettings& settings, double triangles)
						 { return settings.volumes == VolumeRecipe::built ? 2.0 + 1.4e-4 * triangles : 0.3 + 2.4e-5 * triangles; },
						 .candidates = sumCandidates,
						 .words = volumeWords,
						 .key = [](const AssetSettings& settings) { return "volumes " + std::string(nameOf(settings.volumes)); },
						 .resolution = volumeResolution,
						 .definition = volumeDefinition,
						 .make = makeVolumes,
						 .command = volumeCommand,
						 .emit = emitVolumes};
	AssetKind masks = sums;
	masks.name = "aov-mask";
	masks.what = "masks of directions";
	masks.candidates = maskCandidates;
	return {sums,
			masks,
			{.name = "bake",
			 .what = "a bake",
			 .ending = ".baked.glb",
			 .option = "--bake",
			 .with_level = true,
			 .pixel_s = 2e-7,
			 .make_s = [](const AssetSettings& settings, double triangles)
			 { return triangles * (4e-5 + (settings.bake_error > 0.0 ? 2.5e-5 / settings.bake_error : 0.0)); },
			 .candidates = bakeCandidates,
			 .words = bakeWords,
			 .key = [](const AssetSettings& settings) { return "bake" + bakeWords(settings); },
			 .make = makeBake,
			 .command = bakeCommand,
			 .emit = emitBake}};
}

} // namespace

std::span<const AssetKind> assetTable()
{
	static const std::vector<AssetKind> table = assetKinds();
	return table;
}

const AssetKind* assetNamed(std::string_view name)
{
	return firstWhere(assetTable(), [name](const AssetKind& kind) { return kind.name == name; });
}

std::vector<const AssetKind*> kindsBesideMethods()
{
	return itemsWhere(mapped(assetTable(), [](const AssetKind& kind) { return &kind; }),
					  [](const AssetKind* kind) { return methodNamed(kind->name) == nullptr; });
}

std::string namesBesideMethods()
{
	return joinedText(kindsBesideMethods(), "", [](const AssetKind* const kind) { return ", " + std::string(kind->name); });
}

} // namespace nook
