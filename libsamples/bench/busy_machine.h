// SPDX-License-Identifier: GPL-3.0-or-later
// How much of the processors other programs take while times are measured.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace nook
{

// Less is the system's own.
inline constexpr double kBusyShare = 0.1;

// Of so many processors, 0 to 1: keeps them busy for 60 ms, and compares what its threads had with that. 0 where the system does
// not tell.
double takenByOthers(int threads);

// Looks now and then, so that it takes a hundredth of the time.
class BusyWatch
{
public:
	explicit BusyWatch(int threads) : m_threads(threads) {}

	// Between measurements, as often as one likes.
	void look();

	// The mean over all looks; 0 before the first.
	double share() const
	{
		return m_looks > 0 ? m_sum / m_looks : 0.0;
	}

private:
	int m_threads;
	int m_looks = 0;
	double m_sum = 0.0;
	std::optional<std::chrono::steady_clock::time_point> m_last;
};

// What is wrong with times that were measured then; empty where little is.
std::string busyText(double share);

} // namespace nook
