// SPDX-License-Identifier: GPL-3.0-or-later
// A walled court, 25 m wide: arcades on both sides, stairs to a small platform, a well, and 57 m away more stairs to a terrace with
// a temple front. s is the distance along the court, z = −s.
#include "scene/builtin.h"
#include "scene/builtin_shapes.h"

#include "core/lists.h"
#include "core/math.h"

#include <algorithm>

namespace nook
{
namespace
{

constexpr double kBay = 4.0; // column spacing
constexpr int kBays = 14;
constexpr double kLength = kBay * kBays;
constexpr double kFloor = 0.45;   // in the aisles
constexpr double kAbacus = 4.05;  // bottom of the arcade walls
constexpr double kTerrace = 1.92; // at the far end

void addBlock(LevelBuilder& builder, glm::dvec2 x, glm::dvec2 y, glm::dvec2 s)
{
	addBox(builder, kWorld, {x.x, y.x, -s.y}, {x.y, y.y, -s.x});
}

// A box on the right (side 1), or mirrored on the left (side −1).
void addSided(LevelBuilder& builder, int side, glm::dvec2 x, glm::dvec2 y, glm::dvec2 s)
{
	addBlock(builder, side > 0 ? x : glm::dvec2(-x.y, -x.x), y, s);
}

// Extrudes a contour of s and y from x.x to x.y.
void addThrough(LevelBuilder& builder, int side, const std::vector<Contour>& contours, glm::dvec2 x)
{
	addExtrusion(builder, sideFrame({}), contours, side > 0 ? x.x : -x.y, side > 0 ? x.y : -x.x);
}

// Extrudes a contour of x and y along the court from s.x to s.y.
void addAlong(LevelBuilder& builder, int side, Contour contour, glm::dvec2 s)
{
	if (side < 0)
	{
		for (glm::dvec2& p : contour)
		{
			p.x = -p.x;
		}
		std::reverse(contour.begin(), contour.end());
	}
	addExtrusion(builder, kWorld, {contour}, -s.y, -s.x);
}

void addGround(LevelBuilder& builder)
{
	addBlock(builder, {-16.0, 16.0}, {-0.6, 0.0}, {-10.0, 88.0});
	// A path of slabs with open joints.
	const double joint = 0.015;
	for (int row = 0; row < 62; ++row)
	{
		for (int column = 0; column < 3; ++column)
		{
			const double x = -1.8 + 1.2 * column;
			const double s = 0.2 + 0.9 * row;
			addBlock(builder, {x + joint, x + 1.2 - joint}, {-0.02, 0.035}, {s + joint, s + 0.9 - joint});
		}
	}
}

void addArcade(LevelBuilder& builder, int side)
{
	addAlong(builder, side,
			 {{6.8, -0.1}, {12.3, -0.1}, {12.3, kFloor}, {7.4, kFloor}, {7.4, 0.3}, {7.1, 0.3}, {7.1, 0.15}, {6.8, 0.15}},
			 {-1.0, kLength + 1.0});
	for (int i = 1; i < kBays; ++i)
	{
		addColumn(builder, {8.0 * side, kFloor, -kBay * i}, 1.0, 24);
	}
	addSided(builder, side, {7.67, 8.33}, {kFloor - 0.05, kAbacus + 0.05}, {-0.38, 0.38});
	addSided(builder, side, {7.67, 8.33}, {kFloor - 0.05, kAbacus + 0.05}, {kLength - 0.38, kLength + 0.38});

	// The wall above the columns: one solid with its arches.
	const double spring = kAbacus + 0.15;
	Contour wall = {{-0.4, kAbacus}};
	for (int i = 0; i < kBays; ++i)
	{
		const double middle = kBay * (i + 0.5);
		wall.emplace_back(middle - 1.6, kAbacus);
		append(wall, arcOf({middle, spring}, 1.6, kPi, 0.0, 16));
		wall.emplace_back(middle + 1.6, kAbacus);
	}
	append(wall, {{kLength + 0.4, kAbacus}, {kLength + 0.4, 6.6}, {-0.4, 6.6}});
	addThrough(builder, side, {wall}, {7.65, 8.35});
	for (int i = 0; i < kBays; ++i)
	{
		const double middle = kBay * (i + 0.5);
		addThrough(builder, side, {archivoltOf({middle, spring}, 1.63, 1.84, 16)}, {7.58, 7.70});
		const Contour key = {{middle - 0.12, spring + 1.57},
							 {middle + 0.12, spring + 1.57},
							 {middle + 0.17, spring + 1.98},
							 {middle - 0.17, spring + 1.98}};
		addThrough(builder, side, {key}, {7.50, 7.72});
	}
	// Cornice, with its profile towards the court.
	addAlong(builder, side,
			 {{7.60, 6.32},
			  {8.40, 6.32},
			  {8.40, 6.75},
			  {7.26, 6.75},
			  {7.26, 6.66},
			  {7.38, 6.62},
			  {7.44, 6.52},
			  {7.53, 6.48},
			  {7.60, 6.40}},
			 {-0.4, kLength + 0.4});
	for (int i = 0; i < kBays; ++i)
	{
		addBalustrade(builder, {7.85 * side, 6.75, -kBay * i}, {7.85 * side, 6.75, -kBay * (i + 1)}, i + 1 == kBays);
	}
}

void addAisle(LevelBuilder& builder, int side)
{
	// The roof and its beams.
	addSided(builder, side, {8.30, 12.1}, {6.28, 6.55}, {-1.0, kLength + 1.0});
	for (int i = 0; i <= kBays; ++i)
	{
		addSided(builder, side, {8.32, 12.05}, {5.95, 6.30}, {kBay * i - 0.17, kBay * i + 0.17});
	}
	for (const double x : {9.2, 10.2, 11.2})
	{
		addSided(builder, side, {x - 0.07, x + 0.07}, {6.13, 6.30}, {-0.5, kLength + 0.5});
	}
	// The outer wall: niches below, windows above.
	std::vector<Contour> wall = {rectangleOf({-2.0, -0.1}, {kLength + 2.0, 9.4})};
	for (int i = 0; i < kBays; ++i)
	{
		const double middle = kBay * (i + 0.5);
		wall.push_back(holeOf(archwayOf(middle, 0.65, 1.5, 3.1, 12)));
		wall.push_back(holeOf(rectangleOf({middle - 0.5, 7.5}, {middle + 0.5, 8.8})));
	}
	addThrough(builder, side, wall, {12.0, 12.6});
	addSided(builder, side, {12.55, 12.9}, {-0.12, 5.5}, {-1.98, kLength + 1.98});
	addAlong(builder, side, {{11.85, 9.3}, {12.75, 9.3}, {12.75, 9.62}, {11.70, 9.62}, {11.70, 9.52}}, {-2.0, 76.4});
	for (int i = 0; i < kBays; ++i)
	{
		const double middle = kBay * (i + 0.5);
		addSided(builder, side, {11.86, 12.05}, {1.38, 1.495}, {middle - 0.78, middle + 0.78});
		addSided(builder, side, {11.9, 12.05}, {7.4, 7.495}, {middle - 0.6, middle + 0.6});
		if (i % 2 == (side > 0 ? 0 : 1))
		{
			addUrn(builder, {12.28 * side, 1.5, -middle}, 1.15, 20);
		}
	}
	for (int i = 0; i <= kBays; ++i)
	{
		const double s = kBay * i;
		addSided(builder, side, {11.82, 12.1}, {kFloor - 0.05, 5.97}, {s - 0.28, s + 0.28});
		addSided(builder, side, {11.76, 12.1}, {kFloor - 0.05, kFloor + 0.25}, {s - 0.34, s + 0.34});
		addSided(builder, side, {11.76, 12.1}, {5.7, 5.96}, {s - 0.34, s + 0.34});
	}
}

void addEntrance(LevelBuilder& builder)
{
	Contour wall = {{-12.6, -0.1}, {-2.0, -0.1}};
	append(wall, arcOf({0.0, 3.2}, 2.0, kPi, 0.0, 20));
	append(wall, {{2.0, -0.1}, {12.6, -0.1}, {12.6, 9.4}, {-12.6, 9.4}});
	addExtrusion(builder, kWorld, {wall}, 1.2, 1.95);
	addExtrusion(builder, kWorld, {archivoltOf({0.0, 3.2}, 2.04, 2.4, 20)}, 1.1, 1.25);
}

// Stairs along the court to a platform with a passage below.
void addPlatform(LevelBuilder& builder)
{
	Contour side = stairsOf({6.0, 0.0}, 15, 0.16, 0.30, 3.8, 0.05);
	// The passage, cut into the lower edge, which is the contour's first.
	const double middle = 12.2;
	Contour passage = {{middle - 1.0, -0.05}};
	append(passage, arcOf({middle, 1.0}, 1.0, kPi, 0.0, 14));
	passage.emplace_back(middle + 1.0, -0.05);
	side.insert(side.begin() + 1, passage.begin(), passage.end());
	addThrough(builder, 1, {side}, {-6.2, -4.0});
	addThrough(builder, 1, {archivoltOf({middle, 1.0}, 1.03, 1.2, 14)}, {-4.04, -3.95});
	// Parapets next to the steps and around the platform.
	const Contour slope = {{5.9, -0.05}, {6.3, -0.05}, {10.45, 2.2}, {14.0, 2.2}, {14.0, 3.25}, {10.3, 3.25}, {5.9, 0.98}};
	addThrough(builder, 1, {slope}, {-4.12, -3.9});
	addThrough(builder, 1, {slope}, {-6.3, -6.08});
	addBlock(builder, {-6.3, -3.9}, {2.2, 3.25}, {13.95, 14.17});
	addBlock(builder, {-4.17, -3.85}, {3.25, 3.33}, {10.3, 14.2});
	addBlock(builder, {-6.35, -6.03}, {3.25, 3.33}, {10.3, 14.2});
	addUrn(builder, {-5.1, 2.4, -13.2}, 0.9, 20);
}

void addWell(LevelBuilder& builder, glm::dvec3 foot)
{
	const Frame frame = frameAt(foot);
	const glm::dvec2 step[] = {{0.0, -0.02}, {1.75, -0.02}, {1.75, 0.16}, {1.55, 0.16}, {1.55, 0.32}, {0.0, 0.32}};
	addLathe(builder, frame, step, 32);
	const glm::dvec2 shaft[] = {{0.72, 0.3}, {1.05, 0.3}, {1.05, 1.05}, {1.13, 1.07}, {1.13, 1.2}, {0.68, 1.2}, {0.68, 1.07}};
	addLathe(builder, frame, shaft, 32);
	for (const double x : {-0.92, 0.92})
	{
		addBox(builder, frame, {x - 0.08, 1.18, -0.09}, {x + 0.08, 2.9, 0.09});
	}
	addCylinder(builder, foot + glm::dvec3(-1.1, 2.55, 0.0), foot + glm::dvec3(1.1, 2.55, 0.0), 0.09, 16);
	addCylinder(builder, foot + glm::dvec3(0.1, 1.75, 0.1), foot + glm::dvec3(0.1, 2.55, 0.1), 0.012, 6);
	const glm::dvec2 bucket[] = {{0.0, 1.45}, {0.12, 1.45}, {0.16, 1.75}, {0.14, 1.75}, {0.105, 1.48}, {0.0, 1.48}};
	addLathe(builder, frameAt(foot + glm::dvec3(0.1, 0.0, 0.1)), bucket, 16);
	const Contour roof = {{-1.0, 2.75}, {0.0, 3.35}, {1.0, 2.75}, {1.0, 2.83}, {0.0, 3.45}, {-1.0, 2.83}};
	addExtrusion(builder, sideFrame(foot), {roof}, -1.35, 1.35);
}

void addPlanter(LevelBuilder& builder, double x, double s)
{
	const Frame plan = planFrame({x, 0.0, -s});
	addExtrusion(builder, plan, {rectangleOf({-0.8, -2.2}, {0.8, 2.2}), holeOf(rectangleOf({-0.62, -2.02}, {0.62, 2.02}))}, -0.05,
				 0.5);
	addBlock(builder, {x - 0.65, x + 0.65}, {-0.04, 0.4}, {s - 2.05, s + 2.05});
	for (int i = 0; i < 5; ++i)
	{
		const double at = s - 1.6 + 0.8 * i;
		const double radius = 0.34 + 0.05 * (i * 7 % 3);
		addCylinder(builder, {x, 0.38, -at}, {x, 0.95, -at}, 0.035, 8);
		addSphere(builder, {x, 0.9 + radius, -at}, radius, 24);
	}
}

void addBench(LevelBuilder& builder, double x, double s)
{
	addBlock(builder, {x - 0.22, x + 0.22}, {0.40, 0.48}, {s - 0.9, s + 0.9});
	addBlock(builder, {x - 0.17, x + 0.17}, {-0.02, 0.41}, {s - 0.7, s - 0.5});
	addBlock(builder, {x - 0.17, x + 0.17}, {-0.02, 0.41}, {s + 0.5, s + 0.7});
}

void addTerrace(LevelBuilder& builder)
{
	// Stairs across the court, between two side walls with balls.
	addThrough(builder, 1, {stairsOf({57.2, 0.0}, 12, 0.16, 0.34, 0.6, 0.1)}, {-5.0, 5.0});
	addBlock(builder, {-13.0, 13.0}, {-0.1, kTerrace}, {61.4, 86.0});
	for (const int side : {-1, 1})
	{
		addSided(builder, side, {5.0, 6.1}, {-0.1, 1.0}, {57.0, 59.2});
		addSided(builder, side, {4.94, 6.16}, {1.0, 1.14}, {56.94, 59.2});
		addSided(builder, side, {5.01, 6.09}, {-0.12, 2.15}, {59.15, 61.8});
		addSided(builder, side, {4.94, 6.16}, {2.15, 2.29}, {59.14, 61.8});
		addSphere(builder, {5.55 * side, 1.14 + 0.42, -58.1}, 0.44, 24);
		addUrn(builder, {5.55 * side, 2.29, -60.5}, 1.3, 24);
		addBalustrade(builder, {6.6 * side, kTerrace, -61.8}, {12.2 * side, kTerrace, -61.8});
		addSided(builder, side, {12.01, 12.61}, {-0.12, 9.39}, {kLength + 1.9, 84.1});
		addAlong(builder, side, {{11.9, 6.2}, {12.1, 6.2}, {12.1, 6.5}, {11.8, 6.5}, {11.8, 6.4}}, {kLength + 1.0, 76.4});
		for (int i = 0; i < 4; ++i)
		{
			const double s = 62.0 + kBay * i;
			addSided(builder, side, {11.82, 12.1}, {kTerrace - 0.05, 6.25}, {s - 0.28, s + 0.28});
			addSided(builder, side, {11.76, 12.1}, {kTerrace - 0.05, kTerrace + 0.25}, {s - 0.34, s + 0.34});
			addSided(builder, side, {11.76, 12.1}, {5.95, 6.21}, {s - 0.34, s + 0.34});
		}
	}
	// Temple front: four columns, entablature, pediment.
	for (const double x : {-6.0, -2.4, 2.4, 6.0})
	{
		addColumn(builder, {x, kTerrace, -72.0}, 1.5, 32);
	}
	const double top = kTerrace + 3.6 * 1.5;
	addBlock(builder, {-7.0, 7.0}, {top, top + 0.55}, {71.4, 76.2});
	addBlock(builder, {-6.9, 6.9}, {top + 0.55, top + 0.95}, {71.5, 76.2});
	addBlock(builder, {-7.4, 7.4}, {top + 0.95, top + 1.15}, {71.0, 76.2});
	const double base = top + 1.15;
	const Contour gable = {{-7.4, base}, {7.4, base}, {0.0, base + 2.3}};
	const Contour field = {{-5.6, base + 0.2}, {5.6, base + 0.2}, {0.0, base + 1.9}};
	addExtrusion(builder, kWorld, {gable, holeOf(field)}, -71.6, -71.0);
	addExtrusion(builder, kWorld, {gable}, -76.15, -71.55);
	// The hall behind: its front wall has a door and niches.
	std::vector<Contour> front = {{{-12.6, kTerrace - 0.1}, {-1.7, kTerrace - 0.1}}};
	append(front[0], arcOf({0.0, 5.0}, 1.7, kPi, 0.0, 20));
	append(front[0], {{1.7, kTerrace - 0.1}, {12.6, kTerrace - 0.1}, {12.6, 11.0}, {-12.6, 11.0}});
	front.push_back(holeOf(archwayOf(-4.2, 0.7, 3.0, 5.0, 12)));
	front.push_back(holeOf(archwayOf(4.2, 0.7, 3.0, 5.0, 12)));
	addExtrusion(builder, kWorld, front, -76.9, -76.0);
	addBlock(builder, {-12.6, 12.6}, {kTerrace - 0.1, 11.0}, {84.0, 84.6});
	addBlock(builder, {-12.6, 12.6}, {8.6, 9.0}, {76.5, 84.3});
	addUrn(builder, {0.0, kTerrace, -81.0}, 1.8, 24);
}

} // namespace

Level makeCourtyard()
{
	LevelBuilder builder;
	const uint32_t stone = builder.addMaterial("stone");
	const uint32_t paving = builder.addMaterial("paving");
	const uint32_t wood = builder.addMaterial("wood");
	builder.beginMesh("ground", paving);
	addGround(builder);
	for (const int side : {-1, 1})
	{
		const std::string name = side < 0 ? "left " : "right ";
		builder.beginMesh(name + "arcade", stone);
		addArcade(builder, side);
		builder.beginMesh(name + "aisle", stone);
		addAisle(builder, side);
	}
	builder.beginMesh("entrance", stone);
	addEntrance(builder);
	builder.beginMesh("platform", stone);
	addPlatform(builder);
	builder.beginMesh("terrace", stone);
	addTerrace(builder);
	builder.beginMesh("well", stone);
	addWell(builder, {2.9, 0.0, -16.0});
	builder.beginMesh("planters", stone);
	for (const double s : {12.0, 24.0, 34.0, 44.0})
	{
		addPlanter(builder, 5.6, s);
		addPlanter(builder, -5.6, s + 8.0);
	}
	builder.beginMesh("benches", stone);
	for (const double s : {18.0, 29.0, 39.0})
	{
		addBench(builder, 6.3, s);
		addBench(builder, -6.3, s - 1.5);
	}
	builder.beginMesh("goods", wood);
	addCrate(builder, {5.6, 0.0, -5.0}, 0.9, 0.2);
	addCrate(builder, {5.5, 0.9, -5.1}, 0.7, -0.15);
	addCrate(builder, {4.6, 0.0, -5.6}, 0.8, 0.9);
	addBarrel(builder, {5.9, 0.0, -6.4}, 24);
	addBarrel(builder, {5.2, 0.0, -6.7}, 24);

	builder.addCamera("main", {2.6, 1.7, 0.6}, {-0.6, 2.1, -20.0}, 62.0);
	builder.addCamera("stairs", {1.2, 1.7, -51.5}, {-1.0, 2.6, -66.0}, 60.0);
	builder.addCamera("colonnade", {10.3, 2.1, -1.6}, {9.6, 2.5, -20.0}, 65.0);
	builder.addCamera("platform", {-0.6, 1.8, -6.5}, {-5.4, 1.3, -11.6}, 60.0);
	builder.addCamera("top", {7.0, 11.5, -0.6}, {-2.6, 0.0, -22.0}, 60.0);
	return builder.finish();
}

} // namespace nook
