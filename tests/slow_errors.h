// SPDX-License-Identifier: GPL-3.0-or-later
// Small pictures from a formula, and straightforward reference implementations of the errors between them.
#pragma once

#include "testing.h"

#include "core/random.h"
#include "image/compare.h"

namespace nook
{

struct Picture
{
	int width_px;
	int height_px;
	std::vector<float> values;

	Picture(int width, int height, const std::function<double(int, int)>& f) : width_px(width), height_px(height)
	{
		for (int y = 0; y < height; ++y)
		{
			for (int x = 0; x < width; ++x)
			{
				values.push_back(static_cast<float>(f(x, y)));
			}
		}
	}
	VisibilityPlane plane() const
	{
		return {width_px, height_px, values};
	}
	double at(int x, int y) const
	{
		const int cx = std::clamp(x, 0, width_px - 1);
		const int cy = std::clamp(y, 0, height_px - 1);
		return static_cast<double>(values[static_cast<std::size_t>(cy * width_px + cx)]);
	}
};

inline Picture uniform(int width, int height, double value)
{
	return {width, height,
			[value](int, int)
			{
				return value;
			}};
}

inline Picture noise(int width, int height, uint64_t seed)
{
	Random random(seed);
	return {width, height,
			[&](int, int)
			{
				return random.uniform();
			}};
}

// SSIM as in the paper: window by window, means first, then moments about them.
inline double slowSsim(const Picture& t, const Picture& r)
{
	double sum = 0.0;
	int count = 0;
	for (int cy = 5; cy < t.height_px - 5; ++cy)
	{
		for (int cx = 5; cx < t.width_px - 5; ++cx)
		{
			double weights = 0.0;
			double mt = 0.0;
			double mr = 0.0;
			const auto window = [&](const auto& f)
			{
				for (int y = -5; y <= 5; ++y)
				{
					for (int x = -5; x <= 5; ++x)
					{
						f(std::exp(-(x * x + y * y) / 4.5), t.at(cx + x, cy + y), r.at(cx + x, cy + y));
					}
				}
			};
			window([&](double w, double a, double b) { weights += w, mt += w * a, mr += w * b; });
			mt /= weights;
			mr /= weights;
			double vt = 0.0;
			double vr = 0.0;
			double c = 0.0;
			window(
				[&](double w, double a, double b)
				{
					vt += w / weights * (a - mt) * (a - mt);
					vr += w / weights * (b - mr) * (b - mr);
					c += w / weights * (a - mt) * (b - mr);
				});
			sum += (2 * mt * mr + 1e-4) * (2 * c + 9e-4) / ((mt * mt + mr * mr + 1e-4) * (vt + vr + 9e-4));
			count += 1;
		}
	}
	return sum / count;
}

// FLIP in colour, step by step as in the paper, with two-dimensional filters.
class SlowFlip
{
public:
	using Vector = std::array<double, 3>;

	explicit SlowFlip(double ppd) : m_ppd(ppd) {}

	double mean(const Picture& test, const Picture& reference) const
	{
		double sum = 0.0;
		for (int y = 0; y < test.height_px; ++y)
		{
			for (int x = 0; x < test.width_px; ++x)
			{
				const double feature = std::max(std::fabs(feature1(test, x, y) - feature1(reference, x, y)),
												std::fabs(feature2(test, x, y) - feature2(reference, x, y)));
				const double colour = colourError(hyab(seen(test, x, y), seen(reference, x, y)));
				sum += std::pow(colour, 1.0 - std::sqrt(feature / std::sqrt(2.0)));
			}
		}
		return sum / (test.width_px * test.height_px);
	}

	static double colourError(double distance)
	{
		// L*, a*, b* of sRGB's green and blue primaries from tables, Hunt-adjusted.
		const Vector green{87.7347, -86.1827 * 0.877347, 83.1793 * 0.877347};
		const Vector blue{32.2970, 79.1875 * 0.322970, -107.8602 * 0.322970};
		const double most = std::pow(hyab(green, blue), 0.7);
		const double error = std::pow(distance, 0.7);
		return error < 0.4 * most ? 0.95 / (0.4 * most) * error : 0.95 + (error - 0.4 * most) / (0.6 * most) * 0.05;
	}

