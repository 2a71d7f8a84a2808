// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/isolate.h"

#include "core/worker.h"
#include "core/worker_process.h"

#include <csignal>
#include <map>
#include <memory>
#include <mutex>

#include <sys/wait.h>

namespace nook
{
namespace
{

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
