// SPDX-License-Identifier: GPL-3.0-or-later
// Statistical volumetric obscurance: its tables compared with 64-bit sums, planes, closed forms, and the CPU with OpenGL.
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "scene/reference.h"

namespace
{

ShadeSettings uniform(int layers, int cell_px = 1, bool quadrants = false)
{
	ShadeSettings settings = statVo(layers, cell_px, quadrants);
	settings.statvo.layering = StatVoLayering::uniform;
	return settings;
}

ShadeSettings unskipped(ShadeSettings settings)
{
	settings.statvo.skip = false;
	return settings;
}

// Seen from above through a parallel projection, one pixel per centimetre: heights in metres above a ground 5 m away.
GBuffer heights(int width, int height, const std::function<double(int, int)>& at)
{
	Lens lens{.orthographic = true, .half_height_m = 0.005 * height, .far_m = 100.0};
	const glm::dmat4 projection = projectionOf(lens, static_cast<double>(width) / height);
	GBuffer gbuffer{width, height, {glm::dmat4(1.0), projection}, 0.0, {}, {}};
	for (int y = 0; y < height; ++y)
	{
		for (int x = 0; x < width; ++x)
		{
			gbuffer.depth.push_back(static_cast<float>(5.0 - at(x, y)));
			gbuffer.normals.emplace_back(0.0F, 0.0F, 1.0F);
		}
	}
	return gbuffer;
}

double meanOf(const std::vector<float>& values)
{
	const double sum = sumOver(values, [](const float value) { return static_cast<double>(value); });
	return sum / static_cast<double>(values.size());
}

} // namespace

TEST_CASE("statvo: an open plane reads 1 at any slope, field of view, projection, layering and table", "[shade][statvo]")
{
	checkOpen(visibilityOf(eachPlane(96, 54), GENERATE(statVo(1), statVo(2), statVo(4), statVo(4, 2), statVo(4, 4, true),
													   statVo(1, 1, true), uniform(16), unskipped(statVo(4, 1, true)))));
}

TEST_CASE("statvo: without the normal an open plane across the view reads 1/2", "[shade][statvo]")
{
	for (ShadeSettings settings : {statVo(1), statVo(4), uniform(8), statVo(2, 2, true)})
	{
		settings.use_normal = false;
		for (const float v : visibilityOf(planeAt(projectionOf(lensOf(0.0), 1.0), 65, 65, 0.0), settings))
		{
			REQUIRE(v == Approx(0.5F).margin(1e-5));
		}
	}
}

TEST_CASE("statvo: where all heights are in the box, without the normal, it is the depth buffer's open share of the box",
		  "[shade][statvo]")
{
	const GBuffer gbuffer = heights(96, 64, [](int x, int y) { return 0.1 * std::sin(0.11 * x) * std::cos(0.17 * y) + 0.002 * x; });
	ReferenceSettings truth{.measure = ReferenceMeasure::box, .source = MatterSource::depth, .radius_m = 0.2, .rays = 2048};
	const std::vector<ReferenceValue> reference = referenceOfGBuffer(nullptr, gbuffer, truth, {2, {}});
	for (ShadeSettings settings : {statVo(1), statVo(4), uniform(32), statVo(4, 4)})
	{
		settings.radius_m = 0.2;
		settings.use_normal = false;
		const std::vector<float> visibility = visibilityOf(gbuffer, settings);
		double squares = 0.0;
		int count = 0;
		for (int y = 21; y < 64 - 21; ++y)
		{
			for (int x = 21; x < 96 - 21; ++x)
			{
				const auto i = static_cast<std::size_t>(y * 96 + x);
				const double error = static_cast<double>(visibility[i]) - reference[i].visibility;
				squares += error * error;
				count += 1;
			}
		}
		CAPTURE(settings.statvo.layers, settings.statvo.cell_px);
		CHECK(std::sqrt(squares / count) < 0.01); // 2048 points account for 0.003 to 0.01 in a jittered box
	}
}

TEST_CASE("statvo: a step beside a pit is seen by quadrants", "[shade][statvo]")
{
	// From the centre of 20 x 20 cm: on the left 4 cm up, on the right 50 cm down. The single mean is below the ground.
	const GBuffer gbuffer = heights(61, 61, [](int x, int) { return x < 30 ? 0.04 : x > 30 ? -0.5 : 0.0; });
	ShadeSettings settings = statVo(1);
	settings.radius_m = 0.1;
	CHECK(visibilityOf(gbuffer, settings)[30 * 61 + 30] == 1.0F);
	settings.statvo.quadrants = true;
	CHECK(visibilityOf(gbuffer, settings)[30 * 61 + 30] == Approx(1.0 - 0.5 * 0.4).margin(0.01));
	// Layers separate them: 10 of 21 columns are up.
	CHECK(visibilityOf(gbuffer, statVo(4))[30 * 61 + 30] == Approx(1.0F).margin(0.5));
	settings = statVo(4);
	settings.radius_m = 0.1;
	CHECK(visibilityOf(gbuffer, settings)[30 * 61 + 30] == Approx(1.0 - 0.4 * 10.0 / 21.0).margin(0.01));
}

