// SPDX-License-Identifier: GPL-3.0-or-later
// Masks made in code, with smooth edges, and what is made of them: leaves, grass, wire netting.
#pragma once

#include "core/random.h"
#include "scene/builtin_shapes.h"

namespace nook
{

// A twig with leaves, from the middle of the lower edge upward.
Mask leafMask();

// Blades of grass, from the lower edge upward.
Mask grassMask();

// One period of chain link: two wires that cross, `width` of the period thick; tiles without a seam.
Mask chainLinkMask(double width);

// Cards of that size in an ellipsoid, denser outside, their fronts outward; as many as told. The builder's mesh must be masked.
void addLeaves(LevelBuilder& builder, Random& random, glm::dvec3 centre, glm::dvec3 radii, double size, int count);

struct TreeSize
{
	double trunk_height; // metres, up to where branches begin to end
	double trunk_radius; // metres
	int branches;
	double reach; // of the branches, metres
	double card;  // size of a card, metres
	int cards;    // a branch
};

// Wood goes to one mesh, leaves to the next; `leaves` is a masked material.
void addTree(LevelBuilder& builder, Random& random, glm::dvec3 foot, const TreeSize& size, uint32_t bark, uint32_t leaves);

// Upright cards on a level floor within `radius`.
void addGrass(LevelBuilder& builder, Random& random, glm::dvec3 centre, double radius, double size, int count);

} // namespace nook
