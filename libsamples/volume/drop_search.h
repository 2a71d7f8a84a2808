// SPDX-License-Identifier: GPL-3.0-or-later
// What the steps of dropVolumes() share: the polygons, the level's triangles, and what each side of a polygon may darken.
#pragma once

#include "core/byte_text.h"
#include "volume/drop.h"
#include "volume/prism.h"
#include "volume/receivers.h"
#include "volume/region.h"
#include "volume/triangle_tree.h"

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

// What one side of a polygon may darken, the strongest that was found.
enum class Finding : uint8_t
{
	alone,  // no triangle in its region
	convex, // none with it above its tangent plane
	inside, // only within solids
	unseen, // only out of sight
	hidden, // only what it does not see
	needed,
};

inline constexpr std::size_t kDropBlock = 256; // polygons that one thread takes at a time

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
	bool solids = false;                            // places within solids are no receivers
	std::vector<double> areas = {};                 // one a polygon, m²
	std::vector<std::array<Finding, 2>> found = {}; // of the front and the back
	std::vector<uint8_t> inside = {};               // one a polygon: within solids
	std::vector<uint8_t> least = {};                // one a polygon: too little
	DropCounts counts = {};

	std::size_t blocks() const
	{
		return (occluders.polygons.size() + kDropBlock - 1) / kDropBlock;
	}

	// Calls visit(polygon) for those of a block.
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

	// Calls visit(FoundReceiver) for each side of a triangle that reaches into the region and has the polygon above its
	// plane, until it returns false. Says whether any triangle reaches into it.
	template <class Visit> bool forReceivers(std::size_t polygon, const VolumeRegion& region, Visit&& visit) const
	{
		return forSides<true>(polygon, region, visit);
	}

	// The same for those that are needed, and for triangles that may not reach into it.
	template <class Visit> void forNeeded(std::size_t polygon, const VolumeRegion& region, Visit&& visit) const
	{
		forSides<false>(polygon, region, visit);
	}

private:
	template <bool kAll, class Visit> bool forSides(std::size_t polygon, const VolumeRegion& region, Visit& visit) const;
};

struct FoundReceiver
{
	Finding finding = Finding::needed; // or unseen, or inside
	uint32_t triangle = 0;
	unsigned side = 0; // 0: its front
	ReceiverSide receiver;
	double rise_m = 0.0; // of the polygon above it (region.h)
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
						here.finding = (sides.seen[triangle] & bit) != 0      ? Finding::needed
									   : (sides.outside[triangle] & bit) != 0 ? Finding::unseen
																			  : Finding::inside;
						if (here.rise_m > kRise * distance_m && !visit(std::as_const(here)))
						{
							return false;
						}
					}
					return true;
				});
	return any;
}

// Appends the polygon, turned round where asked.
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

// What was found of a block's polygons, for parts; false: no such bytes.
std::string savedFindings(const DropSearch& search, std::size_t block);
bool loadFindings(ByteReader& in, DropSearch& search, std::size_t block);

// Sides that are needed, but see none of their receivers, become hidden, and are returned as polygons of one side
// (drop_hidden.cpp).
Occluders findHidden(DropSearch& search);

// Polygons that are needed, but whose contributions may be left out (drop_least.cpp).
void findLeast(DropSearch& search);

} // namespace nook::detail
