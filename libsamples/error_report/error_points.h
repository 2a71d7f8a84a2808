// SPDX-License-Identifier: GPL-3.0-or-later
// A report's candidates on a view → time, error, flicker; what the cache has is not measured again. For error_measure.cpp.
#pragma once

#include "bench/measurement_cache.h"
#include "core/error.h"
#include "error_report/error_costs.h"
#include "error_report/error_report.h"

#include <limits>
#include <optional>
#include <string>

namespace nook
{

// The cache's troubles are the run's, not the level's.
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
	PointMeasurer(const ErrorReportSettings& settings, int threads, ErrorReportCounts& counts);

	// Of the whole report.
	const ErrorContext& context() const
	{
		return m_context;
	}

	// `most`: repetitions. Throws CacheFailure, TooSlow, or what measuring throws.
	ErrorPoint point(ViewBench& on, const Candidate& candidate, int most = std::numeric_limits<int>::max());

	// Whether it is moved: rays are not, nor what would take too long.
	bool mayFlicker(const ErrorPoint& point) const;
	double flicker(ViewBench& on, const Candidate& candidate);

	// Of a view: what its rays found, from the cache.
	std::optional<Reference> known(const std::string& hash, std::size_t pixels) const
	{
		return m_cache.reference(hash, pixels);
	}
	void keep(const std::string& hash, const Reference& reference) const
	{
		keepOrFail([&] { m_cache.keep(hash, reference); });
	}

	const MeasureSettings& measure() const // with the session of what draws
	{
		return m_measure;
	}
	ViewCost costOf(const ViewBench& on, const LevelBench& bench) const;

private:
	std::string hashOf(ViewBench& on, const Candidate& candidate, const MeasureSettings& how, const std::string& what) const;

	MeasureSettings m_measure;
	int m_shifts;
	ErrorReportCounts& m_counts;
	MeasurementCache m_cache;
	ErrorContext m_context;
};

} // namespace nook
