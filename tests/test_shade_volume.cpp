// SPDX-License-Identifier: GPL-3.0-or-later
// Volumetric obscurance with further features: areas, thickness, falloff, two radii, pairs, bands.
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "pattern/tile.h"
#include "scene/reference.h"

namespace
{

Recipe diskRecipe(int count, bool symmetric = false)
{
	Recipe recipe{.domain = Domain::disk, .count = count, .symmetric = symmetric, .starts = 2};
	return recipe;
}

// Quick to make.
Pattern many(Domain domain)
{
	Recipe recipe{.domain = domain, .count = 512, .method = Method::vogel};
	return generatePattern(recipe);
}

// Numerical integral of the falloff over the open part of a line.
double openBySteps(double reach, double end, double front, double thick, bool quadratic)
{
	const int steps = 20000;
	double sum = 0.0;
	for (int i = 0; i < steps; ++i)
	{
		const double z = -reach + (end + reach) * (i + 0.5) / steps;
		const bool open = z < front || (thick > 0.0 && z > front + thick);
		sum += open ? (quadratic ? reach * reach - z * z : 1.0) : 0.0;
	}
	return sum * (end + reach) / steps;
}

} // namespace

TEST_CASE("shade: the open part of a line, with falloff and thickness, is its integral", "[shade]")
{
	Random random(7);
	shade_kernels::Kernels kernels;
	for (int i = 0; i < 200; ++i)
	{
		const double reach = random.uniform();
		const double end = reach * (2.0 * random.uniform() - 1.0);
		const double front = 3.0 * random.uniform() - 1.5;
		const double thick = i % 2 == 0 ? 0.0 : random.uniform();
		const bool quadratic = i % 4 < 2;
		kernels.nook.quadratic = quadratic ? 1 : 0;
		kernels.nook.thick = thick > 0.0 ? 1 : 0;
		const auto place = [reach](double along)
		{
			return static_cast<float>(0.5 + 0.5 * along / reach);
		};
		const float covered = kernels.nookCoveredShare(place(end), place(front), thick > 0.0 ? place(front + thick) : 1.0F);
		const double open =
			static_cast<double>(kernels.nookAlong(place(end)) - covered) * openBySteps(reach, reach, reach, 0.0, quadratic);
		CAPTURE(reach, end, front, thick, quadratic);
		CHECK(open == Approx(openBySteps(reach, end, front, thick, quadratic)).margin(3e-4));
	}
}

TEST_CASE("shade: the ramp of an area is the mean over its depths, also of a single depth", "[shade]")
{
	Random random(11);
	shade_kernels::Kernels kernels;
	for (int i = 0; i < 100; ++i)
	{
		const double reach = random.uniform();
		const double end = reach * (2.0 * random.uniform() - 1.0);
		const double front = 3.0 * random.uniform() - 1.5;
		const bool perspective = i % 2 == 0;
		const bool quadratic = i % 4 < 2;
		kernels.nook.w_slope = perspective ? 1.0F : 0.0F;
		kernels.nook.w_start = perspective ? 0.0F : 1.0F;
		kernels.nook.quadratic = quadratic ? 1 : 0;
		const float depth = 20.0F;
		const float even = kernels.nookEven(depth + static_cast<float>(front));
		const float spread = (i % 5 == 0 ? 1e-5F : static_cast<float>(random.uniform())) * (perspective ? 1.0F / 400.0F : 1.0F);
		const float share = static_cast<float>(0.5 / reach);
		const float place = static_cast<float>(0.5 + 0.5 * end / reach);
		double mean = 0.0;
		for (int k = 0; k < 400; ++k)
		{
			const float there = kernels.nookUneven(even + spread * static_cast<float>(2.0 * (k + 0.5) / 400.0 - 1.0));
			mean += static_cast<double>(kernels.nookCoveredShare(place, 0.5F + share * (there - depth), 1.0F)) / 400.0;
		}
		const float covered = kernels.nookCoveredRamp(place, kernels.nookRamp(even, spread, depth, share));
		CAPTURE(reach, end, front, spread, quadratic, perspective);
		CHECK(static_cast<double>(covered) == Approx(mean).margin(3e-3));
	}
}

