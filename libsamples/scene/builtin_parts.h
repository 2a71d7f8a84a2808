// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of buildings for the built-in levels: columns, balustrades, stairs, archways, pots. All closed.
#pragma once

#include "scene/builtin_shapes.h"

namespace nook
{

// Plinth, turned base, swelling shaft, neck, capital and abacus; 3.6 m × `scale` high, 0.94 m wide.
void addColumn(LevelBuilder& builder, glm::dvec3 foot, double scale, int segments);

// Rail, plate and turned balusters 0.4 m apart between two points of a level floor, 0.95 m high; a pedestal at the start and, if it
// is the last of a row, at the end.
void addBalustrade(LevelBuilder& builder, glm::dvec3 from, glm::dvec3 to, bool last = true);

// Side outline of a flight of stairs, from (x, y) upward to the right, down to y − buried; counter-clockwise. The right end is
// vertical, at x + (steps − 1) × tread + landing.
Contour stairsOf(glm::dvec2 foot, int steps, double riser, double tread, double landing, double buried);

// An opening with a round top; counter-clockwise; `spring` is where the round part begins.
Contour archwayOf(double middle, double half_width, double bottom, double spring, int steps);

// Half a ring around a round arch.
Contour archivoltOf(glm::dvec2 centre, double inner, double outer, int steps);

// A vase with an open mouth, `height` tall.
void addUrn(LevelBuilder& builder, glm::dvec3 foot, double height, int segments);

// 0.9 m tall, with hoops.
void addBarrel(LevelBuilder& builder, glm::dvec3 foot, int segments);

// A cube of that width made of boards around a box, rotated.
void addCrate(LevelBuilder& builder, glm::dvec3 foot, double width, double angle_rad);

} // namespace nook
