// SPDX-License-Identifier: GPL-3.0-or-later
// A house in its garden, after the scene of the same name in M. McGuire, "Ambient Occlusion Volumes", 2010: thin fins, a chain-link
// fence that is one masked polygon, and large occluders that the main camera does not see. The front faces +z, the street is at z =
// 10 m.
#include "core/lists.h"
#include "core/math.h"
#include "scene/builtin.h"
#include "scene/builtin_shapes.h"

#include <array>

namespace nook
{
namespace
{

// Moves the frame along its own axes.
Frame moved(Frame frame, glm::dvec3 by)
{
	frame.at = frame.point(by);
	return frame;
}

// For extrusions along the frame's x: x becomes −z, z becomes x.
Frame sideOf(const Frame& frame)
{
	return {frame.at, -frame.z, frame.y, frame.x};
}

void addRing(LevelBuilder& builder, const Frame& frame, glm::dvec2 least, glm::dvec2 most, double width, double from, double to)
{
	addExtrusion(builder, frame, {rectangleOf(least, most), holeOf(rectangleOf(least + width, most - width))}, from, to);
}

// 0.92 m wide, 0.36 m deep, 0.72 m high, front towards +z: 78 fins, 1.5 mm thick, 10 mm apart.
void addAirConditioner(LevelBuilder& builder, glm::dvec3 foot)
{
	const Frame frame = frameAt(foot);
	const double half = 0.46;
	const double top = 0.80;
	addBox(builder, frame, {-0.60, -0.05, -0.35}, {0.60, 0.06, 0.35}); // slab
	for (const double x : {-0.38, 0.30})
	{
		addBox(builder, frame, {x, 0.06, -0.16}, {x + 0.08, 0.09, 0.16});
	}
	// The case is a ring with a back; the fins fill its open front, in front of a coil.
	addRing(builder, frame, {-half, 0.08}, {half, top}, 0.035, -0.18, 0.18);
	addBox(builder, frame, {-half + 0.03, 0.11, -0.175}, {half - 0.03, top - 0.03, -0.15});
	const int fins = 78;
	const double pitch = 0.010;
	const double thickness = 0.0015;
	for (int i = 0; i < fins; ++i)
	{
		const double x = (i - 0.5 * (fins - 1)) * pitch;
		addBox(builder, frame, {x - 0.5 * thickness, 0.135, 0.06}, {x + 0.5 * thickness, top - 0.055, 0.165});
	}
	for (const double x : {-0.425, 0.397})
	{
		addBox(builder, frame, {x, 0.115, 0.05}, {x + 0.028, top - 0.035, 0.172});
	}
	for (const double y : {0.115, top - 0.055})
	{
		addBox(builder, frame, {-0.41, y, 0.052}, {0.41, y + 0.02, 0.17});
	}
	for (int i = 0; i < 9; ++i)
	{
		addCylinder(builder, frame.point({-0.40, 0.19 + 0.065 * i, 0.10}), frame.point({0.40, 0.19 + 0.065 * i, 0.10}), 0.005, 8);
	}
	// A grille of rings on the top, above a dark disk.
	for (int i = 0; i < 6; ++i)
	{
		const double r = 0.03 + 0.022 * i;
		const std::array<glm::dvec2, 4> ring = {
			{{r, top + 0.012}, {r + 0.006, top + 0.012}, {r + 0.006, top + 0.018}, {r, top + 0.018}}};
		addLathe(builder, frame, ring, 24);
	}
	addBox(builder, frame, {-0.15, top - 0.002, -0.005}, {0.15, top + 0.012, 0.005});
	addBox(builder, frame, {-0.005, top - 0.002, -0.15}, {0.005, top + 0.0115, 0.15});
	// Pipes to the house.
	const std::array<glm::dvec3, 4> way = {frame.point({-0.44, 0.30, -0.08}), frame.point({-0.50, 0.30, -0.09}),
										   frame.point({-0.54, 0.33, -0.14}), frame.point({-0.54, 0.36, -0.60})};
	addTube(builder, way, std::vector<double>(way.size(), 0.02), 8);
}

// On two wheels, 1.05 m high, front towards +z.
void addBin(LevelBuilder& builder, const Frame& frame)
{
	// Side view: wider at the top.
	const Frame side = sideOf(frame);
	const Contour body = {{-0.22, 0.05}, {0.20, 0.05}, {0.30, 0.95}, {-0.32, 0.95}};
	addExtrusion(builder, side, {body}, -0.27, 0.27);
	const Contour rim = {{-0.36, 0.92}, {0.34, 0.92}, {0.34, 0.96}, {-0.36, 0.96}};
	addExtrusion(builder, side, {rim}, -0.30, 0.30);
	const Contour lid = {{-0.38, 0.965}, {0.36, 0.965}, {0.36, 1.0}, {0.20, 1.05}, {-0.20, 1.05}, {-0.38, 0.99}};
	addExtrusion(builder, side, {lid}, -0.31, 0.31);
	for (const double x : {-0.31, 0.25})
	{
		addCylinder(builder, frame.point({x, 0.12, -0.20}), frame.point({x + 0.06, 0.12, -0.20}), 0.12, 20);
	}
	addCylinder(builder, frame.point({-0.22, 0.97, -0.42}), frame.point({0.22, 0.97, -0.42}), 0.015, 10);
	for (const double x : {-0.20, 0.17})
	{
		addBox(builder, frame, {x, 0.94, -0.43}, {x + 0.03, 0.965, -0.33});
	}
	for (const double x : {-0.16, 0.12}) // ribs of the front
	{
		addBox(builder, frame, {x, 0.12, 0.16}, {x + 0.04, 0.80, 0.252});
	}
}

// Fills a hole in a wall whose outer face is the frame's x-y plane: frame, bars and panes, set back; a sill; optional shutters.
void addWindow(LevelBuilder& builder, const Frame& frame, glm::dvec2 least, glm::dvec2 most, bool shutters)
{
	const glm::dvec2 middle = 0.5 * (least + most);
	addRing(builder, frame, least, most, 0.07, -0.20, -0.12);
	addBox(builder, frame, {least.x + 0.06, least.y + 0.06, -0.165}, {most.x - 0.06, most.y - 0.06, -0.157});
	addBox(builder, frame, {middle.x - 0.03, least.y + 0.065, -0.19}, {middle.x + 0.03, most.y - 0.065, -0.125});
	for (const int half : {0, 1})
	{
		const double from = half == 0 ? least.x + 0.065 : middle.x + 0.028;
		const double to = half == 0 ? middle.x - 0.028 : most.x - 0.065;
		addBox(builder, frame, {from, middle.y + 0.10, -0.178}, {to, middle.y + 0.13, -0.14});
	}
	addBox(builder, frame, {least.x - 0.08, least.y - 0.07, -0.15}, {most.x + 0.08, least.y, 0.07});
	addBox(builder, frame, {least.x - 0.10, most.y, -0.02}, {most.x + 0.10, most.y + 0.14, 0.035});
	if (!shutters)
	{
		return;
	}
	for (const double x : {least.x - 0.56, most.x + 0.10})
	{
		addRing(builder, moved(frame, {x, 0.0, 0.0}), {0.0, least.y}, {0.46, most.y}, 0.05, 0.012, 0.05);
		const double height = most.y - least.y - 0.12;
		const int slats = static_cast<int>(std::floor(height / 0.055));
		for (int i = 0; i < slats; ++i)
		{
			const double y = least.y + 0.06 + height * (i + 0.5) / slats;
			Frame slat = moved(frame, {x, y, 0.031});
			const SinCos tilt = sinCosOf(0.7);
			const glm::dvec3 up = slat.y * tilt.cos - slat.z * tilt.sin;
			slat.z = slat.z * tilt.cos + slat.y * tilt.sin;
			slat.y = up;
			addBox(builder, slat, {0.048, -0.024, -0.004}, {0.412, 0.024, 0.004});
		}
	}
}

// A door leaf with panels in its frame, set back, and a knob.
void addDoor(LevelBuilder& builder, const Frame& frame, glm::dvec2 least, glm::dvec2 most)
{
	// The frame has no threshold.
	const double w = 0.07;
	const Contour casing = {{least.x, least.y},
							{least.x + w, least.y},
							{least.x + w, most.y - w},
							{most.x - w, most.y - w},
							{most.x - w, least.y},
							{most.x, least.y},
							most,
							{least.x, most.y}};
	addExtrusion(builder, frame, {casing}, -0.22, -0.10);
	std::vector<Contour> leaf = {rectangleOf(least + glm::dvec2(w, 0.012), most - w)};
	const double centre = 0.5 * (least.x + most.x);
	const double half = 0.5 * (most.x - least.x) - w;
	for (const double x : {centre - half + 0.1, centre + 0.05})
	{
		for (const glm::dvec2 y : {glm::dvec2(0.22, 0.85), glm::dvec2(1.0, 1.45), glm::dvec2(1.6, 1.92)})
		{
			leaf.push_back(holeOf(rectangleOf({x, least.y + y.x}, {x + half - 0.15, least.y + y.y})));
		}
	}
	addExtrusion(builder, frame, leaf, -0.19, -0.145);
	addBox(builder, frame, {least.x + w + 0.02, least.y + 0.1, -0.18}, {most.x - w - 0.02, most.y - 0.12, -0.16});
	addSphere(builder, frame.point({most.x - 0.14, least.y + 0.95, -0.11}), 0.032, 14);
	addBox(builder, frame, {least.x - 0.12, least.y + 0.02, -0.02}, {least.x - 0.01, most.y + 0.12, 0.03});
	addBox(builder, frame, {most.x + 0.01, least.y + 0.02, -0.02}, {most.x + 0.12, most.y + 0.12, 0.03});
	addBox(builder, frame, {least.x - 0.02, most.y, -0.02}, {most.x + 0.02, most.y + 0.11, 0.025});
}

// A tiled roof with a ridge along x at z = 0, reaching `half_span` to both sides, from eave height to ridge height.
void addTiledRoof(LevelBuilder& builder, const Frame& frame, double half_span, double eave, double ridge, double from_x,
				  double to_x)
{
	const Frame side = sideOf(frame);
	const double thick = 0.14;
	const double step = 0.03; // overhang of each course
	const int courses = 16;
	Contour contour = {{-half_span, eave}, {0.0, ridge}, {half_span, eave}};
	const auto slope = [&](double side_sign, double share, double lift)
	{
		return glm::dvec2(side_sign * half_span * (1.0 - share), eave + thick + (ridge - eave) * share + lift);
	};
	for (int i = 0; i < courses; ++i)
	{
		contour.push_back(slope(1.0, static_cast<double>(i) / courses, step));
		contour.push_back(slope(1.0, static_cast<double>(i + 1) / courses, 0.0));
	}
	contour.pop_back();
	contour.push_back(slope(1.0, 1.0, 0.01));
	for (int i = courses; i > 0; --i)
	{
		if (i < courses)
		{
			contour.push_back(slope(-1.0, static_cast<double>(i) / courses, 0.0));
		}
		contour.push_back(slope(-1.0, static_cast<double>(i - 1) / courses, step));
	}
	addExtrusion(builder, side, {contour}, from_x, to_x);
	addCylinder(builder, frame.point({from_x - 0.04, ridge + thick, 0.0}), frame.point({to_x + 0.04, ridge + thick, 0.0}), 0.11,
				14);
}

// A half-round gutter below an eave, with brackets, along x.
void addGutter(LevelBuilder& builder, const Frame& frame, double from_x, double to_x)
{
	const Frame side = sideOf(frame);
	Contour gutter = arcOf({0.0, 0.0}, 0.07, kPi, 2.0 * kPi, 10);
	append(gutter, arcOf({0.0, 0.0}, 0.063, 2.0 * kPi, kPi, 10));
	addExtrusion(builder, side, {gutter}, from_x, to_x);
	for (double x = from_x + 0.4; x < to_x; x += 0.9)
	{
		Contour bracket = arcOf({0.0, 0.0}, 0.076, kPi, 2.0 * kPi, 10);
		append(bracket, arcOf({0.0, 0.0}, 0.0705, 2.0 * kPi, kPi, 10));
		addExtrusion(builder, side, {bracket}, x, x + 0.025);
	}
}

constexpr double kHouseFloor = 0.45; // of the house
constexpr double kEave = 3.25;       // top of the walls

void addLand(LevelBuilder& builder)
{
	addBox(builder, kWorld, {-24.0, -0.8, -16.0}, {24.0, 0.0, 8.0}); // lawn
	// Pavement of slabs on a bed, kerb stones, street with a gutter, and again on the other side.
	addBox(builder, kWorld, {-23.99, -0.79, 7.95}, {23.99, -0.03, 10.05});
	for (int i = 0; i < 32; ++i)
	{
		const double x = -24.0 + 1.5 * i;
		addBox(builder, kWorld, {x + 0.006, -0.05, 8.04}, {x + 1.494, 0.012, 8.99});
		addBox(builder, kWorld, {x + 0.006, -0.05, 9.005}, {x + 1.494, 0.012, 9.98});
	}
	for (int i = 0; i < 48; ++i)
	{
		const double x = -24.0 + i;
		addBox(builder, kWorld, {x + 0.004, -0.7, 10.0}, {x + 0.996, 0.02, 10.15});
	}
	addBox(builder, kWorld, {-23.98, -0.78, 10.1}, {23.98, -0.13, 18.1});
	addBox(builder, kWorld, {-24.0, -0.8, 18.0}, {24.0, 0.0, 40.0});
	addCylinder(builder, {-5.0, -0.14, 13.5}, {-5.0, -0.12, 13.5}, 0.33, 24);
}

void addWalls(LevelBuilder& builder)
{
	// Footing, floor and ceiling.
	addBox(builder, kWorld, {-6.06, -0.1, -8.06}, {4.06, kHouseFloor, 0.06});
	addBox(builder, kWorld, {-5.8, kEave - 0.15, -7.8}, {3.8, kEave, -0.2});
	std::vector<Contour> front = {{{-6.0, kHouseFloor},
								   {1.0, kHouseFloor},
								   {1.0, 2.6},
								   {2.05, 2.6},
								   {2.05, kHouseFloor},
								   {4.0, kHouseFloor},
								   {4.0, kEave},
								   {-6.0, kEave}}};
	front.push_back(holeOf(rectangleOf({-4.8, 1.3}, {-3.2, 2.65})));
	front.push_back(holeOf(rectangleOf({-1.7, 1.3}, {-0.1, 2.65})));
	addExtrusion(builder, kWorld, front, -0.3, 0.0);
	const std::vector<Contour> back = {rectangleOf({-6.0, kHouseFloor}, {4.0, kEave}),
									   holeOf(rectangleOf({-3.0, 1.3}, {-1.0, 2.65}))};
	addExtrusion(builder, kWorld, back, -8.0, -7.7);
	// Gables; the contour's x is −z.
	const Contour gable = {
		{0.25, kHouseFloor - 0.02}, {7.75, kHouseFloor - 0.02}, {7.75, kEave - 0.01}, {4.0, 5.55}, {0.25, kEave - 0.01}};
	addExtrusion(builder, sideFrame({}),
				 {gable, holeOf(rectangleOf({2.2, 1.3}, {3.6, 2.65})), holeOf(rectangleOf({3.6, 3.7}, {4.4, 4.5}))}, 3.7, 3.995);
	addExtrusion(builder, sideFrame({}), {gable}, -5.995, -5.7);
	// Boards at the corners, a band below the eave.
	for (const double x : {-6.03, 3.88})
	{
		addBox(builder, kWorld, {x, kHouseFloor - 0.01, -0.10}, {x + 0.15, kEave - 0.02, 0.03});
		addBox(builder, kWorld, {x, kHouseFloor - 0.01, -8.03}, {x + 0.15, kEave - 0.02, -7.90});
	}
	addBox(builder, kWorld, {-5.88, kEave - 0.25, -0.05}, {3.88, kEave - 0.02, 0.025});
}

void addOpenings(LevelBuilder& builder)
{
	addWindow(builder, kWorld, {-4.8, 1.3}, {-3.2, 2.65}, true);
	addWindow(builder, kWorld, {-1.7, 1.3}, {-0.1, 2.65}, true);
	addDoor(builder, kWorld, {1.0, kHouseFloor}, {2.05, 2.6});
	const Frame right = {{4.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}};
	addWindow(builder, right, {2.2, 1.3}, {3.6, 2.65}, false);
	addWindow(builder, right, {3.6, 3.7}, {4.4, 4.5}, false);
	const Frame back = {{0.0, 0.0, -8.0}, {-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, -1.0}};
	addWindow(builder, back, {1.0, 1.3}, {3.0, 2.65}, true);
}

void addRoof(LevelBuilder& builder)
{
	addTiledRoof(builder, frameAt({0.0, 0.0, -4.0}), 4.55, 2.93, 5.62, -6.5, 4.5);
	addGutter(builder, frameAt({0.0, 3.02, 0.64}), -6.5, 4.5);
	// Downpipe: out of the gutter, back to the wall, down.
	const std::array<glm::dvec3, 6> way = {
		{{3.6, 2.97, 0.64}, {3.6, 2.85, 0.62}, {3.6, 2.62, 0.13}, {3.6, 2.50, 0.08}, {3.6, 0.30, 0.08}, {3.6, 0.12, 0.22}}};
	addTube(builder, way, std::vector<double>(way.size(), 0.035), 12);
	for (const double y : {0.8, 1.6, 2.4})
	{
		addBox(builder, kWorld, {3.555, y, -0.02}, {3.645, y + 0.03, 0.125});
	}
	addBox(builder, kWorld, {-3.4, 4.2, -5.6}, {-2.6, 6.7, -4.9});
	addBox(builder, kWorld, {-3.48, 6.7, -5.68}, {-2.52, 6.82, -4.82});
	addUrn(builder, {-3.0, 6.82, -5.25}, 0.5, 16);
}

void addPorch(LevelBuilder& builder)
{
	// Deck boards on a base, three steps, posts, a railing, a small roof.
	addBox(builder, kWorld, {0.1, -0.05, 0.0}, {3.1, 0.38, 1.75});
	for (int i = 0; i < 12; ++i)
	{
		addBox(builder, kWorld, {0.05, 0.385, 0.035 + 0.145 * i}, {3.15, 0.415, 0.172 + 0.145 * i});
	}
	addExtrusion(builder, {{0.0, 0.0, 1.75}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}},
				 {{{0.0, -0.05}, {0.62, -0.05}, {0.62, 0.13}, {0.31, 0.13}, {0.31, 0.26}, {0.0, 0.26}}}, -2.2, -0.9);
	for (const double x : {0.12, 2.96})
	{
		addBox(builder, kWorld, {x, 0.40, 1.58}, {x + 0.12, 2.55, 1.70});
		addBox(builder, kWorld, {x - 0.03, 0.40, 1.55}, {x + 0.15, 0.55, 1.73});
		addBox(builder, kWorld, {x - 0.03, 2.45, 1.55}, {x + 0.15, 2.55, 1.73});
		addBox(builder, kWorld, {x + 0.03, 1.25, 0.0}, {x + 0.09, 1.32, 1.58});
		addBox(builder, kWorld, {x + 0.03, 0.52, 0.0}, {x + 0.09, 0.57, 1.58});
		for (int i = 0; i < 11; ++i)
		{
			addBox(builder, kWorld, {x + 0.045, 0.56, 0.12 + 0.13 * i}, {x + 0.075, 1.26, 0.15 + 0.13 * i});
		}
	}
	addBox(builder, kWorld, {0.0, 2.55, -0.02}, {3.2, 2.68, 1.82});
	addExtrusion(builder, {{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}},
				 {{{-0.02, 2.68}, {2.0, 2.60}, {2.0, 2.68}, {-0.02, 3.0}}}, -3.35, 0.15);
	addBox(builder, kWorld, {1.15, 0.414, 0.15}, {1.9, 0.432, 0.65}); // mat
	addUrn(builder, {2.6, 0.415, 0.45}, 0.55, 20);
}

void addGarden(LevelBuilder& builder, Random& random)
{
	// Path from the pavement to the steps, flower bed along the house, wall on the left, bins, post box.
	for (int i = 0; i < 8; ++i)
	{
		const double shift = 0.12 * (random.uniform() - 0.5);
		const double turn = 0.12 * (random.uniform() - 0.5);
		addBox(builder, turnedFrame({1.55 + shift, 0.0, 2.8 + 0.68 * i}, turn), {-0.52, -0.05, -0.29}, {0.52, 0.025, 0.29});
	}
	addExtrusion(builder, planFrame({-2.95, 0.0, 0.75}),
				 {rectangleOf({-2.85, -0.6}, {2.85, 0.6}), holeOf(rectangleOf({-2.75, -0.5}, {2.75, 0.5}))}, -0.05, 0.16);
	addBox(builder, kWorld, {-5.72, -0.04, 0.23}, {-0.18, 0.1, 1.27});
	addBox(builder, kWorld, {-9.3, -0.1, -15.0}, {-9.0, 1.4, 8.0});
	for (int i = 0; i < 23; ++i)
	{
		addBox(builder, kWorld, {-9.36, 1.4, -15.0 + i + 0.004}, {-8.94, 1.48, -14.0 + i - 0.004});
	}
	addBin(builder, turnedFrame({-7.9, 0.0, 1.2}, 0.25));
	addBin(builder, turnedFrame({-7.1, 0.0, 1.05}, -0.12));
	addBox(builder, kWorld, {0.25, -0.1, 7.35}, {0.35, 1.05, 7.45});
	addExtrusion(builder, frameAt({0.3, 1.05, 7.4}), {archwayOf(0.0, 0.11, 0.0, 0.16, 10)}, -0.24, 0.24);
	addCrate(builder, {5.6, 0.0, -3.6}, 0.6, 0.3);
	addBarrel(builder, {4.5, 0.0, -6.2}, 20);
	for (int i = 0; i < 6; ++i) // firewood along the side wall
	{
		for (int row = 0; row < 3; ++row)
		{
			const double radius = 0.085 + 0.02 * random.uniform();
			const double z = -2.6 - 0.215 * i - 0.1 * (row % 2);
			addCylinder(builder, {4.1, 0.1 + 0.19 * row, z}, {4.62, 0.1 + 0.19 * row, z}, radius, 12);
		}
	}
}

// The netting itself is one polygon; posts, rail and wire are solids.
void addFence(LevelBuilder& builder, uint32_t steel, uint32_t netting)
{
	const double x = 7.2;
	const double back = -12.0;
	const double length = 19.8;
	builder.beginMesh("fence posts", steel);
	for (int i = 0; i <= 7; ++i)
	{
		const double z = back + length * i / 7.0;
		addCylinder(builder, {x + 0.045, -0.1, z}, {x + 0.045, 1.9, z}, 0.03, 12);
		addSphere(builder, {x + 0.045, 1.905, z}, 0.037, 12);
	}
	addCylinder(builder, {x + 0.045, 1.8, back}, {x + 0.045, 1.8, back + length}, 0.02, 10);
	addCylinder(builder, {x + 0.008, 0.08, back}, {x + 0.008, 0.08, back + length}, 0.003, 6);
	builder.beginMesh("fence netting", netting);
	// 70 mm between knots, 3 mm wire.
	addCard(builder, {x, 0.04, back + length}, {0.0, 0.0, -length}, {0.0, 1.75, 0.0}, {length / 0.07, 1.75 / 0.07});
}

// On the face of a wall: a frame, crossed bars, a sill and a head.
void addBlindWindow(LevelBuilder& builder, const Frame& frame, glm::dvec2 least, glm::dvec2 most)
{
	const glm::dvec2 middle = 0.5 * (least + most);
	addExtrusion(builder, frame, {rectangleOf(least, most), holeOf(rectangleOf(least + 0.08, most - 0.08))}, -0.02, 0.07);
	addBox(builder, frame, {middle.x - 0.025, least.y + 0.075, -0.02}, {middle.x + 0.025, most.y - 0.075, 0.04});
	addBox(builder, frame, {least.x + 0.075, middle.y + 0.10, -0.02}, {middle.x - 0.02, middle.y + 0.15, 0.035});
	addBox(builder, frame, {middle.x + 0.02, middle.y + 0.10, -0.02}, {most.x - 0.075, middle.y + 0.15, 0.035});
	addBox(builder, frame, {least.x - 0.08, least.y - 0.08, -0.02}, {most.x + 0.08, least.y - 0.004, 0.14});
	addBox(builder, frame, {least.x - 0.08, most.y + 0.004, -0.02}, {most.x + 0.08, most.y + 0.14, 0.05});
}

void addNeighbours(LevelBuilder& builder)
{
	// A tower block across the street, behind the main camera, with a ledge at each storey; a house on the left.
	addBox(builder, kWorld, {-14.0, -0.1, 22.0}, {12.0, 42.0, 36.0});
	for (int i = 1; i <= 14; ++i)
	{
		addBox(builder, kWorld, {-14.3, 3.0 * i - 0.12, 20.8}, {12.3, 3.0 * i + 0.12, 36.3});
	}
	for (int i = 0; i <= 10; ++i)
	{
		addBox(builder, kWorld, {-14.0 + 2.57 * i, -0.1, 20.9}, {-13.7 + 2.57 * i, 42.0, 22.1});
	}
	addBox(builder, kWorld, {-20.0, -0.1, -9.0}, {-13.0, 3.0, 1.0});
	addBox(builder, kWorld, {-13.1, -0.1, -9.1}, {-12.92, 0.4, 1.1});
	for (const double z : {-7.0, -3.6, -0.2})
	{
		addBlindWindow(builder, {{-13.0, 0.0, z}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}}, {-0.6, 1.0}, {0.6, 2.3});
	}
	addTiledRoof(builder, sideFrame({-16.5, 0.0, -4.0}), 4.2, 2.75, 5.2, -5.4, 5.4);
	addBox(builder, kWorld, {11.0, -0.1, -14.0}, {18.0, 6.0, 4.0});
	addBox(builder, kWorld, {10.7, 6.0, -14.3}, {18.3, 6.3, 4.3});
	addBox(builder, kWorld, {10.93, -0.1, -14.1}, {11.1, 0.5, 4.1});
	for (int i = 0; i < 10; ++i)
	{
		const double z = -12.6 + 3.6 * (i % 5);
		const double y = i < 5 ? 1.0 : 3.7;
		addBlindWindow(builder, {{11.0, y, z}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}}, {-0.7, 0.0}, {0.7, 1.4});
	}
}

} // namespace

