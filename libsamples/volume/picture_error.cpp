// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (AOV), eq. 14. Most of it is differences between pixels:
// volumes add steeper ones than rays have, so the curve that is nearest point by point is not the one with the least error.
#include "volume/picture_error.h"

#include "core/math.h"
#include "core/parallel.h"
#include "scene/camera.h"
#include "scene/camera_choice.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace nook
{
namespace
{

// log†(x) of eq. 14.
double signedLog(double x)
{
	return x < 0.0 ? -logOf(1.0 - x) : logOf(1.0 + x);
}

struct Surface
{
	bool there = false;
	ReferencePoint point{};
};

class Eye
{
public:
	Eye(const Tracer& tracer, const LevelCamera& camera, const std::array<int, 2>& size)
		: m_tracer(tracer), m_view(viewOf(camera, size[0], size[1])), m_projector(m_view.projection, size[0], size[1]),
		  m_world_from_camera(glm::inverse(m_view.camera_from_world))
	{
	}

	Surface at(double x, double y) const
	{
		const ViewLine line = m_projector.lineOf({x, y});
		const glm::dvec3 eye(m_world_from_camera * glm::dvec4(line.at, 1.0));
		const glm::dvec3 along = glm::dmat3(m_world_from_camera) * line.along;
		const RayHit hit = m_tracer.nearest(eye, along, std::numeric_limits<double>::infinity());
		if (!hit.hit)
		{
			return {};
		}
		const Level& level = m_tracer.level();
		const glm::uvec3 corner = level.triangles[hit.triangle];
		const glm::dvec3 a = level.positions[corner.x];
		const glm::dvec3 across = glm::cross(level.positions[corner.y] - a, level.positions[corner.z] - a);
		const double area = glm::length(across);
		if (!(area > 0.0))
		{
			return {};
		}
		return {true, {eye + hit.distance * along, across * ((hit.front ? 1.0 : -1.0) / area), 0.0}};
	}

private:
	const Tracer& m_tracer;
	View m_view;
	Projector m_projector;
	glm::dmat4 m_world_from_camera;
};

// The error's three means, and what a curve makes of them.
class Meter
{
public:
	explicit Meter(std::span<const TripleValues> triples) : m_triples(triples)
	{
		for (const TripleValues& triple : triples)
		{
			Expected expected;
			expected.value = signedLog(255.0 * (1.0 - triple.occlusions[0]));
			for (std::size_t i = 0; i < 2; ++i)
			{
				expected.steps[i] = signedLog(255.0 * (triple.occlusions[0] - triple.occlusions[i + 1]));
				m_steps[i] += triple.there[i + 1] ? 1.0 : 0.0;
			}
			m_expected.push_back(expected);
		}
	}

	double error(const Compensation& curve) const
	{
		double value = 0.0;
		std::array<double, 2> steps{};
		for (std::size_t k = 0; k < m_triples.size(); ++k)
		{
			const TripleValues& triple = m_triples[k];
			const double here = 255.0 * (1.0 - curve.at(triple.sums[0]));
			value += squared(signedLog(here) - m_expected[k].value);
			for (std::size_t i = 0; i < 2; ++i)
			{
				if (triple.there[i + 1])
				{
					const double there = 255.0 * (1.0 - curve.at(triple.sums[i + 1]));
					steps[i] += squared(signedLog(there - here) - m_expected[k].steps[i]);
				}
			}
		}
		const auto mean = [](double sum, double count)
		{
			return count > 0.0 ? sum / count : 0.0;
		};
		return mean(value, static_cast<double>(m_triples.size())) + 0.5 * (mean(steps[0], m_steps[0]) + mean(steps[1], m_steps[1]));
	}

private:
	struct Expected
	{
		double value = 0.0;
		std::array<double, 2> steps{};
	};
	static double squared(double x)
	{
		return x * x;
	}

	std::span<const TripleValues> m_triples;
	std::vector<Expected> m_expected;
	std::array<double, 2> m_steps{};
};

bool isRising(const Compensation& curve)
{
	return curve.occlusion[0] == 0.0 && std::is_sorted(curve.occlusion.begin(), curve.occlusion.end()) &&
		   curve.occlusion.back() <= 1.0;
}

} // namespace

std::vector<PictureTriple> pictureTriples(const Tracer& tracer, const PictureSettings& settings, const RunSettings& run)
{
	const auto [width, height] = settings.size;
	const double columns = std::ceil(std::sqrt(static_cast<double>(settings.per_view) * width / height));
	const double rows = std::ceil(settings.per_view / columns);
	std::vector<PictureTriple> triples;
	for (const LevelCamera& camera : chooseCameras(tracer, settings.views, run))
	{
		const Eye eye(tracer, camera, settings.size);
		for (double row = 0.0; row < rows; row += 1.0)
		{
			for (double column = 0.0; column < columns; column += 1.0)
			{
				const double x = std::floor((column + 0.5) * width / columns) + 0.5;
				const double y = std::floor((row + 0.5) * height / rows) + 0.5;
				const Surface here = eye.at(x, y);
				if (!here.there)
				{
					continue;
				}
				const Surface right = eye.at(x + 1.0, y);
				const Surface below = eye.at(x, y + 1.0);
				triples.push_back({{here.point, right.there ? right.point : here.point, below.there ? below.point : here.point},
								   {true, right.there, below.there}});
			}
		}
	}
	return triples;
}

double pictureError(const Compensation& curve, std::span<const TripleValues> triples)
{
	return Meter(triples).error(curve);
}

Compensation fitToPictures(const Compensation& start, std::span<const TripleValues> triples)
{
	assert(isRising(start));
	const Meter meter(triples);
	Compensation best = start;
	double least = meter.error(best);
	const auto take = [&](const Compensation& curve)
	{
		if (!isRising(curve))
		{
			return;
		}
		const double error = meter.error(curve);
		if (error < least)
		{
			least = error;
			best = curve;
		}
	};
	const std::size_t count = best.occlusion.size();
	for (double step = 0.04; step > 0.002; step *= 0.5)
	{
		for (int repeat = 0; repeat < 3; ++repeat)
		{
			for (std::size_t first = 1; first < count; ++first)
			{
				// One knot, a few, and all from there on.
				for (const std::size_t knots : {std::size_t{1}, std::size_t{4}, count})
				{
					for (const double change : {-step, step})
					{
						Compensation curve = best;
						for (std::size_t i = first; i < std::min(first + knots, count); ++i)
						{
							curve.occlusion[i] = std::clamp(curve.occlusion[i] + change, 0.0, 1.0);
						}
						take(curve);
					}
				}
			}
		}
	}
	return best;
}

} // namespace nook
