// SPDX-License-Identifier: GPL-3.0-or-later
#include "pattern/quality.h"

#include "core/lists.h"
#include "core/math.h"
#include "core/parallel.h"
#include "core/random.h"
#include "pattern/cells.h"
#include "pattern/energy.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace nook
{
namespace
{

// Grid sizes of FORMULAS, "Measures of a pattern".
constexpr int kHeights = 24;
constexpr int kOffsets = 40;
constexpr int kAzimuths = 97;
constexpr int kCliffOffsets = 200;
constexpr int kOpenings = 24;
constexpr int kCornersPerOpening = 384;
constexpr int kCapDirections = 2048;
const double kGoldenRatio = 0.5 * (std::sqrt(5.0) - 1.0);

double middle(int k, int count, double low, double high)
{
	return low + (high - low) * (k + 0.5) / count;
}

// Azimuth k of a cell; the first one advances by the golden ratio from cell to cell.
SinCos azimuth(int k, int cell)
{
	return sinCosOf(2.0 * kPi * (k + fraction(cell * kGoldenRatio)) / kAzimuths);
}

double lowestHeight(Domain domain)
{
	return domain == Domain::disk ? 0.0 : -1.0;
}

// Sums over the azimuths of one cell of the plane grid.
struct CellSums
{
	double error = 0.0;    // Σ (A − V)
	double square = 0.0;   // Σ (A − V)²
	double greatest = 0.0; // |A − V|
};

CellSums sumCell(const Estimator& estimator, Domain domain, int height, int offset)
{
	const double n_z = middle(height, kHeights, lowestHeight(domain), 1.0);
	const double c = middle(offset, kOffsets, -1.0, 1.0);
	const double sine = std::sqrt((1.0 - n_z) * (1.0 + n_z));
	const double exact = freeShare(domain, n_z, c);
	CellSums sums;
	for (int k = 0; k < kAzimuths; ++k)
	{
		const SinCos turn = azimuth(k, height * kOffsets + offset);
		const double error = estimator.estimate({sine * turn.cos, sine * turn.sin, n_z}, c) - exact;
		sums.error += error;
		sums.square += error * error;
		sums.greatest = std::max(sums.greatest, std::fabs(error));
	}
	return sums;
}

struct PlaneSums
{
	double plane2 = 0.0;
	double bias2 = 0.0;
	double greatest = 0.0;
};

PlaneSums sumPlanes(const Pattern& pattern, const RunSettings& run)
{
	const Estimator estimator(pattern);
	std::vector<CellSums> cells(static_cast<std::size_t>(kHeights) * kOffsets);
	ProgressCounter progress(run.progress, "planes", cells.size());
	parallelFor(cells.size(), run.threads,
				[&](std::size_t k)
				{
					cells[k] = sumCell(estimator, pattern.domain, static_cast<int>(k) / kOffsets, static_cast<int>(k) % kOffsets);
					progress.finishOne();
				});
	// The rotation is about the view axis or the normal; in the ball and on the sphere it is arbitrary, so that only c remains.
	const bool any_rotation = pattern.domain == Domain::ball || pattern.domain == Domain::sphere;
	PlaneSums sums;
	const double count = static_cast<double>(cells.size()) * kAzimuths;
	for (int offset = 0; offset < kOffsets; ++offset)
	{
		double error = 0.0;
		for (int height = 0; height < kHeights; ++height)
		{
			const CellSums& cell = cells[static_cast<std::size_t>(height * kOffsets + offset)];
			sums.plane2 += cell.square / count;
			sums.greatest = std::max(sums.greatest, cell.greatest);
			error += cell.error;
			if (!any_rotation)
			{
				const double mean = cell.error / kAzimuths;
				sums.bias2 += mean * mean / static_cast<double>(cells.size());
			}
		}
		if (any_rotation)
		{
			const double mean = error / (kHeights * kAzimuths);
			sums.bias2 += mean * mean / kOffsets;
		}
	}
	return sums;
}

void measureCliff(const Estimator& estimator, Quality& quality)
{
	double square = 0.0;
	double greatest = 0.0;
	for (int offset = 0; offset < kCliffOffsets; ++offset)
	{
		const double d = middle(offset, kCliffOffsets, -1.0, 1.0);
		const double exact = 0.25 * (2.0 - 3.0 * d + d * d * d);
		for (int k = 0; k < kAzimuths; ++k)
		{
			const SinCos turn = azimuth(k, offset);
			const double error = estimator.estimateBeyond(turn.cos, turn.sin, d) - exact;
			square += error * error;
			greatest = std::max(greatest, std::fabs(error));
		}
	}
	quality.cliff = std::sqrt(square / (kCliffOffsets * kAzimuths));
	quality.cliff_greatest = greatest;
}

double measureCentre(const Estimator& estimator, Domain domain)
{
	double square = 0.0;
	for (int height = 0; height < kHeights; ++height)
	{
		const double n_z = middle(height, kHeights, lowestHeight(domain), 1.0);
		const double sine = std::sqrt((1.0 - n_z) * (1.0 + n_z));
		for (int k = 0; k < kAzimuths; ++k)
		{
			const SinCos turn = azimuth(k, height);
			const double error = estimator.estimate({sine * turn.cos, sine * turn.sin, n_z}, 0.0) - 0.5;
			square += error * error;
		}
	}
	return std::sqrt(square / (kHeights * kAzimuths));
}

// Two unit normals at the angle `between`, rotated by a uniformly distributed rotation (Shoemake 1992) from Halton's sequence.
void cornerNormals(unsigned index, double between, glm::dvec3& n1, glm::dvec3& n2)
{
	const double u = radicalInverse(index, 2);
	const SinCos a = sinCosOf(2.0 * kPi * radicalInverse(index, 3));
	const SinCos b = sinCosOf(2.0 * kPi * radicalInverse(index, 5));
	const double x = std::sqrt(1.0 - u) * a.sin;
	const double y = std::sqrt(1.0 - u) * a.cos;
	const double z = std::sqrt(u) * b.sin;
	const double w = std::sqrt(u) * b.cos;
	const glm::dvec3 first(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y));
	const glm::dvec3 second(2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x));
	const SinCos turn = sinCosOf(between);
	n1 = first;
	n2 = turn.cos * first + turn.sin * second;
}

