// SPDX-License-Identifier: GPL-3.0-or-later
// Dropping changes nothing visible, or no more than stated.
#include "small_levels.h"
#include "small_volumes.h"
#include "testing.h"

#include "core/lists.h"
#include "volume/build.h"
#include "volume/evaluate.h"
#include "volume/receivers.h"
#include "volume/region.h"

#include <glm/vector_relational.hpp>

namespace
{

Dropped drop(const Level& level, double distance_m, const DropSettings& settings, bool two_sided = false)
{
	const Tracer tracer(level, {});
	return dropVolumes(trianglesOf(level, two_sided), tracer, distance_m, true, settings, {2, {}});
}

uint64_t dropped(const DropCounts& counts)
{
	return counts.inside + counts.convex + counts.alone + counts.enclosed + counts.unseen + counts.below;
}

double greatestChange(const Level& level, const Occluders& kept, double distance_m, bool two_sided = false)
{
	const Tracer tracer(level, {});
	const ReceiverSettings settings{2, 300, 1500, 500, 1};
	const std::vector<ReferencePoint> receivers = sampleReceivers(tracer, distance_m, settings, {2, {}});
	REQUIRE(receivers.size() > 1000);
	const VerifyResult result =
		verifyVolumes(setOf(trianglesOf(level, two_sided), distance_m), setOf(kept, distance_m), receivers, {2, {}});
	CHECK(result.mean <= result.greatest);
	return result.greatest;
}

} // namespace

