// SPDX-License-Identifier: GPL-3.0-or-later
// A corner of a park: two trees and bushes of masked cards, grass, a dry stone wall and a bench.
#include "scene/builtin_leaves.h"
#include "scene/builtin_levels.h"
#include "scene/builtin_parts.h"

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
	const Frame world;
	addBox(builder, world, {-18.0, -0.1, -12.4}, {18.0, 4.6, -12.0});
	addBox(builder, world, {-17.99, -0.12, -12.05}, {17.99, 0.5, -11.92});
	addBox(builder, world, {-18.05, 4.6, -12.5}, {18.05, 4.72, -11.85});
	for (int i = 0; i <= 8; ++i)
	{
		const double x = -17.6 + 4.4 * i;
		addBox(builder, world, {x - 0.3, -0.1, -12.2}, {x + 0.3, 4.85, -11.75});
		addBox(builder, world, {x - 0.38, 4.85, -12.45}, {x + 0.38, 4.98, -11.67});
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

} // namespace nook
