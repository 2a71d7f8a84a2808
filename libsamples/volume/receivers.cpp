// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/receivers.h"

#include "core/error.h"
#include "core/lists.h"
#include "core/math.h"
#include "core/parallel.h"
#include "scene/camera_choice.h"
#include "scene/topology.h"
#include "volume/drop.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace nook
{

double polygonArea(std::span<const glm::dvec3> corners)
{
	double area = 0.0;
	for (std::size_t i = 2; i < corners.size(); ++i)
	{
		area += 0.5 * glm::length(glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]));
	}
	return area;
}

namespace
{

constexpr int kDirections = 8; // directions per point
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::array<glm::dvec3, 3> cornersOf(const Level& level, std::size_t triangle)
{
	const glm::uvec3 corner = level.triangles[triangle];
	return {level.positions[corner.x], level.positions[corner.y], level.positions[corner.z]};
}

glm::dvec3 acrossOf(const std::array<glm::dvec3, 3>& corners)
{
	return glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
}

// Unit normal of a side.
glm::dvec3 normalOf(const std::array<glm::dvec3, 3>& corners, bool front)
{
	const glm::dvec3 across = acrossOf(corners);
	return (front ? 1.0 : -1.0) / glm::length(across) * across;
}

// Two unit vectors orthogonal to a unit normal (T. Duff et al., "Building an Orthonormal Basis, Revisited", 2017).
std::array<glm::dvec3, 2> axesOf(glm::dvec3 n)
{
	const double sign = n.z < 0.0 ? -1.0 : 1.0;
	const double a = -1.0 / (sign + n.z);
	const double b = n.x * n.y * a;
	return {glm::dvec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), glm::dvec3(b, sign + n.y * n.y * a, -n.y)};
}

bool isThere(const Level& level, std::size_t triangle)
{
	return level.material_list[level.materials[triangle]].coverage > 0.0 && glm::length(acrossOf(cornersOf(level, triangle))) > 0.0;
}

glm::dvec3 pointIn(const Bounds& box, Random& random)
{
	const double x = random.uniform();
	const double y = random.uniform();
	const double z = random.uniform();
	return box.least + glm::dvec3(x, y, z) * (box.most - box.least);
}

constexpr std::size_t kRaysOfBlock = 4096;

// The side hit by each of a number of rays from the boxes: 2 · triangle + side; UINT64_MAX for the sky.
std::vector<uint64_t> lookAround(const Tracer& tracer, std::span<const Bounds> boxes, std::size_t rays, uint64_t stream,
								 int threads)
{
	std::vector<uint64_t> met(rays, UINT64_MAX);
	parallelFor((rays + kRaysOfBlock - 1) / kRaysOfBlock, threads,
				[&](std::size_t block)
				{
					Random random(stream, block);
					for (std::size_t i = block * kRaysOfBlock; i < std::min(rays, (block + 1) * kRaysOfBlock); ++i)
					{
						const glm::dvec3 eye = pointIn(boxes[i % boxes.size()], random);
						const RayHit hit = tracer.nearest(eye, directionOf(random), kInfinity);
						met[i] = hit.hit ? 2 * static_cast<uint64_t>(hit.triangle) + (hit.front ? 0 : 1) : UINT64_MAX;
					}
				});
	return met;
}

// True if every corner of every box is behind the plane.
bool isBehind(std::span<const Bounds> boxes, glm::dvec3 normal, glm::dvec3 at)
{
	return std::all_of(boxes.begin(), boxes.end(),
					   [&](const Bounds& box)
					   {
						   glm::dvec3 furthest;
						   for (int axis = 0; axis < 3; ++axis)
						   {
							   furthest[axis] = normal[axis] > 0.0 ? box.most[axis] : box.least[axis];
						   }
						   return glm::dot(normal, furthest - at) < 0.0;
					   });
}

bool isInSight(const Tracer& tracer, std::span<const Bounds> boxes, uint32_t triangle, glm::dvec3 normal, int rays)
{
	const std::array<glm::dvec3, 3> corners = cornersOf(tracer.level(), triangle);
	Random random(0x5ee, triangle);
	for (int i = 0; i < rays; ++i)
	{
		const glm::dvec3 eye = pointIn(boxes[static_cast<std::size_t>(i) % boxes.size()], random);
		const double u = random.uniform();
		const double v = random.uniform();
		const glm::dvec3 point = pointOf(corners, u, v) + 2.0 * tracer.error() * normal;
		// From the surface: what is hidden is mostly so by something near.
		if (glm::dot(eye - point, normal) > 0.0 && !tracer.blocked(point, eye))
		{
			return true;
		}
	}
	return false;
}

