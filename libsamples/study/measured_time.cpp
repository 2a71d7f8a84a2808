// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/measured_time.h"

#include "core/decimal.h"
#include "core/parallel.h"
#include "core/system.h"
#include "core/text.h"

#include <algorithm>
#include <vector>

namespace nook
{
namespace
{

using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kSpin{60}; // a few turns of a scheduler
constexpr std::chrono::seconds kPause{6};

double secondsSince(SteadyClock::time_point start)
{
	return std::chrono::duration<double>(SteadyClock::now() - start).count();
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
					const SteadyClock::time_point start = SteadyClock::now();
					while (SteadyClock::now() - start < kSpin)
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
	if (m_last && SteadyClock::now() - *m_last < kPause)
	{
		return;
	}
	m_sum += takenByOthers(m_threads);
	m_looks += 1;
	m_last = SteadyClock::now();
}

std::string busyText(double share)
{
	return share < kBusyShare ? std::string()
							  : "the machine was busy: other programs took about " + fixedText(100.0 * share, 0) +
									" % of the processors, so times are longer and less steady than on a quiet one";
}

namespace
{

constexpr int kLeastHeight_px = 64;

} // namespace

TooSlow::TooSlow(double expected, double limit)
	: Error(ExitCode::unsupported,
			"stopped: a picture would take about " + roundedText(expected, 2) + " s, more than " + roundedText(limit, 3) + " s"),
	  expected_s(expected)
{
}

double expectedSeconds(const std::function<double(int, int)>& draw, int width_px, int height_px, double limit_s)
{
	double expected_s = 0.0;
	double last_s = 0.0;
	double last_pixels = 0.0;
	const double all = static_cast<double>(width_px) * height_px;
	for (const int part : {16, 8, 4})
	{
		if (height_px < kLeastHeight_px)
		{
			break;
		}
		const int width = std::max(1, width_px / part);
		const int height = std::max(1, height_px / part);
		const double seconds = draw(width, height);
		const double pixels = static_cast<double>(width) * height;
		const double each_s = last_pixels > 0.0 ? std::max(0.0, seconds - last_s) / (pixels - last_pixels) : 0.0;
		expected_s = seconds + each_s * (all - pixels);
		if (expected_s > limit_s)
		{
			break;
		}
		last_s = seconds;
		last_pixels = pixels;
	}
	return expected_s;
}

} // namespace nook
