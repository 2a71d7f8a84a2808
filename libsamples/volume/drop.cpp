// SPDX-License-Identifier: GPL-3.0-or-later
// For each side of every polygon: is there a triangle in its region, on a visible side, with the polygon above its tangent plane?
// Then drops the smallest contributions as long as no receiver loses too much.
#include "volume/drop.h"

#include "core/archive.h"
#include "core/math.h"
#include "core/parallel.h"
#include "core/work_units.h"
#include "volume/receivers.h"
#include "volume/region.h"
#include "volume/sight.h"
#include "volume/volumes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

// Shared by the steps of dropVolumes(): the polygons, the level's triangles, and what each side of a polygon may darken.
namespace nook::detail
{

// The strongest receiver found for one side of a polygon.
enum class SideVerdict : uint8_t
{
	alone,  // no triangle in its region
	convex, // no triangle that has it above its tangent plane
	inside, // only inside solids
	unseen, // only invisible receivers
	hidden, // only receivers it cannot see
	needed,
};

inline constexpr std::size_t kDropBlock = 256; // polygons per thread and step

struct FoundReceiver;

struct DropSearch
{
	const Occluders& occluders;
	const Tracer& tracer;
	double distance_m;
	bool exact_bounds;
	const DropSettings& settings;
	const RunSettings& run;

	std::unique_ptr<TriangleTree> tree = nullptr;
	ReceiverSides sides = {};
	bool solids = false;                                // points inside solids are no receivers
	std::vector<double> areas = {};                     // per polygon, m²
	std::vector<std::array<SideVerdict, 2>> found = {}; // front and back
	std::vector<uint8_t> inside = {};                   // per polygon: inside solids
	std::vector<uint8_t> least = {};                    // per polygon: contributes too little
	DropCounts counts = {};

	std::size_t blocks() const
	{
		return (occluders.polygons.size() + kDropBlock - 1) / kDropBlock;
	}

	// Calls visit(polygon) for the polygons of a block.
	template <class Visit> void forBlock(std::size_t block, Visit&& visit) const
	{
		for (std::size_t i = block * kDropBlock; i < std::min(occluders.polygons.size(), (block + 1) * kDropBlock); ++i)
		{
			visit(i);
		}
	}

	double sizeOf(std::size_t block) const
	{
		return static_cast<double>(std::min(occluders.polygons.size() - block * kDropBlock, kDropBlock));
	}

	std::span<const glm::dvec3> corners(std::size_t polygon) const
	{
		const Occluder& occluder = occluders.polygons[polygon];
		return occluders.cornersOf(occluder);
	}

	// Unit; side 0: the front's.
	glm::dvec3 normal(std::size_t polygon, unsigned side) const
	{
		const glm::dvec3 front = frontOf(corners(polygon));
		return side == 0 ? front : -front;
	}

	VolumeRegion region(std::size_t polygon, unsigned side) const
	{
		return regionOf(corners(polygon), normal(polygon, side), normal(polygon, 0), distance_m, exact_bounds);
	}

	// Calls visit(FoundReceiver) for each side of a triangle that reaches into the region and has the polygon above its plane,
	// until it returns false. Returns whether any triangle reaches into the region.
	template <class Visit> bool forReceivers(std::size_t polygon, const VolumeRegion& region, Visit&& visit) const
	{
		return forSides<true>(polygon, region, visit);
	}

