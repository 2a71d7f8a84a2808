// SPDX-License-Identifier: GPL-3.0-or-later
// Probes compared with closed forms and with rays.
#include "bake_levels.h"

#include "bake/probes.h"
#include "core/error.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace nook;
using namespace nook::test;

TEST_CASE("bake: probes over a plane read the half of the sphere that is open, as the normal turns", "[bake]")
{
	Level level = emptyLevel();
	addFloor(level, {-50.0, 0.0, -50.0}, 100.0, 2);
	addQuad(level, {-0.1, 2.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.1, 0.0}); // makes the grid extend above
	const Tracer tracer(level, {});
	BakeSettings settings = within(std::numeric_limits<double>::infinity());
	settings.rays = 1536;
	const ProbeGrid grid = bakeProbes(tracer, 1.0, settings, {});
	// Occlusion of a plane from above, by the normal's angle to it: (1 − cos)/2.
	CHECK(std::fabs(visibilityAt(grid, {0.3, 1.2, 0.1}, {0.0, 1.0, 0.0}) - 1.0) < 0.02);
	CHECK(std::fabs(visibilityAt(grid, {0.3, 1.2, 0.1}, {1.0, 0.0, 0.0}) - 0.5) < 0.02);
	CHECK(std::fabs(visibilityAt(grid, {0.3, 1.2, 0.1}, {0.6, -0.8, 0.0}) - 0.1) < 0.02);
	CHECK(std::fabs(visibilityAt(grid, {0.3, 1.2, 0.1}, {0.0, -1.0, 0.0})) < 0.02);
}

TEST_CASE("bake: probes agree with rays in the open, and those inside matter do not count", "[bake]")
{
	Level level = emptyLevel();
	addBox(level, {-3.0, -1.0, -3.0}, {3.0, 0.0, 3.0});
	addBox(level, {-1.0, 0.0, -1.0}, {1.0, 2.0, 1.0});
	const Tracer tracer(level, {});
	BakeSettings settings = within(1.0);
	settings.rays = 600;
	const ProbeGrid grid = bakeProbes(tracer, 0.5, settings, {1, {}});
	CHECK(grid.count == glm::ivec3(12, 6, 12));
	CHECK(grid.buried == 12 * 2 * 12 + 4 * 4 * 4);
	const BakeCheck check = checkProbes(tracer, grid, settings, 1000, {});
	CAPTURE(check.rmse, check.bias);
	CHECK(check.rmse < 0.1);
	CHECK(std::fabs(check.bias) < 0.03);
	CHECK(bakeProbes(tracer, 0.5, settings, {2, {}}).texels == grid.texels);
	// Next to the box, where half of the surrounding probes are inside it.
	CHECK(std::fabs(visibilityAt(grid, {1.05, 1.0, 0.0}, {1.0, 0.0, 0.0}) - 1.0) < 0.15);
	// In the middle of matter nothing is known.
	CHECK(visibilityAt(grid, {0.0, 1.0, 0.0}, {0.0, 1.0, 0.0}) == 1.0);
	CHECK_THROWS_AS(bakeProbes(tracer, 0.001, settings, {}), Error);
	CHECK_THROWS_AS(bakeProbes(tracer, 0.01, settings, {}), Error);
	CHECK(bakeProbes(tracer, 1e6, settings, {}).texels.size() == 1);
}
