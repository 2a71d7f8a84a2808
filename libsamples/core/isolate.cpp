// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/isolate.h"

#include "core/error.h"
#include "core/process.h"
#include "core/words.h"

#include <map>
#include <memory>
#include <mutex>
#include <system_error>
#include <utility>

namespace nook
{
namespace
{

constexpr int kStartTime_s = 300; // loading some 250 libraries on a busy machine

[[noreturn]] void cannotRun(const std::string& program, const std::string& why)
{
	throw Error(ExitCode::runtime,
				program + ": found that it cannot be started: " + why + ", expected memory and processes for this part of nook");
}

// Waits until a worker is ready.
void greet(const ChildProcess& worker, const std::string& program)
{
	int waits = 0;
	ValueReader greeting(worker.streams().from,
						 [&]
						 {
							 while (!waitForBytes(worker.streams().from))
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

// Throws Error: file if the program is missing, runtime if it cannot run.
std::unique_ptr<ChildProcess> startWorker(const std::string& program)
{
	const std::optional<std::string> path = pathOfWorker(program);
	refuseIf(!path, program + ": found no such program, expected this part of nook next to its libraries", ExitCode::file);
	std::unique_ptr<ChildProcess> worker;
	try
	{
		worker = std::make_unique<ChildProcess>(*path);
		greet(*worker, program);
		return worker;
	}
	catch (const std::system_error& error)
	{
		cannotRun(program, error.code().message());
	}
	catch (const StreamEnded& ended)
	{
		cannotRun(program, ended.found != nullptr ? ended.found : "it ends with status " + std::to_string(worker->end().status));
	}
}

constexpr int kWaitFactor = 5; // a busy machine may leave a process a fifth of a processor

// Exchanges the idle worker kept for the next call, one per program. A call takes it out and puts it back, so calls never share
// one.
std::unique_ptr<ChildProcess> exchangeKept(const std::string& program, std::unique_ptr<ChildProcess> worker)
{
	static std::mutex mutex;
	static std::map<std::string, std::unique_ptr<ChildProcess>> workers;
	const std::lock_guard lock(mutex);
	return std::exchange(workers[program], std::move(worker));
}

// Waits for a worker's answer, when called, and enforces its limits meanwhile.
std::function<void()> watchOf(const ChildProcess& worker, const std::optional<IsolationLimits>& limits)
{
	return [&worker, limits, before = worker.residentBytes(), waits = 0]() mutable // bytes at the start of the request
	{
		while (!waitForBytes(worker.streams().from))
		{
			waits += 1;
			if (limits && waits > kWaitsASecond * limits->processor_s * kWaitFactor)
			{
				throw StreamEnded{kTooLong};
			}
			const std::size_t bytes = worker.residentBytes();
			if (limits && bytes > before && bytes - before > limits->memory_bytes)
			{
				throw StreamEnded{kTooLarge};
			}
		}
	};
}

// Sends a function's name, its limits and its arguments.
void sendRequest(const ChildProcess& worker, const Isolated& what, const std::optional<IsolationLimits>& limits,
				 const std::function<void(ValueWriter&)>& ask)
{
	ValueWriter request(worker.streams().to);
	request.text(what.function);
	request.value(limits.has_value());
	request.value(limits.value_or(IsolationLimits{}));
	ask(request);
	request.finish(ExitCode::ok, "");
}

} // namespace

bool hasWorker(const char* program)
{
	try
	{
		std::unique_ptr<ChildProcess> kept = exchangeKept(program, nullptr);
		exchangeKept(program, kept != nullptr ? std::move(kept) : startWorker(program));
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
	std::unique_ptr<ChildProcess> worker = what.keep ? exchangeKept(what.program, nullptr) : nullptr;
	for (bool again = worker != nullptr;; again = false)
	{
		if (worker == nullptr)
		{
			worker = startWorker(what.program);
		}
		ValueReader answer(worker->streams().from, watchOf(*worker, limits));
		const auto keep = [&]
		{
			if (what.keep && answer.isFinished())
			{
				exchangeKept(what.program, std::move(worker));
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
			const char* const found = ended.found != nullptr ? ended.found : worker->end().stopped ? kTooLong : kBroken;
			worker.reset();
			if (!again || ended.found != nullptr)
			{
				const bool is_ours = !limits;
				refuseInput(name, found, is_ours ? "contents that can be processed" : "a complete file of its format",
							is_ours ? ExitCode::runtime : ExitCode::invalid_input);
			}
		}
	}
}

} // namespace nook
