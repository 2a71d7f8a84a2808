// SPDX-License-Identifier: GPL-3.0-or-later
// A tree restricted to the reach of the rays compared with one of the whole level.
#include "core/random.h"
#include "scene/builtin.h"
#include "scene/reference.h"
#include "scene/tracer.h"

#include <catch2/catch.hpp>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <vector>

using namespace nook;

namespace
{

double distanceTo(const Bounds& box, glm::dvec3 point)
{
	return glm::length(point - glm::clamp(point, box.least, box.most));
}

} // namespace

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
	for (const char* const name : {"courtyard", "foliage"})
	{
		const Level level = builtinLevel(name);
		const Tracer whole(level, {});
		const GBuffer gbuffer = castGBuffer(whole, viewOf(level.cameras.front(), 48, 27), 48, 27, NormalKind::geometric, {});
		for (const double radius_m : {0.05, 1.5, 1e4})
		{
			for (const Falloff falloff : {Falloff::hard, Falloff::linear})
			{
				ReferenceSettings settings;
				settings.radius_m = radius_m;
				settings.falloff = falloff;
				settings.rays = 64;
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
		ReferenceSettings settings;
		settings.measure = ReferenceMeasure::hemisphere;
		CHECK(!reachOf(level, gbuffer, settings));
	}
}