TEST_CASE("shade: moments of depth keep their digits far away, and never a negative variance", "[shade]")
{
	Random random(3);
	shade_kernels::Kernels kernels;
	for (int i = 0; i < 100; ++i)
	{
		const double base = 1e4 * random.uniform();
		std::array<glm::vec4, 4> four{};
		double sum = 0.0;
		for (glm::vec4& one : four)
		{
			one = {static_cast<float>(base + 0.1 * random.uniform()), 0.0F, 1.0F, 1.0F};
			sum += static_cast<double>(one.x);
		}
		four[3].z = i % 2 == 0 ? 1.0F : 0.0F; // sky
		const int count = i % 2 == 0 ? 4 : 3;
		sum -= i % 2 == 0 ? 0.0 : static_cast<double>(four[3].x);
		double squares = 0.0;
		for (int k = 0; k < count; ++k)
		{
			squares += std::pow(static_cast<double>(four[static_cast<std::size_t>(k)].x) - sum / count, 2.0);
		}
		const glm::vec4 all = kernels.nookJoined(kernels.nookJoined(four[0], four[1]), kernels.nookJoined(four[2], four[3]));
		CHECK(static_cast<double>(all.x) == Approx(sum / count).epsilon(3e-7));
		CHECK(static_cast<double>(all.y) == Approx(squares / count).margin(2.0 * base * 1e-7 * std::sqrt(squares / count)));
		CHECK(all.z == static_cast<float>(count));
		CHECK(all.w == 4.0F);
		CHECK(all.y >= 0.0F);
	}
}

TEST_CASE("shade: areas read 1 on an open plane", "[shade]")
{
	ShadeSettings settings = settingsFor(ShadeMethod::vo_area);
	checkOpen(visibilityOf(eachPlane(96, 54), samplesOf(settings.method, {generatePattern(diskRecipe(9))}), settings));
}

TEST_CASE("shade: areas come closer to the depth buffer's open share than few lines", "[shade]")
{
	const GBuffer gbuffer = builtinView("courtyard", 192, 108);
	ReferenceSettings truth{.measure = ReferenceMeasure::hemisphere, .source = MatterSource::depth, .radius_m = 1.0, .rays = 256};
	const std::vector<ReferenceValue> reference = referenceOfGBuffer(nullptr, gbuffer, truth, {2, {}});
	const std::vector<Pattern> five{generatePattern(diskRecipe(5))};
	const auto errorOf = [&](ShadeMethod method)
	{
		return rmseOf(reference, visibilityOf(gbuffer, samplesOf(method, five), settingsFor(method, 1.0)));
	};
	const double area_error = errorOf(ShadeMethod::vo_area);
	const double line_error = errorOf(ShadeMethod::vo_line);
	CAPTURE(area_error, line_error);
	CHECK(area_error < 0.95 * line_error);
}

TEST_CASE("shade: pairs take the halo from what is far in front, and nothing from a plane", "[shade]")
{
	const ShadeSamples samples = samplesOf(ShadeMethod::vo_line, {pairedPattern(generatePattern(diskRecipe(16, true)))});
	ShadeSettings settings;
	ShadeSettings paired;
	paired.volume.paired = true;
	const std::size_t beside = 32 * 64 + 30; // two pixels from the edge, on the far wall
	const GBuffer walls = stepOf(64, 2.0);
	const float halo = visibilityOf(walls, samples, settings)[beside];
	CHECK(halo < 0.75F);
	CHECK(visibilityOf(walls, samples, paired)[beside] == Approx(1.0F).margin(1e-5));
	// Surfaces in range darken as before.
	const GBuffer step = stepOf(64, 0.4);
	CHECK(visibilityOf(step, samples, paired)[beside] == visibilityOf(step, samples, settings)[beside]);
	for (const bool use_normal : {true, false})
	{
		settings.use_normal = use_normal;
		paired.use_normal = use_normal;
		const GBuffer plane = planeAt(projectionOf(lensOf(use_normal ? 60.0 : 0.0), 1.0), 64, 64, 75.0);
		const std::vector<float> without = visibilityOf(plane, samples, settings);
		const std::vector<float> with = visibilityOf(plane, samples, paired);
		for (std::size_t i = 0; i < with.size(); ++i)
		{
			// At the border the neighbours on one side are border pixels.
			const bool inside = i % 64 >= 8 && i % 64 < 56 && i / 64 >= 8 && i / 64 < 56;
			REQUIRE((!inside || with[i] == Approx(without[i]).margin(1e-5)));
		}
	}
	CHECK_THROWS_AS(pairedPattern(generatePattern(diskRecipe(8))), Error);
}

