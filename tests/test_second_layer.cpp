// SPDX-License-Identifier: GPL-3.0-or-later
// What two layers of depth could know: against the kernel of one, by rays, and where the second alone occludes.
#include "small_levels.h"
#include "small_views.h"

#include "error_report/second_layer.h"
#include "shade/shade.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace nook;
using namespace nook::test;

namespace
{

constexpr float kNone = std::numeric_limits<float>::infinity();

LayersSettings settingsOf(int slices, int steps, double radius_m)
{
	LayersSettings settings;
	settings.slices = slices;
	settings.steps = steps;
	settings.radius_m = radius_m;
	return settings;
}

} // namespace

TEST_CASE("second layer: without one it is the kernel, to the bit", "[report]")
{
	const GBuffer gbuffer = builtinView("courtyard", 96, 54);
	LayersSettings settings = settingsOf(3, 6, 1.2);
	settings.thickness = 0.65;
	ShadeSettings shade;
	shade.method = ShadeMethod::slices;
	shade.radius_m = 1.2;
	shade.slices = {3, 6, 0.65};
	const std::vector<float> second(gbuffer.depth.size(), kNone);
	CHECK(layersVisibility(gbuffer, second, settings, {2, {}}) ==
		  shadeOnCpu(gbuffer, ownSamples(shade), shade, {2, {}}).visibility);
	CHECK(layersVisibility(gbuffer, second, settings, {1, {}}) == layersVisibility(gbuffer, second, settings, {3, {}}));
}

TEST_CASE("second layer: behind a box are its back, and the floor that faces the camera", "[report]")
{
	Level level = emptyLevel();
	addBox(level, {-1.0, -1.0, 0.0}, {1.0, 1.0, 0.5});
	addBox(level, {-9.0, -9.0, -2.0}, {9.0, 9.0, -1.0});
	const Tracer tracer(level, {});
	LevelCamera camera;
	camera.world_from_camera = worldFromCamera({0.0, 0.0, 5.0}, {0.0, 0.0, 0.0});
	const GBuffer gbuffer = castGBuffer(tracer, viewOf(camera, 33, 33), 33, 33, NormalKind::geometric, {});
	const std::size_t middle = 16 * 33 + 16;
	CHECK(gbuffer.depth[middle] == Approx(4.5));
	CHECK(secondDepths(tracer, gbuffer, SecondSurface::any, {2, {}})[middle] == Approx(5.0));
	CHECK(secondDepths(tracer, gbuffer, SecondSurface::facing, {2, {}})[middle] == Approx(6.0));
	CHECK(secondDepths(tracer, gbuffer, SecondSurface::any, {2, {}})[0] == Approx(7.0));
	CHECK(secondDepths(tracer, gbuffer, SecondSurface::facing, {2, {}})[0] == kNone);
}

// Of a step that a sheet far in front of it hides, one layer sees the sheet alone, which is out of reach.
TEST_CASE("second layer: what a sheet hides darkens as if the sheet were not there", "[report]")
{
	const int size = 128;
	GBuffer plain{size, size, {glm::dmat4(1.0), projectionOf(lensOf(0.0), 1.0)}, 0.0, {}, {}};
	for (int i = 0; i < size * size; ++i)
	{
		plain.depth.push_back(i % size > 80 ? 9.6F : 10.0F);
		plain.normals.emplace_back(0.0F, 0.0F, 1.0F);
	}
	GBuffer hidden = plain;
	std::vector<float> second(plain.depth.size(), kNone);
	for (int i = 0; i < size * size; ++i)
	{
		const auto at = static_cast<std::size_t>(i);
		if (i % size > 80)
		{
			second[at] = plain.depth[at];
			hidden.depth[at] = 5.0F;
		}
	}
	const std::vector<float> none(plain.depth.size(), kNone);
	LayersSettings settings = settingsOf(8, 16, 1.0);
	settings.thickness = 0.5;
	settings.second_thickness = 0.5;
	const std::vector<float> open = layersVisibility(hidden, none, settings, {2, {}});
	const std::vector<float> both = layersVisibility(hidden, second, settings, {2, {}});
	const std::vector<float> without = layersVisibility(plain, none, settings, {2, {}});
	for (int x = 60; x <= 80; ++x)
	{
		const auto at = static_cast<std::size_t>(64 * size + x);
		CAPTURE(x);
		CHECK(open[at] == 1.0F);
		CHECK(both[at] == without[at]);
	}
	CHECK(without[64 * size + 79] < 0.8F);
}
