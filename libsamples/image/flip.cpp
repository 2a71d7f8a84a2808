// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Pontus Andersson, Jim Nilsson, Tomas Akenine-Möller, Magnus Oskarsson, Kalle Åström, Mark D. Fairchild,
// "FLIP: A Difference Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques,
// 2020.
//
// Gray pictures only. With R = G = B the opponent channels Cx and Cz are 0, and Y of YCxCz is 116 × linear luminance − 16, so the
// contrast sensitivity filter acts on linear luminance only and a* = b* = 0. For gray pictures this is the complete method.
#include "core/math.h"
#include "core/parallel.h"
#include "image/compare.h"
#include "pattern/filter_band.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace nook
{
namespace
{

// §4.1.1, table 1: exp(−π² x² / b) with x in degrees. The support is that of the paper's widest filter.
constexpr double kContrastAchromatic = 0.0047;
constexpr double kContrastWidest = 0.04;

constexpr double kColourExponent = 0.7; // qc, §4.1.3
constexpr double kColourKnee = 0.4;     // pc
constexpr double kColourShare = 0.95;   // pt
constexpr double kFeatureWidth_deg = 0.082;
constexpr double kFeatureExponent = 0.5; // qf, §4.2.2

double linearOf(double display)
{
	// IEC 61966-2-1
	const double v = std::clamp(display, 0.0, 1.0);
	return v > 0.04045 ? powOf((v + 0.055) / 1.055, 2.4) : v / 12.92;
}

// CIE 1976's f, with L* = 116 f − 16.
double lightnessRoot(double t)
{
	const double delta = 6.0 / 29.0;
	return t > delta * delta * delta ? powOf(t, 1.0 / 3.0) : t / (3.0 * delta * delta) + 4.0 / 29.0;
}

double lightness(double linear)
{
	return 116.0 * lightnessRoot(linear) - 16.0;
}

// L*, a*, b* of an sRGB primary, from its column of the matrix to XYZ; a* and b* after Hunt's adjustment (× L*/100).
std::array<double, 3> huntAdjusted(const std::array<double, 3>& xyz, const std::array<double, 3>& white)
{
	const double x = lightnessRoot(xyz[0] / white[0]);
	const double y = lightnessRoot(xyz[1] / white[1]);
	const double z = lightnessRoot(xyz[2] / white[2]);
	const double l = 116.0 * y - 16.0;
	return {l, 0.01 * l * 500.0 * (x - y), 0.01 * l * 200.0 * (y - z)};
}

// §4.1.3: the greatest possible colour difference, between green and blue, compressed.
double greatestColourError()
{
	// Columns of the matrix from linear sRGB to XYZ in the authors' programs, as fractions.
	const std::array<double, 3> red{10135552.0 / 24577794.0, 2613072.0 / 12288897.0, 1425312.0 / 73733382.0};
	const std::array<double, 3> green{8788810.0 / 24577794.0, 8788810.0 / 12288897.0, 8788810.0 / 73733382.0};
	const std::array<double, 3> blue{4435075.0 / 24577794.0, 887015.0 / 12288897.0, 70074185.0 / 73733382.0};
	const std::array<double, 3> white{red[0] + green[0] + blue[0], red[1] + green[1] + blue[1], red[2] + green[2] + blue[2]};
	const std::array<double, 3> g = huntAdjusted(green, white);
	const std::array<double, 3> b = huntAdjusted(blue, white);
	// HyAB: city-block between lightness and Euclidean chroma.
	const double distance = std::fabs(g[0] - b[0]) + std::sqrt((g[1] - b[1]) * (g[1] - b[1]) + (g[2] - b[2]) * (g[2] - b[2]));
	return powOf(distance, kColourExponent);
}

// §4.1.3: compresses the difference, then maps 0…knee × greatest to 0…0.95 and the rest to 0.95…1.
double colourError(double lightness_difference, double greatest)
{
	const double error = lightness_difference > 0.0 ? powOf(lightness_difference, kColourExponent) : 0.0;
	const double knee = kColourKnee * greatest;
	return error < knee ? kColourShare / knee * error : kColourShare + (error - knee) / (greatest - knee) * (1.0 - kColourShare);
}

// Scales positive weights to sum 1 and negative ones to sum −1.
void balance(Kernel& kernel)
{
	double positive = 0.0;
	double negative = 0.0;
	for (const double weight : kernel.weights)
	{
		(weight > 0.0 ? positive : negative) += weight;
	}
	for (double& weight : kernel.weights)
	{
		weight /= weight > 0.0 ? positive : -negative;
	}
}

struct Filters
{
	Kernel contrast;
	Kernel smooth; // across the feature
	Kernel edge;   // first derivative of a Gaussian, along it
	Kernel point;  // second derivative
};

Filters filtersFor(double pixels_per_degree)
{
	Filters filters;
	const double widest_deg = std::sqrt(kContrastWidest / (2.0 * kPi * kPi)); // standard deviation
	const double sigma_deg = std::sqrt(kContrastAchromatic / (2.0 * kPi * kPi));
	filters.contrast =
		gaussianKernel(sigma_deg * pixels_per_degree, static_cast<int>(std::ceil(3.0 * widest_deg * pixels_per_degree)));
	// §4.2.1
	const double sigma = 0.5 * kFeatureWidth_deg * pixels_per_degree;
	const int radius = static_cast<int>(std::ceil(3.0 * sigma));
	filters.smooth = gaussianKernel(sigma, radius);
	filters.edge = filters.smooth;
	filters.point = filters.smooth;
	for (int i = -radius; i <= radius; ++i)
	{
		const auto k = static_cast<std::size_t>(i + radius);
		filters.edge.weights[k] *= -i;
		filters.point.weights[k] *= i * i / (sigma * sigma) - 1.0;
	}
	balance(filters.edge);
	balance(filters.point);
	return filters;
}

// FLIP's features of one picture.
struct Seen
{
	std::vector<double> luminance; // linear, after the contrast sensitivity filter
	std::vector<double> edges;     // strength
	std::vector<double> points;
};

std::vector<double> strength(const Band& band, const RowSource& source, const Kernel& along, const Kernel& across)
{
	std::vector<double> x = filteredBand(band, source, along, across);
	const std::vector<double> y = filteredBand(band, source, across, along);
	for (std::size_t i = 0; i < x.size(); ++i)
	{
		x[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
	}
	return x;
}

Seen seen(const Band& band, const VisibilityPlane& plane, const Filters& filters)
{
	// Converts the rows around the band to linear once.
	const int reach = std::max(filters.contrast.radius, filters.smooth.radius);
	const int top = std::max(0, band.first - reach);
	const int bottom = std::min(band.height_px, band.last + reach);
	const auto width = static_cast<std::size_t>(band.width_px);
	std::vector<double> linear(static_cast<std::size_t>(bottom - top) * width);
	for (std::size_t i = 0; i < linear.size(); ++i)
	{
		linear[i] = linearOf(static_cast<double>(plane.values[static_cast<std::size_t>(top) * width + i]));
	}
	const RowSource source = [&](int y, std::span<double> row)
	{
		std::copy_n(linear.begin() + (y - top) * band.width_px, row.size(), row.begin());
	};
	return {filteredBand(band, source, filters.contrast, filters.contrast), strength(band, source, filters.edge, filters.smooth),
			strength(band, source, filters.point, filters.smooth)};
}

} // namespace

double meanFlip(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
				double pixels_per_degree, const RunSettings& run)
{
	assert(test.width_px == reference.width_px && test.height_px == reference.height_px);
	const Filters filters = filtersFor(pixels_per_degree);
	const double greatest = greatestColourError();
	const std::vector<Band> bands = bandsOf(test.width_px, test.height_px);
	std::vector<PixelTally> rows(static_cast<std::size_t>(test.height_px));
	ProgressCounter progress(run.progress, "flip", bands.size());
	parallelFor(bands.size(), run.threads,
				[&](std::size_t b)
				{
					const Band& band = bands[b];
					const Seen t = seen(band, test, filters);
					const Seen r = seen(band, reference, filters);
					const auto width = static_cast<std::size_t>(test.width_px);
					for (std::size_t i = 0; i < t.luminance.size(); ++i)
					{
						const std::size_t pixel = static_cast<std::size_t>(band.first) * width + i;
						if (!counts(counted, pixel))
						{
							continue;
						}
						const double colour = colourError(std::fabs(lightness(std::clamp(t.luminance[i], 0.0, 1.0)) -
																	lightness(std::clamp(r.luminance[i], 0.0, 1.0))),
														  greatest);
						// §4.2.2
						const double feature = std::max(std::fabs(t.edges[i] - r.edges[i]), std::fabs(t.points[i] - r.points[i])) /
											   std::numbers::sqrt2;
						const double feature_error = feature > 0.0 ? powOf(feature, kFeatureExponent) : 0.0;
						// §4.3: features amplify a colour difference.
						rows[pixel / width].add(colour > 0.0 ? powOf(colour, 1.0 - feature_error) : 0.0);
					}
					progress.finishOne();
				});
	const PixelTally sum = total(rows);
	return sum.sum / static_cast<double>(sum.count);
}

} // namespace nook