// Clears the bits of unseen sides that are in one cell with a visible side and face the same octant: few rays hit each small
// triangle at the end of a gap, but many hit all of them.
void keepBesideSeen(const Tracer& tracer, const ReceiverSides& sides, std::vector<uint8_t>& unseen, const RunSettings& run)
{
	const Level& level = tracer.level();
	const Bounds bounds = mainBounds(level);
	const double cell_m = 0.002 * glm::length(bounds.most - bounds.least);
	const auto cellOf = [&](std::size_t triangle, bool front)
	{
		const std::array<glm::dvec3, 3> corners = cornersOf(level, triangle);
		const glm::dvec3 across = (front ? 1.0 : -1.0) * acrossOf(corners);
		const glm::dvec3 at = (corners[0] + corners[1] + corners[2]) / (3.0 * cell_m);
		uint64_t cell = 0;
		for (int axis = 0; axis < 3; ++axis)
		{
			const auto along = static_cast<uint64_t>(static_cast<int64_t>(std::floor(at[axis])) & 0xfffff);
			cell = cell << 21U | along << 1U | (across[axis] > 0.0 ? 1U : 0U);
		}
		return cell;
	};
	std::vector<uint64_t> seen;
	for (std::size_t i = 0; i < unseen.size(); ++i)
	{
		for (unsigned side = 0; side < 2; ++side)
		{
			if ((static_cast<unsigned>(sides.seen[i] & ~unseen[i]) >> side & 1U) != 0)
			{
				seen.push_back(cellOf(i, side == 0));
			}
		}
	}
	std::sort(seen.begin(), seen.end());
	parallelForAll(unseen.size(), run.threads,
				   [&](std::size_t i)
				   {
					   for (unsigned side = 0; side < 2; ++side)
					   {
						   if ((unseen[i] >> side & 1U) != 0 && std::binary_search(seen.begin(), seen.end(), cellOf(i, side == 0)))
						   {
							   unseen[i] &= static_cast<uint8_t>(~(1U << side));
						   }
					   }
				   });
}

