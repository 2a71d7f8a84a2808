// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/isolate.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace nook
{
namespace
{

// Address checks reserve terabytes of address space; there only the parent's watch over what is really used limits memory.
#if defined(__SANITIZE_ADDRESS__)
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

constexpr std::size_t kChunkBytes = std::size_t{1} << 16U; // what a pipe holds
constexpr int kTicksASecond = 20;                          // how often memory is looked at while nothing arrives
constexpr int kWaitFactor = 5;                             // a busy machine gives a process a fifth of a processor, or more
constexpr std::size_t kMaxTextBytes = std::size_t{1} << 20U;

constexpr const char* kTooLarge = "something that takes far more memory than its size needs";
constexpr const char* kTooLong = "something that reading does not come to an end with";
constexpr const char* kBroken = "something that breaks its reader";

// Pages of a process: all that is mapped, and what is in memory.
struct Pages
{
	std::size_t mapped = 0;
	std::size_t resident = 0;
};

Pages pagesOf(const std::string& process)
{
	Pages pages;
	std::FILE* const file = std::fopen(("/proc/" + process + "/statm").c_str(), "re");
	if (file != nullptr)
	{
		if (std::fscanf(file, "%zu %zu", &pages.mapped, &pages.resident) != 2)
		{
			pages = {};
		}
		std::fclose(file);
	}
	return pages;
}

std::size_t pageBytes()
{
	return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void limitSelf(const IsolationLimits& limits)
{
	const auto limit = [](auto what, rlim_t most)
	{
		rlimit now{};
		if (::getrlimit(what, &now) == 0)
		{
			now.rlim_cur = std::min(now.rlim_max, most);
			::setrlimit(what, &now);
		}
	};
	limit(RLIMIT_CORE, 0);
	limit(RLIMIT_CPU, static_cast<rlim_t>(limits.processor_s));
	const Pages pages = pagesOf("self");
	if (kLimitAddresses && pages.mapped > 0)
	{
		limit(RLIMIT_AS, pages.mapped * pageBytes() + limits.memory_bytes);
	}
}

[[noreturn]] void runChild(int file, pid_t parent, const IsolationLimits& limits, const std::function<void(IsolatedWriter&)>& work)
{
	// Whoever ends the parent ends this.
	::prctl(PR_SET_PDEATHSIG, SIGKILL);
	if (::getppid() != parent)
	{
		::_exit(1);
	}
	// A parent that was started without standard streams has its files in their places.
	file = ::fcntl(file, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
	// Readers print what they think; the one line of an error is ours.
	const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
	for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
	{
		::dup2(nowhere, stream);
	}
	// Handlers of the parent (a test runner's, a checker's) would speak for it.
	for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT, SIGXCPU, SIGPIPE})
	{
		std::signal(signal, SIG_DFL);
	}
	limitSelf(limits);
	IsolatedWriter writer(file);
	try
	{
		work(writer);
		writer.finish(ExitCode::ok, "");
	}
	catch (const Error& error)
	{
		writer.finish(error.code(), error.what());
	}
	catch (const std::bad_alloc&)
	{
		writer.finish(ExitCode::runtime, kTooLarge);
	}
	catch (...)
	{
		::_exit(1);
	}
	::_exit(0); // nothing of the parent's is destroyed or flushed twice
}

// What is left of the child goes with this, whatever happens here.
class Child
{
public:
	Child(int process, int file) : m_process(process), m_file(file) {}
	Child(const Child&) = delete;
	Child& operator=(const Child&) = delete;

	~Child()
	{
		if (m_process > 0)
		{
			::kill(m_process, SIGKILL);
			waitStatus();
		}
		closeFile();
	}

	// A child that still writes would wait for ever for somebody who reads.
	int waitStatus()
	{
		closeFile();
		int status = 0;
		while (::waitpid(m_process, &status, 0) < 0 && errno == EINTR)
		{
		}
		m_process = 0;
		return status;
	}

private:
	void closeFile()
	{
		if (m_file >= 0)
		{
			::close(m_file);
		}
		m_file = -1;
	}

	int m_process;
	int m_file;
};

[[noreturn]] void refuse(const std::string& name, const char* found)
{
	throw Error(ExitCode::invalid_input, name + ": found " + found + ", expected a whole file of its format");
}

} // namespace

// A stream of chunks: a size, then as many bytes. Size 0 is the last: a code and a message follow.
void IsolatedWriter::chunk(const void* data, std::size_t size)
{
	const auto send = [this](const void* from, std::size_t left)
	{
		const auto* at = static_cast<const char*>(from);
		while (left > 0)
		{
			const ssize_t sent = ::write(m_file, at, left);
			if (sent < 0 && errno != EINTR)
			{
				::_exit(1); // nobody listens
			}
			const std::size_t moved = sent > 0 ? static_cast<std::size_t>(sent) : 0;
			at += moved;
			left -= moved;
		}
	};
	send(&size, sizeof size);
	send(data, size);
}

void IsolatedWriter::flush()
{
	if (!m_buffer.empty())
	{
		chunk(m_buffer.data(), m_buffer.size());
		m_buffer.clear();
	}
}

void IsolatedWriter::bytes(const void* data, std::size_t size)
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

void IsolatedWriter::text(std::string_view text)
{
	text = text.substr(0, kMaxTextBytes);
	value(uint64_t{text.size()});
	bytes(text.data(), text.size());
}

void IsolatedWriter::finish(ExitCode code, std::string_view message)
{
	flush();
	chunk(nullptr, 0);
	value(code);
	text(message);
	flush();
}

IsolatedReader::IsolatedReader(int file, int process, const IsolationLimits& limits)
	: m_file(file), m_process(process), m_limits(limits), m_resident_pages(pagesOf(std::to_string(process)).resident)
{
}

void IsolatedReader::waitForBytes()
{
	pollfd waiting{m_file, POLLIN, 0};
	while (::poll(&waiting, 1, 1000 / kTicksASecond) <= 0)
	{
		m_idle_ticks += 1;
		if (m_idle_ticks > kTicksASecond * m_limits.processor_s * kWaitFactor)
		{
			throw Ended{kTooLong};
		}
		const std::size_t pages = pagesOf(std::to_string(m_process)).resident;
		if (pages > m_resident_pages && (pages - m_resident_pages) * pageBytes() > m_limits.memory_bytes)
		{
			throw Ended{kTooLarge};
		}
	}
}

void IsolatedReader::raw(void* data, std::size_t size)
{
	auto* at = static_cast<char*>(data);
	while (size > 0)
	{
		waitForBytes();
		const ssize_t got = ::read(m_file, at, size);
		if (got == 0 || (got < 0 && errno != EINTR))
		{
			throw Ended{};
		}
		const std::size_t moved = got > 0 ? static_cast<std::size_t>(got) : 0;
		at += moved;
		size -= moved;
	}
}

void IsolatedReader::bytes(void* data, std::size_t size)
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
				throw Ended{kBroken}; // more was expected
			}
		}
		const std::size_t part = std::min(size, m_chunk_left);
		raw(at, part);
		at += part;
		size -= part;
		m_chunk_left -= part;
	}
}

