// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/builtin_shapes.h"

#include "core/lists.h"
#include "core/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace nook
{
namespace
{

// This work is based on: G. H. Meisters, "Polygons Have Ears", 1975; holes joined to the outline by bridges as in D. Eberly,
// "Triangulation by Ear Clipping", 2002. The best-shaped ear is cut first, so that arches do not become long slivers. Not CGAL's
// constrained Delaunay triangulation, which makes other triangles: committed pictures, volumes and figures depend on those of the
// built-in levels.

// A remaining corner of the polygon, in a ring.
struct Corner
{
	glm::dvec2 at{};
	uint32_t index = 0;
	double ear = 0.0; // shape of the triangle with its neighbours; 0 if it is no ear
};

double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
	return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// True if the segments share a point other than a common end.
bool touches(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d)
{
	const auto holds = [](glm::dvec2 from, glm::dvec2 to, glm::dvec2 p)
	{
		return p != from && p != to && turn(from, to, p) == 0.0 && glm::dot(p - from, p - to) < 0.0;
	};
	if (holds(a, b, c) || holds(a, b, d) || holds(c, d, a) || holds(c, d, b))
	{
		return true;
	}
	if (a == c || a == d || b == c || b == d)
	{
		return false;
	}
	return (turn(a, b, c) > 0.0) != (turn(a, b, d) > 0.0) && (turn(c, d, a) > 0.0) != (turn(c, d, b) > 0.0);
}

bool touchesAny(const std::vector<Corner>& ring, glm::dvec2 a, glm::dvec2 b)
{
	return !indicesWhere(ring.size(), [&](std::size_t i) { return touches(a, b, ring[i].at, ring[(i + 1) % ring.size()].at); })
				.empty();
}

// True if the line from corner i to `to` starts inside the ring: a point that a bridge visits twice has two corners.
bool beginsInside(const std::vector<Corner>& ring, std::size_t i, glm::dvec2 to)
{
	const glm::dvec2 before = ring[(i + ring.size() - 1) % ring.size()].at;
	const glm::dvec2 at = ring[i].at;
	const glm::dvec2 after = ring[(i + 1) % ring.size()].at;
	return turn(before, at, after) > 0.0 ? turn(at, to, before) > 0.0 && turn(to, at, after) > 0.0
										 : !(turn(at, to, after) >= 0.0 && turn(to, at, before) >= 0.0);
}

// Joins a hole to the ring along the shortest line between them that crosses nothing.
void bridge(std::vector<Corner>& ring, const std::vector<Corner>& hole)
{
	struct Link
	{
		double length2;
		std::size_t from;
		std::size_t to;
	};
	std::vector<Link> links;
	for (std::size_t i = 0; i < ring.size(); ++i)
	{
		for (std::size_t j = 0; j < hole.size(); ++j)
		{
			const glm::dvec2 d = hole[j].at - ring[i].at;
			links.push_back({glm::dot(d, d), i, j});
		}
	}
	std::stable_sort(links.begin(), links.end(), [](const Link& a, const Link& b) { return a.length2 < b.length2; });
	const auto best =
		std::find_if(links.begin(), links.end(),
					 [&](const Link& link)
					 {
						 const glm::dvec2 a = ring[link.from].at;
						 const glm::dvec2 b = hole[link.to].at;
						 return beginsInside(ring, link.from, b) && !touchesAny(ring, a, b) && !touchesAny(hole, a, b);
					 });
	assert(best != links.end());
	std::vector<Corner> way = listOf(hole.size() + 1, [&](std::size_t k) { return hole[(best->to + k) % hole.size()]; });
	way.push_back(ring[best->from]);
	ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(best->from) + 1, way.begin(), way.end());
}

// Area divided by the square of the longest side: 0.433 for an equilateral triangle.
double shapeOf(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
	const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
	return 0.5 * turn(a, b, c) / longest;
}

double earOf(const std::vector<Corner>& ring, std::size_t i)
{
	const std::size_t n = ring.size();
	const glm::dvec2 a = ring[(i + n - 1) % n].at;
	const glm::dvec2 b = ring[i].at;
	const glm::dvec2 c = ring[(i + 1) % n].at;
	const double shape = shapeOf(a, b, c);
	if (shape < 1e-9)
	{
		return 0.0;
	}
	// A point on a side counts as inside, even if rounding moved it off: the steps of a stair are collinear.
	const double on_side = -1e-10 * glm::dot(c - a, c - a);
	for (const Corner& corner : ring)
	{
		const glm::dvec2 p = corner.at;
		if (p != a && p != b && p != c && turn(a, b, p) >= on_side && turn(b, c, p) >= on_side && turn(c, a, p) >= on_side)
		{
			return 0.0;
		}
	}
	return shape;
}

// Indices into the points of all contours in a row; every triangle is counter-clockwise. The first contour is the outline,
// counter-clockwise; the others are holes, clockwise. Contours must not touch each other or themselves, nor contain three
// consecutive collinear points.
std::vector<glm::uvec3> triangulateContours(const std::vector<Contour>& contours)
{
	std::vector<Corner> ring;
	uint32_t index = 0;
	for (const Contour& contour : contours)
	{
		const std::vector<Corner> part = mapped(contour, [&index](glm::dvec2 point) { return Corner{point, index++, 0.0}; });
		if (ring.empty())
		{
			ring = part;
		}
		else
		{
			bridge(ring, part);
		}
	}
	for (std::size_t i = 0; i < ring.size(); ++i)
	{
		ring[i].ear = earOf(ring, i);
	}
	std::vector<glm::uvec3> triangles;
	while (ring.size() >= 3)
	{
		const auto best =
			std::max_element(ring.begin(), ring.end(), [](const Corner& a, const Corner& b) { return a.ear < b.ear; });
		assert(best->ear > 0.0);
		const auto i = static_cast<std::size_t>(best - ring.begin());
		const std::size_t n = ring.size();
		triangles.emplace_back(ring[(i + n - 1) % n].index, ring[i].index, ring[(i + 1) % n].index);
		ring.erase(best);
		if (ring.size() >= 3)
		{
			const std::size_t after = i % ring.size();
			const std::size_t before = (i + ring.size() - 1) % ring.size();
			ring[after].ear = earOf(ring, after);
			ring[before].ear = earOf(ring, before);
		}
	}
	return triangles;
}

// Normals at both ends of each edge of a chain: the edge's own, or shared with its neighbour at small angles.
struct EdgeNormals
{
	glm::dvec2 start;
	glm::dvec2 end;
};

std::vector<EdgeNormals> edgeNormals(std::span<const glm::dvec2> points, bool closed, double least_cosine)
{
	const std::size_t edges = closed ? points.size() : points.size() - 1;
	std::vector<glm::dvec2> flat(edges);
	for (std::size_t i = 0; i < edges; ++i)
	{
		const glm::dvec2 along = glm::normalize(points[(i + 1) % points.size()] - points[i]);
		flat[i] = {along.y, -along.x};
	}
	std::vector<EdgeNormals> normals(edges);
	for (std::size_t i = 0; i < edges; ++i)
	{
		const bool has_before = closed || i > 0;
		const bool has_after = closed || i + 1 < edges;
		const glm::dvec2 before = has_before ? flat[(i + edges - 1) % edges] : flat[i];
		const glm::dvec2 after = has_after ? flat[(i + 1) % edges] : flat[i];
		normals[i].start = glm::dot(before, flat[i]) > least_cosine ? glm::normalize(before + flat[i]) : flat[i];
		normals[i].end = glm::dot(after, flat[i]) > least_cosine ? glm::normalize(after + flat[i]) : flat[i];
	}
	return normals;
}

void addCap(LevelBuilder& builder, const Frame& frame, const std::vector<Contour>& contours,
			const std::vector<glm::uvec3>& triangles, double z, bool upper)
{
	std::vector<uint32_t> vertices;
	for (const Contour& contour : contours)
	{
		for (const glm::dvec2 p : contour)
		{
			vertices.push_back(builder.addVertex(frame.point({p, z}), upper ? frame.z : -frame.z, p));
		}
	}
	for (const glm::uvec3 t : triangles)
	{
		builder.addTriangle(vertices[t.x], vertices[upper ? t.y : t.z], vertices[upper ? t.z : t.y]);
	}
}

void addSides(LevelBuilder& builder, const Frame& frame, const Contour& contour, double from, double to)
{
	const std::vector<EdgeNormals> normals = edgeNormals(contour, true, 0.766);
	double travelled = 0.0;
	for (std::size_t i = 0; i < contour.size(); ++i)
	{
		const glm::dvec2 p = contour[i];
		const glm::dvec2 q = contour[(i + 1) % contour.size()];
		const double next = travelled + glm::length(q - p);
		const glm::dvec3 start = frame.direction({normals[i].start, 0.0});
		const glm::dvec3 end = frame.direction({normals[i].end, 0.0});
		const uint32_t a = builder.addVertex(frame.point({p, from}), start, {travelled, from});
		const uint32_t b = builder.addVertex(frame.point({q, from}), end, {next, from});
		const uint32_t c = builder.addVertex(frame.point({q, to}), end, {next, to});
		const uint32_t d = builder.addVertex(frame.point({p, to}), start, {travelled, to});
		builder.addQuad(a, b, c, d);
		travelled = next;
	}
}

// One band of a lathe, between two points of the profile.
void addBand(LevelBuilder& builder, const Frame& frame, glm::dvec2 low, glm::dvec2 high, const EdgeNormals& normals, glm::dvec2 v,
			 int segments)
{
	std::vector<uint32_t> lower;
	std::vector<uint32_t> upper;
	for (int k = 0; k <= segments; ++k)
	{
		const SinCos at = sinCosOf(2.0 * kPi * (k % segments) / segments);
		// From +x towards −z, so that the outside is counter-clockwise with y up.
		const auto place = [&](glm::dvec2 p)
		{
			return frame.point({p.x * at.cos, p.y, -p.x * at.sin});
		};
		const auto normal = [&](glm::dvec2 n)
		{
			return frame.direction({n.x * at.cos, n.y, -n.x * at.sin});
		};
		const double u = static_cast<double>(k) / segments;
		lower.push_back(builder.addVertex(place(low), normal(normals.start), {u, v.x}));
		upper.push_back(builder.addVertex(place(high), normal(normals.end), {u, v.y}));
	}
	for (std::size_t k = 0; k + 1 < lower.size(); ++k)
	{
		if (low.x > 0.0)
		{
			builder.addTriangle(lower[k], lower[k + 1], high.x > 0.0 ? upper[k + 1] : upper[k]);
		}
		if (high.x > 0.0)
		{
			builder.addTriangle(lower[k], upper[k + 1], upper[k]);
		}
	}
}

using Profile = std::vector<glm::dvec2>;

void addScaled(LevelBuilder& builder, glm::dvec3 foot, const Profile& profile, double scale, int segments)
{
	addLathe(builder, frameAt(foot), mapped(profile, [scale](glm::dvec2 p) { return p * scale; }), segments);
}

} // namespace

