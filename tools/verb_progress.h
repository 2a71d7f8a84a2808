// SPDX-License-Identifier: GPL-3.0-or-later
// How far a verb is, for whoever looks on: a person at a terminal, a program that reads a log, a page in a browser.
#pragma once

#include "core/error.h"
#include "core/progress.h"
#include "pattern/recipe.h"

#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// The page of a browser that the program runs in; both are empty if nobody looks on.
Progress pageProgress();
Watch pageWatch();

inline constexpr double kProgressEvery_s = 0.1; // at most so often something is shown or written of a stage that goes on

struct ProgressStage
{
	std::string name;
	double begun_s = 0.0; // since the program began
	double share = 0.0;   // 0 to 1, never falls
	RemainingTime remaining;
	double logged_s = 0.0; // when the log last had a line of it

	std::optional<double> remainingAt(double now_s) const
	{
		return remaining.at(now_s - begun_s);
	}
};

// One line on a terminal that is written over and over, and gone in the end.
class ProgressLine
{
public:
	// Nested stages, with a bar and the time left; ten times a second at most, except when a first stage begins.
	void show(std::span<const ProgressStage> stages, double now_s);

	void clear();

private:
	bool m_shown = false;
	double m_shown_s = 0.0;
};

// Progress for programs: a file that grows by a JSON object a line (nook.progress/1) while a verb works.
class ProgressLog
{
public:
	// "-" is standard output. Replaces a file only if it is such a log. Throws Error (usage, file).
	ProgressLog(const std::string& path, std::string_view verb);
	ProgressLog& operator=(ProgressLog&&) = delete;
	~ProgressLog();

	bool isOnTerminal() const;

	// Ten lines a second at most, except a stage's first and last one. `within`: the name of the stage around it, or null.
	void tell(ProgressStage& stage, const std::string* within, double now_s);

	// The last line. `error`: one line, or empty.
	void end(ExitCode code, std::string_view error, double now_s);

	// Once, where writing has failed, which ends the log but not the work: why. Else empty.
	std::string takeFailure();

private:
	void write(const std::string& line);
	void close();

	std::string m_name;
	std::FILE* m_file = nullptr;
	bool m_owned = false;
	std::string m_failure;
};

// One run of the program; begins with it.
class VerbProgress
{
public:
	VerbProgress& operator=(VerbProgress&&) = delete;

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
