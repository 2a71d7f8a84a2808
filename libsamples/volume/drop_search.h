// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the steps of dropVolumes(): the polygons, the level's triangles, and what each side of a polygon may darken.
#pragma once

#include "core/archive.h"
#include "volume/drop.h"
#include "volume/prism.h"
#include "volume/receivers.h"
#include "volume/region.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

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

// Marks needed sides that see none of their receivers as hidden, and returns them as one-sided polygons (drop_hidden.cpp).
Occluders findHidden(DropSearch& search);

// Marks needed polygons whose contributions can be left out (drop_least.cpp).
void findLeast(DropSearch& search);

} // namespace nook::detail
