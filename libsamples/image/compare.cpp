// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/compare.h"

#include "core/lists.h"
#include "core/math.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>

namespace nook
{
namespace
{

struct RowErrors
{
	PixelTally error;
	PixelTally magnitude;
	PixelTally square;
	double greatest = -1.0;
	std::size_t where = 0;

	RowErrors& operator+=(const RowErrors& row)
	{
		error += row.error;
		magnitude += row.magnitude;
		square += row.square;
		if (row.greatest > greatest)
		{
			greatest = row.greatest;
			where = row.where;
		}
		return *this;
	}
};

// Errors that depend on single pixels only.
void pointwise(Comparison& result, const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
			   const RunSettings& run)
{
	const auto width = static_cast<std::size_t>(test.width_px);
	std::vector<RowErrors> rows(static_cast<std::size_t>(test.height_px));
	std::vector<double> magnitudes(test.values.size());
	const auto errorAt = [&](std::size_t i)
	{
		return static_cast<double>(test.values[i]) - static_cast<double>(reference.values[i]);
	};
	parallelFor(rows.size(), run.threads,
				[&](std::size_t y)
				{
					RowErrors& row = rows[y];
					for (std::size_t i = y * width; i < (y + 1) * width; ++i)
					{
						if (!counts(counted, i))
						{
							magnitudes[i] = -1.0;
							continue;
						}
						const double error = errorAt(i);
						magnitudes[i] = std::fabs(error);
						row.error.add(error);
						row.magnitude.add(magnitudes[i]);
						row.square.add(error * error);
						if (magnitudes[i] > row.greatest)
						{
							row.greatest = magnitudes[i];
							row.where = i;
						}
					}
				});
	const RowErrors sum = sumOver(rows);
	assert(sum.error.count > 0);
	const auto count = static_cast<double>(sum.error.count);
	result.pixels = sum.error.count;
	result.rmse = std::sqrt(sum.square.sum / count);
	result.mae = sum.magnitude.sum / count;
	result.mean_error = sum.error.sum / count;
	result.max = sum.greatest;
	result.worst = {static_cast<int>(sum.where % width), static_cast<int>(sum.where / width),
					static_cast<double>(test.values[sum.where]), static_cast<double>(reference.values[sum.where])};
	// Nearest rank: the ⌈0.95 n⌉th of the counted pixels, in integer arithmetic.
	std::erase(magnitudes, -1.0);
	const std::size_t rank = (19 * magnitudes.size() + 19) / 20;
	const auto at = magnitudes.begin() + static_cast<std::ptrdiff_t>(rank - 1);
	std::nth_element(magnitudes.begin(), at, magnitudes.end());
	result.p95 = *at;
}

// This work is based on: Morgan McGuire, "Ambient Occlusion Volumes", High Performance Graphics, 2010, eq. 14.

int byteOf(const VisibilityPlane& plane, std::size_t pixel)
{
	return static_cast<int>(std::floor(255.0 * std::clamp(static_cast<double>(plane.values[pixel]), 0.0, 1.0) + 0.5));
}

double squared(double x)
{
	return x * x;
}

// Squared errors of a row: of values, of differences to the right, and of differences downwards.
struct Terms
{
	PixelTally value;
	PixelTally right;
	PixelTally down;
};

double mean(const PixelTally& tally)
{
	return tally.count == 0 ? 0.0 : tally.sum / static_cast<double>(tally.count);
}

// Separable filters over bands of rows, so that a picture of any height needs memory for only a few rows. A kernel: weights of 2 ×
// radius + 1 neighbours, starting at −radius.
struct Kernel
{
	int radius = 0;
	std::vector<double> weights;
};

// exp(−x²/(2σ²)), normalised to sum 1.
Kernel gaussianKernel(double sigma_px, int radius)
{
	const auto weightOf = [&](int i)
	{
		return expOf(-0.5 * i * i / (sigma_px * sigma_px));
	};
	Kernel kernel{radius, mapped(countingFrom(-radius, 2 * static_cast<std::size_t>(radius) + 1), weightOf)};
	const double sum = sumOver(kernel.weights);
	for (double& weight : kernel.weights)
	{
		weight /= sum;
	}
	return kernel;
}

// Rows [first, last) of a picture.
struct Band
{
	int width_px = 0;
	int height_px = 0; // height of the whole picture
	int first = 0;
	int last = 0;
};

constexpr int kBandRows = 64;

// The picture's rows in bands of kBandRows.
std::vector<Band> bandsOf(int width_px, int height_px)
{
	std::vector<Band> bands;
	for (int first = 0; first < height_px; first += kBandRows)
	{
		bands.push_back({width_px, height_px, first, std::min(first + kBandRows, height_px)});
	}
	return bands;
}

// Writes row y of the picture, 0 ≤ y < height.
using RowSource = std::function<void(int y, std::span<double> row)>;

// Extends the row by `radius` copies of its end pixels on either side.
void extend(std::vector<double>& row, int radius, int width)
{
	const auto begin = row.begin() + radius;
	const auto end = begin + width;
	std::fill(row.begin(), begin, *begin);
	std::fill(end, row.end(), *(end - 1));
}

// A band of the filtered picture: kernel_x along rows, kernel_y along columns (correlation: the weight of offset k applies to the
// pixel at x + k). Border pixels are repeated.
std::vector<double> filteredBand(const Band& band, const RowSource& source, const Kernel& kernel_x, const Kernel& kernel_y)
{
	const auto width = static_cast<std::size_t>(band.width_px);
	const auto rows = static_cast<std::size_t>(band.last - band.first);
	std::vector<double> result(rows * width, 0.0);
	std::vector<double> wide(width + 2 * static_cast<std::size_t>(kernel_x.radius));
	std::vector<double> filtered(width);
	const int top = std::max(0, band.first - kernel_y.radius);
	const int bottom = std::min(band.height_px, band.last + kernel_y.radius);
	for (int y = top; y < bottom; ++y)
	{
		source(y, std::span(wide).subspan(static_cast<std::size_t>(kernel_x.radius), width));
		extend(wide, kernel_x.radius, band.width_px);
		std::fill(filtered.begin(), filtered.end(), 0.0);
		for (std::size_t k = 0; k < kernel_x.weights.size(); ++k)
		{
			const double weight = kernel_x.weights[k];
			for (std::size_t x = 0; x < width; ++x)
			{
				filtered[x] += weight * wide[x + k];
			}
		}
		// The first and the last row of the picture also represent those beyond it.
		const int from = y == 0 ? -kernel_y.radius : y;
		const int to = y == band.height_px - 1 ? y + kernel_y.radius : y;
		for (int at = from; at <= to; ++at)
		{
			for (int out = std::max(band.first, at - kernel_y.radius); out < std::min(band.last, at + kernel_y.radius + 1); ++out)
			{
				const double weight = kernel_y.weights[static_cast<std::size_t>(at - out + kernel_y.radius)];
				double* const target = result.data() + static_cast<std::size_t>(out - band.first) * width;
				for (std::size_t x = 0; x < width; ++x)
				{
					target[x] += weight * filtered[x];
				}
			}
		}
	}
	return result;
}

// This work is based on: Zhou Wang, Alan C. Bovik, Hamid R. Sheikh, Eero P. Simoncelli, "Image Quality Assessment: From Error
// Visibility to Structural Similarity", IEEE Transactions on Image Processing, 2004.

constexpr int kWindow = 5;     // §III-C: 11 × 11
constexpr double kSigma = 1.5; // §III-C
constexpr double kC1 = 1e-4;   // (K1 L)², K1 = 0.01
constexpr double kC2 = 9e-4;   // (K2 L)², K2 = 0.03

double rowValue(const VisibilityPlane& plane, int y, std::size_t x)
{
	return static_cast<double>(plane.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width_px) + x]);
}