	// Likewise for needed receivers, possibly including triangles that do not reach into the region.
	template <class Visit> void forNeeded(std::size_t polygon, const VolumeRegion& region, Visit&& visit) const
	{
		forSides<false>(polygon, region, visit);
	}

private:
	template <bool kAll, class Visit> bool forSides(std::size_t polygon, const VolumeRegion& region, Visit& visit) const;
};

struct FoundReceiver
{
	SideVerdict verdict = SideVerdict::needed; // or unseen, or inside
	uint32_t triangle = 0;
	unsigned side = 0; // 0: front
	ReceiverSide receiver;
	double rise_m = 0.0; // height of the polygon above it (region.h)
};

template <bool kAll, class Visit> bool DropSearch::forSides(std::size_t polygon, const VolumeRegion& region, Visit& visit) const
{
	const Level& level = tracer.level();
	const std::span<const glm::dvec3> of = corners(polygon);
	bool any = false;
	FoundReceiver here;
	tree->visit(region.box, region.planes(),
				[&](uint32_t triangle)
				{
					const glm::uvec3 corner = level.triangles[triangle];
					if (kAll && !reaches(region, {level.positions[corner.x], level.positions[corner.y], level.positions[corner.z]}))
					{
						return true;
					}
					any = true;
					here.triangle = triangle;
					for (here.side = 0; here.side < 2; ++here.side)
					{
						const auto bit = static_cast<uint8_t>(1U << here.side);
						if (!kAll && (sides.seen[triangle] & bit) == 0)
						{
							continue;
						}
						if (!receiverSide(level, triangle, static_cast<int>(here.side), settings.smooth_normals, here.receiver))
						{
							continue;
						}
						here.rise_m = riseOf(of, here.receiver);
						here.verdict = (sides.seen[triangle] & bit) != 0      ? SideVerdict::needed
									   : (sides.outside[triangle] & bit) != 0 ? SideVerdict::unseen
																			  : SideVerdict::inside;
						if (here.rise_m > kRise * distance_m && !visit(std::as_const(here)))
						{
							return false;
						}
					}
					return true;
				});
	return any;
}

// Appends the polygon, reversed on request.
inline void append(Occluder occluder, std::span<const glm::dvec3> corners, bool turned, Occluders& to)
{
	occluder.first_corner = static_cast<uint32_t>(to.corners.size());
	to.corners.insert(to.corners.end(), corners.begin(), corners.end());
	if (turned)
	{
		std::reverse(to.corners.begin() + occluder.first_corner, to.corners.end());
	}
	to.polygons.push_back(occluder);
}

// The verdicts of a block's polygons.
void passVerdicts(Archive& archive, DropSearch& search, std::size_t block);

// Stages that need a block's verdicts run in the share that has them.
std::string groupOfBlock(std::size_t block);

// Marks needed sides that see none of their receivers as hidden, and returns them as one-sided polygons.
Occluders findHidden(DropSearch& search);

// Marks needed polygons whose contributions can be left out (drop_least.cpp).
void findLeast(DropSearch& search);

} // namespace nook::detail

