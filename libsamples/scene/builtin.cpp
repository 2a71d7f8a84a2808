// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/builtin.h"

#include "core/decimal.h"
#include "core/lists.h"
#include "core/math.h"
#include "core/words.h"
#include "scene/builtin_shapes.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace nook
{
namespace
{

// A level, whose number of triangles may be selectable: "heightfield:N".
struct Builtin
{
	std::string_view name;
	Level (*make)() = nullptr;
	Level (*make_sized)(std::size_t triangles) = nullptr;
	std::size_t triangles = 0; // default
	std::size_t least = 0;
	std::size_t most = 0;
};

constexpr std::array<Builtin, 7> kBuiltins{{{"cornell", makeCornell},
											{"courtyard", makeCourtyard},
											{"suburb", makeSuburb},
											{"foliage", makeFoliage},
											{"heightfield", nullptr, makeHeightfield, 131072, 2, 20'000'000},
											{"cave", nullptr, makeCave, 600'000, 1000, 20'000'000},
											{"nulls", makeNulls}}};

std::size_t triangleCount(std::string_view text, const Builtin& level)
{
	const std::optional<std::size_t> count = numberFrom<std::size_t>(text);
	refuseInputIf(!count || *count < level.least || *count > level.most, "builtin:" + std::string(level.name),
				  "'" + std::string(text) + "'", std::to_string(level.least) + " to " + std::to_string(level.most) + " triangles",
				  ExitCode::usage);
	return *count;
}

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

constexpr double kHalf = 50.0;
constexpr double kThick = 1.0;

void addFloor(LevelBuilder& builder, const Frame& frame)
{
	addBox(builder, frame, {-kHalf, -kThick, -kHalf}, {kHalf, 0.0, kHalf});
}

Frame slopeFrame()
{
	const SinCos rise = sinCosOf(kPi / 6.0);
	Frame frame = frameAt({300.0, 0.0, -150.0});
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

std::vector<std::string_view> builtinNames()
{
	return mapped(kBuiltins, [](const Builtin& one) { return one.name; });
}

Level builtinLevel(std::string_view name)
{
	const std::string_view base = name.substr(0, name.find(':'));
	const auto* const found = firstWhere(kBuiltins, [&](const Builtin& one) { return one.name == base; });
	const bool has_count = base != name;
	refuseInputIf(found == nullptr || (has_count && found->make_sized == nullptr), "builtin", "'" + std::string(name) + "'",
				  "one of " + joinedText(builtinNames(), ", ") + ", heightfield:N or cave:N", ExitCode::usage);
	const std::size_t triangles = has_count ? triangleCount(name.substr(base.size() + 1), *found) : found->triangles;
	Level level = found->make != nullptr ? found->make() : found->make_sized(triangles);
	level.name = std::string(kBuiltinPrefix) + std::string(name);
	return level;
}

// The box of C. Goral et al., "Modeling the Interaction of Light Between Diffuse Surfaces", 1984, in the proportions that Cornell
// University's Program of Computer Graphics measured later, a hundred times smaller: 5.56 m wide, 5.48 m high, 5.6 m deep.

Level makeCornell()
{
	LevelBuilder builder;
	const uint32_t plaster = builder.addMaterial("plaster");
	const uint32_t block = builder.addMaterial("block");
	const double half = 2.78;
	const double height = 5.48;
	const double depth = 5.6;
	const double wall = 0.12;

	// Floor, walls and ceiling are one tube with an open front; the back closes it.
	builder.beginMesh("room", plaster);
	const Contour outside = rectangleOf({-half - wall, -wall}, {half + wall, height + wall});
	const Contour inside = rectangleOf({-half, 0.0}, {half, height});
	addExtrusion(builder, kWorld, {outside, holeOf(inside)}, -depth, 0.0);
	builder.beginMesh("back wall", plaster);
	addBox(builder, kWorld, {-half - wall, -wall, -depth - wall}, {half + wall, height + wall, -depth});
	builder.beginMesh("lamp", plaster);
	addBox(builder, kWorld, {-0.65, height - 0.03, -3.32}, {0.65, height, -2.27});

	builder.beginMesh("tall block", block);
	addBox(builder, turnedFrame({-0.92, 0.0, -3.51}, 0.294), {-0.83, 0.0, -0.83}, {0.83, 3.30, 0.83});
	builder.beginMesh("short block", block);
	addBox(builder, turnedFrame({0.93, 0.0, -1.69}, -0.287), {-0.83, 0.0, -0.83}, {0.83, 1.65, 0.83});

	builder.addCamera("main", {0.0, 2.73, 8.0}, {0.0, 2.73, 0.0}, 39.3);
	builder.addCamera("blocks", {2.3, 3.6, -0.4}, {-0.7, 0.9, -3.2}, 65.0);
	builder.addCamera("corner", {-2.3, 0.9, -0.7}, {0.6, 1.3, -5.0}, 65.0);
	return builder.finish();
}

Level makeNulls()
{
	LevelBuilder builder;
	const uint32_t plain = builder.addMaterial("plain");

	builder.beginMesh("floor", plain);
	addFloor(builder, kWorld);

	// One solid, so that the foot of the wall is an edge and not a seam.
	builder.beginMesh("wall", plain);
	const Contour corner = {{-kHalf, -kThick}, {kThick, -kThick}, {kThick, kHalf}, {0.0, kHalf}, {0.0, 0.0}, {-kHalf, 0.0}};
	addExtrusion(builder, sideFrame({150.0, 0.0, 0.0}), {corner}, -kHalf, kHalf);

	builder.beginMesh("step", plain);
	const Contour step = {{-kHalf, -kThick}, {kHalf, -kThick}, {kHalf, 0.5}, {0.0, 0.5}, {0.0, 0.0}, {-kHalf, 0.0}};
	addExtrusion(builder, sideFrame({300.0, 0.0, 0.0}), {step}, -kHalf, kHalf);

	builder.beginMesh("floor of the sphere", plain);
	addFloor(builder, frameAt({0.0, 0.0, -150.0}));
	builder.beginMesh("sphere", plain);
	addSphere(builder, {0.0, 1.0, -150.0}, 1.0, 192);

	builder.beginMesh("floor of the disk", plain);
	addFloor(builder, frameAt({150.0, 0.0, -150.0}));
	builder.beginMesh("disk", plain);
	const std::array<glm::dvec2, 4> disk = {{{0.0, 1.0}, {1.0, 1.0}, {1.0, 1.02}, {0.0, 1.02}}};
	addLathe(builder, frameAt({150.0, 0.0, -150.0}), disk, 1024);

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