// Weighted means of f(test, reference).
template <class Function>
std::vector<double> means(const Band& band, const VisibilityPlane& test, const VisibilityPlane& reference, const Kernel& kernel,
						  Function f)
{
	const RowSource source = [&](int y, std::span<double> row)
	{
		for (std::size_t x = 0; x < row.size(); ++x)
		{
			row[x] = f(rowValue(test, y, x), rowValue(reference, y, x));
		}
	};
	return filteredBand(band, source, kernel, kernel);
}

// SSIM (Wang et al. 2004): windows of 11 × 11 pixels, Gaussian of σ = 1.5, K1 = 0.01, K2 = 0.03, L = 1; the mean over counted
// pixels whose window lies inside the picture, as in the authors' program. None if there is no such pixel.
std::optional<double> meanSsim(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
							   const RunSettings& run)
{
	assert(test.width_px == reference.width_px && test.height_px == reference.height_px);
	const Kernel kernel = gaussianKernel(kSigma, kWindow);
	const std::vector<Band> bands = bandsOf(test.width_px, test.height_px);
	std::vector<PixelTally> rows(static_cast<std::size_t>(test.height_px));
	ProgressCounter progress(run.progress, "ssim", bands.size());
	parallelFor(bands.size(), run.threads,
				[&](std::size_t b)
				{
					const Band& band = bands[b];
					const auto of = [&](auto f)
					{
						return means(band, test, reference, kernel, f);
					};
					// Eqs. 14 to 16. The mean of products minus the product of means loses precision only in nearly flat windows,
					// where C2 dominates.
					const std::vector<double> mean_t = of([](double t, double) { return t; });
					const std::vector<double> mean_r = of([](double, double r) { return r; });
					const std::vector<double> square_t = of([](double t, double) { return t * t; });
					const std::vector<double> square_r = of([](double, double r) { return r * r; });
					const std::vector<double> product = of([](double t, double r) { return t * r; });
					const auto width = static_cast<std::size_t>(test.width_px);
					for (int y = std::max(band.first, kWindow); y < std::min(band.last, test.height_px - kWindow); ++y)
					{
						for (std::size_t x = kWindow; x + kWindow < width; ++x)
						{
							if (!counts(counted, static_cast<std::size_t>(y) * width + x))
							{
								continue;
							}
							const std::size_t i = static_cast<std::size_t>(y - band.first) * width + x;
							const double tt = mean_t[i] * mean_t[i];
							const double rr = mean_r[i] * mean_r[i];
							const double tr = mean_t[i] * mean_r[i];
							// Eq. 13
							rows[static_cast<std::size_t>(y)].add(
								(2.0 * tr + kC1) * (2.0 * (product[i] - tr) + kC2) /
								((tt + rr + kC1) * (square_t[i] - tt + (square_r[i] - rr) + kC2)));
						}
					}
					progress.finishOne();
				});
	const PixelTally sum = sumOver(rows);
	return sum.count == 0 ? std::nullopt : std::optional(sum.sum / static_cast<double>(sum.count));
}