	static double lightnessOf(double display)
	{
		const double linear = linearOf(display);
		return linear > 216.0 / 24389.0 ? 116.0 * std::cbrt(linear) - 16.0 : linear * 24389.0 / 27.0;
	}

private:
	static double linearOf(double v)
	{
		return v > 0.04045 ? std::pow((v + 0.055) / 1.055, 2.4) : v / 12.92;
	}

	static double hyab(const Vector& a, const Vector& b)
	{
		return std::fabs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
	}

	// Opponent colour of a gray pixel through X, Y and Z relative to white.
	static Vector opponent(const Picture& p, int x, int y)
	{
		const double v = linearOf(p.at(x, y));
		const Vector white{0.95047, 1.0, 1.08883};
		const Vector xyz{v * (0.4124564 + 0.3575761 + 0.1804375) / white[0], v * (0.2126729 + 0.7151522 + 0.0721750) / white[1],
						 v * (0.0193339 + 0.1191920 + 0.9503041) / white[2]};
		return {116.0 * xyz[1] - 16.0, 500.0 * (xyz[0] - xyz[1]), 200.0 * (xyz[1] - xyz[2])};
	}

	Vector seen(const Picture& p, int x, int y) const
	{
		const std::array<std::array<double, 4>, 3> csf{
			{{1.0, 0.0047, 0.0, 1e-5}, {1.0, 0.0053, 0.0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};
		const double pi = std::acos(-1.0);
		const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * pi * pi)) * m_ppd));
		Vector value{};
		for (std::size_t c = 0; c < 3; ++c)
		{
			double weights = 0.0;
			for (int dy = -radius; dy <= radius; ++dy)
			{
				for (int dx = -radius; dx <= radius; ++dx)
				{
					const double d2 = (dx * dx + dy * dy) / (m_ppd * m_ppd);
					const auto& [a1, b1, a2, b2] = csf[c];
					const double w = a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * d2 / b1) +
									 a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * d2 / b2);
					value[c] += w * opponent(p, x + dx, y + dy)[c];
					weights += w;
				}
			}
			value[c] /= weights;
		}
		const double luminance = std::clamp((value[0] + 16.0) / 116.0, 0.0, 1.0);
		const auto root = [](double t)
		{
			return t > 216.0 / 24389.0 ? std::cbrt(t) : t * 841.0 / 108.0 + 4.0 / 29.0;
		};
		const double l = 116.0 * root(luminance) - 16.0;
		const double a = 500.0 * (root(luminance + value[1] / 500.0) - root(luminance));
		const double b = 200.0 * (root(luminance) - root(luminance - value[2] / 200.0));
		return {l, 0.01 * l * a, 0.01 * l * b};
	}

	double feature1(const Picture& p, int x, int y) const
	{
		return feature(p, x, y, [](double d, double) { return -d; });
	}

	double feature2(const Picture& p, int x, int y) const
	{
		return feature(p, x, y, [](double d, double sigma) { return d * d / (sigma * sigma) - 1.0; });
	}

	template <class Factor> double feature(const Picture& p, int x, int y, Factor factor) const
	{
		const double sigma = 0.5 * 0.082 * m_ppd;
		const int radius = static_cast<int>(std::ceil(3.0 * sigma));
		std::array<double, 2> positive{};
		std::array<double, 2> negative{};
		double above = 0.0;
		double below = 0.0;
		for (int dy = -radius; dy <= radius; ++dy)
		{
			for (int dx = -radius; dx <= radius; ++dx)
			{
				const double w = factor(dx, sigma) * std::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma));
				(w > 0.0 ? above : below) += w;
				const double along = (opponent(p, x + dx, y + dy)[0] + 16.0) / 116.0;
				const double across = (opponent(p, x + dy, y + dx)[0] + 16.0) / 116.0;
				auto& sums = w > 0.0 ? positive : negative;
				sums[0] += w * along;
				sums[1] += w * across;
			}
		}
		return std::hypot(positive[0] / above - negative[0] / below, positive[1] / above - negative[1] / below);
	}

	double m_ppd;
};

} // namespace nook
