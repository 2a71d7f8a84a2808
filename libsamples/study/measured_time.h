// SPDX-License-Identifier: GPL-3.0-or-later
// How far times can be trusted: how much of the processors other programs take, and how long a picture would take to draw.
#pragma once

#include "core/error.h"

#include <chrono>
#include <functional>
#include <optional>
#include <string>

namespace nook
{

// Less is the system's own.
inline constexpr double kBusyShare = 0.1;

// Returns the share of that many processors that other programs take, 0 to 1: keeps all of them busy for 60 ms and compares the
// time that its threads had. 0 where the system does not tell.
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

// Returns a warning about times that were measured then; empty where few processors were taken.
std::string busyText(double share);

// A candidate that is not drawn, since that would take too long.
struct TooSlow : Error
{
	TooSlow(double expected, double limit);

	double expected_s;
};

// Seconds of a picture of that size, by two drawings of a sixteenth and an eighth of its sides and one of a quarter, and the line
// through the last two: a part of each drawing does not depend on the pixels. As soon as one tells of more than the limit, no
// larger one is drawn. 0 for a picture that is too small for that (less than 64 pixels high).
double expectedSeconds(const std::function<double(int width_px, int height_px)>& draw, int width_px, int height_px, double limit_s);

} // namespace nook
