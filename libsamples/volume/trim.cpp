// SPDX-License-Identifier: GPL-3.0-or-later
// Makes volumes lower or narrower, excluding receivers that can spare their contribution, as long as that saves more surface than
// it costs. The best exchanges over all volumes come first, so that receivers' allowances are spent where they save the most
// fragments.
#include "volume/trim.h"

#include "core/lists.h"
#include "core/parallel.h"
#include "core/random.h"
#include "volume/evaluate.h"
#include "volume/volumes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace nook
{

namespace
{

constexpr double kSharpest = 1.0 / 16.0; // twice the cosine of half a corner's turn: limits a mitre to 32 half widths

// Rounds up to an integer, for 0 to some thousands; called for every part repeatedly.
float roundedUp(float x)
{
	const auto whole = static_cast<float>(static_cast<int>(x));
	return whole < x ? whole + 1.0F : whole;
}

// Rounds up to the steps of files: multiples of 1/128, and of 1/8 of those.
VolumeReach rounded(VolumeReach reach)
{
	const float height = std::clamp(roundedUp(std::max(reach.height, reach.side) * 128.0F), 1.0F, 128.0F) / 128.0F;
	return {height, height * std::clamp(roundedUp(reach.side / height * 8.0F), 1.0F, 8.0F) / 8.0F};
}

// True if the part lies outside such a volume.
bool isBeyond(const TrimPart& part, VolumeReach reach)
{
	const VolumeReach at = part.reach();
	return at.height >= reach.height || at.side >= reach.side;
}

// How much each receiver has lost, and may still lose.
class TrimAllowances
{
public:
	TrimAllowances(const std::vector<double>& sums, double share) : m_share(share), m_receivers(sums.size())
	{
		for (std::size_t i = 0; i < sums.size(); ++i)
		{
			m_receivers[i].most = share * std::max(sums[i], kTrimFloor);
		}
	}

	// The squared fraction of the receiver's total, or of kTrimFloor: a volume's border is an edge, and two faint edges are less
	// visible than one of their sum.
	double lossOf(const TrimPart& part) const
	{
		const double share = m_share * part.occlusion() / m_receivers[part.receiver()].most;
		return share * share;
	}

	bool canTake(const TrimPart& part) const
	{
		const Receiver& receiver = m_receivers[part.receiver()];
		return receiver.lost + part.occlusion() <= receiver.most;
	}

	void take(const TrimPart& part)
	{
		m_receivers[part.receiver()].lost += part.occlusion();
	}

	void giveBack(const TrimPart& part)
	{
		m_receivers[part.receiver()].lost -= part.occlusion();
	}

	void describe(TrimCounts& counts) const
	{
		for (const Receiver& receiver : m_receivers)
		{
			counts.greatest_loss = std::max(counts.greatest_loss, receiver.lost);
			counts.mean_loss += receiver.lost / static_cast<double>(m_receivers.size());
		}
	}

private:
	struct Receiver // together in memory, since each part accesses another receiver
	{
		double lost = 0.0;
		double most = 0.0;
	};

	double m_share;
	std::vector<Receiver> m_receivers;
};

// A volume's parts by their steps from the outside, in the order given.
class TrimQueue
{
public:
	static constexpr uint32_t kNone = 0xffffffffU;

	// `most`: the greatest number of steps.
	void fill(std::span<const TrimPart> parts, int way, uint32_t step, uint32_t most)
	{
		const uint32_t factor = (1U << 22U) / step + 1; // divides integers below 1024 exactly
		std::fill_n(m_first.begin(), most + 1, kNone);
		m_next.resize(std::max(m_next.size(), parts.size()));
		for (auto i = static_cast<uint32_t>(parts.size()); i-- > 0;)
		{
			uint32_t& first = m_first[parts[i].along(way) * factor >> 22U];
			m_next[i] = std::exchange(first, i);
		}
	}

	bool isEmpty(uint32_t steps) const
	{
		return m_first[steps] == kNone;
	}

	uint32_t first(uint32_t steps) const
	{
		return m_first[steps];
	}

	uint32_t next(uint32_t part) const
	{
		return m_next[part];
	}

private:
	std::array<uint32_t, 1024> m_first{};
	std::vector<uint32_t> m_next;
};

// A volume that is made smaller step by step.
class Shrinking
{
public:
	Shrinking() = default; // keeps its reach

	// Keeps a reference to the parts and reorders them.
	Shrinking(const VolumeSet& volumes, const Occluder& polygon, std::span<TrimPart> parts) : m_parts(parts), m_left(parts.size())
	{
		const std::span<const glm::dvec3> corners = volumes.occluders.cornersOf(polygon);
		glm::dvec3 across(0.0);
		for (std::size_t i = 0; i < corners.size(); ++i)
		{
			const glm::dvec3 next = corners[(i + 1) % corners.size()];
			across += glm::cross(corners[i] - corners[0], next - corners[0]) * (0.5 / (volumes.distance_m * volumes.distance_m));
			m_outline += glm::length(next - corners[i]) / volumes.distance_m;
			// Half-angle tangent of the turn, for unit vectors; exact bounds limit it to about 64.
			const glm::dvec3 before = glm::normalize(corners[i] - corners[(i + corners.size() - 1) % corners.size()]);
			const glm::dvec3 after = glm::normalize(next - corners[i]);
			m_mitres += glm::length(before - after) / std::max(glm::length(before + after), kSharpest);
		}
		m_area = glm::length(across);
		m_sides = polygon.two_sided ? 2.0 : 1.0;
		findFirst();
	}

	// Approximate surface of such a volume, in squared distances: four times its average fragments in a view.
	double surface(VolumeReach reach) const
	{
		const VolumeReach kept = rounded(reach);
		const auto side = static_cast<double>(kept.side);
		const double area = m_area + (m_outline + m_mitres * side) * side;
		return 2.0 * area + (m_outline + 2.0 * m_mitres * side) * static_cast<double>(kept.height) * m_sides;
	}

	// Repeatedly removes what saves most, while the loss is below `price` per squared distance saved.
	void shrink(TrimAllowances& allowances, double price, TrimQueue& queue)
	{
		for (;;)
		{
			Step best;
			for (int way = 0; way < kWays; ++way)
			{
				look(way, allowances, price, queue, best);
			}
			if (best.value <= 0.0)
			{
				return;
			}
			m_reach = best.reach;
			const auto lost = std::stable_partition(m_parts.begin(), m_parts.begin() + static_cast<std::ptrdiff_t>(m_left),
													[this](const TrimPart& part) { return !isBeyond(part, m_reach); });
			const auto left = static_cast<std::size_t>(lost - m_parts.begin());
			for (const TrimPart& part : m_parts.subspan(left, m_left - left))
			{
				allowances.take(part);
			}
			m_left = left;
			findFirst();
		}
	}

	// The resulting reach in the steps of files. Parts between it and the next receiver are not lost.
	VolumeReach finish(TrimAllowances& allowances)
	{
		const VolumeReach reach = rounded(m_reach);
		const auto lost = std::partition(m_parts.begin() + static_cast<std::ptrdiff_t>(m_left), m_parts.end(),
										 [reach](const TrimPart& part) { return !isBeyond(part, reach); });
		const auto left = static_cast<std::size_t>(lost - m_parts.begin());
		for (const TrimPart& part : m_parts.subspan(m_left, left - m_left))
		{
			allowances.giveBack(part);
		}
		m_left = left;
		return reach;
	}

	std::size_t lost() const // number of parts
	{
		return m_parts.size() - m_left;
	}

private:
	// Ways to make it smaller: lower, narrower, both.
	static constexpr int kWays = 3;

	struct Step
	{
		double value = 0.0;
		VolumeReach reach;
	};

	static VolumeReach cutTo(int way, VolumeReach reach, uint32_t along)
	{
		const float to = static_cast<float>(along) / 1024.0F;
		return {way == 1 ? reach.height : std::min(reach.height, to), way == 0 ? reach.side : std::min(reach.side, to)};
	}

	void findFirst()
	{
		m_first.fill({});
		for (const TrimPart& part : m_parts.first(m_left))
		{
			for (std::size_t way = 0; way < kWays; ++way)
			{
				const auto along = [way](const TrimPart& of)
				{
					return of.along(static_cast<int>(way));
				};
				m_first[way] = along(part) > along(m_first[way]) ? part : m_first[way];
			}
		}
	}

	// Outermost parts first, while the cost is acceptable.
	void look(int way, const TrimAllowances& allowances, double price, TrimQueue& queue, Step& best) const
	{
		const double now = surface(m_reach);
		const double most = price * (now - surface(cutTo(way, m_reach, 0)));
		const auto isTooMuch = [&](const TrimPart& part, double before)
		{
			return !allowances.canTake(part) || most - (before + allowances.lossOf(part)) <= best.value;
		};
		if (m_left == 0 || isTooMuch(m_first[static_cast<std::size_t>(way)], 0.0))
		{
			return;
		}
		const uint32_t step = way == 1 ? static_cast<uint32_t>(m_reach.height * 128.0F) : 8; // of files, in 1/1024
		const uint32_t outermost = m_first[static_cast<std::size_t>(way)].along(way) / step;
		queue.fill(m_parts.first(m_left), way, step, outermost);
		double loss = 0.0;
		for (uint32_t steps = outermost; steps > 0; --steps)
		{
			if (queue.isEmpty(steps))
			{
				continue;
			}
			for (uint32_t i = queue.first(steps); i != TrimQueue::kNone; i = queue.next(i))
			{
				if (isTooMuch(m_parts[i], loss))
				{
					return; // everything after it costs more
				}
				loss += allowances.lossOf(m_parts[i]);
			}
			const VolumeReach reach = cutTo(way, m_reach, steps * step);
			const double value = price * (now - surface(reach)) - loss;
			if (value > best.value)
			{
				best = {value, reach};
			}
		}
	}

	std::span<TrimPart> m_parts; // remaining parts first, by receiver, then lost ones
	std::size_t m_left = 0;
	std::array<TrimPart, kWays> m_first; // an outermost remaining part of each way
	double m_area = 0.0;                 // polygon area, in squared distances
	double m_outline = 0.0;              // polygon perimeter, in distances
	double m_mitres = 0.0;               // growth at corners, in squares of the side
	double m_sides = 1.0;
	VolumeReach m_reach;
};

constexpr std::size_t kFewestReceivers = 4;    // per volume that is trimmed
constexpr int kRays = 16;                      // from a polygon whose volume has fewer receivers
constexpr std::size_t kSample = 4096;          // receivers sampled to estimate the shares per receiver
constexpr std::size_t kReceiversAtOnce = 4096; // receivers processed at a time
constexpr std::size_t kGroup = 16;             // of them by a thread

// Final price of a volume's surface, with an allowance of 1, relative to the average loss per surface. With an allowance of 0.15 or
// 0.2 it stops few exchanges by itself.
constexpr double kExchange = 0.5;
constexpr int kRounds = 10; // number of times the price doubles to get there

struct Asked
{
	std::vector<std::vector<TrimPart>> parts; // by volume
	std::vector<double> sums;                 // by receiver
	std::size_t shares = 0;
	std::size_t left_out = 0; // receivers
};

// Drops random points if all of them would have more than `most_shares` shares; returns how many.
std::size_t leaveOut(const VolumeEvaluator& evaluator, std::size_t most_shares, const RunSettings& run,
					 std::vector<ReferencePoint>& points)
{
	if (points.size() <= kSample)
	{
		return 0;
	}
	Random random(1, 0x7219);
	for (uint32_t i = 0; i < points.size(); ++i)
	{
		std::swap(points[i], points[random.below(i + 1)]);
	}
	std::vector<VolumeSum> sums(kSample);
	parallelFor(kSample, run.threads,
				[&](std::size_t i)
				{
					const VolumeReceiver receiver{points[i].position, points[i].normal};
					evaluator.sums({&receiver, 1}, {&sums[i], 1});
				});
	std::size_t shares = 0;
	for (const VolumeSum& sum : sums)
	{
		shares += sum.volumes;
	}
	const std::size_t before = points.size();
	points.resize(std::clamp(shares > 0 ? most_shares * kSample / shares : before, kSample, before));
	return before - points.size();
}

// Adds the contributions of volumes to these receivers.
void ask(double distance_m, const VolumeEvaluator& evaluator, std::vector<ReferencePoint> points, std::size_t most_shares,
		 const RunSettings& run, Asked& asked)
{
	asked.left_out += leaveOut(evaluator, most_shares, run, points);
	const auto per_m = static_cast<float>(1.0 / distance_m);
	const std::vector<uint32_t> order = nearOrder(points);
	std::vector<std::vector<VolumeShare>> shares(kReceiversAtOnce);
	ProgressCounter progress(run.progress, "trim", points.size());
	for (std::size_t first = 0; first < points.size(); first += kReceiversAtOnce)
	{
		const std::size_t count = std::min(kReceiversAtOnce, points.size() - first);
		parallelFor((count + kGroup - 1) / kGroup, run.threads,
					[&](std::size_t group)
					{
						const std::size_t begin = group * kGroup;
						const std::size_t size = std::min(kGroup, count - begin);
						const auto receivers = mapped(std::span(order).subspan(first + begin, size),
													  [&](uint32_t i) {
														  return VolumeReceiver{points[i].position, points[i].normal};
													  });
						evaluator.shares(receivers, std::span(shares).subspan(begin, size));
					});
		for (std::size_t i = 0; i < count; ++i)
		{
			double sum = 0.0;
			for (const VolumeShare& share : shares[i])
			{
				sum += static_cast<double>(share.occlusion);
				const VolumeReach needed{share.height_m * per_m, share.outside_m * per_m};
				asked.parts[share.polygon].emplace_back(static_cast<uint32_t>(asked.sums.size()), share.occlusion, needed);
			}
			asked.sums.push_back(sum);
			asked.shares += shares[i].size();
		}
		progress.finish(count);
	}
}

// Adds points that a polygon sees within its volume, from both sides if it has two.
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
		const glm::dvec3 way = side + 0.999 * directionOf(random); // cosine-distributed
		const glm::dvec3 from = pointOf({corners[0], corners[fan], corners[fan + 1]}, u, v) +
								side * (kVolumeBias * volumes.distance_m + tracer.error());
		if (const auto seen = surfaceAlong(tracer, from, way, volumes.distance_m / glm::length(way)))
		{
			points.push_back(*seen);
		}
	}
}

// Points seen by polygons whose volumes have hardly any receivers.
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
	ask(volumes.distance_m, evaluator, {receivers.begin(), receivers.end()}, most_shares, run, asked);
	if (tracer != nullptr)
	{
		ask(volumes.distance_m, evaluator, seenOfFew(*tracer, volumes, asked, run), most_shares, run, asked);
	}
	return asked;
}

// All possible losses relative to the total surface of the volumes.
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
	TrimQueue queue;
	for (int round = kRounds; round >= 0; --round)
	{
		const double price = std::ldexp(last, -round);
		for (Shrinking& volume : shrinking)
		{
			volume.shrink(allowances, price, queue);
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
