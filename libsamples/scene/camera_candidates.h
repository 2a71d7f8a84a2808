// SPDX-License-Identifier: GPL-3.0-or-later
// A level → places from which to look at it, many more than are needed. For camera_choice.cpp.
#pragma once

#include "scene/tracer.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace nook
{

struct Site
{
	Bounds bounds;
	double diagonal = 0.0;   // metres
	double eye_height = 0.0; // where there is no ceiling, metres
};
Site siteOf(const Level& level);

struct CameraCandidate
{
	glm::dvec3 eye{0.0};
	glm::dvec3 way{0.0, 0.0, -1.0}; // in which it looks, of any length; no point: far from the origin it would be the eye itself
	double clearance = 0.0;         // what is nearer is too near, metres
	double worth = 1.0;             // of its place: less where hardly anybody stands
	bool outside = false;           // not a place where one stands
};
glm::dmat4 worldFromCamera(const CameraCandidate& candidate);

// Where to look for places; each is for levels of which those before it show too little.
enum class Places
{
	standing, // over floors; none where too few are found, or in objects of less than 2 m
	around,   // on a sphere around the level
	close,    // before its largest triangles: wires, that a small picture of the whole misses
};
inline constexpr std::array<Places, 3> kAllPlaces{Places::standing, Places::around, Places::close};

// Deterministic.
std::vector<CameraCandidate> cameraCandidates(const Tracer& tracer, const Site& site, Places places);

// Direction i of `count` that are spread evenly over the sphere: Fibonacci's lattice, from −y up to +y.
glm::dvec3 sphereDirection(int i, int count);

} // namespace nook
