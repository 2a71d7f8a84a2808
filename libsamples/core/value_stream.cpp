// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/value_stream.h"

#include "core/isolate.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>

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

} // namespace nook
