// SPDX-License-Identifier: GPL-3.0-or-later
// Progress of one start within a stage of several.
#pragma once

#include "core/progress.h"

#include <cstddef>

namespace nook
{

// Each step of a descent counts as one item; its end counts the remaining ones, since most descents stop early.
class StartProgress
{
public:
	// `steps` ≥ 1; further steps are not counted.
	StartProgress(ProgressCounter& progress, std::size_t steps) : m_progress(progress), m_left(steps) {}
	StartProgress(const StartProgress&) = delete;
	StartProgress& operator=(const StartProgress&) = delete;
	~StartProgress()
	{
		m_progress.finish(m_left);
	}

	void step()
	{
		if (m_left > 1)
		{
			m_left -= 1;
			m_progress.finishOne();
		}
	}

private:
	ProgressCounter& m_progress;
	std::size_t m_left;
};

} // namespace nook
