// SPDX-License-Identifier: GPL-3.0-or-later
// Progress for programs: a file that grows by a JSON object a line (nook.progress/1) while a verb works.
#pragma once

#include "progress_stage.h"

#include "core/error.h"

#include <cstdio>
#include <string>
#include <string_view>

namespace nook
{

class ProgressLog
{
public:
	// "-" is standard output. What is in a file goes, but none that holds anything but such a log is touched. Throws Error (usage,
	// file).
	ProgressLog(const std::string& path, std::string_view verb);
	ProgressLog(const ProgressLog&) = delete;
	ProgressLog& operator=(const ProgressLog&) = delete;
	~ProgressLog();

	bool isOnTerminal() const;

	// Ten lines a second at most, but for a stage's first and last one. `within`: the name of the stage that it is a part of, or
	// null.
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

} // namespace nook