Frame turnedFrame(glm::dvec3 at, double angle_rad)
{
	const SinCos a = sinCosOf(angle_rad);
	return {at, {a.cos, 0.0, -a.sin}, {0.0, 1.0, 0.0}, {a.sin, 0.0, a.cos}};
}

Frame sideFrame(glm::dvec3 at)
{
	return {at, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}};
}

Frame planFrame(glm::dvec3 at)
{
	return {at, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}};
}

Frame frameAlong(glm::dvec3 at, glm::dvec3 direction)
{
	const glm::dvec3 y = glm::normalize(direction);
	const glm::dvec3 other = std::fabs(y.y) > 0.9 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
	const glm::dvec3 z = glm::normalize(glm::cross(other, y));
	return {at, glm::cross(y, z), y, z};
}

uint32_t LevelBuilder::addMaterial(const std::string& name)
{
	m_level.material_list.emplace_back().name = name;
	return static_cast<uint32_t>(m_level.material_list.size() - 1);
}

uint32_t LevelBuilder::addMasked(const std::string& name, Mask mask)
{
	const uint32_t index = addMaterial(name);
	Material& material = m_level.material_list.back();
	material.alpha_mode = AlphaMode::mask;
	material.two_sided = true;
	material.mask = static_cast<int>(m_level.masks.size());
	m_level.masks.push_back(std::move(mask));
	measureAlpha(material, m_level.masks);
	return index;
}

