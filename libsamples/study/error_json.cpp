// SPDX-License-Identifier: GPL-3.0-or-later
// A report ↔ JSON, schema nook.error-report/1.
#include "core/base64.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/text.h"
#include "study/error_report.h"
#include "study/measure_view.h"

#include "format/json_fields.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace nook
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "nook.error-report/1";
constexpr int64_t kMany = int64_t{1} << 40U;

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

double errorFrom(const JsonValue& value)
{
	return value.number(0.0, 1e9);
}

int wholeFrom(const JsonValue& value, int64_t least, int64_t most)
{
	return static_cast<int>(value.integer(least, most));
}

uint64_t sizeFrom(const JsonValue& value)
{
	return static_cast<uint64_t>(value.integer(0, std::numeric_limits<int64_t>::max()));
}

std::optional<double> optionalNumber(const JsonValue& value)
{
	return value.value->is_null() ? std::nullopt : std::optional(value.number());
}

// Errors as they stand among a measurement's other fields.
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

// Times in milliseconds, with nine significant digits; without the picture.
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
	measurement.repetitions = wholeFrom(value.at("repetitions"), 0, 1000000);
	measurement.total = spreadFrom(value.at("time"));
	measurement.passes = value.at("passes").elements(spreadFrom);
	measurement.fragments = sizeFrom(value.at("fragments"));
	measurement.volumes = sizeFrom(value.at("volumes"));
	measurement.bytes = value.has("bytes") ? sizeFrom(value.at("bytes")) : 0; // reports before bakes have none
	measurement.errors = errorsFrom(value);
	measurement.own_rmse = optionalNumber(value.at("own_rmse"));
	return measurement;
}

Json pictureJson(const std::vector<uint8_t>& picture)
{
	return picture.empty() ? Json() : Json(base64Of(picture));
}

Json pointJson(const ErrorPoint& point)
{
	Json json = measurementJson(point.measured);
	json["method"] = point.method;
	json["origin"] = nameOf(point.origin);
	json["count"] = point.count;
	json["resolution"] = point.resolution;
	json["flicker"] = optionalJson(point.flicker);
	json["front"] = point.front;
	json["front_bytes"] = point.front_bytes;
	json["picture"] = pictureJson(point.picture);
	return json;
}

Json limitJson(const ScreenLimit& limit)
{
	Json json{{"thickness", limit.thickness}, {"strength", limit.strength}, {"power", limit.power}};
	json.update(errorsJson(limit.errors));
	return json;
}

ScreenLimit limitFrom(const JsonValue& value)
{
	return {value.at("thickness").number(), value.at("strength").number(), value.at("power").number(), errorsFrom(value)};
}

Json viewJson(const ErrorView& view)
{
	const auto stoppedJson = [](const StoppedPoint& stopped)
	{
		return Json{{"candidate", stopped.name}, {"method", stopped.method}, {"expected_s", stopped.expected_s}};
	};
	return {{"camera", view.camera},
			{"width_px", view.width_px},
			{"height_px", view.height_px},
			{"surface_share", view.surface_share},
			{"reference_error", view.reference_error},
			{"mean_visibility", view.mean_visibility},
			{"front",
			 {{"held", view.share.held},
			  {"papers", view.share.papers},
			  {"worst_ratio", optionalJson(view.share.worst_ratio)},
			  {"worst_paper", view.share.worst_paper}}},
			{"screen_space_limit", view.limit ? limitJson(*view.limit) : Json()},
			{"points", mapped(view.points, pointJson)},
			{"stopped", mapped(view.stopped, stoppedJson)},
			{"picture", pictureJson(view.picture)}};
}

Json levelJson(const ErrorLevel& level)
{
	return {{"name", level.name},
			{"failure", level.failure},
			{"triangles", level.triangles},
			{"radius_m", level.radius_m},
			{"views", mapped(level.views, viewJson)}};
}

std::vector<uint8_t> pictureFrom(const JsonValue& value, std::size_t pixels)
{
	if (value.value->is_null())
	{
		return {};
	}
	const std::optional<std::vector<uint8_t>> bytes = bytesOfBase64(value.string());
	failIf(!bytes || bytes->size() != pixels, value, bytes ? std::to_string(bytes->size()) + " bytes" : "no base64",
		   "a byte for each of " + std::to_string(pixels) + " pixels, in base64");
	return *bytes;
}

