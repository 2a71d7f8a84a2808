// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/measure_view.h"

#include "core/content_hash.h"
#include "core/json_text.h"
#include "methods/feature_table.h"

#include <nlohmann/json.hpp>

namespace nook
{
namespace
{

void addMatrix(ContentHash& hash, const glm::dmat4& matrix)
{
	for (int column = 0; column < 4; ++column)
	{
		for (int row = 0; row < 4; ++row)
		{
			hash.add(matrix[column][row]);
		}
	}
}

} // namespace

std::string viewHash(const LevelBench& level, const LevelCamera& camera, const ViewSettings& settings, const std::string& version)
{
	ContentHash hash;
	hash.add(version);
	hash.add(level.contentHash());
	const View view = viewOf(camera, settings.width_px, settings.height_px);
	addMatrix(hash, view.camera_from_world);
	addMatrix(hash, view.projection);
	for (const double value : {static_cast<double>(settings.width_px), static_cast<double>(settings.height_px), level.radiusM(),
							   static_cast<double>(settings.reference_rays), static_cast<double>(settings.seed)})
	{
		hash.add(value);
	}
	return hash.text();
}

std::string measurementHash(const std::string& view, const Candidate& candidate, const MeasureSettings& settings, int threads)
{
	ContentHash hash;
	hash.add(view);
	for (const double value :
		 {candidate.radius_ratio, candidate.thickness_ratio, static_cast<double>(settings.repetitions), settings.errors ? 1.0 : 0.0,
		  settings.device == Device::gl ? 1.0 : 0.0, static_cast<double>(threads)})
	{
		hash.add(value);
	}
	for (const FeatureRow& feature : featureTable()) // names have words of some
	{
		hash.add(feature.value.get(candidate.shade));
	}
	if (candidate.recipe)
	{
		hash.add(jsonLine(recipeJson(*candidate.recipe)));
	}
	hash.add(candidate.name());
	hash.add(candidate.kind == CandidateKind::asset && candidate.asset->slow ? settings.slowest_s
																			 : 0.0); // what else there is to compare with
	return hash.text();
}

} // namespace nook
