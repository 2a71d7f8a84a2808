// SPDX-License-Identifier: GPL-3.0-or-later
// Curves fitted to AOV eq. 14, including gradients.
#include "core/random.h"
#include "scene/builtin.h"
#include "volume/compensate.h"
#include "volume/occluders.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace nook;

namespace
{

// Sums with occlusions given by `of`, and neighbours whose sums differ slightly.
template <class Of> std::vector<TripleValues> triplesOf(Of&& of)
{
	Random random(1, 5);
	std::vector<TripleValues> triples(2000);
	for (TripleValues& triple : triples)
	{
		triple.there = {true, random.uniform() < 0.9, random.uniform() < 0.9};
		triple.sums[0] = random.uniform();
		for (std::size_t i = 0; i < 3; ++i)
		{
			triple.sums[i] = i == 0 ? triple.sums[0] : std::clamp(triple.sums[0] + 0.05 * (random.uniform() - 0.5), 0.0, 1.0);
			triple.occlusions[i] = of(triple.sums[i], random);
		}
	}
	return triples;
}

Compensation straight()
{
	Compensation curve;
	for (std::size_t i = 0; i < curve.occlusion.size(); ++i)
	{
		curve.occlusion[i] = static_cast<double>(i) / 32.0;
	}
	return curve;
}

} // namespace

TEST_CASE("compensation: eq. 14 of triples is 0 for the curve that they are made with, and is found from another", "[compensate]")
{
	const Compensation paper;
	const std::vector<TripleValues> triples = triplesOf([&](double sum, Random& /*random*/) { return paper.at(sum); });
	CHECK(pictureError(paper, triples) == Approx(0.0).margin(1e-12));
	const double before = pictureError(straight(), triples);
	CHECK(before > 0.1);
	const Compensation fitted = fitToPictures(straight(), triples);
	CHECK(pictureError(fitted, triples) < 0.1 * before);
	CHECK(std::is_sorted(fitted.occlusion.begin(), fitted.occlusion.end()));
	CHECK(fitted.occlusion[0] == 0.0);
	CHECK(fitted.at(0.5) == Approx(paper.at(0.5)).margin(0.02));
}

TEST_CASE("compensation: of two curves with the same values, the one with the steps of the picture", "[compensate]")
{
	// Values are all 0.3, but steps are half of the sums'. A step of eq. 14 counts as much as a value.
	std::vector<TripleValues> triples = triplesOf([](double /*sum*/, Random& /*random*/) { return 0.3; });
	for (TripleValues& triple : triples)
	{
		for (std::size_t i = 1; i < 3; ++i)
		{
			triple.occlusions[i] = triple.occlusions[0] + 0.5 * (triple.sums[i] - triple.sums[0]);
		}
	}
	const Compensation fitted = fitToPictures(straight(), triples);
	CHECK(pictureError(fitted, triples) < pictureError(straight(), triples));
	const double slope = (fitted.at(0.7) - fitted.at(0.3)) / 0.4;
	CHECK(slope > 0.1);
	CHECK(slope < 0.6);
}

TEST_CASE("compensation: by RMSE it is the values that count, not the steps", "[compensate]")
{
	std::vector<TripleValues> triples = triplesOf([](double sum, Random& /*random*/) { return 0.5 * sum; });
	for (TripleValues& triple : triples)
	{
		triple.occlusions[1] = triple.occlusions[2] = triple.occlusions[0];
	}
	const Compensation fitted = fitToPictures(straight(), triples, CurveMeasure::rmse);
	CHECK(curveError(fitted, triples, CurveMeasure::rmse) < 1e-4);
	CHECK(fitted.at(0.6) == Approx(0.3).margin(0.01));
	const CurveErrors errors = errorsOf(fitted, triples);
	CHECK(errors.rmse * errors.rmse == Approx(curveError(fitted, triples, CurveMeasure::rmse)));
	CHECK(errors.eq14 == pictureError(fitted, triples));
	CHECK(std::fabs(errors.mean) <= errors.rmse);
	// A curve that is half too dark.
	CHECK(errorsOf(straight(), triples).mean < -0.1);
}

TEST_CASE("compensation: a curve that is worse in views kept out is refused", "[compensate]")
{
	const Level level = builtinLevel("cornell");
	const Tracer tracer(level, {});
	VolumeSet set;
	set.distance_m = 1.0;
	set.exact_bounds = true;
	set.occluders = occludersOf(level, {}, {}).occluders;
	CompensateSettings settings;
	settings.rays = 64;
	settings.kept_out = {2, 2, 200};
	settings.pictures = {2, 0, 200};
	for (const CurveMeasure measure : {CurveMeasure::eq14, CurveMeasure::rmse})
	{
		settings.measure = measure;
		const CompensateResult good = compensateVolumes(set, tracer, settings, {2, {}});
		REQUIRE(good.views.size() == 2);
		CHECK(good.check.triples == good.views[0].triples + good.views[1].triples);
		CHECK(!good.refused);
		CHECK(good.curve.occlusion != Compensation::paper());
		const bool rmse = measure == CurveMeasure::rmse;
		CHECK((rmse ? good.check.after.rmse <= good.check.before.rmse : good.check.after.eq14 <= good.check.before.eq14));
	}
	// Fitted to a single point.
	settings.views = settings.per_view = settings.by_area = 1;
	settings.pictures = {1, 0, 1};
	const CompensateResult bad = compensateVolumes(set, tracer, settings, {2, {}});
	CHECK(bad.refused);
	CHECK(bad.check.after.rmse > bad.check.before.rmse);
	CHECK(bad.curve.occlusion == Compensation::paper());
	CHECK(bad.curve.range == 1.0);
	CHECK(bad.ray_distance_m == Approx(1.0 / 0.6));
}

TEST_CASE("compensation: the points of pictures are a pixel apart, and on surfaces", "[compensate]")
{
	const Level level = builtinLevel("cornell");
	const Tracer tracer(level, {});
	PictureSettings settings;
	settings.views = 2;
	settings.per_view = 100;
	const std::vector<PictureTriple> triples = pictureTriples(tracer, settings, {});
	REQUIRE(triples.size() > 100);
	std::size_t near_by = 0;
	for (const PictureTriple& triple : triples)
	{
		const double step_m = glm::distance(triple.points[0].position, triple.points[1].position);
		near_by += triple.there[1] && step_m > 0.0 && step_m < 0.05 ? 1U : 0U;
		CHECK(glm::length(triple.points[2].normal) == Approx(1.0));
	}
	CHECK(10 * near_by > 9 * triples.size());
	settings.views = 0;
	CHECK(pictureTriples(tracer, settings, {}).empty());
}