void leaveOutOfSight(const Tracer& tracer, const SideSettings& settings, ReceiverSides& sides, const RunSettings& run)
{
	const Level& level = tracer.level();
	std::vector<uint8_t> met(sides.seen.size(), 0);
	const std::size_t rays = std::clamp<std::size_t>(8 * met.size(), 100'000, 4'000'000);
	for (const uint64_t side : lookAround(tracer, settings.boxes, rays, 1, run.threads))
	{
		if (side != UINT64_MAX)
		{
			met[side / 2] |= static_cast<uint8_t>(1U << (side % 2));
		}
	}
	std::vector<uint8_t> unseen(met.size(), 0);
	ProgressCounter progress(run.progress, "sight", met.size());
	parallelFor(met.size(), run.threads,
				[&](std::size_t i)
				{
					const std::array<glm::dvec3, 3> corners = cornersOf(level, i);
					for (unsigned side = 0; side < 2 && sides.there[i] != 0; ++side)
					{
						const auto bit = static_cast<uint8_t>(1U << side);
						const glm::dvec3 normal = normalOf(corners, side == 0);
						if ((sides.seen[i] & bit) != 0 && (met[i] & bit) == 0 &&
							(isBehind(settings.boxes, normal, corners[0]) ||
							 !isInSight(tracer, settings.boxes, static_cast<uint32_t>(i), normal, settings.seen_rays)))
						{
							unseen[i] |= bit;
						}
					}
					progress.finishOne();
				});
	sides.check_rays = std::min<std::size_t>(rays, 1'000'000);
	for (const uint64_t side : lookAround(tracer, settings.boxes, sides.check_rays, 2, run.threads))
	{
		const auto bit = static_cast<uint8_t>(1U << (side % 2));
		sides.check_missed += side != UINT64_MAX && (unseen[side / 2] & bit) != 0 ? 1U : 0U;
		met[side == UINT64_MAX ? 0 : side / 2] |= side == UINT64_MAX ? uint8_t{0} : bit;
	}
	keepBesideSeen(tracer, sides, unseen, run);
	for (std::size_t i = 0; i < met.size(); ++i)
	{
		const auto out = static_cast<uint8_t>(unseen[i] & ~met[i]);
		sides.unseen_sides += static_cast<uint64_t>(std::popcount(out));
		sides.seen[i] &= static_cast<uint8_t>(~out);
	}
}

// Leaves out sides from which every ray hits a back first. Of a small triangle a quarter of the rays will do if the sides around it
// are inside, too, as in a dense closed mesh.
void leaveOutInside(const Tracer& tracer, ReceiverSides& sides, const RunSettings& run)
{
	constexpr uint32_t kAround = 9; // triangles at the three corners, itself three times
	const Level& level = tracer.level();
	const Bounds bounds = mainBounds(level);
	const double step_m = 0.005 * glm::length(bounds.most - bounds.least);
	const auto insideOf = [&](std::size_t i, unsigned asked, bool fully)
	{
		const std::array<glm::dvec3, 3> corners = cornersOf(level, i);
		unsigned inside = 0;
		for (unsigned side = 0; side < 2; ++side)
		{
			const glm::dvec3 normal = normalOf(corners, side == 0);
			const auto turn = static_cast<uint32_t>(2 * i + side);
			const auto isOut = [&]
			{
				return fully ? isOpen(tracer, sides.materials, corners, normal, step_m, turn)
							 : isOpen(tracer, sides.materials, (corners[0] + corners[1] + corners[2]) / 3.0, normal, turn);
			};
			const unsigned bit = 1U << side;
			inside |= (asked & bit) != 0 && !isOut() ? bit : 0U;
		}
		return static_cast<uint8_t>(inside);
	};
	const auto isLarge = [&](std::size_t i)
	{
		return glm::length(acrossOf(cornersOf(level, i))) > 8.0 * step_m * step_m;
	};
	std::vector<uint8_t> inside(level.triangles.size(), 0);
	inBlocks(inside.size(), 1024, run, "insides",
			 [&](std::size_t i) { inside[i] = sides.there[i] != 0 ? insideOf(i, sides.seen[i], isLarge(i)) : uint8_t{0}; });
	const std::vector<uint32_t> first = weldPositions(level.positions, run.threads);
	std::vector<uint32_t> count_at(first.size(), 0); // by place
	std::vector<uint8_t> inside_at(first.size(), kFrontSeen | kBackSeen);
	for (std::size_t i = 0; i < inside.size(); ++i)
	{
		for (int corner = 0; corner < 3; ++corner)
		{
			const uint32_t place = first[level.triangles[i][corner]];
			count_at[place] += 1;
			inside_at[place] &= inside[i];
		}
	}
	inBlocks(inside.size(), 1024, run, "insides",
			 [&](std::size_t i)
			 {
				 const glm::uvec3& t = level.triangles[i];
				 const std::array<uint32_t, 3> places{first[t.x], first[t.y], first[t.z]};
				 const bool few = count_at[places[0]] + count_at[places[1]] + count_at[places[2]] < kAround;
				 const unsigned around = few ? 0U : inside_at[places[0]] & inside_at[places[1]] & inside_at[places[2]];
				 const unsigned doubtful = inside[i] & ~around;
				 if (doubtful != 0 && !isLarge(i))
				 {
					 inside[i] = static_cast<uint8_t>((inside[i] & around) | insideOf(i, doubtful, true));
				 }
			 });
	for (std::size_t i = 0; i < inside.size(); ++i)
	{
		sides.inside_sides += static_cast<uint64_t>(std::popcount(inside[i]));
		sides.seen[i] &= static_cast<uint8_t>(~inside[i]);
	}
}

// Calls visit(from, way, hit) for the first surface along each of eight directions until it returns true; returns whether it did.
template <class Visit>
bool lookOut(const Tracer& tracer, glm::dvec3 point, glm::dvec3 normal, double reach_m, uint32_t turn, Visit&& visit)
{
	const auto [s, t] = axesOf(normal);
	const glm::dvec3 from = point + 2.0 * tracer.error() * normal;
	for (int i = 0; i < kDirections; ++i)
	{
		// Golden-angle steps; each direction represents an equal fraction of the hemisphere, steepest first.
		const double up = 1.0 - (i + 0.5) / kDirections;
		const double across = std::sqrt(1.0 - up * up);
		const SinCos angle = sinCosOf(2.0 * kPi * fraction(0.6180339887498949 * i + radicalInverse(turn % 65536 + 1, 2)));
		const glm::dvec3 way = up * normal + across * (angle.cos * s + angle.sin * t);
		if (visit(from, way, tracer.nearest(from, way, reach_m)))
		{
			return true;
		}
	}
	return false;
}

// Calls visit(point, turn) for points spread over a convex polygon until it returns true; returns whether it did.
template <class Visit> bool anyPoint(std::span<const glm::dvec3> corners, double step_m, uint32_t turn, Visit&& visit)
{
	assert(corners.size() >= 3);
	const double area = polygonArea(corners);
	const int points = static_cast<int>(std::clamp(std::ceil(area / (step_m * step_m)), 4.0, 64.0));
	for (int k = 0; k < points; ++k)
	{
		// Finds the triangle of the fan at that fraction of the area, and a point in it.
		double rest = (k + 0.5) / points * area;
		std::size_t i = 2;
		for (; i + 1 < corners.size(); ++i)
		{
			const double here = 0.5 * glm::length(glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]));
			if (rest < here)
			{
				break;
			}
			rest -= here;
		}
		// M. Roberts' sequence R2.
		const double u = fraction(0.5 + 0.7548776662466927 * (k + 1));
		const double v = fraction(0.5 + 0.5698402909980532 * (k + 1));
		if (visit(pointOf({corners[0], corners[i - 1], corners[i]}, u, v), turn + static_cast<uint32_t>(k) * 7919U))
		{
			return true;
		}
	}
	return false;
}