void LevelBuilder::beginMesh(const std::string& name, uint32_t material)
{
	m_level.meshes.push_back({name, m_level.triangles.size(), 0});
	m_material = material;
}

void LevelBuilder::addCamera(const std::string& name, glm::dvec3 eye, glm::dvec3 target, double fov_y_deg)
{
	LevelCamera camera;
	camera.name = name;
	camera.world_from_camera = worldFromCamera(eye, target);
	camera.lens.fov_y_rad = fov_y_deg * (kPi / 180.0);
	m_level.cameras.push_back(camera);
}

uint32_t LevelBuilder::addVertex(glm::dvec3 position, glm::dvec3 normal, glm::dvec2 uv)
{
	m_level.positions.push_back(position);
	m_level.normals.emplace_back(normal);
	m_level.uvs.emplace_back(uv);
	return static_cast<uint32_t>(m_level.positions.size() - 1);
}

void LevelBuilder::addTriangle(uint32_t a, uint32_t b, uint32_t c)
{
	m_level.triangles.emplace_back(a, b, c);
	m_level.materials.push_back(m_material);
	m_level.meshes.back().triangle_count += 1;
}

void LevelBuilder::addQuad(uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
	addTriangle(a, b, c);
	addTriangle(a, c, d);
}

Level LevelBuilder::finish()
{
	return std::move(m_level);
}

