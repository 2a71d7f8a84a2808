// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/builtin_suburb_parts.h"

#include "core/math.h"

#include <array>
#include <cmath>

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

void addRing(LevelBuilder& builder, const Frame& frame, glm::dvec2 least, glm::dvec2 most, double width, double from, double to)
{
	addExtrusion(builder, frame, {rectangleOf(least, most), holeOf(rectangleOf(least + width, most - width))}, from, to);
}

} // namespace

void addAirConditioner(LevelBuilder& builder, glm::dvec3 foot)
{
	Frame frame;
	frame.at = foot;
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
	const std::array<double, 4> radii = {0.02, 0.02, 0.02, 0.02};
	addTube(builder, way, radii, 8);
}

void addBin(LevelBuilder& builder, const Frame& frame)
{
	// Side view: wider at the top.
	Frame side = frame;
	side.x = -frame.z;
	side.z = frame.x;
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

void addTiledRoof(LevelBuilder& builder, const Frame& frame, double half_span, double eave, double ridge, double from_x,
				  double to_x)
{
	Frame side = frame;
	side.x = -frame.z;
	side.z = frame.x;
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

void addGutter(LevelBuilder& builder, const Frame& frame, double from_x, double to_x)
{
	Frame side = frame;
	side.x = -frame.z;
	side.z = frame.x;
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

} // namespace nook
