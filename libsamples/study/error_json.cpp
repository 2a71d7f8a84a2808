// SPDX-License-Identifier: GPL-3.0-or-later
// A report ↔ JSON, schema nook.error-report/1.
#include "core/base64.h"
#include "core/json_text.h"
#include "study/error_report.h"
#include "study/measure_view.h"

#include "format/json_fields.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace nook
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "nook.error-report/1";
constexpr int64_t kMany = int64_t{1} << 40U;

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
	Json json{{"camera", view.camera},
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
			  {"points", Json::array()},
			  {"stopped", Json::array()},
			  {"picture", pictureJson(view.picture)}};
	for (const ErrorPoint& point : view.points)
	{
		json["points"].push_back(pointJson(point));
	}
	for (const StoppedPoint& stopped : view.stopped)
	{
		json["stopped"].push_back({{"candidate", stopped.name}, {"method", stopped.method}, {"expected_s", stopped.expected_s}});
	}
	return json;
}

Json levelJson(const ErrorLevel& level)
{
	Json json{{"name", level.name},
			  {"failure", level.failure},
			  {"triangles", level.triangles},
			  {"radius_m", level.radius_m},
			  {"views", Json::array()}};
	for (const ErrorView& view : level.views)
	{
		json["views"].push_back(viewJson(view));
	}
	return json;
}

int wholeFrom(const JsonValue& value, int64_t least, int64_t most)
{
	return static_cast<int>(value.integer(least, most));
}

std::vector<std::string> textsFrom(const JsonValue& value)
{
	std::vector<std::string> texts;
	for (std::size_t i = 0; i < value.arraySize(); ++i)
	{
		texts.push_back(value.at(i).string());
	}
	return texts;
}

std::vector<uint8_t> pictureFrom(const JsonValue& value, std::size_t pixels)
{
	if (value.value->is_null())
	{
		return {};
	}
	const std::optional<std::vector<uint8_t>> bytes = bytesOfBase64(value.string());
	if (!bytes || bytes->size() != pixels)
	{
		value.fail(bytes ? std::to_string(bytes->size()) + " bytes" : "no base64",
				   "a byte for each of " + std::to_string(pixels) + " pixels, in base64");
	}
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

// Adds an item under a name that no earlier item has: items of two reports are compared by their names.
template <class Item> void addOnce(std::vector<Item>& items, Item item, std::string Item::*name, const JsonValue& where)
{
	if (std::any_of(items.begin(), items.end(), [&](const Item& other) { return other.*name == item.*name; }))
	{
		where.fail("'" + item.*name + "' twice", "each once");
	}
	items.push_back(std::move(item));
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
	view.share.papers = textsFrom(front.at("papers"));
	view.share.worst_ratio = optionalNumber(front.at("worst_ratio"));
	view.share.worst_paper = front.at("worst_paper").string();
	const std::size_t pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
	const JsonValue points = value.at("points");
	for (std::size_t i = 0; i < points.arraySize(); ++i)
	{
		addOnce(view.points, pointFrom(points.at(i), pixels), &ErrorPoint::name, points.at(i).at("name"));
	}
	if (value.has("screen_space_limit") && !value.at("screen_space_limit").value->is_null())
	{
		view.limit = limitFrom(value.at("screen_space_limit"));
	}
	if (value.has("stopped")) // not in reports of before
	{
		const JsonValue list = value.at("stopped");
		for (std::size_t i = 0; i < list.arraySize(); ++i)
		{
			const JsonValue one = list.at(i);
			view.stopped.push_back({one.at("candidate").string(), one.at("method").string(), one.at("expected_s").number()});
		}
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
	const JsonValue views = value.at("views");
	for (std::size_t i = 0; i < views.arraySize(); ++i)
	{
		addOnce(level.views, viewFrom(views.at(i)), &ErrorView::camera, views.at(i).at("camera"));
	}
	return level;
}

} // namespace

Json errorReportFields(const ErrorReport& report)
{
	Json json{{"schema", kSchema},
			  {"command", report.command},
			  {"version", report.context.version},
			  {"machine",
			   {{"renderer", report.context.renderer}, {"software", report.context.software}, {"threads", report.context.threads}}},
			  {"rays", report.rays},
			  {"repetitions", report.repetitions},
			  {"levels", Json::array()}};
	for (const ErrorLevel& level : report.levels)
	{
		json["levels"].push_back(levelJson(level));
	}
	return json;
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
	const JsonValue levels = root.at("levels");
	for (std::size_t i = 0; i < levels.arraySize(); ++i)
	{
		addOnce(report.levels, levelFrom(levels.at(i)), &ErrorLevel::name, levels.at(i).at("name"));
	}
	return report;
}

} // namespace nook
