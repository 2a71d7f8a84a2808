// SPDX-License-Identifier: GPL-3.0-or-later
// Side by side of every polygon: is there a triangle in its region, on a side of it that can be seen, with the polygon above its
// tangent plane? Then, the least contributions first, what no receiver misses.
#include "volume/drop.h"

#include "core/whole_stage.h"
#include "volume/drop_search.h"
#include "volume/kept_stages.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <memory>
#include <span>

namespace nook
{
namespace
{

using detail::DropSearch;
using detail::Finding;
using detail::FoundReceiver;
using detail::kDropBlock;

double polygonArea(std::span<const glm::dvec3> corners)
{
	double area = 0.0;
	for (std::size_t i = 2; i < corners.size(); ++i)
	{
		area += 0.5 * glm::length(glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]));
	}
	return area;
}

Finding find(const DropSearch& search, std::size_t polygon, unsigned side)
{
	Finding found = Finding::alone;
	const bool any = search.forReceivers(polygon, search.region(polygon, side),
										 [&](const FoundReceiver& receiver)
										 {
											 found = std::max(found, receiver.finding);
											 return found != Finding::needed;
										 });
	return found == Finding::alone && any ? Finding::convex : found;
}

// Microseconds of a polygon of Sponza, as the reference takes about one a ray.
constexpr double kReceiversCost = 10.0;
constexpr double kSolidsCost = 4.0;

constexpr int kLifts = 4; // heights at which a simplified polygon may be outside

void findReceivers(DropSearch& search, const RunSettings& run)
{
	const auto compute = [&](std::size_t i)
	{
		search.found[i][0] = find(search, i, 0);
		search.found[i][1] = search.occluders.polygons[i].two_sided ? find(search, i, 1) : Finding::alone;
	};
	runStage({"receivers", search.blocks(), [&](std::size_t block) { return kReceiversCost * search.sizeOf(block); },
			  [&](std::size_t block) { search.forBlock(block, compute); },
			  [&](std::size_t block) { return detail::savedFindings(search, block); },
			  [&](std::size_t block, std::string_view bytes)
			  {
				  ByteReader in(bytes);
				  return detail::loadFindings(in, search, block) && in.isAtEnd();
			  }},
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
	// A simplified polygon may lie below the surface that it stands for: several heights, as the place before that may be narrow.
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
			  [&](std::size_t block)
			  {
				  ByteWriter out;
				  search.forBlock(block, [&](std::size_t i) { out.byte(search.inside[i]); });
				  return out.take();
			  },
			  [&](std::size_t block, std::string_view bytes)
			  {
				  ByteReader in(bytes);
				  bool well = true;
				  search.forBlock(block,
								  [&](std::size_t i)
								  {
									  search.inside[i] = in.byte();
									  well = well && search.inside[i] <= 1;
								  });
				  return well && in.isAtEnd();
			  },
			  "receivers"},
			 search.run);
}

// A room whose walls look outwards, with the cameras in it, seems to be one solid.
void refuseInside(DropSearch& search)
{
	DropCounts& counts = search.counts;
	for (std::size_t i = 0; i < search.found.size(); ++i)
	{
		const Finding best = std::max(search.found[i][0], search.found[i][1]);
		counts.inside_m2 += search.inside[i] != 0 || best == Finding::inside ? search.areas[i] : 0.0;
	}
	if (counts.inside_m2 > 0.5 * counts.area_m2)
	{
		counts.inside_refused = true;
		search.solids = false;
		search.inside.assign(search.inside.size(), 0);
		search.sides =
			receiverSides(search.tracer, {false, search.settings.visible_from, search.settings.seen_rays, true}, search.run);
		findReceivers(search, undivided(search.run)); // no part knew
	}
}

// False for one that is dropped, which is then counted.
bool isKept(DropSearch& search, std::size_t polygon)
{
	DropCounts& counts = search.counts;
	const Finding best = std::max(search.found[polygon][0], search.found[polygon][1]);
	if (search.inside[polygon] != 0)
	{
		counts.inside += 1;
		return false;
	}
	if (best != Finding::needed && (search.settings.no_receiver || best == Finding::hidden))
	{
		counts.alone += best == Finding::alone ? 1 : 0;
		counts.convex += best == Finding::convex ? 1 : 0;
		counts.enclosed += best == Finding::inside ? 1 : 0;
		counts.hidden += best == Finding::hidden ? 1 : 0;
		counts.unseen += best == Finding::unseen ? 1 : 0;
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
		const bool front = search.found[i][0] == Finding::needed;
		const bool back = search.found[i][1] == Finding::needed;
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
	search.found.assign(count, {Finding::needed, Finding::needed});
	search.inside.assign(count, 0);
	search.least.assign(count, 0);
}

} // namespace

std::string detail::savedFindings(const DropSearch& search, std::size_t block)
{
	ByteWriter out;
	search.forBlock(block,
					[&](std::size_t i)
					{
						out.byte(static_cast<uint8_t>(search.found[i][0]));
						out.byte(static_cast<uint8_t>(search.found[i][1]));
					});
	return out.take();
}

bool detail::loadFindings(ByteReader& in, DropSearch& search, std::size_t block)
{
	bool well = true;
	search.forBlock(block,
					[&](std::size_t i)
					{
						for (Finding& found : search.found[i])
						{
							const uint8_t value = in.byte();
							well = well && value <= static_cast<uint8_t>(Finding::needed);
							found = well ? static_cast<Finding>(value) : Finding::alone;
						}
					});
	return well && in.isWell();
}

Dropped dropVolumes(const Occluders& occluders, const Tracer& tracer, double distance_m, bool exact_bounds,
					const DropSettings& settings, const RunSettings& run)
{
	assert(distance_m > 0.0 && settings.below >= 0.0 && settings.below <= 1.0 && settings.seen_rays >= 1);
	DropSearch search{occluders, tracer, distance_m, exact_bounds, settings, run};
	start(search);
	if (settings.no_receiver || settings.sides || settings.inside || settings.hidden || settings.below > 0.0)
	{
		const SideSettings sides{settings.inside, settings.visible_from, settings.seen_rays, false};
		runShared({"sides",
				   1,
				   {},
				   [&](std::size_t) { search.sides = receiverSides(tracer, sides, undivided(run)); },
				   [&](std::size_t) { return savedSides(search.sides); },
				   [&](std::size_t, std::string_view bytes)
				   {
					   return loadSides(bytes, search.sides);
				   }},
				  run);
		search.tree = std::make_unique<TriangleTree>(tracer.level(), search.sides.there, run.threads);
		findReceivers(search, run);
	}
	search.solids = settings.inside;
	if (settings.inside)
	{
		findInside(search);
	}
	if (settings.inside && !isPart(run))
	{
		refuseInside(search);
	}
	Occluders hidden;
	if (settings.hidden)
	{
		hidden = findHidden(search);
	}
	if (isPart(run))
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
