// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/tune.h"

#include "core/json_text.h"
#include "core/lists.h"
#include "core/text.h"
#include "core/words.h"
#include "page/page_fill.h"
#include "study/measure_view.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace nook
{
namespace
{

// With blanks before it.
std::string padded(const std::string& text, std::size_t width)
{
	return std::string(width - std::min(width, text.size()), ' ') + text;
}

// "     0.81", or blanks.
std::string megabytes(const Tried& tried)
{
	const uint64_t bytes = bytesOf(tried.trial);
	return padded(bytes > 0 ? roundedText(1e-6 * static_cast<double>(bytes), 3) : "", 8);
}

// Returns the candidates that were measured at full size on all views, fastest first.
std::vector<std::size_t> onAllViews(const TuneReport& report)
{
	std::vector<std::size_t> all = indicesWhere(report.search.tried.size(),
												[&](std::size_t i) { return isFrom(report.search.tried[i], report.rungs.once()); });
	std::stable_sort(all.begin(), all.end(),
					 [&](std::size_t a, std::size_t b) { return report.search.tried[a].time_s < report.search.tried[b].time_s; });
	return all;
}

// Half the distance between the quartiles of a drawing's time, as a share, the greatest of any view; of one drawing there is none.
std::string spreadOf(const TuneReport& report, const Tried& tried)
{
	if (tried.time_s == 0.0)
	{
		return "   none";
	}
	if (report.rungs.rungs[tried.rung].repetitions < 2)
	{
		return "   once";
	}
	double most = 0.0;
	for (const ViewTrial& view : tried.trial.views)
	{
		most = std::max(most, view.time_s > 0.0 ? 0.5 * (view.high_s - view.low_s) / view.time_s : 0.0);
	}
	return "±" + padded(fixedText(100.0 * most, 0), 4) + " %";
}

std::string whatWasMeasured(const TuneReport& report)
{
	std::string names;
	std::size_t views = 0;
	for (const TuneLevel& level : report.levels)
	{
		names += level.failed.empty()
					 ? (names.empty() ? "" : ", ") + level.name + " (reach " + roundedText(level.radius_m, 6) + " m)"
					 : "";
		views += level.views.size();
	}
	const TuneSettings& settings = report.settings;
	return names + "; " + counted(views, "view", "views") + " of " + std::to_string(settings.width_px) + " × " +
		   std::to_string(settings.height_px) + " pixels; " + std::string(nameOf(settings.measure)) + " to rays, " +
		   (settings.goal.over == OverLevels::mean ? "the mean over levels" : "the worst of the levels");
}

std::string searchText(const TuneReport& report)
{
	std::string text = counted(report.candidates.size(), "candidate", "candidates") + ": ";
	std::string rungs;
	for (std::size_t i = 0; i < report.search.rungs.size(); ++i)
	{
		const Fidelity& rung = report.rungs.rungs[i];
		if (report.search.rungs[i].candidates > 0)
		{
			rungs += (rungs.empty() ? "" : ", ") + std::to_string(report.search.rungs[i].candidates) + " at " +
					 (rung.scale == 1.0 ? "full size" : roundedText(rung.scale, 6) + " of the width") + " on " +
					 counted(rung.views, "view", "views") + " with " +
					 counted(static_cast<std::size_t>(rung.repetitions), "drawing", "drawings");
		}
	}
	return text + rungs + "; measuring took " + fixedText(report.search.cost_s, 1) + " s, preparing levels and references " +
		   fixedText(report.prepared_s + report.coarse_s, 1) + " s";
}

std::vector<std::string> failures(const TuneReport& report)
{
	std::vector<std::string> lines;
	for (const TuneLevel& level : report.levels)
	{
		if (!level.failed.empty())
		{
			lines.push_back("level " + level.given + " is not in these figures: " + level.failed);
		}
	}
	const std::vector<Tried>& tried = report.search.tried;
	const std::vector<std::size_t> failed = indicesWhere(tried.size(), [&](std::size_t i) { return !tried[i].failed.empty(); });
	if (!failed.empty())
	{
		const Tried& first = tried[failed.front()];
		lines.push_back(counted(failed.size(), "candidate", "candidates") + (failed.size() == 1 ? " is" : " are") +
						" not in these figures; the first is " + report.candidates[first.candidate].name() + ": " + first.failed);
	}
	if (const std::string busy = busyText(report.busy); !busy.empty())
	{
		lines.push_back(busy);
	}
	return lines;
}

using Json = nlohmann::ordered_json;

Json triedJson(const TuneReport& report, std::size_t i)
{
	const Tried& tried = report.search.tried[i];
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
	const auto viewJson = [](const ViewTrial& view)
	{
		return Json{{"level", view.level},          {"time_ms", 1e3 * view.time_s}, {"low_ms", 1e3 * view.low_s},
					{"high_ms", 1e3 * view.high_s}, {"error", view.error},          {"bytes", view.bytes}};
	};
	json["views"] = mapped(tried.trial.views, viewJson);
	return json;
}

// Levels in the order of the command line.
Json levelsJson(const TuneReport& report)
{
	const auto levelJson = [](const TuneLevel& level) -> Json
	{
		if (!level.failed.empty())
		{
			return {{"given", level.given}, {"failed", level.failed}};
		}
		return {{"given", level.given},       {"name", level.name},   {"triangles", level.triangles},
				{"radius_m", level.radius_m}, {"views", level.views}, {"reference_errors", level.reference_errors}};
	};
	return mapped(report.levels, levelJson);
}

Json emissionJson(const TuneEmission& emission)
{
	return {{"files", mapped(emission.files, [](const EmittedFile& file) { return file.name; })},
			{"holds", mapped(emission.files, [](const EmittedFile& file) { return file.what; })},
			{"commands", emission.commands},
			{"use", emission.use},
			{"left_out", mapped(emission.left_out,
								[](const LeftOut& left) {
									return Json{{"feature", left.feature}, {"why", left.why}};
								})}};
}

Json comparisonJson(const TuneReport& report)
{
	const CandidateComparison& found = *report.runner_up;
	return {{"candidate", report.candidates[*report.search.runner_up].name()},
			{"views", found.views},
			{"error_difference", found.error_difference},
			{"error_standard", optionalJson(found.error_standard)},
			{"errors_differ", found.errors_differ},
			{"time_ratio", optionalJson(found.time_ratio)},
			{"times_differ", found.times_differ ? Json(*found.times_differ) : Json()}};
}

} // namespace

std::string tuneLines(const TuneReport& report, const TuneText& text)
{
	std::string lines = goalText(report.settings) + " on " + report.renderer + "\n" + whatWasMeasured(report) + "\n";
	lines += joinedText(failures(report), "", [](const std::string& line) { return line + "\n"; });
	lines += "      ms   spread    " + std::string(nameOf(report.settings.measure)) +
			 "        MB   candidate (full size, all views; * the front)\n";
	const std::vector<std::size_t> best = frontOf(report.search, report.rungs.once());
	for (const std::size_t i : onAllViews(report))
	{
		const Tried& tried = report.search.tried[i];
		const bool on_front = std::find(best.begin(), best.end(), i) != best.end();
		lines += padded(roundedText(1e3 * tried.time_s, 3), 8) + "   " + spreadOf(report, tried) + "  " +
				 fixedText(tried.error, 4) + "  " + megabytes(tried) + (on_front ? " * " : "   ") + report.candidates[i].name() +
				 "\n";
	}
	if (report.search.pick)
	{
		lines += "pick: " + triedText(report, *report.search.pick) + "\n";
	}
	lines += confidenceText(report) + "\n";
	if (text.emission != nullptr)
	{
		lines += joinedText(text.emission->left_out, "",
							[](const LeftOut& left) { return "left out: " + left.feature + ": " + left.why + "\n"; });
		lines += joinedText(text.emission->use, "", [](const std::string& line) { return "use: " + line + "\n"; });
	}
	lines += searchText(report) + "\n";
	return lines;
}

std::string tuneHtml(const TuneReport& report, const TuneText& text)
{
	return pageHtml({"what to take for " + goalText(report.settings),
					 text.version,
					 assets::tune_html,
					 {assets::error_css, assets::tune_css},
					 {assets::charts_js, assets::error_charts_js, assets::tune_page_js},
					 tuneJson(report, text)});
}

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
	json["pick"] = report.search.pick ? triedJson(report, *report.search.pick) : Json();
	json["nearest"] = report.search.nearest ? triedJson(report, *report.search.nearest) : Json();
	json["instead_of"] = report.search.instead_of ? Json(report.candidates[*report.search.instead_of].name()) : Json();
	json["busy"] = report.busy;
	json["runner_up"] = report.runner_up ? comparisonJson(report) : Json();
	json["confidence"] = confidenceText(report);
	json["front"] =
		mapped(frontOf(report.search, report.rungs.once()), [&](const std::size_t i) { return report.candidates[i].name(); });
	json["candidates"] = listOf(report.candidates.size(), [&](std::size_t i) { return triedJson(report, i); });
	json["emitted"] = text.emission != nullptr ? emissionJson(*text.emission) : Json();
	json["texts"] = {{"goal", goalText(settings)},
					 {"pick", report.search.taken() ? triedText(report, *report.search.taken()) : ""},
					 {"measured", whatWasMeasured(report)},
					 {"search", searchText(report)},
					 {"failures", failures(report)}};
	return jsonFile(json);
}

} // namespace nook
