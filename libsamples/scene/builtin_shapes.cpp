// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/builtin_shapes.h"

#include "core/math.h"

#include <glm/geometric.hpp>

#include <cassert>
#include <cmath>
#include <utility>

namespace nook
{
namespace
{

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
	Material material;
	material.name = name;
	m_level.material_list.push_back(material);
	return static_cast<uint32_t>(m_level.material_list.size() - 1);
}

uint32_t LevelBuilder::addMasked(const std::string& name, Mask mask)
{
	Material material;
	material.name = name;
	material.alpha_mode = AlphaMode::mask;
	material.two_sided = true;
	material.mask = static_cast<int>(m_level.masks.size());
	m_level.masks.push_back(std::move(mask));
	measureAlpha(material, m_level.masks);
	m_level.material_list.push_back(material);
	return static_cast<uint32_t>(m_level.material_list.size() - 1);
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

void LevelBuilder::reserve(std::size_t vertices, std::size_t triangles)
{
	m_level.positions.reserve(vertices);
	m_level.normals.reserve(vertices);
	m_level.uvs.reserve(vertices);
	m_level.triangles.reserve(triangles);
	m_level.materials.reserve(triangles);
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
	Frame frame;
	frame.at = centre;
	addLathe(builder, frame, profile, segments);
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

} // namespace nook
