// SPDX-License-Identifier: GPL-3.0-or-later
// The open edges of a piece of surface → how much area its holes can have.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>

namespace nook::detail
{

// An edge that a surface has one way only, in the direction that its triangle runs along it.
struct OpenEdge
{
	uint32_t piece = 0;
	uint32_t from = 0; // vertices; those at one position are one
	uint32_t to = 0;
};

// Adds to holes[piece] twice the area, m², that its open edges can bound at most: loop by loop the lesser of L² / (4 π) for its
// length L, and of the cone over it from its first vertex. So a slit has none: where triangles without area were, as cleaned scans
// have it, edges lie along one another. Edges of a piece next to one another.
// Where not as many arrive at a vertex as leave it, ways that do not close count as if they did.
void addHoles(std::span<const OpenEdge> edges, std::span<const glm::dvec3> positions, std::span<double> holes);

} // namespace nook::detail
