// SPDX-License-Identifier: GPL-3.0-or-later
// View selection: renders a small ray-traced picture for each of many candidates, scores it, and picks the best views greedily,
// each showing something new.
//
// Candidates. In levels: above floors, found by rays from above through all storeys, with ground around and head room; at standing
// height (half of it in low rooms), and about three times as high. Around objects (nothing to stand on, less than 2 m in total, or
// standing views that score less than 0.65 times as much, or show mostly the backs of a hollow object), and if standing views show
// too little: from outside, on a sphere, at a distance that shows the whole object, and closer. Last, close to the largest
// triangles.
//
// Score of a picture of 32 × 18 rays, 60° high:
//     place × seen × clear × facing × varied × (0.25 depths + 0.20 normals + 0.30 edges + 0.25 creases)
//
// - place: 0.3 on a roof or on top of a wall, else 1.
// - varied: from the plane that fills most of the picture: 1 if it fills a third or less, 0.2 from three quarters on.
// - seen: fraction of rays that hit a surface, 1 from 80 % on.
// - clear: (1 − fraction of rays that hit one nearer than 0.4 standing heights)³.
// - facing: 1 − 0.9 × fraction of opaque surfaces seen from behind.
// - depths: entropy of depth in half octaves, 1 for eight equally filled ones.
// - normals: entropy of the normal over 26 directions, 1 for eight equally filled ones.
// - edges: fraction of adjacent rays with a depth jump of more than a tenth, 1 from 15 % on.
// - creases: fraction of adjacent rays without a jump whose normals differ by more than 25°, 1 from 15 % on.
//
// A view also loses up to 60 % of its score for surfaces that already chosen views show (in cells of 1/40 of the level's diagonal),
// and views within 1/20 of the diagonal of a chosen one with directions within 35° are taken only if no others remain. From
// outside, any picture of a surface scores above 0, however uniform. The weights are tuned by eye on the built-in levels, Sponza, a
// bathroom, a city quarter, a dragon, a space shuttle and a tree.
#include "scene/camera_choice.h"

#include "core/lists.h"
#include "core/math.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/words.h"
#include "scene/ray_triangle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

