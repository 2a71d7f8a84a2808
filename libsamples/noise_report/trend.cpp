// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/trend.h"

#include "core/math.h"

namespace nook
{

std::optional<PowerFit> fitPower(const MeasureByCount& values, int first_count)
{
	int n = 0;
	double sum_x = 0.0;
	double sum_y = 0.0;
	double sum_xx = 0.0;
	double sum_xy = 0.0;
	for (const auto& [count, value] : values)
	{
		if (count >= first_count && value > kNegligible)
		{
			const double x = logOf(count);
			const double y = logOf(value);
			n += 1;
			sum_x += x;
			sum_y += y;
			sum_xx += x * x;
			sum_xy += x * y;
		}
	}
	if (n < 4)
	{
		return std::nullopt;
	}
	const double slope = (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
	return PowerFit{expOf((sum_y - slope * sum_x) / n), -slope};
}

std::optional<double> localRatio(const MeasureByCount& values, int count, double exponent)
{
	const auto usable = [&](int n)
	{
		const auto found = values.find(n);
		return found != values.end() && found->second > kNegligible ? found->second : 0.0;
	};
	const double value = usable(count);
	if (value == 0.0)
	{
		return std::nullopt;
	}
	double sum = 0.0;
	int neighbours = 0;
	for (const int side : {-1, 1})
	{
		int here = 0;
		for (int step = 1; step <= 4 && here < 2; ++step)
		{
			const int other = count + side * step;
			if (const double v = other > 0 ? usable(other) : 0.0; v > 0.0)
			{
				sum += logOf(v) + exponent * logOf(static_cast<double>(other) / count);
				here += 1;
			}
		}
		if (here == 0)
		{
			return std::nullopt;
		}
		neighbours += here;
	}
	return value / expOf(sum / neighbours);
}

} // namespace nook
