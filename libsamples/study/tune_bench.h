// SPDX-License-Identifier: GPL-3.0-or-later
// A search's candidates on the views of its levels, measured at the sizes that it asks for. For tune.cpp.
#pragma once

#include "core/store.h"
#include "study/measured_time.h"
#include "study/tune.h"

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace nook
{

class Clock
{
public:
	double seconds() const
	{
		return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
	}

private:
	std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

// The levels' views at every size that the search asks for, and what measuring costs.
class TuneBench
{
public:
	TuneBench(TuneReport& report, const RunSettings& run);

	// One view of each level after another, so that few views are of many levels.
	void setViews(const std::vector<std::vector<LevelCamera>>& cameras);

	std::size_t views() const
	{
		return m_views.size();
	}

	Trial measure(std::size_t index, const Fidelity& fidelity);

	// Strength and power of a candidate by a recipe, fitted to all views; none where they bring no less error.
	std::optional<Candidate> withShape(std::size_t index);

private:
	// One camera of one level.
	struct View
	{
		std::size_t level = 0;
		LevelCamera camera;
	};

	void refuseLarge(const Measurement& found) const;
	std::string hashOf(const Candidate& candidate, ViewBench& view, const MeasureSettings& how) const;

	// False where a level failed, and its views are gone.
	bool viewsAreMade(ProgressCounter& progress);

	ViewBench& benchAt(std::size_t view, double scale);

	// Makes what a candidate's first drawing would: samples or volumes, and what the driver keeps of its shaders.
	void prepare(std::size_t index, std::size_t level);

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

} // namespace nook
