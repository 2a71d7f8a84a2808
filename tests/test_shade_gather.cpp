// SPDX-License-Identifier: GPL-3.0-or-later
// The gather of five pixels for renderers that shade several samples per pixel, compared with visibility evaluated at each sample.
#include "small_views.h"
#include "testing.h"

#include "methods/block.h"
#include "pattern/recipe.h"
#include "shade/shade.h"

namespace
{

// Usual positions of four samples in a pixel, in pixels from its centre, x right, y down (Direct3D's standard pattern).
constexpr std::array<std::array<double, 2>, 4> kOffsets{{{-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}}};

// The view shifted by that many pixels.
View shifted(View view, double x_px, double y_px, int width, int height)
{
	view.projection[2][0] += 2.0 * x_px / width;
	view.projection[2][1] -= 2.0 * y_px / height;
	return view;
}

ShadeSamples manyLines()
{
	Recipe recipe{.domain = Domain::disk, .count = 64, .method = Method::vogel};
	return samplesOf(ShadeMethod::vo_line, {generatePattern(recipe)});
}

// Visibility of every pixel, ready for the gather.
struct Drawn
{
	explicit Drawn(const GBuffer& gbuffer, std::vector<float> visibility) : depths(finiteDepths(gbuffer))
	{
		plane.width = gbuffer.width_px;
		plane.height = gbuffer.height_px;
		plane.values = std::move(visibility);
		kernels.nook = blockOf(frameOf(gbuffer), {1, 1, {glm::vec4(0.0F)}}, {});
		kernels.depths = depths;
		kernels.normals = gbuffer.normals;
		kernels.cells = &plane;
	}
	Drawn& operator=(Drawn&&) = delete;

	std::vector<float> depths;
	PicturePlane plane;
	shade_kernels::Kernels kernels;
};

struct Errors
{
	double own = 0.0; // root mean square over the pixels' means of four samples
	double gathered = 0.0;
};

Errors errorsOf(const std::string& name, int width, int height)
{
	const Level level = builtinLevel(name);
	const Tracer tracer(level, {});
	const View view = viewOf(level.cameras[0], width, height);
	const ShadeSamples samples = manyLines();
	const auto visibility = [&](const GBuffer& gbuffer)
	{
		return shadeOnCpu(gbuffer, samples, {}, {2, {}}).visibility;
	};
	const GBuffer middles = castGBuffer(tracer, view, width, height, NormalKind::geometric, {});
	Drawn drawn(middles, visibility(middles));
	const std::size_t pixels = middles.depth.size();
	std::vector<Errors> sums(pixels);
	for (const std::array<double, 2>& offset : kOffsets)
	{
		const GBuffer own =
			castGBuffer(tracer, shifted(view, offset[0], offset[1], width, height), width, height, NormalKind::geometric, {});
		const std::vector<float> truth = visibility(own);
		shade_kernels::Kernels shading;
		shading.nook = blockOf(frameOf(own), samples, {});
		for (std::size_t i = 0; i < pixels; ++i)
		{
			if (std::isfinite(own.depth[i]))
			{
				const glm::ivec2 pixel(static_cast<int>(i) % width, static_cast<int>(i) / width);
				const float gathered = drawn.kernels.nookGather(pixel, shading.nookPosition(pixel, own.depth[i]), own.normals[i]);
				REQUIRE((gathered >= 0.0F && gathered <= 1.0F));
				sums[i].own += static_cast<double>(drawn.plane.values[i] - truth[i]) / 4.0;
				sums[i].gathered += static_cast<double>(gathered - truth[i]) / 4.0;
			}
		}
	}
	Errors errors;
	for (const Errors& sum : sums)
	{
		errors.own += sum.own * sum.own / static_cast<double>(pixels);
		errors.gathered += sum.gathered * sum.gathered / static_cast<double>(pixels);
	}
	return {std::sqrt(errors.own), std::sqrt(errors.gathered)};
}

} // namespace

TEST_CASE("shade gather: four samples a pixel, nearer to visibility at each than the pixel's own", "[shade]")
{
	const auto name = GENERATE(as<std::string>{}, "courtyard", "suburb", "cornell");
	const Errors errors = errorsOf(name, 160, 90);
	CAPTURE(name, errors.own, errors.gathered);
	WARN(name << ": RMSE of the pixel's own visibility " << errors.own << ", gathered " << errors.gathered);
	CHECK(errors.own > 0.005);
	CHECK(errors.gathered < 0.7 * errors.own);
}

TEST_CASE("shade gather: a sample takes the visibility of its own side of an edge", "[shade]")
{
	// A wall at depth 5, its right half 1 m nearer; each side has its own visibility, and the sky above both has 1.
	GBuffer gbuffer = planeAt(projectionOf(lensOf(60.0), 1.0), 16, 16, 0.0);
	std::vector<float> sides;
	for (std::size_t i = 0; i < gbuffer.depth.size(); ++i)
	{
		const bool sky = i < 4 * 16;
		gbuffer.depth[i] = sky ? std::numeric_limits<float>::infinity() : i % 16 < 8 ? 5.0F : 4.0F;
		gbuffer.normals[i] = sky ? glm::vec3(0.0F) : glm::vec3(0.0F, 0.0F, 1.0F);
		sides.push_back(sky ? 1.0F : i % 16 < 8 ? 0.25F : 0.75F);
	}
	Drawn drawn(gbuffer, sides);
	const glm::vec3 n(0.0F, 0.0F, 1.0F);
	for (int y = 4; y < 16; ++y)
	{
		for (const int x : {7, 8})
		{
			// Either surface may be visible in part of either pixel.
			CHECK(drawn.kernels.nookGather({x, y}, drawn.kernels.nookPosition({x, y}, 5.0F), n) == Approx(0.25).margin(1e-3));
			CHECK(drawn.kernels.nookGather({x, y}, drawn.kernels.nookPosition({x, y}, 4.0F), n) == Approx(0.75).margin(1e-3));
		}
	}
	CHECK(drawn.kernels.nookGather({3, 3}, drawn.kernels.nookPosition({3, 3}, 5.0F), n) == Approx(0.25).margin(1e-3)); // over sky
	CHECK(drawn.kernels.nookGather({3, 1}, drawn.kernels.nookPosition({3, 1}, 5.0F), n) == 1.0F); // all five are sky
	// Neither surface matches: takes the one nearer to the sample's plane.
	CHECK(drawn.kernels.nookGather({7, 9}, drawn.kernels.nookPosition({7, 9}, 4.1F), n) > 0.5F);
	CHECK(drawn.kernels.nookGather({8, 9}, drawn.kernels.nookPosition({8, 9}, 4.9F), n) < 0.5F);
}

TEST_CASE("shade gather: a constant stays a constant, at the picture's corners too", "[shade]")
{
	const GBuffer gbuffer = builtinView("cornell", 12, 9);
	Drawn drawn(gbuffer, std::vector<float>(12 * 9, 0.375F));
	for (int i = 0; i < 12 * 9; ++i)
	{
		const auto at = static_cast<std::size_t>(i);
		const glm::ivec2 pixel(i % 12, i / 12);
		REQUIRE(drawn.kernels.nookGather(pixel, drawn.kernels.nookPosition(pixel, drawn.depths[at]), gbuffer.normals[at]) ==
				Approx(0.375));
	}
}
