// SPDX-License-Identifier: GPL-3.0-or-later
// Candidate views of a level, many more than needed. For camera_choice.cpp.
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
	double eye_height = 0.0; // without a ceiling, metres
};
Site siteOf(const Level& level);

struct CameraCandidate
{
	glm::dvec3 eye{0.0};
	glm::dvec3 way{0.0, 0.0, -1.0}; // view direction of any length; not a target, which far from the origin could round to the eye
	double clearance = 0.0;         // minimum distance to surfaces, metres
	double worth = 1.0;             // weight of the position: lower where people rarely stand
	bool outside = false;           // not a place where a person could stand
};
glm::dmat4 worldFromCamera(const CameraCandidate& candidate);

// Kinds of positions; each is used if the previous ones show too little.
enum class Places
{
	standing, // above floors; empty if there are too few, or for objects below 2 m
	around,   // on a sphere around the level
	close,    // in front of its largest triangles: finds thin wires that a small picture of the whole misses
};
inline constexpr std::array<Places, 3> kAllPlaces{Places::standing, Places::around, Places::close};

// Deterministic.
std::vector<CameraCandidate> cameraCandidates(const Tracer& tracer, const Site& site, Places places);

// Direction i of `count` evenly distributed ones: Fibonacci lattice, from −y up to +y.
glm::dvec3 sphereDirection(int i, int count);

} // namespace nook
