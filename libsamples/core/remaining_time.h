// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates the remaining time of a stage.
#pragma once

#include <optional>

namespace nook
{

// Extrapolates the speed over the last half to three quarters of the elapsed time. Tiles and search rounds vary in cost: the whole
// past would react too late, the last moment alone would be jumpy.
class RemainingTime
{
public:
	// Seconds since the stage began and its finished share, 0 to 1. Neither may decrease.
	void add(double elapsed_s, double share)
	{
		if (!(share > m_last.share))
		{
			return;
		}
		m_last = {elapsed_s, share};
		if (elapsed_s > 2.0 * m_newer.elapsed_s)
		{
			m_older = m_newer;
			m_newer = m_last;
		}
		const double rate = (share - m_older.share) / (elapsed_s - m_older.elapsed_s);
		m_left_s = (1.0 - share) / rate;
	}

	// Returns nothing in the first second, before any progress, or once the last estimate has been exceeded.
	std::optional<double> at(double elapsed_s) const
	{
		const double left_s = m_left_s - (elapsed_s - m_last.elapsed_s);
		if (m_last.share == 1.0)
		{
			return 0.0;
		}
		return elapsed_s >= kSoonest_s && m_last.share > 0.0 && left_s > 0.0 ? std::optional(left_s) : std::nullopt;
	}

private:
	static constexpr double kSoonest_s = 1.0;

	struct Mark
	{
		double elapsed_s = 0.0;
		double share = 0.0;
	};
	Mark m_older;
	Mark m_newer;
	Mark m_last;
	double m_left_s = 0.0;
};

} // namespace nook
