// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/measure_view.h"

#include "core/content_hash.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/text.h"
#include "methods/feature_table.h"

#include <nlohmann/json.hpp>

#include <limits>

namespace nook
{
namespace
{

using Json = nlohmann::ordered_json;

// Nine significant digits: a time that is read back as seconds writes the same digits again.
double millisecondsOf(double seconds)
{
	return roundedNumber(1e3 * seconds, 9);
}

Json spreadJson(const TimeSpread& spread)
{
	return {{"pass", spread.name},
			{"ms", millisecondsOf(spread.median_s)},
			{"low_ms", millisecondsOf(spread.low_s)},
			{"high_ms", millisecondsOf(spread.high_s)}};
}

TimeSpread spreadFrom(const JsonValue& value)
{
	return {value.at("pass").string(), 1e-3 * value.at("ms").number(), 1e-3 * value.at("low_ms").number(),
			1e-3 * value.at("high_ms").number()};
}

uint64_t wholeFrom(const JsonValue& value)
{
	return static_cast<uint64_t>(value.integer(0, std::numeric_limits<int64_t>::max()));
}

double errorFrom(const JsonValue& value)
{
	return value.number(0.0, 1e9);
}

} // namespace

std::optional<double> optionalNumber(const JsonValue& value)
{
	return value.value->is_null() ? std::nullopt : std::optional(value.number());
}

Json optionalJson(const std::optional<double>& value)
{
	return value ? Json(*value) : Json();
}

Json errorsJson(const ViewErrors& errors)
{
	return {{"eq14", errors.eq14},
			{"rmse", errors.rmse},
			{"flip", errors.flip},
			{"ssim", optionalJson(errors.ssim)},
			{"mean_error", errors.mean_error},
			{"best_factor", errors.best_factor},
			{"best_rmse", errors.best_rmse}};
}

ViewErrors errorsFrom(const JsonValue& value)
{
	return {errorFrom(value.at("eq14")),      errorFrom(value.at("rmse")),     errorFrom(value.at("flip")),
			optionalNumber(value.at("ssim")), value.at("mean_error").number(), value.at("best_factor").number(),
			errorFrom(value.at("best_rmse"))};
}

Json measurementJson(const Measurement& measurement)
{
	Json json{{"name", measurement.candidate},
			  {"renderer", measurement.renderer},
			  {"repetitions", measurement.repetitions},
			  {"time", spreadJson(measurement.total)},
			  {"passes", mapped(measurement.passes, spreadJson)},
			  {"fragments", measurement.fragments},
			  {"volumes", measurement.volumes},
			  {"bytes", measurement.bytes}};
	json.update(errorsJson(measurement.errors));
	json["own_rmse"] = optionalJson(measurement.own_rmse);
	return json;
}

Measurement measurementFrom(const JsonValue& value)
{
	Measurement measurement;
	measurement.candidate = value.at("name").string();
	measurement.renderer = value.at("renderer").string();
	measurement.repetitions = static_cast<int>(value.at("repetitions").integer(0, 1000000));
	measurement.total = spreadFrom(value.at("time"));
	measurement.passes = value.at("passes").elements(spreadFrom);
	measurement.fragments = wholeFrom(value.at("fragments"));
	measurement.volumes = wholeFrom(value.at("volumes"));
	measurement.bytes = value.has("bytes") ? wholeFrom(value.at("bytes")) : 0; // reports before bakes have none
	measurement.errors = errorsFrom(value);
	measurement.own_rmse = optionalNumber(value.at("own_rmse"));
	return measurement;
}

std::string viewHash(const LevelBench& level, const LevelCamera& camera, const ViewSettings& settings, const std::string& version)
{
	ContentHash hash;
	hash.add(version);
	hash.add(level.hash);
	const View view = viewOf(camera, settings.width_px, settings.height_px);
	for (const glm::dmat4& matrix : {view.camera_from_world, view.projection})
	{
		hash.add(std::as_bytes(std::span(&matrix[0][0], 16)));
	}
	hash.add(settings.width_px, settings.height_px, level.radius_m, settings.reference_rays, settings.seed);
	return hash.text();
}

std::string measurementHash(const std::string& view, const Candidate& candidate, const MeasureSettings& settings, int threads)
{
	ContentHash hash;
	hash.add(view);
	hash.add(candidate.radius_ratio, candidate.thickness_ratio, settings.repetitions, settings.errors,
			 settings.device == Device::gl, threads);
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
