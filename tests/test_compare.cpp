// SPDX-License-Identifier: GPL-3.0-or-later
#include "testing.h"

#include "image/compare.h"
#include "image/drawing.h"
#include "image/visibility_image.h"

namespace
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

Picture uniform(int width, int height, double value)
{
	return {width, height,
			[value](int, int)
			{
				return value;
			}};
}

Picture noise(int width, int height, uint64_t seed)
{
	Random random(seed);
	return {width, height,
			[&](int, int)
			{
				return random.uniform();
			}};
}

// SSIM as in the paper: window by window, means first, then moments about them.
double slowSsim(const Picture& t, const Picture& r)
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

Comparison compared(const Picture& test, const Picture& reference, const CompareSettings& settings = {})
{
	return compareImages(test.plane(), reference.plane(), settings, {});
}

Image imageOf(std::vector<std::string> channels, std::vector<float> values, int width_px = 1)
{
	const int height = static_cast<int>(values.size() / channels.size()) / width_px;
	return {width_px, height, std::move(channels), std::move(values), {}, {}};
}

} // namespace

TEST_CASE("measure: equal pictures have no error", "[compare]")
{
	const Picture a = noise(31, 23, 1);
	const Comparison c = compared(a, a);
	CHECK(c.pixels == 31 * 23);
	for (const ErrorMetric metric : {ErrorMetric::rmse, ErrorMetric::mae, ErrorMetric::p95, ErrorMetric::max, ErrorMetric::ssim,
									 ErrorMetric::flip, ErrorMetric::eq14})
	{
		CHECK(errorBy(c, metric) == 0.0);
	}
	CHECK(c.mean_error == 0.0);
	CHECK(c.ssim == 1.0);
}

TEST_CASE("measure: a constant offset is every pointwise error", "[compare]")
{
	const Picture reference = uniform(20, 12, 0.75);
	const Comparison c = compared(uniform(20, 12, 0.5), reference);
	CHECK(c.rmse == 0.25);
	CHECK(c.mae == 0.25);
	CHECK(c.mean_error == -0.25);
	CHECK(c.p95 == 0.25);
	CHECK(c.max == 0.25);
	CHECK((c.worst.x == 0 && c.worst.y == 0));
	CHECK((c.worst.test == 0.5 && c.worst.reference == 0.75));
	// Zero variance: only SSIM's luminance term remains.
	CHECK(c.ssim.value() == Approx((2 * 0.375 + 1e-4) / (0.25 + 0.5625 + 1e-4)).epsilon(1e-12));
	const double ratio = std::log(129.0) - std::log(192.0); // 8 bits: 128 and 191
	CHECK(c.eq14 == Approx(ratio * ratio).epsilon(1e-12));
}

TEST_CASE("measure: black against white", "[compare]")
{
	const Comparison c = compared(uniform(20, 12, 0.0), uniform(20, 12, 1.0));
	CHECK(c.rmse == 1.0);
	CHECK(c.mean_error == -1.0);
	CHECK(c.ssim.value() == Approx(1e-4 / 1.0001).epsilon(1e-9));
	CHECK(c.flip == Approx(SlowFlip::colourError(100.0)).epsilon(1e-5));
	CHECK(c.flip == Approx(0.96738).epsilon(1e-5)); // by hand: 203.30^0.7 = 41.276 and 100^0.7 = 25.119
	CHECK(c.eq14 == Approx(std::pow(std::log(256.0), 2)).epsilon(1e-12));
	const Comparison back = compared(uniform(20, 12, 1.0), uniform(20, 12, 0.0));
	CHECK(back.flip == c.flip);
	CHECK(back.mean_error == 1.0);
}

