// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (AOV), eq. 14. Most of it is differences between pixels:
// volumes add steeper ones than rays have, so the curve that is nearest point by point is not the one with the least error.
#include "volume/picture_error.h"

#include "core/math.h"
#include "scene/camera_choice.h"
#include "volume/eye.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <optional>

namespace nook
{
namespace
{

// log†(x) of eq. 14.
double signedLog(double x)
{
	return x < 0.0 ? -logOf(1.0 - x) : logOf(1.0 + x);
}

constexpr uint64_t kAllKnots = ~uint64_t{0};

uint64_t knotsFrom(std::size_t first, std::size_t end)
{
	return ((uint64_t{1} << end) - 1) & ~((uint64_t{1} << first) - 1);
}

// The error's three means for a curve, and for others of the same range that differ from it by some knots.
class Meter
{
public:
	Meter(const Compensation& curve, std::span<const TripleValues> triples, CurveMeasure measure)
		: m_triples(triples), m_measure(measure), m_terms(triples.size())
	{
		const std::size_t last = curve.occlusion.size() - 1;
		for (const TripleValues& triple : triples)
		{
			Expected expected;
			expected.value =
				m_measure == CurveMeasure::rmse ? 1.0 - triple.occlusions[0] : signedLog(255.0 * (1.0 - triple.occlusions[0]));
			for (std::size_t i = 0; i < 3; ++i)
			{
				const double place = std::clamp(triple.sums[i] / curve.range, 0.0, 1.0) * static_cast<double>(last); // as the curve
				const std::size_t knot = std::min(static_cast<std::size_t>(place), last - 1);
				expected.knots |= knotsFrom(knot, knot + 2);
			}
			for (std::size_t i = 0; i < 2; ++i)
			{
				expected.steps[i] = signedLog(255.0 * (triple.occlusions[0] - triple.occlusions[i + 1]));
				m_steps[i] += triple.there[i + 1] ? 1.0 : 0.0;
			}
			m_expected.push_back(expected);
		}
		m_error = error(curve, kAllKnots);
		take();
	}

	// Of the curve that was taken last.
	double error() const
	{
		return m_taken;
	}

	// Of one that differs from that by these knots at most.
	double error(const Compensation& curve, uint64_t knots)
	{
		m_trial = m_terms;
		Terms sum;
		for (std::size_t k = 0; k < m_triples.size(); ++k)
		{
			if ((m_expected[k].knots & knots) != 0)
			{
				m_trial[k] = termsOf(curve, k);
			}
			sum.value += m_trial[k].value;
			sum.steps[0] += m_trial[k].steps[0];
			sum.steps[1] += m_trial[k].steps[1];
		}
		const auto mean = [](double of, double count)
		{
			return count > 0.0 ? of / count : 0.0;
		};
		m_error = mean(sum.value, static_cast<double>(m_triples.size())) +
				  0.5 * (mean(sum.steps[0], m_steps[0]) + mean(sum.steps[1], m_steps[1]));
		return m_error;
	}

	// The curve that was asked last.
	void take()
	{
		m_terms.swap(m_trial);
		m_taken = m_error;
	}

private:
	struct Terms
	{
		double value = 0.0;
		std::array<double, 2> steps{};
	};
	struct Expected
	{
		double value = 0.0;
		std::array<double, 2> steps{};
		uint64_t knots = 0; // that its values lie between
	};
	static double squared(double x)
	{
		return x * x;
	}
	Terms termsOf(const Compensation& curve, std::size_t k) const
	{
		const TripleValues& triple = m_triples[k];
		const double here = 255.0 * (1.0 - curve.at(triple.sums[0]));
		Terms terms;
		if (m_measure == CurveMeasure::rmse)
		{
			terms.value = squared(here / 255.0 - m_expected[k].value);
			return terms;
		}
		terms.value = squared(signedLog(here) - m_expected[k].value);
		for (std::size_t i = 0; i < 2; ++i)
		{
			if (triple.there[i + 1])
			{
				const double there = 255.0 * (1.0 - curve.at(triple.sums[i + 1]));
				terms.steps[i] = squared(signedLog(there - here) - m_expected[k].steps[i]);
			}
		}
		return terms;
	}