namespace nook
{
namespace
{

struct Site
{
	Bounds bounds;
	double diagonal = 0.0;   // metres
	double eye_height = 0.0; // without a ceiling, metres
};

struct CameraCandidate
{
	glm::dvec3 eye{0.0};
	glm::dvec3 way{0.0, 0.0, -1.0}; // view direction of any length; not a target, which far from the origin could round to the eye
	double clearance = 0.0;         // minimum distance to surfaces, metres
	double worth = 1.0;             // weight of the position: lower where people rarely stand
	bool outside = false;           // not a place where a person could stand
};

constexpr unsigned kPlaces = 600;         // positions in plan where floors are searched
constexpr std::size_t kMaxStands = 120;   // evenly chosen from the floors found
constexpr std::size_t kMinStands = 18;    // with fewer it is an object, not a level
constexpr double kLeastLevelDiagonal = 2; // metres: nobody stands in anything smaller
constexpr double kMetreDiagonal = 1000;   // a larger level may not be in metres
constexpr double kRoofWorth = 0.3;
constexpr std::size_t kCloseViews = 64; // the most ever requested

const glm::dvec3 kUp(0.0, 1.0, 0.0);

glm::dvec3 flatDirection(double turn)
{
	const SinCos at = sinCosOf(2.0 * kPi * turn);
	return {at.cos, 0.0, at.sin};
}

// Direction i of `count` evenly distributed ones: Fibonacci lattice, from −y up to +y.
glm::dvec3 sphereDirection(int i, int count)
{
	const double y = -1.0 + (2.0 * i + 1.0) / count;
	const double flat = std::sqrt((1.0 - y) * (1.0 + y));
	return flat * flatDirection(fraction(i * 0.6180339887498949)) + kUp * y;
}

// All floors below a place: opaque upward faces that slope by less than 45°.
std::vector<glm::dvec3> floorsBelow(const Tracer& tracer, glm::dvec3 from, double reach)
{
	const Level& level = tracer.level();
	std::vector<glm::dvec3> floors;
	const double step = 1e-6 * reach + 2.0 * tracer.error();
	for (int i = 0; i < 24; ++i)
	{
		const RayHit hit = tracer.nearest(from, -kUp, reach);
		if (!hit.hit)
		{
			break;
		}
		const glm::dvec3 at = from - kUp * hit.distance;
		const glm::dvec3 across = twiceAreaOf(level, hit.triangle);
		const Material& material = level.material_list[level.materials[hit.triangle]];
		const bool bears = material.alpha_mode == AlphaMode::opaque && (hit.front || material.two_sided); // nobody stands on leaves
		if (bears && std::fabs(across.y) > 0.7 * glm::length(across))
		{
			floors.push_back(at);
		}
		from = at - kUp * step;
		reach -= hit.distance + step;
	}
	return floors;
}

// Ground at about that height in most directions: a floor, and not the back of a dragon.
bool hasGroundAround(const Tracer& tracer, const Site& site, glm::dvec3 floor)
{
	int found = 0;
	const double away = 0.08 * site.diagonal;
	const double rise = 0.06 * site.diagonal;
	for (int i = 0; i < 8; ++i)
	{
		const glm::dvec3 from = floor + away * flatDirection(i / 8.0) + kUp * rise;
		found += tracer.nearest(from, -kUp, 2.0 * rise).hit ? 1 : 0;
	}
	return found >= 5;
}

// A roof or the top of a wall: under the open sky, with the ground ending or dropping by two body heights nearby in most
// directions. A hill slopes.
bool isRoof(const Tracer& tracer, const Site& site, glm::dvec3 floor)
{
	constexpr int kDirections = 8;
	const glm::dvec3 eye = floor + kUp * site.eye_height;
	const double drop = 3.0 * site.eye_height; // below the eye
	int drops = 0;
	for (int i = 0; i < kDirections; ++i)
	{
		const glm::dvec3 way = flatDirection((i + 0.5) / kDirections);
		const double most = std::min(24.0 * site.eye_height, 0.1 * site.diagonal);
		const double free = tracer.nearest(eye, way, most).hit ? 0.0 : most; // a wall prevents falling
		bool falls = false;
		for (double away = 0.125 * most; away <= free && !falls; away *= 2.0)
		{
			falls = !tracer.nearest(eye + away * way, -kUp, drop).hit;
		}
		drops += falls ? 1 : 0;
	}
	return drops > kDirections / 2;
}

bool isClear(const Tracer& tracer, glm::dvec3 eye, double radius)
{
	for (int i = 0; i < 26; ++i)
	{
		if (tracer.nearest(eye, sphereDirection(i, 26), radius).hit)
		{
			return false;
		}
	}
	return insideShare(tracer, eye, 64) < kInsideShare;
}

// Eye positions above floors.
std::vector<CameraCandidate> standingEyes(const Tracer& tracer, const Site& site)
{
	const glm::dvec3 size = site.bounds.most - site.bounds.least;
	const double lift = 1e-3 * site.diagonal;
	std::vector<CameraCandidate> eyes;
	for (unsigned i = 1; i <= kPlaces; ++i)
	{
		const glm::dvec3 from(site.bounds.least.x + size.x * radicalInverse(i, 2), site.bounds.most.y + lift,
							  site.bounds.least.z + size.z * radicalInverse(i, 3));
		for (const glm::dvec3 floor : floorsBelow(tracer, from, size.y + 2.0 * lift))
		{
			// Under a ceiling: in the middle part of the room's height.
			const RayHit ceiling = tracer.nearest(floor + kUp * (1e-3 * site.eye_height), kUp, 20.0 * site.eye_height + size.y);
			double height = site.eye_height;
			if (ceiling.hit)
			{
				height = std::min(std::max(height, 0.3 * ceiling.distance), 0.6 * ceiling.distance);
			}
			const glm::dvec3 eye = floor + kUp * height;
			if (height > 0.4 * site.eye_height && hasGroundAround(tracer, site, floor) && isClear(tracer, eye, 0.3 * height))
			{
				const double worth = !ceiling.hit && isRoof(tracer, site, floor) ? kRoofWorth : 1.0;
				eyes.push_back({eye, {}, 0.4 * height, worth});
			}
		}
	}
	return eyes;
}

void addViewsAround(std::vector<CameraCandidate>& candidates, const CameraCandidate& stand, double first_turn, double slope)
{
	for (int i = 0; i < 8; ++i)
	{
		CameraCandidate view = stand;
		view.way = flatDirection(first_turn + i / 8.0) + kUp * slope;
		candidates.push_back(view);
	}
}

// Above floors; none if there are too few, or for objects below 2 m.
std::vector<CameraCandidate> standingViews(const Tracer& tracer, const Site& site)
{
	if (site.diagonal < kLeastLevelDiagonal)
	{
		return {};
	}
	std::vector<CameraCandidate> eyes = standingEyes(tracer, site);
	if (eyes.size() < kMinStands) // rooms of a game whose unit is a storey
	{
		Site lower = site;
		lower.eye_height *= 0.5;
		eyes = standingEyes(tracer, lower);
		if (eyes.size() < 2 * kMinStands) // a cavity
		{
			return {};
		}
	}
	const std::size_t count = std::min(eyes.size(), kMaxStands);
	std::vector<CameraCandidate> candidates;
	for (std::size_t i = 0; i < count; ++i)
	{
		const CameraCandidate& stand = eyes[i * eyes.size() / count];
		const auto index = static_cast<unsigned>(i + 1);
		// Pitch from slightly upward to 16° down.
		addViewsAround(candidates, stand, radicalInverse(index, 5) / 8.0, 0.08 - 0.36 * radicalInverse(index, 7));
		const double more = 5.0 * stand.clearance; // three times as high, since the eye height is 2.5 clearances
		if (i % 3 == 0 && !tracer.nearest(stand.eye, kUp, 1.2 * more).hit)
		{
			CameraCandidate higher = stand;
			higher.eye += kUp * more;
			if (isClear(tracer, higher.eye, stand.clearance))
			{
				addViewsAround(candidates, higher, radicalInverse(index, 5) / 8.0, -0.4);
			}
		}
	}
	return candidates;
}

// From outside. The box's corners lie within the picture, or for the nearer half somewhat outside of it.
std::vector<CameraCandidate> viewsFromOutside(const Site& site)
{
	const glm::dvec3 centre = 0.5 * (site.bounds.least + site.bounds.most);
	const glm::dvec3 half = 0.5 * (site.bounds.most - site.bounds.least);
	const SinCos fov = sinCosOf(kPi / 6.0);
	std::vector<CameraCandidate> candidates;
	for (int i = 0; i < 160; ++i)
	{
		const glm::dvec3 out = sphereDirection(i, 160);
		if (out.y < -0.25 || out.y > 0.9)
		{
			continue;
		}
		const glm::dmat4 frame = worldFromCamera(out, glm::dvec3(0.0));
		double distance = 0.0;
		for (int corner = 0; corner < 8; ++corner)
		{
			const glm::dvec3 sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0, (corner & 4) != 0 ? 1.0 : -1.0);
			const glm::dvec3 p = half * sign;
			const double across =
				std::max(std::fabs(glm::dot(p, glm::dvec3(frame[0]))) * (9.0 / 16.0), std::fabs(glm::dot(p, glm::dvec3(frame[1]))));
			distance = std::max(distance, glm::dot(p, out) + across * fov.cos / fov.sin);
		}
		for (const double share : {1.0, 0.75})
		{
			candidates.push_back({centre + out * std::max(share * distance, 1e-3 * site.diagonal), -out, 0.0, 1.0, true});
		}
	}
	return candidates;
}

// In front of the largest triangles: finds thin wires that a small picture of the whole misses. So close that the circle inscribed
// in each triangle fills half of the picture's height.
std::vector<CameraCandidate> closeViews(const Tracer& tracer)
{
	const Level& level = tracer.level();
	std::vector<std::pair<double, std::size_t>> largest; // negative area, and the triangle
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		largest.emplace_back(-glm::length(twiceAreaOf(level, i)), i);
	}
	const std::size_t count = std::min(largest.size(), kCloseViews);
	std::partial_sort(largest.begin(), largest.begin() + static_cast<std::ptrdiff_t>(count), largest.end());
	std::vector<CameraCandidate> candidates;
	for (std::size_t i = 0; i < count && largest[i].first < 0.0; ++i)
	{
		const glm::uvec3& t = level.triangles[largest[i].second];
		const glm::dvec3 a = level.positions[t.x];
		const glm::dvec3 b = level.positions[t.y];
		const glm::dvec3 c = level.positions[t.z];
		const double sides = glm::distance(a, b) + glm::distance(b, c) + glm::distance(c, a);
		const glm::dvec3 centre = (glm::distance(b, c) * a + glm::distance(c, a) * b + glm::distance(a, b) * c) / sides;
		const glm::dvec3 normal = twiceAreaOf(level, largest[i].second) / -largest[i].first;
		const double distance = std::max(-3.5 * largest[i].first / sides, 4.0 * tracer.error());
		candidates.push_back({centre + distance * normal, -normal, 0.5 * distance, 1.0, true});
	}
	return candidates;
}

