// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/pattern_json.h"

#include "core/error.h"
#include "core/round.h"
#include "core/text.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace nook
{
namespace
{

constexpr double kOutside = 1e-6;    // a few roundings of a 32-bit float near 1 (6e-8 each)
constexpr double kUnitLength = 1e-5; // directions printed with five digits
constexpr double kWeightSum = 1e-4;  // thousands of weights printed with seven digits

glm::dvec3 toFloats(const glm::dvec3& p)
{
	return {roundToFloat(p.x), roundToFloat(p.y), roundToFloat(p.z)};
}

[[noreturn]] void fail(const std::string& where, const std::string& found, const std::string& expected)
{
	throw Error(ExitCode::invalid_input, where + ": found " + found + ", expected " + expected);
}

} // namespace

glm::dvec3 checkedPoint(Domain domain, const glm::dvec3& point, const std::string& where)
{
	if (domain == Domain::slice)
	{
		const glm::dvec3 rounded = toFloats(point);
		if (!(rounded.x >= 0.0 && rounded.x < 1.0 && rounded.y >= 0.0 && rounded.y < 1.0))
		{
			fail(where, roundedText(point.x, 7) + ", " + roundedText(point.y, 7), "an azimuth and a jitter from 0 to below 1");
		}
		return rounded;
	}
	const double length = glm::length(point);
	if (isDirectional(domain))
	{
		if (!(std::fabs(length - 1.0) <= kUnitLength))
		{
			fail(where, "a direction of length " + roundedText(length, 7), "length 1 (within 1e-5)");
		}
		if (domain == Domain::hemisphere && point.z < -1e-6)
		{
			fail(where, "z = " + roundedText(point.z, 7), "a direction of the upper hemisphere, z >= 0");
		}
		return toFloats(point);
	}
	if (!(length <= 1.0 + kOutside))
	{
		fail(where, "a point at distance " + roundedText(length, 7) + " from the centre",
			 domain == Domain::disk ? "a point in the unit disk" : "a point in the unit ball");
	}
	glm::dvec3 inside = toFloats(point);
	for (double shrink = 1.0; glm::dot(inside, inside) > 1.0;)
	{
		shrink -= 0x1p-24;
		inside = toFloats(point * (shrink / length));
	}
	return inside;
}

void checkWeights(std::vector<double>& weights, const std::string& where, const SampleName& name_of)
{
	double sum = 0.0;
	for (std::size_t i = 0; i < weights.size(); ++i)
	{
		if (!(weights[i] >= 0.0))
		{
			fail(name_of(i), "the weight " + roundedText(weights[i], 7), "a weight of 0 or more");
		}
		sum += weights[i];
		weights[i] = roundToFloat(weights[i]);
	}
	if (!(std::fabs(sum - 1.0) <= kWeightSum))
	{
		fail(where, "the sum " + roundedText(sum, 7), "the sum 1 (within 1e-4)");
	}
}

} // namespace nook
