// SPDX-License-Identifier: GPL-3.0-or-later
// Measures a report's levels, one after the other; what a cache has is not measured again.
#include "study/error_report.h"
#include "study/measure_view.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/lists.h"
#include "core/work_units.h"
#include "scene/camera_choice.h"
#include "scene/load.h"
#include "shade/gl_context.h"
#include "study/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <set>

namespace nook
{

void visit(Archive& archive, ScreenLimit& limit)
{
	archive(limit.thickness, limit.strength, limit.power, limit.errors);
}

namespace
{

// Bakes end where fewer could be split. The courtyard at a radius of 1 m and an error of 0.1: 13 of 32 rounds, and 97 % of the
// triangles.
constexpr double kFewTriangles = 2e-3;

constexpr double kLimit_s = 1.3e-4; // of a pixel, on one thread: the screen-space limit (docs/reference/sharing.md)

std::vector<uint8_t> bytesOf(const std::vector<float>& visibility)
{
	return mapped(visibility,
				  [&](const float value) { return static_cast<uint8_t>(std::clamp(255.0F * value + 0.5F, 0.0F, 255.0F)); });
}

std::vector<Candidate> gridOf(const ErrorReportSettings& settings)
{
	std::vector<Candidate> grid = settings.only.empty() ? candidateGrid(settings.grid) : settings.only;
	const std::vector<std::string>& asked = settings.methods;
	std::erase_if(grid, [&](const Candidate& one)
				  { return !asked.empty() && std::find(asked.begin(), asked.end(), one.method()) == asked.end(); });
	return grid;
}

// Rays are slow and their times steady.
constexpr int kRayRepetitions = 2;

// A result that cannot be kept ends the run, not just the level.
struct CacheFailure : Error
{
	using Error::Error;
};

template <class Write> void keepOrFail(const Write& write)
{
	try
	{
		write();
	}
	catch (const Error& problem)
	{
		throw CacheFailure(problem.code(), problem.what());
	}
}

class PointMeasurer
{
public:
	// Starts what draws, once for all candidates. Throws Error: unsupported without a renderer; file, of the cache.
	PointMeasurer(const ErrorReportSettings& settings, const RunSettings& run, ErrorReportCounts& counts)
		: m_measure(settings.measure), m_shifts(settings.shifts), m_counts(counts),
		  m_store(run.units != nullptr ? &run.units->store() : nullptr)
	{
		const RendererFacts renderer = rendererOf(m_measure);
		m_context = {renderer.name, renderer.software, run.threads, settings.version};
		if (m_measure.device == Device::gl)
		{
			m_measure.session = std::make_shared<GlSession>(m_measure.gl_device);
		}
	}

	// One context for the whole report.
	const ErrorContext& context() const
	{
		return m_context;
	}

	// `most`: repetitions. Throws CacheFailure, TooSlow, or what measuring throws.
	ErrorPoint point(ViewBench& on, const Candidate& candidate, int most = std::numeric_limits<int>::max())
	{
		MeasureSettings how = m_measure;
		how.repetitions = std::min(how.repetitions, candidate.kind == CandidateKind::rays ? kRayRepetitions : most);
		const std::string hash = hashOf(on, candidate, how, "");
		ErrorPoint point{
			candidate.name(), candidate.method(), candidate.origin, candidate.count, candidate.resolution(), {}, {}, false, {}};
		point.measured = known(hash, [&] { return on.measure(candidate, how); });
		return point;
	}

	// Returns whether its flicker is measured: not for rays, nor for what would take too long.
	bool mayFlicker(const ErrorPoint& point) const
	{
		const double slowest_s = m_measure.slowest_s; // of all that it would draw
		const bool slow = slowest_s > 0.0 && point.measured.total.median_s * m_shifts > slowest_s;
		return m_shifts >= 2 && !slow && point.origin != Origin::rays;
	}

	double flicker(ViewBench& on, const Candidate& candidate)
	{
		const std::string hash = hashOf(on, candidate, m_measure, "flicker " + std::to_string(m_shifts));
		return known(hash, [&] { return on.flicker(candidate, m_measure, m_shifts); });
	}