Site siteOf(const Level& level)
{
	Site site;
	site.bounds = mainBounds(level);
	site.diagonal = std::max(glm::length(site.bounds.most - site.bounds.least), 1e-9);
	// Eye height of a person; in levels too large for metres, a fiftieth of the diagonal.
	site.eye_height = site.diagonal <= kMetreDiagonal ? 1.6 : 0.02 * site.diagonal;
	const double height = site.bounds.most.y - site.bounds.least.y;
	if (height > 0.1 * site.diagonal)
	{
		site.eye_height = std::min(site.eye_height, 0.55 * height);
	}
	return site;
}

glm::dmat4 worldFromCamera(const CameraCandidate& candidate)
{
	glm::dmat4 world = nook::worldFromCamera(glm::dvec3(0.0), candidate.way);
	world[3] = glm::dvec4(candidate.eye, 1.0);
	return world;
}

constexpr int kColumns = 32;
constexpr int kRows = 18;
constexpr double kFovY = kPi / 3.0;
constexpr double kLeastScore = 1e-12; // below any varied view; also the score of a view similar to a chosen one

struct Sight
{
	double score = 0.0;
	double unfaced = 0.0; // score without the factor `facing`
	bool mostly_backs = false;
	std::vector<uint64_t> cells; // that it shows, sorted, without duplicates
};

