// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/value_stream.h"

#include "core/isolate.h"
#include "core/lists.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <new>
#include <system_error>

#include <unistd.h>

namespace nook
{
namespace
{

constexpr std::size_t kChunkBytes = std::size_t{1} << 16U;
constexpr std::size_t kMaxTextBytes = std::size_t{1} << 20U;

// Reads the rest of a request: closing a socket with unread data loses the answer.
void skip(ValueReader& request)
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

// Serves one request. Throws StreamEnded if there is none.
void serve(const WorkerStreams& streams, std::span<const WorkerFunction> functions)
{
	ValueReader request(streams.from);
	ValueWriter answer(streams.to);
	const std::string name = request.text();
	const auto limited = request.value<bool>();
	const auto limits = request.value<IsolationLimits>();
	const bool ours = limitThisProcess(limited, limits.memory_bytes, limits.processor_s);
	try
	{
		const auto* const found = firstWhere(functions, [&](const WorkerFunction& one) { return one.name == name; });
		refuseIf(found == nullptr, name + ": found no such function in this worker, expected parts of nook of one build",
				 ExitCode::runtime);
		found->run(request, answer);
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

} // namespace

// The stream consists of chunks: a size, then that many bytes. Size 0 ends it, followed by a code and a message.
void ValueWriter::chunk(const void* data, std::size_t size)
{
	if (!sendBytes(m_to, &size, sizeof size) || !sendBytes(m_to, data, size))
	{
		throw StreamEnded{};
	}
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
		const std::size_t moved = receiveBytes(m_from, at, size);
		if (moved == 0)
		{
			throw StreamEnded{};
		}
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

int serveRequests(int argc, char** argv, std::span<const WorkerFunction> functions, const std::function<void()>& prepare)
{
	if (argc != 2)
	{
		std::fprintf(stderr, "%s: a part of nook, which starts it where it is needed\n", argv[0]);
		return static_cast<int>(ExitCode::usage);
	}
	const std::optional<WorkerStreams> streams = takeStreams(argv[1]);
	if (!streams)
	{
		return static_cast<int>(ExitCode::runtime);
	}
	try
	{
		if (prepare)
		{
			prepare();
		}
		ValueWriter greeting(streams->to);
		greeting.text(NOOK_WORKER_VERSION);
		greeting.finish(ExitCode::ok, "");
		for (;;)
		{
			serve(*streams, functions);
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
