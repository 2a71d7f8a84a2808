// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/tune_bench.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/work_units.h"
#include "shade/gl_context.h"
#include "study/measurement_json.h"
#include "study/shape_fit.h"

#include <algorithm>
#include <cmath>
#include <exception>

namespace nook
{
namespace
{

// Volumes that take so long a picture, and so many budgets, are not drawn.
constexpr double kSlowest_s = 4.0;
constexpr double kFarOver = 10.0;

} // namespace

TuneBench::TuneBench(TuneReport& report, const RunSettings& run)
	: m_report(report), m_run(run), m_busy(availableThreads()), m_store(run.units != nullptr ? &run.units->store() : nullptr)
{
	m_how.gl_device = m_report.settings.gl_device;
	m_how.session = std::make_shared<GlSession>(m_how.gl_device);
	m_how.errors = false;
	m_how.slowest_s = report.settings.goal.budget_s ? std::max(kSlowest_s, kFarOver * *report.settings.goal.budget_s) : kSlowest_s;
}

void TuneBench::setViews(const std::vector<std::vector<LevelCamera>>& cameras)
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

Trial TuneBench::measure(std::size_t index, const Fidelity& fidelity)
{
	const Candidate& candidate = m_report.candidates[index];
	m_busy.look();
	m_report.busy = m_busy.share();
	MeasureSettings how = m_how;
	how.repetitions = fidelity.repetitions;
	Trial trial;
	// Not where the grid draws once as well: what it needs is to be told.
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
		const std::string name = hashOf(candidate, view, how);
		std::optional<Measurement> found = m_store != nullptr ? m_store->get<Measurement>(name) : std::nullopt;
		const bool known = found.has_value();
		(known ? m_report.cached : m_report.measured) += 1;
		if (!known)
		{
			prepare(index, m_views[i].level);
		}
		const Clock clock;
		if (!known)
		{
			found = view.measure(candidate, how);
		}
		refuseLarge(*found);
		const double error = view.errorBy(m_report.settings.measure, found->visibility);
		trial.cost_s += clock.seconds();
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

std::optional<Candidate> TuneBench::withShape(std::size_t index)
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

void TuneBench::refuseLarge(const Measurement& found) const
{
	const uint64_t most = m_report.settings.max_bytes;
	if (most > 0 && found.bytes > most)
	{
		throw Error(ExitCode::runtime, "bytes: found " + bytesText(found.bytes) + ", expected at most " + bytesText(most));
	}
}

std::string TuneBench::hashOf(const Candidate& candidate, ViewBench& view, const MeasureSettings& how) const
{
	ContentHash hash;
	hash.add(std::string("tune"));
	hash.add(m_report.renderer);
	hash.add(view.contentHash(candidate, how, m_report.settings.version));
	return hash.text();
}

bool TuneBench::viewsAreMade(ProgressCounter& progress)
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

ViewBench& TuneBench::benchAt(std::size_t view, double scale)
{
	const TuneSettings& settings = m_report.settings;
	const std::pair key(view, scale);
	const auto found = m_benches.find(key);
	if (found != m_benches.end())
	{
		return found->second;
	}
	const Clock clock;
	const auto side = [scale](int pixels)
	{
		return std::max(16, static_cast<int>(std::floor(scale * pixels + 0.5)));
	};
	ViewSettings how;
	how.width_px = side(settings.width_px);
	how.height_px = side(settings.height_px);
	how.reference_rays = settings.reference_rays;
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
	(scale == 1.0 ? m_report.prepared_s : m_report.coarse_s) += clock.seconds();
	return made;
}

void TuneBench::prepare(std::size_t index, std::size_t level)
{
	const Candidate& candidate = m_report.candidates[index];
	const double coarsest = m_report.rungs.rungs.front().scale;
	ViewBench& first = benchAt(0, coarsest);
	const Clock clock;
	LevelBench& bench = *m_report.levels[level].bench;
	if (candidate.kind == CandidateKind::asset)
	{
		bench.asset(candidate);
	}
	else
	{
		bench.samples().samplesOf(candidate, shadeSettingsOf(candidate, bench.radiusM()), m_run);
	}
	if (m_drawn.insert(index).second)
	{
		first.draw(candidate, m_how);
	}
	m_report.prepared_s += clock.seconds();
}

} // namespace nook
