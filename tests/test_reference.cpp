// SPDX-License-Identifier: GPL-3.0-or-later
// Reference visibility compared with closed forms.
#include "small_levels.h"
#include "testing.h"

#include "scene/reference.h"
#include "scene/sample_set.h"

namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const ReferencePoint kOrigin{{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0.0};

ReferenceValue occlusionSeeds(const Level& level, const ReferencePoint& point, ReferenceSettings settings, int seeds)
{
	// Mean visibility over seeds, and the standard error of that mean from those of the seeds.
	const Tracer tracer(level, {});
	double sum = 0.0;
	double squares = 0.0;
	for (int seed = 0; seed < seeds; ++seed)
	{
		settings.seed = static_cast<uint32_t>(seed);
		const ReferenceValue value = referenceAtPoints(tracer, std::span(&point, 1), settings, {})[0];
		sum += value.visibility;
		squares += value.standard_error * value.standard_error;
	}
	const double mean = sum / seeds;
	return {mean, std::sqrt(squares) / seeds, settings.rays};
}

ReferenceValue at(const Level& level, const ReferencePoint& point, const ReferenceSettings& settings)
{
	const Tracer tracer(level, {});
	return referenceAtPoints(tracer, std::span(&point, 1), settings, {})[0];
}

// One value with 4096 rays, and the mean of 64 seeds with 64.
void checkOcclusion(const Level& level, const ReferencePoint& point, ReferenceSettings settings, double expected)
{
	settings.rays = 4096;
	const ReferenceValue value = at(level, point, settings);
	CAPTURE(value.visibility, value.standard_error, expected);
	CHECK(value.standard_error > 0.0);
	CHECK(value.standard_error < 0.005);
	CHECK(std::fabs(1.0 - value.visibility - expected) <= 3.0 * value.standard_error);

	settings.rays = 64;
	const ReferenceValue mean = occlusionSeeds(level, point, settings, 64);
	CAPTURE(mean.visibility, mean.standard_error);
	CHECK(std::fabs(1.0 - mean.visibility - expected) <= 3.0 * mean.standard_error);
}

ReferenceSettings hard(double radius_m)
{
	ReferenceSettings settings{.radius_m = radius_m};
	return settings;
}

Level floorAndWall()
{
	Level level = emptyLevel();
	addBox(level, {-20.0, -10.0, -20.0}, {20.0, 0.0, 20.0});
	addBox(level, {1.0, 0.0, -20.0}, {20.0, 20.0, 20.0});
	return level;
}

} // namespace

TEST_CASE("reference: under a disk, beside a wall, under a sphere, on a plane", "[reference]")
{
	SECTION("disk of radius r at height h: r²/(r²+h²)")
	{
		Level level = emptyLevel();
		addDiskFacingDown(level, {0.0, 2.0, 0.0}, 1.5, 1024);
		checkOcclusion(level, kOrigin, hard(kInfinity), 2.25 / (2.25 + 4.0));
	}
	SECTION("infinite wall: 1/2")
	{
		Level level = emptyLevel();
		addQuad(level, {0.001, -100.0, -1000.0}, {0.0, 0.0, 2000.0}, {0.0, 1000.0, 0.0});
		checkOcclusion(level, kOrigin, hard(kInfinity), 0.5);
	}
	SECTION("sphere of radius R at distance d: R²/d²")
	{
		Level level = emptyLevel();
		addSphere(level, {0.0, 3.0, 0.0}, 1.0, 256, 512);
		checkOcclusion(level, kOrigin, hard(kInfinity), 1.0 / 9.0);
	}
	SECTION("plane: 0, exactly")
	{
		Level level = emptyLevel();
		addQuad(level, {-10.0, 0.0, -10.0}, {0.0, 0.0, 20.0}, {20.0, 0.0, 0.0});
		CHECK(at(level, kOrigin, hard(kInfinity)).visibility == 1.0);
	}
}

