// SPDX-License-Identifier: GPL-3.0-or-later
// Objects around a suburban house: an air-conditioning unit, bins, a window with shutters. For builtin_suburb.cpp.
#pragma once

#include "scene/builtin_shapes.h"

namespace nook
{

// 0.92 m wide, 0.36 m deep, 0.72 m high, front towards +z: 78 fins, 1.5 mm thick, 10 mm apart.
void addAirConditioner(LevelBuilder& builder, glm::dvec3 foot);

// On two wheels, 1.05 m high, front towards +z.
void addBin(LevelBuilder& builder, const Frame& frame);

// Fills a hole in a wall whose outer face is the frame's x-y plane: frame, bars and panes, set back; a sill; optional shutters.
void addWindow(LevelBuilder& builder, const Frame& frame, glm::dvec2 least, glm::dvec2 most, bool shutters);

// A door leaf with panels in its frame, set back, and a knob.
void addDoor(LevelBuilder& builder, const Frame& frame, glm::dvec2 least, glm::dvec2 most);

// A tiled roof with a ridge along x at z = 0, reaching `half_span` to both sides, from eave height to ridge height.
void addTiledRoof(LevelBuilder& builder, const Frame& frame, double half_span, double eave, double ridge, double from_x,
				  double to_x);

// A half-round gutter below an eave, with brackets, along x.
void addGutter(LevelBuilder& builder, const Frame& frame, double from_x, double to_x);

} // namespace nook
