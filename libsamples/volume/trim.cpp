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

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <meshoptimizer.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace nook
{
namespace
{

constexpr std::size_t kFewestReceivers = 4;    // of a volume that is trimmed
constexpr int kRays = 16;                      // of a polygon whose volume fewer receivers get something from
constexpr std::size_t kSample = 4096;          // receivers that tell how many volumes give something to one
constexpr std::size_t kReceiversAtOnce = 4096; // receivers that are asked at once

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

// Numbers of the points, so that those that follow one another lie close together.
std::vector<uint32_t> nearOrder(const std::vector<ReferencePoint>& points)
{
	glm::dvec3 least(1e300);
	for (const ReferencePoint& point : points)
	{
		least = glm::min(least, point.position);
	}
	std::vector<glm::vec3> positions;
	positions.reserve(points.size());
	for (const ReferencePoint& point : points)
	{
		positions.emplace_back(point.position - least);
	}
	std::vector<uint32_t> places(points.size());
	if (!points.empty())
	{
		meshopt_spatialSortRemap(places.data(), &positions[0].x, positions.size(), sizeof(glm::vec3));
	}
	std::vector<uint32_t> order(points.size());
	for (uint32_t i = 0; i < order.size(); ++i)
	{
		order[places[i]] = i;
	}
	return order;
}

void shuffle(std::vector<ReferencePoint>& points)
{
	Random random(1, 0x7219);
	for (uint32_t i = 0; i < points.size(); ++i)
	{
		std::swap(points[i], points[random.below(i + 1)]);
	}
}

// Leaves out points at random where all of them would get something from more than `most_shares` volumes → how many.
std::size_t leaveOut(const VolumeEvaluator& evaluator, std::size_t most_shares, const RunSettings& run,
					 std::vector<ReferencePoint>& points)
{
	if (points.size() <= kSample)
	{
		return 0;
	}
	shuffle(points);
	std::vector<std::size_t> counts(kSample);
	parallelFor(kSample, run.threads,
				[&](std::size_t i)
				{
					thread_local std::vector<VolumeShare> shares;
					evaluator.shares(points[i].position, points[i].normal, shares);
					counts[i] = shares.size();
				});
	const std::size_t shares = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
	const std::size_t before = points.size();
	points.resize(std::clamp(shares > 0 ? most_shares * kSample / shares : before, kSample, before));
	return before - points.size();
}

// Adds what volumes give to these receivers.
void ask(const VolumeSet& volumes, const VolumeEvaluator& evaluator, std::vector<ReferencePoint> points, std::size_t most_shares,
		 const RunSettings& run, Asked& asked)
{
	asked.left_out += leaveOut(evaluator, most_shares, run, points);
	const std::vector<uint32_t> order = nearOrder(points);
	std::vector<std::vector<VolumeShare>> shares(kReceiversAtOnce);
	std::vector<std::vector<VolumeReach>> reaches(kReceiversAtOnce);
	ProgressCounter progress(run.progress, "trim", points.size());
	for (std::size_t first = 0; first < points.size(); first += kReceiversAtOnce)
	{
		const std::size_t count = std::min(kReceiversAtOnce, points.size() - first);
		parallelFor(count, run.threads,
					[&](std::size_t i)
					{
						const ReferencePoint& receiver = points[order[first + i]];
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
				asked.parts[share.polygon].emplace_back(static_cast<uint32_t>(asked.sums.size()), share.occlusion, reaches[i][k]);
			}
			asked.sums.push_back(sum);
			asked.shares += shares[i].size();
		}
		progress.finish(count);
	}
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

// What polygons see whose volumes hardly any receiver gets something from.
std::vector<ReferencePoint> seenOfFew(const Tracer& tracer, const VolumeSet& volumes, const Asked& asked, const RunSettings& run)
{
	constexpr std::size_t kChunk = 1024;
	const std::size_t count = asked.parts.size();
	std::vector<std::vector<ReferencePoint>> seen((count + kChunk - 1) / kChunk);
	parallelFor(seen.size(), run.threads,
				[&](std::size_t chunk)
				{
					for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i)
					{
						if (asked.parts[i].size() < kFewestReceivers)
						{
							addSeen(tracer, volumes, i, seen[chunk]);
						}
					}
				});
	std::vector<ReferencePoint> points;
	for (const std::vector<ReferencePoint>& of_chunk : seen)
	{
		points.insert(points.end(), of_chunk.begin(), of_chunk.end());
	}
	return points;
}

Asked askAll(const VolumeSet& volumes, std::span<const ReferencePoint> receivers, const TrimSettings& settings,
			 const RunSettings& run, const Tracer* tracer)
{
	const VolumeEvaluator evaluator(volumes, run);
	Asked asked;
	asked.parts.resize(volumes.occluders.polygons.size());
	const std::size_t most_shares = std::max(settings.most_shares, settings.shares_each * asked.parts.size());
	ask(volumes, evaluator, {receivers.begin(), receivers.end()}, most_shares, run, asked);
	if (tracer != nullptr)
	{
		ask(volumes, evaluator, seenOfFew(*tracer, volumes, asked, run), most_shares, run, asked);
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
	Asked asked = askAll(volumes, receivers, settings, run, tracer);
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