void addBox(LevelBuilder& builder, const Frame& frame, glm::dvec3 least, glm::dvec3 most)
{
	addExtrusion(builder, frame, {rectangleOf({least.x, least.y}, {most.x, most.y})}, least.z, most.z);
}

void addExtrusion(LevelBuilder& builder, const Frame& frame, const std::vector<Contour>& contours, double from, double to)
{
	assert(from < to);
	const std::vector<glm::uvec3> triangles = triangulateContours(contours);
	addCap(builder, frame, contours, triangles, from, false);
	addCap(builder, frame, contours, triangles, to, true);
	for (const Contour& contour : contours)
	{
		addSides(builder, frame, contour, from, to);
	}
}

void addLathe(LevelBuilder& builder, const Frame& frame, std::span<const glm::dvec2> profile, int segments)
{
	const bool ring = profile.front().x > 0.0;
	const std::vector<EdgeNormals> normals = edgeNormals(profile, ring, 0.643);
	double travelled = 0.0;
	for (std::size_t i = 0; i < normals.size(); ++i)
	{
		const glm::dvec2 low = profile[i];
		const glm::dvec2 high = profile[(i + 1) % profile.size()];
		const double next = travelled + glm::length(high - low);
		addBand(builder, frame, low, high, normals[i], {travelled, next}, segments);
		travelled = next;
	}
}

