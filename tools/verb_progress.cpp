// SPDX-License-Identifier: GPL-3.0-or-later
#include "verb_progress.h"

#include "call.h"

#include "core/file.h"
#include "core/parallel.h"
#include "core/system.h"
#include "core/text.h"
#include "version.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <new>
#include <utility>

namespace nook
{

#ifndef __EMSCRIPTEN__ // else watch_wasm.cpp
Progress pageProgress()
{
	return {};
}

Watch pageWatch()
{
	return {};
}
#endif

namespace
{

// "1 min 20 s".
std::string spoken(double seconds)
{
	const auto whole = static_cast<long>(std::ceil(seconds));
	const long hours = whole / 3600;
	const long minutes = whole / 60 % 60;
	if (hours > 0)
	{
		return std::to_string(hours) + " h " + std::to_string(minutes) + " min";
	}
	const std::string rest = std::to_string(whole % 60) + " s";
	return minutes > 0 ? std::to_string(minutes) + " min " + rest : rest;
}

std::string barOf(double share)
{
	constexpr std::size_t kCells = 20;
	const auto full = static_cast<std::size_t>(std::floor(static_cast<double>(kCells) * share));
	return "[" + std::string(full, '#') + std::string(kCells - full, '.') + "]";
}

// The bar and the time left are those of the outermost stage that knows them. Of one that nothing counts the name is all.
std::string textOf(std::span<const ProgressStage> stages, double now_s)
{
	std::string text;
	bool has_bar = false;
	bool has_time = false;
	for (const ProgressStage& stage : stages)
	{
		text += (text.empty() ? "" : ": ") + oneLine(stage.name);
		if (stage.share > 0.0)
		{
			const int percent = static_cast<int>(std::floor(100.0 * stage.share));
			text += (has_bar ? " " : " " + barOf(stage.share) + " ") + std::to_string(percent) + " %";
			has_bar = true;
		}
		const std::optional<double> left_s = stage.remainingAt(now_s);
		if (left_s && !has_time)
		{
			text += ", " + spoken(*left_s) + " left";
			has_time = true;
		}
	}
	return text;
}

constexpr std::string_view kFirst = "{\"schema\": \"nook.progress/1\"";

std::string secondsOf(double seconds)
{
	return fixedText(seconds, 3);
}

// A level's buffers are known only when it has been read, a pattern's name may be mistyped: then nothing of them may be lost.
void checkReplaceable(const std::string& path)
{
	std::error_code none;
	if (!std::filesystem::is_regular_file(nativePath(path), none))
	{
		return;
	}
	std::string begin(kFirst.size(), '\0');
	std::FILE* const file = openFile(path, "rb");
	if (file != nullptr)
	{
		begin.resize(std::fread(begin.data(), 1, begin.size(), file));
		std::fclose(file);
	}
	refuseIf(file == nullptr || (!begin.empty() && begin != kFirst),
			 path + ": --progress: found a file that is no log of progress, expected one, or a new name");
}

// Opening it again would give it a place of its own in what is written there.
bool isSame(const std::string& path, const char* stream)
{
	const std::optional<std::string> identity = identityOfFile(path);
	return identity && identity == identityOfFile(stream);
}

} // namespace

// Without line breaks by the terminal (DECAWM) while it is written: of a line that is too long, the end is not seen.
void ProgressLine::show(std::span<const ProgressStage> stages, double now_s)
{
	const bool begins = stages.size() == 1 && stages.front().share == 0.0;
	if (!begins && m_shown && now_s - m_shown_s < kProgressEvery_s)
	{
		return;
	}
	m_shown = true;
	m_shown_s = now_s;
	std::fprintf(stderr, "\r\033[?7l%s\033[K\033[?7h", textOf(stages, now_s).c_str());
	std::fflush(stderr);
}

void ProgressLine::clear()
{
	if (m_shown)
	{
		std::fputs("\r\033[K", stderr);
		std::fflush(stderr);
		m_shown = false;
	}
}

ProgressLog::ProgressLog(const std::string& path, std::string_view verb) : m_name(path)
{
	if (path == "-" || isSame(path, "/dev/stdout"))
	{
		m_name = path == "-" ? "standard output" : path;
		m_file = stdout;
	}
	else if (isSame(path, "/dev/stderr"))
	{
		m_file = stderr;
	}
	else
	{
		checkReplaceable(path);
		m_file = openFile(path, "wb");
		m_owned = true;
	}
	refuseIf(m_file == nullptr, path + ": cannot be written: " + std::strerror(errno), ExitCode::file);
	write(std::string(kFirst) + ", \"verb\": " + jsonText(verb) + ", \"version\": " + jsonText(NOOK_VERSION) + "}");
}

ProgressLog::~ProgressLog()
{
	close();
}

bool ProgressLog::isOnTerminal() const
{
	return m_file != nullptr && isTerminal(m_file);
}

void ProgressLog::tell(ProgressStage& stage, const std::string* within, double now_s)
{
	const bool in_between = stage.share > 0.0 && stage.share < 1.0;
	if (m_file == nullptr || (in_between && now_s - stage.logged_s < kProgressEvery_s))
	{
		return;
	}
	stage.logged_s = now_s;
	std::string line = "{\"stage\": " + jsonText(stage.name);
	line += within != nullptr ? ", \"within\": " + jsonText(*within) : "";
	const std::string done = roundedText(std::floor(1e4 * stage.share) / 1e4, 4); // rounded down: 1 is the end
	line += ", \"done\": " + done + ", \"elapsed_s\": " + secondsOf(now_s);
	if (const std::optional<double> left_s = stage.remainingAt(now_s))
	{
		line += ", \"remaining_s\": " + secondsOf(*left_s);
	}
	write(line + "}");
}

void ProgressLog::end(ExitCode code, std::string_view error, double now_s)
{
	std::string line = "{\"end\": true, \"exit_code\": " + std::to_string(static_cast<int>(code));
	line += ", \"elapsed_s\": " + secondsOf(now_s);
	write(line + (error.empty() ? "" : ", \"error\": " + jsonText(error)) + "}");
	close();
}

std::string ProgressLog::takeFailure()
{
	return std::exchange(m_failure, "");
}

// A line at a time, so that a program that is killed leaves whole ones.
void ProgressLog::write(const std::string& line)
{
	if (m_file == nullptr)
	{
		return;
	}
	const std::string text = line + "\n";
	if (std::fwrite(text.data(), 1, text.size(), m_file) != text.size() || std::fflush(m_file) != 0)
	{
		m_failure = m_name + ": cannot be written: " + std::strerror(errno) + ", the work goes on without a log of progress";
		close();
	}
}

void ProgressLog::close()
{
	if (m_owned && m_file != nullptr)
	{
		std::fclose(m_file);
	}
	m_file = nullptr;
}

RunSettings VerbProgress::start(std::string_view verb, int threads, const std::string& log)
{
	RunSettings run;
	run.threads = threads > 0 ? threads : availableThreads();
	if (t_call != nullptr)
	{
		run.progress = t_call->progress;
		return run;
	}
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
