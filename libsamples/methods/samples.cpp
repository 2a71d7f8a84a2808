// SPDX-License-Identifier: GPL-3.0-or-later
// Converts patterns to the samples that kernels read.
#include "core/error.h"
#include "core/lists.h"
#include "core/math.h"
#include "core/random.h"
#include "methods/aov_text.h"
#include "methods/method_table.h"
#include "methods/volume_kernels.h"
#include "pattern/cells.h"

#include <array>
#include <cassert>
#include <cmath>
#include <mutex>
#include <numbers>

namespace nook
{
namespace
{

constexpr double kTwin = 1e-5; // tolerance between a point and its mirrored partner

// log2 of the side of each point's part of the disk, in radii.
std::vector<double> areaSides(const Pattern& pattern)
{
	return mapped(exactCells(Domain::hemisphere, pattern.points).integrals,
				  [](double share) { return 0.5 * std::numbers::log2e * logOf(std::numbers::pi * std::max(share, 1e-9)); });
}

std::size_t twinOf(const Pattern& pattern, std::size_t i)
{
	for (std::size_t j = 0; j < pattern.count(); ++j)
	{
		const glm::dvec3 sum = pattern.points[i] + pattern.points[j];
		if (std::fabs(sum.x) <= kTwin && std::fabs(sum.y) <= kTwin)
		{
			return j;
		}
	}
	return pattern.count();
}

MaskTables madeTables(int count)
{
	MaskTables tables;
	tables.directions = count;
	tables.rays = mapped(maskDirections(count), [](const glm::vec4& d) { return glm::vec3(d) * (1.0F - d.w); });
	tables.rays.resize((tables.rays.size() + 127) / 128 * 128);
	volume_kernels::Kernels kernels;
	kernels.rays = tables.rays;
	const int side = kernels.nookHalfSpaces();
	const auto fours = static_cast<int>(tables.rays.size() / 128);
	const auto texelOf = [&](int i)
	{
		return kernels.nookHalfSpaceTexel({i % side, i / side % side}, i / (side * side));
	};
	tables.half_spaces = mapped(countingFrom(0, static_cast<std::size_t>(fours * side * side)), texelOf);
	return tables;
}

} // namespace

Pattern pairedPattern(const Pattern& pattern)
{
	Pattern paired;
	paired.domain = pattern.domain;
	Pattern centre;
	const auto take = [&pattern](Pattern& into, std::size_t i)
	{
		into.points.push_back(pattern.points[i]);
		into.weights.push_back(pattern.weights[i]);
	};
	for (std::size_t i = 0; i < pattern.count(); ++i)
	{
		const std::size_t twin = twinOf(pattern, i);
		refuseIf(twin == pattern.count() || (twin == i && centre.count() > 0),
				 "sample " + std::to_string(i) + ": found no other at the opposite side, expected a symmetric pattern (paired)",
				 ExitCode::invalid_input);
		if (twin == i)
		{
			take(centre, i);
		}
		else if (i < twin)
		{
			take(paired, i);
			take(paired, twin);
		}
	}
	for (std::size_t i = 0; i < centre.count(); ++i)
	{
		paired.points.push_back(centre.points[i]);
		paired.weights.push_back(centre.weights[i]);
	}
	return paired;
}

ShadeSamples samplesOf(ShadeMethod method, const std::vector<Pattern>& variants, int layers)
{
	assert(takesPattern(method) || mayTakeTile(method));
	const SampleThird third = rowOf(method).third;
	ShadeSamples samples;
	samples.tiled = mayTakeTile(method);
	while (static_cast<std::size_t>(samples.size * samples.size * layers) < variants.size())
	{
		samples.size += 1;
	}
	assert(static_cast<std::size_t>(samples.size * samples.size * layers) == variants.size());
	samples.count = static_cast<int>(variants.front().count());
	for (const Pattern& pattern : variants)
	{
		assert(pattern.domain == domainOf(method) && pattern.count() == variants.front().count());
		const std::vector<double> sides = third == SampleThird::log2_side ? areaSides(pattern) : std::vector<double>{};
		for (std::size_t i = 0; i < pattern.count(); ++i)
		{
			const glm::dvec3& p = pattern.points[i];
			const double value = third == SampleThird::log2_side     ? sides[i]
								 : third == SampleThird::half_length ? std::sqrt(std::max(0.0, 1.0 - p.x * p.x - p.y * p.y))
																	 : p.z;
			samples.samples.emplace_back(p.x, p.y, value, pattern.weights[i]);
		}
	}
	return samples;
}

// A sunflower spiral (H. Vogel, "A Better Way to Construct the Sunflower Head", 1979) on the disk under the hemisphere: uniform in
// the cosine-weighted measure. Thresholds step around the unit interval so that those of neighbours, whose numbers differ by
// Fibonacci numbers, are far apart. The step is tuned on planes at random distances and slopes, half of them cut by an edge: RMS
// error of the linear falloff 0.029 (32 directions), 0.018 (64), 0.010 (128), 0.0067 (256); with falloffs instead of thresholds
// 0.013 to 0.002. Exchanging thresholds to lower it further did not help on other planes.
std::vector<glm::vec4> maskDirections(int count)
{
	assert(count >= kLeastDirections && count <= kMostDirections && count % 32 == 0);
	constexpr double kStep = 0.28063;
	std::vector<glm::vec4> directions;
	directions.reserve(static_cast<std::size_t>(count));
	for (int i = 0; i < count; ++i)
	{
		const double squared = (i + 0.5) / count;
		const double turn = fraction(i * (2.0 - std::numbers::phi)) * 2.0 * kPi;
		const double radius = std::sqrt(squared);
		const SinCos at = sinCosOf(turn);
		directions.emplace_back(radius * at.cos, radius * at.sin, std::sqrt(1.0 - squared), fraction(i * kStep + 0.5 / count));
	}
	return directions;
}

const MaskTables& maskTablesOf(int count)
{
	static std::array<MaskTables, kMostDirections / 32> tables;
	static std::array<std::once_flag, kMostDirections / 32> made;
	const auto i = static_cast<std::size_t>(count / 32 - 1);
	std::call_once(made[i], [&] { tables[i] = madeTables(count); });
	return tables[i];
}

} // namespace nook
