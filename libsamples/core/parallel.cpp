// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/parallel.h"

#ifdef NOOK_TBB
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#else
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>
#endif

namespace nook
{
namespace
{

#ifdef NOOK_TBB

void runOnThreads(std::size_t count, int threads, const std::function<void(std::size_t)>& body)
{
	onThreads(threads, [&] { oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { body(i); }); });
}

#else

thread_local bool inside = false; // a loop inside a loop has its thread already

void runOnThreads(std::size_t count, int threads, const std::function<void(std::size_t)>& body)
{
	std::atomic<std::size_t> next = 0;
	std::exception_ptr failure;
	std::mutex mutex;
	const auto work = [&]
	{
		inside = true;
		try
		{
			for (std::size_t i = next++; i < count; i = next++)
			{
				body(i);
			}
		}
		catch (...)
		{
			next = count;
			const std::lock_guard lock(mutex);
			failure = failure ? failure : std::current_exception();
		}
		inside = false;
	};
	std::vector<std::thread> others;
	try
	{
		while (!inside && others.size() + 1 < std::min(count, static_cast<std::size_t>(threads)))
		{
			others.emplace_back(work);
		}
	}
	catch (const std::system_error&) // no more are to be had: those that are do the work
	{
	}
	const bool nested = inside;
	work();
	inside = nested;
	for (std::thread& other : others)
	{
		other.join();
	}
	if (failure)
	{
		std::rethrow_exception(failure);
	}
}

#endif

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
	runOnThreads(count, threads, body);
}

#ifdef NOOK_TBB

void onThreads(int threads, const std::function<void()>& body)
{
	// Without this oneTBB refuses more threads than processors, and says so on stderr.
	const oneapi::tbb::global_control allowed(oneapi::tbb::global_control::max_allowed_parallelism,
											  static_cast<std::size_t>(threads));
	oneapi::tbb::task_arena arena(threads);
	arena.execute(body);
}

int availableThreads()
{
	return oneapi::tbb::info::default_concurrency();
}

#else

void onThreads(int /*threads*/, const std::function<void()>& body)
{
	body();
}

int availableThreads()
{
	return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

#endif

} // namespace nook
