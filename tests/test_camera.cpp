// SPDX-License-Identifier: GPL-3.0-or-later
#include "small_gbuffers.h"
#include "small_levels.h"
#include "small_pictures.h"
#include "testing.h"

#include "scene/builtin.h"
#include "scene/camera_choice.h"
#include "scene/describe.h"
#include "scene/load.h"
#include "scene/tracer.h"

#include <glm/matrix.hpp>

namespace
{

using namespace nook;

constexpr int kWidth = 640;
constexpr int kHeight = 360;
constexpr double kNear = 0.2;
constexpr double kFar = 300.0;

// m·z + c divided by −z for a perspective projection; its device depth at depth d is −m + c / d.
glm::dmat4 perspective(double m, double c)
{
	glm::dmat4 p(0.0);
	p[0][0] = 1.1;
	p[1][1] = 1.9;
	p[2][2] = m;
	p[3][2] = c;
	p[2][3] = -1.0;
	return p;
}

} // namespace

TEST_CASE("camera: from a pixel to its line and back, and to depth from what a depth buffer holds", "[camera]")
{
	const NamedProjection one = GENERATE(from_range(projections(16.0 / 9.0)));
	INFO(one.name);
	const Projector projector(one.matrix, kWidth, kHeight);
	Random random(3);
	for (int i = 0; i < 200; ++i)
	{
		const double x = kWidth * random.uniform();
		const double y = kHeight * random.uniform();
		const double depth = kNear * expOf(random.uniform() * logOf(kFar / kNear));
		const ViewLine line = projector.lineOf({x, y});
		CHECK(line.along.z == -1.0);
		CHECK(line.at.z == 0.0);
		const glm::dvec3 at = line.at + line.along * depth;
		const glm::dvec2 back = projector.pixelOf(at);
		CHECK(back.x == Approx(x).margin(1e-8));
		CHECK(back.y == Approx(y).margin(1e-8));
		const glm::dvec4 clip = one.matrix * glm::dvec4(at, 1.0);
		CHECK(projector.depthOfDevice(clip.z / clip.w, line) == Approx(depth).epsilon(1e-9));
	}
	if (one.name == std::string("reversed infinite"))
	{
		CHECK(std::isinf(projector.depthOfDevice(0.0, projector.lineOf({1.0, 1.0}))));
	}
}

TEST_CASE("camera: the picture is the right way round", "[camera]")
{
	Lens lens{.fov_y_rad = 0.5 * kPi};
	const Projector projector(projectionOf(lens, 2.0), 200, 100);
	// Half the height at 45°: the upper edge shows y = depth, the right one x = 2 × depth.
	CHECK(projector.pixelOf({0.0, 3.0, -3.0}).y == Approx(0.0).margin(1e-12));
	CHECK(projector.pixelOf({6.0, 0.0, -3.0}).x == Approx(200.0));
	CHECK(projector.pixelOf({0.0, 0.0, -3.0}).x == Approx(100.0));

	const glm::dmat4 down = worldFromCamera({1.0, 5.0, 2.0}, {1.0, 0.0, 2.0});
	CHECK(glm::determinant(glm::dmat3(down)) == Approx(1.0));
	CHECK(down[1].z == Approx(-1.0)); // −z is up in the picture
	const glm::dmat4 level = worldFromCamera({0.0, 1.0, 0.0}, {4.0, 1.0, 0.0});
	CHECK(level[2].x == Approx(-1.0));
	CHECK(level[1].y == Approx(1.0));
	CHECK(level[0].z == Approx(1.0));
}

TEST_CASE("camera: projections without lines of sight are refused", "[camera]")
{
	const auto refused = [](const glm::dmat4& p)
	{
		return !refusalBy([&] { Projector(p, kWidth, kHeight); }).empty();
	};
	CHECK(refused(glm::dmat4(0.0)));
	glm::dmat4 p = perspective(-1.001, -0.4);
	p[1][1] = 0.0;
	CHECK(refused(p)); // flat
	p = perspective(-1.001, -0.4);
	p[0][0] = std::numeric_limits<double>::quiet_NaN();
	CHECK(refused(p));
	p[0][0] = std::numeric_limits<double>::infinity();
	CHECK(refused(p));
	p = perspective(-1.001, -0.4);
	p[3][2] = 0.0; // depth is undetermined: row 2 is a multiple of row 3
	CHECK(refused(p));
	p[3][2] = 1e-16;
	CHECK(refused(p));
	p = perspective(-1.001, -0.4);
	p[2][3] = 1.0; // looks along +z
	CHECK(refused(p));
	p = perspective(-1.001, -0.4);
	p[1] = p[0] * (1.0 + 1e-15);
	CHECK(refused(p));
}

