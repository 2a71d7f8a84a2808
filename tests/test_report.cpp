// SPDX-License-Identifier: GPL-3.0-or-later
#include "small_views.h"

#include "core/error.h"
#include "core/json_reader.h"
#include "core/math.h"
#include "pattern/recipe.h"
#include "scene/builtin.h"
#include "scene/tracer.h"
#include "study/error_report.h"
#include "study/noise_report.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

using namespace nook;

using Approx = Catch::Detail::Approx;

namespace
{

const NoiseReport& smallReport()
{
	static const NoiseReport report = measureNoise({.max_count = 7, .starts = 2, .random_seeds = 2}, {2, {}});
	return report;
}

} // namespace

TEST_CASE("report: a power law is fitted exactly", "[report]")
{
	std::map<int, double> values;
	for (int n = 1; n <= 20; ++n)
	{
		values[n] = 0.3 * powOf(n, -0.75);
	}
	values[13] = 1e-5; // no more than rounding
	const std::optional<PowerFit> fit = fitPower(values);
	REQUIRE(fit);
	CHECK(fit->factor == Approx(0.3).epsilon(1e-12));
	CHECK(fit->exponent == Approx(0.75).epsilon(1e-12));
	CHECK_FALSE(fitPower({{4, 0.1}, {5, 0.1}, {6, 0.1}}));
}

TEST_CASE("report: the same bytes on any number of threads", "[report]")
{
	const NoiseReportSettings settings{.max_count = 4, .starts = 2, .random_seeds = 2};
	const NoiseReport one = measureNoise(settings, {1, {}});
	const NoiseReport four = measureNoise(settings, {4, {}});
	CHECK(noiseReportHtml(one, noiseReportCommand(settings), "1") == noiseReportHtml(four, noiseReportCommand(settings), "1"));
	CHECK(noiseReportJson(one, noiseReportCommand(settings), "1") == noiseReportJson(four, noiseReportCommand(settings), "1"));
}

// In one process, which measures it once.
TEST_CASE("report: the rows, page and JSON of a small one", "[report]")
{
	SECTION("every domain, method and count that the generator offers has a row, once")
	{
		std::set<std::string> seen;
		for (const NoiseRow& row : smallReport().rows)
		{
			CHECK(seen.insert(patternCommand(row.recipe)).second);
			CHECK(row.pattern.count() == static_cast<std::size_t>(row.recipe.count));
			CHECK(row.quality.plane > 0.0);
		}
		// Each of 8 methods: free in 4 domains; disk and ball also centred and symmetric; the sphere also symmetric, even counts.
		// In the ball two methods are too dear for centred and symmetric.
		CHECK(seen.size() == 8 * (7 * 4 + 7 * 4 + 3) - 2 * 2 * 7);
	}
	SECTION("the measures of random are an expectation over its seeds")
	{
		const std::vector<NoiseRow>& rows = smallReport().rows;
		const auto row = std::find_if(rows.begin(), rows.end(),
									  [](const NoiseRow& r)
									  {
										  return r.recipe.domain == Domain::disk && r.variant == Variant::free &&
												 r.recipe.method == Method::random && r.recipe.count == 5;
									  });
		REQUIRE(row != rows.end());
		double square = 0.0;
		for (const uint32_t seed : {1U, 2U})
		{
			const Quality q = measurePattern(generatePattern({.count = 5, .method = Method::random, .seed = seed}));
			square += 0.5 * q.plane * q.plane;
		}
		CHECK(row->quality.plane == Approx(std::sqrt(square)).epsilon(1e-12));
	}
	SECTION("the page needs no network and holds its data safely")
	{
		const std::string hostile = "nook </script><b>&\"@DATA@";
		const std::string page = noiseReportHtml(smallReport(), hostile, "1.2.3");
		CHECK_THAT(page, !Catch::Contains("@SCRIPT@") && !Catch::Contains("@STYLE@"));
		CHECK_THAT(page, !Catch::Contains("src=") && !Catch::Contains("@import") && !Catch::Contains("url(http"));
		CHECK_THAT(page, !Catch::Contains("</script><b>") && Catch::Contains("nook \\u003c/script>\\u003cb>&\\\"@DATA@"));
		CHECK_THAT(page, Catch::Contains("nook 1.2.3"));
		std::size_t addresses = 0;
		for (std::size_t at = page.find("://"); at != std::string::npos; at = page.find("://", at + 1))
		{
			addresses += 1;
		}
		CHECK(addresses == 1); // the name of the SVG namespace
	}
	SECTION("the JSON holds the figures of the rows")
	{
		const auto json = parseJson(noiseReportJson(smallReport(), "nook report noise", "1"), "report.json");
		CHECK(json.at("schema") == "nook.report.noise/1");
		CHECK(json.at("settings").at("max_count") == 7);
		std::size_t counts = 0;
		for (const auto& series : json.at("series"))
		{
			counts += series.at("counts").size();
			for (const auto& [name, values] : series.at("measures").items())
			{
				CHECK(values.size() == series.at("counts").size());
			}
			CHECK_FALSE(series.contains("points"));
		}
		CHECK(counts == smallReport().rows.size());
		const NoiseRow& row = smallReport().rows.back();
		CHECK(json.at("series").back().at("measures").at("noise").back().get<double>() == Approx(row.quality.noise).epsilon(1e-6));
	}
}