	// Returns a view's reference from the store, or traces it.
	Reference reference(const std::string& hash, const std::function<Reference()>& trace)
	{
		if (m_store == nullptr)
		{
			return trace();
		}
		Reference found;
		const auto compute = [&]
		{
			found = trace();
			return true;
		};
		keepOrFail([&] { m_store->once("reference " + hash, compute, [&](Archive& archive) { archive(found); }); });
		return found;
	}

	ViewCost costOf(const ViewBench& on, const LevelBench& bench) const
	{
		return {bench.hash, on.gbuffer().depth.size(), bench.level.triangles.size(), m_measure.repetitions};
	}

private:
	std::string hashOf(ViewBench& on, const Candidate& candidate, const MeasureSettings& how, const std::string& what) const
	{
		ContentHash hash;
		hash.add(on.contentHash(candidate, how, m_context.version));
		hash.add(candidate.kind == CandidateKind::rays ? std::string("CPU") : m_context.renderer);
		hash.add(what);
		return hash.text();
	}

	// The value that the store has, or what `measure` finds, which is kept.
	template <class Measure, class Value = std::invoke_result_t<Measure>>
	Value known(const std::string& hash, const Measure& measure)
	{
		if (const std::optional<Value> found = m_store != nullptr ? m_store->get<Value>(hash) : std::nullopt)
		{
			m_counts.cached += 1;
			return *found;
		}
		m_counts.measured += 1;
		const Value made = measure();
		if (m_store != nullptr)
		{
			keepOrFail([&] { m_store->put(hash, made); });
		}
		return made;
	}

	MeasureSettings m_measure;
	int m_shifts;
	ErrorReportCounts& m_counts;
	Store* m_store; // null: nothing is kept
	ErrorContext m_context;
};

// A view → about what one layer of depth can know of it.

using Draw = std::function<std::vector<float>(const Candidate&)>;

// With the strength and the power that suit this view.
ScreenLimit limitWith(const ViewBench& on, const SliceSettings& slices, std::span<const char> counted, const Draw& draw)
{
	Candidate candidate;
	candidate.shade.method = ShadeMethod::slices;
	candidate.shade.slices = slices;
	candidate.shade.filter = ShadeFilter::none;
	std::vector<float> visibility = draw(candidate);
	const ShapeView view = shapeView(0, visibility, on.reference().visibility, counted);
	const CurveShape shape = fitShape({&view, 1});
	for (float& v : visibility)
	{
		v = static_cast<float>(std::pow(std::max(0.0, 1.0 - shape.strength * (1.0 - static_cast<double>(v))), shape.power));
	}
	return {slices.thickness, shape.strength, shape.power, on.errorsOf(visibility)};
}

ScreenLimit screenLimitOf(const ViewBench& on, const Draw& draw, const RunSettings& run)
{
	const std::vector<char> counted = surfacesOf(on.gbuffer());
	std::optional<ScreenLimit> best;
	constexpr std::array<double, 5> kThicknesses{0.25, 0.5, 0.75, 1.0, 2.0};
	constexpr std::array<int, 2> kStepCounts{8, 32}; // more find what is thin, fewer let more light through
	ProgressCounter progress(run.progress, "limit", kThicknesses.size() * kStepCounts.size());
	for (const int steps : kStepCounts)
	{
		for (const double thickness : kThicknesses)
		{
			const ScreenLimit found = limitWith(on, {16, steps, thickness}, counted, draw);
			if (!best || found.errors.rmse < best->errors.rmse)
			{
				best = found;
			}
			progress.finishOne();
		}
	}
	return *best;
}

// A candidate that was tried: its point, or why there is none; neither in a share that does not have it.
struct TriedPoint
{
	std::optional<ErrorPoint> point;
	std::string failure;
	double expected_s = 0.0; // above 0: it was stopped because a picture would take so long
};

class Measurer
{
public:
	Measurer(const ErrorReportSettings& settings, const RunSettings& run, ErrorReportCounts& counts)
		: m_settings(settings), m_run(withoutUnits(run)), m_split(run), m_counts(counts), m_points(settings, run, counts),
		  m_grid(gridOf(settings)), m_samples(std::make_shared<SampleStore>())
	{
	}

