// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake.h"
#include "bake/surface_samples.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{

BakeCheck checkValues(const Tracer& tracer, const Level& baked, const std::function<double(const SurfaceSample&)>& valueOf,
					  const BakeSettings& settings, std::size_t points, const RunSettings& run)
{
	constexpr int kRays = 1024;              // a standard error of some 0.006, of which a root mean square of 0.05 shows 1 %
	constexpr uint32_t kOther = 0x5eed0ffUL; // another sequence than that of the bake
	std::vector<SurfaceSample> samples = placeByArea(baked, areasOf(baked), points, settings.seed ^ kOther);
	traceSamples(tracer, baked, samples, settings, kRays, settings.seed ^ kOther, run, "check");
	BakeCheck check;
	for (const SurfaceSample& sample : samples)
	{
		if (sample.buried)
		{
			check.buried += 1;
			continue;
		}
		const double off = valueOf(sample) - static_cast<double>(sample.visibility);
		check.points += 1;
		check.rmse += off * off;
		check.bias += off;
		check.standard_error += static_cast<double>(sample.standard_error) * static_cast<double>(sample.standard_error);
	}
	const auto count = static_cast<double>(std::max<std::size_t>(check.points, 1));
	check.rays = samples.size() * static_cast<std::size_t>(kRays);
	check.rmse = std::sqrt(check.rmse / count);
	check.bias /= count;
	check.standard_error = std::sqrt(check.standard_error / count);
	return check;
}

BakeCheck checkBake(const Tracer& tracer, const Level& baked, const std::vector<float>& visibility, const BakeSettings& settings,
					std::size_t points, const RunSettings& run)
{
	assert(visibility.size() == baked.positions.size());
	const auto valueOf = [&](const SurfaceSample& sample)
	{
		const glm::uvec3 t = baked.triangles[sample.triangle];
		return static_cast<double>((1.0F - sample.b - sample.c) * visibility[t.x] + sample.b * visibility[t.y] +
								   sample.c * visibility[t.z]);
	};
	return checkValues(tracer, baked, valueOf, settings, points, run);
}

} // namespace nook
