// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/content_hash.h"
#include "study/measure_view.h"

#include "scene/advice.h"

#include <glm/geometric.hpp>

#include <cassert>
#include <map>
#include <utility>

namespace nook
{
namespace
{

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
	std::map<std::string, std::unique_ptr<LevelAsset>> assets; // by key
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

LevelAsset& LevelBench::asset(const Candidate& candidate)
{
	assert(candidate.kind == CandidateKind::asset);
	std::unique_ptr<LevelAsset>& made = m_data->assets[candidate.asset->key(candidate)];
	if (!made)
	{
		const AssetSource source{m_data->level, m_data->tracer, m_data->radius_m, m_data->few};
		made = candidate.asset->make(source, candidate, m_data->run);
	}
	return *made;
}

} // namespace nook