TEST_CASE("drop: a convex body alone needs no volume", "[volume_drop]")
{
	Level box = emptyLevel();
	addBox(box, {-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
	const Dropped of_box = drop(box, 1.0, {});
	CHECK(of_box.counts.kept == 0);
	CHECK(dropped(of_box.counts) == 12);
	CHECK_FALSE(of_box.counts.inside_refused);

	Level sphere = emptyLevel();
	addSphere(sphere, {0.0, 0.0, 0.0}, 1.0, 12, 24);
	const Dropped of_sphere = drop(sphere, 0.7, {});
	CHECK(of_sphere.counts.kept == 0);
	CHECK(dropped(of_sphere.counts) == sphere.triangles.size());
}

TEST_CASE("drop: the inside of a dense mesh is inside unless it has a window", "[volume_drop]")
{
	Level ball = emptyLevel();
	addSphere(ball, {0.0, 0.0, 0.0}, 1.0, 200, 400);
	ball.cameras.emplace_back().world_from_camera[3] = {5.0, 0.0, 0.0, 1.0};
	SideSettings both;
	both.backs = true;
	CHECK(receiverSides(Tracer(ball, {2, {}}), both, {2, {}}).inside_sides == ball.triangles.size());
	std::erase_if(ball.triangles, [&](const glm::uvec3& t) { return ball.positions[t.x].y > 0.95; });
	ball.materials.resize(ball.triangles.size());
	CHECK(5 * receiverSides(Tracer(ball, {2, {}}), both, {2, {}}).inside_sides < 3 * ball.triangles.size());
}

TEST_CASE("drop: a box over a floor loses its top, and nothing else changes", "[volume_drop]")
{
	const Level level = floorAndBox();
	const Dropped result = drop(level, 1.0, {});
	// The top's two triangles have nothing in front of them; the floor keeps both of its own because of the box.
	CHECK(result.counts.polygons == 14);
	CHECK(result.counts.kept == 12);
	CHECK(result.counts.alone == 2);
	CHECK(greatestChange(level, result.occluders, 1.0) <= 1e-6);

	// At 0.05 m the floor is out of reach: corners of 45° extend by 0.13 m.
	CHECK(drop(level, 0.05, {}).counts.kept == 0);
	DropSettings none;
	none.no_receiver = false;
	CHECK(drop(level, 0.05, none).counts.kept == 14);
}

TEST_CASE("drop: two-sided polygons keep the side that has receivers, turned where needed", "[volume_drop]")
{
	// A ceiling that faces up although its receivers are below.
	Level level = emptyLevel();
	addQuad(level, {-2.0, 0.0, 2.0}, {4.0, 0.0, 0.0}, {0.0, 0.0, -4.0});
	addQuad(level, {-1.0, 0.5, 1.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, -2.0});
	level.material_list[0].two_sided = true;
	const Dropped result = drop(level, 1.0, {}, true);
	REQUIRE(result.counts.kept == 4);
	CHECK(result.counts.turned == 4);
	for (const Occluder& occluder : result.occluders.polygons)
	{
		CHECK_FALSE(occluder.two_sided);
		const auto* corners = &result.occluders.corners[occluder.first_corner];
		const double up = frontOf({corners, occluder.corner_count}).y;
		CHECK(up * (corners[0].y > 0.25 ? -1.0 : 1.0) > 0.99);
	}
	CHECK(greatestChange(level, result.occluders, 1.0, true) <= 1e-6);
	DropSettings keep;
	keep.sides = false;
	CHECK(drop(level, 1.0, keep, true).counts.turned == 0);
}

TEST_CASE("drop: what is inside a solid goes, unless the level is inside out", "[volume_drop]")
{
	Level level = floorAndBox();
	addBox(level, {-0.3, 0.4, -0.3}, {0.3, 1.0, 0.3}); // inside the other
	const Dropped result = drop(level, 1.0, {});
	CHECK(result.counts.inside == 12);
	CHECK(result.counts.kept == 12);
	// Nothing is seen inside the floating box: receivers there may lose everything, others nothing (sampleReceivers skips insides).
	DropSettings keep;
	keep.inside = false;
	CHECK(drop(level, 1.0, keep).counts.inside == 0);
	CHECK(drop(level, 1.0, keep).counts.kept > 12);

	// A room with a pillar, both with their backs to the inside.
	Level room = emptyLevel();
	addBox(room, {-3.0, 0.0, -3.0}, {3.0, 3.0, 3.0});
	addBox(room, {-0.5, 1.2, -0.5}, {0.5, 1.8, 0.5});
	Level inward = emptyLevel();
	inward.positions = room.positions;
	inward.normals = room.normals;
	inward.uvs = room.uvs;
	for (std::size_t i = 0; i < room.triangles.size(); ++i)
	{
		const glm::uvec3 corner = room.triangles[i];
		const bool pillar = i >= 12;
		addTriangle(inward, corner.x, pillar ? corner.z : corner.y, pillar ? corner.y : corner.z);
	}
	const Dropped refused = drop(inward, 1.0, {}, true);
	CHECK(refused.counts.inside_refused);
	CHECK(refused.counts.inside == 0);
	CHECK(refused.counts.inside_m2 > 0.5 * refused.counts.area_m2);
	CHECK(refused.counts.kept == 24);
}

TEST_CASE("drop: no receiver loses more than is proven", "[volume_drop]")
{
	const Level level = builtinLevel("suburb");
	const double below = GENERATE(1.0 / 512.0, 0.02);
	DropSettings settings;
	settings.no_receiver = false;
	settings.sides = false;
	settings.inside = false;
	settings.below = below;
	const Dropped result = drop(level, 0.5, settings);
	CHECK(result.counts.below > 0);
	CHECK(result.counts.greatest_loss > 0.0);
	CHECK(result.counts.greatest_loss <= below);
	CHECK(greatestChange(level, result.occluders, 0.5) <= result.counts.greatest_loss + 1e-6);
}

TEST_CASE("drop: the bound of a contribution holds at every point of the receiver", "[volume_drop]")
{
	Random random(7);
	const auto number = [&](double least, double most)
	{
		return least + (most - least) * random.uniform();
	};
	std::size_t lit = 0;
	double tightest = 0.0;
	for (int trial = 0; trial < 3000; ++trial)
	{
		const double distance_m = 1.0;
		const double size = std::exp(number(-4.0, 1.0));
		Level level = emptyLevel();
		for (int k = 0; k < 3; ++k)
		{
			addVertex(level, size * glm::dvec3(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0)) +
								 glm::dvec3(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0)));
		}
		addTriangle(level, 0, 1, 2);
		const double extent = std::exp(number(-4.0, 1.0));
		Occluders occluders;
		for (int k = 0; k < 3; ++k)
		{
			occluders.corners.emplace_back(extent * number(-1.0, 1.0), 0.0, extent * number(-1.0, 1.0));
		}
		occluders.polygons.push_back({0, 3, 0, 0.7F, false});
		const glm::dvec3 front = frontOf(occluders.corners);
		const VolumeSet set = setOf(occluders, distance_m);
		const VolumeEvaluator evaluator(set, {});
		const VolumeRegion region = regionOf(occluders.corners, front, front, distance_m, true);
		const double area =
			0.5 * glm::length(glm::cross(occluders.corners[1] - occluders.corners[0], occluders.corners[2] - occluders.corners[0]));
		for (int side = 0; side < 2; ++side)
		{
			ReceiverSide receiver;
			REQUIRE(receiverSide(level, 0, side, false, receiver));
			const double rise = riseOf(occluders.corners, receiver);
			const bool reached = reaches(region, receiver.corners);
			const double bound = reached && rise > 0.0
									 ? greatestShare(region, occluders.corners, area, static_cast<double>(0.7F), receiver, rise)
									 : 0.0;
			for (int i = 0; i < 20; ++i)
			{
				double u = random.uniform();
				double v = random.uniform();
				if (u + v > 1.0)
				{
					u = 1.0 - u;
					v = 1.0 - v;
				}
				const auto& [a, b, c] = receiver.corners;
				const double share = evaluator.occlusion(a + u * (b - a) + v * (c - a), receiver.flat);
				REQUIRE(share <= bound + 2e-6);
				lit += share > 1e-4 ? 1 : 0;
				tightest = std::max(tightest, share > 1e-3 ? share / bound : 0.0);
			}
		}
	}
	CHECK(lit > 1000);
	CHECK(tightest > 0.5);
}

