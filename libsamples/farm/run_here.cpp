// SPDX-License-Identifier: GPL-3.0-or-later
#include "farm/run_here.h"

#include "core/error.h"
#include "farm/status.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace nook
{
namespace
{

constexpr int kCannotRun = 127;

// In the new process: a group of its own, which run.sh ends as one, and which ends with this program.
[[noreturn]] void becomeScript(const std::string& script, const std::string& log, const std::string& jobs, pid_t parent)
{
	::setpgid(0, 0);
	::prctl(PR_SET_PDEATHSIG, SIGTERM); // NOLINT: as it is declared
	if (::getppid() != parent)
	{
		::_exit(kCannotRun);
	}
	const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666); // NOLINT: its third argument
	const int none = ::open("/dev/null", O_RDONLY);                           // NOLINT
	if (file < 0 || none < 0)
	{
		::_exit(kCannotRun);
	}
	::dup2(none, STDIN_FILENO);
	::dup2(file, STDOUT_FILENO);
	::dup2(file, STDERR_FILENO);
	::execlp("sh", "sh", script.c_str(), jobs.c_str(), static_cast<char*>(nullptr)); // NOLINT
	::_exit(kCannotRun);
}

} // namespace

void runHere(const Plan& plan, const std::string& folder, int jobs, const RunSettings& settings)
{
	std::error_code failed;
	const std::string self = std::filesystem::read_symlink("/proc/self/exe", failed).string();
	if (!failed)
	{
		::setenv("NOOK", self.c_str(), 1);
	}
	::setenv("NOOK_GROUP", "1", 1);
	const std::string script = folder + "/run.sh";
	const std::string log = folder + "/log/run.log";
	const std::string at_once = std::to_string(jobs);
	const pid_t parent = ::getpid();
	std::size_t done = statusOf(plan, folder).count(JobState::done);
	const pid_t process = ::fork();
	if (process < 0)
	{
		throw Error(ExitCode::runtime, std::string("sh: cannot be started: ") + std::strerror(errno));
	}
	if (process == 0)
	{
		becomeScript(script, log, at_once, parent);
	}
	ProgressCounter stage(settings.progress, "jobs", plan.jobs.size());
	stage.finish(done);
	int code = 0;
	for (int tick = 1; ::waitpid(process, &code, WNOHANG) == 0; ++tick)
	{
		std::this_thread::sleep_for(std::chrono::milliseconds(50));
		if (settings.progress && tick % 20 == 0)
		{
			const std::size_t now = statusOf(plan, folder).count(JobState::done);
			stage.finish(now > done ? now - done : 0);
			done = std::max(done, now);
		}
	}
	if (WIFEXITED(code) && WEXITSTATUS(code) == kCannotRun)
	{
		throw Error(ExitCode::runtime, script + ": cannot be run by sh, expected a shell in PATH");
	}
}

} // namespace nook