Level makeSuburb()
{
	LevelBuilder builder;
	const uint32_t ground = builder.addMaterial("ground");
	const uint32_t render = builder.addMaterial("render");
	const uint32_t tile = builder.addMaterial("tile");
	const uint32_t wood = builder.addMaterial("wood");
	const uint32_t steel = builder.addMaterial("steel");
	const uint32_t netting = builder.addMasked("netting", chainLinkMask(0.003 / 0.07));
	const uint32_t leaves = builder.addMasked("leaves", leafMask());
	const uint32_t grass = builder.addMasked("grass", grassMask());
	Random random(11);
	builder.beginMesh("land", ground);
	addLand(builder);
	builder.beginMesh("walls", render);
	addWalls(builder);
	builder.beginMesh("windows and door", wood);
	addOpenings(builder);
	builder.beginMesh("roof", tile);
	addRoof(builder);
	builder.beginMesh("porch", wood);
	addPorch(builder);
	builder.beginMesh("garden", render);
	addGarden(builder, random);
	builder.beginMesh("air conditioner", steel);
	addAirConditioner(builder, {5.3, 0.0, -0.9});
	addFence(builder, steel, netting);
	builder.beginMesh("neighbours", render);
	addNeighbours(builder);
	builder.beginMesh("bushes", leaves);
	addLeaves(builder, random, {-4.7, 0.5, 0.78}, {0.75, 0.5, 0.5}, 0.34, 130);
	addLeaves(builder, random, {-3.0, 0.42, 0.82}, {0.6, 0.4, 0.45}, 0.3, 110);
	addLeaves(builder, random, {-1.2, 0.5, 0.78}, {0.75, 0.5, 0.5}, 0.34, 130);

	addTree(builder, random, {-4.9, 0.0, 4.6}, {2.3, 0.15, 6, 1.5, 0.4, 180}, wood, leaves);
	builder.beginMesh("grass", grass);
	for (int i = 0; i <= 7; ++i)
	{
		addGrass(builder, random, {7.25, 0.0, -12.0 + 19.8 * i / 7.0}, 0.35, 0.22, 10);
	}
	for (int i = 0; i < 12; ++i)
	{
		addGrass(builder, random, {-8.75, 0.0, -14.0 + 1.9 * i}, 0.4, 0.22, 8);
	}
	addGrass(builder, random, {-4.9, 0.0, 4.6}, 0.5, 0.22, 24);

	builder.addCamera("main", {5.3, 1.65, 8.2}, {0.9, 1.45, -1.6}, 55.0);
	builder.addCamera("unit", {6.3, 1.05, 0.9}, {5.1, 0.42, -0.9}, 45.0);
	builder.addCamera("porch", {3.9, 1.75, 3.4}, {1.0, 1.0, 0.2}, 60.0);
	builder.addCamera("side", {6.5, 1.6, -10.5}, {4.6, 0.9, -1.5}, 60.0);
	builder.addCamera("street", {-13.0, 4.5, 15.5}, {0.5, 1.5, -1.0}, 50.0);
	return builder.finish();
}

} // namespace nook