double measureCrease(const Estimator& estimator)
{
	double square = 0.0;
	for (int opening = 0; opening < kOpenings; ++opening)
	{
		const double angle = middle(opening, kOpenings, 30.0, 175.0) * kPi / 180.0;
		int taken = 0;
		for (unsigned index = 1; taken < kCornersPerOpening; ++index)
		{
			glm::dvec3 n1;
			glm::dvec3 n2;
			cornerNormals(index, kPi - angle, n1, n2);
			if (n1.z > 1e-3 && n2.z > 1e-3) // a depth buffer shows only front faces
			{
				const double error = estimator.estimateCorner(n1, n2) - angle / (2.0 * kPi);
				square += error * error;
				taken += 1;
			}
		}
	}
	return std::sqrt(square / (kOpenings * kCornersPerOpening));
}

// The greatest error over the caps around one direction, evaluated just below and at every point's height.
double greatestCap(const Pattern& pattern, const glm::dvec3& n)
{
	std::vector<std::pair<double, double>> heights =
		listOf(pattern.count(), [&](std::size_t i) { return std::pair(glm::dot(n, pattern.points[i]), pattern.weights[i]); });
	std::sort(heights.begin(), heights.end());
	double below = 0.0;
	double greatest = 0.0;
	for (const auto& [height, weight] : heights)
	{
		const double exact = freeShare(pattern.domain, n.z, std::clamp(height, -1.0, 1.0));
		greatest = std::max({greatest, std::fabs(below - exact), std::fabs(below + weight - exact)});
		below += weight;
	}
	return greatest;
}

double measureCap(const Pattern& pattern, const RunSettings& run)
{
	std::vector<glm::dvec3> directions;
	for (int k = 0; k < kCapDirections; ++k)
	{
		const double z = middle(k, kCapDirections, -1.0, 1.0);
		const double r = std::sqrt((1.0 - z) * (1.0 + z));
		const SinCos turn = sinCosOf(2.0 * kPi * fraction(k * kGoldenRatio));
		directions.emplace_back(r * turn.cos, r * turn.sin, z);
	}
	for (std::size_t i = 0; i < std::min<std::size_t>(pattern.count(), kCapDirections); ++i)
	{
		directions.push_back(glm::normalize(pattern.points[i]));
	}
	std::vector<double> greatest(directions.size());
	parallelFor(directions.size(), run.threads, [&](std::size_t k) { greatest[k] = greatestCap(pattern, directions[k]); });
	return *std::max_element(greatest.begin(), greatest.end());
}

// Closed form over all planes.
double squareOf(const Pattern& pattern, const RunSettings& run)
{
	return squaredError(pattern.domain, Ensemble::plane, Part::whole, pattern.points, pattern.weights, nullptr, run.threads);
}

void measureDistances(const Pattern& pattern, Quality& quality)
{
	double least2 = std::numeric_limits<double>::infinity();
	for (std::size_t i = 0; i < pattern.count(); ++i)
	{
		for (std::size_t j = i + 1; j < pattern.count(); ++j)
		{
			const glm::dvec3 difference = pattern.points[i] - pattern.points[j];
			const double d2 = glm::dot(difference, difference);
			least2 = std::min(least2, d2);
			quality.energy += d2 > 0.0 ? powOf(d2, -0.5 * quality.energy_exponent) : std::numeric_limits<double>::infinity();
		}
	}
	quality.smallest_distance = pattern.count() > 1 ? std::sqrt(least2) : 0.0;
}

