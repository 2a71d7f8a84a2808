// SPDX-License-Identifier: GPL-3.0-or-later
// Side by side of every polygon: is there a triangle in its region, on a side of it that can be seen, with the polygon above its
// tangent plane? Then, the least contributions first, what no receiver misses.
#include "volume/drop.h"

#include "core/parallel.h"
#include "volume/prism.h"
#include "volume/receivers.h"
#include "volume/region.h"
#include "volume/triangle_tree.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <memory>
#include <span>

namespace nook
{
namespace
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

constexpr std::size_t kBlock = 256; // polygons that one thread takes at a time

double areaOf(std::span<const glm::dvec3> corners)
{
	double area = 0.0;
	for (std::size_t i = 2; i < corners.size(); ++i)
	{
		area += 0.5 * glm::length(glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]));
	}
	return area;
}

class Dropper
{
public:
	Dropper(const Occluders& occluders, const Tracer& tracer, double distance_m, bool exact_bounds, const DropSettings& settings,
			const RunSettings& run)
		: m_occluders(occluders), m_tracer(tracer), m_distance_m(distance_m), m_exact(exact_bounds), m_settings(settings),
		  m_run(run)
	{
	}

	Dropped drop();

private:
	std::span<const glm::dvec3> corners(std::size_t polygon) const
	{
		const Occluder& occluder = m_occluders.polygons[polygon];
		return std::span(m_occluders.corners).subspan(occluder.first_corner, occluder.corner_count);
	}

	// side 0: front.
	VolumeRegion region(std::size_t polygon, unsigned side) const
	{
		const glm::dvec3 front = frontOf(corners(polygon));
		return regionOf(corners(polygon), side == 0 ? front : -front, front, m_distance_m, m_exact);
	}

	// Calls visit(finding, receiver, rise) for each side of a triangle that reaches into the region and has the polygon above its
	// plane, until it returns false. Says whether any triangle reaches into it.
	template <class Visit> bool forReceivers(std::size_t polygon, const VolumeRegion& region, Visit&& visit) const;

	Finding find(std::size_t polygon, unsigned side) const;
	void findReceivers();
	void findHidden();
	void findInside();
	void refuseInside();
	void dropLeast();
	Dropped collect();

	const Occluders& m_occluders;
	const Tracer& m_tracer;
	double m_distance_m;
	bool m_exact;
	const DropSettings& m_settings;
	const RunSettings& m_run;
	std::unique_ptr<TriangleTree> m_tree;
	ReceiverSides m_sides;
	std::vector<double> m_areas;
	std::vector<std::array<Finding, 2>> m_found; // of the front and the back
	std::vector<uint8_t> m_inside;               // one a polygon: within solids
	std::vector<uint8_t> m_least;                // one a polygon: too little
	DropCounts m_counts;
};

template <class Visit> bool Dropper::forReceivers(std::size_t polygon, const VolumeRegion& region, Visit&& visit) const
{
	const Level& level = m_tracer.level();
	const std::span<const glm::dvec3> of = corners(polygon);
	bool any = false;
	m_tree->visit(region.box, region.planes(),
				  [&](uint32_t triangle)
				  {
					  const glm::uvec3 corner = level.triangles[triangle];
					  if (!reaches(region, {level.positions[corner.x], level.positions[corner.y], level.positions[corner.z]}))
					  {
						  return true;
					  }
					  any = true;
					  for (unsigned side = 0; side < 2; ++side)
					  {
						  const auto bit = static_cast<uint8_t>(1U << side);
						  ReceiverSide receiver;
						  if (!receiverSide(level, triangle, static_cast<int>(side), m_settings.smooth_normals, receiver))
						  {
							  continue;
						  }
						  const double rise_m = riseOf(of, receiver);
						  const Finding finding = (m_sides.seen[triangle] & bit) != 0      ? Finding::needed
												  : (m_sides.outside[triangle] & bit) != 0 ? Finding::unseen
																						   : Finding::inside;
						  if (rise_m > kRise * m_distance_m && !visit(finding, triangle, receiver, rise_m))
						  {
							  return false;
						  }
					  }
					  return true;
				  });
	return any;
}

Finding Dropper::find(std::size_t polygon, unsigned side) const
{
	Finding found = Finding::alone;
	const bool any = forReceivers(polygon, region(polygon, side),
								  [&](Finding finding, uint32_t /*triangle*/, const ReceiverSide& /*receiver*/, double /*rise_m*/)
								  {
									  found = std::max(found, finding);
									  return found != Finding::needed;
								  });
	return found == Finding::alone && any ? Finding::convex : found;
}