TEST_CASE("report: settings out of range are refused by their name", "[report]")
{
	const auto message = [](const NoiseReportSettings& settings) -> std::string
	{
		try
		{
			checkNoiseReportSettings(settings);
		}
		catch (const Error& error)
		{
			CHECK(error.code() == ExitCode::usage);
			return error.what();
		}
		return "accepted";
	};
	CHECK(message({}) == "accepted");
	CHECK_THAT(message({.max_count = 0}), Catch::Contains("max-count"));
	CHECK_THAT(message({.max_count = kMaxReportCount + 1}), Catch::Contains("max-count"));
	CHECK_THAT(message({.starts = -1}), Catch::Contains("starts"));
	CHECK_THAT(message({.random_seeds = 0}), Catch::Contains("seeds"));
	CHECK(noiseReportCommand(NoiseReportSettings{}) == "nook report noise");
	CHECK(noiseReportCommand({.max_count = 20, .starts = 4, .random_seeds = 5, .seed = 9}) ==
		  "nook report noise --max-count 20 --starts 4 --seeds 5 --seed 9");
}

// The mean over frames: which history is read, which is rejected, and how it is weighted.

namespace
{

constexpr int kFrameWidth = 96;
constexpr int kFrameHeight = 54;

std::vector<GBuffer> framesOf(const std::string& name, Motion motion, int count)
{
	const Level level = builtinLevel(name);
	const Tracer tracer(level, RunSettings{2, {}});
	std::vector<GBuffer> frames;
	for (int i = 0; i < count; ++i)
	{
		const LevelCamera camera = cameraOfFrame(level.cameras.front(), stepOf(motion, 1.0), i, kFrameWidth, kFrameHeight);
		frames.push_back(castGBuffer(tracer, viewOf(camera, kFrameWidth, kFrameHeight), kFrameWidth, kFrameHeight,
									 NormalKind::geometric, {2, {}}));
	}
	return frames;
}

// A smooth function attached to the surface: it depends on the world position.
std::vector<double> paintedOn(const GBuffer& gbuffer)
{
	const Projector projector(gbuffer.view.projection, kFrameWidth, kFrameHeight);
	const glm::dmat4 world = glm::inverse(gbuffer.view.camera_from_world);
	std::vector<double> values(gbuffer.depth.size(), 0.0);
	for (std::size_t i = 0; i < values.size(); ++i)
	{
		if (std::isfinite(gbuffer.depth[i]))
		{
			const glm::dvec3 p(world * glm::dvec4(positionOf(gbuffer, projector, static_cast<int>(i) % kFrameWidth,
															 static_cast<int>(i) / kFrameWidth),
												  1.0));
			values[i] = 0.05 * p.x + 0.03 * p.y - 0.04 * p.z;
		}
	}
	return values;
}

} // namespace

