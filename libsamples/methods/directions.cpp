// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/directions.h"

#include "core/math.h"
#include "core/sequence.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace nook
{

// A sunflower spiral (H. Vogel, "A Better Way to Construct the Sunflower Head", 1979) on the disk under the hemisphere: even in the
// measure with the cosine. Thresholds run around the unit interval by a step that keeps those of neighbours apart, whose numbers
// differ by Fibonacci numbers. The step is tuned on planes at random distances and slopes, half of them cut by an edge: RMS error
// of the linear falloff 0.029 (32 directions), 0.018 (64), 0.010 (128), 0.0067 (256); with falloffs instead of thresholds 0.013 to
// 0.002. Exchanging thresholds to lower it further did not help on other planes.
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

} // namespace nook