struct Sample
{
	double depth = 0.0; // 0: sky
	glm::dvec3 position{0.0};
	glm::dvec3 normal{0.0};
	bool opaque = false;
	bool front = true;
	uint64_t cell = 0;
};

using Samples = std::array<Sample, kColumns * kRows>;

// 1 if `used` of the bins are equally filled, 0 if one bin has everything.
double spreadOf(std::span<const int> bins, double used)
{
	const int total = std::accumulate(bins.begin(), bins.end(), 0);
	double entropy = 0.0;
	for (const int bin : bins)
	{
		if (bin > 0)
		{
			const double share = static_cast<double>(bin) / total;
			entropy -= share * logOf(share);
		}
	}
	return std::min(1.0, entropy / logOf(used));
}

uint64_t cellOf(const Site& site, glm::dvec3 position)
{
	const glm::dvec3 at = (position - site.bounds.least) * (40.0 / site.diagonal);
	const auto part = [](double x)
	{
		return static_cast<uint64_t>(std::clamp(x, 0.0, 1000.0));
	};
	return (part(at.x) << 40U) | (part(at.y) << 20U) | part(at.z);
}

Samples lookAt(const Tracer& tracer, const Site& site, const CameraCandidate& candidate)
{
	const glm::dmat4 world_from_camera = worldFromCamera(candidate);
	const SinCos half = sinCosOf(0.5 * kFovY);
	const double reach_y = half.sin / half.cos;
	const double reach_x = reach_y * kColumns / kRows;
	const Level& level = tracer.level();
	Samples samples;
	for (int y = 0; y < kRows; ++y)
	{
		for (int x = 0; x < kColumns; ++x)
		{
			const glm::dvec3 direction(reach_x * (2.0 * (x + 0.5) / kColumns - 1.0), reach_y * (1.0 - 2.0 * (y + 0.5) / kRows),
									   -1.0);
			const glm::dvec3 way = glm::dvec3(world_from_camera * glm::dvec4(direction, 0.0));
			const RayHit hit = tracer.nearest(candidate.eye, way, std::numeric_limits<double>::infinity());
			if (!hit.hit)
			{
				continue;
			}
			Sample& sample = samples[static_cast<std::size_t>(y * kColumns + x)];
			const glm::dvec3 across = twiceAreaOf(level, hit.triangle);
			const double area = glm::length(across);
			sample.depth = std::max(hit.distance, 1e-300); // the direction's z is −1
			sample.normal = area > 0.0 ? across * ((hit.front ? 1.0 : -1.0) / area) : glm::dvec3(0.0);
			sample.opaque = level.material_list[level.materials[hit.triangle]].alpha_mode == AlphaMode::opaque;
			sample.front = hit.front;
			sample.position = candidate.eye + way * hit.distance;
			sample.cell = cellOf(site, sample.position);
		}
	}
	return samples;
}