TEST_CASE("reference: falloffs under a ceiling", "[reference]")
{
	Level level = emptyLevel();
	const double h = 0.4;
	addQuad(level, {-50.0, h, -50.0}, {100.0, 0.0, 0.0}, {0.0, 0.0, 100.0});
	ReferenceSettings settings = hard(1.0);
	SECTION("hard: 1 - (h/r)²")
	{
		checkOcclusion(level, kOrigin, settings, 1.0 - h * h);
	}
	SECTION("linear: (1 - h/r)²")
	{
		settings.falloff = Falloff::linear;
		checkOcclusion(level, kOrigin, settings, (1.0 - h) * (1.0 - h));
	}
	SECTION("alchemy with u < h: 2u/(3h) (1 - (h/r)³)")
	{
		settings.falloff = Falloff::alchemy;
		settings.falloff_u_m = 0.3;
		checkOcclusion(level, kOrigin, settings, 2.0 * 0.3 / (3.0 * h) * (1.0 - h * h * h));
	}
	SECTION("alchemy with u > r: every distance counts t/u, 2h/u (1 - h/r)")
	{
		settings.falloff = Falloff::alchemy;
		settings.falloff_u_m = 2.0;
		checkOcclusion(level, kOrigin, settings, 2.0 * h / 2.0 * (1.0 - h));
	}
}

TEST_CASE("reference: open shares of a volume by the geometry", "[reference]")
{
	const Level level = floorAndWall();
	ReferenceSettings settings = hard(0.5);
	settings.measure = ReferenceMeasure::hemisphere;
	checkOcclusion(level, kOrigin, settings, 0.0); // nothing within reach
	settings.radius_m = 2.0;
	// Half the ball's cap beyond distance 1 of radius 2: cap π h² (3r − h)/3 with h = 1, over the ball.
	const double cap = (3.0 * 2.0 - 1.0) / (4.0 * 8.0);
	checkOcclusion(level, kOrigin, settings, cap);
	settings.measure = ReferenceMeasure::sphere;
	checkOcclusion(level, kOrigin, settings, 0.5 + 0.5 * cap);
}

TEST_CASE("reference: open shares of a volume by the depth buffer", "[reference]")
{
	Level level = emptyLevel();
	addBox(level, {-20.0, -20.0, -1.0}, {20.0, 20.0, 0.0}); // a wall to look at
	addBox(level, {0.5, -20.0, 0.0}, {20.0, 20.0, 1.0});    // with a step in it
	const Tracer tracer(level, {});
	LevelCamera camera;
	camera.lens.orthographic = true; // avoids a shadow of the step
	camera.lens.half_height_m = 3.0;
	camera.lens.far_m = 100.0;
	camera.world_from_camera = worldFromCamera({0.0, 0.0, 10.0}, {0.0, 0.0, 0.0});
	GBuffer gbuffer = castGBuffer(tracer, viewOf(camera, 31, 31), 31, 31, NormalKind::geometric, {});
	// Rays for the centre only: the others become sky that no sample reaches, beyond the box.
	for (int i = 0; i < 31 * 31; ++i)
	{
		if (std::max(std::abs(i % 31 - 15), std::abs(i / 31 - 15)) > 8)
		{
			gbuffer.depth[static_cast<std::size_t>(i)] = std::numeric_limits<float>::infinity();
		}
	}
	ReferenceSettings settings = hard(1.0);
	settings.source = MatterSource::depth;
	settings.rays = 4096;
	const auto centre = [&](ReferenceMeasure measure)
	{
		settings.measure = measure;
		return referenceOfGBuffer(nullptr, gbuffer, settings, {})[15 * 31 + 15];
	};
	// The centre pixel shows the origin; the step starts at a pixel's border, and 0.5 m are 2.58 pixels.
	const double edge = 2.5 * 6.0 / 31.0;
	const double cap = (2.0 / 3.0 - edge + edge * edge * edge / 3.0) / (4.0 / 3.0); // of the ball beyond `edge`
	const ReferenceValue hemisphere = centre(ReferenceMeasure::hemisphere);
	CHECK(std::fabs(hemisphere.visibility - (1.0 - cap)) <= 3.0 * hemisphere.standard_error);
	const ReferenceValue sphere = centre(ReferenceMeasure::sphere);
	CHECK(std::fabs(sphere.visibility - 0.5 * (1.0 - cap)) <= 3.0 * sphere.standard_error);
	const ReferenceValue box = centre(ReferenceMeasure::box);
	CHECK(std::fabs(box.visibility - 0.5 * (1.0 + edge) / 2.0) <= 3.0 * box.standard_error);

	// Now from the geometry: here the depth buffer implies the same solids.
	settings.source = MatterSource::geometry;
	settings.measure = ReferenceMeasure::box;
	const ReferenceValue solid = referenceOfGBuffer(&tracer, gbuffer, settings, {})[15 * 31 + 15];
	CHECK(std::fabs(solid.visibility - 0.5 * 1.5 / 2.0) <= 3.0 * solid.standard_error);
}