TEST_CASE("measure: FLIP of uniform grays is their difference of lightness, compressed", "[compare]")
{
	for (const auto& [a, b] : {std::pair{0.5, 0.6}, std::pair{0.0, 0.02}, std::pair{0.9, 0.91}, std::pair{0.2, 0.9}})
	{
		const double difference = std::fabs(SlowFlip::lightnessOf(a) - SlowFlip::lightnessOf(b));
		CHECK(compared(uniform(9, 9, a), uniform(9, 9, b)).flip == Approx(SlowFlip::colourError(difference)).epsilon(5e-5));
	}
	// Values beyond black and white look the same.
	CHECK(compared(uniform(9, 9, 1.0), uniform(9, 9, 1.5)).flip == 0.0);
}

TEST_CASE("measure: SSIM and FLIP agree with slow twins", "[compare]")
{
	const Picture smooth(26, 19, [](int x, int y) { return 0.5 + 0.4 * std::sin(0.4 * x) * std::cos(0.3 * y); });
	const Picture step(26, 19, [](int x, int y) { return x + y < 20 ? 0.9 : 0.1; });
	const Picture rough = noise(26, 19, 7);
	for (const auto& [t, r] : {std::pair{&smooth, &step}, std::pair{&rough, &smooth}, std::pair{&step, &rough}})
	{
		CHECK(compared(*t, *r).ssim.value() == Approx(slowSsim(*t, *r)).epsilon(1e-9));
	}
	const double ppd = GENERATE(20.0, 67.0);
	CompareSettings settings;
	settings.pixels_per_degree = ppd;
	const SlowFlip slow(ppd);
	CHECK(compared(step, smooth, settings).flip == Approx(slow.mean(step, smooth)).epsilon(5e-5));
	CHECK(compared(rough, step, settings).flip == Approx(slow.mean(rough, step)).epsilon(5e-5));
}

TEST_CASE("measure: FLIP is symmetric, and a line counts for more than the same difference without one", "[compare]")
{
	const Picture flat = uniform(60, 60, 0.5);
	const Picture line(60, 60, [](int x, int) { return x == 30 ? 0.9 : 0.5; });
	CHECK(compared(line, flat).flip == compared(flat, line).flip);
	// Two gray levels: adjacent in one picture, and in pictures of their own.
	const Picture half(60, 60, [](int x, int) { return x < 30 ? 0.9 : 0.5; });
	const Picture other(60, 60, [](int x, int) { return x < 30 ? 0.5 : 0.9; });
	CHECK(compared(uniform(60, 60, 0.9), flat).flip ==
		  Approx(SlowFlip::colourError(SlowFlip::lightnessOf(0.9) - SlowFlip::lightnessOf(0.5))).epsilon(5e-5));
	CHECK(compared(half, flat).flip > 0.5 * compared(uniform(60, 60, 0.9), flat).flip);
	CHECK(compared(half, other).flip < compared(uniform(60, 60, 0.9), flat).flip); // mirrored, with equal, blurred edges
}

TEST_CASE("measure: AOV's eq. 14 by hand", "[compare]")
{
	const auto byte = [](double v)
	{
		return static_cast<float>(v / 255.0);
	};
	const Picture t(3, 2,
					[&](int x, int y) {
						return byte(std::array{0, 255, 10, 20, 30, 40}[static_cast<std::size_t>(3 * y + x)]);
					});
	const Picture r(3, 2,
					[&](int x, int y) {
						return byte(std::array{0, 128, 10, 20, 25, 40}[static_cast<std::size_t>(3 * y + x)]);
					});
	const auto l = [](double x)
	{
		return std::copysign(std::log(std::fabs(x) + 1.0), x);
	};
	const auto sq = [](double x)
	{
		return x * x;
	};
	const double values = (sq(l(255) - l(128)) + sq(l(30) - l(25))) / 6.0;
	const double right = (sq(l(255) - l(128)) + sq(l(-245) - l(-118)) + sq(l(10) - l(5)) + sq(l(10) - l(15))) / 4.0;
	const double down = sq(l(-225) - l(-103)) / 3.0;
	CHECK(compared(t, r).eq14 == Approx(values + 0.5 * (right + down)).epsilon(1e-12));
	// A single pixel has no neighbour differences.
	CHECK(compared(uniform(1, 1, 0.0), uniform(1, 1, 1.0)).eq14 == Approx(sq(std::log(256.0))));
}