	ErrorReport report()
	{
		ErrorReport report;
		report.context = m_points.context();
		report.command = errorReportCommand(m_settings);
		report.rays = m_settings.rays;
		report.repetitions = m_settings.measure.repetitions;
		std::map<std::string, int> named;
		std::optional<ProgressCounter> progress(std::in_place, m_run.progress, "levels", countIfSeveral(m_settings.levels.size()));
		for (const std::string& path : m_settings.levels)
		{
			ErrorLevel level = measureLevel(path);
			progress->finishOne();
			const int number = ++named[level.name];
			level.name += number > 1 ? " (" + std::to_string(number) + ")" : "";
			report.levels.push_back(std::move(level));
		}
		progress.reset();
		return report;
	}

private:
	// Errors of the cache (a full disk) end the run; those of a level are its own.
	ErrorLevel measureLevel(const std::string& path)
	{
		ErrorLevel level;
		level.name = path.starts_with("builtin:") ? path : std::filesystem::path(path).filename().string();
		try
		{
			LoadedLevel loaded = loadLevel(path, m_settings.load, m_run);
			noteFiles(loaded.level.files);
			keepOrFail([&] { addInputs(loaded.level.files, m_split); });
			level.name = loaded.level.name;
			LevelBench bench(std::move(loaded.level), m_settings.radius_m, m_run, m_samples, kFewTriangles);
			level.triangles = bench.level.triangles.size();
			level.radius_m = bench.radius_m;
			for (const LevelCamera& camera : camerasOf(bench))
			{
				measureView(bench, camera, level);
			}
		}
		catch (const CacheFailure&)
		{
			throw;
		}
		catch (const std::exception& problem)
		{
			if (std::error_code ignored; std::filesystem::is_regular_file(path, ignored))
			{
				noteFiles({path});
			}
			level.failure += (level.failure.empty() ? "" : "; ") + std::string(problem.what());
			const std::size_t at = level.failure.find(path);
			if (at != std::string::npos)
			{
				level.failure.replace(at, path.size(), std::filesystem::path(path).filename().string()); // no folders on a page
			}
		}
		return level;
	}

	void noteFiles(const std::vector<std::string>& files)
	{
		for (const std::string& file : files)
		{
			addOnce(m_counts.files, file);
		}
	}

	std::vector<LevelCamera> camerasOf(const LevelBench& bench) const
	{
		CamerasOfLevel found = nook::camerasOf(bench.tracer, m_settings.camera, m_settings.automatic, m_run);
		if (!found.chosen)
		{
			const LevelCamera& camera = found.cameras.front();
			checkOutside(bench.tracer, glm::dvec3(camera.world_from_camera[3]), camera.name);
		}
		return std::move(found.cameras);
	}

	void measureView(LevelBench& bench, const LevelCamera& camera, ErrorLevel& level)
	{
		ErrorView view;
		view.camera = camera.name;
		view.width_px = m_settings.width_px;
		view.height_px = m_settings.height_px;
		const ViewSettings how{m_settings.width_px, m_settings.height_px, m_settings.rays, 1};
		const std::string hash = viewHash(bench, camera, how, m_settings.version);
		ViewBench on(bench, camera, how, m_run,
					 m_points.reference(hash, [&] { return ViewBench(bench, camera, how, m_run).reference(); }));
		if (!isShare(m_split))
		{
			view.surface_share = on.surfaceShare();
			view.reference_error = on.reference().error;
			view.picture = bytesOf(on.reference().visibility);
			view.mean_visibility = meanOver(on);
		}

		ProgressCounter progress(m_run.progress, level.name + " " + camera.name, m_grid.size());
		std::vector<std::string> failed;
		const std::vector<Candidate> drawn = addPoints(on, bench, view, progress, failed);
		refuseIf(drawn.empty() && !isShare(m_split), failed.empty() ? "every candidate was stopped" : failed.front(),
				 ExitCode::runtime);
		setFront(view); // in a part: of its own points, among which is all that is on the front of all
		shareFlicker(on, bench, drawn, view);
		addLimit(on, view);
		if (isShare(m_split)) // what follows needs all points
		{
			level.views.push_back(std::move(view));
			return;
		}
		show(on, drawn, view);
		if (!failed.empty())
		{
			level.failure += (level.failure.empty() ? "" : "; ") + camera.name + ": " + failed.front();
			level.failure += failed.size() > 1 ? ", and " + std::to_string(failed.size() - 1) + " more" : "";
		}
		for (ErrorPoint& one : view.points)
		{
			one.measured.visibility = std::vector<float>(); // frees its memory, too
		}
		level.views.push_back(std::move(view));
	}