// Empty if no point of the level shows anything.
std::vector<LevelCamera> chosenCameras(const Tracer& tracer, const RunSettings& run, int count = 8)
{
	try
	{
		return chooseCameras(tracer, count, run);
	}
	catch (const Error&)
	{
		return {};
	}
}

// Places where a person can stand and mostly sees fronts, and the level's own cameras; none if fewer than three of the former are
// found.
std::vector<Bounds> standingEyes(const Tracer& tracer, const RunSettings& run)
{
	std::vector<Bounds> eyes;
	for (const LevelCamera& camera : chosenCameras(tracer, run, 12))
	{
		const glm::dvec3 eye(camera.world_from_camera[3]);
		std::array<uint64_t, 2> sides{};
		for (const uint64_t side :
			 lookAround(tracer, std::vector<Bounds>{{eye, eye}}, camera.from_outside ? 0 : 1024, 5, run.threads))
		{
			sides[side % 2] += side != UINT64_MAX ? 1 : 0;
		}
		if (sides[0] > sides[1])
		{
			eyes.push_back({eye, eye});
		}
	}
	if (eyes.size() < 3)
	{
		return {};
	}
	for (const LevelCamera& camera : tracer.level().cameras)
	{
		const glm::dvec3 eye(camera.world_from_camera[3]);
		eyes.push_back({eye, eye});
	}
	return eyes;
}

constexpr double kNeeded = 0.005; // of a piece's area, or of the rays that hit it

// A piece of surface that is connected by vertices.
struct SurfacePiece
{
	std::size_t triangles = 0;
	double area = 0.0;
	double needed = 0.0;          // of the area: parts whose backs are seen or see a receiver
	std::array<double, 2> rays{}; // that hit its fronts and backs
};

struct SurfacePieces
{
	std::vector<uint32_t> of; // per triangle
	std::vector<SurfacePiece> pieces;
};

// `met`: sides that rays hit, from lookAround().
SurfacePieces surfacePieces(const Level& level, std::span<const uint64_t> met, const RunSettings& run)
{
	const std::vector<uint32_t> first = weldPositions(level.positions, run.threads);
	Groups groups(level.positions.size());
	for (const glm::uvec3& t : level.triangles)
	{
		groups.join(first[t.x], first[t.y]);
		groups.join(first[t.x], first[t.z]);
	}
	SurfacePieces found{mapped(level.triangles, [&](const glm::uvec3& t) { return groups.rootOf(first[t.x]); }),
						std::vector<SurfacePiece>(level.positions.size())};
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		found.pieces[found.of[i]].triangles += 1;
		found.pieces[found.of[i]].area += glm::length(acrossOf(cornersOf(level, i)));
	}
	for (const uint64_t side : met)
	{
		if (side != UINT64_MAX)
		{
			found.pieces[found.of[side / 2]].rays[side % 2] += 1.0;
		}
	}
	return found;
}

// Sides that rays from the boxes hit; from the level's cameras if there are none, else from automatic ones.
std::vector<uint64_t> lookFromCameras(const Tracer& tracer, std::span<const Bounds> boxes, const RunSettings& run)
{
	constexpr std::size_t kRays = 200'000;
	const Level& level = tracer.level();
	std::vector<Bounds> eyes(boxes.begin(), boxes.end());
	if (eyes.empty())
	{
		eyes = mapped(level.cameras.empty() ? chosenCameras(tracer, run) : level.cameras,
					  [](const LevelCamera& camera)
					  {
						  const glm::dvec3 eye(camera.world_from_camera[3]);
						  return Bounds{eye, eye};
					  });
	}
	return lookAround(tracer, eyes, eyes.empty() ? 0 : kRays, 3, run.threads);
}

// A 16 : 9 grid of at least `count` points.
struct Grid
{
	int columns = 1;
	int rows = 1;
};

Grid gridOf(int count)
{
	const int columns = static_cast<int>(std::ceil(std::sqrt(count * 16.0 / 9.0)));
	return {columns, (count + columns - 1) / columns};
}