TEST_CASE("over frames: history is read where the surface was, and not where it was hidden", "[report]")
{
	for (const Motion motion : {Motion::still, Motion::pan, Motion::walk})
	{
		const std::vector<GBuffer> frames = framesOf("courtyard", motion, 2);
		const std::vector<HistoryTexels> history = historyOf(frames[1], frames[0]);
		const std::vector<double> before = paintedOn(frames[0]);
		const std::vector<double> now = paintedOn(frames[1]);
		const Projector projector(frames[1].view.projection, kFrameWidth, kFrameHeight);
		std::size_t uncovered = 0;
		std::size_t surfaces = 0;
		std::size_t off = 0;
		for (std::size_t i = 0; i < history.size(); ++i)
		{
			if (!std::isfinite(frames[1].depth[i]))
			{
				CHECK_FALSE(history[i].any);
				continue;
			}
			surfaces += 1;
			uncovered += history[i].any ? 0U : 1U;
			double read = 0.0;
			double sum = 0.0;
			for (std::size_t tap = 0; tap < 4; ++tap)
			{
				read += history[i].weights[tap] * before[history[i].texels[tap]];
				sum += history[i].weights[tap];
			}
			CHECK(sum == Approx(history[i].any ? 1.0 : 0.0).margin(1e-12));
			// At most one texel around the pixel, whose footprint is long at grazing angles; the painted values change by at most
			// 0.08 per metre.
			const glm::dvec3 at =
				positionOf(frames[1], projector, static_cast<int>(i) % kFrameWidth, static_cast<int>(i) / kFrameWidth);
			const double facing = std::fabs(glm::dot(glm::normalize(at), glm::dvec3(frames[1].normals[i])));
			const double texel_m = 2.0 / (kFrameWidth * frames[1].view.projection[0][0]) * -at.z / std::max(facing, 0.01);
			off += history[i].any && std::fabs(read - now[i]) > 0.08 * texel_m ? 1U : 0U;
			CHECK((!history[i].any || std::fabs(read - now[i]) < 0.08 * 3.0 * texel_m));
		}
		INFO(nameOf(motion));
		CHECK(off * 50 < surfaces);
		CHECK((motion == Motion::still ? uncovered == 0 : uncovered > surfaces / 500));
		CHECK(uncovered < surfaces / 8);
	}
}

TEST_CASE("over frames: the first frames count alike, then the newest by alpha", "[report]")
{
	std::vector<HistoryTexels> same(2);
	for (std::size_t i = 0; i < 2; ++i)
	{
		same[i] = {{i, i, i, i}, {1.0, 0.0, 0.0, 0.0}, i == 0}; // the second pixel is always new
	}
	FrameMean mean(0.25);
	mean.add({1.0, 1.0}, {});
	CHECK(mean.change() == 0.0);
	mean.add({3.0, 3.0}, same);
	CHECK(mean.mean() == std::vector<double>{2.0, 3.0});
	CHECK(mean.change() == Approx(1.0));
	CHECK(mean.ages() == std::vector<int>{2, 1});
	mean.add({5.0, 5.0}, same);
	CHECK(mean.mean()[0] == Approx(3.0));
	mean.add({7.0, 7.0}, same);
	CHECK(mean.mean()[0] == Approx(4.0));
	mean.add({0.0, 0.0}, same);
	CHECK(mean.mean()[0] == Approx(3.0)); // 3/4 of 4
	CHECK(mean.mean()[1] == 0.0);
	FrameMean newest(1.0);
	newest.add({1.0, 1.0}, {});
	newest.add({0.25, 0.5}, same);
	CHECK(newest.mean() == std::vector<double>{0.25, 0.5});
}