TEST_CASE("reference: masks let rays through", "[reference]")
{
	Level level = emptyLevel();
	Mask mask{"stripes", 64, 1, Wrap::repeat, Wrap::repeat, std::vector<uint8_t>(64, 0)};
	std::fill(mask.alpha.begin() + 16, mask.alpha.begin() + 48, uint8_t{255});
	level.masks.push_back(mask);
	Material masked;
	masked.alpha_mode = AlphaMode::mask;
	masked.mask = 0;
	measureAlpha(masked, level.masks);
	CHECK(masked.coverage == 0.5);
	level.material_list.push_back(masked);
	addQuad(level, {-500.0, 1.0, -500.0}, {1000.0, 0.0, 0.0}, {0.0, 0.0, 1000.0}, 1);
	for (glm::vec2& uv : level.uvs)
	{
		uv.x *= 10000.0F; // stripes of 5 cm, at a distance of 1 m and more
	}
	// Almost the same as rays against a ceiling that covers half, except for the stripes near the zenith.
	ReferenceSettings settings = hard(kInfinity);
	settings.rays = 4096;
	CHECK(std::fabs(at(level, kOrigin, settings).visibility - 0.5) < 0.02);
	settings.falloff = Falloff::linear;
	settings.radius_m = 1e6;
	CHECK(std::fabs(at(level, kOrigin, settings).visibility - 0.5) < 0.02);
	level.material_list[1].alpha = 0.4; // below the cut-off everywhere
	measureAlpha(level.material_list[1], level.masks);
	CHECK(at(level, kOrigin, settings).visibility == 1.0);
}

TEST_CASE("reference: more rays until the error is small enough", "[reference]")
{
	Level level = floorAndWall();
	const Tracer tracer(level, {});
	std::vector<ReferencePoint> points;
	for (int i = 0; i < 200; ++i)
	{
		points.push_back({{1.0 - 0.05 * (i + 1), 0.0, 0.01 * i}, {0.0, 1.0, 0.0}, 0.0});
	}
	ReferenceSettings settings = hard(2.0);
	settings.rays = 4096;
	settings.max_error = 0.004;
	std::size_t spent = 0;
	std::size_t beyond = 0;
	for (const auto& [value, point] :
		 [&]
		 {
			 std::vector<std::pair<ReferenceValue, ReferencePoint>> pairs;
			 const std::vector<ReferenceValue> values = referenceAtPoints(tracer, points, settings, {});
			 for (std::size_t i = 0; i < values.size(); ++i)
			 {
				 pairs.emplace_back(values[i], points[i]);
			 }
			 return pairs;
		 }())
	{
		CHECK((value.standard_error <= settings.max_error || value.rays == settings.rays));
		spent += static_cast<std::size_t>(value.rays);
		// A wall at distance d, seen by rays of length r: sin θ cos φ > d/r, a segment of the projected disk.
		const double d = std::min(1.0, (1.0 - point.position.x) / 2.0);
		const double expected = (std::acos(d) - d * std::sqrt(1.0 - d * d)) / kPi;
		beyond += std::fabs(1.0 - value.visibility - expected) > 3.0 * value.standard_error ? 1U : 0U;
	}
	CHECK(beyond <= 4); // of 200: 2 %
	CHECK(spent < 200U * 1500U);
	CHECK(spent > 200U * 64U);
}

