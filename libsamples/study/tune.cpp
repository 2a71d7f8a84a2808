// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/tune.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/lists.h"
#include "core/parallel.h"
#include "core/text.h"
#include "core/work_units.h"
#include "scene/camera_choice.h"
#include "shade/gl_context.h"
#include "study/fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <exception>
#include <map>
#include <set>
#include <utility>

namespace nook
{
namespace
{

// Volumes that take so long a picture, and so many budgets, are not drawn.
constexpr double kSlowest_s = 4.0;
constexpr double kFarOver = 10.0;

// The levels' views at every size that the search asks for, and what measuring costs.
class TuneBench
{
public:
	TuneBench(TuneReport& report, const RunSettings& run)
		: m_report(report), m_run(run), m_busy(availableThreads()), m_store(run.units != nullptr ? &run.units->store() : nullptr)
	{
		m_how.gl_device = m_report.settings.gl_device;
		m_how.session = std::make_shared<GlSession>(m_how.gl_device);
		m_how.errors = false;
		m_how.slowest_s =
			report.settings.goal.budget_s ? std::max(kSlowest_s, kFarOver * *report.settings.goal.budget_s) : kSlowest_s;
	}

	// One view of each level after another, so that few views are of many levels.
	void setViews(const std::vector<std::vector<LevelCamera>>& cameras)
	{
		for (int k = 0; k < m_report.settings.views; ++k)
		{
			for (std::size_t level = 0; level < cameras.size(); ++level)
			{
				if (static_cast<std::size_t>(k) < cameras[level].size())
				{
					m_views.push_back({level, cameras[level][static_cast<std::size_t>(k)]});
				}
			}
		}
		ProgressCounter progress(m_run.progress, "views", m_views.size());
		while (!viewsAreMade(progress))
		{
		}
		for (std::size_t i = 0; i < m_views.size(); ++i)
		{
			TuneLevel& level = m_report.levels[m_views[i].level];
			level.views.push_back(m_views[i].camera.name);
			level.reference_errors.push_back(benchAt(i, 1.0).reference().error);
		}
	}

	std::size_t views() const
	{
		return m_views.size();
	}

	Trial measure(std::size_t index, const Fidelity& fidelity)
	{
		const Candidate& candidate = m_report.candidates[index];
		m_busy.look();
		m_report.busy = m_busy.share();
		MeasureSettings how = m_how;
		how.repetitions = fidelity.repetitions;
		Trial trial;
		// Not where one drawing is all: a pick with a fitted shape is drawn again under its number.
		const bool once = fidelity.scale == 1.0 && fidelity.repetitions == 1 && m_report.settings.repetitions > 1;
		for (std::size_t i = 0; i < fidelity.views; ++i)
		{
			const auto before = once ? m_once.find({index, i}) : m_once.end();
			if (before != m_once.end())
			{
				trial.views.push_back(before->second);
				continue;
			}
			ViewBench& view = benchAt(i, fidelity.scale);
			ContentHash hash;
			hash.add("tune");
			hash.add(m_report.renderer);
			hash.add(view.contentHash(candidate, how, m_report.settings.version));
			const std::string name = hash.text();
			std::optional<Measurement> found = m_store != nullptr ? m_store->get<Measurement>(name) : std::nullopt;
			const bool known = found.has_value();
			(known ? m_report.cached : m_report.measured) += 1;
			if (!known)
			{
				prepare(index, m_views[i].level);
			}
			const auto start = std::chrono::steady_clock::now();
			if (!known)
			{
				found = view.measure(candidate, how);
			}
			if (const uint64_t most = m_report.settings.max_bytes; most > 0 && found->bytes > most)
			{
				throw Error(ExitCode::runtime, "bytes: found " + bytesText(found->bytes) + ", expected at most " + bytesText(most));
			}
			const double error = view.errorBy(m_report.settings.measure, found->visibility);
			trial.cost_s += secondsSince(start);
			if (!known && m_store != nullptr)
			{
				m_store->put(name, *found);
			}
			trial.pictures += fidelity.scale * fidelity.scale * (1.0 + fidelity.repetitions);
			trial.views.push_back(
				{m_views[i].level, found->total.median_s, found->total.low_s, found->total.high_s, error, found->bytes});
			if (once)
			{
				m_once.emplace(std::pair(index, i), trial.views.back());
			}
		}
		return trial;
	}