void addCylinder(LevelBuilder& builder, glm::dvec3 from, glm::dvec3 to, double radius, int segments)
{
	const double length = glm::length(to - from);
	const glm::dvec2 profile[] = {{0.0, 0.0}, {radius, 0.0}, {radius, length}, {0.0, length}};
	addLathe(builder, frameAlong(from, to - from), profile, segments);
}

void addSphere(LevelBuilder& builder, glm::dvec3 centre, double radius, int segments)
{
	const int rings = segments / 2;
	std::vector<glm::dvec2> profile;
	for (int i = 0; i <= rings; ++i)
	{
		const SinCos at = sinCosOf(kPi * i / rings);
		profile.emplace_back(i == 0 || i == rings ? 0.0 : radius * at.sin, -radius * at.cos);
	}
	addLathe(builder, frameAt(centre), profile, segments);
}

void addTube(LevelBuilder& builder, std::span<const glm::dvec3> points, std::span<const double> radii, int segments)
{
	// Rings are orthogonal to the mean of the two adjacent directions; the frame is transported without twist.
	const std::size_t count = points.size();
	const auto n = static_cast<std::size_t>(segments);
	std::vector<std::vector<uint32_t>> rings(count);
	Frame frame = frameAlong(points[0], points[1] - points[0]);
	double travelled = 0.0;
	for (std::size_t i = 0; i < count; ++i)
	{
		const glm::dvec3 ahead = points[i + 1 < count ? i + 1 : i] - points[i + 1 < count ? i : i - 1];
		const glm::dvec3 behind = points[i > 0 ? i : 1] - points[i > 0 ? i - 1 : 0];
		frame.y = glm::normalize(glm::normalize(ahead) + glm::normalize(behind));
		frame.z = glm::normalize(glm::cross(frame.x, frame.y));
		frame.x = glm::cross(frame.y, frame.z);
		frame.at = points[i];
		travelled += i > 0 ? glm::length(behind) : 0.0;
		for (std::size_t k = 0; k <= n; ++k)
		{
			const SinCos at = sinCosOf(2.0 * kPi * static_cast<double>(k % n) / static_cast<double>(n));
			const glm::dvec3 out = frame.direction({at.cos, 0.0, -at.sin});
			rings[i].push_back(
				builder.addVertex(points[i] + radii[i] * out, out, {static_cast<double>(k) / static_cast<double>(n), travelled}));
		}
		if (i > 0)
		{
			for (std::size_t k = 0; k < n; ++k)
			{
				builder.addQuad(rings[i - 1][k], rings[i - 1][k + 1], rings[i][k + 1], rings[i][k]);
			}
		}
		if (i == 0 || i + 1 == count)
		{
			const glm::dvec3 normal = i == 0 ? -frame.y : frame.y;
			const uint32_t middle = builder.addVertex(points[i], normal, {0.5, 0.5});
			std::vector<uint32_t> rim;
			for (std::size_t k = 0; k < n; ++k)
			{
				const SinCos at = sinCosOf(2.0 * kPi * static_cast<double>(k) / static_cast<double>(n));
				const glm::dvec3 out = frame.direction({at.cos, 0.0, -at.sin});
				rim.push_back(builder.addVertex(points[i] + radii[i] * out, normal, {0.5 + 0.5 * at.cos, 0.5 + 0.5 * at.sin}));
			}
			for (std::size_t k = 0; k < n; ++k)
			{
				const uint32_t a = rim[k];
				const uint32_t b = rim[(k + 1) % n];
				builder.addTriangle(middle, i == 0 ? b : a, i == 0 ? a : b);
			}
		}
	}
}

void addCard(LevelBuilder& builder, glm::dvec3 corner, glm::dvec3 right, glm::dvec3 up, glm::dvec2 repeats)
{
	const glm::dvec3 normal = glm::normalize(glm::cross(right, up));
	const uint32_t a = builder.addVertex(corner, normal, {0.0, repeats.y});
	const uint32_t b = builder.addVertex(corner + right, normal, {repeats.x, repeats.y});
	const uint32_t c = builder.addVertex(corner + right + up, normal, {repeats.x, 0.0});
	const uint32_t d = builder.addVertex(corner + up, normal, {0.0, 0.0});
	builder.addQuad(a, b, c, d);
}

