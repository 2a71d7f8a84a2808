// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/builtin.h"

#include "core/error.h"
#include "core/math.h"
#include "scene/builtin_shapes.h"

#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <utility>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 7> kNames = {"cornell", "courtyard", "suburb", "foliage", "heightfield", "cave", "nulls"};

[[noreturn]] void refuseName(std::string_view name)
{
	std::string listed;
	for (const std::string_view known : kNames)
	{
		listed += std::string(listed.empty() ? "" : ", ") + std::string(known);
	}
	throw Error(ExitCode::usage,
				"builtin: found '" + std::string(name) + "', expected one of " + listed + ", heightfield:N or cave:N");
}

// A level with a selectable number of triangles: "heightfield:N".
struct SizedLevel
{
	std::string_view name;
	Level (*make)(std::size_t triangles);
	std::size_t triangles; // default
	std::size_t least;
	std::size_t most;
};

constexpr std::array<SizedLevel, 2> kSized = {
	{{"heightfield", makeHeightfield, kDefaultHeightfieldTriangles, 2, kMaxHeightfieldTriangles},
	 {"cave", makeCave, kDefaultCaveTriangles, kMinCaveTriangles, kMaxCaveTriangles}}};

std::size_t triangleCount(std::string_view text, const SizedLevel& level)
{
	std::size_t count = 0;
	const std::from_chars_result result = std::from_chars(text.data(), text.data() + text.size(), count);
	if (result.ec != std::errc{} || result.ptr != text.data() + text.size() || count < level.least || count > level.most)
	{
		throw Error(ExitCode::usage, "builtin:" + std::string(level.name) + ": found '" + std::string(text) + "', expected " +
										 std::to_string(level.least) + " to " + std::to_string(level.most) + " triangles");
	}
	return count;
}

std::optional<Level> sizedLevel(std::string_view name)
{
	for (const SizedLevel& level : kSized)
	{
		if (name == level.name)
		{
			return level.make(level.triangles);
		}
		if (name.starts_with(level.name) && name.substr(level.name.size()).starts_with(":"))
		{
			return level.make(triangleCount(name.substr(level.name.size() + 1), level));
		}
	}
	return std::nullopt;
}

} // namespace

std::span<const std::string_view> builtinNames()
{
	return kNames;
}

Level builtinLevel(std::string_view name)
{
	Level level;
	if (name == "cornell")
	{
		level = makeCornell();
	}
	else if (name == "courtyard")
	{
		level = makeCourtyard();
	}
	else if (name == "suburb")
	{
		level = makeSuburb();
	}
	else if (name == "foliage")
	{
		level = makeFoliage();
	}
	else if (name == "nulls")
	{
		level = makeNulls();
	}
	else if (std::optional<Level> sized = sizedLevel(name))
	{
		level = std::move(*sized);
	}
	else
	{
		refuseName(name);
	}
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
