// SPDX-License-Identifier: GPL-3.0-or-later
// Stress runs: a fixed seed passes its thresholds; the same cases on any number of threads; a case can be shown again.
#include "stress/case.h"
#include "stress/pictures.h"
#include "stress/stress.h"
#include "stress/wide.h"

#include "core/error.h"
#include "core/parallel.h"

#include <catch2/catch.hpp>

#include <limits>
#include <string>

using namespace nook;

namespace
{

std::string resultsOn(int threads)
{
	StressSettings settings;
	settings.cases = 20'000;
	settings.seed = 7;
	return stressJson(runStress(settings, {threads, {}}), settings, "test");
}

} // namespace

TEST_CASE("stress: two million cases of all kernels keep to their thresholds", "[stress]")
{
	StressSettings settings;
	settings.cases = 2'000'000;
	const std::vector<StressResult> results = runStress(settings, {availableThreads(), {}});
	REQUIRE(results.size() == stressKernelNames().size());
	INFO(stressText(results, settings));
	for (const StressResult& result : results)
	{
		INFO(result.name);
		CHECK(result.cases > 0);
		CHECK(result.broken == 0);
		CHECK(result.outside == 0);
		CHECK(result.passed());
		if (result.name == "volume-wild") // corners that make no polygon have no twin
		{
			CHECK(result.compared == 0);
			continue;
		}
		CHECK(result.compared > 0);
		CHECK(result.unsure < result.compared);
	}
}

TEST_CASE("stress: the same bytes on any number of threads", "[stress]")
{
	const std::string one = resultsOn(1);
	CHECK(one == resultsOn(2));
	CHECK(one == resultsOn(5));
}

TEST_CASE("stress: the case with the worst error has it again when it is shown", "[stress]")
{
	StressSettings settings;
	settings.kernels = {"form-factor", "vo-line", "depth-linear"};
	settings.cases = 30'000;
	for (const StressResult& result : runStress(settings, {2, {}}))
	{
		INFO(result.name);
		REQUIRE(result.absolute.at);
		const StressCase shown = showStressCase(result.name, settings.seed, *result.absolute.at);
		CHECK(shown.passed);
		char value[64];
		std::snprintf(value, sizeof value, "absolute error: %a ", result.absolute.value);
		INFO(shown.text);
		CHECK(shown.text.find(value) != std::string::npos);
	}
}

TEST_CASE("stress: an unknown kernel is refused with the names of all", "[stress]")
{
	StressSettings settings;
	settings.kernels = {"no-such"};
	CHECK_THROWS_WITH(runStress(settings, {}), Catch::Contains("found 'no-such'") && Catch::Contains("vo-line"));
}

TEST_CASE("stress: NaN, a number out of range and an error beyond the threshold are found", "[stress]")
{
	stress::Case one(1, 2, true, nullptr);
	one.result("fine", 0.5, 0.0, 1.0);
	CHECK_FALSE((one.broken || one.outside));
	one.result("beyond", 1.5, 0.0, 1.0);
	CHECK(one.outside);
	one.compare("off", 1.0, 1.25L);
	CHECK(one.absolute == 0.25);
	CHECK(one.relative == 0.2);
	one.result("none", HUGE_VAL - HUGE_VAL, 0.0, 1.0);
	CHECK(one.broken);
	for (const long double none : {std::numeric_limits<long double>::quiet_NaN(), std::numeric_limits<long double>::infinity()})
	{
		stress::Case other(1, 2, true, nullptr);
		other.compare("a twin that is no number", 0.5, none);
		CHECK(other.broken);
		CHECK_FALSE(other.unsure);
	}
}

TEST_CASE("stress: beyond the bound of wide numbers is found, whatever the threshold", "[stress]")
{
	using stress::Wide;
	for (const double off : {0.5e-6, 2e-6})
	{
		stress::Case one(1, 2, true, nullptr);
		stress::compareWide(one, "off", 0.25 + off, [] { return Wide(0.25L, 1e-6); });
		CHECK(one.outside == (off > 1e-6));
		CHECK_FALSE(one.unsure);
	}
	stress::Case open(1, 2, true, nullptr);
	stress::compareWide(open, "open", 0.5, [] { return Wide(0.25L, 2.0 * stress::kMostBound); });
	CHECK(open.unsure);
	CHECK_FALSE(open.outside);
}

TEST_CASE("stress: wide numbers bound what 32 bits compute, and know when a comparison is open", "[stress]")
{
	using stress::Wide;
	Random random(3);
	for (int i = 0; i < 2000; ++i)
	{
		const auto a = static_cast<float>(random.uniform() - 0.5);
		const auto b = static_cast<float>(random.uniform() + 0.1);
		const auto c = static_cast<float>(random.uniform() * 1e-3);
		const float narrow = std::sqrt((a * b + c) * (a * b + c) / b) - b;
		const Wide wide = sqrt((Wide(a) * Wide(b) + Wide(c)) * (Wide(a) * Wide(b) + Wide(c)) / Wide(b)) - Wide(b);
		CHECK(std::fabs(static_cast<double>(static_cast<long double>(narrow) - wide.value)) <= wide.error);
		CHECK(wide.error < 1e-6);
	}
	const Wide third = Wide(1.0F) / Wide(3.0F);
	stress::wide_unsure = false;
	CHECK(third < Wide(0.34F));
	CHECK_FALSE(stress::wide_unsure);
	CHECK_FALSE(third * Wide(3.0F) < Wide(1.0F));
	CHECK(stress::wide_unsure);
	stress::wide_unsure = false;
	floor(third * Wide(3.0F));
	CHECK(stress::wide_unsure);
	stress::wide_unsure = false;
	CHECK(static_cast<int>(third) == 0);
	CHECK_FALSE(stress::wide_unsure);
	CHECK(std::abs(static_cast<int>(third * Wide(3.0F))) <= 1);
	CHECK(stress::wide_unsure);
	stress::wide_unsure = false;
	CHECK(Wide(2.0F) * Wide(3.0F) == Wide(6.0F)); // exact: no doubt
	CHECK_FALSE(stress::wide_unsure);
	stress::wide_broken = false;
	const Wide none = (Wide(0.0F) / Wide(0.0F)) * Wide(0.0F);
	CHECK(std::isnan(none.value));
	CHECK(stress::wide_broken);
}