	// Adds a point for each candidate that could be measured, and returns these candidates. One that fails (no memory for a level's
	// volumes, say) takes nothing from the others.
	std::vector<Candidate> addPoints(ViewBench& on, const LevelBench& bench, ErrorView& view, ProgressCounter& progress,
									 std::vector<std::string>& failed)
	{
		std::vector<TriedPoint> tried(m_grid.size());
		const auto attempt = [&](std::size_t i)
		{
			try
			{
				tried[i].point = m_points.point(on, m_grid[i]);
			}
			catch (const CacheFailure&)
			{
				throw;
			}
			catch (const TooSlow& problem)
			{
				tried[i].failure = problem.what();
				tried[i].expected_s = problem.expected_s;
			}
			catch (const std::exception& problem)
			{
				tried[i].failure = problem.what();
			}
			progress.finishOne();
		};
		const std::vector<double> costs = candidateSeconds(m_grid, m_points.costOf(on, bench), m_made);
		keepOrFail(
			[&]
			{
				runStage({"points on " + m_points.context().renderer, m_grid.size(), [&](std::size_t i) { return costs[i]; },
						  attempt,
						  [&](std::size_t i, Archive& archive)
						  {
							  archive(tried[i].failure, tried[i].expected_s);
							  if (archive.reads() && tried[i].failure.empty())
							  {
								  tried[i].point = m_points.point(on, m_grid[i]); // the store has it
							  }
						  },
						  [&](std::size_t i)
						  {
							  return sharedBy(m_grid[i], bench.hash);
						  }},
						 {1, {}, m_split.units});
			});
		std::vector<Candidate> drawn;
		for (std::size_t i = 0; i < tried.size(); ++i)
		{
			if (tried[i].point)
			{
				view.points.push_back(std::move(*tried[i].point));
				drawn.push_back(m_grid[i]);
			}
			else if (tried[i].expected_s > 0.0)
			{
				view.stopped.push_back({m_grid[i].name(), m_grid[i].method(), tried[i].expected_s});
			}
			else if (!tried[i].failure.empty())
			{
				failed.push_back("'" + m_grid[i].name() + "': " + tried[i].failure);
			}
		}
		return drawn;
	}

	static double meanOver(const ViewBench& on)
	{
		const std::vector<float>& depth = on.gbuffer().depth;
		const std::vector<std::size_t> pixels = indicesWhere(depth.size(), [&](std::size_t i) { return std::isfinite(depth[i]); });
		const double sum = sumOver(pixels, [&](std::size_t i) { return static_cast<double>(on.reference().visibility[i]); });
		return pixels.empty() ? 1.0 : sum / static_cast<double>(pixels.size());
	}

