// SPDX-License-Identifier: GPL-3.0-or-later
// Rays compared with every triangle in double precision.
#include "small_levels.h"
#include "testing.h"

#include "scene/builtin.h"
#include "scene/level_glb.h"
#include "scene/ray_triangle.h"
#include "scene/reference.h"
#include "scene/sample_set.h"
#include "scene/tracer.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace
{

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

double distanceTo(const Bounds& box, glm::dvec3 point)
{
	return glm::length(point - glm::clamp(point, box.least, box.most));
}

} // namespace

TEST_CASE("tracer: hits lie on their triangle, at their distance", "[reference]")
{
	Level level = emptyLevel();
	addSphere(level, {0.3, 0.2, -0.1}, 1.0, 40, 60);
	const Tracer tracer(level, {});
	Random random(5);
	for (int i = 0; i < 20000; ++i)
	{
		const glm::dvec3 origin(3.0 * random.uniform() - 1.5, 3.0 * random.uniform() - 1.5, 3.0 + random.uniform());
		const glm::dvec3 direction(random.uniform() - 0.5, random.uniform() - 0.5, -1.0);
		const RayHit hit = tracer.nearest(origin, direction, kUnlimited);
		if (!hit.hit)
		{
			continue;
		}
		const glm::uvec3 corner = level.triangles[hit.triangle];
		const double b = hit.barycentric.x;
		const double c = hit.barycentric.y;
		const glm::dvec3 on_triangle =
			(1.0 - b - c) * level.positions[corner[0]] + b * level.positions[corner[1]] + c * level.positions[corner[2]];
		CHECK(std::min({b, c, 1.0 - b - c}) > -1e-4);
		REQUIRE(glm::length(origin + hit.distance * direction - on_triangle) < 1e-6);
		CHECK(hit.front);
	}
	CHECK(!tracer.nearest({0.0, 0.0, 5.0}, {0.0, 1.0, 0.0}, kUnlimited).hit);
	CHECK(!tracer.nearest({0.0, 0.0, 5.0}, {0.0, 0.0, -1.0}, 2.0).hit);
	CHECK(!tracer.nearest({0.3, 0.2, -0.1}, {0.0, 0.0, -1.0}, kUnlimited).front);
}

TEST_CASE("tracer: no distance is below zero, of points in a surface either", "[reference]")
{
	Level level = emptyLevel();
	addSphere(level, {300.0, 200.0, -100.0}, 50.0, 40, 60);
	const Tracer tracer(level, {});
	Random random(9);
	std::array<float, 64> x{};
	std::array<float, 64> y{};
	std::array<float, 64> z{};
	std::array<float, 64> distances{};
	int met = 0;
	for (const glm::uvec3& corner : level.triangles)
	{
		const glm::dvec3 a = level.positions[corner[0]];
		const glm::dvec3 origin = a + 0.3 * (level.positions[corner[1]] - a) + 0.3 * (level.positions[corner[2]] - a);
		for (std::size_t i = 0; i < x.size(); ++i)
		{
			x[i] = static_cast<float>(random.uniform() - 0.5);
			y[i] = static_cast<float>(random.uniform() - 0.5);
			z[i] = static_cast<float>(random.uniform() - 0.5);
		}
		tracer.distances(origin, {x, y, z}, 1.0F, distances);
		for (const float distance : distances)
		{
			REQUIRE(distance >= 0.0F);
			met += distance < 1.0F ? 1 : 0;
		}
	}
	CHECK(met > 0);
}