void addViews(const Tracer& tracer, const ReceiverSettings& settings, std::vector<ReferencePoint>& points, const RunSettings& run)
{
	const Grid grid = gridOf(settings.per_view);
	for (const LevelCamera& camera : chooseCameras(tracer, settings.views, run))
	{
		const Eye eye(tracer, camera, grid.columns, grid.rows);
		for (int i = 0; i < grid.columns * grid.rows; ++i)
		{
			if (const auto seen = eye.at(i % grid.columns + 0.5, static_cast<double>(i / grid.columns) + 0.5))
			{
				points.push_back(*seen);
			}
		}
	}
}

// Finds the triangle at a given fraction of the total area.
class ByArea
{
public:
	explicit ByArea(const Level& level) : m_until(level.triangles.size())
	{
		double sum = 0.0;
		for (std::size_t i = 0; i < m_until.size(); ++i)
		{
			const bool there = level.material_list[level.materials[i]].coverage > 0.0;
			sum += there ? glm::length(acrossOf(cornersOf(level, i))) : 0.0;
			m_until[i] = sum;
		}
	}

	bool empty() const
	{
		return m_until.empty() || !(m_until.back() > 0.0);
	}

	std::size_t at(double share) const
	{
		const auto found = std::upper_bound(m_until.begin(), m_until.end(), share * m_until.back());
		return static_cast<std::size_t>(std::min(found, m_until.end() - 1) - m_until.begin());
	}

private:
	std::vector<double> m_until;
};

// On random sides, where those are in the open.
void addSurfaces(const Tracer& tracer, double distance_m, const ReceiverSettings& settings, const MaterialSides& materials,
				 std::vector<ReferencePoint>& points)
{
	const Level& level = tracer.level();
	const ByArea by_area(level);
	Random random(settings.seed, 0xa0e);
	for (int i = 0; i < settings.by_area + settings.near_creases && !by_area.empty(); ++i)
	{
		const std::size_t triangle = by_area.at(random.uniform());
		const glm::uvec3 corner = level.triangles[triangle];
		const unsigned turn = random.below(3);
		const glm::dvec3 a = level.positions[corner[static_cast<int>(turn)]];
		const glm::dvec3 b = level.positions[corner[static_cast<int>((turn + 1) % 3)]];
		const glm::dvec3 c = level.positions[corner[static_cast<int>((turn + 2) % 3)]];
		double u = random.uniform();
		double v = random.uniform();
		const glm::dvec3 across = acrossOf(cornersOf(level, triangle));
		const double area = glm::length(across);
		if (i >= settings.by_area)
		{
			// Next to the edge a–b, a hundredth of δ away from it, or half of the triangle's height.
			const double height = area / std::max(glm::length(b - a), 1e-300);
			v = std::min(0.5, 0.01 * distance_m / height);
			u *= 1.0 - v;
		}
		const std::size_t material = level.materials[triangle];
		const bool back = (level.material_list[material].two_sided || materials.oriented[material] == 0) && // see receiverSides()
						  (settings.idle_backs.empty() || settings.idle_backs[triangle] == 0);
		const glm::dvec3 normal = across * ((back && random.below(2) == 0 ? -1.0 : 1.0) / area);
		const glm::dvec3 position = pointOf({a, b, c}, u, v);
		if (isOpen(tracer, materials, position, normal, static_cast<uint32_t>(points.size())))
		{
			points.push_back({position, normal, 0.0});
		}
	}
}

} // namespace

glm::dvec3 directionOf(Random& random)
{
	const double z = 2.0 * random.uniform() - 1.0;
	const SinCos turn = sinCosOf(2.0 * kPi * random.uniform());
	const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
	return {r * turn.cos, r * turn.sin, z};
}

glm::dvec3 pointOf(const std::array<glm::dvec3, 3>& triangle, double u, double v)
{
	const auto& [a, b, c] = triangle;
	const bool beyond = u + v > 1.0;
	return a + (beyond ? 1.0 - u : u) * (b - a) + (beyond ? 1.0 - v : v) * (c - a);
}

Eye::Eye(const Tracer& tracer, const LevelCamera& camera, int width_px, int height_px)
	: m_tracer(tracer), m_view(viewOf(camera, width_px, height_px)), m_projector(m_view.projection, width_px, height_px),
	  m_world_from_camera(glm::inverse(m_view.camera_from_world))
{
}

std::optional<ReferencePoint> Eye::at(double x, double y) const
{
	const ViewLine line = m_projector.lineOf({x, y});
	return surfaceAlong(m_tracer, glm::dvec3(m_world_from_camera * glm::dvec4(line.at, 1.0)),
						glm::dmat3(m_world_from_camera) * line.along, std::numeric_limits<double>::infinity());
}

