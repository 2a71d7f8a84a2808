// SPDX-License-Identifier: GPL-3.0-or-later
// How far a verb is, for whoever looks on: a person at a terminal, a program that reads a log, a page in a browser.
#pragma once

#include "progress_line.h"
#include "progress_log.h"

#include "core/error.h"
#include "core/progress.h"

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// Of one run of the program; begins with it.
class VerbProgress
{
public:
	VerbProgress() = default;
	VerbProgress(const VerbProgress&) = delete;
	VerbProgress& operator=(const VerbProgress&) = delete;

	// Before start(): the run is a part, or a merge of parts. `units` must outlive what start() returns.
	void divide(WorkUnits& units)
	{
		m_units = &units;
	}

	// For a verb whose options have been checked, before its work; nothing is shown or written without. threads 0: all. `log`: of
	// --progress, or empty. What it returns must not outlive this. Throws as ProgressLog.
	RunSettings start(std::string_view verb, int threads, const std::string& log);

	// Before anything else is written to a terminal; and the log's last line. `error`: one line, or empty.
	void end(ExitCode code, std::string_view error);

private:
	void tell(std::string_view stage, double share);
	void update(std::string_view stage, double share);
	void warn();
	double now() const;

	std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
	std::mutex m_mutex;
	WorkUnits* m_units = nullptr;
	Progress m_page;
	std::optional<ProgressLine> m_line;
	std::unique_ptr<ProgressLog> m_log;
	std::vector<ProgressStage> m_stages; // each a part of the one before
};

} // namespace nook
