// SPDX-License-Identifier: GPL-3.0-or-later
// Implementation with oneTBB.
#include "core/parallel.h"

#include "core/error.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace nook
{
namespace
{

// oneTBB terminates the program, from one of its threads, if it cannot start another. So start as many here first.
void checkThreads(int threads)
{
	static std::mutex mutex;
	static int checked = 1;
	const std::lock_guard lock(mutex);
	if (threads <= checked)
	{
		return;
	}
	std::mutex gate;
	std::unique_lock closed(gate);
	std::vector<std::thread> started;
	std::string failed;
	try
	{
		while (started.size() + 1 < static_cast<std::size_t>(threads))
		{
			started.emplace_back([&gate] { const std::lock_guard open(gate); });
		}
	}
	catch (const std::system_error& error)
	{
		failed = error.code().message();
	}
	const std::size_t count = started.size() + 1;
	closed.unlock();
	for (std::thread& thread : started)
	{
		thread.join();
	}
	refuseIf(!failed.empty(),
			 "threads: found " + std::to_string(count) + " that can be started (" + failed + "), expected " +
				 std::to_string(threads) + " (threads)",
			 ExitCode::runtime);
	checked = threads;
}

} // namespace

void parallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body)
{
	if (threads <= 1 || count <= 1)
	{
		for (std::size_t i = 0; i < count; ++i)
		{
			body(i);
		}
		return;
	}
	onThreads(threads, [&] { oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { body(i); }); });
}

void onThreads(int threads, const std::function<void()>& body)
{
	checkThreads(threads);
	// Without this oneTBB caps threads at the processor count and warns on stderr.
	const oneapi::tbb::global_control allowed(oneapi::tbb::global_control::max_allowed_parallelism,
											  static_cast<std::size_t>(threads));
	oneapi::tbb::task_arena arena(threads);
	arena.execute(body);
}

int availableThreads()
{
	return oneapi::tbb::info::default_concurrency();
}

} // namespace nook
