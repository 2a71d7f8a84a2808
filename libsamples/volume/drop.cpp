// SPDX-License-Identifier: GPL-3.0-or-later
// For each side of every polygon: is there a triangle in its region, on a visible side, with the polygon above its tangent plane?
// Then drops the smallest contributions as long as no receiver loses too much.
#include "volume/drop.h"

#include "core/archive.h"
#include "core/lists.h"
#include "core/work_units.h"
#include "scene/ray_triangle.h"
#include "volume/receivers.h"
#include "volume/region.h"
#include "volume/volumes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace nook
{
namespace
{

// The strongest receiver found for one side of a polygon.
enum class SideVerdict : uint8_t
{
	alone,  // no triangle in its region
	convex, // no triangle that has it above its tangent plane
	inside, // only inside solids
	unseen, // only invisible receivers
	needed,
};

constexpr std::size_t kDropBlock = 256; // polygons per thread and step

struct FoundReceiver
{
	SideVerdict verdict = SideVerdict::needed; // or unseen, or inside
	uint32_t triangle = 0;
	unsigned side = 0; // 0: front
	ReceiverSide receiver;
	double rise_m = 0.0; // height of the polygon above it (region.h)
};

struct DropSearch
{
	const Occluders& occluders;
	const Tracer& tracer;
	double distance_m;
	bool exact_bounds;
	const DropSettings& settings;
	const RunSettings& run;

	std::unique_ptr<TriangleTree> tree = nullptr;
	std::unique_ptr<TriangleTree> seen_tree = nullptr; // of triangles with a visible side; none if cameras may be anywhere
	ReceiverSides sides = {};
	double step_m = 0.0;                                // between points of a polygon that rays start from
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
		return occluders.cornersOf(occluders.polygons[polygon]);
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
	// until it returns false; returns false then. Sets `any` if the triangle reaches into the region.
	template <class Visit>
	bool forTriangle(std::span<const glm::dvec3> of, const VolumeRegion& region, uint32_t triangle, bool& any, Visit&& visit) const
	{
		const Level& level = tracer.level();
		const glm::uvec3 corner = level.triangles[triangle];
		if (!reaches(region, {level.positions[corner.x], level.positions[corner.y], level.positions[corner.z]}))
		{
			return true;
		}
		any = true;
		FoundReceiver here;
		here.triangle = triangle;
		for (here.side = 0; here.side < 2; ++here.side)
		{
			const auto bit = static_cast<uint8_t>(1U << here.side);
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
	}

	// Likewise for all triangles, or those with a visible side, which is faster. Returns whether any of them reaches into the
	// region.
	template <class Visit>
	bool forReceivers(std::size_t polygon, const VolumeRegion& region, bool only_visible, Visit&& visit) const
	{
		const std::span<const glm::dvec3> of = corners(polygon);
		const glm::dvec3 centre = (of[0] + of[1] + of[2]) / 3.0; // the strongest are next to it
		bool any = false;
		const TriangleTree& among = only_visible && seen_tree ? *seen_tree : *tree;
		among.visit(region.box, region.planes(), centre,
					[&](uint32_t triangle)
					{ return (only_visible && sides.seen[triangle] == 0) || forTriangle(of, region, triangle, any, visit); });
		return any;
	}
};

// Stages that need a block's verdicts run in the share that has them.
std::string groupOfBlock(std::size_t block)
{
	return "block " + std::to_string(block);
}

constexpr int kLifts = 4; // heights at which a simplified polygon may emerge from the surface

// True if test(corners) holds for a side's corners. A simplified polygon may lie below the original surface: then also at several
// heights, since the space in front may be narrow.
template <class Test> bool anyLifted(const DropSearch& search, std::size_t polygon, unsigned side, Test&& test)
{
	bool holds = test(search.corners(polygon));
	for (int part = 1; part <= kLifts && !holds && search.settings.simplified_m > 0.0; ++part)
	{
		const glm::dvec3 lift = part * search.settings.simplified_m / kLifts * search.normal(polygon, side);
		holds = test(mapped(search.corners(polygon), [lift](const glm::dvec3& corner) { return corner + lift; }));
	}
	return holds;
}

// True if the cameras see a side, or it sees a surface that they see. Otherwise something opaque lies between it and all visible
// surfaces in its volume.
bool darkensVisible(const DropSearch& search, std::size_t polygon, unsigned side)
{
	const uint32_t triangle = search.occluders.polygons[polygon].triangle;
	const glm::dvec3 normal = search.normal(polygon, side);
	const bool is_front = glm::dot(twiceAreaOf(search.tracer.level(), triangle), normal) > 0.0;
	return (search.sides.seen[triangle] & (is_front ? kFrontSeen : kBackSeen)) != 0 ||
		   anyLifted(search, polygon, side,
					 [&](std::span<const glm::dvec3> corners)
					 {
						 return seesReceiver(search.tracer, search.sides, corners, normal, search.step_m, search.distance_m,
											 static_cast<uint32_t>(2 * polygon + side));
					 });
}

SideVerdict find(const DropSearch& search, std::size_t polygon, unsigned side)
{
	const VolumeRegion region = search.region(polygon, side);
	SideVerdict found = SideVerdict::alone;
	const auto look = [&](bool only_visible, SideVerdict enough)
	{
		return search.forReceivers(polygon, region, only_visible,
								   [&](const FoundReceiver& receiver)
								   {
									   found = std::max(found, receiver.verdict);
									   return found < enough;
								   });
	};
	look(true, SideVerdict::needed);
	if (found == SideVerdict::needed)
	{
		return search.settings.visible_from.empty() || darkensVisible(search, polygon, side) ? found : SideVerdict::unseen;
	}
	const bool any = look(false, SideVerdict::unseen); // why it is dropped, for the counts
	return found == SideVerdict::alone && any ? SideVerdict::convex : found;
}

// Cost per polygon in microseconds, measured on Sponza; a reference ray costs about one.
constexpr double kReceiversCost = 10.0;
constexpr double kSolidsCost = 4.0;

void findReceivers(DropSearch& search, const RunSettings& run)
{
	const auto compute = [&](std::size_t i)
	{
		search.found[i][0] = find(search, i, 0);
		search.found[i][1] = search.occluders.polygons[i].two_sided ? find(search, i, 1) : SideVerdict::alone;
	};
	runStage({"receivers", search.blocks(), [&](std::size_t block) { return kReceiversCost * search.sizeOf(block); },
			  [&](std::size_t block) { search.forBlock(block, compute); },
			  [&](std::size_t block, Archive& archive)
			  { search.forBlock(block, [&](std::size_t i) { archive(search.found[i][0], search.found[i][1]); }); },
			  groupOfBlock},
			 run);
}

void findInside(DropSearch& search)
{
	const auto is_open = [&](std::size_t i, unsigned side)
	{
		return anyLifted(search, i, side,
						 [&](std::span<const glm::dvec3> corners)
						 {
							 return isOpen(search.tracer, search.sides.materials, corners, search.normal(i, side), search.step_m,
										   static_cast<uint32_t>(2 * i + side));
						 });
	};
	runStage({"solids", search.blocks(), [&](std::size_t block) { return kSolidsCost * search.sizeOf(block); },
			  [&](std::size_t block)
			  { search.forBlock(block, [&](std::size_t i) { search.inside[i] = !is_open(i, 0) && !is_open(i, 1) ? 1 : 0; }); },
			  [&](std::size_t block, Archive& archive)
			  { search.forBlock(block, [&](std::size_t i) { archive(search.inside[i]); }); },
			  groupOfBlock},
			 search.run);
}

void buildSeenTree(DropSearch& search)
{
	if (!search.settings.visible_from.empty())
	{
		search.seen_tree = std::make_unique<TriangleTree>(search.tracer.level(), search.sides.seen, search.run.threads);
	}
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
		search.inside.assign(search.inside.size(), 0);
		search.sides =
			receiverSides(search.tracer, {false, search.settings.visible_from, search.settings.seen_rays, true}, search.run);
		buildSeenTree(search);
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
	if (best != SideVerdict::needed && search.settings.no_receiver)
	{
		counts.alone += best == SideVerdict::alone ? 1 : 0;
		counts.convex += best == SideVerdict::convex ? 1 : 0;
		counts.enclosed += best == SideVerdict::inside ? 1 : 0;
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
		std::vector<glm::dvec3> corners(search.corners(i).begin(), search.corners(i).end());
		if (one_side && back)
		{
			std::reverse(corners.begin(), corners.end());
		}
		dropped.occluders.add(occluder, corners);
	}
	search.counts.kept = dropped.occluders.polygons.size();
	return dropped;
}

void start(DropSearch& search)
{
	const std::size_t count = search.occluders.polygons.size();
	search.counts.polygons = count;
	const Bounds bounds = mainBounds(search.tracer.level());
	search.step_m = 0.005 * glm::length(bounds.most - bounds.least);
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

// Greedy, in ascending order of a polygon's greatest possible contribution at any receiver; each triangle side may lose `below` in
// total.

struct Loss
{
	uint32_t side; // 2 · triangle + side
	float share;   // rounded up
};

// Collects what a polygon may take from each receiver side if that is at most `below` everywhere; else none and a value above
// `below`.
double lossesOf(const DropSearch& search, std::size_t polygon, std::vector<Loss>& losses)
{
	constexpr std::size_t kFirst = 64;   // receivers of each side: one of them nearly always loses too much
	thread_local uint32_t strongest = 0; // the triangle that lost most by the last polygon: often a neighbour
	strongest = std::min(strongest, static_cast<uint32_t>(search.sides.there.size() - 1)); // of another level
	double most = 0.0;
	// Asks up to `count` receivers of a side, the nearest first.
	const auto ask = [&](unsigned side, std::size_t count)
	{
		const VolumeRegion region = search.region(polygon, side);
		const auto alpha = static_cast<double>(search.occluders.polygons[polygon].alpha);
		const auto add = [&](const FoundReceiver& found)
		{
			const double share =
				found.verdict != SideVerdict::needed
					? 0.0
					: greatestShare(region, search.corners(polygon), search.areas[polygon], alpha, found.receiver, found.rise_m);
			most = std::max(most, share);
			strongest = share > search.settings.below ? found.triangle : strongest;
			if (share > 0.0)
			{
				losses.push_back({2 * found.triangle + found.side, static_cast<float>(share * (1.0 + 0x1p-22))});
			}
			return most <= search.settings.below && --count > 0;
		};
		bool any = false;
		if (count > kFirst || search.forTriangle(search.corners(polygon), region, strongest, any, add))
		{
			search.forReceivers(polygon, region, true, add);
		}
	};
	for (const std::size_t count : {kFirst, std::numeric_limits<std::size_t>::max()})
	{
		losses.clear();
		most = 0.0;
		for (unsigned side = 0; side < 2 && most <= search.settings.below; ++side)
		{
			if (search.found[polygon][side] == SideVerdict::needed)
			{
				ask(side, count);
			}
		}
		if (most > search.settings.below)
		{
			losses.clear();
			break;
		}
	}
	return most;
}

bool isNeeded(const DropSearch& search, std::size_t polygon)
{
	return search.inside[polygon] == 0 &&
		   (search.found[polygon][0] == SideVerdict::needed || search.found[polygon][1] == SideVerdict::needed);
}

// Marks needed polygons whose contributions can be left out.
void findLeast(DropSearch& search)
{
	const std::size_t count = search.found.size();
	const double below = search.settings.below;
	std::vector<std::vector<Loss>> losses(count);
	std::vector<double> greatest(count, 2.0);
	inBlocks(count, kDropBlock, search.run, "contributions",
			 [&](std::size_t i)
			 {
				 thread_local std::vector<Loss> here;
				 if (isNeeded(search, i))
				 {
					 here.clear();
					 greatest[i] = lossesOf(search, i, here);
					 losses[i] = here;
				 }
			 });
	std::vector<std::size_t> order = indicesWhere(count, [&](std::size_t i) { return greatest[i] <= below; });
	std::sort(order.begin(), order.end(),
			  [&](std::size_t a, std::size_t b) { return greatest[a] != greatest[b] ? greatest[a] < greatest[b] : a < b; });
	std::vector<double> lost(2 * search.sides.seen.size(), 0.0);
	for (const std::size_t i : order)
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

} // namespace

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
	if (settings.no_receiver || settings.sides || settings.inside || settings.below > 0.0)
	{
		const SideSettings sides{settings.inside, settings.visible_from, settings.seen_rays, false, settings.receivers};
		runOnce(
			"sides", [&] { search.sides = receiverSides(tracer, sides, withoutUnits(run)); },
			[&](Archive& archive) { archive(search.sides); }, run);
		search.tree = std::make_unique<TriangleTree>(tracer.level(), search.sides.there, run.threads);
		buildSeenTree(search);
		findReceivers(search, run);
	}
	if (settings.inside)
	{
		findInside(search);
	}
	if (settings.inside && !isShare(run))
	{
		refuseInside(search);
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
	dropped.counts = search.counts;
	return dropped;
}

} // namespace nook