std::optional<ReferencePoint> surfaceAlong(const Tracer& tracer, glm::dvec3 from, glm::dvec3 along, double reach)
{
	const RayHit hit = tracer.nearest(from, along, reach);
	if (!hit.hit)
	{
		return std::nullopt;
	}
	const glm::dvec3 across = acrossOf(cornersOf(tracer.level(), hit.triangle));
	const double area = glm::length(across);
	if (!(area > 0.0))
	{
		return std::nullopt;
	}
	return ReferencePoint{from + hit.distance * along, across * ((hit.front ? 1.0 : -1.0) / area), 0.0};
}

MaterialSides materialSides(const Tracer& tracer, const RunSettings& run)
{
	const Level& level = tracer.level();
	MaterialSides sides;
	sides.fronts.assign(level.material_list.size(), 0);
	sides.backs.assign(level.material_list.size(), 0);
	for (const uint64_t side : lookFromCameras(tracer, {}, run))
	{
		if (side != UINT64_MAX)
		{
			(side % 2 == 0 ? sides.fronts : sides.backs)[level.materials[side / 2]] += 1;
		}
	}
	for (std::size_t i = 0; i < level.material_list.size(); ++i)
	{
		// One-sided materials are oriented unless their backs are seen; two-sided ones if only one side is seen.
		const Material& material = level.material_list[i];
		const uint64_t fronts = sides.fronts[i];
		const uint64_t backs = sides.backs[i];
		const bool solid = material.alpha_mode == AlphaMode::opaque;
		sides.oriented.push_back(solid && (material.two_sided ? fronts >= 100 && backs * 200 <= fronts : backs * 20 <= fronts) ? 1
																															   : 0);
	}
	return sides;
}

bool isOpen(const Tracer& tracer, const MaterialSides& materials, glm::dvec3 point, glm::dvec3 normal, uint32_t turn)
{
	return lookOut(tracer, point, normal, kInfinity, turn,
				   [&](glm::dvec3 /*from*/, glm::dvec3 /*way*/, const RayHit& hit)
				   { return !hit.hit || hit.front || materials.oriented[tracer.level().materials[hit.triangle]] == 0; });
}

bool isOpen(const Tracer& tracer, const MaterialSides& materials, std::span<const glm::dvec3> corners, glm::dvec3 normal,
			double step_m, uint32_t turn)
{
	return anyPoint(corners, step_m, turn,
					[&](glm::dvec3 point, uint32_t turned) { return isOpen(tracer, materials, point, normal, turned); });
}

bool seesReceiver(const Tracer& tracer, const ReceiverSides& sides, std::span<const glm::dvec3> corners, glm::dvec3 normal,
				  double step_m, double reach_m, uint32_t turn)
{
	const Level& level = tracer.level();
	const auto isReceiver = [&](glm::dvec3 from, glm::dvec3 way, const RayHit& hit)
	{
		if (!hit.hit || (sides.seen[hit.triangle] & (hit.front ? kFrontSeen : kBackSeen)) == 0)
		{
			return false;
		}
		// A large triangle may be visible elsewhere but not here, such as a floor inside a column.
		return isOpen(tracer, sides.materials, from + hit.distance * way, normalOf(cornersOf(level, hit.triangle), hit.front),
					  turn);
	};
	return anyPoint(corners, step_m, turn,
					[&](glm::dvec3 point, uint32_t turned) { return lookOut(tracer, point, normal, reach_m, turned, isReceiver); });
}

std::array<Bounds, 6> boxesAround(const Level& level)
{
	const Bounds inner = mainBounds(level);
	const glm::dvec3 size = inner.most - inner.least;
	const double thick_m = 3.0 * std::max({size.x, size.y, size.z});
	const Bounds outer{inner.least - thick_m, inner.most + thick_m};
	std::array<Bounds, 6> boxes;
	boxes.fill(outer);
	for (int axis = 0; axis < 3; ++axis)
	{
		boxes[static_cast<std::size_t>(2 * axis)].most[axis] = inner.least[axis];
		boxes[static_cast<std::size_t>(2 * axis + 1)].least[axis] = inner.most[axis];
	}
	return boxes;
}