TEST_CASE("reference: bent normals beside a wall, in the open and where nothing is", "[reference]")
{
	ReferenceSettings settings = hard(kInfinity);
	settings.measure = ReferenceMeasure::bent;
	settings.rays = 4096;
	const ReferenceValue wall = at(floorAndWall(), {{1.0 - 1e-4, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0.0}, settings);
	// Over the quarter sphere: (1/π) ∫ ω (n·ω) dω = (−2/(3π), 1/3, 0).
	const glm::vec3 expected = glm::normalize(glm::vec3(-2.0F / (3.0F * 3.14159265F), 1.0F / 3.0F, 0.0F));
	CHECK(glm::distance(wall.bent, expected) < 0.01F);
	CHECK(std::fabs(coneAngle(wall.visibility) - 0.25 * 3.14159265) < 0.01); // half is seen: sin² = ½

	Level plane = emptyLevel();
	addBox(plane, {-20.0, -10.0, -20.0}, {20.0, 0.0, 20.0});
	const ReferenceValue open = at(plane, kOrigin, settings);
	CHECK(open.visibility == 1.0);
	CHECK(glm::distance(open.bent, {0.0F, 1.0F, 0.0F}) < 0.01F);

	const ReferencePoint inside{{0.0, -5.0, 0.0}, {0.0, 1.0, 0.0}, 0.0};
	const ReferenceValue closed = at(plane, inside, settings);
	CHECK(closed.visibility == 0.0);
	CHECK(closed.bent == glm::vec3(0.0F, 1.0F, 0.0F)); // nothing is open: the normal
	settings.measure = ReferenceMeasure::obscurance;
	CHECK(at(floorAndWall(), kOrigin, settings).bent == glm::vec3(0.0F));
}

TEST_CASE("reference: bent normals of pixels lie in view space, and the rays are those of obscurance", "[reference]")
{
	const Level level = floorAndWall();
	LevelCamera camera;
	camera.world_from_camera = worldFromCamera({-3.0, 2.0, 3.0}, {1.0, 0.0, 0.0});
	const View view = viewOf(camera, 24, 16);
	const Tracer tracer(level, {});
	const GBuffer gbuffer = castGBuffer(tracer, view, 24, 16, NormalKind::geometric, {});
	ReferenceSettings settings = hard(0.25);
	settings.rays = 64;
	const std::vector<ReferenceValue> plain = referenceOfGBuffer(&tracer, gbuffer, settings, {});
	settings.measure = ReferenceMeasure::bent;
	const std::vector<ReferenceValue> bent = referenceOfGBuffer(&tracer, gbuffer, settings, {});
	std::size_t open = 0;
	for (std::size_t i = 0; i < bent.size(); ++i)
	{
		CHECK(bent[i].visibility == plain[i].visibility);
		if (bent[i].rays == 0)
		{
			CHECK(bent[i].bent == glm::vec3(0.0F));
			continue;
		}
		CHECK(std::fabs(glm::length(bent[i].bent) - 1.0F) < 1e-5F);
		if (bent[i].visibility == 1.0) // 64 rays around it
		{
			CHECK(glm::dot(bent[i].bent, gbuffer.normals[i]) > 0.99F);
			open += 1;
		}
	}
	CHECK(open > 50);
}

TEST_CASE("reference: rays inside a closed mesh far from the origin do not get out", "[reference]")
{
	Level level = emptyLevel();
	addSphere(level, {148376.0, 1234.0, -223423.0}, 2.0, 150, 300);
	// Rounded as in a file of 32-bit floats.
	for (glm::dvec3& position : level.positions)
	{
		position = glm::dvec3(glm::vec3(position));
	}
	const Tracer tracer(level, {});
	Random random(3);
	const SampleSet set(SampleDomain::ball, 4096);
	std::vector<float> x(4096);
	std::vector<float> y(4096);
	std::vector<float> z(4096);
	std::vector<uint8_t> blocked(4096);
	std::vector<float> distances(4096);
	std::size_t missed = 0;
	for (int point = 0; point < 64; ++point)
	{
		const glm::dvec3 origin =
			glm::dvec3(148376.0, 1234.0, -223423.0) + glm::dvec3(random.uniform(), random.uniform(), random.uniform());
		set.place(random, x, y, z);
		tracer.blocked(origin, {x, y, z}, std::numeric_limits<float>::infinity(), blocked);
		tracer.distances(origin, {x, y, z}, std::numeric_limits<float>::infinity(), distances);
		missed += static_cast<std::size_t>(std::count(blocked.begin(), blocked.end(), uint8_t{0}));
		missed +=
			static_cast<std::size_t>(std::count_if(distances.begin(), distances.end(), [](float d) { return std::isinf(d); }));
	}
	CHECK(missed <= 10); // of 524,288: 2e-5
}

TEST_CASE("reference: a plane does not occlude itself, from a millimetre to 1000 km away", "[reference]")
{
	Random random(1);
	const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, 0.9, -0.2));
	const glm::dvec3 u = glm::normalize(glm::cross(normal, glm::dvec3(0.0, 0.0, 1.0)));
	const glm::dvec3 v = glm::cross(normal, u);
	for (double away = 1e-3; away < 2e6; away *= 10.0)
	{
		for (const double size : {1.0, away})
		{
			Level level = emptyLevel();
			// 32-bit vertices, as in files.
			const glm::dvec3 middle = away * normal;
			addQuad(level, middle - 0.5 * size * (u + v), size * v, size * u);
			for (glm::dvec3& position : level.positions)
			{
				position = glm::dvec3(glm::vec3(position));
			}
			const glm::dvec3 facing =
				glm::normalize(glm::cross(level.positions[1] - level.positions[0], level.positions[2] - level.positions[0]));
			std::vector<ReferencePoint> points;
			for (int i = 0; i < 100; ++i)
			{
				const double a = random.uniform();
				const double b = random.uniform() * (1.0 - a);
				const glm::dvec3 p = level.positions[0] + a * (level.positions[1] - level.positions[0]) +
									 b * (level.positions[2] - level.positions[0]);
				const glm::dvec3 rounded = glm::dvec3(glm::vec3(p));
				points.push_back({rounded, facing, 0x1p-24 * (std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z))});
			}
			const Tracer tracer(level, {});
			ReferenceSettings settings = hard(kInfinity);
			settings.rays = 256;
			const std::size_t occluded = sumOver(referenceAtPoints(tracer, points, settings, {}), [](const ReferenceValue& value)
												 { return value.visibility < 1.0 ? std::size_t{1} : std::size_t{0}; });
			CAPTURE(away, size);
			CHECK(occluded == 0);
		}
	}
}