Contour arcOf(glm::dvec2 centre, double radius, double from_rad, double to_rad, int steps)
{
	Contour points;
	for (int i = 0; i <= steps; ++i)
	{
		const SinCos angle = sinCosOf(from_rad + (to_rad - from_rad) * i / steps);
		points.emplace_back(centre.x + radius * angle.cos, centre.y + radius * angle.sin);
	}
	return points;
}

Contour rectangleOf(glm::dvec2 least, glm::dvec2 most)
{
	return {least, {most.x, least.y}, most, {least.x, most.y}};
}

Contour holeOf(Contour contour)
{
	std::reverse(contour.begin(), contour.end());
	return contour;
}

void addColumn(LevelBuilder& builder, glm::dvec3 foot, double scale, int segments)
{
	const double w = 0.46 * scale;
	addBox(builder, frameAt(foot), {-w, -0.02, -w}, {w, 0.18 * scale, w});
	// Attic base: a large torus, a hollow, a small torus.
	Profile profile = {{0.0, 0.17}};
	append(profile, arcOf({0.39, 0.245}, 0.065, -0.5 * kPi, 0.5 * kPi, 5));
	append(profile, {{0.365, 0.325}, {0.345, 0.35}});
	append(profile, arcOf({0.35, 0.405}, 0.03, -0.5 * kPi, 0.5 * kPi, 4));
	// Entasis: the shaft swells by a hundredth below the middle.
	append(profile, {{0.325, 0.45}, {0.315, 0.50}, {0.318, 1.2}, {0.306, 2.0}, {0.284, 2.75}, {0.27, 3.06}});
	append(profile, {{0.295, 3.075}, {0.295, 3.12}, {0.272, 3.135}, {0.272, 3.24}, {0.30, 3.26}});
	append(profile, {{0.345, 3.31}, {0.385, 3.385}, {0.405, 3.46}, {0.40, 3.48}, {0.0, 3.48}});
	addScaled(builder, foot, profile, scale, segments);
	addBox(builder, frameAt(foot), {-w - 0.01, 3.47 * scale, -w - 0.01}, {w + 0.01, 3.6 * scale, w + 0.01});
}

void addBalustrade(LevelBuilder& builder, glm::dvec3 from, glm::dvec3 to, bool last)
{
	const double length = glm::length(to - from);
	Frame frame;
	frame.at = from;
	frame.x = glm::normalize(to - from);
	frame.z = glm::cross(frame.x, frame.y);
	for (int i = 0; i < (last ? 2 : 1); ++i)
	{
		const double x = i * length;
		addBox(builder, frame, {x - 0.2, -0.02, -0.2}, {x + 0.2, 0.95, 0.2});
		addBox(builder, frame, {x - 0.24, 0.95, -0.24}, {x + 0.24, 1.03, 0.24});
	}
	addBox(builder, frame, {0.2, -0.02, -0.14}, {length - 0.2, 0.1, 0.14});
	addBox(builder, frame, {0.2, 0.82, -0.13}, {length - 0.2, 0.95, 0.13});
	const Profile profile = {{0.0, 0.09}, {0.08, 0.09}, {0.08, 0.13}, {0.045, 0.16}, {0.085, 0.30}, {0.07, 0.42},
							 {0.04, 0.6}, {0.04, 0.70}, {0.07, 0.74}, {0.07, 0.83},  {0.0, 0.83}};
	const int count = static_cast<int>(std::floor((length - 0.4) / 0.4));
	for (int i = 0; i < count; ++i)
	{
		const double x = 0.2 + (length - 0.4) * (i + 0.5) / count;
		addLathe(builder, frameAt(frame.point({x, 0.0, 0.0})), profile, 8);
	}
}