namespace nook
{

namespace
{

using detail::DropSearch;
using detail::FoundReceiver;
using detail::kDropBlock;
using detail::SideVerdict;

SideVerdict find(const DropSearch& search, std::size_t polygon, unsigned side)
{
	SideVerdict found = SideVerdict::alone;
	const bool any = search.forReceivers(polygon, search.region(polygon, side),
										 [&](const FoundReceiver& receiver)
										 {
											 found = std::max(found, receiver.verdict);
											 return found != SideVerdict::needed;
										 });
	return found == SideVerdict::alone && any ? SideVerdict::convex : found;
}

// Cost per polygon in microseconds, measured on Sponza; a reference ray costs about one.
constexpr double kReceiversCost = 10.0;
constexpr double kSolidsCost = 4.0;

constexpr int kLifts = 4; // heights at which a simplified polygon may emerge from the surface

void findReceivers(DropSearch& search, const RunSettings& run)
{
	const auto compute = [&](std::size_t i)
	{
		search.found[i][0] = find(search, i, 0);
		search.found[i][1] = search.occluders.polygons[i].two_sided ? find(search, i, 1) : SideVerdict::alone;
	};
	runStage({"receivers", search.blocks(), [&](std::size_t block) { return kReceiversCost * search.sizeOf(block); },
			  [&](std::size_t block) { search.forBlock(block, compute); },
			  [&](std::size_t block, Archive& archive) { detail::passVerdicts(archive, search, block); }, detail::groupOfBlock},
			 run);
}

void findInside(DropSearch& search)
{
	const Bounds& bounds = search.tracer.bounds();
	const double step_m = 0.005 * glm::length(bounds.most - bounds.least);
	const auto is_open_over = [&](std::span<const glm::dvec3> corners, std::size_t i, unsigned side)
	{
		return isOpen(search.tracer, search.sides.materials, corners, search.normal(i, side), step_m,
					  static_cast<uint32_t>(2 * i + side));
	};
	// A simplified polygon may lie below the original surface; try several heights, since the space in front may be narrow.
	const auto is_open = [&](std::size_t i, unsigned side)
	{
		bool open = is_open_over(search.corners(i), i, side);
		for (int part = 1; part <= kLifts && !open && search.settings.simplified_m > 0.0; ++part)
		{
			std::vector<glm::dvec3> lifted(search.corners(i).begin(), search.corners(i).end());
			for (glm::dvec3& corner : lifted)
			{
				corner += part * search.settings.simplified_m / kLifts * search.normal(i, side);
			}
			open = is_open_over(lifted, i, side);
		}
		return open;
	};
	runStage({"solids", search.blocks(), [&](std::size_t block) { return kSolidsCost * search.sizeOf(block); },
			  [&](std::size_t block)
			  { search.forBlock(block, [&](std::size_t i) { search.inside[i] = !is_open(i, 0) && !is_open(i, 1) ? 1 : 0; }); },
			  [&](std::size_t block, Archive& archive)
			  { search.forBlock(block, [&](std::size_t i) { archive(search.inside[i]); }); },
			  detail::groupOfBlock},
			 search.run);
}

// A room whose walls face outwards, with the cameras inside, looks like one solid.
void refuseInside(DropSearch& search)
{
	DropCounts& counts = search.counts;
	for (std::size_t i = 0; i < search.found.size(); ++i)
	{
		const SideVerdict best = std::max(search.found[i][0], search.found[i][1]);
		counts.inside_m2 += search.inside[i] != 0 || best == SideVerdict::inside ? search.areas[i] : 0.0;
	}
	if (counts.inside_m2 > 0.5 * counts.area_m2)
	{
		counts.inside_refused = true;
		search.solids = false;
		search.inside.assign(search.inside.size(), 0);
		search.sides =
			receiverSides(search.tracer, {false, search.settings.visible_from, search.settings.seen_rays, true}, search.run);
		findReceivers(search, withoutUnits(search.run)); // computed by no part
	}
}

// Returns false for a dropped polygon and counts it.
bool isKept(DropSearch& search, std::size_t polygon)
{
	DropCounts& counts = search.counts;
	const SideVerdict best = std::max(search.found[polygon][0], search.found[polygon][1]);
	if (search.inside[polygon] != 0)
	{
		counts.inside += 1;
		return false;
	}
	if (best != SideVerdict::needed && (search.settings.no_receiver || best == SideVerdict::hidden))
	{
		counts.alone += best == SideVerdict::alone ? 1 : 0;
		counts.convex += best == SideVerdict::convex ? 1 : 0;
		counts.enclosed += best == SideVerdict::inside ? 1 : 0;
		counts.hidden += best == SideVerdict::hidden ? 1 : 0;
		counts.unseen += best == SideVerdict::unseen ? 1 : 0;
		return false;
	}
	counts.below += search.least[polygon];
	return search.least[polygon] == 0;
}

Dropped collect(DropSearch& search)
{
	Dropped dropped;
	dropped.occluders.polygons.reserve(search.occluders.polygons.size());
	for (std::size_t i = 0; i < search.occluders.polygons.size(); ++i)
	{
		if (!isKept(search, i))
		{
			continue;
		}
		Occluder occluder = search.occluders.polygons[i];
		const bool front = search.found[i][0] == SideVerdict::needed;
		const bool back = search.found[i][1] == SideVerdict::needed;
		const bool one_side = search.settings.sides && occluder.two_sided && front != back;
		search.counts.turned += one_side ? 1 : 0;
		occluder.two_sided = occluder.two_sided && !one_side;
		detail::append(occluder, search.corners(i), one_side && back, dropped.occluders);
	}
	search.counts.kept = dropped.occluders.polygons.size();
	return dropped;
}

void start(DropSearch& search)
{
	const std::size_t count = search.occluders.polygons.size();
	search.counts.polygons = count;
	search.counts.triangles = search.tracer.level().triangles.size();
	search.areas.resize(count);
	for (std::size_t i = 0; i < count; ++i)
	{
		search.areas[i] = polygonArea(search.corners(i));
		search.counts.area_m2 += search.areas[i];
	}
	search.found.assign(count, {SideVerdict::needed, SideVerdict::needed});
	search.inside.assign(count, 0);
	search.least.assign(count, 0);
}

} // namespace

void detail::passVerdicts(Archive& archive, DropSearch& search, std::size_t block)
{
	search.forBlock(block, [&](std::size_t i) { archive(search.found[i][0], search.found[i][1]); });
}

std::string detail::groupOfBlock(std::size_t block)
{
	return "block " + std::to_string(block);
}

void visit(Archive& archive, ReceiverSides& sides)
{
	archive(sides.materials.oriented, sides.materials.fronts, sides.materials.backs, sides.there, sides.outside, sides.seen,
			sides.inside_sides, sides.unseen_sides, sides.check_rays, sides.check_missed);
}

Dropped dropVolumes(const Occluders& occluders, const Tracer& tracer, double distance_m, bool exact_bounds,
					const DropSettings& settings, const RunSettings& run)
{
	assert(distance_m > 0.0 && settings.below >= 0.0 && settings.below <= 1.0 && settings.seen_rays >= 1);
	DropSearch search{occluders, tracer, distance_m, exact_bounds, settings, run};
	start(search);
	if (settings.no_receiver || settings.sides || settings.inside || settings.hidden || settings.below > 0.0)
	{
		const SideSettings sides{settings.inside, settings.visible_from, settings.seen_rays, false, settings.receivers};
		runOnce(
			"sides", [&] { search.sides = receiverSides(tracer, sides, withoutUnits(run)); },
			[&](Archive& archive) { archive(search.sides); }, run);
		search.tree = std::make_unique<TriangleTree>(tracer.level(), search.sides.there, run.threads);
		findReceivers(search, run);
	}
	search.solids = settings.inside;
	if (settings.inside)
	{
		findInside(search);
	}
	if (settings.inside && !isShare(run))
	{
		refuseInside(search);
	}
	Occluders hidden;
	if (settings.hidden)
	{
		hidden = findHidden(search);
	}
	if (isShare(run))
	{
		return {};
	}
	if (settings.below > 0.0)
	{
		findLeast(search);
	}
	search.counts.inside_sides = search.sides.inside_sides;
	search.counts.unseen_sides = search.sides.unseen_sides;
	search.counts.check_rays = search.sides.check_rays;
	search.counts.check_missed = search.sides.check_missed;
	Dropped dropped = collect(search);
	dropped.hidden = std::move(hidden);
	dropped.counts = search.counts;
	return dropped;
}

} // namespace nook