void Dropper::findReceivers()
{
	const std::size_t count = m_occluders.polygons.size();
	ProgressCounter progress(m_run.progress, "receivers", (count + kBlock - 1) / kBlock);
	parallelFor((count + kBlock - 1) / kBlock, m_run.threads,
				[&](std::size_t block)
				{
					for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i)
					{
						m_found[i][0] = find(i, 0);
						m_found[i][1] = m_occluders.polygons[i].two_sided ? find(i, 1) : Finding::alone;
					}
					progress.finishOne();
				});
}

// Rays see what volumes do not: that there is a wall between.
void Dropper::findHidden()
{
	const std::size_t count = m_occluders.polygons.size();
	parallelFor((count + kBlock - 1) / kBlock, m_run.threads,
				[&](std::size_t block)
				{
					for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i)
					{
						const glm::dvec3 front = frontOf(corners(i));
						for (unsigned side = 0; side < 2; ++side)
						{
							if (m_found[i][side] == Finding::needed && (side == 0 || m_occluders.polygons[i].two_sided) &&
								!seesReceiver(m_tracer, m_sides, corners(i), side == 0 ? front : -front, 0.25 * m_distance_m,
											  2.0 * m_distance_m, static_cast<uint32_t>(2 * i + side)))
							{
								m_found[i][side] = Finding::hidden;
							}
						}
					}
				});
}

void Dropper::findInside()
{
	const std::size_t count = m_occluders.polygons.size();
	const Bounds bounds = boundsOf(m_tracer.level());
	const double step_m = 0.005 * glm::length(bounds.most - bounds.least);
	parallelFor((count + kBlock - 1) / kBlock, m_run.threads,
				[&](std::size_t block)
				{
					for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i)
					{
						const glm::dvec3 front = frontOf(corners(i));
						m_inside[i] =
							!isOpen(m_tracer, m_sides.materials, corners(i), front, step_m, static_cast<uint32_t>(2 * i)) &&
									!isOpen(m_tracer, m_sides.materials, corners(i), -front, step_m,
											static_cast<uint32_t>(2 * i + 1))
								? 1
								: 0;
					}
				});
}

// A room whose walls look outwards, with the cameras in it, seems to be one solid.
void Dropper::refuseInside()
{
	for (std::size_t i = 0; i < m_found.size(); ++i)
	{
		const Finding best = std::max(m_found[i][0], m_found[i][1]);
		m_counts.inside_m2 += m_inside[i] != 0 || best == Finding::inside ? m_areas[i] : 0.0;
	}
	if (m_counts.inside_m2 > 0.5 * m_counts.area_m2)
	{
		m_counts.inside_refused = true;
		m_inside.assign(m_inside.size(), 0);
		m_sides = receiverSides(m_tracer, {false, m_settings.visible_from, m_settings.seen_rays, true}, m_run);
		findReceivers();
	}
}

// Greedy, in rising order of the greatest share that a polygon can have at any receiver; every triangle's side has `below` to lose.
void Dropper::dropLeast()
{
	struct Loss
	{
		uint32_t side; // 2 · triangle + side
		double share;
	};
	std::vector<std::vector<Loss>> losses(m_found.size());
	std::vector<double> greatest(m_found.size(), 2.0);
	const auto measure = [&](std::size_t i)
	{
		double most = 0.0;
		for (unsigned side = 0; side < 2; ++side)
		{
			if (m_found[i][side] != Finding::needed)
			{
				continue;
			}
			const VolumeRegion of = region(i, side);
			forReceivers(i, of,
						 [&](Finding finding, uint32_t triangle, const ReceiverSide& receiver, double rise_m)
						 {
							 if (finding == Finding::needed)
							 {
								 const double share =
									 greatestShare(of, corners(i), m_areas[i], static_cast<double>(m_occluders.polygons[i].alpha),
												   receiver, rise_m);
								 most = std::max(most, share);
								 if (share > 0.0)
								 {
									 const bool front =
										 glm::dot(receiver.flat, glm::cross(receiver.corners[1] - receiver.corners[0],
																			receiver.corners[2] - receiver.corners[0])) > 0.0;
									 losses[i].push_back({2 * triangle + (front ? 0U : 1U), share});
								 }
							 }
							 return most <= m_settings.below;
						 });
			if (most > m_settings.below)
			{
				losses[i] = {};
				return;
			}
		}
		greatest[i] = most;
	};
	const auto isNeeded = [&](std::size_t i)
	{
		return m_inside[i] == 0 && (m_found[i][0] == Finding::needed || m_found[i][1] == Finding::needed);
	};
	ProgressCounter progress(m_run.progress, "contributions", (m_found.size() + kBlock - 1) / kBlock);
	parallelFor((m_found.size() + kBlock - 1) / kBlock, m_run.threads,
				[&](std::size_t block)
				{
					for (std::size_t i = block * kBlock; i < std::min(m_found.size(), (block + 1) * kBlock); ++i)
					{
						if (isNeeded(i))
						{
							measure(i);
						}
					}
					progress.finishOne();
				});
	std::vector<uint32_t> order;
	for (std::size_t i = 0; i < greatest.size(); ++i)
	{
		if (greatest[i] <= m_settings.below)
		{
			order.push_back(static_cast<uint32_t>(i));
		}
	}
	std::sort(order.begin(), order.end(),
			  [&](uint32_t a, uint32_t b) { return greatest[a] != greatest[b] ? greatest[a] < greatest[b] : a < b; });
	std::vector<double> lost(2 * m_sides.seen.size(), 0.0);
	for (const uint32_t i : order)
	{
		const bool fits = std::all_of(losses[i].begin(), losses[i].end(),
									  [&](const Loss& loss) { return lost[loss.side] + loss.share <= m_settings.below; });
		if (fits)
		{
			m_least[i] = 1;
			for (const Loss& loss : losses[i])
			{
				lost[loss.side] += loss.share;
				m_counts.greatest_loss = std::max(m_counts.greatest_loss, lost[loss.side]);
			}
		}
		losses[i] = {};
	}
}