Contour stairsOf(glm::dvec2 foot, int steps, double riser, double tread, double landing, double buried)
{
	const double end = foot.x + (steps - 1) * tread + landing;
	Contour contour = {{foot.x, foot.y - buried}, {end, foot.y - buried}, {end, foot.y + steps * riser}};
	for (int i = steps - 1; i >= 0; --i)
	{
		contour.emplace_back(foot.x + i * tread, foot.y + (i + 1) * riser);
		if (i > 0)
		{
			contour.emplace_back(foot.x + i * tread, foot.y + i * riser);
		}
	}
	return contour;
}

Contour archwayOf(double middle, double half_width, double bottom, double spring, int steps)
{
	Contour contour = {{middle - half_width, bottom}, {middle + half_width, bottom}};
	append(contour, arcOf({middle, spring}, half_width, 0.0, kPi, steps));
	return contour;
}

Contour archivoltOf(glm::dvec2 centre, double inner, double outer, int steps)
{
	Contour contour = arcOf(centre, outer, 0.0, kPi, steps);
	append(contour, arcOf(centre, inner, kPi, 0.0, steps));
	return contour;
}

void addUrn(LevelBuilder& builder, glm::dvec3 foot, double height, int segments)
{
	// Outside upward, over the lip, inside downward; one closed line from axis to axis.
	const Profile profile = {{0.0, 0.0},   {0.20, 0.0},  {0.20, 0.04}, {0.11, 0.08}, {0.10, 0.14}, {0.20, 0.24}, {0.32, 0.42},
							 {0.36, 0.58}, {0.33, 0.74}, {0.24, 0.86}, {0.22, 0.92}, {0.29, 0.98}, {0.29, 1.0},  {0.26, 1.0},
							 {0.19, 0.93}, {0.21, 0.85}, {0.29, 0.73}, {0.32, 0.58}, {0.28, 0.43}, {0.0, 0.35}};
	addScaled(builder, foot, profile, height, segments);
}

void addBarrel(LevelBuilder& builder, glm::dvec3 foot, int segments)
{
	const Profile profile = {{0.0, 0.0},   {0.25, 0.0},  {0.26, 0.06},  {0.268, 0.06}, {0.282, 0.12}, {0.272, 0.12},
							 {0.31, 0.33}, {0.32, 0.33}, {0.325, 0.40}, {0.315, 0.40}, {0.315, 0.50}, {0.325, 0.50},
							 {0.32, 0.57}, {0.31, 0.57}, {0.272, 0.78}, {0.282, 0.78}, {0.268, 0.84}, {0.26, 0.84},
							 {0.25, 0.90}, {0.23, 0.90}, {0.23, 0.87},  {0.0, 0.87}};
	addLathe(builder, frameAt(foot), profile, segments);
}

void addCrate(LevelBuilder& builder, glm::dvec3 foot, double width, double angle_rad)
{
	const Frame frame = turnedFrame(foot, angle_rad);
	const double h = 0.5 * width;
	const double board = 0.12 * width;
	const double proud = 0.025;
	addBox(builder, frame, {-h + proud, 0.01, -h + proud}, {h - proud, width - proud, h - proud});
	for (const double x : {-h, h - board})
	{
		for (const double z : {-h, h - board})
		{
			addBox(builder, frame, {x, 0.0, z}, {x + board, width, z + board});
		}
	}
	for (const double y : {0.004, width - board - 0.004})
	{
		const double inset = 0.004;
		for (const double z : {-h + inset, h - inset - proud})
		{
			addBox(builder, frame, {-h + board, y, z}, {h - board, y + board, z + proud});
		}
		for (const double x : {-h + inset, h - inset - proud})
		{
			addBox(builder, frame, {x, y, -h + board}, {x + proud, y + board, h - board});
		}
	}
}

} // namespace nook