double acosOf(double x)
{
	x = std::clamp(x, -1.0, 1.0);
	return atan2Of(std::sqrt((1.0 - x) * (1.0 + x)), x);
}

// Cosine-weighted measure of the cap n·x > c above the horizon, over π: the area of its projection on the ground, by Green's
// theorem over the part of its circle above the horizon (|t| ≤ t0) and the part of the horizon inside it (|ψ| ≤ ψ0).
double cosineCap(double n_z, double c)
{
	const double sine = std::sqrt(std::max(0.0, (1.0 - n_z) * (1.0 + n_z)));
	const double s = std::sqrt(std::max(0.0, (1.0 - c) * (1.0 + c)));
	if (sine < 1e-12) // straight up or down
	{
		return n_z > 0.0 ? (c >= 0.0 ? s * s : 1.0) : (c >= 0.0 ? 0.0 : 1.0 - s * s);
	}
	const double psi0 = acosOf(c / sine);
	if (s < 1e-12)
	{
		return psi0 / kPi;
	}
	const double t0 = acosOf(-c * n_z / (s * sine));
	return (t0 * s * s * n_z - c * s * sine * sinCosOf(t0).sin + psi0) / kPi;
}

constexpr std::array<int, 3> kBegun{2, 4, 8}; // frames in means that have just begun

} // namespace

Quality measurePattern(const Pattern& pattern, const RunSettings& run, double exponent)
{
	Quality quality;
	const PlaneSums planes = sumPlanes(pattern, run);
	quality.plane = std::sqrt(planes.plane2);
	quality.bias = std::sqrt(planes.bias2);
	quality.noise = std::sqrt(std::max(0.0, planes.plane2 - planes.bias2));
	quality.greatest = planes.greatest;
	quality.plane_exact = std::sqrt(std::max(0.0, squareOf(pattern, run)));
	const Estimator estimator(pattern);
	if (pattern.domain == Domain::disk)
	{
		measureCliff(estimator, quality);
		quality.crease = measureCrease(estimator);
	}
	if (isDirectional(pattern.domain))
	{
		quality.cap = measureCap(pattern, run);
	}
	else
	{
		quality.centre = measureCentre(estimator, pattern.domain);
	}
	quality.spread = relativeSpread(exactCells(pattern.domain, pattern.points, pattern.powers).integrals);
	quality.energy_exponent = exponent > 0.0 ? exponent : isDirectional(pattern.domain) ? 1.0 : 3.0;
	measureDistances(pattern, quality);
	return quality;
}

double errorBehind(const PatternTile& tile, const std::vector<TileShares>& shares, const RunSettings& run)
{
	TileShares mean;
	for (const TileShares& one : shares)
	{
		addShares(mean, one, 1.0 / static_cast<double>(shares.size()));
	}
	const Pattern all = unionOf(tile, 1.0);
	ProgressCounter progress(run.progress, "pairs", mean.pairs.size());
	return std::sqrt(std::max(0.0, tileSquaredError(tile.domain, mean, all.points, all.weights, nullptr, run.threads, &progress)));
}

TileQuality measureTile(const PatternTile& tile, const Pattern& base, const RunSettings& run)
{
	TileQuality quality;
	const auto count = static_cast<double>(tile.variants.front().count());
	const auto variants = static_cast<double>(tile.variants.size());
	const Pattern whole = unionOf(tile, variants);
	if (variants * count * count <= kQuickSteps)
	{
		double mean_square = 0.0;
		double worst_square = 0.0;
		ProgressCounter progress(run.progress, "variants", tile.variants.size());
		for (const Pattern& variant : tile.variants)
		{
			const double square = squareOf(variant, run);
			mean_square += square / variants;
			worst_square = std::max(worst_square, square);
			progress.finishOne();
		}
		quality.variant_plane = std::sqrt(std::max(0.0, mean_square));
		quality.worst_variant = std::sqrt(std::max(0.0, worst_square));
	}
	if (variants * count <= std::sqrt(kQuickSteps))
	{
		if (tile.domain != Domain::slice)
		{
			quality.window = std::sqrt(sumPlanes(whole, run).plane2);
		}
		quality.window_exact = std::sqrt(std::max(0.0, squareOf(whole, run)));
	}
	quality.base_plane = std::sqrt(std::max(0.0, squareOf(base, run)));
	return quality;
}