ReceiverSides receiverSides(const Tracer& tracer, const SideSettings& settings, const RunSettings& run)
{
	const Level& level = tracer.level();
	ReceiverSides sides;
	sides.materials = materialSides(tracer, run);
	sides.there.resize(level.triangles.size());
	sides.seen.resize(level.triangles.size());
	for (std::size_t i = 0; i < sides.seen.size(); ++i)
	{
		sides.there[i] = isThere(level, i) ? 1 : 0;
		// The back of a one-sided material is culled and no receiver, unless backs of it are seen.
		const std::size_t material = level.materials[i];
		const bool back = settings.backs || level.material_list[material].two_sided || sides.materials.oriented[material] == 0;
		sides.seen[i] = sides.there[i] == 0 ? 0 : back ? kFrontSeen | kBackSeen : kFrontSeen;
	}
	if (settings.inside)
	{
		leaveOutInside(tracer, sides, run);
	}
	sides.outside = sides.seen;
	if (!settings.boxes.empty())
	{
		leaveOutOfSight(tracer, settings, sides, run);
	}
	for (std::size_t i = 0; i < settings.receivers.size(); ++i)
	{
		sides.seen[i] = settings.receivers[i] != 0 ? sides.seen[i] : 0;
	}
	return sides;
}

std::vector<uint8_t> idleBacks(const Tracer& tracer, double distance_m, std::span<const Bounds> boxes, const RunSettings& run)
{
	constexpr std::size_t kLooks = 400'000;
	constexpr double kLarge = 4.0;   // times the mean area
	constexpr std::size_t kFew = 16; // triangles of a piece that are asked first
	constexpr std::size_t kFirstSample = 512;
	constexpr double kClearly = 0.03; // of a piece's area in the first sample
	constexpr std::size_t kSample = 4096;
	constexpr double kFewest = 100.0; // rays that tell which sides of a piece people see
	const Level& level = tracer.level();
	const std::size_t count = level.triangles.size();
	SideSettings settings;
	settings.boxes = boxes;
	ReceiverSides sides = receiverSides(tracer, settings, run);
	const std::vector<Bounds> eyes = boxes.empty() ? standingEyes(tracer, run) : std::vector<Bounds>{};
	SurfacePieces looked = surfacePieces(level, lookAround(tracer, eyes, eyes.empty() ? 0 : kLooks, 4, run.threads), run);
	const std::vector<uint32_t>& piece_of = looked.of;
	std::vector<SurfacePiece>& found = looked.pieces;
	for (std::size_t i = 0; i < count; ++i)
	{
		const SurfacePiece& piece = found[piece_of[i]];
		const bool hidden = piece.rays[0] >= kFewest && piece.rays[1] <= kNeeded * piece.rays[0];
		sides.seen[i] &= hidden ? kFrontSeen : kFrontSeen | kBackSeen;
	}
	for (std::size_t i = 0; i < count; ++i)
	{
		const bool seen = sides.there[i] != 0 && (sides.seen[i] & kBackSeen) != 0;
		found[piece_of[i]].needed += seen ? glm::length(acrossOf(cornersOf(level, i))) : 0.0;
	}
	// Per piece, the area whose backs see a receiver, from all large triangles and a sample of the others, which stand for the rest
	// if `scaled`; 0 for pieces with fewer triangles and for those known to be needed.
	const auto areasThatSee = [&](std::size_t sample, std::size_t fewest, bool scaled)
	{
		std::vector<double> areas(count, 0.0);
		inBlocks(count, 256, run, "backs",
				 [&](std::size_t i)
				 {
					 const SurfacePiece& piece = found[piece_of[i]];
					 const bool asked = piece.triangles >= fewest && piece.needed <= kNeeded * piece.area;
					 if (!asked || sides.there[i] == 0 || (sides.seen[i] & kBackSeen) != 0)
					 {
						 return;
					 }
					 const std::array<glm::dvec3, 3> corners = cornersOf(level, i);
					 const glm::dvec3 across = acrossOf(corners);
					 const double area = glm::length(across);
					 const bool large = area * static_cast<double>(piece.triangles) > kLarge * piece.area;
					 const std::size_t every = large ? 1 : std::max<std::size_t>(1, piece.triangles / sample);
					 const bool sees = i % every == 0 && seesReceiver(tracer, sides, corners, -across / area, distance_m,
																	  distance_m, static_cast<uint32_t>(i));
					 areas[i] = sees ? area * static_cast<double>(scaled ? every : 1) : 0.0;
				 });
		std::vector<double> sums(found.size(), 0.0);
		for (std::size_t i = 0; i < count; ++i)
		{
			sums[piece_of[i]] += areas[i];
		}
		return sums;
	};
	const auto decide = [&](const std::vector<double>& areas, double clearly)
	{
		for (std::size_t k = 0; k < found.size(); ++k)
		{
			found[k].needed += areas[k] > clearly * found[k].area ? areas[k] : 0.0;
		}
	};
	decide(areasThatSee(kFew, 2 * kFew, false), kNeeded);
	decide(areasThatSee(kFirstSample, 2 * kFirstSample, true), kClearly);
	decide(areasThatSee(kSample, 0, true), 0.0);
	const auto isIdle = [&](std::size_t i)
	{
		const SurfacePiece& piece = found[piece_of[i]];
		return level.material_list[level.materials[i]].alpha_mode == AlphaMode::opaque && piece.needed <= kNeeded * piece.area;
	};
	return listOf(count, [&](std::size_t i) { return static_cast<uint8_t>(isIdle(i) ? 1 : 0); });
}