TEST_CASE("tracer: rays along edges meet what every triangle in double says", "[reference]")
{
	Random random(7);
	Level level = emptyLevel();
	const auto somewhere = [&](double size)
	{
		return size * (glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 0.5);
	};
	for (int i = 0; i < 60; ++i)
	{
		const glm::dvec3 middle = somewhere(20.0);
		const double size = std::pow(10.0, 2.0 * random.uniform() - 1.0);
		const uint32_t a = addVertex(level, middle + somewhere(size));
		const uint32_t b = addVertex(level, middle + somewhere(size));
		const uint32_t c = addVertex(level, middle + somewhere(size));
		addTriangle(level, a, b, c);
		addTriangle(level, c, b, addVertex(level, middle + somewhere(size)));
		if (i % 4 == 0)
		{
			addTriangle(level, b, a, c); // twice at one place
		}
	}
	addSphere(level, {1.0, 2.0, 3.0}, 2.0, 12, 16);
	const Tracer tracer(level, {});
	constexpr std::size_t kRays = 64;
	std::size_t compared = 0;
	std::size_t blocked_count = 0;
	for (int bundle = 0; bundle < 300; ++bundle)
	{
		const glm::dvec3 origin = somewhere(20.0);
		const auto reach = static_cast<float>(5.0 + 20.0 * random.uniform());
		std::array<float, kRays> x{};
		std::array<float, kRays> y{};
		std::array<float, kRays> z{};
		for (std::size_t i = 0; i < kRays; ++i)
		{
			const glm::uvec3 corner = level.triangles[random.below(static_cast<uint32_t>(level.triangles.size()))];
			const double share = i % 8 == 0 ? 0.0 : random.uniform();
			const glm::dvec3 on_edge = (1.0 - share) * level.positions[corner[0]] + share * level.positions[corner[1]];
			const glm::vec3 way(glm::normalize(on_edge - origin));
			x[i] = way.x;
			y[i] = way.y;
			z[i] = way.z;
		}
		std::array<uint8_t, kRays> blocked{};
		std::array<float, kRays> distances{};
		tracer.blocked(origin, {x, y, z}, reach, blocked);
		tracer.distances(origin, {x, y, z}, reach, distances);
		for (std::size_t i = 0; i < kRays; ++i)
		{
			double least = kUnlimited;
			bool grazes = false; // by less than six degrees, where enlarged triangles do not suffice
			for (uint32_t triangle = 0; triangle < level.triangles.size(); ++triangle)
			{
				const PlaneHit hit = meet(level, triangle, origin, glm::dvec3(glm::vec3(x[i], y[i], z[i])));
				least = isInside(hit) && hit.t <= static_cast<double>(reach) ? std::min(least, hit.t) : least;
				grazes = grazes || (std::fabs(hit.rise) < 0.1 && std::min({hit.b, hit.c, 1.0 - hit.b - hit.c}) > -0.1);
			}
			if (!grazes)
			{
				compared += 1;
				blocked_count += blocked[i];
				CHECK(blocked[i] == (least < kUnlimited ? 1 : 0));
				CHECK(distances[i] == static_cast<float>(least));
			}
		}
	}
	CHECK(compared > 300 * kRays / 2);
	CHECK(blocked_count > compared / 4);
}

// A tree restricted to the reach of the rays compared with one of the whole level.

