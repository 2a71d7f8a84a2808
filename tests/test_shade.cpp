// SPDX-License-Identifier: GPL-3.0-or-later
// Screen-space methods compared with planes and closed forms, and the CPU with OpenGL.
#include "picture_errors.h"
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "pattern/recipe.h"
#include "pattern/tile.h"
#include "scene/reference.h"
#include "shade/shade.h"

namespace
{

constexpr std::array kMethods{ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::alchemy};

} // namespace

TEST_CASE("shade: an open plane reads 1 at any slope, field of view and projection", "[shade]")
{
	for (const ShadeMethod method : kMethods)
	{
		const ShadeSamples samples = samplesFor(method, 9);
		ShadeSettings settings;
		settings.method = method;
		settings.beta = 0.0;
		for (const double fov : {0.0, 30.0, 60.0, 100.0})
		{
			for (const double tilt : {0.0, 30.0, 60.0, 80.0})
			{
				const GBuffer gbuffer = planeAt(projectionOf(lensOf(fov), 16.0 / 9.0), 96, 54, tilt);
				float least = 1.0F;
				for (const float v : shadeOnCpu(gbuffer, samples, settings, {}).visibility)
				{
					least = std::min(least, v);
					REQUIRE(v <= 1.0F);
				}
				CAPTURE(static_cast<int>(method), fov, tilt);
				CHECK(least >= 1.0F - 1.0F / 255.0F);
			}
		}
	}
}

TEST_CASE("shade: without the normal an open plane across the view reads 1/2", "[shade]")
{
	for (const ShadeMethod method : {ShadeMethod::vo_line, ShadeMethod::vo_point})
	{
		ShadeSettings settings;
		settings.method = method;
		settings.use_normal = false;
		const GBuffer gbuffer = planeAt(projectionOf(lensOf(0.0), 1.0), 65, 65, 0.0);
		const float v = shadeOnCpu(gbuffer, samplesFor(method, 64), settings, {}).visibility[32 * 65 + 32];
		CHECK(v == Approx(0.5).margin(0.03));
	}
}

TEST_CASE("shade: lines and points approach the depth buffer's open share", "[shade]")
{
	const GBuffer gbuffer = builtinView("cornell", 160, 90);
	ReferenceSettings truth{.measure = ReferenceMeasure::hemisphere, .source = MatterSource::depth, .radius_m = 0.5, .rays = 512};
	const std::vector<ReferenceValue> reference = referenceOfGBuffer(nullptr, gbuffer, truth, {2, {}});
	for (const ShadeMethod method : {ShadeMethod::vo_line, ShadeMethod::vo_point})
	{
		double last = 1.0;
		for (const int count : {4, 16, 64})
		{
			ShadeSettings settings;
			settings.method = method;
			const std::vector<float> visibility = shadeOnCpu(gbuffer, samplesFor(method, count), settings, {}).visibility;
			const double rmse = rmseOf(visibility, reference);
			CAPTURE(static_cast<int>(method), count, rmse, last);
			CHECK(rmse < last);
			last = rmse;
		}
		CHECK(last < 0.08);
	}
}

TEST_CASE("shade: the same picture through other projections of the same view", "[shade]")
{
	const Level level = builtinLevel("cornell");
	const Tracer tracer(level, {});
	const View plain = viewOf(level.cameras[0], 64, 64);
	const auto shaded = [&](const glm::dmat4& projection)
	{
		const GBuffer gbuffer = castGBuffer(tracer, {plain.camera_from_world, projection}, 64, 64, NormalKind::geometric, {});
		return shadeOnCpu(gbuffer, samplesFor(ShadeMethod::vo_line, 9), {}, {}).visibility;
	};
	glm::dmat4 reversed = plain.projection;
	reversed[2][2] = 0.0; // infinite and reversed: z from 1 at the near plane to 0
	reversed[3][2] = 0.1;
	const std::vector<float> a = shaded(plain.projection);
	const std::vector<float> b = shaded(reversed);
	for (std::size_t i = 0; i < a.size(); ++i)
	{
		REQUIRE(a[i] == b[i]); // neither rays nor kernels use the z row
	}
	glm::dmat4 skewed = plain.projection;
	skewed[1][0] = 0.1;
	CHECK_THROWS_AS(shaded(skewed), Error);
}

TEST_CASE("shade: OpenGL agrees with the CPU", "[shade]")
{
	for (const std::string name : {"courtyard", "suburb", "nulls"})
	{
		const GBuffer gbuffer = builtinView(name, 160, 90);
		for (const ShadeMethod method : kMethods)
		{
			Recipe recipe{.domain = domainOf(method), .count = 9, .starts = 2};
			TileRecipe tile{.kind = TileKind::random};
			const ShadeSamples samples = samplesOf(method, generateTile(generatePattern(recipe), tile, {}).variants);
			ShadeSettings settings;
			settings.method = method;
			const Shaded cpu = shadeOnCpu(gbuffer, samples, settings, {2, {}});
			const Shaded gl = shadeOnGl(gbuffer, samples, settings);
			CHECK(gl.renderer.find("OpenGL") != std::string::npos);
			CAPTURE(name, static_cast<int>(method), gl.renderer);
			checkSamePicture(cpu.visibility, gl.visibility);
		}
	}
}
