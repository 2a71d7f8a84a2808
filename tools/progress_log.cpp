// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress_log.h"

#include "core/file.h"
#include "core/system.h"
#include "core/text.h"
#include "version.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>

namespace nook
{
namespace
{

constexpr std::string_view kFirst = "{\"schema\": \"nook.progress/1\"";

// Rounded down: 1 is the end.
std::string doneOf(double share)
{
	return roundedText(std::floor(1e4 * share) / 1e4, 4);
}

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
	if (file == nullptr || (!begin.empty() && begin != kFirst))
	{
		throw Error(ExitCode::usage, path + ": --progress: found a file that is no log of progress, expected one, or a new name");
	}
}

// Opening it again would give it a place of its own in what is written there.
bool isSame(const std::string& path, const char* stream)
{
	const std::optional<std::string> identity = identityOfFile(path);
	return identity && identity == identityOfFile(stream);
}

} // namespace

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
	if (m_file == nullptr)
	{
		throw Error(ExitCode::file, path + ": cannot be written: " + std::strerror(errno));
	}
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
	line += ", \"done\": " + doneOf(stage.share) + ", \"elapsed_s\": " + secondsOf(now_s);
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

} // namespace nook
