// SPDX-License-Identifier: GPL-3.0-or-later
// A loop over independent items on a number of threads. Each item writes to its own place, so the result does not depend on it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace nook
{

// Calls body(i) for every i in [0, count), on at most `threads` threads (≥ 1). An exception of a body is rethrown.
// Throws Error (runtime) where so many threads cannot be started.
void parallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

inline constexpr std::size_t kParallelBlock = std::size_t{1} << 15U; // of items that take next to no time each

// The same for such items, a block of them at a time.
template <class Body> void parallelForAll(std::size_t count, int threads, const Body& body)
{
	parallelFor((count + kParallelBlock - 1) / kParallelBlock, threads,
				[&](std::size_t block)
				{
					for (std::size_t i = block * kParallelBlock; i < std::min(count, (block + 1) * kParallelBlock); ++i)
					{
						body(i);
					}
				});
}

// Calls body() once; loops that a library runs inside of it (TBB) use at most `threads` threads (≥ 1).
// Throws as above.
void onThreads(int threads, const std::function<void()>& body);

// Processors this process may use, at least 1.
int availableThreads();

} // namespace nook
