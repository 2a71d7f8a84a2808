// SPDX-License-Identifier: GPL-3.0-or-later
// A corner of a park: two trees and bushes of masked cards, grass, a dry stone wall and a bench.
#include "scene/builtin_leaves.h"
#include "scene/builtin_levels.h"
#include "scene/builtin_parts.h"

#include "core/math.h"

#include <array>
#include <cmath>

namespace nook
{
namespace
{

struct Limb
{
	std::vector<glm::dvec3> points;
	std::vector<double> radii;
};

// From `from` in direction `way`, bending upward; ends at a third of its thickness.
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

struct TreeSize
{
	double trunk_height;
	double trunk_radius;
	int branches;
	double reach;
	double card;
	int cards; // a branch
};

// Wood goes to one mesh, leaves to the next.
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
		addBox(builder, frame, {x - 0.03, 0.36, -0.20}, {x + 0.03, 0.42, 0.16});
	}
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
	addBox(builder, Frame{}, {-14.0, -0.5, -14.0}, {14.0, 0.0, 14.0});
	builder.beginMesh("wall", stone);
	addStoneWall(builder, random, {-7.0, 0.0, -5.0}, 14.0);
	builder.beginMesh("bench", bark);
	addBench(builder, turnedFrame({2.6, 0.0, -1.6}, -0.3));

	addTree(builder, random, {0.0, 0.0, -1.8}, {2.6, 0.21, 9, 2.1, 0.55, 210}, bark, leaves);
	addTree(builder, random, {-5.2, 0.0, -8.0}, {2.2, 0.16, 7, 1.7, 0.5, 150}, bark, leaves);
	builder.beginMesh("bushes", leaves);
	addLeaves(builder, random, {-3.4, 0.55, -0.2}, {0.95, 0.6, 0.85}, 0.36, 330);
	addLeaves(builder, random, {-2.2, 0.4, 0.9}, {0.65, 0.45, 0.6}, 0.3, 200);
	addLeaves(builder, random, {4.6, 0.6, -4.0}, {1.2, 0.65, 0.7}, 0.4, 330);
	builder.beginMesh("grass", grass);
	addGrass(builder, random, {0.6, 0.0, 0.2}, 3.4, 0.26, 420);
	addGrass(builder, random, {0.1, 0.0, -1.8}, 0.8, 0.3, 90);

	builder.addCamera("main", {2.2, 1.6, 6.4}, {-0.4, 1.7, -2.0}, 55.0);
	builder.addCamera("grass", {1.9, 0.42, 3.0}, {-0.3, 0.35, -1.6}, 60.0);
	builder.addCamera("crown", {-3.2, 1.5, 3.0}, {0.2, 3.4, -1.8}, 60.0);
	return builder.finish();
}

} // namespace nook