// Fractions of adjacent samples with a depth jump, and with a crease.
glm::dvec2 edgesOf(const Samples& samples)
{
	int pairs = 0;
	int jumps = 0;
	int creases = 0;
	const auto compare = [&](const Sample& a, const Sample& b)
	{
		if (a.depth == 0.0 || b.depth == 0.0)
		{
			return; // a silhouette against the sky has no occlusion
		}
		pairs += 1;
		if (std::fabs(a.depth - b.depth) > 0.1 * std::min(a.depth, b.depth))
		{
			// A floor at a grazing angle is no edge: its normals agree, which is sufficient evidence of a single plane.
			jumps += glm::dot(a.normal, b.normal) > 0.98 ? 0 : 1;
		}
		else if (glm::dot(a.normal, b.normal) < 0.906) // cos 25°
		{
			creases += 1;
		}
	};
	for (std::size_t y = 0; y < kRows; ++y)
	{
		for (std::size_t x = 0; x < kColumns; ++x)
		{
			const Sample& here = samples[y * kColumns + x];
			if (x + 1 < kColumns)
			{
				compare(here, samples[y * kColumns + x + 1]);
			}
			if (y + 1 < kRows)
			{
				compare(here, samples[(y + 1) * kColumns + x]);
			}
		}
	}
	return pairs == 0 ? glm::dvec2(0.0) : glm::dvec2(static_cast<double>(jumps) / pairs, static_cast<double>(creases) / pairs);
}

// Fraction of the picture that the largest plane fills: samples whose normals agree within about 7°, and whose distances from the
// origin along them agree within 1 % of the diagonal.
double largestPlane(const Site& site, const CameraCandidate& candidate, const Samples& samples)
{
	std::vector<std::array<int64_t, 4>> planes;
	const auto rounded = [](double x)
	{
		return static_cast<int64_t>(std::floor(x + 0.5));
	};
	for (const Sample& sample : samples)
	{
		if (sample.depth != 0.0)
		{
			const glm::dvec3 n = sample.normal;
			planes.push_back({rounded(8.0 * n.x), rounded(8.0 * n.y), rounded(8.0 * n.z),
							  rounded(glm::dot(n, sample.position - candidate.eye) * (100.0 / site.diagonal))});
		}
	}
	std::sort(planes.begin(), planes.end());
	std::size_t most = 0;
	using Plane = std::array<int64_t, 4>;
	eachRun(std::span<const Plane>(planes), std::equal_to<>(),
			[&most](std::span<const Plane> run) { most = std::max(most, run.size()); });
	return static_cast<double>(most) / (kColumns * kRows);
}