TEST_CASE("measure: the 95th percentile and the greatest error", "[compare]")
{
	// Errors 0.01 to 1.00 in scrambled order.
	const Picture test(10, 10, [](int x, int y) { return 0.01 * ((37 * (10 * y + x)) % 100 + 1); });
	const Comparison c = compared(test, uniform(10, 10, 0.0));
	CHECK(c.p95 == static_cast<double>(0.95F));
	CHECK(c.max == 1.0);
	CHECK((37 * (10 * c.worst.y + c.worst.x)) % 100 == 99);
	CHECK(compared(uniform(3, 3, 0.0), uniform(3, 3, 0.5)).p95 == 0.5);
}

TEST_CASE("measure: pixels that do not count", "[compare]")
{
	Picture test = noise(40, 30, 3);
	const Picture reference = test;
	std::vector<uint8_t> counted(test.values.size(), 1);
	for (std::size_t i = 0; i < 40; ++i)
	{
		counted[i] = 0;
		test.values[i] = 1.0F - test.values[i];
	}
	CompareSettings settings{.counted = counted};
	const Comparison c = compared(test, reference, settings);
	CHECK(c.pixels == 40 * 29);
	CHECK(c.max == 0.0);
	CHECK(c.eq14 == 0.0);
	CHECK(compared(test, reference).max > 0.0);
}

TEST_CASE("measure: small pictures have no SSIM, the other errors they have", "[compare]")
{
	const Comparison c = compared(uniform(10, 40, 0.0), uniform(10, 40, 1.0));
	CHECK_FALSE(c.ssim.has_value());
	CHECK_FALSE(errorBy(c, ErrorMetric::ssim).has_value());
	CHECK(c.flip > 0.9);
}

TEST_CASE("measure: which channel is the visibility", "[compare]")
{
	const auto chosen = [](const Image& image, const std::string& wanted = "")
	{
		return visibilityOf(image, "a.exr", wanted);
	};
	CHECK(chosen(imageOf({"visibility", "standard_error"}, {0.5F, 0.1F})).channel == "visibility");
	CHECK(chosen(imageOf({"visibility", "standard_error"}, {0.5F, 0.1F})).standard_error == std::vector<float>{0.1F});
	CHECK(chosen(imageOf({"ao"}, {0.5F})).channel == "ao");
	CHECK(chosen(imageOf({"A", "ao"}, {1.0F, 0.5F})).values == std::vector<float>{0.5F});
	CHECK(chosen(imageOf({"Y", "Z"}, {0.5F, 2.0F})).channel == "Y");
	CHECK(chosen(imageOf({"R", "G", "B"}, {0.5F, 0.5F, 0.5F})).channel == "R,G,B");
	CHECK(chosen(imageOf({"R", "G", "B"}, {0.5F, 0.6F, 0.7F}), "G").values == std::vector<float>{0.6F});
	CHECK_THROWS_WITH(chosen(imageOf({"R", "G", "B"}, {0.5F, 0.5F, 0.6F})),
					  Catch::Contains("a.exr: channels: found R, G, B, expected"));
	CHECK_THROWS_WITH(chosen(imageOf({"a", "b"}, {0.5F, 0.5F})), Catch::Contains("found a, b, expected"));
	CHECK_THROWS_WITH(chosen(imageOf({"a", "b"}, {0.5F, 0.5F}), "c"), Catch::Contains("found a, b, expected c among them"));
}

