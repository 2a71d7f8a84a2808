// SPDX-License-Identifier: GPL-3.0-or-later
// Each volume is made lower or narrower, past receivers that can spare what they get there, as long as that saves more of its
// surface than it costs. An exchange that is the better goes first, over all volumes: so receivers' allowances go where most
// fragments are saved for them.
#include "volume/trim.h"

#include "core/parallel.h"
#include "core/random.h"
#include "volume/evaluate.h"
#include "volume/eye.h"
#include "volume/prism.h"
#include "volume/receivers.h"
#include "volume/shrink.h"
#include "volume/sight.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace nook
{
namespace
{

constexpr std::size_t kFewestReceivers = 4; // of a volume that is trimmed
constexpr int kRays = 16;                   // of a polygon whose volume fewer receivers get something from

// What a square of the volumes' surface is worth in the end, with an allowance of 1: this share of what it has to do with on
// average. An allowance of 0.15 or 0.2 then ends few exchanges by itself.
constexpr double kExchange = 0.5;
constexpr int kRounds = 10; // the price doubles as often before

struct Asked
{
	std::vector<std::vector<TrimPart>> parts; // by volume
	std::vector<double> sums;                 // by receiver
	std::size_t shares = 0;
	std::size_t left_out = 0; // receivers
};

// Receivers in an order of their own, so that those left out are spread over the level.
std::vector<uint32_t> shuffled(std::size_t count)
{
	std::vector<uint32_t> order(count);
	Random random(1, 0x7219);
	for (uint32_t i = 0; i < count; ++i)
	{
		const uint32_t other = random.below(i + 1);
		order[i] = order[other];
		order[other] = i;
	}
	return order;
}

// Adds what volumes give to these receivers, until there are enough shares.
void ask(const VolumeSet& volumes, const VolumeEvaluator& evaluator, std::span<const ReferencePoint> receivers,
		 const TrimSettings& settings, const RunSettings& run, Asked& asked)
{
	constexpr std::size_t kBlock = 4096;
	const std::vector<uint32_t> order = shuffled(receivers.size());
	std::vector<std::vector<VolumeShare>> shares(kBlock);
	std::vector<std::vector<VolumeReach>> reaches(kBlock);
	constexpr std::size_t kParts = 1000; // of receivers or of shares, whichever ends first
	ProgressCounter progress(run.progress, "trim", kParts);
	const std::size_t before = asked.shares;
	std::size_t told = 0;
	std::size_t first = 0;
	for (; first < receivers.size() && asked.shares < settings.most_shares; first += kBlock)
	{
		const std::size_t count = std::min(kBlock, receivers.size() - first);
		parallelFor(count, run.threads,
					[&](std::size_t i)
					{
						const ReferencePoint& receiver = receivers[order[first + i]];
						evaluator.shares(receiver.position, receiver.normal, shares[i]);
						reaches[i].clear();
						for (const VolumeShare& share : shares[i])
						{
							const Occluder& polygon = volumes.occluders.polygons[share.polygon];
							reaches[i].push_back(reachFor(volumes, polygon, receiver.position));
						}
					});
		for (std::size_t i = 0; i < count; ++i)
		{
			double sum = 0.0;
			for (std::size_t k = 0; k < shares[i].size(); ++k)
			{
				const VolumeShare& share = shares[i][k];
				sum += static_cast<double>(share.occlusion);
				asked.parts[share.polygon].push_back({static_cast<uint32_t>(asked.sums.size()), share.occlusion, reaches[i][k]});
			}
			asked.sums.push_back(sum);
			asked.shares += shares[i].size();
		}
		const std::size_t done = std::min(kParts, std::max(kParts * (first + count) / receivers.size(),
														   kParts * (asked.shares - before) / (settings.most_shares - before)));
		progress.finish(done - told);
		told = done;
	}
	asked.left_out += receivers.size() - std::min(first, receivers.size());
}

// What a polygon sees within its volume, from both of its sides if it has two.
void addSeen(const Tracer& tracer, const VolumeSet& volumes, std::size_t index, std::vector<ReferencePoint>& points)
{
	const Occluder& polygon = volumes.occluders.polygons[index];
	const std::span<const glm::dvec3> corners = volumes.occluders.cornersOf(polygon);
	const glm::dvec3 front = frontOf(corners);
	Random random(0x7219, index);
	for (int i = 0; i < kRays; ++i)
	{
		const uint32_t fan = 1 + random.below(static_cast<uint32_t>(corners.size()) - 2);
		const double u = random.uniform();
		const double v = random.uniform();
		const glm::dvec3 side = polygon.two_sided && i % 2 != 0 ? -front : front;
		const glm::dvec3 way = side + 0.999 * directionOf(random); // by the cosine
		const glm::dvec3 from = pointOf({corners[0], corners[fan], corners[fan + 1]}, u, v) +
								side * (kVolumeBias * volumes.distance_m + tracer.error());
		if (const auto seen = surfaceAlong(tracer, from, way, volumes.distance_m / glm::length(way)))
		{
			points.push_back(*seen);
		}
	}
}

// The receivers; then, of volumes that hardly any of them gets something from, what their polygons see.
Asked askAll(const VolumeSet& volumes, std::span<const ReferencePoint> receivers, const TrimSettings& settings,
			 const RunSettings& run, const Tracer* tracer)
{
	const VolumeEvaluator evaluator(volumes, run);
	Asked asked;
	asked.parts.resize(volumes.occluders.polygons.size());
	ask(volumes, evaluator, receivers, settings, run, asked);
	if (tracer != nullptr)
	{
		std::vector<std::vector<ReferencePoint>> seen(asked.parts.size());
		parallelFor(seen.size(), run.threads,
					[&](std::size_t i)
					{
						if (asked.parts[i].size() < kFewestReceivers)
						{
							addSeen(*tracer, volumes, i, seen[i]);
						}
					});
		std::vector<ReferencePoint> others;
		for (const std::vector<ReferencePoint>& points : seen)
		{
			others.insert(others.end(), points.begin(), points.end());
		}
		ask(volumes, evaluator, others, settings, run, asked);
	}
	return asked;
}

// All losses there could be, against all of the volumes' surface.
double evenPrice(const std::vector<Shrinking>& volumes, const Asked& asked, const TrimAllowances& allowances)
{
	double surface = 0.0;
	double loss = 0.0;
	for (std::size_t i = 0; i < volumes.size(); ++i)
	{
		surface += volumes[i].surface({});
		for (const TrimPart& part : asked.parts[i])
		{
			loss += allowances.lossOf(part);
		}
	}
	return surface > 0.0 ? loss / surface : 0.0;
}

} // namespace

VolumeReach reachFor(const VolumeSet& volumes, const Occluder& polygon, glm::dvec3 position)
{
	const std::span<const glm::dvec3> corners = volumes.occluders.cornersOf(polygon);
	const glm::dvec3 front = frontOf(corners);
	double side_m = 0.0;
	glm::dvec3 a = corners.back();
	for (const glm::dvec3& b : corners)
	{
		const glm::dvec3 outward = glm::normalize(glm::cross(b - a, front));
		side_m = std::max(side_m, glm::dot(outward, position - a));
		a = b;
	}
	return {static_cast<float>(std::fabs(glm::dot(front, position - corners[0])) / volumes.distance_m),
			static_cast<float>(side_m / volumes.distance_m)};
}

TrimCounts trimVolumes(VolumeSet& volumes, std::span<const ReferencePoint> receivers, const TrimSettings& settings,
					   const RunSettings& run, const Tracer* tracer)
{
	assert(settings.share > 0.0 && settings.share <= 1.0);
	const Asked asked = askAll(volumes, receivers, settings, run, tracer);
	std::vector<Occluder>& polygons = volumes.occluders.polygons;
	std::vector<Shrinking> shrinking(polygons.size());
	ProgressCounter progress(run.progress, "trimming", 2 + static_cast<std::size_t>(kRounds));
	parallelFor(polygons.size(), run.threads,
				[&](std::size_t i)
				{
					if (asked.parts[i].size() >= kFewestReceivers)
					{
						shrinking[i] = Shrinking(volumes, polygons[i], asked.parts[i]);
					}
				});
	progress.finishOne();
	TrimAllowances allowances(asked.sums, settings.share);
	const double last = kExchange * settings.share * settings.share * evenPrice(shrinking, asked, allowances);
	for (int round = kRounds; round >= 0; --round)
	{
		const double price = std::ldexp(last, -round);
		for (Shrinking& volume : shrinking)
		{
			volume.shrink(allowances, price);
		}
		progress.finishOne();
	}

	TrimCounts counts;
	counts.receivers = asked.sums.size();
	counts.shares = asked.shares;
	counts.left_out = asked.left_out;
	double reach_sum = 0.0;
	double before = 0.0;
	double after = 0.0;
	for (std::size_t i = 0; i < polygons.size(); ++i)
	{
		const VolumeReach reach = shrinking[i].finish(allowances);
		polygons[i].reach = reach.height;
		polygons[i].side_reach = reach.side;
		counts.lost += shrinking[i].lost();
		counts.whole += asked.parts[i].size() < kFewestReceivers ? 1U : 0U;
		counts.trimmed += reach.side < 1.0F ? 1U : 0U;
		reach_sum += static_cast<double>(reach.height);
		before += shrinking[i].surface({});
		after += shrinking[i].surface(reach);
	}
	counts.mean_reach = polygons.empty() ? 1.0 : reach_sum / static_cast<double>(polygons.size());
	counts.surface = before > 0.0 ? after / before : 1.0;
	allowances.describe(counts);
	return counts;
}

TrimCounts trimVolumes(VolumeSet& volumes, const Tracer& tracer, const TrimSettings& settings, const RunSettings& run)
{
	return trimVolumes(volumes, sampleReceivers(tracer, volumes.distance_m, settings.receivers, run), settings, run, &tracer);
}

} // namespace nook
