// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/isolate.h"

#include "core/error.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace nook
{
namespace
{

class WorkerProcess
{
public:
	// Returns once the worker is ready. Throws Error: file if the program is missing, runtime if it cannot run.
	explicit WorkerProcess(const std::string& program);
	WorkerProcess(const WorkerProcess&) = delete;
	WorkerProcess& operator=(const WorkerProcess&) = delete;
	~WorkerProcess(); // kills the worker

	int socket() const
	{
		return m_socket;
	}

	std::size_t residentBytes() const
	{
		return memoryOf(std::to_string(m_process)).resident_bytes;
	}

	// Closes the socket, so that a worker that still writes ends, and waits; returns waitpid()'s status.
	int end();

private:
	void start(const std::string& program);
	void greet(const std::string& program);
	void stop();

	int m_process = 0;
	int m_socket = -1;
};

// Waits up to a twentieth of a second; true if there is data to read or the other end is closed.
inline constexpr int kWaitsASecond = 20;

bool waitForBytes(int socket)
{
	pollfd waiting{socket, POLLIN, 0};
	return ::poll(&waiting, 1, 1000 / kWaitsASecond) > 0;
}

constexpr int kStartTime_s = 300; // loading some 250 libraries on a busy machine

// The run path of this program, or of the library that this code is in, which leads to the workers both in the build folder and
// when installed.
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

std::string pathOf(const std::string& program)
{
	for (const std::string& folder : libraryFolders())
	{
		const std::string path = folder + "/" + program;
		if (::access(path.c_str(), X_OK) == 0)
		{
			return path;
		}
	}
	throw Error(ExitCode::file, program + ": found no such program, expected this part of nook next to its libraries");
}

[[noreturn]] void cannotRun(const std::string& program, const std::string& why)
{
	throw Error(ExitCode::runtime,
				program + ": found that it cannot be started: " + why + ", expected memory and processes for this part of nook");
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
	SpawnSettings(const SpawnSettings&) = delete;
	SpawnSettings& operator=(const SpawnSettings&) = delete;
	~SpawnSettings()
	{
		::posix_spawn_file_actions_destroy(&actions);
		::posix_spawnattr_destroy(&attributes);
	}

	posix_spawn_file_actions_t actions{};
	posix_spawnattr_t attributes{};
};

// Inherits the environment and, unless set, asks for huge heap pages: Assimp clears 16 MiB per OBJ, which dominates its time with
// small pages. (glibc 2.35 or newer; others ignore the variable.)
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

WorkerProcess::WorkerProcess(const std::string& program)
{
	start(program);
	try
	{
		greet(program);
	}
	catch (const StreamEnded& ended)
	{
		const std::string why = ended.found != nullptr ? ended.found : "it ends with status " + std::to_string(end());
		stop();
		cannotRun(program, why);
	}
	catch (const Error&)
	{
		stop();
		throw;
	}
}

void WorkerProcess::start(const std::string& program)
{
	const std::string path = pathOf(program);
	std::array<int, 2> ends{};
	if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
	{
		cannotRun(program, std::strerror(errno));
	}
	const SpawnSettings settings(ends[1]);
	std::string name = path;
	std::string self = std::to_string(::getpid());
	std::array<char*, 3> arguments{name.data(), self.data(), nullptr};
	const int failed =
		::posix_spawn(&m_process, path.c_str(), &settings.actions, &settings.attributes, arguments.data(), environment().data());
	::close(ends[1]);
	m_socket = ends[0];
	if (failed != 0)
	{
		m_process = 0;
		::close(m_socket);
		cannotRun(program, std::strerror(failed));
	}
}

void WorkerProcess::greet(const std::string& program)
{
	int waits = 0;
	ValueReader greeting(m_socket,
						 [&]
						 {
							 while (!waitForBytes(m_socket))
							 {
								 waits += 1;
								 if (waits > kStartTime_s * kWaitsASecond)
								 {
									 throw StreamEnded{"it takes too long"};
								 }
							 }
						 });
	const std::string version = greeting.text();
	greeting.finish();
	if (version != NOOK_WORKER_VERSION) // both must come from the same build
	{
		throw Error(ExitCode::runtime, program + ": found version " + version + ", expected " NOOK_WORKER_VERSION);
	}
}

WorkerProcess::~WorkerProcess()
{
	stop();
}

void WorkerProcess::stop()
{
	if (m_process > 0)
	{
		::kill(m_process, SIGKILL);
		end();
	}
}

int WorkerProcess::end()
{
	::close(m_socket);
	int status = 0;
	while (::waitpid(m_process, &status, 0) < 0 && errno == EINTR)
	{
	}
	m_process = 0;
	return status;
}

constexpr int kWaitFactor = 5; // a busy machine may leave a process a fifth of a processor

// Idle workers kept for the next call, one per program. A call takes one out and puts it back, so calls never share a worker.
class KeptWorkers
{
public:
	std::unique_ptr<WorkerProcess> take(const std::string& program)
	{
		const std::lock_guard lock(m_mutex);
		return std::move(m_workers[program]);
	}

	void put(const std::string& program, std::unique_ptr<WorkerProcess> worker)
	{
		const std::lock_guard lock(m_mutex);
		m_workers[program] = std::move(worker);
	}

private:
	std::mutex m_mutex;
	std::map<std::string, std::unique_ptr<WorkerProcess>> m_workers;
};

KeptWorkers& keptWorkers()
{
	static KeptWorkers workers;
	return workers;
}

// Waits for a worker's answer and enforces its limits meanwhile.
class Watch
{
public:
	Watch(const WorkerProcess& worker, const std::optional<IsolationLimits>& limits)
		: m_worker(worker), m_limits(limits), m_resident_bytes(worker.residentBytes())
	{
	}

	void operator()()
	{
		while (!waitForBytes(m_worker.socket()))
		{
			m_waits += 1;
			if (m_limits && m_waits > kWaitsASecond * m_limits->processor_s * kWaitFactor)
			{
				throw StreamEnded{kTooLong};
			}
			const std::size_t bytes = m_worker.residentBytes();
			if (m_limits && bytes > m_resident_bytes && bytes - m_resident_bytes > m_limits->memory_bytes)
			{
				throw StreamEnded{kTooLarge};
			}
		}
	}

private:
	const WorkerProcess& m_worker;
	std::optional<IsolationLimits> m_limits;
	std::size_t m_resident_bytes; // at the start of the request
	int m_waits = 0;
};

// Sends a function's name, its limits and its arguments.
void sendRequest(const WorkerProcess& worker, const Isolated& what, const std::optional<IsolationLimits>& limits,
				 const std::function<void(ValueWriter&)>& ask)
{
	ValueWriter request(worker.socket());
	request.text(what.function);
	request.value(limits ? RequestHead{true, limits->memory_bytes, limits->processor_s} : RequestHead{});
	ask(request);
	request.finish(ExitCode::ok, "");
}

// Throws an Error naming the file being read, with the reason why the worker ended.
[[noreturn]] void refuse(const std::string& name, bool is_ours, const char* found)
{
	if (is_ours)
	{
		throw Error(ExitCode::runtime, name + ": found " + found + ", expected contents that can be processed");
	}
	throw Error(ExitCode::invalid_input, name + ": found " + found + ", expected a complete file of its format");
}

const char* reasonOf(int status)
{
	const bool stopped = WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL);
	return stopped ? kTooLong : kBroken;
}

} // namespace