Sight judge(const Tracer& tracer, const Site& site, const CameraCandidate& candidate)
{
	const Samples samples = lookAt(tracer, site, candidate);
	Sight sight;
	int hits = 0;
	int near = 0;
	int opaque = 0;
	int backs = 0;
	std::array<int, 64> depths{};
	std::array<int, 27> normals{};
	for (const Sample& sample : samples)
	{
		if (sample.depth == 0.0)
		{
			continue;
		}
		hits += 1;
		near += sample.depth < candidate.clearance ? 1 : 0;
		opaque += sample.opaque ? 1 : 0;
		backs += sample.opaque && !sample.front ? 1 : 0;
		const double half_octaves =
			std::floor(2.0 * logOf(std::max(sample.depth / site.diagonal, 1e-12)) * (1.0 / 0.6931471805599453));
		depths[static_cast<std::size_t>(std::clamp(half_octaves + 56.0, 0.0, 63.0))] += 1;
		const auto third = [](double x)
		{
			return x < -0.4 ? 0 : x > 0.4 ? 2 : 1;
		};
		const int bin = 9 * third(sample.normal.x) + 3 * third(sample.normal.y) + third(sample.normal.z);
		normals[static_cast<std::size_t>(bin)] += 1;
		sight.cells.push_back(sample.cell);
	}
	if (hits == 0)
	{
		return sight;
	}
	std::sort(sight.cells.begin(), sight.cells.end());
	sight.cells.erase(std::unique(sight.cells.begin(), sight.cells.end()), sight.cells.end());
	const double seen = std::min(1.0, hits / (0.8 * static_cast<double>(samples.size())));
	const double clear = 1.0 - static_cast<double>(near) / static_cast<double>(samples.size());
	const double facing = 1.0 - (opaque > 0 ? 0.9 * backs / opaque : 0.0);
	const glm::dvec2 edges = edgesOf(samples);
	const double interest = 0.25 * spreadOf(depths, 8.0) + 0.20 * spreadOf(normals, 8.0) + 0.30 * std::min(1.0, edges.x / 0.15) +
							0.25 * std::min(1.0, edges.y / 0.15);
	const double plane = largestPlane(site, candidate, samples);
	const double varied = std::clamp(1.0 - 0.8 * (plane - 1.0 / 3.0) / (0.75 - 1.0 / 3.0), 0.2, 1.0);
	sight.unfaced = candidate.worth * seen * clear * clear * clear * varied * interest;
	sight.score = facing * sight.unfaced;
	sight.mostly_backs = 2 * backs > opaque;
	if (candidate.outside)
	{
		sight.score = std::max(sight.score, kLeastScore * seen);
	}
	return sight;
}

// Fraction of the cells not yet seen; both lists are sorted.
double shareOfNew(const std::vector<uint64_t>& cells, const std::vector<uint64_t>& seen)
{
	const auto known = std::count_if(cells.begin(), cells.end(),
									 [&](uint64_t cell) { return std::binary_search(seen.begin(), seen.end(), cell); });
	return cells.empty() ? 0.0 : 1.0 - static_cast<double>(known) / static_cast<double>(cells.size());
}

bool areAlike(const Site& site, const CameraCandidate& a, const CameraCandidate& b)
{
	const double cosine = glm::dot(glm::normalize(a.way), glm::normalize(b.way));
	return glm::length(a.eye - b.eye) < 0.05 * site.diagonal && cosine > 0.819; // cos 35°
}

std::vector<uint64_t> together(const std::vector<uint64_t>& a, const std::vector<uint64_t>& b)
{
	std::vector<uint64_t> both;
	std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
	return both;
}

// Adds candidate indices to the chosen ones. Takes a view similar to another only if nothing else remains.
void pick(const Site& site, const std::vector<CameraCandidate>& candidates, const std::vector<Sight>& sights, int count,
		  std::vector<std::size_t>& chosen)
{
	std::vector<uint64_t> seen;
	for (const std::size_t i : chosen)
	{
		seen = together(seen, sights[i].cells);
	}
	while (chosen.size() < static_cast<std::size_t>(count))
	{
		std::size_t best = candidates.size();
		double best_score = 0.0;
		for (std::size_t i = 0; i < candidates.size(); ++i)
		{
			if (sights[i].score <= 0.0 || std::find(chosen.begin(), chosen.end(), i) != chosen.end())
			{
				continue;
			}
			const bool alike = std::any_of(chosen.begin(), chosen.end(),
										   [&](std::size_t j) { return areAlike(site, candidates[i], candidates[j]); });
			const double score = sights[i].score * (0.4 + 0.6 * shareOfNew(sights[i].cells, seen)) * (alike ? 1e-3 : 1.0);
			if (score > best_score)
			{
				best_score = score;
				best = i;
			}
		}
		if (best == candidates.size())
		{
			break;
		}
		chosen.push_back(best);
		seen = together(seen, sights[best].cells);
	}
}

