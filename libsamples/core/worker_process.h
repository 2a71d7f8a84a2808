// SPDX-License-Identifier: GPL-3.0-or-later
// A worker program (core/worker.h) that this one started, and the socket to it.
#pragma once

#include <cstddef>
#include <string>

namespace nook
{

class WorkerProcess
{
public:
	// Returns when it is ready for requests. Throws Error: file where there is no such program, runtime where it cannot run.
	explicit WorkerProcess(const std::string& program);
	WorkerProcess(const WorkerProcess&) = delete;
	WorkerProcess& operator=(const WorkerProcess&) = delete;
	~WorkerProcess(); // nothing of it is left, whatever it was doing

	int socket() const
	{
		return m_socket;
	}

	// Memory in use that is its own, or 0 where that is unknown.
	std::size_t residentBytes() const;

	// Closes the socket, so that one that still writes ends, and waits for that; as waitpid() says it.
	int end();

private:
	void start(const std::string& program);
	void greet(const std::string& program);
	void stop();

	int m_process = 0;
	int m_socket = -1;
};

// Returns true where there is something to read, or the other end is closed, within a twentieth of a second.
inline constexpr int kWaitsASecond = 20;
bool waitForBytes(int socket);

} // namespace nook