	// Where the work is shared out, a part moves what may be chosen: the choice is a matter of all points, but what is on the front
	// of all, or the best of its method, is so among a part's own. `candidates`: of the view's points.
	void shareFlicker(ViewBench& on, const LevelBench& bench, const std::vector<Candidate>& candidates, ErrorView& view)
	{
		if (m_split.units == nullptr || m_settings.shifts < 2)
		{
			return;
		}
		std::map<std::string, std::size_t> places;
		for (std::size_t i = 0; i < view.points.size(); ++i)
		{
			places.emplace(view.points[i].name, i);
		}
		const std::set<std::size_t> likely = likelyPoints(view);
		const auto placeOf = [&](std::size_t unit) // none: in this grid, but not measured
		{
			const auto found = places.find(m_grid[unit].name());
			return found != places.end() ? std::optional(found->second) : std::nullopt;
		};
		const auto move = [&](std::size_t unit)
		{
			const std::optional<std::size_t> i = placeOf(unit);
			if (i && likely.contains(*i) && m_points.mayFlicker(view.points[*i]))
			{
				inPart([&] { view.points[*i].flicker = m_points.flicker(on, candidates[*i]); });
			}
		};
		const auto pass = [&](std::size_t unit, Archive& archive)
		{
			std::optional<double> none;
			const std::optional<std::size_t> i = placeOf(unit);
			archive(i ? view.points[*i].flicker : none);
		};
		// In the costs of the points, whose parts have what is drawn.
		const WorkStage stage{"moved",
							  m_grid.size(),
							  [](std::size_t) { return 0.0; },
							  move,
							  pass,
							  [&](std::size_t unit)
							  {
								  return sharedBy(m_grid[unit], bench.hash);
							  }};
		keepOrFail([&] { runStage(stage, {1, m_run.progress, m_split.units}); });
	}

	// The merge retries whatever a part failed to do, and reports the error.
	template <class Work> void inPart(const Work& work) const
	{
		try
		{
			work();
		}
		catch (const CacheFailure&)
		{
			throw;
		}
		catch (const std::exception&)
		{
			if (!isShare(m_split))
			{
				throw;
			}
		}
	}

	void addLimit(ViewBench& on, ErrorView& view)
	{
		const auto draw = [&](const Candidate& candidate)
		{
			return m_points.point(on, candidate, 0).measured.visibility;
		};
		const auto find = [&](std::size_t)
		{
			inPart([&] { view.limit = screenLimitOf(on, draw, m_run); });
		};
		if (m_split.units != nullptr)
		{
			keepOrFail(
				[&]
				{
					runStage({"limits", 1, [&](std::size_t) { return kLimit_s * static_cast<double>(on.gbuffer().depth.size()); },
							  find,
							  [&](std::size_t, Archive& archive)
							  {
								  archive(view.limit);
							  }},
							 {1, {}, m_split.units});
				});
		}
		if (!view.limit && !isShare(m_split))
		{
			find(0);
		}
	}

	// Pictures: the front's, evenly spaced, and the best recipe of each method; stability of these and of the front. `candidates`:
	// of the points.
	void show(ViewBench& on, const std::vector<Candidate>& candidates, ErrorView& view)
	{
		const std::set<std::size_t> chosen = chosenPoints(view, static_cast<std::size_t>(m_settings.pictures));
		ProgressCounter progress(m_run.progress, "flicker", m_settings.shifts >= 2 ? view.points.size() : 0);
		for (std::size_t i = 0; i < view.points.size(); ++i)
		{
			ErrorPoint& point = view.points[i];
			if (chosen.contains(i))
			{
				point.picture = bytesOf(point.measured.visibility);
			}
			if (!m_points.mayFlicker(point) || (!chosen.contains(i) && !point.front))
			{
				point.flicker = std::nullopt; // of a part, and not chosen
			}
			else if (!point.flicker)
			{
				point.flicker = m_points.flicker(on, candidates[i]);
			}
			progress.finishOne();
		}
	}

	const ErrorReportSettings& m_settings;
	RunSettings m_run;          // of what every part does
	const RunSettings& m_split; // of what is shared out
	ErrorReportCounts& m_counts;
	PointMeasurer m_points;
	std::vector<Candidate> m_grid;
	std::shared_ptr<SampleStore> m_samples;
	std::set<std::string> m_made; // what costs say is made once
};

} // namespace

ErrorReport measureErrors(const ErrorReportSettings& settings, const RunSettings& run, ErrorReportCounts* counts)
{
	ErrorReportCounts own;
	return Measurer(settings, run, counts != nullptr ? *counts : own).report();
}

} // namespace nook
