// SPDX-License-Identifier: GPL-3.0-or-later
// A report's candidates on a view → time, error, flicker, and which of them are shown; what the cache has is not measured again.
// For error_measure.cpp.
#pragma once

#include "core/error.h"
#include "core/work_units.h"
#include "study/candidates.h"
#include "study/error_report.h"
#include "study/measure_view.h"

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace nook
{

// Which candidates share what takes long to make, and about how long each takes: how a report is shared out.

// Candidates of one name draw the same samples, on whatever level, or the same volumes or bake of this level. `level`: any name
// that is its own.
std::string sharedBy(const Candidate& candidate, const std::string& level);

// The facts of a view that its costs depend on.
struct ViewCost
{
	std::string level; // a name that is its own
	std::size_t pixels = 0;
	std::size_t triangles = 0; // of its level
	int repetitions = 0;
};

// Estimates of the seconds that each candidate takes on one thread. The first candidate of each name bears what is made once.
// `made`: the names of views before; grows.
std::vector<double> candidateSeconds(std::span<const Candidate> candidates, const ViewCost& view, std::set<std::string>& made);

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
	PointMeasurer(const ErrorReportSettings& settings, const RunSettings& run, ErrorReportCounts& counts);

	// One context for the whole report.
	const ErrorContext& context() const
	{
		return m_context;
	}

	// `most`: repetitions. Throws CacheFailure, TooSlow, or what measuring throws.
	ErrorPoint point(ViewBench& on, const Candidate& candidate, int most = std::numeric_limits<int>::max());

	// Returns whether its flicker is measured: not for rays, nor for what would take too long.
	bool mayFlicker(const ErrorPoint& point) const;
	double flicker(ViewBench& on, const Candidate& candidate);

	// Returns a view's reference from the store, or traces it.
	Reference reference(const std::string& hash, const std::function<Reference()>& trace);

	ViewCost costOf(const ViewBench& on, const LevelBench& bench) const;

private:
	std::string hashOf(ViewBench& on, const Candidate& candidate, const MeasureSettings& how, const std::string& what) const;

	// The value that the store has, or what `measure` finds, which is kept.
	template <class Measure> auto known(const std::string& hash, const Measure& measure)
	{
		using Value = decltype(measure());
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

// Returns at most `count` points: the front's, evenly spaced, and the best recipe of each method.
std::set<std::size_t> chosenPoints(const ErrorView& view, std::size_t count);

// Returns all that chosenPoints() chooses from: the front, and the best recipe of each method. With some of a view's points and
// their own front, the result contains whatever of them is chosen from all points.
std::set<std::size_t> likelyPoints(const ErrorView& view);

// A view → about what one layer of depth can know of it.

// `draw`: returns a candidate's visibility on this view.
ScreenLimit screenLimitOf(const ViewBench& on, const std::function<std::vector<float>(const Candidate&)>& draw,
						  const RunSettings& run);

void visit(Archive& archive, ScreenLimit& limit);

} // namespace nook
