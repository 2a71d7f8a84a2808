// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/json_text.h"
#include "study/measurement_json.h"
#include "study/tune_page.h"

#include <nlohmann/json.hpp>

namespace nook
{
namespace
{

using Json = nlohmann::ordered_json;

Json triedJson(const TuneReport& report, const TuneSearch& search, std::size_t i)
{
	const Tried& tried = search.tried[i];
	const Candidate& candidate = report.candidates[i];
	Json json{{"candidate", candidate.name()}, {"method", candidate.method()}, {"resolution", candidate.resolution()}};
	if (!tried.failed.empty())
	{
		json["failed"] = tried.failed;
		return json;
	}
	json["rung"] = tried.rung;
	json["time_ms"] = 1e3 * tried.time_s;
	json["error"] = tried.error;
	json["bytes"] = bytesOf(tried.trial);
	json["views"] = Json::array();
	for (const ViewTrial& view : tried.trial.views)
	{
		json["views"].push_back({{"level", view.level},
								 {"time_ms", 1e3 * view.time_s},
								 {"low_ms", 1e3 * view.low_s},
								 {"high_ms", 1e3 * view.high_s},
								 {"error", view.error},
								 {"bytes", view.bytes}});
	}
	return json;
}

Json candidatesJson(const TuneReport& report, const TuneSearch& search)
{
	Json list = Json::array();
	for (std::size_t i = 0; i < report.candidates.size(); ++i)
	{
		list.push_back(triedJson(report, search, i));
	}
	return list;
}

// Levels in the order of the command line.
Json levelsJson(const TuneReport& report)
{
	Json levels = Json::array();
	for (const TuneLevel& level : report.levels)
	{
		Json json{{"given", level.given}};
		if (!level.failed.empty())
		{
			json["failed"] = level.failed;
		}
		else
		{
			json["name"] = level.name;
			json["triangles"] = level.triangles;
			json["radius_m"] = level.radius_m;
			json["views"] = level.views;
			json["reference_errors"] = level.reference_errors;
		}
		levels.push_back(json);
	}
	return levels;
}

Json emissionJson(const TuneEmission& emission)
{
	Json json{{"files", Json::array()},
			  {"holds", Json::array()},
			  {"commands", emission.commands},
			  {"use", emission.use},
			  {"left_out", Json::array()}};
	for (const EmittedFile& file : emission.files)
	{
		json["files"].push_back(file.name);
		json["holds"].push_back(file.what);
	}
	for (const LeftOut& left : emission.left_out)
	{
		json["left_out"].push_back({{"feature", left.feature}, {"why", left.why}});
	}
	return json;
}

Json comparisonJson(const TuneReport& report)
{
	const CandidateComparison& found = *report.runner_up;
	Json json{{"candidate", report.candidates[*report.search.runner_up].name()},
			  {"views", found.views},
			  {"error_difference", found.error_difference},
			  {"error_standard", optionalJson(found.error_standard)},
			  {"errors_differ", found.errors_differ},
			  {"time_ratio", optionalJson(found.time_ratio)},
			  {"times_differ", found.times_differ ? Json(*found.times_differ) : Json()}};
	return json;
}

} // namespace

std::string tuneJson(const TuneReport& report, const TuneText& text)
{
	const TuneSettings& settings = report.settings;
	Json json{{"schema", "nook.tune/1"}, {"command", text.command}, {"version", text.version}, {"renderer", report.renderer}};
	json["goal"] = {{"budget_ms", Json()}, {"max_error", Json()}};
	(settings.goal.budget_s ? json["goal"]["budget_ms"] : json["goal"]["max_error"]) =
		settings.goal.budget_s ? 1e3 * *settings.goal.budget_s : *settings.goal.max_error;
	json["max_bytes"] = settings.max_bytes > 0 ? Json(settings.max_bytes) : Json();
	json["measure"] = nameOf(settings.measure);
	json["over"] = nameOf(settings.goal.over);
	json["size"] = {settings.width_px, settings.height_px};
	json["levels"] = levelsJson(report);
	json["rungs"] = Json::array();
	for (std::size_t i = 0; i < report.rungs.rungs.size(); ++i)
	{
		const Fidelity& rung = report.rungs.rungs[i];
		json["rungs"].push_back({{"scale", rung.scale},
								 {"views", rung.views},
								 {"repetitions", rung.repetitions},
								 {"candidates", report.search.rungs[i].candidates},
								 {"seconds", report.search.rungs[i].cost_s}});
	}
	json["seconds"] = {{"search", report.search.cost_s}, {"prepared", report.prepared_s}, {"coarse", report.coarse_s}};
	json["pick"] = report.search.pick ? triedJson(report, report.search, *report.search.pick) : Json();
	json["nearest"] = report.search.nearest ? triedJson(report, report.search, *report.search.nearest) : Json();
	json["instead_of"] = report.search.instead_of ? Json(report.candidates[*report.search.instead_of].name()) : Json();
	json["busy"] = report.busy;
	json["runner_up"] = report.runner_up ? comparisonJson(report) : Json();
	json["confidence"] = confidenceText(report);
	json["front"] = Json::array();
	for (const std::size_t i : frontOf(report.grid ? *report.grid : report.search, report.rungs.once()))
	{
		json["front"].push_back(report.candidates[i].name());
	}
	json["candidates"] = candidatesJson(report, report.search);
	if (report.grid)
	{
		json["grid"] = {{"best", report.grid->pick ? triedJson(report, *report.grid, *report.grid->pick) : Json()},
						{"seconds", report.grid->cost_s},
						{"text", gridText(report)},
						{"candidates", candidatesJson(report, *report.grid)}};
	}
	json["emitted"] = text.emission != nullptr ? emissionJson(*text.emission) : Json();
	const TuneTexts texts = tuneTexts(report);
	json["texts"] = {{"goal", texts.goal},
					 {"pick", texts.pick},
					 {"measured", texts.measured},
					 {"search", texts.search},
					 {"failures", texts.failures}};
	return jsonFile(json);
}

} // namespace nook
