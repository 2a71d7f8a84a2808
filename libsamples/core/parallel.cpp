// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace nook
{

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

} // namespace nook
