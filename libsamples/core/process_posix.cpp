// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/process.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <vector>

namespace nook
{
namespace
{

constexpr int kWorkerSocket = 3; // in the worker; its standard streams lead nowhere

struct ProcessMemory
{
	std::size_t mapped_bytes = 0;
	std::size_t resident_bytes = 0;
};

// Memory of a process, by its number or "self"; 0 if unknown.
ProcessMemory memoryOf(const std::string& process)
{
	ProcessMemory memory;
	if (std::FILE* const file = std::fopen(("/proc/" + process + "/statm").c_str(), "re"); file != nullptr)
	{
		const auto page_bytes = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
		std::size_t mapped = 0;
		std::size_t resident = 0;
		memory = std::fscanf(file, "%zu %zu", &mapped, &resident) == 2 ? ProcessMemory{page_bytes * mapped, page_bytes * resident}
																	   : memory;
		std::fclose(file);
	}
	return memory;
}

// The run path of this program or library, which leads to the workers both in the build folder and when installed.
std::vector<std::string> libraryFolders()
{
	Dl_info here{};
	void* self = nullptr;
	if (::dladdr(reinterpret_cast<const void*>(&waitForBytes), &here) != 0) // NOLINT: what dladdr takes
	{
		self = ::dlopen(here.dli_fname, RTLD_LAZY | RTLD_NOLOAD); // null for a program
	}
	self = self == nullptr ? ::dlopen(nullptr, RTLD_LAZY) : self;
	Dl_serinfo size{};
	if (self == nullptr || ::dlinfo(self, RTLD_DI_SERINFOSIZE, &size) != 0)
	{
		return {};
	}
	std::vector<std::max_align_t> room(size.dls_size / sizeof(std::max_align_t) + 1);
	auto* const list = reinterpret_cast<Dl_serinfo*>(room.data()); // NOLINT: what dlinfo fills
	std::memcpy(list, &size, sizeof size);
	std::vector<std::string> folders;
	if (::dlinfo(self, RTLD_DI_SERINFO, list) == 0)
	{
		for (unsigned i = 0; i < list->dls_cnt; ++i)
		{
			folders.emplace_back((&list->dls_serpath[0] + i)->dls_name);
		}
	}
	return folders;
}

// posix_spawn() settings: the worker inherits no streams, signal handlers or files except one end of the socket.
class SpawnSettings
{
public:
	explicit SpawnSettings(int socket)
	{
		::posix_spawn_file_actions_init(&actions);
		::posix_spawn_file_actions_adddup2(&actions, socket,
										   kWorkerSocket); // first: it may occupy the descriptor of a closed standard stream
		for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
		{
			::posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
		}
		::posix_spawnattr_init(&attributes);
		sigset_t signals{};
		::sigemptyset(&signals);
		::posix_spawnattr_setsigmask(&attributes, &signals);
		for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGXFSZ, SIGPIPE})
		{
			::sigaddset(&signals, signal);
		}
		::posix_spawnattr_setsigdefault(&attributes, &signals);
		::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
	}
	SpawnSettings& operator=(SpawnSettings&&) = delete;
	~SpawnSettings()
	{
		::posix_spawn_file_actions_destroy(&actions);
		::posix_spawnattr_destroy(&attributes);
	}

	posix_spawn_file_actions_t actions{};
	posix_spawnattr_t attributes{};
};

// Inherits the environment and, unless set, asks for huge heap pages (glibc 2.35 or newer), for fewer page faults.
std::vector<char*> environment()
{
	static std::string pages = "GLIBC_TUNABLES=glibc.malloc.hugetlb=1";
	std::vector<char*> words;
	for (char** word = environ; *word != nullptr; ++word)
	{
		words.push_back(*word);
	}
	if (std::getenv("GLIBC_TUNABLES") == nullptr) // NOLINT: nobody changes it
	{
		words.push_back(pages.data());
	}
	words.push_back(nullptr);
	return words;
}

// Address and thread sanitizers reserve terabytes of address space; there, only the parent's check of resident memory applies.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitAddresses = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool kLimitAddresses = false;
#else
constexpr bool kLimitAddresses = true;
#endif
#else
constexpr bool kLimitAddresses = true;
#endif

rlim_t processorSeconds()
{
	rusage used{};
	::getrusage(RUSAGE_SELF, &used);
	return static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1; // rounded up
}

