// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices of one position and one normal → one value, so that seams of textures and of meshes do not show.
#pragma once

#include "bake/bake.h"
#include "scene/level.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace nook
{

struct Unknowns
{
	std::vector<uint32_t> of_vertex; // its value; in the order of the values' first vertices
	std::vector<uint32_t> of_back;   // that of its other side; the same where it has one value
	bool has_sides = false;          // some have two values
	std::size_t count = 0;
	std::vector<uint32_t> place_of_vertex; // its position: the same for vertices that lie at one place
};

// Unit normals: of the vertices, or where they have none the mean of their triangles', by area. Zero where no triangle is.
std::vector<glm::vec3> vertexNormals(const Level& level);

// Vertices share a value where their positions are equal and their normals differ by less than 2.6 degrees. Unused ones have
// values, too. BakeSides::separate: those of materials with two sides have two; the backs come last, in the order of the fronts.
Unknowns unknownsOf(const Level& level, BakeSides sides = BakeSides::mean);

} // namespace nook
