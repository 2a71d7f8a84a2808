// SPDX-License-Identifier: GPL-3.0-or-later
// Test cases with closed forms. Each stands on its own square of floor, 100 m wide, centred 100 m from the next one, so that with a
// radius of up to 90 m only one case is in reach. Visibility (cosine-weighted, infinite reach, near the centre of each square) up
// to terms of (x / 50 m)²:
//
// - case   | centre         | geometry                                           | visibility of the floor
// - ------ | -------------- | -------------------------------------------------- | -----------------------------------------------
// - floor  | (0, 0, 0)      | none                                               | 1
// - wall   | (150, 0, 0)    | a wall at z = 0, 50 m high, its face towards +z    | ½ (1 + z / √(z² + 50²)) at z > 0: ½ at its foot
// - step   | (300, 0, 0)    | floor behind z = 0 is 0.5 m higher                 | ½ (1 + z / √(z² + 0.5²)) at z > 0
// - sphere | (0, 0, −150)   | a sphere of radius 1 m resting on the centre       | 1 − 1 / (1 + x²)^(3/2) at x from the centre
// - disk   | (150, 0, −150) | a level disk of radius 1 m, its underside 1 m high | ½ = 1 − 1² / (1² + 1²) at the centre
// - slope  | (300, 0, −150) | floor that rises by 30° towards −z                 | 1
//
// The wall itself has visibility ½ (1 + y / √(y² + 50²)) at height y.
// The sphere's vertices lie on the sphere, 192 around, so its faces are up to 1.4e-4 m inside; the disk's 1024 corners are on the
// circle.
#include "scene/builtin_levels.h"
#include "scene/builtin_shapes.h"

#include "core/math.h"

#include <array>

namespace nook
{
namespace
{

constexpr double kHalf = 50.0;
constexpr double kThick = 1.0;

void addFloor(LevelBuilder& builder, const Frame& frame)
{
	addBox(builder, frame, {-kHalf, -kThick, -kHalf}, {kHalf, 0.0, kHalf});
}

Frame placed(double x, double z)
{
	Frame frame;
	frame.at = {x, 0.0, z};
	return frame;
}

Frame slopeFrame()
{
	const SinCos rise = sinCosOf(kPi / 6.0);
	Frame frame = placed(300.0, -150.0);
	frame.y = {0.0, rise.cos, rise.sin};
	frame.z = {0.0, -rise.sin, rise.cos};
	return frame;
}

// Looks at the centre of the slope from 3 m away, at that angle to its surface.
void addSlopeCamera(LevelBuilder& builder, const std::string& name, double above_deg, double fov_y_deg)
{
	const Frame frame = slopeFrame();
	const SinCos above = sinCosOf(above_deg * (kPi / 180.0));
	builder.addCamera(name, frame.point({0.0, 3.0 * above.sin, 3.0 * above.cos}), frame.at, fov_y_deg);
}

} // namespace

Level makeNulls()
{
	LevelBuilder builder;
	const uint32_t plain = builder.addMaterial("plain");

	builder.beginMesh("floor", plain);
	addFloor(builder, placed(0.0, 0.0));

	// One solid, so that the foot of the wall is an edge and not a seam.
	builder.beginMesh("wall", plain);
	const Contour corner = {{-kHalf, -kThick}, {kThick, -kThick}, {kThick, kHalf}, {0.0, kHalf}, {0.0, 0.0}, {-kHalf, 0.0}};
	addExtrusion(builder, sideFrame({150.0, 0.0, 0.0}), {corner}, -kHalf, kHalf);

	builder.beginMesh("step", plain);
	const Contour step = {{-kHalf, -kThick}, {kHalf, -kThick}, {kHalf, 0.5}, {0.0, 0.5}, {0.0, 0.0}, {-kHalf, 0.0}};
	addExtrusion(builder, sideFrame({300.0, 0.0, 0.0}), {step}, -kHalf, kHalf);

	builder.beginMesh("floor of the sphere", plain);
	addFloor(builder, placed(0.0, -150.0));
	builder.beginMesh("sphere", plain);
	addSphere(builder, {0.0, 1.0, -150.0}, 1.0, 192);

	builder.beginMesh("floor of the disk", plain);
	addFloor(builder, placed(150.0, -150.0));
	builder.beginMesh("disk", plain);
	const std::array<glm::dvec2, 4> disk = {{{0.0, 1.0}, {1.0, 1.0}, {1.0, 1.02}, {0.0, 1.02}}};
	addLathe(builder, placed(150.0, -150.0), disk, 1024);

	builder.beginMesh("slope", plain);
	addFloor(builder, slopeFrame());

	builder.addCamera("main", {150.0, 130.0, 130.0}, {150.0, 0.0, -75.0});
	builder.addCamera("floor", {0.0, 2.0, 0.0}, {0.0, 0.0, -2.0});
	builder.addCamera("wall", {150.0, 2.0, 5.0}, {150.0, 1.0, 0.0});
	builder.addCamera("step", {301.0, 1.5, 3.0}, {300.0, 0.2, 0.0});
	builder.addCamera("sphere", {2.0, 2.0, -145.5}, {0.0, 0.7, -150.0});
	builder.addCamera("disk", {151.2, 0.75, -147.0}, {150.0, 0.4, -150.0});
	addSlopeCamera(builder, "slope", 35.0, 40.0);
	addSlopeCamera(builder, "grazing", 15.0, 10.0); // 70° to 80° from the normal
	return builder.finish();
}

} // namespace nook
