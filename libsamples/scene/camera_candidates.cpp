// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/camera_candidates.h"

#include "core/math.h"
#include "core/sequence.h"
#include "scene/camera_choice.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace nook
{
namespace
{

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
		const glm::uvec3 corners = level.triangles[hit.triangle];
		const glm::dvec3 a = level.positions[corners.x];
		const glm::dvec3 across = glm::cross(level.positions[corners.y] - a, level.positions[corners.z] - a);
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

std::vector<CameraCandidate> standingViews(const Tracer& tracer, const std::vector<CameraCandidate>& eyes)
{
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

// So close that the circle inscribed in each triangle fills half of the picture's height.
std::vector<CameraCandidate> closeViews(const Tracer& tracer)
{
	const Level& level = tracer.level();
	std::vector<std::pair<double, std::size_t>> largest; // negative area, and the triangle
	const auto across = [&](std::size_t i)
	{
		const glm::uvec3& t = level.triangles[i];
		const glm::dvec3 a = level.positions[t.x];
		return glm::cross(level.positions[t.y] - a, level.positions[t.z] - a);
	};
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		largest.emplace_back(-glm::length(across(i)), i);
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
		const glm::dvec3 normal = across(largest[i].second) / -largest[i].first;
		const double distance = std::max(-3.5 * largest[i].first / sides, 4.0 * tracer.error());
		candidates.push_back({centre + distance * normal, -normal, 0.5 * distance, 1.0, true});
	}
	return candidates;
}

} // namespace

Site siteOf(const Level& level)
{
	Site site;
	site.bounds = boundsOf(level);
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
	glm::dmat4 world = worldFromCamera(glm::dvec3(0.0), candidate.way);
	world[3] = glm::dvec4(candidate.eye, 1.0);
	return world;
}

std::vector<CameraCandidate> cameraCandidates(const Tracer& tracer, const Site& site, Places places)
{
	if (places == Places::around)
	{
		return viewsFromOutside(site);
	}
	if (places == Places::close)
	{
		return closeViews(tracer);
	}
	if (site.diagonal < kLeastLevelDiagonal)
	{
		return {};
	}
	const std::vector<CameraCandidate> eyes = standingEyes(tracer, site);
	return eyes.size() < kMinStands ? std::vector<CameraCandidate>{} : standingViews(tracer, eyes);
}

glm::dvec3 sphereDirection(int i, int count)
{
	const double y = -1.0 + (2.0 * i + 1.0) / count;
	const double flat = std::sqrt((1.0 - y) * (1.0 + y));
	return flat * flatDirection(fraction(i * 0.6180339887498949)) + kUp * y;
}

} // namespace nook