	// Strength and power of a candidate by a recipe, fitted to all views; none where they bring no less error.
	std::optional<Candidate> withShape(std::size_t index)
	{
		ProgressCounter progress(m_run.progress, "shape", m_views.size());
		Candidate plain = m_report.candidates[index];
		if (!plain.recipe)
		{
			return std::nullopt;
		}
		setShape(*plain.recipe, {});
		std::vector<ShapeView> views;
		for (std::size_t i = 0; i < m_views.size(); ++i)
		{
			ViewBench& view = benchAt(i, 1.0);
			views.push_back(
				shapeView(m_views[i].level, view.draw(plain, m_how), view.reference().visibility, surfacesOf(view.gbuffer())));
			progress.finishOne();
		}
		const CurveShape fitted = fitShape(views);
		if (!(shapedError(views, fitted) < shapedError(views, shapeOf(*m_report.candidates[index].recipe))))
		{
			return std::nullopt;
		}
		setShape(*plain.recipe, fitted);
		return plain;
	}

private:
	// One camera of one level.
	struct View
	{
		std::size_t level = 0;
		LevelCamera camera;
	};

	// False where a level failed, and its views are gone.
	bool viewsAreMade(ProgressCounter& progress)
	{
		for (std::size_t i = 0; i < m_views.size(); ++i)
		{
			const std::size_t level = m_views[i].level;
			try
			{
				benchAt(i, 1.0);
				progress.finishOne();
			}
			catch (const std::exception& problem)
			{
				if (m_report.levels.size() == 1)
				{
					throw;
				}
				m_report.levels[level].failed = problem.what();
				m_benches.clear(); // they go by the number of a view
				std::erase_if(m_views, [level](const View& view) { return view.level == level; });
				return false;
			}
		}
		return true;
	}

	ViewBench& benchAt(std::size_t view, double scale)
	{
		const TuneSettings& settings = m_report.settings;
		const std::pair key(view, scale);
		const auto found = m_benches.find(key);
		if (found != m_benches.end())
		{
			return found->second;
		}
		const auto start = std::chrono::steady_clock::now();
		const auto side = [scale](int pixels)
		{
			return std::max(16, static_cast<int>(std::floor(scale * pixels + 0.5)));
		};
		ViewSettings how{
			.width_px = side(settings.width_px), .height_px = side(settings.height_px), .reference_rays = settings.reference_rays};
		LevelBench& level = *m_report.levels[m_views[view].level].bench;
		const std::string name = viewHash(level, m_views[view].camera, how, settings.version);
		const std::optional<Reference> known = m_store != nullptr ? m_store->get<Reference>("reference " + name) : std::nullopt;
		ViewBench& made = m_benches.emplace(key, ViewBench(level, m_views[view].camera, how, m_run, known)).first->second;
		if (!known)
		{
			const Reference& traced = made.reference(); // now, not while a candidate is timed
			if (m_store != nullptr)
			{
				m_store->put("reference " + name, traced);
			}
		}
		(scale == 1.0 ? m_report.prepared_s : m_report.coarse_s) += secondsSince(start);
		return made;
	}

	// Makes what a candidate's first drawing would: samples or volumes, and what the driver keeps of its shaders.
	void prepare(std::size_t index, std::size_t level)
	{
		const Candidate& candidate = m_report.candidates[index];
		const double coarsest = m_report.rungs.rungs.front().scale;
		ViewBench& first = benchAt(0, coarsest);
		const auto start = std::chrono::steady_clock::now();
		LevelBench& bench = *m_report.levels[level].bench;
		if (candidate.kind == CandidateKind::asset)
		{
			bench.asset(candidate);
		}
		else
		{
			bench.samples->samplesOf(candidate, shadeSettingsOf(candidate, bench.radius_m), m_run);
		}
		if (m_drawn.insert(index).second)
		{
			first.draw(candidate, m_how);
		}
		m_report.prepared_s += secondsSince(start);
	}

