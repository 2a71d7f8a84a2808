// SPDX-License-Identifier: GPL-3.0-or-later
// Screen-space methods compared with planes and closed forms, and the CPU with OpenGL.
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "pattern/tile.h"
#include "scene/reference.h"

namespace
{

constexpr std::array kMethods{ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::alchemy};

} // namespace

TEST_CASE("shade: an open plane reads 1 at any slope, field of view and projection", "[shade]")
{
	const ShadeMethod method = GENERATE(from_range(kMethods));
	ShadeSettings settings = settingsFor(method);
	settings.beta = 0.0;
	checkOpen(visibilityOf(eachPlane(96, 54), samplesFor(method, 9), settings));
}

TEST_CASE("shade: without the normal an open plane across the view reads 1/2", "[shade]")
{
	const ShadeMethod method = GENERATE(ShadeMethod::vo_line, ShadeMethod::vo_point);
	ShadeSettings settings = settingsFor(method);
	settings.use_normal = false;
	const GBuffer gbuffer = planeAt(projectionOf(lensOf(0.0), 1.0), 65, 65, 0.0);
	CHECK(visibilityOf(gbuffer, samplesFor(method, 64), settings)[32 * 65 + 32] == Approx(0.5).margin(0.03));
}

TEST_CASE("shade: lines and points approach the depth buffer's open share", "[shade]")
{
	const GBuffer gbuffer = builtinView("cornell", 160, 90);
	ReferenceSettings truth{.measure = ReferenceMeasure::hemisphere, .source = MatterSource::depth, .radius_m = 0.5, .rays = 512};
	const std::vector<ReferenceValue> reference = referenceOfGBuffer(nullptr, gbuffer, truth, {2, {}});
	const ShadeMethod method = GENERATE(ShadeMethod::vo_line, ShadeMethod::vo_point);
	double last = 1.0;
	for (const int count : {4, 16, 64})
	{
		const double rmse = rmseOf(visibilityOf(gbuffer, samplesFor(method, count), settingsFor(method)), reference);
		CAPTURE(static_cast<int>(method), count, rmse, last);
		CHECK(rmse < last);
		last = rmse;
	}
	CHECK(last < 0.08);
}

TEST_CASE("shade: OpenGL agrees with the CPU", "[shade]")
{
	const auto name = GENERATE(as<std::string>{}, "courtyard", "suburb", "nulls");
	const ShadeMethod method = GENERATE(from_range(kMethods));
	Recipe recipe{.domain = domainOf(method), .count = 9, .starts = 2};
	TileRecipe tile{.kind = TileKind::random};
	const ShadeSamples samples = samplesOf(method, generateTile(generatePattern(recipe), tile, {}).variants);
	INFO(name);
	checkOnGl(builtinView(name, 160, 90), samples, settingsFor(method));
}