	std::span<const TripleValues> m_triples;
	CurveMeasure m_measure;
	std::vector<Expected> m_expected;
	std::array<double, 2> m_steps{};
	std::vector<Terms> m_terms; // of the curve that was taken
	std::vector<Terms> m_trial; // of the one that was asked
	double m_taken = 0.0;
	double m_error = 0.0;
};

bool isRising(const Compensation& curve)
{
	return curve.occlusion[0] == 0.0 && std::is_sorted(curve.occlusion.begin(), curve.occlusion.end()) &&
		   curve.occlusion.back() <= 1.0;
}

} // namespace

std::vector<PictureTriple> pictureTriples(const Tracer& tracer, const PictureSettings& settings, const RunSettings& run)
{
	if (settings.views < 1 || settings.per_view < 1)
	{
		return {};
	}
	const auto [width, height] = settings.size;
	const double columns = std::ceil(std::sqrt(static_cast<double>(settings.per_view) * width / height));
	const double rows = std::ceil(settings.per_view / columns);
	std::vector<PictureTriple> triples;
	const std::vector<LevelCamera> cameras = chooseCameras(tracer, settings.skipped + settings.views, run);
	for (auto view = static_cast<std::size_t>(settings.skipped); view < cameras.size(); ++view)
	{
		const Eye eye(tracer, cameras[view], width, height);
		for (double row = 0.0; row < rows; row += 1.0)
		{
			for (double column = 0.0; column < columns; column += 1.0)
			{
				const double x = std::floor((column + 0.5) * width / columns) + 0.5;
				const double y = std::floor((row + 0.5) * height / rows) + 0.5;
				const std::optional<ReferencePoint> here = eye.at(x, y);
				if (!here)
				{
					continue;
				}
				const std::optional<ReferencePoint> right = eye.at(x + 1.0, y);
				const std::optional<ReferencePoint> below = eye.at(x, y + 1.0);
				triples.push_back({{*here, right.value_or(*here), below.value_or(*here)},
								   {true, right.has_value(), below.has_value()},
								   static_cast<int>(view)});
			}
		}
	}
	return triples;
}

double pictureError(const Compensation& curve, std::span<const TripleValues> triples)
{
	return Meter(curve, triples, CurveMeasure::eq14).error();
}

double curveError(const Compensation& curve, std::span<const TripleValues> triples, CurveMeasure measure)
{
	return Meter(curve, triples, measure).error();
}

Compensation fitToPictures(const Compensation& start, std::span<const TripleValues> triples, CurveMeasure measure)
{
	assert(isRising(start));
	Meter meter(start, triples, measure);
	Compensation best = start;
	const std::size_t count = best.occlusion.size();
	const auto change = [&](std::size_t first, std::size_t end, double by)
	{
		Compensation curve = best;
		for (std::size_t i = first; i < end; ++i)
		{
			curve.occlusion[i] = std::clamp(curve.occlusion[i] + by, 0.0, 1.0);
		}
		if (isRising(curve) && meter.error(curve, knotsFrom(first, end)) < meter.error())
		{
			meter.take();
			best = curve;
		}
	};
	for (double step = 0.04; step > 0.002; step *= 0.5)
	{
		for (int repeat = 0; repeat < 3; ++repeat)
		{
			for (std::size_t first = 1; first < count; ++first)
			{
				// One knot, a few, and all from there on.
				for (const std::size_t knots : {std::size_t{1}, std::size_t{4}, count})
				{
					change(first, std::min(first + knots, count), -step);
					change(first, std::min(first + knots, count), step);
				}
			}
		}
	}
	return best;
}

} // namespace nook
