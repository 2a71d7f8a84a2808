// SPDX-License-Identifier: GPL-3.0-or-later
// Rays see what volumes do not: that there is a wall between. A side goes only where nothing was found that sees it: neither rays
// from it nor segments between it and each of its receivers get there, nor those of receivers sampled by themselves.
#include "core/math.h"
#include "core/parallel.h"
#include "volume/drop_search.h"
#include "volume/hidden.h"
#include "volume/sight.h"
#include "volume/verify.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace nook::detail
{
namespace
{

// Two samples of receivers: one finds sides that were missed, the other measures what still is.
constexpr ReceiverSettings kFirstSample{0, 0, 10'000, 10'000, 11};
constexpr ReceiverSettings kSecondSample{0, 0, 10'000, 10'000, 12};

enum class Seen : uint8_t
{
	yes,
	no,
	unsettled,
};

struct Answer
{
	Seen seen = Seen::yes;
	uint64_t segments = 0;
};

// That of the volume, no further than a polygon of that area can give kHiddenLeast: a form factor is at most area / (π r²).
VolumeRegion nearRegion(const DropSearch& search, std::size_t polygon, unsigned side)
{
	VolumeRegion region = search.region(polygon, side);
	const double far_m = std::sqrt(search.areas[polygon] / (kPi * kHiddenLeast));
	glm::dvec3 least(1e300);
	glm::dvec3 most(-1e300);
	for (const glm::dvec3& corner : search.corners(polygon))
	{
		least = glm::min(least, corner - far_m);
		most = glm::max(most, corner + far_m);
	}
	region.box.least = glm::max(region.box.least, least);
	region.box.most = glm::min(region.box.most, most);
	return region;
}

// The parts of receivers within a region that may get more than kHiddenLeast, those that may get most first.
class Pieces
{
public:
	void gather(const DropSearch& search, std::size_t polygon, unsigned side)
	{
		m_corners.clear();
		m_parts.clear();
		const VolumeRegion region = nearRegion(search, polygon, side);
		const auto alpha = static_cast<double>(search.occluders.polygons[polygon].alpha);
		search.forReceivers(
			polygon, region,
			[&](const FoundReceiver& found)
			{
				const double share = found.finding != Finding::needed
										 ? 0.0
										 : greatestShare(region, search.corners(polygon), search.areas[polygon], alpha,
														 found.receiver, found.rise_m);
				if (share > kHiddenLeast)
				{
					add(region, found.receiver, share, 0.25 * search.distance_m);
				}
				return true;
			},
			false);
		std::stable_sort(m_parts.begin(), m_parts.end(), [](const Part& a, const Part& b) { return a.share > b.share; });
		m_pieces.clear();
		for (const Part& part : m_parts)
		{
			m_pieces.push_back({std::span(m_corners).subspan(part.first, part.count), part.normal});
		}
	}

	std::span<const SightPiece> all() const
	{
		return m_pieces;
	}

	// Its triangle is so large that only a part of it may be a receiver: a floor within a column.
	bool large(std::size_t piece) const
	{
		return m_parts[piece].large;
	}

private:
	struct Part
	{
		std::size_t first = 0;
		std::size_t count = 0;
		glm::dvec3 normal{0.0};
		double share = 0.0;
		bool large = false;
	};

	void add(const VolumeRegion& region, const ReceiverSide& receiver, double share, double large_m)
	{
		const std::size_t first = m_corners.size();
		const std::size_t count = partWithin(region, receiver.corners, m_corners);
		if (count < 3)
		{
			m_corners.resize(first);
			return;
		}
		const auto& [a, b, c] = receiver.corners;
		const double longest_m = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
		m_parts.push_back({first, count, receiver.flat, share, longest_m > large_m});
	}

	std::vector<glm::dvec3> m_corners;
	std::vector<Part> m_parts;
	std::vector<SightPiece> m_pieces;
};

Answer lookFor(const DropSearch& search, const SightSettings& settings, std::size_t polygon, unsigned side, Pieces& pieces)
{
	// Most sides are seen, which few rays tell.
	const auto turn = static_cast<uint32_t>(2 * polygon + side);
	const glm::dvec3 normal = search.normal(polygon, side);
	if (seesReceiver(search.tracer, search.sides, search.corners(polygon), normal, 0.25 * search.distance_m, search.distance_m,
					 turn))
	{
		return {};
	}
	pieces.gather(search, polygon, side);
	if (pieces.all().empty())
	{
		return {}; // it gives little anywhere, which says nothing of what lies between; many of its kind may give much
	}
	const auto counts = [&](std::size_t piece, glm::dvec3 point)
	{
		return !search.solids || !pieces.large(piece) ||
			   isOpen(search.tracer, search.sides.materials, point, pieces.all()[piece].normal, turn);
	};
	Answer answer;
	const bool seen = Sight(search.tracer, settings).sees({search.corners(polygon), normal}, pieces.all(), counts, answer.segments);
	answer.seen = !seen ? Seen::no : answer.segments > settings.most_segments ? Seen::unsettled : Seen::yes;
	return answer;
}

struct Side
{
	uint32_t polygon = 0;
	unsigned side = 0;
};

// Those found hidden, in order. With both sides or none only where there is no turning round.
std::vector<Side> hiddenSides(DropSearch& search)
{
	std::vector<Side> sides;
	for (std::size_t i = 0; i < search.found.size(); ++i)
	{
		std::array<Finding, 2>& found = search.found[i];
		for (unsigned side = 0; side < 2; ++side)
		{
			if (found[side] == Finding::hidden && !search.settings.sides && found[1 - side] == Finding::needed)
			{
				found[side] = Finding::needed;
			}
			if (found[side] == Finding::hidden)
			{
				sides.push_back({static_cast<uint32_t>(i), side});
			}
		}
	}
	return sides;
}

VolumeSet volumesOf(const DropSearch& search, std::span<const Side> sides)
{
	VolumeSet set;
	set.distance_m = search.distance_m;
	set.exact_bounds = search.exact_bounds;
	for (const Side& side : sides)
	{
		Occluder occluder = search.occluders.polygons[side.polygon];
		occluder.two_sided = false;
		append(occluder, search.corners(side.polygon), side.side == 1, set.occluders);
	}
	return set;
}

void findSides(DropSearch& search, double lift_m)
{
	const std::size_t count = search.occluders.polygons.size();
	const SightSettings settings{search.distance_m, lift_m};
	std::vector<DropCounts> counts((count + kDropBlock - 1) / kDropBlock);
	ProgressCounter progress(search.run.progress, "sight", counts.size());
	parallelFor(counts.size(), search.run.threads,
				[&](std::size_t block)
				{
					Pieces pieces;
					for (std::size_t i = block * kDropBlock; i < std::min(count, (block + 1) * kDropBlock); ++i)
					{
						for (unsigned side = 0; side < 2; ++side)
						{
							if (search.found[i][side] != Finding::needed || search.inside[i] != 0)
							{
								continue;
							}
							const Answer answer = lookFor(search, settings, i, side, pieces);
							search.found[i][side] = answer.seen == Seen::no ? Finding::hidden : Finding::needed;
							counts[block].hidden_segments += answer.segments;
							counts[block].hidden_unsettled += answer.seen == Seen::unsettled ? 1 : 0;
						}
					}
					progress.finishOne();
				});
	for (const DropCounts& of_block : counts)
	{
		search.counts.hidden_segments += of_block.hidden_segments;
		search.counts.hidden_unsettled += of_block.hidden_unsettled;
	}
}

} // namespace

Occluders findHidden(DropSearch& search)
{
	const double lift_m = sightLift(search.tracer, search.distance_m, search.settings.surface_m);
	findSides(search, lift_m);
	std::vector<Side> sides = hiddenSides(search);
	if (sides.empty())
	{
		return {};
	}
	const auto check = [&](const ReceiverSettings& sample)
	{
		return hiddenShares(volumesOf(search, sides), search.tracer,
							sampleReceivers(search.tracer, search.distance_m, sample, search.run, &search.sides.materials), lift_m,
							search.run);
	};
	const HiddenShares first = check(kFirstSample);
	for (std::size_t i = 0; i < sides.size(); ++i)
	{
		if (first.seen_volumes[i] != 0)
		{
			search.found[sides[i].polygon][sides[i].side] = Finding::needed;
			search.counts.hidden_restored += 1;
		}
	}
	sides = hiddenSides(search);
	search.counts.hidden_check = check(kSecondSample).check;
	search.counts.hidden_sides = sides.size();
	return volumesOf(search, sides).occluders;
}

} // namespace nook::detail
