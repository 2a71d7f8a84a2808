// SPDX-License-Identifier: GPL-3.0-or-later
// A running worker program (core/worker.h) and the socket to it.
#pragma once

#include <cstddef>
#include <string>

namespace nook
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

	// The worker's private resident memory; 0 if unknown.
	std::size_t residentBytes() const;

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
bool waitForBytes(int socket);

} // namespace nook