// Evidence of a ray about its origin; only one-sided surfaces count.
enum class Verdict
{
	nothing, // hits none
	outside,
	inside, // leaves a solid that it has not entered
};

Verdict verdictOf(const Tracer& tracer, glm::dvec3 from, glm::dvec3 way, double step)
{
	const Level& level = tracer.level();
	Verdict verdict = Verdict::nothing;
	int entered = 0;
	for (int i = 0; i < 64; ++i) // far more surfaces than any building needs
	{
		const RayHit hit = tracer.nearest(from, way, std::numeric_limits<double>::infinity());
		if (!hit.hit)
		{
			break;
		}
		if (!level.material_list[level.materials[hit.triangle]].two_sided)
		{
			verdict = Verdict::outside;
			entered += hit.front ? 1 : -1;
			if (entered < 0)
			{
				return Verdict::inside;
			}
		}
		from += way * (hit.distance + step);
	}
	return verdict;
}

// Greatest value of a member.
double bestOf(std::span<const Sight> sights, double Sight::*value)
{
	double best = 0.0;
	for (const Sight& sight : sights)
	{
		best = std::max(best, sight.*value);
	}
	return best;
}

// Whether the level is an object: standing views are from its own top or from inside it, and views from outside show more.
bool isObject(std::span<const Sight> standing, std::span<const Sight> outside)
{
	const auto backs = std::count_if(standing.begin(), standing.end(), [](const Sight& sight) { return sight.mostly_backs; });
	// A room whose faces are all turned round also shows its backs, but little from outside.
	return 4 * static_cast<std::size_t>(backs) > 3 * standing.size()
			   ? bestOf(outside, &Sight::unfaced) > 0.5 * bestOf(standing, &Sight::unfaced)
			   : 0.65 * bestOf(outside, &Sight::score) > bestOf(standing, &Sight::score);
}

// Fewer views are the first of more.
std::vector<LevelCamera> bestCameras(const Tracer& tracer, int count, const RunSettings& run)
{
	const Site site = siteOf(tracer.level());
	const auto sightsOf = [&](const std::vector<CameraCandidate>& views)
	{
		ProgressCounter progress(run.progress, "cameras", views.size());
		std::vector<Sight> sights(views.size());
		parallelFor(views.size(), run.threads,
					[&](std::size_t i)
					{
						sights[i] = judge(tracer, site, views[i]);
						progress.finishOne();
					});
		return sights;
	};
	std::vector<CameraCandidate> candidates;
	std::vector<Sight> sights;
	std::vector<std::size_t> chosen;
	const auto add = [&](const std::vector<CameraCandidate>& views, const std::vector<Sight>& judged)
	{
		candidates.insert(candidates.end(), views.begin(), views.end());
		sights.insert(sights.end(), judged.begin(), judged.end());
		pick(site, candidates, sights, count, chosen);
	};
	const std::vector<CameraCandidate> standing = standingViews(tracer, site);
	const std::vector<CameraCandidate> outside = viewsFromOutside(site);
	const std::vector<Sight> from_floors = sightsOf(standing);
	const std::vector<Sight> from_outside = sightsOf(outside);
	if (!isObject(from_floors, from_outside))
	{
		add(standing, from_floors);
	}
	if (chosen.size() < static_cast<std::size_t>(count))
	{
		add(outside, from_outside);
	}
	if (chosen.size() < static_cast<std::size_t>(count))
	{
		const std::vector<CameraCandidate> close = closeViews(tracer);
		add(close, sightsOf(close));
	}
	std::vector<LevelCamera> cameras;
	for (const std::size_t i : chosen)
	{
		LevelCamera camera;
		camera.name = "auto-" + std::to_string(cameras.size() + 1);
		camera.world_from_camera = worldFromCamera(candidates[i]);
		camera.lens.fov_y_rad = kFovY;
		camera.lens.near_m = std::min(0.1, 1e-3 * site.diagonal);
		if (candidates[i].clearance > 0.0)
		{
			camera.lens.near_m = std::min(camera.lens.near_m, candidates[i].clearance);
		}
		camera.from_outside = candidates[i].outside;
		cameras.push_back(camera);
	}
	return cameras;
}

} // namespace

