// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/builtin_parts.h"

#include "core/math.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace nook
{
namespace
{

using Profile = std::vector<glm::dvec2>;

void addScaled(LevelBuilder& builder, glm::dvec3 foot, Profile profile, double scale, int segments)
{
	for (glm::dvec2& p : profile)
	{
		p *= scale;
	}
	addLathe(builder, frameAt(foot), profile, segments);
}

} // namespace

void addColumn(LevelBuilder& builder, glm::dvec3 foot, double scale, int segments)
{
	const double w = 0.46 * scale;
	addBox(builder, frameAt(foot), {-w, -0.02, -w}, {w, 0.18 * scale, w});
	// Attic base: a large torus, a hollow, a small torus.
	Profile profile = {{0.0, 0.17}};
	append(profile, arcOf({0.39, 0.245}, 0.065, -0.5 * kPi, 0.5 * kPi, 5));
	append(profile, {{0.365, 0.325}, {0.345, 0.35}});
	append(profile, arcOf({0.35, 0.405}, 0.03, -0.5 * kPi, 0.5 * kPi, 4));
	// Entasis: the shaft swells by a hundredth below the middle.
	append(profile, {{0.325, 0.45}, {0.315, 0.50}, {0.318, 1.2}, {0.306, 2.0}, {0.284, 2.75}, {0.27, 3.06}});
	append(profile, {{0.295, 3.075}, {0.295, 3.12}, {0.272, 3.135}, {0.272, 3.24}, {0.30, 3.26}});
	append(profile, {{0.345, 3.31}, {0.385, 3.385}, {0.405, 3.46}, {0.40, 3.48}, {0.0, 3.48}});
	addScaled(builder, foot, profile, scale, segments);
	addBox(builder, frameAt(foot), {-w - 0.01, 3.47 * scale, -w - 0.01}, {w + 0.01, 3.6 * scale, w + 0.01});
}

void addBalustrade(LevelBuilder& builder, glm::dvec3 from, glm::dvec3 to, bool last)
{
	const double length = glm::length(to - from);
	Frame frame;
	frame.at = from;
	frame.x = glm::normalize(to - from);
	frame.z = glm::cross(frame.x, frame.y);
	for (int i = 0; i < (last ? 2 : 1); ++i)
	{
		const double x = i * length;
		addBox(builder, frame, {x - 0.2, -0.02, -0.2}, {x + 0.2, 0.95, 0.2});
		addBox(builder, frame, {x - 0.24, 0.95, -0.24}, {x + 0.24, 1.03, 0.24});
	}
	addBox(builder, frame, {0.2, -0.02, -0.14}, {length - 0.2, 0.1, 0.14});
	addBox(builder, frame, {0.2, 0.82, -0.13}, {length - 0.2, 0.95, 0.13});
	const Profile profile = {{0.0, 0.09}, {0.08, 0.09}, {0.08, 0.13}, {0.045, 0.16}, {0.085, 0.30}, {0.07, 0.42},
							 {0.04, 0.6}, {0.04, 0.70}, {0.07, 0.74}, {0.07, 0.83},  {0.0, 0.83}};
	const int count = static_cast<int>(std::floor((length - 0.4) / 0.4));
	for (int i = 0; i < count; ++i)
	{
		const double x = 0.2 + (length - 0.4) * (i + 0.5) / count;
		addLathe(builder, frameAt(frame.point({x, 0.0, 0.0})), profile, 8);
	}
}

Contour stairsOf(glm::dvec2 foot, int steps, double riser, double tread, double landing, double buried)
{
	const double end = foot.x + (steps - 1) * tread + landing;
	Contour contour = {{foot.x, foot.y - buried}, {end, foot.y - buried}, {end, foot.y + steps * riser}};
	for (int i = steps - 1; i >= 0; --i)
	{
		contour.emplace_back(foot.x + i * tread, foot.y + (i + 1) * riser);
		if (i > 0)
		{
			contour.emplace_back(foot.x + i * tread, foot.y + i * riser);
		}
	}
	return contour;
}

Contour archwayOf(double middle, double half_width, double bottom, double spring, int steps)
{
	Contour contour = {{middle - half_width, bottom}, {middle + half_width, bottom}};
	append(contour, arcOf({middle, spring}, half_width, 0.0, kPi, steps));
	return contour;
}

Contour archivoltOf(glm::dvec2 centre, double inner, double outer, int steps)
{
	Contour contour = arcOf(centre, outer, 0.0, kPi, steps);
	append(contour, arcOf(centre, inner, kPi, 0.0, steps));
	return contour;
}

void addUrn(LevelBuilder& builder, glm::dvec3 foot, double height, int segments)
{
	// Outside upward, over the lip, inside downward; one closed line from axis to axis.
	const Profile profile = {{0.0, 0.0},   {0.20, 0.0},  {0.20, 0.04}, {0.11, 0.08}, {0.10, 0.14}, {0.20, 0.24}, {0.32, 0.42},
							 {0.36, 0.58}, {0.33, 0.74}, {0.24, 0.86}, {0.22, 0.92}, {0.29, 0.98}, {0.29, 1.0},  {0.26, 1.0},
							 {0.19, 0.93}, {0.21, 0.85}, {0.29, 0.73}, {0.32, 0.58}, {0.28, 0.43}, {0.0, 0.35}};
	addScaled(builder, foot, profile, height, segments);
}

void addBarrel(LevelBuilder& builder, glm::dvec3 foot, int segments)
{
	const Profile profile = {{0.0, 0.0},   {0.25, 0.0},  {0.26, 0.06},  {0.268, 0.06}, {0.282, 0.12}, {0.272, 0.12},
							 {0.31, 0.33}, {0.32, 0.33}, {0.325, 0.40}, {0.315, 0.40}, {0.315, 0.50}, {0.325, 0.50},
							 {0.32, 0.57}, {0.31, 0.57}, {0.272, 0.78}, {0.282, 0.78}, {0.268, 0.84}, {0.26, 0.84},
							 {0.25, 0.90}, {0.23, 0.90}, {0.23, 0.87},  {0.0, 0.87}};
	addLathe(builder, frameAt(foot), profile, segments);
}

void addCrate(LevelBuilder& builder, glm::dvec3 foot, double width, double angle_rad)
{
	const Frame frame = turnedFrame(foot, angle_rad);
	const double h = 0.5 * width;
	const double board = 0.12 * width;
	const double proud = 0.025;
	addBox(builder, frame, {-h + proud, 0.01, -h + proud}, {h - proud, width - proud, h - proud});
	for (const double x : {-h, h - board})
	{
		for (const double z : {-h, h - board})
		{
			addBox(builder, frame, {x, 0.0, z}, {x + board, width, z + board});
		}
	}
	for (const double y : {0.004, width - board - 0.004})
	{
		const double inset = 0.004;
		for (const double z : {-h + inset, h - inset - proud})
		{
			addBox(builder, frame, {-h + board, y, z}, {h - board, y + board, z + proud});
		}
		for (const double x : {-h + inset, h - inset - proud})
		{
			addBox(builder, frame, {x, y, -h + board}, {x + proud, y + board, h - board});
		}
	}
}

} // namespace nook
