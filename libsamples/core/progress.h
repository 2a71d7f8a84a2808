// SPDX-License-Identifier: GPL-3.0-or-later
// Progress of a long computation, reported to a callback.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
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

} // namespace nook
