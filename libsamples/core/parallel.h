// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel loop over independent items. Each item writes to its own place, so the result does not depend on the thread count.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace nook
{

// Calls body(i) for every i in [0, count) on at most `threads` threads (≥ 1). Rethrows a body's exception. Throws Error (runtime)
// if the threads cannot be started.
void parallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

inline constexpr std::size_t kParallelBlock = std::size_t{1} << 15U; // block size for very cheap items

// parallelFor for very cheap items, processed in blocks.
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

// Calls body() once; parallel loops inside it (TBB) use at most `threads` threads (≥ 1). Throws as parallelFor.
void onThreads(int threads, const std::function<void()>& body);

// Processors this process may use, at least 1.
int availableThreads();

} // namespace nook