Dropped Dropper::collect()
{
	Dropped dropped;
	dropped.occluders.polygons.reserve(m_occluders.polygons.size());
	for (std::size_t i = 0; i < m_occluders.polygons.size(); ++i)
	{
		Occluder occluder = m_occluders.polygons[i];
		const Finding best = std::max(m_found[i][0], m_found[i][1]);
		if (m_inside[i] != 0)
		{
			m_counts.inside += 1;
			continue;
		}
		if (best != Finding::needed && (m_settings.no_receiver || best == Finding::hidden))
		{
			m_counts.alone += best == Finding::alone ? 1 : 0;
			m_counts.convex += best == Finding::convex ? 1 : 0;
			m_counts.enclosed += best == Finding::inside ? 1 : 0;
			m_counts.hidden += best == Finding::hidden ? 1 : 0;
			m_counts.unseen += best == Finding::unseen ? 1 : 0;
			continue;
		}
		if (m_least[i] != 0)
		{
			m_counts.below += 1;
			continue;
		}
		const auto first = static_cast<uint32_t>(dropped.occluders.corners.size());
		const std::span<const glm::dvec3> of = corners(i);
		dropped.occluders.corners.insert(dropped.occluders.corners.end(), of.begin(), of.end());
		occluder.first_corner = first;
		const bool front = m_found[i][0] == Finding::needed;
		const bool back = m_found[i][1] == Finding::needed;
		if (m_settings.sides && occluder.two_sided && front != back)
		{
			m_counts.turned += 1;
			occluder.two_sided = false;
			if (back)
			{
				std::reverse(dropped.occluders.corners.begin() + first, dropped.occluders.corners.end());
			}
		}
		dropped.occluders.polygons.push_back(occluder);
	}
	m_counts.kept = dropped.occluders.polygons.size();
	dropped.counts = m_counts;
	return dropped;
}

Dropped Dropper::drop()
{
	const std::size_t count = m_occluders.polygons.size();
	m_counts.polygons = count;
	m_counts.triangles = m_tracer.level().triangles.size();
	m_areas.resize(count);
	for (std::size_t i = 0; i < count; ++i)
	{
		m_areas[i] = areaOf(corners(i));
		m_counts.area_m2 += m_areas[i];
	}
	m_found.assign(count, {Finding::needed, Finding::needed});
	m_inside.assign(count, 0);
	m_least.assign(count, 0);
	if (m_settings.no_receiver || m_settings.sides || m_settings.inside || m_settings.hidden || m_settings.below > 0.0)
	{
		m_sides = receiverSides(m_tracer, {m_settings.inside, m_settings.visible_from, m_settings.seen_rays, false}, m_run);
		m_tree = std::make_unique<TriangleTree>(m_tracer.level(), m_sides.there, m_run.threads);
		findReceivers();
	}
	if (m_settings.inside)
	{
		findInside();
		refuseInside();
	}
	if (m_settings.hidden)
	{
		findHidden();
	}
	if (m_settings.below > 0.0)
	{
		dropLeast();
	}
	m_counts.inside_sides = m_sides.inside_sides;
	m_counts.unseen_sides = m_sides.unseen_sides;
	m_counts.check_rays = m_sides.check_rays;
	m_counts.check_missed = m_sides.check_missed;
	return collect();
}

} // namespace

Dropped dropVolumes(const Occluders& occluders, const Tracer& tracer, double distance_m, bool exact_bounds,
					const DropSettings& settings, const RunSettings& run)
{
	assert(distance_m > 0.0 && settings.below >= 0.0 && settings.below <= 1.0 && settings.seen_rays >= 1);
	return Dropper(occluders, tracer, distance_m, exact_bounds, settings, run).drop();
}

} // namespace nook