// Sets a resource limit of this process, never above the inherited one.
class Limit
{
public:
	explicit Limit(__rlimit_resource what) : m_what(what)
	{
		::getrlimit(m_what, &m_given);
	}

	// True if the requested limit is the effective one.
	bool set(rlim_t most) const
	{
		rlimit limit = m_given;
		limit.rlim_cur = std::min(m_given.rlim_cur, most);
		::setrlimit(m_what, &limit);
		return most < m_given.rlim_cur;
	}

private:
	__rlimit_resource m_what;
	rlimit m_given{};
};

} // namespace

bool sendBytes(StreamEnd to, const void* data, std::size_t size)
{
	const auto* at = static_cast<const char*>(data);
	while (size > 0)
	{
		const ssize_t sent = ::send(static_cast<int>(to), at, size, MSG_NOSIGNAL);
		if (sent < 0 && errno != EINTR)
		{
			return false;
		}
		const std::size_t moved = sent > 0 ? static_cast<std::size_t>(sent) : 0;
		at += moved;
		size -= moved;
	}
	return true;
}

std::size_t receiveBytes(StreamEnd from, void* data, std::size_t size)
{
	ssize_t got = -1;
	do
	{
		got = ::recv(static_cast<int>(from), data, size, 0);
	} while (got < 0 && errno == EINTR);
	return got > 0 ? static_cast<std::size_t>(got) : 0;
}

bool waitForBytes(StreamEnd from)
{
	pollfd waiting{static_cast<int>(from), POLLIN, 0};
	return ::poll(&waiting, 1, 1000 / kWaitsASecond) > 0;
}

ChildProcess::ChildProcess(const std::string& path)
{
	std::array<int, 2> ends{};
	if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
	{
		throw std::system_error(errno, std::generic_category());
	}
	const SpawnSettings settings(ends[1]);
	std::string name = path;
	std::string self = std::to_string(::getpid());
	std::array<char*, 3> arguments{name.data(), self.data(), nullptr};
	pid_t process = 0;
	const int failed =
		::posix_spawn(&process, path.c_str(), &settings.actions, &settings.attributes, arguments.data(), environment().data());
	::close(ends[1]);
	if (failed != 0)
	{
		::close(ends[0]);
		throw std::system_error(failed, std::generic_category());
	}
	m_streams = {ends[0], ends[0]};
	m_process = process;
}

ChildProcess::~ChildProcess()
{
	if (m_process > 0)
	{
		::kill(static_cast<pid_t>(m_process), SIGKILL);
		end();
	}
}

std::size_t ChildProcess::residentBytes() const
{
	return memoryOf(std::to_string(m_process)).resident_bytes;
}

ProcessEnd ChildProcess::end()
{
	::close(static_cast<int>(m_streams.from));
	int status = 0;
	while (::waitpid(static_cast<pid_t>(m_process), &status, 0) < 0 && errno == EINTR)
	{
	}
	m_process = 0;
	return {status, WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)};
}

std::optional<std::string> pathOfWorker(const std::string& program)
{
	for (const std::string& folder : libraryFolders())
	{
		const std::string path = folder + "/" + program;
		if (::access(path.c_str(), X_OK) == 0)
		{
			return path;
		}
	}
	return std::nullopt;
}

std::optional<WorkerStreams> takeStreams(const char* argument)
{
	// A terminal sends these signals to both processes, and the parent must handle them.
	::prctl(PR_SET_PDEATHSIG, SIGKILL);
	for (const int signal : {SIGINT, SIGTERM, SIGHUP})
	{
		std::signal(signal, SIG_IGN);
	}
	Limit(RLIMIT_CORE).set(0);
	return std::to_string(::getppid()) == argument ? std::optional(WorkerStreams{kWorkerSocket, kWorkerSocket}) : std::nullopt;
}

bool limitThisProcess(bool limited, std::size_t memory_bytes, int processor_s)
{
	static const Limit processor(RLIMIT_CPU); // as inherited
	static const Limit addresses(RLIMIT_AS);
	processor.set(limited ? processorSeconds() + static_cast<rlim_t>(processor_s) : RLIM_INFINITY);
	const std::size_t mapped = memoryOf("self").mapped_bytes;
	return addresses.set(limited && kLimitAddresses && mapped > 0 ? mapped + memory_bytes : RLIM_INFINITY);
}

} // namespace nook