TEST_CASE("vicinity: no box within reach of a point is left out, most of the others are", "[reference]")
{
	Random random(3);
	const auto somewhere = [&random](glm::dvec3 size)
	{
		return size * (glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 0.5);
	};
	for (const glm::dvec3 size : {glm::dvec3(40.0, 20.0, 30.0), glm::dvec3(1000.0, 0.0, 1000.0), glm::dvec3(0.0, 0.0, 0.0)})
	{
		for (const double reach_m : {0.01, 1.5, 4000.0})
		{
			const Bounds bounds{-0.5 * size, 0.5 * size};
			Vicinity vicinity(bounds, reach_m);
			std::vector<glm::dvec3> points;
			for (std::size_t i = 0; i < 40; ++i)
			{
				// Clustered, like the points that a camera sees; some outside the level.
				points.push_back(somewhere(0.2 * size) + 0.45 * size);
				vicinity.add(points.back());
			}
			vicinity.count();
			int far = 0;
			int left_out = 0;
			for (std::size_t i = 0; i < 2000; ++i)
			{
				const glm::dvec3 middle = i % 2 == 0 ? somewhere(0.9 * size) : glm::min(points[i % points.size()], bounds.most);
				const glm::dvec3 half = glm::abs(somewhere(glm::dvec3(0.05) * size));
				const Bounds box{glm::max(middle - half, bounds.least), glm::min(middle + half, bounds.most)};
				const double nearest = distanceTo(box, *std::min_element(points.begin(), points.end(),
																		 [&box](glm::dvec3 a, glm::dvec3 b)
																		 { return distanceTo(box, a) < distanceTo(box, b); }));
				const bool touches = vicinity.touches(box);
				CAPTURE(size.x, reach_m, nearest);
				if (nearest <= reach_m)
				{
					REQUIRE(touches);
				}
				const bool is_far = nearest > 3.0 * reach_m + 0.1 * size.x;
				far += is_far ? 1 : 0;
				left_out += is_far && !touches ? 1 : 0;
			}
			CHECK(left_out == far);
			CHECK((far > 400) == (reach_m < 100.0 && size.x > 0.0));
		}
	}
}

TEST_CASE("vicinity: the same visibility by a tree of what is near", "[reference]")
{
	const char* const name = GENERATE(as<const char*>{}, "courtyard", "foliage");
	const Level level = builtinLevel(name);
	const Tracer whole(level, {});
	const GBuffer gbuffer = castGBuffer(whole, viewOf(level.cameras.front(), 48, 27), 48, 27, NormalKind::geometric, {});
	for (const double radius_m : {0.05, 1.5, 1e4})
	{
		for (const Falloff falloff : {Falloff::hard, Falloff::linear})
		{
			ReferenceSettings settings{.falloff = falloff, .radius_m = radius_m, .rays = 64};
			const std::optional<Vicinity> reach = reachOf(level, gbuffer, settings);
			REQUIRE(reach);
			std::size_t kept = 0;
			for (std::size_t i = 0; i < level.triangles.size(); ++i)
			{
				kept += reach->touches(boundsOf(level, i)) ? 1U : 0U;
			}
			CHECK((kept < level.triangles.size()) == (radius_m < 1e4)); // otherwise the test is vacuous
			const Tracer near(level, {}, &*reach);
			CHECK(near.error() == whole.error());
			const std::vector<ReferenceValue> expected = referenceOfGBuffer(&whole, gbuffer, settings, {});
			const std::vector<ReferenceValue> found = referenceOfGBuffer(&near, gbuffer, settings, {});
			for (std::size_t i = 0; i < expected.size(); ++i)
			{
				REQUIRE(found[i].visibility == expected[i].visibility);
			}
		}
	}
	ReferenceSettings settings{.measure = ReferenceMeasure::hemisphere};
	CHECK(!reachOf(level, gbuffer, settings));
}

// Sample sets: their means, and the errors that they state.

TEST_CASE("samples: standard errors hold for half-spaces, in every domain", "[reference]")
{
	// Occupied where n·p > c; the truth is the mean of many placements. Compares errors over placements with the stated ones.
	const SampleDomain domain = GENERATE(SampleDomain::hemisphere, SampleDomain::ball, SampleDomain::box);
	const int count = GENERATE(16, 64, 256, 1024);
	const SampleSet set(domain, count);
	const auto n = static_cast<std::size_t>(count);
	std::vector<float> x(n);
	std::vector<float> y(n);
	std::vector<float> z(n);
	std::vector<float> values(n);
	Random random(2);
	double errors = 0.0;
	double stated = 0.0;
	for (int plane = 0; plane < 8; ++plane)
	{
		const double a = random.uniform() - 0.5;
		const double b = random.uniform() - 0.5;
		const double c = random.uniform() - 0.5;
		const glm::vec3 normal(glm::normalize(glm::dvec3(a, b, c)));
		const auto offset = static_cast<float>(0.8 * random.uniform() - 0.4);
		constexpr int kPlacements = 100;
		double sum = 0.0;
		double squares = 0.0;
		for (int p = 0; p < kPlacements; ++p)
		{
			set.place(random, x, y, z);
			double occupied = 0.0;
			for (std::size_t i = 0; i < n; ++i)
			{
				values[i] = normal.x * x[i] + normal.y * y[i] + normal.z * z[i] > offset ? 1.0F : 0.0F;
				occupied += static_cast<double>(values[i]) / count;
			}
			sum += occupied;
			squares += occupied * occupied;
			stated += set.squaredError(values);
		}
		errors += squares - sum * sum / kPlacements;
	}
	CAPTURE(static_cast<int>(domain), count, std::sqrt(errors / stated));
	CHECK(errors <= 1.2 * stated);
	CHECK(errors >= 0.1 * stated);
}