TEST_CASE("camera: a picture that is wider than any is refused", "[camera]")
{
	glm::dmat4 wide = perspective(-1.0, -0.2);
	CHECK_NOTHROW(Projector(wide, kWidth, kHeight));
	wide[0][0] = 1e-12;
	CHECK_THROWS_WITH(Projector(wide, kWidth, kHeight), Catch::Contains("without one line of sight per pixel"));
}

TEST_CASE("camera: the inside of a solid is told from the outside", "[camera]")
{
	const Level level = builtinLevel("courtyard");
	const Tracer tracer(level, {});
	CHECK(insideShare(tracer, {0.0, 1.7, -5.0}) < 0.3);             // in the court
	CHECK(insideShare(tracer, {10.0, 2.0, -30.0}) < 0.3);           // under the aisle's roof
	CHECK(insideShare(tracer, {0.0, 500.0, 0.0}) < 0.1);            // far above, with little in sight
	CHECK(insideShare(tracer, {12.3, 1.0, -22.0}) >= kInsideShare); // in the outer wall
	CHECK(insideShare(tracer, {8.0, 1.8, -8.0}) >= kInsideShare);   // in a column
	CHECK(insideShare(tracer, {0.0, -0.3, -30.0}) >= kInsideShare); // below the ground's surface
	CHECK_NOTHROW(checkOutside(tracer, {0.0, 1.7, -5.0}, "court"));
	CHECK(refusalBy([&] { checkOutside(tracer, {12.3, 1.0, -22.0}, "buried"); }).find("buried") != std::string::npos);

	// A room whose faces look inward is open inside; two-sided faces do not count.
	Level cornell = builtinLevel("cornell");
	for (glm::uvec3& triangle : cornell.triangles)
	{
		std::swap(triangle.y, triangle.z);
	}
	const Tracer turned(cornell, {});
	CHECK(insideShare(turned, {0.0, 2.7, -2.0}) >= kInsideShare);
	for (Material& material : cornell.material_list)
	{
		material.two_sided = true;
	}
	CHECK(insideShare(turned, {0.0, 2.7, -2.0}) == 0.0);
}

TEST_CASE("camera: chosen views are the same on any number of threads, distinct, and outside of solids", "[camera]")
{
	const char* const name =
		GENERATE(as<const char*>{}, "cornell", "courtyard", "suburb", "foliage", "heightfield:20000", "cave:20000", "nulls");
	INFO(name);
	const Level level = builtinLevel(name);
	const Tracer tracer(level, {});
	RunSettings run;
	const std::vector<LevelCamera> cameras = chooseCameras(tracer, 5, run);
	REQUIRE(cameras.size() == 5);
	// More threads give the same views; fewer views are the first of more.
	run.threads = 4;
	const std::vector<LevelCamera> again = chooseCameras(tracer, 4, run);
	REQUIRE(again.size() == 4);
	for (std::size_t i = 0; i < 4; ++i)
	{
		CHECK(again[i].name == "auto-" + std::to_string(i + 1));
		CHECK(again[i].world_from_camera == cameras[i].world_from_camera);
	}
	const Bounds bounds = boundsOf(level);
	const double diagonal = glm::length(bounds.most - bounds.least);
	for (std::size_t i = 0; i < 5; ++i)
	{
		CHECK_NOTHROW(checkOutside(tracer, glm::dvec3(cameras[i].world_from_camera[3]), cameras[i].name));
		for (std::size_t j = 0; j < i; ++j)
		{
			const glm::dvec4 apart = cameras[i].world_from_camera[3] - cameras[j].world_from_camera[3];
			const double cosine = glm::dot(cameras[i].world_from_camera[2], cameras[j].world_from_camera[2]);
			CHECK((glm::length(apart) > 0.05 * diagonal || cosine < 0.82));
		}
	}
}

TEST_CASE("camera: a small object is looked at from outside", "[camera]")
{
	// Only the disk of the nulls, scaled to 20 cm: nothing to stand on.
	Level level = builtinLevel("nulls");
	for (const Mesh& mesh : std::vector<Mesh>(level.meshes))
	{
		if (mesh.name == "sphere")
		{
			const auto first = static_cast<std::ptrdiff_t>(mesh.first_triangle);
			const auto last = first + static_cast<std::ptrdiff_t>(mesh.triangle_count);
			level.triangles = std::vector<glm::uvec3>(level.triangles.begin() + first, level.triangles.begin() + last);
			level.materials.resize(level.triangles.size());
			level.meshes = {{"sphere", 0, level.triangles.size()}};
			break;
		}
	}
	for (glm::dvec3& position : level.positions)
	{
		position *= 0.1;
	}
	const Tracer tracer(level, {});
	const glm::dvec3 middle(0.0, 0.1, -15.0);
	for (const LevelCamera& camera : chooseCameras(tracer, 4, {}))
	{
		const glm::dvec3 eye = glm::dvec3(camera.world_from_camera[3]);
		CHECK(glm::length(eye - middle) > 0.1);
		CHECK(glm::length(eye - middle) < 0.6);
		CHECK(glm::dot(glm::normalize(middle - eye), -glm::dvec3(camera.world_from_camera[2])) > 0.9999);
	}
}