	TuneReport& m_report;
	RunSettings m_run;
	BusyWatch m_busy;
	Store* m_store; // null: nothing is kept
	MeasureSettings m_how;
	std::vector<View> m_views;
	std::map<std::pair<std::size_t, double>, ViewBench> m_benches;
	std::set<std::size_t> m_drawn;                                   // candidates
	std::map<std::pair<std::size_t, std::size_t>, ViewTrial> m_once; // of a candidate on a view: drawn once at full size
};

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
			LoadedLevel loaded = loadLevel(given, load, run);
			level.name = loaded.level.name;
			level.files = loaded.level.files;
			level.triangles = loaded.level.triangles.size();
			level.bench = std::make_shared<LevelBench>(std::move(loaded.level), settings.radius_m, run, samples);
			level.radius_m = level.bench->radius_m;
			cameras.back() = chooseCameras(level.bench->tracer, settings.views, run);
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

// Those that nook emits, in its own forms, and bakes, of the methods that are asked for: names of methods that it emits, or "bake".
std::vector<Candidate> tuneCandidates(GridSize grid, const std::vector<std::string>& methods)
{
	const auto isWanted = [&methods](const Candidate& candidate)
	{
		const bool known = candidate.row() != nullptr ? candidate.row()->emitted : candidate.kind == CandidateKind::asset;
		const bool asked = methods.empty() || std::find(methods.begin(), methods.end(), candidate.method()) != methods.end();
		return known && asked && (candidate.origin == Origin::ours || candidate.only_form);
	};
	return itemsWhere(candidateGrid(grid), isWanted);
}

// Compares the runner-up's time with the pick's.
std::string timeText(const TuneReport& report)
{
	const CandidateComparison& found = *report.runner_up;
	if (!found.time_ratio)
	{
		return " The pick takes no extra time.";
	}
	if (report.search.tried[*report.search.runner_up].time_s == 0.0)
	{
		return " It takes no extra time.";
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

TuneSearchSettings rungsFor(std::size_t views, int repetitions)
{
	TuneSearchSettings settings;
	const std::size_t some = std::max<std::size_t>(1, (views + 2) / 3);
	settings.rungs = {{0.5, 1, 1}, {1.0, some, 1}, {1.0, views, 1}, {1.0, views, repetitions}};
	return settings;
}

TuneReport tuneLevels(const std::vector<std::string>& levels, const LoadSettings& load, const TuneSettings& settings,
					  const RunSettings& run)
{
	TuneReport report;
	report.settings = settings;
	report.candidates = tuneCandidates(settings.grid, settings.methods);
	MeasureSettings how;
	how.gl_device = settings.gl_device;
	report.renderer = rendererOf(how).name;
	const auto start = std::chrono::steady_clock::now();
	const std::vector<std::vector<LevelCamera>> cameras = readLevels(levels, load, settings, run, report);
	report.prepared_s = secondsSince(start);
	TuneBench bench(report, run);
	bench.setViews(cameras);
	refuseIf(bench.views() == 0,
			 "levels: found none of " + std::to_string(levels.size()) +
				 " that can be measured, expected one: " + report.levels.front().failed,
			 ExitCode::runtime);
	report.rungs = rungsFor(bench.views(), settings.repetitions);
	const MeasureTrial measure = [&bench](std::size_t candidate, const Fidelity& fidelity)
	{
		return bench.measure(candidate, fidelity);
	};
	report.search = searchCandidates(report.candidates.size(), settings.goal, report.rungs, measure, run.progress);
	fitPick(report, bench);
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
