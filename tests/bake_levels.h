// SPDX-License-Identifier: GPL-3.0-or-later
// Levels and settings for tests of bakes.
#pragma once

#include "small_levels.h"

#include "bake/bake.h"
#include "scene/gltf_edit.h"
#include "scene/load_parts.h"

namespace nook::test
{

// A level as a file with baked values.
inline std::string bakedGlb(const Level& level, std::string_view generator, const GlbBake& bake)
{
	if (bake.visibility.empty() && bake.png.empty())
	{
		return levelGlb(level, generator);
	}
	GltfBake in;
	static_cast<GlbBake&>(in) = bake;
	std::vector<GltfPlace> places;
	std::string bytes = levelGlb(level, generator, &places);
	const std::array<std::string, 1> output{"level.glb"};
	return bakeInto(openGlb(std::move(bytes), level.name), places, in, output).files.front();
}

inline BakeSettings within(double radius_m)
{
	BakeSettings settings{.radius_m = radius_m};
	return settings;
}

// A square floor of `cells` × `cells` in y = 0 with its own vertices, facing up.
inline void addFloor(Level& level, glm::dvec3 corner, double side_m, int cells)
{
	const auto first = static_cast<uint32_t>(level.positions.size());
	for (int z = 0; z <= cells; ++z)
	{
		for (int x = 0; x <= cells; ++x)
		{
			addVertex(level, corner + side_m / cells * glm::dvec3(x, 0.0, z));
		}
	}
	for (int z = 0; z < cells; ++z)
	{
		for (int x = 0; x < cells; ++x)
		{
			const uint32_t a = first + static_cast<uint32_t>(z * (cells + 1) + x);
			const uint32_t b = a + static_cast<uint32_t>(cells) + 1;
			addTriangle(level, a, b, a + 1);
			addTriangle(level, a + 1, b, b + 1);
		}
	}
}

} // namespace nook::test
