// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/hidden.h"

#include "core/parallel.h"
#include "volume/evaluate.h"
#include "volume/prism.h"
#include "volume/region.h"
#include "volume/sight.h"

#include <algorithm>
#include <atomic>

namespace nook
{

double sightLift(const Tracer& tracer, double distance_m, double surface_m)
{
	return 2.0 * tracer.error() + kPlaneBias * distance_m + surface_m;
}

namespace
{

constexpr std::size_t kBlock = 64; // receivers that one thread takes at once
constexpr int kSegments = 8;       // from a receiver to a polygon

} // namespace

HiddenShares hiddenShares(const VolumeSet& hidden, const Tracer& tracer, std::span<const ReferencePoint> receivers, double lift_m,
						  const RunSettings& run)
{
	HiddenShares shares;
	shares.behind.assign(receivers.size(), 0.0);
	shares.seen_volumes.assign(hidden.occluders.polygons.size(), 0);
	shares.check.receivers = receivers.size();
	if (hidden.occluders.polygons.empty())
	{
		return shares;
	}
	const VolumeEvaluator evaluator(hidden, run);
	const Sight sight(tracer, {hidden.distance_m, lift_m});
	std::vector<std::vector<uint32_t>> seen(receivers.size());
	std::vector<double> seen_sums(receivers.size(), 0.0); // of the contributions of which any part is seen
	std::vector<std::size_t> asked(receivers.size(), 0);
	ProgressCounter progress(run.progress, "hidden volumes", (receivers.size() + kBlock - 1) / kBlock);
	const auto ask = [&](std::size_t i, std::vector<VolumeShare>& found)
	{
		evaluator.shares(receivers[i].position, receivers[i].normal, found);
		for (const VolumeShare& share : found)
		{
			const Occluder& polygon = hidden.occluders.polygons[share.polygon];
			const std::span<const glm::dvec3> corners = hidden.occluders.cornersOf(polygon);
			const auto occlusion = static_cast<double>(share.occlusion);
			const bool counts = occlusion > kHiddenLeast;
			asked[i] += counts ? 1U : 0U;
			const bool is_seen = counts && sight.seesFrom({corners, frontOf(corners)}, receivers[i].position, receivers[i].normal,
														  kSegments, static_cast<uint32_t>(i * 31 + share.polygon));
			(is_seen ? seen_sums : shares.behind)[i] += occlusion;
			if (is_seen)
			{
				seen[i].push_back(share.polygon);
			}
		}
	};
	parallelFor((receivers.size() + kBlock - 1) / kBlock, run.threads,
				[&](std::size_t block)
				{
					std::vector<VolumeShare> found;
					for (std::size_t i = block * kBlock; i < std::min(receivers.size(), (block + 1) * kBlock); ++i)
					{
						ask(i, found);
					}
					progress.finishOne();
				});
	for (std::size_t i = 0; i < receivers.size(); ++i)
	{
		shares.check.volumes += asked[i];
		shares.check.seen += seen[i].size();
		shares.check.greatest = std::max(shares.check.greatest, seen_sums[i]);
		shares.check.mean += seen_sums[i] / static_cast<double>(receivers.size());
		for (const uint32_t volume : seen[i])
		{
			shares.seen_volumes[volume] = 1;
		}
	}
	return shares;
}

} // namespace nook