std::vector<uint8_t> seenBacks(const Tracer& tracer, std::span<const Bounds> boxes, const RunSettings& run)
{
	constexpr double kFewest = 20.0; // rays
	const SurfacePieces found = surfacePieces(tracer.level(), lookFromCameras(tracer, boxes, run), run);
	return mapped(found.of,
				  [&](uint32_t of)
				  {
					  const auto& [fronts, backs] = found.pieces[of].rays;
					  return static_cast<uint8_t>(backs >= kFewest && backs > kNeeded * fronts ? 1 : 0);
				  });
}

std::vector<ReferencePoint> sampleReceivers(const Tracer& tracer, double distance_m, const ReceiverSettings& settings,
											const RunSettings& run)
{
	std::vector<ReferencePoint> points;
	if (settings.views > 0 && settings.per_view > 0)
	{
		addViews(tracer, settings, points, run);
	}
	addSurfaces(tracer, distance_m, settings, materialSides(tracer, run), points);
	return points;
}

std::vector<uint32_t> nearOrder(std::span<const glm::vec3> points)
{
	std::vector<uint32_t> places(points.size());
	if (!points.empty())
	{
		meshopt_spatialSortRemap(places.data(), &points[0].x, points.size(), sizeof(glm::vec3));
	}
	std::vector<uint32_t> order(points.size());
	for (uint32_t i = 0; i < order.size(); ++i)
	{
		order[places[i]] = i;
	}
	return order;
}

std::vector<uint32_t> nearOrder(std::span<const ReferencePoint> points)
{
	const glm::dvec3 least = boundsAround(mapped(points, [](const ReferencePoint& point) { return point.position; })).least;
	return nearOrder(mapped(points, [&least](const ReferencePoint& point) { return glm::vec3(point.position - least); }));
}

std::vector<double> sumsAt(const VolumeEvaluator& evaluator, std::span<const ReferencePoint> points, const RunSettings& run,
						   bool roughly, double enough)
{
	constexpr std::size_t kBlock = 64;
	const std::vector<uint32_t> order = nearOrder(points);
	std::vector<double> sums(points.size());
	const std::size_t blocks = (points.size() + kBlock - 1) / kBlock;
	ProgressCounter progress(run.progress, "sums", blocks);
	parallelFor(blocks, run.threads,
				[&](std::size_t block)
				{
					const auto of = std::span(order).subspan(block * kBlock, std::min(kBlock, points.size() - block * kBlock));
					std::array<VolumeSum, kBlock> found;
					evaluator.sums(mapped(of,
										  [&](uint32_t i) {
											  return VolumeReceiver{points[i].position, points[i].normal};
										  }),
								   std::span(found).first(of.size()), roughly, enough);
					for (std::size_t i = 0; i < of.size(); ++i)
					{
						sums[of[i]] = found[i].occlusion;
					}
					progress.finishOne();
				});
	return sums;
}

std::vector<double> sumsAt(const VolumeSet& volumes, std::span<const ReferencePoint> points, const RunSettings& run)
{
	return sumsAt(VolumeEvaluator(volumes, run), points, run);
}

VerifyResult verifyVolumes(const VolumeSet& all, const VolumeSet& kept, std::span<const ReferencePoint> receivers,
						   const RunSettings& run)
{
	const std::vector<double> before = sumsAt(all, receivers, run);
	const std::vector<double> after = sumsAt(kept, receivers, run);
	VerifyResult result{.receivers = receivers.size()};
	for (std::size_t i = 0; i < receivers.size(); ++i)
	{
		const double difference = std::fabs(before[i] - after[i]);
		const double compensated = std::fabs(kept.compensation.at(before[i]) - kept.compensation.at(after[i]));
		result.mean += difference;
		result.mean_compensated += compensated;
		result.greatest_compensated = std::max(result.greatest_compensated, compensated);
		if (difference > result.greatest || i == 0)
		{
			result.greatest = difference;
			result.worst_position = receivers[i].position;
		}
	}
	const double count = std::max(1.0, static_cast<double>(receivers.size()));
	result.mean /= count;
	result.mean_compensated /= count;
	return result;
}

} // namespace nook