TEST_CASE("camera: views of levels of any size, anywhere", "[camera]")
{
	struct Place
	{
		double size;
		glm::dvec3 at;
	};
	for (const auto& [size, at] :
		 {Place{1e-4, glm::dvec3(0.0)}, {1.0, {5e5, 0.0, -5e5}}, {64.0, {5e14, 5e14, -5e14}}, {1e14, glm::dvec3(0.0)}})
	{
		INFO(size << " m at " << at.x);
		Level level = builtinLevel("cornell");
		for (glm::dvec3& position : level.positions)
		{
			position = at + size * position;
		}
		const Tracer tracer(level, {});
		for (const LevelCamera& camera : chooseCameras(tracer, 3, {}))
		{
			CHECK(hitsPerCent(tracer, camera) >= 10);
		}
	}
}

TEST_CASE("camera: where those who stand see too little, views are from outside", "[camera]")
{
	const auto viewsOf = [](const Level& level, std::size_t from_outside, int least_per_cent)
	{
		const Tracer tracer(level, {});
		const CamerasOfLevel found = camerasOf(tracer, "", 6, {});
		REQUIRE(found.cameras.size() == 6);
		std::size_t outside = 0;
		for (const LevelCamera& camera : found.cameras)
		{
			outside += camera.from_outside ? 1U : 0U;
			CHECK(hitsPerCent(tracer, camera) >= least_per_cent);
			CHECK(camera.lens.near_m > 0.0);
		}
		CHECK(outside == from_outside);
		RunSettings more;
		more.threads = 3;
		const std::vector<LevelCamera> again = chooseCameras(tracer, 2, more);
		CHECK(again[1].world_from_camera == found.cameras[1].world_from_camera);
	};
	const auto floorOf = [](double size)
	{
		Level level = test::emptyLevel();
		test::addQuad(level, {-0.5 * size, 0.0, 0.5 * size}, {size, 0.0, 0.0}, {0.0, 0.0, -size});
		return level;
	};
	viewsOf(floorOf(2.0), 6, 5); // not visible from its middle at 1.6 m
	viewsOf(floorOf(0.02), 6, 5);
	viewsOf(floorOf(40.0), 0, 5);
	Level wall = test::emptyLevel();
	test::addQuad(wall, {-4.0, 0.0, 0.0}, {8.0, 0.0, 0.0}, {0.0, 3.0, 0.0});
	viewsOf(wall, 6, 3);
	Level triangle = test::emptyLevel();
	test::addTriangle(triangle, test::addVertex(triangle, {0, 0, 0}), test::addVertex(triangle, {0, 5, 0}),
					  test::addVertex(triangle, {0, 0, 5}));
	viewsOf(triangle, 6, 1);
	Level ball = test::emptyLevel();
	test::addSphere(ball, {0.0, 0.5, 0.0}, 0.5, 12, 24);
	test::addBox(ball, {-0.1, 0.4, -0.1}, {0.1, 0.6, 0.1}); // in it
	viewsOf(ball, 6, 10);
	Level desk = test::emptyLevel(); // people could stand on it, but would not see it
	test::addBox(desk, {-1.0, 0.9, -0.8}, {1.0, 1.0, 0.8});
	test::addBox(desk, {-1.0, 0.0, -0.8}, {-0.9, 0.9, 0.8});
	test::addBox(desk, {0.4, 0.0, -0.8}, {1.0, 0.9, 0.8});
	viewsOf(desk, 6, 10);
	// A maze of rooms with ceilings at a height of 1, as in a game whose unit is a storey.
	Level maze = test::emptyLevel();
	test::addBox(maze, {-10, -1, -10}, {10, 0, 10});
	test::addQuad(maze, {-10, 1, -10}, {20, 0, 0}, {0, 0, 20}); // faces down
	for (int i = 0; i < 5; ++i)
	{
		test::addBox(maze, {-8.0 + 4.0 * i, 0, -10}, {-7.0 + 4.0 * i, 1, i % 2 == 0 ? 6.0 : -4.0});
	}
	viewsOf(maze, 0, 10);
	Level wire = test::emptyLevel();
	test::addBox(wire, {0.0, 0.0, 0.0}, {0.001, 40.0, 0.001});
	viewsOf(wire, 6, 1);
	// A hollow, two-sided pyramid with boxes around it, and one with boxes inside that are turned round: a room with wrong faces.
	for (const bool room : {false, true})
	{
		Level pyramid = test::emptyLevel();
		pyramid.material_list[0].two_sided = true;
		const std::array<glm::dvec3, 4> corners{glm::dvec3{-8, 0, 8}, {8, 0, 8}, {8, 0, -8}, {-8, 0, -8}};
		test::addQuad(pyramid, corners[0], {0, 0, -16}, {16, 0, 0}); // faces down
		for (std::size_t i = 0; i < 4; ++i)
		{
			test::addTriangle(pyramid, test::addVertex(pyramid, corners[i]), test::addVertex(pyramid, corners[(i + 1) % 4]),
							  test::addVertex(pyramid, {0, 9, 0}));
		}
		for (const glm::dvec3 corner : corners)
		{
			const glm::dvec3 middle = (room ? 0.6 : 0.8) * corner + glm::dvec3(0, room ? 1.0 : 6.0, 0);
			const glm::dvec3 half(1.0, room ? -1.0 : 3.0, 1.0); // a negative size turns all faces round
			test::addBox(pyramid, middle - half, middle + half);
		}
		viewsOf(pyramid, room ? 0 : 6, 10);
	}

	Level glass = floorOf(4.0);
	glass.material_list[0].alpha_mode = AlphaMode::mask;
	glass.material_list[0].alpha = 0.0;
	measureAlpha(glass.material_list[0], glass.masks);
	CHECK_THROWS_WITH(chooseCameras(Tracer(glass, {}), 1, {}), Catch::Contains("found no view that shows anything of it"));
}

