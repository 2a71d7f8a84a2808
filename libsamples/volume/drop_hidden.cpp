// SPDX-License-Identifier: GPL-3.0-or-later
// Rays account for walls that volumes ignore. A side is dropped only if nothing reaches it: neither rays from it, nor segments
// between it and each of its receivers, nor segments from independently sampled receivers.
#include "core/math.h"
#include "core/work_units.h"
#include "volume/drop_search.h"
#include "volume/receivers.h"
#include "volume/sight.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace nook::detail
{
namespace
{

// The first sample finds missed sides, and the next measures the remaining loss. While that exceeds the bound, its sides are kept
// too, and another sample measures.
constexpr ReceiverSettings kFirstSample{0, 0, 10'000, 10'000, 11};
constexpr uint64_t kMostHiddenSamples = 12;

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

// The volume's region, limited to where a polygon of that area can contribute kHiddenLeast: a form factor is at most area / (π r²).
VolumeRegion nearRegion(const DropSearch& search, std::size_t polygon, unsigned side)
{
	VolumeRegion region = search.region(polygon, side);
	const double far_m = std::sqrt(search.areas[polygon] / (kPi * kHiddenLeast));
	const Bounds box = boundsAround(search.corners(polygon));
	region.box.least = glm::max(region.box.least, box.least - far_m);
	region.box.most = glm::min(region.box.most, box.most + far_m);
	return region;
}

// Whether the sides of large triangles are in the open, on a grid with cells of δ/48; each cell is tested at the first point that
// asks.
class OpenPlaces
{
public:
	explicit OpenPlaces(const DropSearch& search) : m_search(search), m_places_per_m(48.0 / search.distance_m) {}

	bool at(uint32_t side, glm::dvec3 point, glm::dvec3 normal)
	{
		const glm::dvec3 place = glm::floor(m_places_per_m * (point - m_search.tracer.bounds().least));
		const auto [found, is_new] = m_open.try_emplace({static_cast<double>(side), place.x, place.y, place.z}, false);
		if (is_new)
		{
			found->second = isOpen(m_search.tracer, m_search.sides.materials, point, normal, side);
		}
		return found->second;
	}

private:
	using Place = std::array<double, 4>;
	struct Hash
	{
		std::size_t operator()(const Place& place) const
		{
			uint64_t hash = 0;
			for (const double number : place)
			{
				hash = (hash ^ std::bit_cast<uint64_t>(number)) * 0x9e3779b97f4a7c15U;
				hash ^= hash >> 32U;
			}
			return hash;
		}
	};

	const DropSearch& m_search;
	double m_places_per_m;
	std::unordered_map<Place, bool, Hash> m_open;
};

// The parts of receivers in a region that may receive more than kHiddenLeast.
class Pieces
{
public:
	Pieces(const DropSearch& search, OpenPlaces& places) : m_search(search), m_places(places) {}

	// Returns true as soon as one sees the polygon, tested between both centres.
	bool gather(const Sight& sight, std::size_t polygon, unsigned side, uint64_t& segments);

	// Strongest contributions first, pieces whose centre is no receiver last.
	std::span<const SightPiece> inOrder();

	bool empty() const
	{
		return m_parts.empty();
	}

	// Only a part of a very large triangle may be a receiver, such as a floor that extends under a column.
	bool counts(std::size_t piece, glm::dvec3 point) const
	{
		return counts(m_parts[piece], point);
	}

private:
	struct Part
	{
		std::size_t first = 0;
		std::size_t count = 0;
		glm::dvec3 normal{0.0};
		double share = 0.0;
		uint32_t side = 0; // 2 · triangle + side
		bool large = false;
		bool last = false;
	};

	bool counts(const Part& part, glm::dvec3 point) const
	{
		return !m_search.solids || !part.large || m_places.at(part.side, point, part.normal);
	}
	SightPiece pieceOf(const Part& part) const
	{
		return {std::span(m_corners).subspan(part.first, part.count), part.normal};
	}
	bool add(const VolumeRegion& region, const FoundReceiver& found, double share);

	const DropSearch& m_search;
	OpenPlaces& m_places;
	std::vector<glm::dvec3> m_corners;
	std::vector<Part> m_parts;
	std::vector<SightPiece> m_pieces;
};

bool Pieces::add(const VolumeRegion& region, const FoundReceiver& found, double share)
{
	const std::size_t first = m_corners.size();
	const std::size_t count = partWithin(region, found.receiver.corners, m_corners);
	if (count < 3)
	{
		m_corners.resize(first);
		return false;
	}
	const auto& [a, b, c] = found.receiver.corners;
	const double longest_m = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
	m_parts.push_back(
		{first, count, found.receiver.flat, share, 2 * found.triangle + found.side, longest_m > 0.25 * m_search.distance_m, false});
	return true;
}

bool Pieces::gather(const Sight& sight, std::size_t polygon, unsigned side, uint64_t& segments)
{
	m_corners.clear();
	m_parts.clear();
	const VolumeRegion region = nearRegion(m_search, polygon, side);
	const auto alpha = static_cast<double>(m_search.occluders.polygons[polygon].alpha);
	const std::span<const glm::dvec3> corners = m_search.corners(polygon);
	const SightPiece of{corners, m_search.normal(polygon, side)};
	bool seen = false;
	m_search.forNeeded(polygon, region,
					   [&](const FoundReceiver& found)
					   {
						   const double share =
							   greatestShare(region, corners, m_search.areas[polygon], alpha, found.receiver, found.rise_m);
						   if (share > kHiddenLeast && add(region, found, share))
						   {
							   Part& part = m_parts.back();
							   const Segment met =
								   sight.middles(of, pieceOf(part), [&](glm::dvec3 point) { return counts(part, point); });
							   segments += 1;
							   part.last = met == Segment::discounted;
							   seen = met == Segment::open;
						   }
						   return !seen;
					   });
	return seen;
}

std::span<const SightPiece> Pieces::inOrder()
{
	std::stable_sort(m_parts.begin(), m_parts.end(),
					 [](const Part& a, const Part& b) { return a.last != b.last ? b.last : a.share > b.share; });
	m_pieces.clear();
	for (const Part& part : m_parts)
	{
		m_pieces.push_back(pieceOf(part));
	}
	return m_pieces;
}

Answer lookFor(const DropSearch& search, const SightSettings& settings, std::size_t polygon, unsigned side, Pieces& pieces)
{
	// Most sides are visible, which a few rays can show.
	const auto turn = static_cast<uint32_t>(2 * polygon + side);
	const glm::dvec3 normal = search.normal(polygon, side);
	if (seesReceiver(search.tracer, search.sides, search.corners(polygon), normal, 0.25 * search.distance_m, search.distance_m,
					 turn))
	{
		return {};
	}
	const Sight sight(search.tracer, settings);
	Answer answer;
	// A side that contributes little everywhere cannot be ruled out by sampling; many of its kind may contribute a lot.
	if (pieces.gather(sight, polygon, side, answer.segments) || pieces.empty())
	{
		return answer;
	}
	const bool seen = sight.sees(
		{search.corners(polygon), normal}, pieces.inOrder(),
		[&](std::size_t piece, glm::dvec3 point) { return pieces.counts(piece, point); }, answer.segments);
	answer.seen = !seen ? Seen::no : answer.segments > settings.most_segments ? Seen::unsettled : Seen::yes;
	return answer;
}

struct Side
{
	uint32_t polygon = 0;
	unsigned side = 0;
};

// The sides found hidden, in order. Without orientation, only if both sides are hidden or neither is.
std::vector<Side> hiddenSides(DropSearch& search)
{
	std::vector<Side> sides;
	for (std::size_t i = 0; i < search.found.size(); ++i)
	{
		std::array<SideVerdict, 2>& found = search.found[i];
		for (unsigned side = 0; side < 2; ++side)
		{
			if (found[side] == SideVerdict::hidden && !search.settings.sides && found[1 - side] == SideVerdict::needed)
			{
				found[side] = SideVerdict::needed;
			}
			if (found[side] == SideVerdict::hidden)
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

constexpr double kSightCost = 250.0; // see kReceiversCost

void findSides(DropSearch& search, double lift_m)
{
	const SightSettings settings{search.distance_m, lift_m};
	std::vector<DropCounts> counts(search.blocks());
	const auto look = [&](std::size_t block)
	{
		OpenPlaces places(search);
		Pieces pieces(search, places);
		search.forBlock(block,
						[&](std::size_t i)
						{
							for (unsigned side = 0; side < 2; ++side)
							{
								if (search.found[i][side] != SideVerdict::needed || search.inside[i] != 0)
								{
									continue;
								}
								const Answer answer = lookFor(search, settings, i, side, pieces);
								search.found[i][side] = answer.seen == Seen::no ? SideVerdict::hidden : SideVerdict::needed;
								counts[block].hidden_segments += answer.segments;
								counts[block].hidden_unsettled += answer.seen == Seen::unsettled ? 1 : 0;
							}
						});
	};
	const auto pass = [&](std::size_t block, Archive& archive)
	{
		archive(counts[block].hidden_segments, counts[block].hidden_unsettled);
		passVerdicts(archive, search, block);
	};
	// Shares assume that insides are not refused: only all of them together can tell.
	runStage(
		{"sight", counts.size(), [&](std::size_t block) { return kSightCost * search.sizeOf(block); }, look, pass, groupOfBlock},
		search.counts.inside_refused ? withoutUnits(search.run) : search.run);
	for (const DropCounts& of_block : counts)
	{
		search.counts.hidden_segments += of_block.hidden_segments;
		search.counts.hidden_unsettled += of_block.hidden_unsettled;
	}
}

// Returns how many.
uint64_t keepSeen(DropSearch& search, std::span<const Side> sides, const HiddenShares& shares)
{
	uint64_t kept = 0;
	for (std::size_t i = 0; i < sides.size(); ++i)
	{
		if (shares.seen_volumes[i] != 0)
		{
			search.found[sides[i].polygon][sides[i].side] = SideVerdict::needed;
			kept += 1;
		}
	}
	return kept;
}

} // namespace

Occluders findHidden(DropSearch& search)
{
	const double lift_m = sightLift(search.tracer, search.distance_m, search.settings.surface_m);
	findSides(search, lift_m);
	if (isShare(search.run))
	{
		return {};
	}
	std::vector<Side> sides = hiddenSides(search);
	DropCounts& counts = search.counts;
	ReceiverSettings sample = kFirstSample;
	for (bool enough = false; !sides.empty() && !enough; ++sample.seed)
	{
		const HiddenShares shares = hiddenShares(
			volumesOf(search, sides), search.tracer,
			sampleReceivers(search.tracer, search.distance_m, sample, search.run, &search.sides.materials), lift_m, search.run);
		counts.hidden_check = shares.check;
		counts.hidden_lost = shares.check.greatest > search.settings.hidden_bound;
		enough = counts.hidden_samples > 0 && (!counts.hidden_lost || counts.hidden_samples >= kMostHiddenSamples);
		if (!enough)
		{
			counts.hidden_samples += 1;
			counts.hidden_restored += keepSeen(search, sides, shares);
			sides = hiddenSides(search);
		}
	}
	if (sides.empty())
	{
		counts.hidden_lost = false;
		counts.hidden_check = {};
	}
	counts.hidden_sides = sides.size();
	return volumesOf(search, sides).occluders;
}

} // namespace nook::detail
