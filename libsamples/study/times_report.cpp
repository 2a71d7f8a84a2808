// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/times_report.h"

#include "core/error.h"
#include "core/lists.h"
#include "scene/camera_choice.h"
#include "scene/load.h"
#include "shade/gl_context.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>

namespace nook
{
namespace
{

// Throws Error (usage) for words with which no name begins.
std::vector<Candidate> screenCandidates(const TimesSettings& settings)
{
	std::vector<Candidate> grid = candidateGrid(settings.grid);
	std::erase_if(grid, [](const Candidate& one) { return one.kind != CandidateKind::screen; });
	std::vector<bool> chosen(grid.size(), settings.only.empty());
	for (const std::string& words : settings.only)
	{
		bool found = false;
		for (std::size_t i = 0; i < grid.size(); ++i)
		{
			const bool begins = (grid[i].name() + " ").starts_with(words + " ");
			chosen[i] = chosen[i] || begins;
			found = found || begins;
		}
		refuseIf(!found, "--only: found '" + words + "', expected the beginning of a candidate's name, such as '" +
							 grid.front().method() + "' or '" + grid.front().name() + "'");
	}
	return mapped(indicesWhere(grid.size(), [&](std::size_t i) { return chosen[i]; }), [&](std::size_t i) { return grid[i]; });
}

void compareWithCpu(ViewBench& view, const MeasureSettings& how, TimedPicture& picture)
{
	MeasureSettings twin = how;
	twin.device = Device::cpu;
	const std::vector<float> expected = view.draw(picture.candidate, twin);
	picture.most = 0.0;
	for (std::size_t i = 0; i < expected.size(); ++i)
	{
		const double difference = std::fabs(static_cast<double>(picture.measured.visibility[i]) - static_cast<double>(expected[i]));
		picture.most = std::isnan(difference) ? 1.0 : std::max(*picture.most, difference);
		picture.unlike += difference <= 1.0 / 255.0 ? 0.0 : 1.0 / static_cast<double>(expected.size());
	}
}

void measurePicture(ViewBench& view, const MeasureSettings& how, bool check, TimedPicture& picture)
{
	try
	{
		picture.measured = view.measure(picture.candidate, how);
		if (check)
		{
			compareWithCpu(view, how, picture);
		}
		picture.measured.visibility = std::vector<float>(); // frees its memory
	}
	catch (const std::exception& problem) // takes nothing from the others
	{
		picture.failure = problem.what();
	}
}

} // namespace

TimesReport measureTimes(const TimesSettings& settings, const RunSettings& run)
{
	const auto start = std::chrono::steady_clock::now();
	TimesReport report;
	report.renderer = rendererOf(settings.measure);
	MeasureSettings how = settings.measure;
	how.errors = false;
	how.session = std::make_shared<GlSession>(how.gl_device);
	const std::vector<Candidate> candidates = screenCandidates(settings);
	const auto samples = std::make_shared<SampleStore>();
	std::deque<LevelBench> levels;
	for (const std::string& path : settings.levels)
	{
		LoadedLevel loaded = loadLevel(path, {}, run);
		append(report.files, loaded.level.files);
		levels.emplace_back(std::move(loaded.level), 0.0, run, samples);
	}
	const std::size_t per_view = settings.radii_px.size() * candidates.size();
	ProgressCounter progress(run.progress, "pictures", settings.sizes.size() * levels.size() * per_view);
	for (const glm::ivec2& size : settings.sizes)
	{
		for (LevelBench& level : levels)
		{
			const LevelCamera camera = camerasOf(level.tracer, "", 0, run).cameras.front();
			ViewBench view(level, camera, {size.x, size.y, 1}, silent(run));
			for (std::size_t i = 0; i < per_view; ++i)
			{
				progress.finishOne();
				if (settings.seconds > 0.0 && secondsSince(start) > settings.seconds)
				{
					report.left_out += 1;
					continue;
				}
				TimedPicture picture;
				picture.level = level.level.name;
				picture.size = size;
				picture.radius_px = settings.radii_px[i / candidates.size()];
				picture.candidate = candidates[i % candidates.size()];
				picture.candidate.shade.min_radius_px = picture.radius_px;
				picture.candidate.shade.max_radius_px = picture.radius_px;
				measurePicture(view, how, settings.check && size == settings.sizes.front(), picture);
				report.pictures.push_back(std::move(picture));
			}
		}
	}
	return report;
}

} // namespace nook
