// SPDX-License-Identifier: GPL-3.0-or-later
// Progress of a long computation, reported to a callback.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace nook
{

// Called with a stage's name and its finished share: 0 when the stage begins, 1 when it ends, increasing between. Other stages may
// begin and end inside it. May be called from several threads, one at a time; throws to cancel, but not at 1. May be empty.
using Progress = std::function<void(std::string_view stage, double share)>;

class WorkUnits;

// Settings of a run; they never change its result.
struct RunSettings
{
	int threads = 1; // ≥ 1
	Progress progress;
	WorkUnits* units = nullptr; // the share of the work done here; null: all of it
};

// Without progress reports, for steps so short, or timed, that reporting would distort them.
inline RunSettings silent(const RunSettings& run)
{
	return {run.threads, {}, nullptr};
}

// Without progress reports, but still divided into parts.
inline RunSettings withoutProgress(const RunSettings& run)
{
	return {run.threads, {}, run.units};
}

// For work that every part needs and repeats.
inline RunSettings withoutUnits(const RunSettings& run)
{
	return {run.threads, run.progress, nullptr};
}

// Item count for a stage that reports nothing for a single item, since its sub-stages report more.
inline std::size_t countIfSeveral(std::size_t items)
{
	return items > 1 ? items : 0;
}

// Progress of one stage: counts finished items from any thread and reports each thousandth. Without items the stage counts as one.
// An error that ends the stage is reported elsewhere.
class ProgressCounter
{
public:
	// `count` 0: nothing is reported. `progress` must outlive this object.
	ProgressCounter(const Progress& progress, std::string stage, std::size_t count = 1)
		: m_progress(progress), m_stage(std::move(stage)), m_count(count), m_errors(std::uncaught_exceptions())
	{
		if (m_progress && m_count > 0)
		{
			m_progress(m_stage, 0.0);
		}
	}
	ProgressCounter& operator=(ProgressCounter&&) = delete;

	// There may have been fewer items than expected.
	~ProgressCounter()
	{
		if (m_progress && m_told < m_count && std::uncaught_exceptions() == m_errors)
		{
			m_progress(m_stage, 1.0);
		}
	}

	void finishOne()
	{
		finish(1);
	}

	void finish(std::size_t items)
	{
		if (!m_progress || m_count == 0)
		{
			return;
		}
		const uint64_t before = m_done.fetch_add(items, std::memory_order_relaxed);
		if (before * kSteps / m_count != (before + items) * kSteps / m_count)
		{
			tell();
		}
	}

private:
	static constexpr uint64_t kSteps = 1000;

	void tell()
	{
		const std::lock_guard lock(m_mutex);
		const uint64_t done = m_done.load(std::memory_order_relaxed);
		if (done > m_told && done <= m_count)
		{
			m_told = done;
			m_progress(m_stage, static_cast<double>(done) / static_cast<double>(m_count));
		}
	}

	const Progress& m_progress;
	std::string m_stage;
	uint64_t m_count;
	int m_errors;
	std::atomic<uint64_t> m_done{0};
	uint64_t m_told = 0;
	std::mutex m_mutex;
};

// Estimates the remaining time of a stage: extrapolates the speed over the last half to three quarters of the elapsed time. Tiles
// and search rounds vary in cost: the whole past would react too late, the last moment alone would be jumpy.
class RemainingTime
{
public:
	// Seconds since the stage began and its finished share, 0 to 1. Neither may decrease.
	void add(double elapsed_s, double share)
	{
		if (!(share > m_last.share))
		{
			return;
		}
		m_last = {elapsed_s, share};
		if (elapsed_s > 2.0 * m_newer.elapsed_s)
		{
			m_older = m_newer;
			m_newer = m_last;
		}
		const double rate = (share - m_older.share) / (elapsed_s - m_older.elapsed_s);
		m_left_s = (1.0 - share) / rate;
	}

	// Returns nothing in the first second, before any progress, or once the last estimate has been exceeded.
	std::optional<double> at(double elapsed_s) const
	{
		const double left_s = m_left_s - (elapsed_s - m_last.elapsed_s);
		if (m_last.share == 1.0)
		{
			return 0.0;
		}
		return elapsed_s >= kSoonest_s && m_last.share > 0.0 && left_s > 0.0 ? std::optional(left_s) : std::nullopt;
	}

private:
	static constexpr double kSoonest_s = 1.0;

	struct Mark
	{
		double elapsed_s = 0.0;
		double share = 0.0;
	};
	Mark m_older;
	Mark m_newer;
	Mark m_last;
	double m_left_s = 0.0;
};

} // namespace nook