TEST_CASE("shade: thickness opens what lies behind a thin surface in front", "[shade]")
{
	const ShadeSamples samples = samplesOf(ShadeMethod::vo_line, {generatePattern(diskRecipe(16))});
	const GBuffer walls = stepOf(64, 2.0);
	const std::size_t beside = 32 * 64 + 30;
	ShadeSettings settings;
	const float endless = visibilityOf(walls, samples, settings)[beside];
	settings.volume.thickness_m = 0.25;
	CHECK(visibilityOf(walls, samples, settings)[beside] == 1.0F);
	CHECK(endless < 0.75F);
	// Points agree with many lines if a thin step is inside the ball.
	const GBuffer step = stepOf(64, 0.3);
	settings.volume.thickness_m = 0.1;
	const float lines = visibilityOf(step, samplesOf(ShadeMethod::vo_line, {many(Domain::disk)}), settings)[beside];
	settings.method = ShadeMethod::vo_point;
	const float points = visibilityOf(step, samplesOf(ShadeMethod::vo_point, {many(Domain::ball)}), settings)[beside];
	CHECK(points == Approx(lines).margin(0.04));
	CHECK(lines < 0.99F);
}

TEST_CASE("shade: two radii are the product or the lesser of one radius each", "[shade]")
{
	const GBuffer gbuffer = builtinView("cornell", 48, 48);
	const ShadeMethod method = GENERATE(ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::vo_area);
	Recipe recipe = diskRecipe(9);
	recipe.domain = domainOf(method);
	const ShadeSamples samples = samplesOf(method, {generatePattern(recipe)});
	ShadeSettings settings = settingsFor(method, 0.2);
	const std::vector<float> small = visibilityOf(gbuffer, samples, settings);
	settings.radius_m = 0.6;
	const std::vector<float> large = visibilityOf(gbuffer, samples, settings);
	settings.volume.second_radius_m = 0.2;
	settings.volume.radii = TwoRadii::product;
	const std::vector<float> product = visibilityOf(gbuffer, samples, settings);
	settings.volume.radii = TwoRadii::minimum;
	const std::vector<float> minimum = visibilityOf(gbuffer, samples, settings);
	for (std::size_t i = 0; i < small.size(); ++i)
	{
		REQUIRE(product[i] == Approx(small[i] * large[i]).margin(1e-6));
		REQUIRE(minimum[i] == std::min(small[i], large[i]));
	}
}

TEST_CASE("shade: bands take the first samples of a pattern where the radius is small", "[shade]")
{
	Recipe recipe = diskRecipe(9);
	recipe.order = Order::progressive;
	const Pattern pattern = generatePattern(recipe);
	const GBuffer gbuffer = builtinView("cornell", 48, 48);
	ShadeSettings settings;
	settings.bands = {3, 1e3, 2e3};
	const std::vector<float> banded = visibilityOf(gbuffer, samplesOf(ShadeMethod::vo_line, {pattern}), settings);
	Pattern first;
	for (std::size_t i = 0; i < 3; ++i)
	{
		first.points.push_back(pattern.points[i]);
		first.weights.push_back(pattern.weights[i]);
	}
	const std::vector<float> three = visibilityOf(gbuffer, samplesOf(ShadeMethod::vo_line, {first}), {});
	settings.bands = {3, 1.0, 2.0};
	const std::vector<float> all = visibilityOf(gbuffer, samplesOf(ShadeMethod::vo_line, {pattern}), settings);
	const std::vector<float> nine = visibilityOf(gbuffer, samplesOf(ShadeMethod::vo_line, {pattern}), {});
	for (std::size_t i = 0; i < banded.size(); ++i)
	{
		REQUIRE(banded[i] == three[i]);
		REQUIRE(all[i] == nine[i]);
	}
	CHECK(three != nine);
}

TEST_CASE("shade: OpenGL agrees with the CPU on every feature of volumetric obscurance", "[shade]")
{
	const GBuffer gbuffer = builtinView("suburb", 160, 90);
	TileRecipe random;
	random.kind = TileKind::random;
	const ShadeMethod method = GENERATE(ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::vo_area);
	Recipe recipe = diskRecipe(8, method != ShadeMethod::vo_point);
	recipe.domain = domainOf(method);
	std::vector<Pattern> variants = generateTile(generatePattern(recipe), random, {}).variants;
	for (const int feature : {0, 1, 2, 3})
	{
		ShadeSettings settings = settingsFor(method, 1.0);
		settings.use_normal = feature != 3;
		settings.volume.thickness_m = feature == 1 ? 0.3 : 0.0;
		settings.volume.quadratic = feature == 2;
		settings.volume.radii = feature == 2 ? TwoRadii::product : TwoRadii::none;
		settings.volume.second_radius_m = 0.4;
		settings.volume.paired = feature == 3 && method != ShadeMethod::vo_point;
		std::vector<Pattern> own = variants;
		for (Pattern& one : own)
		{
			one = settings.volume.paired ? pairedPattern(one) : one;
		}
		const ShadeSamples samples = samplesOf(method, own);
		CAPTURE(feature);
		checkOnGl(gbuffer, samples, settings);
	}
}
