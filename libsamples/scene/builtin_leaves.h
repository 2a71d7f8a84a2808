// SPDX-License-Identifier: GPL-3.0-or-later
// Procedural masks with smooth edges, and objects made of them: leaves, grass, wire netting.
#pragma once

#include "core/random.h"
#include "scene/builtin_shapes.h"

namespace nook
{

// A twig with leaves, growing upward from the middle of the lower edge.
Mask leafMask();

// Blades of grass, from the lower edge upward.
Mask grassMask();

// One period of chain link: two crossing wires, as thick as `width` of the period; tiles seamlessly.
Mask chainLinkMask(double width);

// The given number of cards of that size in an ellipsoid, denser outside, fronts outward. The builder's mesh must be masked.
void addLeaves(LevelBuilder& builder, Random& random, glm::dvec3 centre, glm::dvec3 radii, double size, int count);

struct TreeSize
{
	double trunk_height; // metres, up to where branches start to end
	double trunk_radius; // metres
	int branches;
	double reach; // length of the branches, metres
	double card;  // size of a card, metres
	int cards;    // per branch
};

// Wood goes to one mesh and leaves to the next; `leaves` is a masked material.
void addTree(LevelBuilder& builder, Random& random, glm::dvec3 foot, const TreeSize& size, uint32_t bark, uint32_t leaves);

// Upright cards on a level floor within `radius`.
void addGrass(LevelBuilder& builder, Random& random, glm::dvec3 centre, double radius, double size, int count);

} // namespace nook
