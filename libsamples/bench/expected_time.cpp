// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/expected_time.h"

#include "core/number.h"
#include "core/text.h"

#include <algorithm>

namespace nook
{
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
