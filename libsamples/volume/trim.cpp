// SPDX-License-Identifier: GPL-3.0-or-later
// From the outside in: each volume is shortened past its outermost receiver as long as that can spare what it gets there. Those
// that spare the least of their sum go first, over all volumes; so receivers' allowances go where most fragments are saved for
// them.
#include "volume/trim.h"

#include "core/parallel.h"
#include "core/random.h"
#include "volume/evaluate.h"
#include "volume/prism.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

namespace nook
{
namespace
{

constexpr std::size_t kFewestReceivers = 4; // of a volume that is trimmed

// What one volume gives to one receiver.
struct Part
{
	uint32_t receiver = 0;
	float occlusion = 0.0F;
	float reach = 0.0F; // that takes
};

struct Asked
{
	std::vector<std::vector<Part>> parts; // by volume
	std::vector<double> sums;             // by receiver
	std::size_t shares = 0;
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

Asked ask(const VolumeSet& volumes, std::span<const ReferencePoint> receivers, const TrimSettings& settings, const RunSettings& run)
{
	constexpr std::size_t kBlock = 4096;
	const VolumeEvaluator evaluator(volumes, run);
	Asked asked;
	asked.parts.resize(volumes.occluders.polygons.size());
	const std::vector<uint32_t> order = shuffled(receivers.size());
	std::vector<std::vector<VolumeShare>> shares(kBlock);
	std::vector<std::vector<float>> reaches(kBlock);
	ProgressCounter progress(run.progress, "trim", (receivers.size() + kBlock - 1) / kBlock);
	while (asked.sums.size() < receivers.size() && asked.shares < settings.most_shares)
	{
		const std::size_t first = asked.sums.size();
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
							reaches[i].push_back(static_cast<float>(reachFor(volumes, polygon, receiver.position)));
						}
					});
		for (std::size_t i = 0; i < count; ++i)
		{
			double sum = 0.0;
			for (std::size_t k = 0; k < shares[i].size(); ++k)
			{
				const VolumeShare& share = shares[i][k];
				sum += static_cast<double>(share.occlusion);
				asked.parts[share.polygon].push_back({static_cast<uint32_t>(first + i), share.occlusion, reaches[i][k]});
			}
			asked.sums.push_back(sum);
			asked.shares += shares[i].size();
		}
		progress.finishOne();
	}
	return asked;
}

// How much each receiver has lost, and may lose.
class Allowances
{
public:
	Allowances(const std::vector<double>& sums, double share) : m_lost(sums.size()), m_most(sums.size())
	{
		for (std::size_t i = 0; i < sums.size(); ++i)
		{
			m_most[i] = share * std::max(sums[i], kTrimFloor);
		}
	}

	// Where the part is at most `most_part` of what its receiver may lose in all.
	bool take(const Part& part, double most_part)
	{
		const auto occlusion = static_cast<double>(part.occlusion);
		const double most = m_most[part.receiver];
		double& lost = m_lost[part.receiver];
		if (occlusion > most_part * most || lost + occlusion > most)
		{
			return false;
		}
		lost += occlusion;
		return true;
	}

	void giveBack(const Part& part)
	{
		m_lost[part.receiver] -= static_cast<double>(part.occlusion);
	}

	void describe(TrimCounts& counts) const
	{
		for (const double lost : m_lost)
		{
			counts.greatest_loss = std::max(counts.greatest_loss, lost);
			counts.mean_loss += lost / static_cast<double>(m_lost.size());
		}
	}

private:
	std::vector<double> m_lost;
	std::vector<double> m_most;
};

// Multiples of 1/128, as files have them; not below 1/128.
float rounded(float reach)
{
	return std::clamp(std::ceil(reach * 128.0F), 1.0F, 128.0F) / 128.0F;
}

} // namespace

double reachFor(const VolumeSet& volumes, const Occluder& polygon, glm::dvec3 position)
{
	const std::span<const glm::dvec3> corners = volumes.occluders.cornersOf(polygon);
	const glm::dvec3 front = frontOf(corners);
	double most_m = std::fabs(glm::dot(front, position - corners[0]));
	glm::dvec3 a = corners.back();
	for (const glm::dvec3& b : corners)
	{
		const glm::dvec3 outward = glm::normalize(glm::cross(b - a, front));
		most_m = std::max(most_m, glm::dot(outward, position - a));
		a = b;
	}
	return most_m / volumes.distance_m;
}

TrimCounts trimVolumes(VolumeSet& volumes, std::span<const ReferencePoint> receivers, const TrimSettings& settings,
					   const RunSettings& run)
{
	assert(settings.share > 0.0 && settings.share <= 1.0);
	Asked asked = ask(volumes, receivers, settings, run);
	std::vector<Occluder>& polygons = volumes.occluders.polygons;
	// Outermost last; equal ones by receiver.
	parallelFor(polygons.size(), run.threads,
				[&](std::size_t i)
				{
					std::sort(asked.parts[i].begin(), asked.parts[i].end(),
							  [](const Part& a, const Part& b)
							  { return a.reach != b.reach ? a.reach < b.reach : a.receiver < b.receiver; });
				});
	Allowances allowances(asked.sums, settings.share);
	std::vector<std::size_t> kept(polygons.size());
	for (std::size_t i = 0; i < polygons.size(); ++i)
	{
		kept[i] = asked.parts[i].size();
	}
	for (double most_part = 0x1p-14; most_part <= 1.0; most_part *= 2.0)
	{
		for (std::size_t i = 0; i < polygons.size(); ++i)
		{
			const std::vector<Part>& parts = asked.parts[i];
			while (parts.size() >= kFewestReceivers && kept[i] > 0 && allowances.take(parts[kept[i] - 1], most_part))
			{
				kept[i] -= 1;
			}
		}
	}

	TrimCounts counts;
	counts.receivers = asked.sums.size();
	counts.shares = asked.shares;
	double reach_sum = 0.0;
	for (std::size_t i = 0; i < polygons.size(); ++i)
	{
		// To the innermost receiver that does without, so that what lies between it and the next one is not lost.
		const std::vector<Part>& parts = asked.parts[i];
		polygons[i].reach = kept[i] < parts.size() ? rounded(parts[kept[i]].reach) : 1.0F;
		for (; kept[i] < parts.size() && parts[kept[i]].reach < polygons[i].reach; ++kept[i])
		{
			allowances.giveBack(parts[kept[i]]);
		}
		counts.lost += parts.size() - kept[i];
		counts.trimmed += polygons[i].reach < 1.0F ? 1U : 0U;
		reach_sum += static_cast<double>(polygons[i].reach);
	}
	counts.mean_reach = polygons.empty() ? 1.0 : reach_sum / static_cast<double>(polygons.size());
	allowances.describe(counts);
	return counts;
}

TrimCounts trimVolumes(VolumeSet& volumes, const Tracer& tracer, const TrimSettings& settings, const RunSettings& run)
{
	return trimVolumes(volumes, sampleReceivers(tracer, volumes.distance_m, settings.receivers, run), settings, run);
}

} // namespace nook