// This work is based on: Pontus Andersson, Jim Nilsson, Tomas Akenine-Möller, Magnus Oskarsson, Kalle Åström, Mark D. Fairchild,
// "FLIP: A Difference Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques,
// 2020.
//
// Gray pictures only. With R = G = B the opponent channels Cx and Cz are 0, and Y of YCxCz is 116 × linear luminance − 16, so the
// contrast sensitivity filter acts on linear luminance only and a* = b* = 0. For gray pictures this is the complete method.

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
	std::transform(x.begin(), x.end(), y.begin(), x.begin(), [](double a, double b) { return std::sqrt(a * a + b * b); });
	return x;
}

Seen seen(const Band& band, const VisibilityPlane& plane, const Filters& filters)
{
	// Converts the rows around the band to linear once.
	const int reach = std::max(filters.contrast.radius, filters.smooth.radius);
	const int top = std::max(0, band.first - reach);
	const int bottom = std::min(band.height_px, band.last + reach);
	const auto width = static_cast<std::size_t>(band.width_px);
	const auto rows = plane.values.subspan(static_cast<std::size_t>(top) * width, static_cast<std::size_t>(bottom - top) * width);
	const std::vector<double> linear = mapped(rows, [](float value) { return linearOf(static_cast<double>(value)); });
	const RowSource source = [&](int y, std::span<double> row)
	{
		std::copy_n(linear.begin() + (y - top) * band.width_px, row.size(), row.begin());
	};
	return {filteredBand(band, source, filters.contrast, filters.contrast), strength(band, source, filters.edge, filters.smooth),
			strength(band, source, filters.point, filters.smooth)};
}

} // namespace