bool hasWorker(const char* program)
{
	try
	{
		std::unique_ptr<WorkerProcess> kept = keptWorkers().take(program);
		keptWorkers().put(program, kept != nullptr ? std::move(kept) : std::make_unique<WorkerProcess>(program));
		return true;
	}
	catch (const Error&)
	{
		return false;
	}
}

void isolate(const Isolated& what, const std::string& name, const std::optional<IsolationLimits>& limits,
			 const std::function<void(ValueWriter&)>& ask, const std::function<void(ValueReader&)>& take)
{
	std::unique_ptr<WorkerProcess> worker = what.keep ? keptWorkers().take(what.program) : nullptr;
	for (bool again = worker != nullptr;; again = false)
	{
		if (worker == nullptr)
		{
			worker = std::make_unique<WorkerProcess>(what.program);
		}
		ValueReader answer(worker->socket(), Watch(*worker, limits));
		const auto keep = [&]
		{
			if (what.keep && answer.isFinished())
			{
				keptWorkers().put(what.program, std::move(worker));
			}
		};
		try
		{
			sendRequest(*worker, what, limits, ask);
			take(answer);
			answer.finish();
			keep();
			return;
		}
		catch (const Error&)
		{
			keep();
			throw;
		}
		catch (const StreamEnded& ended)
		{
			const char* const found = ended.found != nullptr ? ended.found : reasonOf(worker->end());
			worker.reset();
			if (!again || ended.found != nullptr)
			{
				refuse(name, !limits, found);
			}
		}
	}
}

} // namespace nook