TEST_CASE("reference: a flat floor in a G-buffer reads 1, near and far, steep and shallow", "[reference]")
{
	const double size = GENERATE(1.0, 1e3, 1e5);
	Level level = emptyLevel();
	addQuad(level, {-size, 0.0, -size}, {0.0, 0.0, 2.0 * size}, {2.0 * size, 0.0, 0.0});
	const Tracer tracer(level, {});
	LevelCamera camera;
	camera.world_from_camera = worldFromCamera({0.0, 0.05 * size, 0.9 * size}, {0.0, 0.0, 0.0});
	GBuffer gbuffer = castGBuffer(tracer, viewOf(camera, 64, 48), 64, 48, NormalKind::geometric, {});
	ReferenceSettings settings = hard(0.1 * size);
	settings.rays = 64;
	for (const ReferenceValue& value : referenceOfGBuffer(&tracer, gbuffer, settings, {}))
	{
		REQUIRE(value.visibility == 1.0);
	}
}

TEST_CASE("reference: a depth buffer's coarse numbers do not make a floor occlude itself", "[reference]")
{
	Level level = emptyLevel();
	addQuad(level, {-50.0, 0.0, -50.0}, {0.0, 0.0, 100.0}, {100.0, 0.0, 0.0});
	const Tracer tracer(level, {});
	LevelCamera camera;
	camera.lens.near_m = 0.01;
	camera.world_from_camera = worldFromCamera({0.0, 2.0, 30.0}, {0.0, 0.0, 0.0});
	const GBuffer truth = castGBuffer(tracer, viewOf(camera, 32, 24), 32, 24, NormalKind::geometric, {});
	const Projector projector(truth.view.projection, 32, 24);
	ReferenceSettings settings = hard(1.0);
	settings.rays = 16;
	const double steps = GENERATE(0.0, 65535.0, 16777215.0);
	CAPTURE(steps);
	Image image{32, 24, {"N.X", "N.Y", "N.Z", "depth"}, {}, {}, {}};
	for (std::size_t i = 0; i < truth.depth.size(); ++i)
	{
		const ViewLine line = projector.lineOf({static_cast<double>(i % 32) + 0.5, static_cast<double>(i / 32) + 0.5});
		const double depth = std::min(static_cast<double>(truth.depth[i]), 1e9);
		const glm::dvec4 clip = truth.view.projection * glm::dvec4(line.at + depth * line.along, 1.0);
		const double device = std::min(0.5 * clip.z / clip.w + 0.5, 1.0);
		const glm::vec3 n = truth.normals[i];
		image.values.insert(image.values.end(), {n.x, n.y, n.z,
												 static_cast<float>(depth == 1e9   ? 1.0
																	: steps == 0.0 ? device
																				   : std::floor(device * steps + 0.5) / steps)});
	}
	const TemporaryFolder folder;
	writeFile(folder / "engine.exr", exrBytes(image));
	GBufferImport import;
	import.depth = DepthKind::device;
	import.projection = truth.view.projection;
	import.camera_from_world = truth.view.camera_from_world;
	const GBuffer gbuffer = readGBuffer(folder / "engine.exr", import);
	std::size_t open = 0;
	std::size_t seen = 0;
	for (const ReferenceValue& value : referenceOfGBuffer(&tracer, gbuffer, settings, {}))
	{
		seen += value.rays > 0 ? 1U : 0U;
		open += value.rays > 0 && value.visibility == 1.0 ? 1U : 0U;
	}
	CHECK(seen > 300);
	CHECK(open == seen);
}