std::string IsolatedReader::text()
{
	const auto size = value<uint64_t>();
	if (size > kMaxTextBytes)
	{
		throw Ended{};
	}
	std::string text(static_cast<std::size_t>(size), '\0');
	bytes(text.data(), text.size());
	return text;
}

void IsolatedReader::lastWords()
{
	const auto code = value<ExitCode>();
	const std::string message = text();
	if (code == ExitCode::runtime && message == kTooLarge)
	{
		throw Ended{kTooLarge};
	}
	if (code != ExitCode::ok)
	{
		throw Error(code, message);
	}
}

void IsolatedReader::finish()
{
	std::size_t end = m_chunk_left;
	if (end == 0)
	{
		raw(&end, sizeof end);
	}
	if (end != 0)
	{
		throw Ended{kBroken}; // less was expected
	}
	lastWords();
}

void isolate(const std::string& name, const IsolationLimits& limits, const std::function<void(IsolatedWriter&)>& work,
			 const std::function<void(IsolatedReader&)>& take)
{
	std::array<int, 2> ends{};
	if (::pipe2(ends.data(), O_CLOEXEC) != 0)
	{
		throw Error(ExitCode::runtime, std::string("pipe: ") + std::strerror(errno));
	}
	const pid_t self = ::getpid();
	const pid_t process = ::fork();
	if (process < 0)
	{
		const int reason = errno;
		::close(ends[0]);
		::close(ends[1]);
		throw Error(ExitCode::runtime, std::string("fork: ") + std::strerror(reason));
	}
	if (process == 0)
	{
		::close(ends[0]);
		runChild(ends[1], self, limits, work);
	}
	::close(ends[1]);
	Child child(process, ends[0]);
	try
	{
		IsolatedReader reader(ends[0], process, limits);
		take(reader);
		reader.finish();
	}
	catch (const IsolatedReader::Ended& ended)
	{
		if (ended.reason != nullptr)
		{
			refuse(name, ended.reason);
		}
		const int status = child.waitStatus();
		const bool stopped = WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL);
		refuse(name, stopped ? kTooLong : kBroken);
	}
	child.waitStatus();
}

} // namespace nook
