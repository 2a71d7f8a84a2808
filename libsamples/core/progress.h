// SPDX-License-Identifier: GPL-3.0-or-later
// How far a long computation is, told to whoever wants to show it.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

namespace nook
{

// Called with a stage's name and a share from 0 to 1; may be called from several threads, one at a time. May be empty.
using Progress = std::function<void(std::string_view stage, double share)>;

// How a computation runs; never changes its result.
struct RunSettings
{
	int threads = 1; // ≥ 1
	Progress progress;
};

// Counts finished items of a stage and reports each, from any thread.
class ProgressCounter
{
public:
	ProgressCounter(const Progress& progress, std::string stage, std::size_t count)
		: m_progress(progress), m_stage(std::move(stage)), m_count(count)
	{
	}

	void finishOne()
	{
		if (m_progress)
		{
			const std::lock_guard lock(m_mutex);
			m_done += 1;
			m_progress(m_stage, static_cast<double>(m_done) / static_cast<double>(m_count));
		}
	}

private:
	const Progress& m_progress;
	std::string m_stage;
	std::size_t m_count;
	std::size_t m_done = 0;
	std::mutex m_mutex;
};

} // namespace nook
