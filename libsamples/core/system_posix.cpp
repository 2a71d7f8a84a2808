// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/system.h"

#include <csignal>
#include <ctime>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace nook
{

std::FILE* openFile(const std::string& path, const char* mode)
{
	return std::fopen(path.c_str(), mode);
}

void removeFile(const char* path) noexcept
{
	::unlink(path);
}

void removeFolder(const char* path) noexcept
{
	::rmdir(path);
}

std::optional<std::string> identityOfFile(const std::string& path)
{
	struct stat status
	{
	};
	if (::stat(path.c_str(), &status) != 0)
	{
		return std::nullopt;
	}
	return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
}

std::string nameKey(const std::string& path)
{
	return path;
}

bool isOpenFolder(const std::string& folder)
{
	return ::access(folder.c_str(), W_OK | X_OK) == 0;
}

FileLock::FileLock(const std::string& path) : m_file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) // NOLINT: variadic
{
	if (m_file >= 0)
	{
		::flock(m_file, LOCK_EX); // fails where a network's file system has no locks
	}
}

FileLock::~FileLock()
{
	if (m_file >= 0)
	{
		::close(m_file);
	}
}

bool isTerminal()
{
	return isTerminal(stderr);
}

bool isTerminal(std::FILE* stream)
{
#ifdef __EMSCRIPTEN__
	return stream == nullptr; // Emscripten takes every stream for a terminal
#else
	return ::isatty(::fileno(stream)) != 0;
#endif
}

unsigned long processNumber()
{
	return static_cast<unsigned long>(::getpid());
}

double threadSeconds()
{
	timespec time{};
	return ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) == 0
			   ? static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec)
			   : -1.0;
}

std::vector<std::string> takeCommandLine(int argc, char** argv)
{
	return {argv, argv + argc};
}

void waitForEnd()
{
	::pause();
}

void onEndingSignals(void (*handler)(int))
{
	for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU})
	{
		struct sigaction action
		{
		};
		::sigaction(signal, nullptr, &action);
		if (action.sa_handler == SIG_IGN)
		{
			continue;
		}
		action = {};
		action.sa_handler = handler;
		action.sa_flags = SA_RESTART;
		::sigaction(signal, &action, nullptr);
	}
	std::signal(SIGPIPE, SIG_IGN);
	std::signal(SIGXFSZ, SIG_IGN);
}

void endBySignal(int signal)
{
	std::signal(signal, SIG_DFL);
	sigset_t signals{};
	::sigemptyset(&signals);
	::sigaddset(&signals, signal);
	::pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
	std::raise(signal);
}

} // namespace nook