double freeShare(Domain domain, double n_z, double c)
{
	switch (domain)
	{
	case Domain::sphere: return 0.5 * (1.0 + c);
	case Domain::hemisphere: return 1.0 - cosineCap(n_z, c);
	case Domain::disk:
	case Domain::ball:
	case Domain::slice: break;
	}
	return 0.25 * (1.0 + c) * (1.0 + c) * (2.0 - c);
}

Estimator::Estimator(const Pattern& pattern) : m_lines(pattern.domain == Domain::disk), m_weight(pattern.weights)
{
	for (const glm::dvec3& p : pattern.points)
	{
		m_x.push_back(p.x);
		m_y.push_back(p.y);
		m_z.push_back(p.z);
		// A line at the rim has zero length; a tiny one keeps the quotient finite and makes it a step.
		m_half.push_back(std::sqrt(std::max(1e-18, 1.0 - p.x * p.x - p.y * p.y)));
	}
}

double Estimator::linesFree(const glm::dvec3& n, double c) const
{
	double sum = 0.0;
	const double scale = 0.5 / n.z;
	for (std::size_t i = 0; i < m_weight.size(); ++i)
	{
		const double share = 0.5 + (c - n.x * m_x[i] - n.y * m_y[i]) * scale / m_half[i];
		sum += m_weight[i] * std::min(1.0, std::max(0.0, share));
	}
	return sum;
}

double Estimator::estimate(const glm::dvec3& n, double c) const
{
	if (m_lines)
	{
		return linesFree(n, c);
	}
	double sum = 0.0;
	for (std::size_t i = 0; i < m_weight.size(); ++i)
	{
		const double gap = c - (n.x * m_x[i] + n.y * m_y[i] + n.z * m_z[i]);
		sum += m_weight[i] * (gap > 0.0 ? 1.0 : gap == 0.0 ? 0.5 : 0.0);
	}
	return sum;
}

double Estimator::estimateBeyond(double m_x_axis, double m_y_axis, double d) const
{
	double sum = 0.0;
	for (std::size_t i = 0; i < m_weight.size(); ++i)
	{
		const double gap = m_x_axis * m_x[i] + m_y_axis * m_y[i] - d;
		sum += m_weight[i] * (gap > 0.0 ? 1.0 : gap == 0.0 ? 0.5 : 0.0);
	}
	return sum;
}

double Estimator::estimateCorner(const glm::dvec3& n1, const glm::dvec3& n2) const
{
	double sum = 0.0;
	for (std::size_t i = 0; i < m_weight.size(); ++i)
	{
		const double depth1 = -(n1.x * m_x[i] + n1.y * m_y[i]) / n1.z;
		const double depth2 = -(n2.x * m_x[i] + n2.y * m_y[i]) / n2.z;
		const double share = 0.5 + 0.5 * std::min(depth1, depth2) / m_half[i];
		sum += m_weight[i] * std::min(1.0, std::max(0.0, share));
	}
	return sum;
}

std::vector<Measure> measuresBehind(const PatternTile& tile, const std::vector<TileFilter>& filters, double ema, double most_steps,
									const RunSettings& run)
{
	std::vector<Measure> measures;
	const TileTime time{tile.frames, ema, tile.moves};
	const std::size_t count = tile.variants.front().count();
	const std::vector<int> lasts = itemsWhere(kBegun, [&](int last) { return last < tile.frames; });
	ProgressCounter progress(run.progress, "behind filters", filters.size() * (tile.frames > 1 ? 5 + lasts.size() : 2));
	for (const TileFilter& filter : filters)
	{
		const auto error = [&](const std::vector<TileFilter>& parts, int last, glm::ivec2 pan) -> std::optional<double>
		{
			std::vector<TileShares> shares;
			double steps = 0.0;
			for (const TileFilter& part : parts)
			{
				steps += stepsOfShares(tile.size, part, time, pan != glm::ivec2(0));
				if (steps > most_steps)
				{
					return std::nullopt;
				}
				shares.push_back(sharesOf(tile.size, part, time, last, pan));
			}
			return stepsOfError(shares.front(), count) <= most_steps ? std::optional(errorBehind(tile, shares, run)) : std::nullopt;
		};
		const auto add = [&](const std::string& name, const std::vector<TileFilter>& parts, int last, glm::ivec2 pan)
		{
			if (const std::optional<double> found = error(parts, last, pan))
			{
				measures.push_back({filter.name + name, *found});
			}
			progress.finishOne();
		};
		add("", {filter}, 1, {0, 0});
		add(", half", halvesOf(filter), 1, {0, 0});
		if (tile.frames > 1)
		{
			add(", frames", {filter}, 0, {0, 0});
			add(", frames, panned", {filter}, 0, {1, 0});
			for (const int last : lasts)
			{
				add(", first " + std::to_string(last), {filter}, last, {0, 0});
			}
			add(", cycle", {filter}, tile.frames, {0, 0});
		}
	}
	return measures;
}

} // namespace nook