TEST_CASE("drop: normals between the vertices' see what the triangle's own does not", "[volume_drop]")
{
	// A flat floor whose vertex normals lean towards a wall that stands behind its edge, below its plane.
	Level level = emptyLevel();
	addQuad(level, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0});
	const std::array<glm::dvec3, 3> wall{glm::dvec3(1.2, -0.5, 0.0), glm::dvec3(1.2, -0.1, 0.0), glm::dvec3(1.2, -0.1, 1.0)};
	ReceiverSide receiver;
	REQUIRE(receiverSide(level, 0, 0, true, receiver));
	CHECK(receiver.flat.y > 0.99);
	CHECK(riseOf(wall, receiver) <= 0.0);
	for (glm::vec3& normal : level.normals)
	{
		normal = glm::normalize(glm::vec3(1.0F, 1.0F, 0.0F));
	}
	REQUIRE(receiverSide(level, 0, 0, true, receiver));
	CHECK(riseOf(wall, receiver) > 0.5);
	REQUIRE(receiverSide(level, 0, 0, false, receiver));
	CHECK(riseOf(wall, receiver) < 0.0);
}

TEST_CASE("drop: out of sight of the cameras' boxes", "[volume_drop]")
{
	// Two boxes on one floor with a high wall between them; the cameras are on one side.
	Level level = emptyLevel();
	addQuad(level, {-6.0, 0.0, 6.0}, {6.0, 0.0, 0.0}, {0.0, 0.0, -12.0});
	addQuad(level, {0.0, 0.0, 6.0}, {6.0, 0.0, 0.0}, {0.0, 0.0, -12.0});
	addBox(level, {-0.1, -0.1, -6.0}, {0.1, 6.0, 6.0});
	addBox(level, {2.0, 0.1, -0.5}, {3.0, 1.1, 0.5});
	addBox(level, {-3.0, 0.1, -0.5}, {-2.0, 1.1, 0.5});
	DropSettings settings;
	const uint64_t anywhere = drop(level, 0.8, settings).counts.kept;
	settings.visible_from.push_back({{3.5, 1.0, -2.0}, {5.0, 2.0, 2.0}});
	const Dropped result = drop(level, 0.8, settings);
	CHECK(result.counts.kept < anywhere);
	CHECK(result.counts.unseen >= 8); // of the box behind the wall: sides and bottom
	CHECK(result.counts.unseen_sides > 0);
	CHECK(result.counts.check_rays >= 100'000);
	CHECK(static_cast<double>(result.counts.check_missed) <= 1e-4 * static_cast<double>(result.counts.check_rays));
	for (const glm::dvec3& corner : result.occluders.corners)
	{
		CHECK(corner.x >= (corner.y > 0.05 ? -0.2 : -6.0)); // nothing of the box behind the wall
	}
}

TEST_CASE("drop: behind walls that the cameras' boxes do not see through", "[volume_drop]")
{
	// A hut on a floor, a box in it whose volumes reach through the walls, and a box outside.
	Level level = emptyLevel();
	addBox(level, {-1.0, 0.0, -1.0}, {1.0, 1.0, 1.0});
	addQuad(level, {-1.0, 0.0, 1.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, -2.0}); // its floor
	for (const double turn : {0.0, 90.0, 180.0, 270.0})
	{
		const double s = std::sin(glm::radians(turn));
		const double c = std::cos(glm::radians(turn));
		addQuad(level, {c + 4.0 * s, 0.0, 4.0 * c - s}, {3.0 * c, 0.0, -3.0 * s}, {-8.0 * s, 0.0, -8.0 * c});
	}
	addBox(level, {-0.5, 0.1, -0.5}, {0.5, 0.6, 0.5});
	addBox(level, {1.5, 0.1, -0.5}, {2.0, 0.5, 0.5});
	DropSettings settings;
	settings.inside = false;
	const auto inTheHut = [&]
	{
		const Dropped result = drop(level, 2.0, settings);
		CHECK(std::any_of(result.occluders.corners.begin(), result.occluders.corners.end(),
						  [](const glm::dvec3& corner) { return corner.x > 1.4 && corner.y > 0.05; })); // the box outside
		return std::count_if(result.occluders.corners.begin(), result.occluders.corners.end(),
							 [](const glm::dvec3& corner) { return std::fabs(corner.x) < 0.9 && std::fabs(corner.z) < 0.9; });
	};
	CHECK(inTheHut() > 0);
	settings.visible_from = {{{-9.0, 2.0, -9.0}, {9.0, 9.0, 9.0}}};
	CHECK(inTheHut() == 0);
	settings.visible_from.clear();
	append(settings.visible_from, boxesAround(level));
	CHECK(inTheHut() == 0);
}

TEST_CASE("sides: the boxes around a level hold all points next to it, and none in it", "[volume_drop]")
{
	Level level = emptyLevel();
	addBox(level, {1.0, 2.0, 3.0}, {2.0, 4.0, 6.0});
	const auto boxes = boxesAround(level);
	const auto isHeld = [&](glm::dvec3 at)
	{
		return std::any_of(boxes.begin(), boxes.end(),
						   [at](const Bounds& box) {
							   return glm::all(glm::greaterThanEqual(at, box.least)) && glm::all(glm::lessThanEqual(at, box.most));
						   });
	};
	for (int i = 0; i < 27; ++i)
	{
		const glm::dvec3 away(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
		CHECK(isHeld(glm::dvec3(1.5, 3.0, 4.5) + 0.51 * away * glm::dvec3(1.0, 2.0, 3.0)) == (i != 13));
	}
}

TEST_CASE("sides: small triangles at the end of a gap are seen together", "[volume_drop]")
{
	// The bottom of a slit, half a metre deep and 10 cm wide, in strips a millimetre wide.
	constexpr int kStrips = 2000;
	Level level = emptyLevel();
	addBox(level, {-1.0, 0.0, -1.0}, {-0.05, 0.5, 1.0});
	addBox(level, {0.05, 0.0, -1.0}, {1.0, 0.5, 1.0});
	const std::size_t first = level.triangles.size();
	for (int i = 0; i < kStrips; ++i)
	{
		addQuad(level, {-0.05, 0.0, -1.0 + 2.0 * (i + 1) / kStrips}, {0.1, 0.0, 0.0}, {0.0, 0.0, -2.0 / kStrips});
	}
	const Tracer tracer(level, {});
	const std::vector<Bounds> boxes{{{-4.0, 2.0, -4.0}, {4.0, 6.0, 4.0}}};
	const ReceiverSides sides = receiverSides(tracer, {.inside = false, .boxes = boxes, .seen_rays = 8}, {2, {}});
	const auto seen = std::count_if(sides.seen.begin() + static_cast<std::ptrdiff_t>(first), sides.seen.end(),
									[](uint8_t bits) { return (bits & kFrontSeen) != 0; });
	CHECK(seen > 2 * kStrips * 99 / 100);
}

TEST_CASE("volume tree: finds every triangle that a slow search finds", "[volume_drop]")
{
	const Level level = builtinLevel("suburb");
	const std::vector<uint8_t> all(level.triangles.size(), 1);
	const TriangleTree tree(level, all, 2);
	const Occluders occluders = trianglesOf(level);
	for (std::size_t i = 0; i < occluders.polygons.size(); i += 997)
	{
		const std::span<const glm::dvec3> corners(&occluders.corners[occluders.polygons[i].first_corner], 3);
		const glm::dvec3 front = frontOf(corners);
		const VolumeRegion region = regionOf(corners, front, front, 0.5, false);
		const auto reached = [&](uint32_t triangle)
		{
			const glm::uvec3 corner = level.triangles[triangle];
			return reaches(region, {level.positions[corner.x], level.positions[corner.y], level.positions[corner.z]});
		};
		std::vector<uint32_t> found;
		tree.visit(region.box, region.planes(), corners[0],
				   [&](uint32_t triangle)
				   {
					   if (reached(triangle))
					   {
						   found.push_back(triangle);
					   }
					   return true;
				   });
		std::sort(found.begin(), found.end());
		std::vector<uint32_t> slow;
		for (uint32_t triangle = 0; triangle < level.triangles.size(); ++triangle)
		{
			if (reached(triangle))
			{
				slow.push_back(triangle);
			}
		}
		CHECK(found == slow);
	}
}
