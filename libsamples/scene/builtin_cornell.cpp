// SPDX-License-Identifier: GPL-3.0-or-later
// The box of C. Goral et al., "Modeling the Interaction of Light Between Diffuse Surfaces", 1984, in the proportions that Cornell
// University's Program of Computer Graphics measured later, a hundred times smaller: 5.56 m wide, 5.48 m high, 5.6 m deep.
#include "scene/builtin_levels.h"
#include "scene/builtin_shapes.h"

namespace nook
{

Level makeCornell()
{
	LevelBuilder builder;
	const uint32_t plaster = builder.addMaterial("plaster");
	const uint32_t block = builder.addMaterial("block");
	const Frame world;
	const double half = 2.78;
	const double height = 5.48;
	const double depth = 5.6;
	const double wall = 0.12;

	// Floor, walls and ceiling are one tube with an open front; the back closes it.
	builder.beginMesh("room", plaster);
	const Contour outside = rectangleOf({-half - wall, -wall}, {half + wall, height + wall});
	const Contour inside = rectangleOf({-half, 0.0}, {half, height});
	addExtrusion(builder, world, {outside, holeOf(inside)}, -depth, 0.0);
	builder.beginMesh("back wall", plaster);
	addBox(builder, world, {-half - wall, -wall, -depth - wall}, {half + wall, height + wall, -depth});
	builder.beginMesh("lamp", plaster);
	addBox(builder, world, {-0.65, height - 0.03, -3.32}, {0.65, height, -2.27});

	builder.beginMesh("tall block", block);
	addBox(builder, turnedFrame({-0.92, 0.0, -3.51}, 0.294), {-0.83, 0.0, -0.83}, {0.83, 3.30, 0.83});
	builder.beginMesh("short block", block);
	addBox(builder, turnedFrame({0.93, 0.0, -1.69}, -0.287), {-0.83, 0.0, -0.83}, {0.83, 1.65, 0.83});

	builder.addCamera("main", {0.0, 2.73, 8.0}, {0.0, 2.73, 0.0}, 39.3);
	builder.addCamera("blocks", {2.3, 3.6, -0.4}, {-0.7, 0.9, -3.2}, 65.0);
	builder.addCamera("corner", {-2.3, 0.9, -0.7}, {0.6, 1.3, -5.0}, 65.0);
	return builder.finish();
}

} // namespace nook
