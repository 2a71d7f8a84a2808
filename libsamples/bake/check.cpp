// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake.h"
#include "bake/surface_samples.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{

BakeCheck checkValues(const Tracer& tracer, const Level& baked, const std::function<double(const SurfaceSample&)>& valueOf,
					  const BakeSettings& settings, std::size_t points, const RunSettings& run,
					  const std::function<glm::dvec3(const SurfaceSample&)>& bentOf)
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
		check.rmse_seen += sample.shut ? 0.0 : off * off;
		check.shut += sample.shut ? 1U : 0U;
		check.bias += off;
		check.rmse_without += static_cast<double>(sample.visibility) * static_cast<double>(sample.visibility);
		check.standard_error += static_cast<double>(sample.standard_error) * static_cast<double>(sample.standard_error);
		if (bentOf)
		{
			check.angle_rad += std::acos(std::clamp(glm::dot(bentOf(sample), glm::dvec3(sample.bent)), -1.0, 1.0));
		}
	}
	const auto count = static_cast<double>(std::max<std::size_t>(check.points, 1));
	check.rays = samples.size() * static_cast<std::size_t>(kRays);
	check.rmse = std::sqrt(check.rmse / count);
	check.rmse_seen = std::sqrt(check.rmse_seen / static_cast<double>(std::max<std::size_t>(check.points - check.shut, 1)));
	check.rmse_without = settings.beside ? std::sqrt(check.rmse_without / count) : 0.0;
	check.bias /= count;
	check.standard_error = std::sqrt(check.standard_error / count);
	check.angle_rad /= count;
	return check;
}

namespace
{

// Interpolated, of the sample's side.
template <class Value>
Value valueAt(const Level& baked, const SurfaceSample& sample, const std::vector<Value>& front, const std::vector<Value>& back)
{
	const glm::uvec3 t = baked.triangles[sample.triangle];
	const std::vector<Value>& values = sample.back && !back.empty() ? back : front;
	return (1.0F - sample.b - sample.c) * values[t.x] + sample.b * values[t.y] + sample.c * values[t.z];
}

} // namespace

BakeCheck checkBake(const Tracer& tracer, const Level& baked, const VertexBake& bake, const BakeSettings& settings,
					std::size_t points, const RunSettings& run)
{
	assert(bake.visibility.size() == baked.positions.size());
	const auto valueOf = [&](const SurfaceSample& sample)
	{
		return static_cast<double>(valueAt(baked, sample, bake.visibility, bake.back));
	};
	if (!settings.bent)
	{
		return checkValues(tracer, baked, valueOf, settings, points, run);
	}
	const auto bentOf = [&](const SurfaceSample& sample)
	{
		const glm::dvec3 bent(valueAt(baked, sample, bake.bent, bake.bent_back));
		const double length = glm::length(bent);
		return length > 0.0 ? bent / length : bent;
	};
	return checkValues(tracer, baked, valueOf, settings, points, run, bentOf);
}

} // namespace nook
