// SPDX-License-Identifier: GPL-3.0-or-later
// A level and what is asked for → the views to take pictures from.
#pragma once

#include "core/progress.h"
#include "scene/camera.h"
#include "scene/tracer.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <vector>

namespace nook
{

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