TEST_CASE("statvo: psi rises to 1 at the box's height and falls with the slope above", "[shade][statvo]")
{
	// A pixel deep in a shaft: all others are `up` higher, so their mean is about `up`.
	const double slope = GENERATE(0.5, 1.0, 4.0);
	const double up = GENERATE(0.02, 0.08, 0.1, 0.12, 0.15, 0.4);
	const GBuffer gbuffer = heights(61, 61, [up](int x, int y) { return x == 30 && y == 30 ? 0.0 : up; });
	ShadeSettings settings = statVo(1);
	settings.radius_m = 0.2;
	settings.statvo.height = 0.5;
	settings.statvo.slope = slope;
	const double t = up * (41.0 * 41.0 - 1.0) / (41.0 * 41.0) / 0.1;
	const double expected = 1.0 - (t <= 1.0 ? t : std::max(0.0, 1.0 - slope * (t - 1.0)));
	CAPTURE(slope, up);
	CHECK(visibilityOf(gbuffer, settings)[30 * 61 + 30] == Approx(expected).margin(1e-4));
}

TEST_CASE("statvo: a plate far in front of a wall darkens it by one layer, and not by four", "[shade][statvo]")
{
	const GBuffer gbuffer = heights(120, 80, [](int x, int) { return x < 60 ? 0.3 : 0.0; });
	std::vector<double> darkness;
	for (ShadeSettings settings : {statVo(1), statVo(2), statVo(4), uniform(16)})
	{
		settings.radius_m = 0.1;
		darkness.push_back(1.0 - meanOf(visibilityOf(gbuffer, settings)));
	}
	CAPTURE(darkness[0], darkness[1], darkness[2], darkness[3]);
	CHECK(darkness[0] > 0.02);
	CHECK(darkness[1] < 0.1 * darkness[0]);
	CHECK(darkness[2] < 0.1 * darkness[0]);
	CHECK(darkness[3] < 0.1 * darkness[0]);
}

TEST_CASE("statvo: sky is in no table, and open", "[shade][statvo]")
{
	constexpr float kSky = std::numeric_limits<float>::infinity();
	GBuffer gbuffer = heights(40, 30, [](int x, int) { return x < 20 ? 0.05 : 0.0; });
	ShadeSettings settings = statVo(4);
	settings.radius_m = 0.1;
	const std::vector<float> whole = visibilityOf(gbuffer, settings);
	for (int i = 0; i < 30 * 40; ++i)
	{
		if (i % 40 >= 21) // all of the ground except its first column
		{
			gbuffer.depth[static_cast<std::size_t>(i)] = kSky;
		}
	}
	for (const bool quadrants : {false, true})
	{
		settings.statvo.quadrants = quadrants;
		const std::vector<float> cut = visibilityOf(gbuffer, settings);
		CHECK(cut[15 * 40 + 30] == 1.0F);
		// Ten of 21 columns are 5 cm up; the others are at height 0 or open.
		CHECK(cut[15 * 40 + 20] == Approx(1.0 - 0.5 * (quadrants ? 0.5 : 10.0 / 21.0)).margin(0.01));
	}
	CHECK(whole[15 * 40 + 20] == Approx(1.0 - 0.5 * 10.0 / 21.0).margin(0.01));
	gbuffer.depth.assign(gbuffer.depth.size(), kSky);
	CHECK(meanOf(visibilityOf(gbuffer, settings)) == 1.0);
	gbuffer.depth[615] = 2.0F; // isolated
	CHECK(meanOf(visibilityOf(gbuffer, settings)) == 1.0);
}

TEST_CASE("statvo: a box counts all layers where more of them fit into it than integers count", "[shade][statvo]")
{
	// Two depths that differ by one float step, in the first and the last layer; 1/2 without the normal.
	const GBuffer gbuffer = heights(32, 32, [](int x, int y) { return (x + y) % 2 == 0 ? 0.0 : -0x1p-21; });
	ShadeSettings settings = unskipped(uniform(64));
	settings.use_normal = false;
	settings.statvo.height = 100.0;
	for (const float value : visibilityOf(gbuffer, settings))
	{
		CHECK(value == Approx(0.5).margin(0.01));
	}
}