TEST_CASE("reference: a depth that is no length is refused by its pixel", "[reference]")
{
	Level level = emptyLevel();
	addQuad(level, {-1.0, -1.0, -2.0}, {2.0, 0.0, 0.0}, {0.0, 2.0, 0.0});
	const Tracer tracer(level, {});
	View view{.projection = projectionOf({}, 1.0)};
	const float depth = GENERATE(1e-45F, 1e-13F, 1e13F, 1e30F);
	GBuffer gbuffer = castGBuffer(tracer, view, 4, 4, NormalKind::geometric, {});
	CHECK_NOTHROW(referenceOfGBuffer(&tracer, gbuffer, {}, {}));
	gbuffer.depth[4 * 3 + 1] = depth;
	CHECK(refusalBy([&] { referenceOfGBuffer(&tracer, gbuffer, {}, {}); }).starts_with("depth, pixel 1,3: found "));
}

TEST_CASE("reference: lists of points are read line by line", "[reference]")
{
	const std::string path = (std::filesystem::temp_directory_path() / "nook_points_test.csv").string();
	const auto parsed = [&](const std::string& text)
	{
		writeFile(path, text);
		return readPoints(path);
	};
	const auto failure = [&](const std::string& text)
	{
		return refusalBy([&] { parsed(text); });
	};
	const std::vector<ReferencePoint> points = parsed("# made by hand\nx, y, z, nx, ny, nz\r\n1,2,3, 0,0,2\r\n\n-1e2,.5,0,1,0,0");
	REQUIRE(points.size() == 2);
	CHECK(points[0].position == glm::dvec3(1.0, 2.0, 3.0));
	CHECK(points[0].normal == glm::dvec3(0.0, 0.0, 1.0));
	CHECK(points[1].position.x == -100.0);
	CHECK(failure("") != "");
	CHECK(failure("x,y,z,nx,ny,nz\n") != "");
	CHECK(failure("1,2,3,0,0\n").find(":1:") != std::string::npos);
	CHECK(failure("1,2,3,0,0,1,5\n") != "");
	CHECK(failure("1,2,3,0,0,1\n1,2,nan,0,0,1\n").find(":2:") != std::string::npos);
	CHECK(failure("1,2,3,0,0,0\n") != "");
	CHECK(failure("1,2,3,0,0,inf\n") != "");
	CHECK(failure("1,2,3,0,0,one\n") != "");
	std::filesystem::remove(path);
}