const LevelCamera& cameraNamed(const Level& level, std::string_view name)
{
	std::vector<std::string> names;
	for (const LevelCamera& camera : level.cameras)
	{
		if (camera.name == name)
		{
			return camera;
		}
		names.push_back(camera.name);
	}
	refuseInput("camera", "'" + std::string(name) + "'",
				names.empty() ? "auto:K, as " + level.name + " has no cameras" : joinedText(names, ", ") + " or auto:K",
				ExitCode::usage);
}

std::vector<LevelCamera> chooseCameras(const Tracer& tracer, int count, const RunSettings& run)
{
	assert(count >= 1);
	constexpr int kUsual = 12; // views that the stages of a verb need
	CameraMemo& memo = tracer.cameraMemo();
	std::unique_lock lock(memo.mutex);
	if (memo.chosen < count)
	{
		lock.unlock(); // a thread that waits for the loop below may take up work that chooses, too
		std::vector<LevelCamera> cameras = bestCameras(tracer, std::max(count, kUsual), run);
		lock.lock();
		memo.cameras = std::move(cameras);
		memo.chosen = std::max(count, kUsual);
	}
	refuseInputIf(memo.cameras.empty(), tracer.level().name + ": cameras", "no view that shows anything of it",
				  "an explicit camera (eye, target)");
	const std::size_t found = std::min(static_cast<std::size_t>(count), memo.cameras.size());
	return {memo.cameras.begin(), memo.cameras.begin() + static_cast<std::ptrdiff_t>(found)};
}

CamerasOfLevel camerasOf(const Tracer& tracer, std::string_view name, int automatic, const RunSettings& run)
{
	const Level& level = tracer.level();
	if (automatic <= 0 && !(name.empty() && level.cameras.empty()))
	{
		return {{name.empty() ? level.cameras.front() : cameraNamed(level, name)}, false};
	}
	const int count = std::max(automatic, 1);
	CamerasOfLevel found{chooseCameras(tracer, count, run), true};
	refuseInputIf(found.cameras.size() < static_cast<std::size_t>(count), level.name + ": cameras",
				  std::to_string(found.cameras.size()) + " views that show something", std::to_string(count));
	return found;
}

double insideShare(const Tracer& tracer, glm::dvec3 point, int directions)
{
	const Bounds& bounds = tracer.bounds();
	const double step = std::max(1e-9 * glm::length(bounds.most - bounds.least), 2.0 * tracer.error());
	int met = 0;
	int inside = 0;
	for (int i = 0; i < directions; ++i)
	{
		const glm::dvec3 way = sphereDirection(i, directions);
		const Verdict verdict = verdictOf(tracer, point, way, step);
		met += verdict != Verdict::nothing ? 1 : 0;
		inside += verdict == Verdict::inside ? 1 : 0;
	}
	return met * 20 < directions ? 0.0 : static_cast<double>(inside) / met;
}

void checkOutside(const Tracer& tracer, glm::dvec3 eye, const std::string& name)
{
	const double share = insideShare(tracer, eye);
	if (share >= kInsideShare)
	{
		const int percent = static_cast<int>(std::floor(100.0 * share));
		refuseInput(tracer.level().name + ": camera '" + name + "'",
					"it inside a solid (according to " + std::to_string(percent) + " % of the directions from it)",
					"it outside (allow-inside permits it)");
	}
}

} // namespace nook