Comparison compareImages(const VisibilityPlane& test, const VisibilityPlane& reference, const CompareSettings& settings,
						 const RunSettings& run)
{
	assert(test.width_px == reference.width_px && test.height_px == reference.height_px);
	assert(test.values.size() == reference.values.size() && !test.values.empty());
	assert(settings.counted.empty() || settings.counted.size() == test.values.size());
	Comparison result;
	pointwise(result, test, reference, settings.counted, run);
	result.ssim = meanSsim(test, reference, settings.counted, run);
	result.flip = meanFlip(test, reference, settings.counted, settings.pixels_per_degree, run);
	result.eq14 = logError(test, reference, settings.counted, run);
	return result;
}

std::optional<double> errorBy(const Comparison& comparison, ErrorMetric metric)
{
	switch (metric)
	{
	case ErrorMetric::rmse: return comparison.rmse;
	case ErrorMetric::mae: return comparison.mae;
	case ErrorMetric::p95: return comparison.p95;
	case ErrorMetric::max: return comparison.max;
	case ErrorMetric::ssim: return comparison.ssim ? std::optional(1.0 - *comparison.ssim) : std::nullopt;
	case ErrorMetric::flip: return comparison.flip;
	case ErrorMetric::eq14: return comparison.eq14;
	}
	return std::nullopt;
}

double logError(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
				const RunSettings& run)
{
	assert(test.width_px == reference.width_px && test.height_px == reference.height_px);
	const std::vector<double> logs = listOf(256, [](std::size_t x) { return logOf(static_cast<double>(x) + 1.0); });
	const auto log = [&logs](int x) // log†(x) = sign(x) log(|x| + 1), from −255 to 255
	{
		return std::copysign(logs[static_cast<std::size_t>(std::abs(x))], x);
	};
	const auto width = static_cast<std::size_t>(test.width_px);
	const auto height = static_cast<std::size_t>(test.height_px);
	std::vector<Terms> rows(height);
	parallelFor(height, run.threads,
				[&](std::size_t y)
				{
					for (std::size_t x = 0; x < width; ++x)
					{
						const std::size_t i = y * width + x;
						if (!counts(counted, i))
						{
							continue;
						}
						const int t = byteOf(test, i);
						const int r = byteOf(reference, i);
						const auto difference = [&](std::size_t next)
						{
							return squared(log(byteOf(test, next) - t) - log(byteOf(reference, next) - r));
						};
						rows[y].value.add(squared(log(t) - log(r)));
						if (x + 1 < width && counts(counted, i + 1))
						{
							rows[y].right.add(difference(i + 1));
						}
						if (y + 1 < height && counts(counted, i + width))
						{
							rows[y].down.add(difference(i + width));
						}
					}
				});
	Terms sum;
	for (const Terms& row : rows)
	{
		sum.value += row.value;
		sum.right += row.right;
		sum.down += row.down;
	}
	return mean(sum.value) + 0.5 * (mean(sum.right) + mean(sum.down));
}

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
	const PixelTally sum = sumOver(rows);
	return sum.sum / static_cast<double>(sum.count);
}

} // namespace nook
