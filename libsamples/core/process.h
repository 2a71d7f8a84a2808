// SPDX-License-Identifier: GPL-3.0-or-later
// Worker processes and the streams to them: what isolate() needs of the operating system.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace nook
{

// An end of a stream of bytes: a socket, or a pipe's handle on Windows.
using StreamEnd = std::intptr_t;

struct WorkerStreams
{
	StreamEnd from = -1;
	StreamEnd to = -1; // POSIX: the same socket
};

// False if the other end is closed.
bool sendBytes(StreamEnd to, const void* data, std::size_t size);

// Waits for bytes and returns how many it read, at most `size`; 0 if the other end is closed.
std::size_t receiveBytes(StreamEnd from, void* data, std::size_t size);

// Waits up to a twentieth of a second; true if there is data to read or the other end is closed.
inline constexpr int kWaitsASecond = 20;
bool waitForBytes(StreamEnd from);

struct ProcessEnd
{
	int status = 0;
	bool stopped = false; // by a limit on its processor time
};

// A worker and the streams to it. The worker inherits no other files, and ends with this program.
class ChildProcess
{
public:
	explicit ChildProcess(const std::string& path); // throws std::system_error if it cannot be started
	ChildProcess& operator=(ChildProcess&&) = delete;
	~ChildProcess(); // kills it

	const WorkerStreams& streams() const
	{
		return m_streams;
	}
	std::size_t residentBytes() const; // 0 if unknown

	// Closes the streams, so that a worker that still writes ends, and waits.
	ProcessEnd end();

private:
	WorkerStreams m_streams;
	std::intptr_t m_process = 0; // 0: ended
};

// Path of a worker; nothing if there is no such program where this one's libraries, or on Windows this program itself, are.
std::optional<std::string> pathOfWorker(const std::string& program);

// The worker's side.

// Call first: returns the streams that the command line names, or nothing if the parent is gone; the process ends with it.
std::optional<WorkerStreams> takeStreams(const char* argument);

// Limits this process to the memory and the processor time that it has now and so much more, never above the inherited limits; or
// no longer. True if the limit on memory is the effective one.
bool limitThisProcess(bool limited, std::size_t memory_bytes, int processor_s);

} // namespace nook
