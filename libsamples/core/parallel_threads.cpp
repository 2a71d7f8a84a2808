// SPDX-License-Identifier: GPL-3.0-or-later
// Implementation with std::thread, where oneTBB is not available.
#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace nook
{
namespace
{

thread_local bool inside = false; // nested loops run on the current thread

// Starts up to `most` threads; if the system refuses more, those that started do the work.
std::vector<std::thread> startThreads(std::size_t most, const std::function<void()>& work)
{
	std::vector<std::thread> threads;
	try
	{
		while (threads.size() < most)
		{
			threads.emplace_back(work);
		}
	}
	catch (const std::system_error&)
	{
	}
	return threads;
}

} // namespace

void parallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body)
{
	std::atomic<std::size_t> next = 0;
	std::exception_ptr failure;
	std::mutex mutex;
	const auto work = [&]
	{
		const bool outer = inside;
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
		inside = outer;
	};
	const std::size_t wanted = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
	std::vector<std::thread> others = startThreads(inside || wanted == 0 ? 0 : wanted - 1, work);
	work();
	for (std::thread& other : others)
	{
		other.join();
	}
	if (failure)
	{
		std::rethrow_exception(failure);
	}
}

void onThreads(int /*threads*/, const std::function<void()>& body)
{
	body();
}

int availableThreads()
{
	return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

} // namespace nook