TEST_CASE("camera: strays far away do not move the views", "[camera]")
{
	Level level = builtinLevel("courtyard");
	const Bounds bounds = boundsOf(level);
	CHECK(mainBounds(level).least == bounds.least);
	CHECK(mainBounds(level).most == bounds.most);
	const double radius_m = suggestedRadius(level);
	test::addQuad(level, {300.0, 5.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.1, 0.0});
	test::addQuad(level, {-900.0, 5.0, 9e3}, {0.5, 0.0, 0.0}, {0.0, 0.5, 0.0}); // the other is close to the rest in comparison
	CHECK(mainBounds(level).least == bounds.least);
	CHECK(mainBounds(level).most == bounds.most);
	CHECK(suggestedRadius(level) == radius_m);
	for (const LevelCamera& camera : chooseCameras(Tracer(level, {}), 4, {}))
	{
		CHECK(!camera.from_outside);
		CHECK(glm::all(glm::lessThan(glm::abs(glm::dvec3(camera.world_from_camera[3])), glm::dvec3(100.0))));
	}
}

TEST_CASE("camera: nobody stands on a roof where there is a floor", "[camera]")
{
	// A church without doors on a square, with pillars inside and out to look at, and a flat roof with chimneys.
	Level level = test::emptyLevel();
	test::addBox(level, {-30, -1, -30}, {30, 0, 30});
	test::addBox(level, {-10, 0, -16}, {10, 9, 16});
	for (int i = 0; i < 8; ++i)
	{
		const double z = -14.0 + 4.0 * i;
		test::addBox(level, {-6, 9, z}, {-5, 11, z + 1});
		test::addBox(level, {5, 9, z}, {6, 11, z + 1});
		test::addBox(level, {-20, 0, z}, {-19, 5, z + 1});
		test::addBox(level, {19, 0, z}, {20, 5, z + 1});
	}
	const Tracer tracer(level, {});
	const int above = sumOver(chooseCameras(tracer, 6, {}),
							  [](const LevelCamera& camera) { return camera.world_from_camera[3].y > 9.0 ? 1 : 0; });
	CHECK(above == 0);
}

TEST_CASE("camera: views of levels from files", "[camera]")
{
	const std::filesystem::path scenes = std::filesystem::path(NOOK_SOURCE_DIR).parent_path() / "shared" / "scenes";
	for (const char* const name : {"cornell_box/cornell_box.obj", "delft/delft.obj", "pine/pine.glb"})
	{
		if (!std::filesystem::exists(scenes / name))
		{
			continue; // optional files that are not in the repository
		}
		INFO(name);
		const LoadedLevel loaded = loadLevel((scenes / name).string(), {}, {});
		const Tracer tracer(loaded.level, {});
		const std::vector<LevelCamera> cameras = chooseCameras(tracer, 3, {});
		REQUIRE(cameras.size() == 3);
		for (const LevelCamera& camera : cameras)
		{
			CHECK(hitsPerCent(tracer, camera) >= 20);
		}
	}
}
