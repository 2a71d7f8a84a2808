// SPDX-License-Identifier: GPL-3.0-or-later
// How far a long computation is, told to whoever wants to show it.
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

// Called with a stage's name and a share of it: 0 where the stage begins, 1 where it ends, and growing in between. Other stages may
// begin and end meanwhile, parts of this one. May be called from several threads, one at a time; throws nothing. May be empty.
using Progress = std::function<void(std::string_view stage, double share)>;

class WorkUnits;

// How a computation runs; never changes its result.
struct RunSettings
{
	int threads = 1; // ≥ 1
	Progress progress;
	WorkUnits* units = nullptr; // which part of the work is done here, or what parts have done; null: all of it is done here
};

// The same without a word: for what is so short, or timed, that telling of it would be seen in its time.
inline RunSettings silent(const RunSettings& run)
{
	return {run.threads, {}, nullptr};
}

// The same, but parts share it out.
inline RunSettings silentStage(const RunSettings& run)
{
	return {run.threads, {}, run.units};
}

// The same for what every part needs and does by itself.
inline RunSettings undivided(const RunSettings& run)
{
	return {run.threads, run.progress, nullptr};
}

// Items of a stage that says nothing where there is one: then its parts say more.
inline std::size_t severalOf(std::size_t items)
{
	return items > 1 ? items : 0;
}

// A stage, from its making to its end: counts finished items, from any thread, and tells of each thousandth of them. One that
// nothing counts has one item. An error that ends it is told by others.
class ProgressCounter
{
public:
	// count 0: nothing to do, or nothing that is worth a word of its own: nothing is told. `progress` must outlive it.
	ProgressCounter(const Progress& progress, std::string stage, std::size_t count = 1)
		: m_progress(progress), m_stage(std::move(stage)), m_count(count), m_errors(std::uncaught_exceptions())
	{
		if (m_progress && m_count > 0)
		{
			m_progress(m_stage, 0.0);
		}
	}
	ProgressCounter(const ProgressCounter&) = delete;
	ProgressCounter& operator=(const ProgressCounter&) = delete;

	// Fewer items than were expected may have been all.
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