ErrorPoint pointFrom(const JsonValue& value, std::size_t pixels)
{
	ErrorPoint point;
	point.measured = measurementFrom(value);
	point.name = point.measured.candidate;
	point.method = value.at("method").string();
	point.origin = enumOf<Origin>(value.at("origin"));
	point.count = wholeFrom(value.at("count"), 0, 1000000);
	point.resolution = value.at("resolution").string();
	point.flicker = optionalNumber(value.at("flicker"));
	point.front = value.at("front").boolean();
	point.front_bytes = value.has("front_bytes") && value.at("front_bytes").boolean();
	point.picture = pictureFrom(value.at("picture"), pixels);
	return point;
}

// Items by a name that no two of them have, in the field `by`: items of two reports are compared by their names.
template <class Item, class Read>
std::vector<Item> namedFrom(const JsonValue& list, std::string Item::*name, const char* by, const Read& read)
{
	std::vector<Item> items;
	for (std::size_t i = 0; i < list.arraySize(); ++i)
	{
		Item item = read(list.at(i));
		failIf(std::any_of(items.begin(), items.end(), [&](const Item& other) { return other.*name == item.*name; }),
			   list.at(i).at(by), "'" + item.*name + "' twice", "each once");
		items.push_back(std::move(item));
	}
	return items;
}

ErrorView viewFrom(const JsonValue& value)
{
	ErrorView view;
	view.camera = value.at("camera").string();
	view.width_px = wholeFrom(value.at("width_px"), 1, 32768);
	view.height_px = wholeFrom(value.at("height_px"), 1, 32768);
	view.surface_share = value.at("surface_share").number();
	view.reference_error = value.at("reference_error").number();
	view.mean_visibility = value.at("mean_visibility").number();
	const JsonValue front = value.at("front");
	view.share.held = front.at("held").number();
	view.share.papers = front.at("papers").elements(&JsonValue::string);
	view.share.worst_ratio = optionalNumber(front.at("worst_ratio"));
	view.share.worst_paper = front.at("worst_paper").string();
	const std::size_t pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
	view.points = namedFrom(value.at("points"), &ErrorPoint::name, "name",
							[pixels](const JsonValue& point) { return pointFrom(point, pixels); });
	if (value.has("screen_space_limit") && !value.at("screen_space_limit").value->is_null())
	{
		view.limit = limitFrom(value.at("screen_space_limit"));
	}
	if (value.has("stopped")) // not in reports of before
	{
		const auto stoppedFrom = [](const JsonValue& one)
		{
			return StoppedPoint{one.at("candidate").string(), one.at("method").string(), one.at("expected_s").number()};
		};
		view.stopped = value.at("stopped").elements(stoppedFrom);
	}
	view.picture = pictureFrom(value.at("picture"), pixels);
	return view;
}

ErrorLevel levelFrom(const JsonValue& value)
{
	ErrorLevel level;
	level.name = value.at("name").string();
	level.failure = value.at("failure").string();
	level.triangles = static_cast<std::size_t>(value.at("triangles").integer(0, kMany));
	level.radius_m = value.at("radius_m").number();
	level.views = namedFrom(value.at("views"), &ErrorView::camera, "camera", viewFrom);
	return level;
}

} // namespace

Json errorReportFields(const ErrorReport& report)
{
	return {{"schema", kSchema},
			{"command", report.command},
			{"version", report.context.version},
			{"machine",
			 {{"renderer", report.context.renderer}, {"software", report.context.software}, {"threads", report.context.threads}}},
			{"rays", report.rays},
			{"repetitions", report.repetitions},
			{"levels", mapped(report.levels, levelJson)}};
}

std::string errorReportJson(const ErrorReport& report)
{
	return jsonFile(errorReportFields(report));
}

ErrorReport errorReportFrom(const std::string& text, const std::string& path)
{
	const nlohmann::json json = parseJson(text, path);
	const JsonValue root{&json, &path, ""};
	requireSchema(root, kSchema);
	ErrorReport report;
	report.command = root.at("command").string();
	const JsonValue machine = root.at("machine");
	report.context = {machine.at("renderer").string(), machine.at("software").boolean(),
					  wholeFrom(machine.at("threads"), 1, 1000000), root.at("version").string()};
	report.rays = wholeFrom(root.at("rays"), 1, 1000000);
	report.repetitions = wholeFrom(root.at("repetitions"), 0, 1000000);
	report.levels = namedFrom(root.at("levels"), &ErrorLevel::name, "name", levelFrom);
	return report;
}

} // namespace nook
