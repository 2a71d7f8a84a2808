// SPDX-License-Identifier: GPL-3.0-or-later
// A corner of a park: two trees and bushes of masked cards, grass, a dry stone wall and a bench.
#include "core/math.h"
#include "core/random.h"
#include "scene/builtin.h"
#include "scene/builtin_shapes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <functional>

namespace nook
{
namespace
{

// Courses of stones of uneven length and depth, without mortar.
void addStoneWall(LevelBuilder& builder, Random& random, glm::dvec3 from, double length)
{
	const double joint = 0.006;
	double bottom = -0.05;
	for (int course = 0; course < 5; ++course)
	{
		const double height = 0.13 + 0.05 * random.uniform();
		double x = 0.0;
		while (x < length)
		{
			const double width = 0.22 + 0.30 * random.uniform();
			const double front = 0.20 + 0.05 * random.uniform();
			const double back = 0.20 + 0.05 * random.uniform();
			const double tilt = 0.05 * (random.uniform() - 0.5);
			const Frame frame = turnedFrame(from + glm::dvec3(x + 0.5 * width, bottom, 0.0), tilt);
			addBox(builder, frame, {-0.5 * width + joint, joint, -back}, {0.5 * width - joint, height, front});
			x += width;
		}
		bottom += height;
	}
	addBox(builder, turnedFrame(from, 0.0), {-0.05, bottom + joint, -0.28}, {length + 0.1, bottom + 0.09, 0.28});
}

// A high wall at the back, with piers, a plinth and a coping.
void addBoundary(LevelBuilder& builder)
{
	addBox(builder, kWorld, {-18.0, -0.1, -12.4}, {18.0, 4.6, -12.0});
	addBox(builder, kWorld, {-17.99, -0.12, -12.05}, {17.99, 0.5, -11.92});
	addBox(builder, kWorld, {-18.05, 4.6, -12.5}, {18.05, 4.72, -11.85});
	for (int i = 0; i <= 8; ++i)
	{
		const double x = -17.6 + 4.4 * i;
		addBox(builder, kWorld, {x - 0.3, -0.1, -12.2}, {x + 0.3, 4.85, -11.75});
		addBox(builder, kWorld, {x - 0.38, 4.85, -12.45}, {x + 0.38, 4.98, -11.67});
		addSphere(builder, {x, 5.2, -12.06}, 0.26, 18);
	}
}

void addBench(LevelBuilder& builder, const Frame& frame)
{
	for (int i = 0; i < 5; ++i)
	{
		addBox(builder, frame, {-0.8, 0.42, -0.22 + 0.095 * i}, {0.8, 0.45, -0.14 + 0.095 * i});
	}
	for (int i = 0; i < 3; ++i)
	{
		addBox(builder, frame, {-0.8, 0.56 + 0.13 * i, -0.275}, {0.8, 0.66 + 0.13 * i, -0.25});
	}
	for (const double x : {-0.65, 0.65})
	{
		addBox(builder, frame, {x - 0.03, -0.02, -0.25}, {x + 0.03, 0.95, -0.20});
		addBox(builder, frame, {x - 0.03, -0.02, 0.16}, {x + 0.03, 0.42, 0.21});
		addBox(builder, frame, {x - 0.028, 0.36, -0.22}, {x + 0.028, 0.418, 0.18});
	}
}

// Coverage of each texel from 4 × 4 points; (0, 0) is the lower left corner of the picture, (1, 1) the upper right one.
Mask drawMask(const std::string& name, int size, const std::function<bool(glm::dvec2)>& inside)
{
	Mask mask;
	mask.name = name;
	mask.width_px = size;
	mask.height_px = size;
	for (int y = 0; y < size; ++y)
	{
		for (int x = 0; x < size; ++x)
		{
			int count = 0;
			for (int k = 0; k < 16; ++k)
			{
				const double px = (x + 0.125 + 0.25 * (k % 4)) / size;
				const double py = 1.0 - (y + 0.125 + 0.25 * (k / 4)) / size;
				count += inside({px, py}) ? 1 : 0;
			}
			mask.alpha.push_back(static_cast<uint8_t>((count * 255 + 8) / 16));
		}
	}
	return mask;
}

// A pointed blade from `foot` to `tip`: widest at a third of its length.
struct Blade
{
	glm::dvec2 foot;
	glm::dvec2 tip;
	double half_width;
};

bool isInside(const Blade& blade, glm::dvec2 p)
{
	const glm::dvec2 along = blade.tip - blade.foot;
	const double length2 = glm::dot(along, along);
	const double t = glm::dot(p - blade.foot, along) / length2;
	if (t <= 0.0 || t >= 1.0)
	{
		return false;
	}
	const double across = (along.x * (p.y - blade.foot.y) - along.y * (p.x - blade.foot.x)) / std::sqrt(length2);
	const double root = std::sqrt(t);
	// √t (1 − t) has its maximum 0.385 at t = 1/3.
	return std::fabs(across) <= blade.half_width * root * (1.0 - t) * (1.0 / 0.385);
}

Mask maskOf(const std::string& name, int size, const std::vector<Blade>& blades)
{
	Mask mask =
		drawMask(name, size,
				 [&](glm::dvec2 p)
				 { return std::any_of(blades.begin(), blades.end(), [p](const Blade& blade) { return isInside(blade, p); }); });
	mask.wrap_u = mask.wrap_v = Wrap::clamp;
	return mask;
}

glm::dvec2 directionOf(double angle_rad)
{
	const SinCos at = sinCosOf(angle_rad);
	return {at.cos, at.sin};
}

// Leaves on both sides of a twig and one at its end.
void addTwig(std::vector<Blade>& blades, glm::dvec2 foot, double angle_rad, double length, int pairs)
{
	const glm::dvec2 along = directionOf(angle_rad);
	blades.push_back({foot - 0.02 * along, foot + 1.1 * length * along, 0.008});
	const double leaf = 0.30 * length + 0.07;
	for (int i = 0; i < pairs; ++i)
	{
		const glm::dvec2 at = foot + (0.18 + 0.72 * i / pairs) * length * along;
		const double size = leaf * (1.0 - 0.25 * i / pairs);
		for (const double side : {-1.0, 1.0})
		{
			const glm::dvec2 out = directionOf(angle_rad + side * (1.05 - 0.25 * i / pairs));
			blades.push_back({at, at + size * out, 0.26 * size});
		}
	}
	blades.push_back({foot + 0.8 * length * along, foot + (0.8 * length + leaf) * along, 0.26 * leaf});
}

struct Limb
{
	std::vector<glm::dvec3> points;
	std::vector<double> radii;
};

// Starts at `from` in direction `way` and bends upward; tapers to a third of its thickness.
Limb limbOf(glm::dvec3 from, glm::dvec3 way, double length, double radius, Random& random)
{
	Limb limb;
	glm::dvec3 at = from;
	glm::dvec3 along = glm::normalize(way);
	const int steps = 5;
	for (int i = 0; i <= steps; ++i)
	{
		limb.points.push_back(at);
		limb.radii.push_back(radius * (1.0 - 0.67 * i / steps));
		const double x = random.uniform() - 0.5;
		const double y = random.uniform() - 0.2;
		const double z = random.uniform() - 0.5;
		along = glm::normalize(along + 0.35 * glm::dvec3(x, y, z));
		at += along * (length / steps);
	}
	return limb;
}

} // namespace

Level makeFoliage()
{
	LevelBuilder builder;
	const uint32_t ground = builder.addMaterial("ground");
	const uint32_t stone = builder.addMaterial("stone");
	const uint32_t bark = builder.addMaterial("bark");
	const uint32_t leaves = builder.addMasked("leaves", leafMask());
	const uint32_t grass = builder.addMasked("grass", grassMask());
	Random random(7);

	builder.beginMesh("ground", ground);
	addBox(builder, Frame{}, {-18.0, -0.5, -18.0}, {18.0, 0.0, 14.0});
	builder.beginMesh("boundary", stone);
	addBoundary(builder);
	builder.beginMesh("wall", stone);
	addStoneWall(builder, random, {-7.0, 0.0, -5.0}, 14.0);
	builder.beginMesh("bench", bark);
	addBench(builder, turnedFrame({2.6, 0.0, -1.6}, -0.3));

	addTree(builder, random, {0.0, 0.0, -1.8}, {2.6, 0.21, 9, 2.1, 0.44, 300}, bark, leaves);
	addTree(builder, random, {-5.2, 0.0, -8.0}, {2.2, 0.16, 7, 1.7, 0.42, 195}, bark, leaves);
	builder.beginMesh("bushes", leaves);
	addLeaves(builder, random, {-3.4, 0.55, -0.2}, {0.95, 0.6, 0.85}, 0.36, 330);
	addLeaves(builder, random, {-2.2, 0.4, 0.9}, {0.65, 0.45, 0.6}, 0.3, 200);
	addLeaves(builder, random, {4.6, 0.6, -4.0}, {1.2, 0.65, 0.7}, 0.4, 330);
	builder.beginMesh("grass", grass);
	addGrass(builder, random, {0.6, 0.0, 0.2}, 3.4, 0.26, 420);
	addGrass(builder, random, {0.1, 0.0, -1.8}, 0.8, 0.3, 90);

	builder.addCamera("main", {2.4, 1.65, 5.2}, {-0.5, 1.35, -2.0}, 55.0);
	builder.addCamera("grass", {1.9, 0.45, 3.0}, {-0.3, 0.25, -1.6}, 60.0);
	builder.addCamera("crown", {1.5, 1.2, 1.3}, {-0.1, 3.0, -1.9}, 55.0);
	return builder.finish();
}

Mask leafMask()
{
	std::vector<Blade> blades;
	const glm::dvec2 foot = {0.5, 0.02};
	addTwig(blades, foot, 0.5 * kPi, 0.70, 5);
	addTwig(blades, foot + glm::dvec2(0.0, 0.16), 0.5 * kPi + 0.75, 0.38, 3);
	addTwig(blades, foot + glm::dvec2(0.0, 0.24), 0.5 * kPi - 0.80, 0.38, 3);
	return maskOf("leaves", 192, blades);
}

Mask grassMask()
{
	std::vector<Blade> blades;
	for (unsigned i = 0; i < 18; ++i)
	{
		const double x = 0.08 + 0.84 * radicalInverse(i + 1, 2);
		const double height = 0.45 + 0.5 * radicalInverse(i + 1, 3);
		const double lean = 0.5 * (radicalInverse(i + 1, 5) - 0.5);
		blades.push_back({{x, -0.25}, {0.04 + 0.92 * std::clamp(x + lean * 0.6, 0.0, 1.0), height}, 0.022});
	}
	return maskOf("grass", 128, blades);
}

Mask chainLinkMask(double width)
{
	// The distance across a diagonal wire is 1/√2 of the distance along an axis.
	const double half = 0.5 * width * std::sqrt(2.0);
	const auto isWire = [half](glm::dvec2 p)
	{
		const double up = fraction(p.x - p.y + 0.5);
		const double down = fraction(p.x + p.y + 0.5);
		return std::fabs(up - 0.5) <= half || std::fabs(down - 0.5) <= half;
	};
	return drawMask("chain link", 96, isWire);
}

void addLeaves(LevelBuilder& builder, Random& random, glm::dvec3 centre, glm::dvec3 radii, double size, int count)
{
	for (int i = 0; i < count; ++i)
	{
		// A direction and a distance; √ puts more of them near the outside.
		const double height = 2.0 * random.uniform() - 1.0;
		const SinCos turn = sinCosOf(2.0 * kPi * random.uniform());
		const double flat = std::sqrt(1.0 - height * height);
		const glm::dvec3 out = {flat * turn.cos, height, flat * turn.sin};
		const double reach = std::sqrt(0.15 + 0.85 * random.uniform());
		const glm::dvec3 at = centre + radii * out * reach;
		// The card hangs outward and down, rotated at random.
		const SinCos roll = sinCosOf(2.0 * kPi * random.uniform());
		const double droop = 0.3 + 0.5 * random.uniform();
		const glm::dvec3 normal = glm::normalize(out + glm::dvec3(0.0, droop, 0.0));
		const Frame frame = frameAlong(at, normal);
		const double scale = size * (0.75 + 0.5 * random.uniform());
		const glm::dvec3 right = scale * (frame.x * roll.cos + frame.z * roll.sin);
		const glm::dvec3 up = glm::cross(normal, right);
		addCard(builder, at - 0.5 * right - 0.3 * up, right, up);
	}
}

void addGrass(LevelBuilder& builder, Random& random, glm::dvec3 centre, double radius, double size, int count)
{
	for (int i = 0; i < count; ++i)
	{
		const double reach = radius * std::sqrt(random.uniform());
		const SinCos around = sinCosOf(2.0 * kPi * random.uniform());
		const SinCos turn = sinCosOf(2.0 * kPi * random.uniform());
		const double scale = size * (0.7 + 0.6 * random.uniform());
		const double lean = 0.25 * (random.uniform() - 0.5);
		const glm::dvec3 right = {scale * turn.cos, 0.0, scale * turn.sin};
		const glm::dvec3 up = {-lean * scale * turn.sin, scale * 0.8, lean * scale * turn.cos};
		const glm::dvec3 foot = centre + glm::dvec3(reach * around.cos, -0.01, reach * around.sin);
		addCard(builder, foot - 0.5 * right, right, up);
	}
}

void addTree(LevelBuilder& builder, Random& random, glm::dvec3 foot, const TreeSize& size, uint32_t bark, uint32_t leaves)
{
	const auto rise = [&](double x, double share, double z)
	{
		return foot + glm::dvec3(x, share * size.trunk_height, z);
	};
	const std::array<glm::dvec3, 6> trunk = {rise(0.0, -0.05, 0.0),  rise(0.0, 0.03, 0.0),   rise(0.03, 0.12, 0.02),
											 rise(0.10, 0.45, 0.05), rise(0.05, 0.8, -0.04), rise(0.12, 1.15, -0.02)};
	const double r = size.trunk_radius;
	const std::array<double, 6> radii = {1.9 * r, 1.6 * r, 1.1 * r, 0.95 * r, 0.8 * r, 0.4 * r};
	builder.beginMesh("trunk", bark);
	addTube(builder, trunk, radii, 16);
	std::vector<glm::dvec3> tips;
	for (int i = 0; i < size.branches; ++i)
	{
		const double share = 0.62 + 0.5 * i / size.branches;
		const SinCos around = sinCosOf(2.39996 * i + 0.4 * random.uniform());
		const double lift = 0.35 + 0.9 * i / size.branches;
		const double length = size.reach * (1.0 - 0.25 * i / size.branches);
		const glm::dvec3 way = {around.cos, lift, around.sin};
		const Limb branch = limbOf(rise(0.07, share, 0.0), way, length, 0.42 * r, random);
		addTube(builder, branch.points, branch.radii, 8);
		tips.push_back(branch.points.back());
		for (const int from : {2, 3})
		{
			const double x = random.uniform() - 0.5;
			const double z = random.uniform() - 0.5;
			const glm::dvec3 side = glm::dvec3(around.cos + 1.6 * x, 0.5, around.sin + 1.6 * z);
			const Limb twig = limbOf(branch.points[static_cast<std::size_t>(from)], side, 0.55 * length, 0.16 * r, random);
			addTube(builder, twig.points, twig.radii, 6);
			tips.push_back(twig.points.back());
		}
	}
	builder.beginMesh("leaves", leaves);
	for (const glm::dvec3 tip : tips)
	{
		addLeaves(builder, random, tip, glm::dvec3(0.32, 0.24, 0.32) * size.reach, size.card, size.cards / 3);
	}
}

} // namespace nook
