// SPDX-License-Identifier: GPL-3.0-or-later
#include "testing.h"

#include "core/json_reader.h"
#include "pattern/recipe.h"
#include "study/noise_report.h"

#include <nlohmann/json.hpp>

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

TEST_CASE("report: the command states what differs from the defaults", "[report]")
{
	CHECK(noiseReportCommand(NoiseReportSettings{}) == "nook report noise");
	CHECK(noiseReportCommand({.max_count = 20, .starts = 4, .random_seeds = 5, .seed = 9}) ==
		  "nook report noise --max-count 20 --starts 4 --seeds 5 --seed 9");
}
