// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/tune.h"

#include "core/error.h"
#include "core/text.h"
#include "scene/camera_choice.h"
#include "study/tune_bench.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <utility>

namespace nook
{

template <> std::span<const std::string_view> namesOf<ErrorMeasure>()
{
	static constexpr std::array<std::string_view, 3> kNames{"rmse", "eq14", "flip"};
	return kNames;
}

template <> std::span<const std::string_view> namesOf<OverLevels>()
{
	static constexpr std::array<std::string_view, 2> kNames{"mean", "worst"};
	return kNames;
}

namespace
{

// Sets the strength and the power of the pick to those that suit these levels, as an artist would with sliders.
void fitPick(TuneReport& report, TuneBench& bench)
{
	if (!report.search.taken())
	{
		return;
	}
	const std::size_t pick = *report.search.taken();
	const std::optional<Candidate> fitted = bench.withShape(pick);
	if (!fitted)
	{
		return;
	}
	const Candidate before = std::exchange(report.candidates[pick], *fitted);
	const Trial trial = bench.measure(pick, report.rungs.rungs.back());
	Tried& tried = report.search.tried[pick];
	const double error = errorOf(trial, report.settings.goal.over);
	if (error < tried.error)
	{
		tried.trial = trial;
		tried.error = error;
		tried.time_s = timeOf(trial, report.settings.goal.over);
		report.shape_before = before.recipe;
		if (report.search.nearest && reaches(report.settings.goal, tried.time_s, tried.error))
		{
			report.search.pick = std::exchange(report.search.nearest, std::nullopt);
		}
	}
	else
	{
		report.candidates[pick] = before;
	}
}

void readLevel(TuneLevel& level, const LoadSettings& load, double radius_m, const RunSettings& run,
			   const std::shared_ptr<SampleStore>& samples)
{
	LoadedLevel loaded = loadLevel(level.given, load, run);
	level.name = loaded.level.name;
	level.files = loaded.level.files;
	level.triangles = loaded.level.triangles.size();
	level.bench = std::make_shared<LevelBench>(std::move(loaded.level), radius_m, run, samples);
	level.radius_m = level.bench->radiusM();
}

} // namespace

std::vector<Candidate> tuneCandidates(GridSize grid, const std::vector<std::string>& methods)
{
	std::vector<Candidate> kept;
	for (const Candidate& candidate : candidateGrid(grid))
	{
		const bool known = candidate.row() != nullptr ? candidate.row()->emitted : candidate.kind == CandidateKind::asset;
		const bool asked = methods.empty() || std::find(methods.begin(), methods.end(), candidate.method()) != methods.end();
		if (known && asked && (candidate.origin == Origin::ours || candidate.only_form))
		{
			kept.push_back(candidate);
		}
	}
	return kept;
}

TuneSearchSettings rungsFor(std::size_t views, int repetitions)
{
	TuneSearchSettings settings;
	const std::size_t some = std::max<std::size_t>(1, (views + 2) / 3);
	settings.rungs = {{0.5, 1, 1}, {1.0, some, 1}, {1.0, views, 1}, {1.0, views, repetitions}};
	return settings;
}

namespace
{

// Returns the cameras of the levels that can be read, and notes why others cannot. Throws where the only level cannot be read.
std::vector<std::vector<LevelCamera>> readLevels(const std::vector<std::string>& levels, const LoadSettings& load,
												 const TuneSettings& settings, const RunSettings& run, TuneReport& report)
{
	const auto samples = std::make_shared<SampleStore>();
	std::vector<std::vector<LevelCamera>> cameras;
	ProgressCounter stage(run.progress, "levels", countIfSeveral(levels.size()));
	for (const std::string& given : levels)
	{
		report.levels.emplace_back().given = given;
		TuneLevel& level = report.levels.back();
		cameras.emplace_back();
		try
		{
			readLevel(level, load, settings.radius_m, run, samples);
			cameras.back() = chooseCameras(level.bench->tracer(), settings.views, run);
		}
		catch (const std::exception& problem)
		{
			if (levels.size() == 1)
			{
				throw;
			}
			level.failed = problem.what();
			cameras.back().clear();
		}
		stage.finishOne();
	}
	return cameras;
}

} // namespace

TuneReport tuneLevels(const std::vector<std::string>& levels, const LoadSettings& load, const TuneSettings& settings,
					  const RunSettings& run)
{
	TuneReport report;
	report.settings = settings;
	report.candidates = tuneCandidates(settings.grid, settings.methods);
	MeasureSettings how;
	how.gl_device = settings.gl_device;
	report.renderer = rendererOf(how).name;
	const Clock clock;
	const std::vector<std::vector<LevelCamera>> cameras = readLevels(levels, load, settings, run, report);
	report.prepared_s = clock.seconds();
	TuneBench bench(report, run);
	bench.setViews(cameras);
	if (bench.views() == 0)
	{
		throw Error(ExitCode::runtime, "levels: found none of " + std::to_string(levels.size()) +
										   " that can be measured, expected one: " + report.levels.front().failed);
	}
	report.rungs = rungsFor(bench.views(), settings.repetitions);
	const MeasureTrial measure = [&bench](std::size_t candidate, const Fidelity& fidelity)
	{
		return bench.measure(candidate, fidelity);
	};
	report.search = searchCandidates(report.candidates.size(), settings.goal, report.rungs, measure, run.progress);
	fitPick(report, bench);
	if (settings.check_grid)
	{
		report.grid = searchGrid(report.candidates.size(), settings.goal, report.rungs, measure, &report.search, run.progress);
	}
	if (report.search.pick && report.search.runner_up)
	{
		report.runner_up =
			compareTrials(report.search.tried[*report.search.pick].trial, report.search.tried[*report.search.runner_up].trial);
	}
	return report;
}

std::string goalText(const TuneSettings& settings)
{
	if (!settings.goal.budget_s)
	{
		return "--max-error " + roundedText(*settings.goal.max_error, 4);
	}
	const double budget_s = *settings.goal.budget_s;
	return "--budget " + (budget_s >= 1.0     ? roundedText(budget_s, 4) + "s"
						  : budget_s >= 0.001 ? roundedText(1e3 * budget_s, 4) + "ms"
											  : roundedText(1e6 * budget_s, 4) + "us");
}

std::string triedText(const TuneReport& report, std::size_t candidate)
{
	const Tried& tried = report.search.tried[candidate];
	const uint64_t bytes = bytesOf(tried.trial);
	return report.candidates[candidate].name() + ": " + roundedText(1e3 * tried.time_s, 3) + " ms, " +
		   std::string(nameOf(report.settings.measure)) + " " + roundedText(tried.error, 4) +
		   (bytes > 0 ? ", " + bytesText(bytes) + " a level" : std::string());
}

std::string bytesText(uint64_t bytes)
{
	const auto value = static_cast<double>(bytes);
	return value < 1e6 ? roundedText(1e-3 * value, 3) + " kB" : roundedText(1e-6 * value, 3) + " MB";
}

namespace
{

// Compares the runner-up's time with the pick's.
std::string timeText(const TuneReport& report)
{
	const CandidateComparison& found = *report.runner_up;
	if (!found.time_ratio)
	{
		return " The pick takes no time of its own.";
	}
	if (report.search.tried[*report.search.runner_up].time_s == 0.0)
	{
		return " It takes no time of its own.";
	}
	const std::string times = " Its time is " + fixedText(*found.time_ratio, 2) + " times the pick's";
	return !found.times_differ   ? times + ", from a single drawing, so its spread is unknown."
		   : *found.times_differ ? times + ", which is outside the spread of the drawings."
								 : times + ", which is within the spread of the drawings.";
}

std::string errorText(const CandidateComparison& found)
{
	const std::string over = found.views == 1 ? "On a single view" : "Over " + std::to_string(found.views) + " views";
	const std::string text = " " + over + " its error differs from the pick's by " +
							 (std::signbit(found.error_difference) ? "" : "+") + roundedText(found.error_difference, 2);
	return !found.error_standard ? text + "; one view does not tell whether that is significant."
								 : text + " (standard error " + roundedText(*found.error_standard, 1) + "), which is " +
									   (found.errors_differ ? "" : "not ") + "significant.";
}

} // namespace

std::string confidenceText(const TuneReport& report)
{
	if (!report.search.pick)
	{
		return report.search.nearest ? "Nothing reaches the goal; the nearest is " + triedText(report, *report.search.nearest) + "."
									 : "Nothing could be drawn.";
	}
	if (!report.runner_up)
	{
		return "No other candidate that was drawn on all views reaches the goal.";
	}
	const bool costs_more = report.search.instead_of == report.search.runner_up;
	return (costs_more ? "The least error has " : "Next is ") + triedText(report, *report.search.runner_up) + "." +
		   errorText(*report.runner_up) + timeText(report) +
		   (costs_more ? " Where errors do not differ significantly, the cheapest candidate is taken." : "");
}

} // namespace nook
