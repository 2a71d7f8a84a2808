// SPDX-License-Identifier: GPL-3.0-or-later
#include "run.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace nook::hostile
{
namespace
{

using Clock = std::chrono::steady_clock;

// Starts it in its own process group; returns its id and the read ends of two pipes.
pid_t start(const std::vector<std::string>& arguments, std::array<int, 2>& ends)
{
	std::array<int, 2> out{};
	std::array<int, 2> error{};
	if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(error.data(), O_CLOEXEC) != 0)
	{
		throw std::runtime_error("no pipe");
	}
	std::vector<char*> pointers;
	for (const std::string& argument : arguments)
	{
		pointers.push_back(const_cast<char*>(argument.c_str())); // NOLINT: execv's own type
	}
	pointers.push_back(nullptr);
	// Not fork: this process has gigabytes of files, whose page tables would be copied.
	posix_spawn_file_actions_t actions{};
	::posix_spawn_file_actions_init(&actions);
	::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
	::posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
	::posix_spawn_file_actions_adddup2(&actions, error[1], STDERR_FILENO);
	posix_spawnattr_t attributes{};
	::posix_spawnattr_init(&attributes);
	::posix_spawnattr_setpgroup(&attributes, 0);
	::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
	pid_t process = -1;
	const int failed = ::posix_spawn(&process, pointers[0], &actions, &attributes, pointers.data(), environ);
	::posix_spawnattr_destroy(&attributes);
	::posix_spawn_file_actions_destroy(&actions);
	::close(out[1]);
	::close(error[1]);
	ends = {out[0], error[0]};
	if (failed != 0)
	{
		throw std::runtime_error("no process");
	}
	return process;
}

// Reads both pipes to their ends; false on timeout.
bool drain(std::array<int, 2>& ends, std::array<std::string*, 2> texts, Clock::time_point until)
{
	while (ends[0] >= 0 || ends[1] >= 0)
	{
		std::array<pollfd, 2> waiting{{{ends[0], POLLIN, 0}, {ends[1], POLLIN, 0}}};
		const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count();
		if (left <= 0)
		{
			return false;
		}
		::poll(waiting.data(), 2, static_cast<int>(left));
		for (std::size_t i = 0; i < 2; ++i)
		{
			std::array<char, 65536> buffer{};
			if (ends[i] < 0 || waiting[i].revents == 0)
			{
				continue;
			}
			const ssize_t got = ::read(ends[i], buffer.data(), buffer.size());
			if (got > 0)
			{
				texts[i]->append(buffer.data(), static_cast<std::size_t>(got));
			}
			else
			{
				::close(ends[i]);
				ends[i] = -1;
			}
		}
	}
	return true;
}

// True if a process started by the program outlives it by a second.
bool adoptsAnyone()
{
	for (int wait = 0; wait < 100; ++wait)
	{
		const pid_t found = ::waitpid(-1, nullptr, WNOHANG);
		if (found < 0)
		{
			return false; // there is none
		}
		if (found == 0)
		{
			std::this_thread::sleep_for(std::chrono::milliseconds(10));
		}
	}
	return true;
}

} // namespace

Ended run(const std::vector<std::string>& arguments, double wait_s)
{
	::prctl(PR_SET_CHILD_SUBREAPER, 1);
	Ended ended;
	std::array<int, 2> ends{};
	const pid_t process = start(arguments, ends);
	const auto until = Clock::now() + std::chrono::milliseconds(static_cast<long>(1000 * wait_s));
	const bool in_time = drain(ends, {&ended.out, &ended.error}, until);
	if (!in_time)
	{
		::kill(-process, SIGKILL);
		for (const int end : ends)
		{
			::close(end);
		}
	}
	int status = 0;
	rusage used{};
	while (::wait4(process, &status, 0, &used) < 0 && errno == EINTR)
	{
	}
	ended.left_process = adoptsAnyone();
	const auto seconds = [](const timeval& time)
	{
		return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
	};
	ended.processor_s = seconds(used.ru_utime) + seconds(used.ru_stime);
	ended.resident_kb = used.ru_maxrss;
	if (!in_time)
	{
		ended.how = "no end after " + std::to_string(wait_s) + " s";
	}
	else if (WIFEXITED(status))
	{
		ended.code = WEXITSTATUS(status);
	}
	else
	{
		ended.how = "signal " + std::to_string(WTERMSIG(status));
	}
	return ended;
}

} // namespace nook::hostile
