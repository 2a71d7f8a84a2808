// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/measure_view.h"
#include "core/content_hash.h"

#include "bake/bake.h"
#include "bake/sheets.h"
#include "scene/advice.h"
#include "volume/build.h"
#include "volume/clusters.h"
#include "volume/volume_glb.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <map>
#include <utility>

namespace nook
{
namespace
{

// δ_AOV = 0.6 δ_ray (AOV §6); masks have the rays' own falloff.
double distanceOf(VolumeRecipe recipe, double radius_m)
{
	return recipe == VolumeRecipe::masks ? radius_m : kPaperRayRatio * radius_m;
}

VolumeSettings volumeSettings(VolumeRecipe recipe, double radius_m)
{
	VolumeSettings settings;
	settings.distance_m = distanceOf(recipe, radius_m);
	settings.ray_distance_m = radius_m;
	settings.occluders.distance_m = settings.distance_m;
	if (recipe == VolumeRecipe::triangles)
	{
		settings.occluders.merge = false;
		settings.drop.no_receiver = false;
		settings.drop.sides = false;
		settings.drop.inside = false;
	}
	if (recipe == VolumeRecipe::built)
	{
		settings.trim.emplace().share = kBuiltTrim;
		settings.compensate.emplace();
	}
	return settings;
}

std::string hashOf(const Level& level)
{
	ContentHash hash;
	hash.items(std::span<const glm::dvec3>(level.positions));
	hash.items(std::span<const glm::vec3>(level.normals));
	hash.items(std::span<const glm::vec2>(level.uvs));
	hash.items(std::span<const glm::uvec3>(level.triangles));
	hash.items(std::span<const uint32_t>(level.materials));
	for (const Material& material : level.material_list)
	{
		for (const double value : {static_cast<double>(material.alpha_mode), material.cutoff, material.alpha,
								   static_cast<double>(material.mask), material.two_sided ? 1.0 : 0.0})
		{
			hash.add(value);
		}
	}
	for (const Mask& mask : level.masks)
	{
		hash.add(static_cast<double>(mask.width_px));
		hash.add(static_cast<double>(mask.wrap_u));
		hash.add(static_cast<double>(mask.wrap_v));
		hash.items(std::span<const uint8_t>(mask.alpha));
	}
	return hash.text();
}

} // namespace

double radiusFor(const Level& level)
{
	return suggestedRadius(level);
}

struct LevelBench::Data
{
	Data(Level given, double radius, const RunSettings& how, std::shared_ptr<SampleStore> store, double few_split)
		: level(std::move(given)), tracer(level, how), run(how), radius_m(radius > 0.0 ? radius : radiusFor(level)),
		  hash(hashOf(level)), samples(store ? std::move(store) : std::make_shared<SampleStore>()), few(few_split)
	{
	}

	Level level;
	Tracer tracer;
	RunSettings run;
	double radius_m;
	std::string hash;
	std::shared_ptr<SampleStore> samples;
	double few;
	std::map<std::pair<VolumeRecipe, double>, VolumeSet> volumes; // by recipe and scale
	std::map<std::pair<VolumeRecipe, double>, uint64_t> volume_bytes;
	std::map<double, BakedLevel> bakes; // by error
};

LevelBench::LevelBench(Level level, double radius_m, const RunSettings& run, std::shared_ptr<SampleStore> samples, double few)
	: m_data(std::make_shared<Data>(std::move(level), radius_m, run, std::move(samples), few))
{
}

const Level& LevelBench::level() const
{
	return m_data->level;
}

const Tracer& LevelBench::tracer() const
{
	return m_data->tracer;
}

double LevelBench::radiusM() const
{
	return m_data->radius_m;
}

const std::string& LevelBench::contentHash() const
{
	return m_data->hash;
}

SampleStore& LevelBench::samples()
{
	return *m_data->samples;
}

const VolumeSet& LevelBench::volumes(VolumeRecipe recipe, double scale)
{
	const std::pair key(recipe, scale);
	const auto found = m_data->volumes.find(key);
	if (found != m_data->volumes.end())
	{
		return found->second;
	}
	BuiltVolumes built = buildVolumes(m_data->level, volumeSettings(recipe, scale * m_data->radius_m), m_data->run);
	clusterVolumes(built.set, {}, m_data->run);
	return m_data->volumes.emplace(key, std::move(built.set)).first->second;
}

uint64_t LevelBench::volumeBytes(VolumeRecipe recipe, double scale)
{
	const std::pair key(recipe, scale);
	const auto found = m_data->volume_bytes.find(key);
	if (found != m_data->volume_bytes.end())
	{
		return found->second;
	}
	const uint64_t bytes = volumeGlb(volumes(recipe, scale), {}, m_data->level.name, "nook", m_data->run).bytes.size();
	return m_data->volume_bytes.emplace(key, bytes).first->second;
}

const BakedLevel& LevelBench::bake(double max_error)
{
	const auto found = m_data->bakes.find(max_error);
	if (found != m_data->bakes.end())
	{
		return found->second;
	}
	BakeSettings settings;
	settings.radius_m = m_data->radius_m;
	settings.falloff = Falloff::linear;
	settings.max_error = max_error;
	settings.few = m_data->few;
	Level aligned = m_data->level; // as nook bake does it
	std::unique_ptr<Tracer> of_aligned;
	if (alignSheets(aligned, m_data->run.threads) > 0)
	{
		of_aligned = std::make_unique<Tracer>(aligned, m_data->run);
	}
	VertexBake made = bakeVertices(of_aligned ? *of_aligned : m_data->tracer, settings, m_data->run);
	of_aligned.reset();
	BakedLevel baked;
	baked.level = made.refined ? std::move(*made.refined) : std::move(aligned);
	const std::size_t values = made.visibility.size() + made.back.size();
	const std::size_t more_vertices = baked.level.positions.size() - m_data->level.positions.size();
	const std::size_t more_triangles = baked.level.triangles.size() - m_data->level.triangles.size();
	baked.bytes = 4 * values + 32 * more_vertices + 12 * more_triangles;
	baked.values.back = made.back.empty() ? made.visibility : std::move(made.back);
	baked.values.front = std::move(made.visibility);
	BakedLevel& kept = m_data->bakes.emplace(max_error, std::move(baked)).first->second;
	kept.tracer = std::make_unique<Tracer>(kept.level, m_data->run);
	return kept;
}

} // namespace nook