TEST_CASE("measure: values that are no numbers are refused by their place", "[compare]")
{
	const float nan = std::numeric_limits<float>::quiet_NaN();
	const float inf = std::numeric_limits<float>::infinity();
	CHECK_THROWS_WITH(visibilityOf(imageOf({"visibility"}, {0.0F, 0.0F, 0.0F, nan}, 2), "a.exr", ""),
					  "a.exr: channel visibility, pixel 1,1: found NaN, expected a finite number");
	CHECK_THROWS_WITH(visibilityOf(imageOf({"visibility", "standard_error"}, {0.0F, inf}), "a.exr", ""),
					  "a.exr: channel standard_error, pixel 0,0: found infinity, expected a finite number");
	const VisibilityImage a = visibilityOf(imageOf({"Y"}, {0.0F, 0.0F}, 2), "a.exr", "");
	const VisibilityImage b = visibilityOf(imageOf({"Y"}, {0.0F, 0.0F}, 1), "b.exr", "");
	CHECK_THROWS_WITH(checkSameSize(a, b), "a.exr: size: found 2x1 pixels, expected 1x2 pixels as b.exr");
}

TEST_CASE("measure: the reference's own uncertainty", "[compare]")
{
	const VisibilityImage a = visibilityOf(imageOf({"visibility", "standard_error"}, {0.5F, 0.25F, 0.5F, 0.75F}), "a.exr", "");
	CHECK(ownUncertainty(a, {}).value() == Approx(std::sqrt((0.0625 + 0.5625) / 2.0)));
	const std::vector<uint8_t> counted{1, 0};
	CHECK(ownUncertainty(a, counted).value() == 0.25);
	CHECK_FALSE(ownUncertainty(visibilityOf(imageOf({"Y"}, {0.5F}), "a.exr", ""), {}).has_value());
}

TEST_CASE("emit: the picture of a difference shows sign, size and what does not count", "[compare]")
{
	const Picture reference = uniform(500, 4, 0.5);
	const Picture test(500, 4, [](int x, int) { return x < 100 ? 0.3 : x < 200 ? 0.7 : x < 300 ? 0.5 : 0.9; });
	std::vector<uint8_t> counted(test.values.size(), 1);
	for (std::size_t i = 0; i < counted.size(); ++i)
	{
		counted[i] = i % 500 < 400 ? 1 : 0;
	}
	const Image png = decodeImage(differencePng(test.plane(), reference.plane(), counted, 0.2, {}), "d.png");
	CHECK(png.width_px == 500); // already wide enough
	CHECK(png.height_px > 4);   // the legend
	const auto colour = [&](std::size_t x)
	{
		return std::array{png.at(x, 0), png.at(x, 1), png.at(x, 2)};
	};
	CHECK(colour(50)[2] > colour(50)[0]);   // darker: blue
	CHECK(colour(150)[0] > colour(150)[2]); // lighter: red
	CHECK(colour(250) == std::array{1.0F, 1.0F, 1.0F});
	CHECK(colour(350) == colour(150));       // beyond the range: clamped
	CHECK(colour(450)[0] == colour(450)[1]); // gray
	CHECK(colour(450)[1] == colour(450)[2]);
	// Small pictures are enlarged by an integer factor, so that the legend is legible.
	const Picture dot = uniform(3, 2, 0.5);
	const Image small = decodeImage(differencePng(dot.plane(), dot.plane(), {}, 0.2, {}), "d.png");
	CHECK(small.width_px >= 320);
	CHECK(small.height_px > 2 * 32);
}

TEST_CASE("emit: the range of a difference is round and holds 99 % of it", "[compare]")
{
	const Picture reference = uniform(10, 20, 0.0);
	const auto range = [&](double value, int outliers)
	{
		const Picture test(10, 20, [&](int x, int y) { return 10 * y + x < outliers ? 1.0 : value; });
		return differenceRange(test.plane(), reference.plane(), {});
	};
	CHECK(range(0.0, 0) == 0.001);
	CHECK(range(0.03, 0) == 0.05);
	CHECK(range(0.03, 2) == 0.05);
	CHECK(range(0.03, 3) == 1.0);
	CHECK(range(0.4, 0) == 0.5);
	CHECK(range(3.0, 0) == 1.0);
}