namespace nook::detail
{

// Greedy, in ascending order of a polygon's greatest possible contribution at any receiver; each triangle side may lose `below` in
// total.

namespace
{

struct Loss
{
	uint32_t side; // 2 · triangle + side
	float share;   // rounded up
};

// Collects what a polygon may take from each receiver side if that is at most `below` everywhere; else none and a value above
// `below`.
double lossesOf(const DropSearch& search, std::size_t polygon, std::vector<Loss>& losses)
{
	double most = 0.0;
	for (unsigned side = 0; side < 2; ++side)
	{
		if (search.found[polygon][side] != SideVerdict::needed)
		{
			continue;
		}
		const VolumeRegion region = search.region(polygon, side);
		const auto alpha = static_cast<double>(search.occluders.polygons[polygon].alpha);
		const auto add = [&](const FoundReceiver& found)
		{
			const double share =
				found.verdict != SideVerdict::needed
					? 0.0
					: greatestShare(region, search.corners(polygon), search.areas[polygon], alpha, found.receiver, found.rise_m);
			most = std::max(most, share);
			if (share > 0.0)
			{
				losses.push_back({2 * found.triangle + found.side, static_cast<float>(share * (1.0 + 0x1p-22))});
			}
			return most <= search.settings.below;
		};
		search.forReceivers(polygon, region, add);
		if (most > search.settings.below)
		{
			losses.clear();
			return most;
		}
	}
	return most;
}

bool isNeeded(const DropSearch& search, std::size_t polygon)
{
	return search.inside[polygon] == 0 &&
		   (search.found[polygon][0] == SideVerdict::needed || search.found[polygon][1] == SideVerdict::needed);
}

} // namespace

void findLeast(DropSearch& search)
{
	const std::size_t count = search.found.size();
	const double below = search.settings.below;
	std::vector<std::vector<Loss>> losses(count);
	std::vector<double> greatest(count, 2.0);
	ProgressCounter progress(search.run.progress, "contributions", (count + kDropBlock - 1) / kDropBlock);
	parallelFor((count + kDropBlock - 1) / kDropBlock, search.run.threads,
				[&](std::size_t block)
				{
					std::vector<Loss> here;
					for (std::size_t i = block * kDropBlock; i < std::min(count, (block + 1) * kDropBlock); ++i)
					{
						if (isNeeded(search, i))
						{
							here.clear();
							greatest[i] = lossesOf(search, i, here);
							losses[i] = here;
						}
					}
					progress.finishOne();
				});
	std::vector<uint32_t> order;
	for (std::size_t i = 0; i < count; ++i)
	{
		if (greatest[i] <= below)
		{
			order.push_back(static_cast<uint32_t>(i));
		}
	}
	std::sort(order.begin(), order.end(),
			  [&](uint32_t a, uint32_t b) { return greatest[a] != greatest[b] ? greatest[a] < greatest[b] : a < b; });
	std::vector<double> lost(2 * search.sides.seen.size(), 0.0);
	for (const uint32_t i : order)
	{
		const bool fits = std::all_of(losses[i].begin(), losses[i].end(),
									  [&](const Loss& loss) { return lost[loss.side] + static_cast<double>(loss.share) <= below; });
		if (fits)
		{
			search.least[i] = 1;
			for (const Loss& loss : losses[i])
			{
				lost[loss.side] += static_cast<double>(loss.share);
				search.counts.greatest_loss = std::max(search.counts.greatest_loss, lost[loss.side]);
			}
		}
		losses[i] = {};
	}
}

// Rays account for walls that volumes ignore. A side is dropped only if nothing reaches it: neither rays from it, nor segments
// between it and each of its receivers, nor segments from independently sampled receivers.
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
