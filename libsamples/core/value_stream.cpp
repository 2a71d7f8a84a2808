// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/value_stream.h"

#include "core/isolate.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <system_error>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

namespace nook
{
namespace
{

constexpr std::size_t kChunkBytes = std::size_t{1} << 16U;
constexpr std::size_t kMaxTextBytes = std::size_t{1} << 20U;

} // namespace

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

// The stream consists of chunks: a size, then that many bytes. Size 0 ends it, followed by a code and a message.
void ValueWriter::chunk(const void* data, std::size_t size)
{
	const auto send = [this](const void* from, std::size_t left)
	{
		const auto* at = static_cast<const char*>(from);
		while (left > 0)
		{
			const ssize_t sent = ::send(m_socket, at, left, MSG_NOSIGNAL);
			if (sent < 0 && errno != EINTR)
			{
				throw StreamEnded{};
			}
			const std::size_t moved = sent > 0 ? static_cast<std::size_t>(sent) : 0;
			at += moved;
			left -= moved;
		}
	};
	send(&size, sizeof size);
	send(data, size);
}

void ValueWriter::flush()
{
	if (!m_buffer.empty())
	{
		chunk(m_buffer.data(), m_buffer.size());
		m_buffer.clear();
	}
}

void ValueWriter::bytes(const void* data, std::size_t size)
{
	if (size == 0)
	{
		return;
	}
	if (size >= kChunkBytes)
	{
		flush();
		chunk(data, size);
		return;
	}
	const auto* const from = static_cast<const char*>(data);
	m_buffer.insert(m_buffer.end(), from, from + size);
	if (m_buffer.size() >= kChunkBytes)
	{
		flush();
	}
}

void ValueWriter::text(std::string_view text)
{
	values(text.substr(0, kMaxTextBytes));
}

void ValueWriter::finish(ExitCode code, std::string_view message)
{
	flush();
	chunk(nullptr, 0);
	value(code);
	text(message);
	flush();
}

void ValueReader::raw(void* data, std::size_t size)
{
	auto* at = static_cast<char*>(data);
	while (size > 0)
	{
		if (m_wait)
		{
			m_wait();
		}
		const ssize_t got = ::recv(m_socket, at, size, 0);
		if (got == 0 || (got < 0 && errno != EINTR))
		{
			throw StreamEnded{};
		}
		const std::size_t moved = got > 0 ? static_cast<std::size_t>(got) : 0;
		at += moved;
		size -= moved;
	}
}

void ValueReader::bytes(void* data, std::size_t size)
{
	auto* at = static_cast<char*>(data);
	while (size > 0)
	{
		if (m_chunk_left == 0)
		{
			raw(&m_chunk_left, sizeof m_chunk_left);
			if (m_chunk_left == 0)
			{
				lastWords();
				throw StreamEnded{kBroken}; // the message ended early
			}
		}
		const std::size_t part = std::min(size, m_chunk_left);
		raw(at, part);
		at += part;
		size -= part;
		m_chunk_left -= part;
	}
}

std::string ValueReader::text()
{
	std::string text;
	values(text, kMaxTextBytes);
	return text;
}

void ValueReader::lastWords()
{
	const auto code = value<ExitCode>();
	const std::string message = text();
	m_finished = true;
	if (code == ExitCode::runtime && message == kTooLarge)
	{
		throw StreamEnded{kTooLarge};
	}
	if (code != ExitCode::ok)
	{
		throw Error(code, message);
	}
}

void ValueReader::finish()
{
	std::size_t end = m_chunk_left;
	if (end == 0)
	{
		raw(&end, sizeof end);
	}
	if (end != 0)
	{
		throw StreamEnded{kBroken}; // the message has unread values
	}
	lastWords();
}

namespace
{

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

class Server
{
public:
	explicit Server(std::span<const WorkerFunction> functions) : m_functions(functions) {}

	// Serves one request. Throws StreamEnded if there is none.
	void serve()
	{
		ValueReader request(kWorkerSocket);
		ValueWriter answer(kWorkerSocket);
		const std::string name = request.text();
		const bool ours = limit(request.value<RequestHead>());
		try
		{
			run(name, request, answer);
			request.finish();
			answer.finish(ExitCode::ok, "");
		}
		catch (const Error& error)
		{
			request.finish();
			answer.finish(error.code(), error.what());
		}
		catch (const std::bad_alloc&)
		{
			skip(request);
			answer.finish(ExitCode::runtime, ours ? kTooLarge : "memory: found none left, expected a smaller task");
			throw StreamEnded{}; // a new worker can start clean
		}
		catch (const std::system_error& error)
		{
			if (error.code() != std::errc::resource_unavailable_try_again) // no thread could be started
			{
				throw;
			}
			skip(request);
			answer.finish(ExitCode::runtime, std::string("threads: ") + error.what());
			throw StreamEnded{};
		}
	}

private:
	bool limit(const RequestHead& head) const
	{
		m_processor.set(head.limited ? processorSeconds() + static_cast<rlim_t>(head.processor_s) : RLIM_INFINITY);
		const std::size_t mapped = memoryOf("self").mapped_bytes;
		return m_addresses.set(head.limited && kLimitAddresses && mapped > 0 ? mapped + head.memory_bytes : RLIM_INFINITY);
	}

	// Reads the rest of a request: closing a socket with unread data loses the answer.
	static void skip(ValueReader& request)
	{
		std::array<char, 4096> rest;
		try
		{
			while (!request.isFinished())
			{
				request.bytes(rest.data(), rest.size());
			}
		}
		catch (const StreamEnded&)
		{
		}
	}

	void run(const std::string& name, ValueReader& request, ValueWriter& answer) const
	{
		const auto found =
			std::find_if(m_functions.begin(), m_functions.end(), [&](const WorkerFunction& one) { return one.name == name; });
		if (found == m_functions.end())
		{
			throw Error(ExitCode::runtime, name + ": found no such function in this worker, expected parts of nook of one build");
		}
		found->run(request, answer);
	}

	std::span<const WorkerFunction> m_functions;
	Limit m_processor{RLIMIT_CPU};
	Limit m_addresses{RLIMIT_AS};
};

} // namespace

int serveRequests(int argc, char** argv, std::span<const WorkerFunction> functions, const std::function<void()>& prepare)
{
	if (argc != 2)
	{
		std::fprintf(stderr, "%s: a part of nook, which starts it where it is needed\n", argv[0]);
		return static_cast<int>(ExitCode::usage);
	}
	// End with the parent, and only then: a terminal sends these signals to both, and the parent must handle them.
	::prctl(PR_SET_PDEATHSIG, SIGKILL);
	for (const int signal : {SIGINT, SIGTERM, SIGHUP})
	{
		std::signal(signal, SIG_IGN);
	}
	if (std::to_string(::getppid()) != argv[1])
	{
		return static_cast<int>(ExitCode::runtime);
	}
	Limit(RLIMIT_CORE).set(0);
	try
	{
		if (prepare)
		{
			prepare();
		}
		ValueWriter greeting(kWorkerSocket);
		greeting.text(NOOK_WORKER_VERSION);
		greeting.finish(ExitCode::ok, "");
		for (Server server(functions);;)
		{
			server.serve();
		}
	}
	catch (const StreamEnded&)
	{
	}
	catch (...)
	{
		::_exit(static_cast<int>(ExitCode::runtime)); // the parent has the message
	}
	::_exit(0); // do not wait for a library's threads
}

} // namespace nook
