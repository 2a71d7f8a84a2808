// SPDX-License-Identifier: GPL-3.0-or-later
// Levels of a few surfaces, for tests with closed forms.
#pragma once

#include "testing.h"

#include "scene/level.h"

namespace nook::test
{

inline Level emptyLevel()
{
	Level level;
	level.name = "test";
	level.material_list.push_back({});
	level.meshes.push_back({"all", 0, 0});
	return level;
}

inline uint32_t addVertex(Level& level, glm::dvec3 position, glm::vec2 uv = {})
{
	level.positions.push_back(position);
	level.normals.emplace_back(0.0F);
	level.uvs.push_back(uv);
	return static_cast<uint32_t>(level.positions.size() - 1);
}

inline void addTriangle(Level& level, uint32_t a, uint32_t b, uint32_t c, uint32_t material = 0)
{
	level.triangles.emplace_back(a, b, c);
	level.materials.push_back(material);
	level.meshes.back().triangle_count += 1;
}

// Corners corner, corner + u, corner + u + v, corner + v; front towards u × v.
inline void addQuad(Level& level, glm::dvec3 corner, glm::dvec3 u, glm::dvec3 v, uint32_t material = 0)
{
	const uint32_t a = addVertex(level, corner, {0.0F, 0.0F});
	const uint32_t b = addVertex(level, corner + u, {1.0F, 0.0F});
	const uint32_t c = addVertex(level, corner + u + v, {1.0F, 1.0F});
	const uint32_t d = addVertex(level, corner + v, {0.0F, 1.0F});
	addTriangle(level, a, b, c, material);
	addTriangle(level, a, c, d, material);
}

inline void addBox(Level& level, glm::dvec3 least, glm::dvec3 most)
{
	const glm::dvec3 s = most - least;
	const glm::dvec3 x(s.x, 0.0, 0.0);
	const glm::dvec3 y(0.0, s.y, 0.0);
	const glm::dvec3 z(0.0, 0.0, s.z);
	addQuad(level, least, y, x);
	addQuad(level, least, z, y);
	addQuad(level, least, x, z);
	addQuad(level, least + z, x, y);
	addQuad(level, least + x, y, z);
	addQuad(level, least + y, z, x);
}

// A floor of 8 m around the origin, and a box of 1 m floating 0.2 m above.
inline Level floorAndBox()
{
	Level level = emptyLevel();
	addQuad(level, {-4.0, 0.0, 4.0}, {8.0, 0.0, 0.0}, {0.0, 0.0, -8.0});
	addBox(level, {-0.5, 0.2, -0.5}, {0.5, 1.2, 0.5});
	return level;
}

// A fan around `centre` that faces −y.
inline void addDiskFacingDown(Level& level, glm::dvec3 centre, double radius_m, int segments)
{
	const uint32_t middle = addVertex(level, centre);
	const auto first = static_cast<uint32_t>(level.positions.size());
	for (int i = 0; i < segments; ++i)
	{
		const SinCos a = sinCosOf(2.0 * kPi * i / segments);
		addVertex(level, centre + radius_m * glm::dvec3(a.cos, 0.0, a.sin));
	}
	for (int i = 0; i < segments; ++i)
	{
		addTriangle(level, middle, first + static_cast<uint32_t>(i), first + static_cast<uint32_t>((i + 1) % segments));
	}
}

// A closed sphere of rings between two poles with shared vertices, facing outward.
inline void addSphere(Level& level, glm::dvec3 centre, double radius_m, int rings, int segments)
{
	const uint32_t top = addVertex(level, centre + glm::dvec3(0.0, radius_m, 0.0));
	const uint32_t bottom = addVertex(level, centre - glm::dvec3(0.0, radius_m, 0.0));
	const auto first = static_cast<uint32_t>(level.positions.size());
	for (int ring = 1; ring < rings; ++ring)
	{
		const SinCos polar = sinCosOf(kPi * ring / rings);
		for (int i = 0; i < segments; ++i)
		{
			const SinCos a = sinCosOf(2.0 * kPi * i / segments);
			addVertex(level, centre + radius_m * glm::dvec3(polar.sin * a.cos, polar.cos, polar.sin * a.sin));
		}
	}
	const auto at = [&](int ring, int i)
	{
		return first + static_cast<uint32_t>((ring - 1) * segments + i % segments);
	};
	for (int i = 0; i < segments; ++i)
	{
		addTriangle(level, top, at(1, i + 1), at(1, i));
		addTriangle(level, bottom, at(rings - 1, i), at(rings - 1, i + 1));
		for (int ring = 1; ring + 1 < rings; ++ring)
		{
			addTriangle(level, at(ring, i), at(ring, i + 1), at(ring + 1, i));
			addTriangle(level, at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i));
		}
	}
}

inline void checkNear(glm::dvec3 found, glm::dvec3 expected, double tolerance = 1e-9)
{
	INFO("found " << found.x << " " << found.y << " " << found.z);
	INFO("expected " << expected.x << " " << expected.y << " " << expected.z);
	CHECK(glm::distance(found, expected) <= tolerance);
}

inline void checkBox(const Level& level, glm::dvec3 least, glm::dvec3 most)
{
	const Bounds bounds = boundsOf(level);
	checkNear(bounds.least, least);
	checkNear(bounds.most, most);
}

} // namespace nook::test
