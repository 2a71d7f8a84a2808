// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/volumes.h"

#include <algorithm>
#include <cmath>

namespace nook
{

double Compensation::at(double sum) const
{
	const double last = static_cast<double>(occlusion.size() - 1);
	const double place = std::clamp(sum / range, 0.0, 1.0) * last;
	const auto knot = static_cast<std::size_t>(std::min(std::floor(place), last - 1.0));
	const double share = place - static_cast<double>(knot);
	return occlusion[knot] + share * (occlusion[knot + 1] - occlusion[knot]);
}

std::array<double, 33> Compensation::paper()
{
	std::array<double, 33> curve{};
	for (std::size_t i = 0; i < curve.size(); ++i)
	{
		const double x = static_cast<double>(i) / static_cast<double>(curve.size() - 1);
		curve[i] = x - 0.25 * x * x;
	}
	return curve;
}

} // namespace nook