TEST_CASE("samples: every placement has the mean of its domain in expectation", "[reference]")
{
	const SampleDomain domain = GENERATE(SampleDomain::hemisphere, SampleDomain::ball, SampleDomain::box);
	const int count = GENERATE(1, 2, 5, 33);
	const SampleSet set(domain, count);
	Random random(11);
	const auto n = static_cast<std::size_t>(count);
	std::vector<float> x(n);
	std::vector<float> y(n);
	std::vector<float> z(n);
	double mean = 0.0;
	double first = 0.0;
	const int placements = 200000 / count;
	for (int p = 0; p < placements; ++p)
	{
		set.place(random, x, y, z);
		for (std::size_t i = 0; i < n; ++i)
		{
			mean += static_cast<double>(x[i] * x[i] + y[i] * y[i]) / (static_cast<double>(placements) * count);
			first += static_cast<double>(x[i]) / (static_cast<double>(placements) * count);
		}
	}
	const double expected = domain == SampleDomain::hemisphere ? 0.5 : domain == SampleDomain::ball ? 0.4 : 2.0 / 3.0;
	CAPTURE(static_cast<int>(domain), count);
	CHECK(mean == Approx(expected).margin(0.004));
	CHECK(std::fabs(first) < 0.006);
}

TEST_CASE("tracer: strays a thousand times as far away do not blur the rest", "[reference]")
{
	Level level = builtinLevel("courtyard");
	const Tracer before(level, {});
	const glm::dvec3 eye(0.3, 1.6, 0.2);
	const glm::dvec3 way(0.36, -0.48, 0.8);
	const RayHit hit = before.nearest(eye, way, 100.0);
	REQUIRE(hit.hit);
	const glm::dvec3 far(2e7, 3.0, 0.0);
	addQuad(level, far - glm::dvec3(0.0, 5.0, 5.0), {0.0, 10.0, 0.0}, {0.0, 0.0, 10.0});
	const Tracer after(level, {});
	CHECK(after.error() == before.error());
	CHECK(after.bounds().most.x == far.x);
	const RayHit again = after.nearest(eye, way, 100.0);
	CHECK(again.triangle == hit.triangle);
	CHECK(again.distance == hit.distance);
	const glm::dvec3 above(0.0, 200.0, 0.0);
	CHECK(after.nearest(above, glm::normalize(far - above), 3e7).triangle >= level.triangles.size() - 2);
	CHECK(glbOrigin(preciseBounds(level)) == glm::dvec3(0.0));
	// With as many triangles there as here, all is precise to the size of the whole.
	const std::size_t triangles = level.triangles.size();
	for (std::size_t i = 0; i < triangles; ++i)
	{
		const glm::uvec3 t = level.triangles[i];
		addTriangle(level, addVertex(level, far + level.positions[t.x]), addVertex(level, far + level.positions[t.y]),
					addVertex(level, far + level.positions[t.z]));
	}
	CHECK(preciseBounds(level).most.x > far.x);
}
