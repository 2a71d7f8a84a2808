// SPDX-License-Identifier: GPL-3.0-or-later
#include "verb_progress.h"

#include "watch.h"

#include "core/parallel.h"
#include "core/system.h"
#include "core/text.h"

#include <algorithm>
#include <cstdio>
#include <new>

namespace nook
{

RunSettings VerbProgress::start(std::string_view verb, int threads, const std::string& log)
{
	RunSettings run;
	run.threads = threads > 0 ? threads : availableThreads();
	run.units = m_units;
	m_page = pageProgress();
	if (!log.empty())
	{
		m_log = std::make_unique<ProgressLog>(log, verb);
	}
	if (isTerminal() && !(m_log && m_log->isOnTerminal())) // lines of JSON among it would be no lines
	{
		m_line.emplace();
	}
	warn();
	if (m_page || m_log || m_line)
	{
		run.progress = [this](std::string_view stage, double share)
		{
			tell(stage, share);
		};
	}
	return run;
}

void VerbProgress::end(ExitCode code, std::string_view error)
{
	const std::lock_guard lock(m_mutex);
	m_stages.clear();
	if (m_line)
	{
		m_line->clear();
	}
	if (m_log)
	{
		m_log->end(code, error, now());
		warn();
	}
}

// The work is worth more than word of it.
void VerbProgress::tell(std::string_view stage, double share)
{
	const std::lock_guard lock(m_mutex);
	if (m_page)
	{
		m_page(stage, share);
	}
	try
	{
		update(stage, share);
	}
	catch (const std::bad_alloc&)
	{
	}
}

void VerbProgress::update(std::string_view name, double share)
{
	const double now_s = now();
	if (share == 0.0)
	{
		m_stages.push_back({std::string(name), now_s, 0.0, {}, 0.0});
	}
	while (!m_stages.empty() && m_stages.back().name != name) // an error ended it that did not end the stage that it was a part of
	{
		m_stages.pop_back();
	}
	if (m_stages.empty())
	{
		return;
	}
	ProgressStage& stage = m_stages.back();
	stage.share = std::max(stage.share, share);
	stage.remaining.add(now_s - stage.begun_s, stage.share);
	if (m_log)
	{
		m_log->tell(stage, m_stages.size() > 1 ? &m_stages[m_stages.size() - 2].name : nullptr, now_s);
		warn();
	}
	const bool ends = share >= 1.0;
	if (ends)
	{
		m_stages.pop_back();
	}
	if (m_line && m_stages.empty())
	{
		m_line->clear(); // whatever is written between stages needs not know of it
	}
	else if (m_line && !ends)
	{
		m_line->show(m_stages, now_s);
	}
}

void VerbProgress::warn()
{
	const std::string failure = m_log ? m_log->takeFailure() : "";
	if (failure.empty())
	{
		return;
	}
	if (m_line)
	{
		m_line->clear();
	}
	std::fprintf(stderr, "nook: warning: %s\n", oneLine(failure).c_str());
}

double VerbProgress::now() const
{
	return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
}

} // namespace nook
