// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/busy_machine.h"

#include "core/parallel.h"
#include "core/system.h"
#include "core/text.h"

#include <algorithm>
#include <vector>

namespace nook
{
namespace
{

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kSpin{60}; // a few turns of a scheduler
constexpr std::chrono::seconds kPause{6};

double secondsSince(Clock::time_point start)
{
	return std::chrono::duration<double>(Clock::now() - start).count();
}

} // namespace

double takenByOthers(int threads)
{
	const auto count = static_cast<std::size_t>(std::max(threads, 1));
	std::vector<double> had(count); // shares; an item takes a thread for as long as it spins, so each has its own
	parallelFor(count, threads,
				[&](std::size_t i)
				{
					const double before = threadSeconds();
					const Clock::time_point start = Clock::now();
					while (Clock::now() - start < kSpin)
					{
					}
					had[i] = before < 0.0 ? 1.0 : (threadSeconds() - before) / secondsSince(start);
				});
	double sum = 0.0;
	for (const double share : had)
	{
		sum += std::clamp(share, 0.0, 1.0);
	}
	return 1.0 - sum / static_cast<double>(count);
}

void BusyWatch::look()
{
	if (m_last && Clock::now() - *m_last < kPause)
	{
		return;
	}
	m_sum += takenByOthers(m_threads);
	m_looks += 1;
	m_last = Clock::now();
}

std::string busyText(double share)
{
	return share < kBusyShare ? std::string()
							  : "the machine was busy: other programs took about " + fixedText(100.0 * share, 0) +
									" % of the processors, so times are longer and less steady than on a quiet one";
}

} // namespace nook
