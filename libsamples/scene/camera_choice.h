// SPDX-License-Identifier: GPL-3.0-or-later
// Selects a level's cameras by name, or its most informative views; tests whether a point lies inside a solid.
#pragma once

#include "core/progress.h"
#include "scene/camera.h"
#include "scene/tracer.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// The best views of a tracer's level, kept with it because several stages look from the same ones.
struct CameraMemo
{
	std::mutex mutex;
	int chosen = 0;                   // views that were asked for
	std::vector<LevelCamera> cameras; // that show something
};

// The level's camera with that name. Throws Error (usage) with the list of names.
const LevelCamera& cameraNamed(const Level& level, std::string_view name);

// Up to `count` views of the level, best first, all different; "auto-1", "auto-2", …; perspective, 60° high. Levels are viewed from
// standing height above their floors, or from outside if fewer than `count` such views show something: small objects, small floors,
// closed solids. Same result for any thread count. Scoring: camera_choice.cpp. Returns fewer than `count` only if no other view
// shows anything; throws Error (invalid_input) if none does, for example in a level that lets every ray through. Requires count ≥
// 1.
std::vector<LevelCamera> chooseCameras(const Tracer& tracer, int count, const RunSettings& run);

struct CamerasOfLevel
{
	std::vector<LevelCamera> cameras; // one or more
	bool chosen = false;              // by chooseCameras, whose positions are already checked
};

// Chooses `automatic` views if that is above 0; else takes the camera with that name; without a name the level's first, or an
// automatic one if it has none. Throws Error: usage for an unknown camera; invalid_input if fewer views than requested show
// something.
CamerasOfLevel camerasOf(const Tracer& tracer, std::string_view name, int automatic, const RunSettings& run);

// Fraction of the directions for which a point is inside a solid, of those that hit a one-sided surface; 0 if fewer than a
// twentieth of all do. Inside means that the nearest of these surfaces shows its back or, since intersecting solids have fronts
// inside, that the ray leaves one more solid than it enters.
double insideShare(const Tracer& tracer, glm::dvec3 point, int directions = 512);

inline constexpr double kInsideShare = 0.95; // a point at or above this counts as inside

// Throws Error (invalid_input) if `eye` is inside a solid; `name` is the camera's.
void checkOutside(const Tracer& tracer, glm::dvec3 eye, const std::string& name);

struct CameraOptions
{
	std::string camera;                   // empty: the level's first, or one chosen
	int automatic = 0;                    // K views chosen; 0: by name
	std::optional<glm::dvec3> eye;        // world, metres
	std::optional<glm::dvec3> target;     // world, metres
	std::optional<double> fov_y_deg;      // whole vertical angle
	std::optional<double> near_m;         // of the projection that is written down; rays are not cut
	std::optional<glm::dmat4> projection; // replaces the camera's own
	std::optional<glm::dmat4> camera_from_world;
	int width_px = 1280;
	int height_px = 720;
	bool allow_inside = false;
};

// Before any work. Throws Error for projections that have no lines of sight, and (usage) for an eye that is its own target and a
// matrix that is no rotation and translation.
void checkCameras(const CameraOptions& options);

// Number of pictures that were asked for: K, or 1.
int pictureCount(const CameraOptions& options);

// Files for that many pictures: the name itself for one; "g.exr" becomes "g-1.exr", "g-2.exr", … for more.
std::vector<std::string> pictureFiles(const std::string& file, int count);

struct NamedView
{
	std::string name;          // "main", "auto-1", or "given" for an eye or a matrix
	bool chosen = false;       // by nook, also where it stands in for a level without cameras
	bool from_outside = false; // of a chosen one: the level shows too little to those who stand in it
	View view;
};

// pictureCount() views. Throws Error: usage for a camera that the level does not have; invalid_input where a camera is inside
// something solid (unless allowed), or fewer views than asked for show something.
std::vector<NamedView> viewsOf(const CameraOptions& options, const Tracer& tracer, const RunSettings& run);

} // namespace nook
