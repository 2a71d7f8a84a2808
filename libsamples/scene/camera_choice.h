// SPDX-License-Identifier: GPL-3.0-or-later
// A level → cameras: by name, or the most informative views of it; and whether a point lies inside something solid.
#pragma once

#include "core/progress.h"
#include "scene/camera.h"
#include "scene/tracer.h"

#include <glm/vec3.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// The level's camera of that name. Throws Error (usage), naming those there are.
const LevelCamera& cameraNamed(const Level& level, std::string_view name);

// Up to `count` views of the level, the best first, no two alike; "auto-1", "auto-2", …; perspective, 60° high. Levels are seen
// from standing height over their floors; from outside where fewer than `count` such views show something: small objects, small
// floors, closed solids. The same ones on any number of threads. How a view is judged: camera_choice.cpp. Fewer than `count` only
// where no other view shows anything; throws Error (invalid_input) where none does, as in a level that lets every ray through.
// Requires count ≥ 1.
std::vector<LevelCamera> chooseCameras(const Tracer& tracer, int count, const RunSettings& run);

struct CamerasOfLevel
{
	std::vector<LevelCamera> cameras; // one or more
	bool chosen = false;              // by chooseCameras, from places that it has checked
};

// `automatic` views chosen, where that is above 0; else the camera of that name; without a name the level's first, or one chosen
// where it has none. Throws Error: usage for a camera that the level does not have; invalid_input where fewer views than asked for
// show something.
CamerasOfLevel camerasOf(const Tracer& tracer, std::string_view name, int automatic, const RunSettings& run);

// Share of the directions in which a point is inside something solid, of those that meet a one-sided surface; 0 where fewer than a
// twentieth of all meet one. Inside: the nearest of these surfaces shows its back, or, as solids that are built into one another
// have fronts within, the ray leaves one solid more than it has entered.
double insideShare(const Tracer& tracer, glm::dvec3 point, int directions = 512);

inline constexpr double kInsideShare = 0.95; // from which on a point counts as inside

// Throws Error (invalid_input) where `eye` is inside something solid; `name` is the camera's.
void checkOutside(const Tracer& tracer, glm::dvec3 eye, const std::string& name);

} // namespace nook
