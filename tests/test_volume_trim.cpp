// SPDX-License-Identifier: GPL-3.0-or-later
// Shortened volumes: the cut itself, the allowed losses, and the file's round trip.
#include "fill.h"
#include "small_volumes.h"

#include "core/random.h"
#include "volume/evaluate.h"
#include "volume/trim.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace nook;
using namespace nook::test;

namespace
{

VolumeSet squareOf(float reach, float side_reach, bool two_sided)
{
	VolumeSet set;
	set.distance_m = 2.0;
	set.occluders.corners = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}};
	set.occluders.polygons.push_back({0, 4, 0, 1.0F, two_sided});
	set.occluders.polygons[0].reach = reach;
	set.occluders.polygons[0].side_reach = side_reach;
	return set;
}

} // namespace

TEST_CASE("trim: a receiver beyond the reach gets nothing, one within gets what it got", "[trim]")
{
	Random random(3);
	std::size_t within = 0;
	std::size_t beyond = 0;
	for (const bool two_sided : {false, true})
	{
		const VolumeSet whole = squareOf(1.0F, 1.0F, two_sided);
		const VolumeSet cut = squareOf(0.375F, 0.1875F, two_sided); // 0.75 m up, half as far sideways
		const VolumeEvaluator of_whole(whole, {});
		const VolumeEvaluator of_cut(cut, {});
		for (int i = 0; i < 20000; ++i)
		{
			const glm::dvec3 at(4.0 * random.uniform() - 1.5, 4.0 * random.uniform() - 1.5, 4.0 * random.uniform() - 2.0);
			const glm::dvec3 toward = glm::normalize(glm::dvec3(0.5, 0.5, 0.0) - at);
			const double height_m = std::fabs(at.z);
			const double side_m = std::max({0.0, -at.x, at.x - 1.0, -at.y, at.y - 1.0});
			if (std::fabs(height_m - 0.75) < 1e-5 || std::fabs(side_m - 0.375) < 1e-5)
			{
				continue;
			}
			const double expected = height_m < 0.75 && side_m < 0.375 ? of_whole.occlusion(at, toward) : 0.0;
			REQUIRE(of_cut.occlusion(at, toward) == expected);
			const VolumeReach needed = reachFor(cut, cut.occluders.polygons[0], at);
			REQUIRE(static_cast<double>(needed.height) == Approx(height_m / 2.0).margin(1e-7));
			REQUIRE(static_cast<double>(needed.side) == Approx(side_m / 2.0).margin(1e-7));
			within += expected > 0.0 ? 1U : 0U;
			beyond += expected == 0.0 && of_whole.occlusion(at, toward) > 0.0 ? 1U : 0U;
			// Masks are covered by the same polygons.
			if (expected == 0.0 && i % 16 == 0)
			{
				REQUIRE(of_cut.maskedVisibility(at, toward, 32) == 1.0);
			}
		}
	}
	CHECK(within > 500);
	CHECK(beyond > 500);
}

TEST_CASE("trim: files keep the reach, rounded up to 1/128, that of sides to eighths of it", "[trim]")
{
	const Level level = builtinLevel("cornell");
	for (const bool prisms : {false, true})
	{
		VolumeSet set = volumesOf(level, 0.4, 8, true);
		Random random(5);
		for (Occluder& polygon : set.occluders.polygons)
		{
			polygon.reach = static_cast<float>(1.0 - random.uniform());
			polygon.side_reach = polygon.reach * static_cast<float>(1.0 - random.uniform());
		}
		set.occluders.polygons[0].reach = set.occluders.polygons[0].side_reach = 1.0F;
		set.occluders.polygons[1].reach = set.occluders.polygons[1].side_reach = 1e-6F;
		const PackedVolumes packed = packVolumes(set, {prisms}, {});
		const VolumeSet back = unpacked(packed, set);
		REQUIRE(back.occluders.polygons.size() == set.occluders.polygons.size());
		for (std::size_t i = 0; i < set.occluders.polygons.size(); ++i)
		{
			const double reach = static_cast<double>(set.occluders.polygons[i].reach);
			REQUIRE(static_cast<double>(back.occluders.polygons[i].reach) == std::ceil(128.0 * reach) / 128.0);
			REQUIRE(back.occluders.polygons[i].two_sided);
			REQUIRE(nook_volumes::reachOf(packed.polygons[i]) == std::ceil(128.0 * reach) / 128.0);
			const double side = static_cast<double>(set.occluders.polygons[i].side_reach);
			const double kept = static_cast<double>(back.occluders.polygons[i].side_reach);
			const double eighth = std::ceil(128.0 * reach) / 1024.0;
			REQUIRE(kept == std::ceil(side / eighth) * eighth);
			REQUIRE(nook_volumes::sideReachOf(packed.polygons[i]) == kept);
			REQUIRE(nook_volumes::cornerCountOf(packed.polygons[i]) == back.occluders.polygons[i].corner_count);
		}
		// An untrimmed volume is written exactly as before reaches existed.
		REQUIRE(packed.polygons[0].flags == nook_volumes::kTwoSided);
		REQUIRE(packed.polygons[0].corner_bits == set.occluders.polygons[0].corner_count);
		const PackedVolumes again = packVolumes(back, {prisms}, {});
		for (std::size_t i = 0; i < packed.polygons.size(); ++i)
		{
			REQUIRE(again.polygons[i].flags == packed.polygons[i].flags);
			REQUIRE(again.polygons[i].corner_bits == packed.polygons[i].corner_bits);
		}
	}
}

TEST_CASE("trim: no receiver loses more than it may, fragments are saved, threads change nothing", "[trim]")
{
	const Level level = builtinLevel("suburb");
	const Tracer tracer(level, {});
	TrimSettings settings;
	settings.share = 0.1;
	const std::vector<ReferencePoint> receivers = sampleReceivers(tracer, 1.5, {2, 2000, 6000, 0, 1}, {2, {}});
	const VolumeSet whole = volumesOf(level, 1.5, 64);
	VolumeSet cut = whole;
	const TrimCounts counts = trimVolumes(cut, receivers, settings, {2, {}});
	const std::vector<double> before = sumsAt(whole, receivers, {2, {}});
	const std::vector<double> after = sumsAt(cut, receivers, {2, {}});
	double most = 0.0;
	double mean = 0.0;
	for (std::size_t i = 0; i < receivers.size(); ++i)
	{
		const double lost = before[i] - after[i];
		REQUIRE(lost <= settings.share * std::max(before[i], kTrimFloor) + 1e-5);
		REQUIRE(lost >= -1e-6);
		most = std::max(most, lost);
		mean += lost / static_cast<double>(receivers.size());
	}
	CHECK(counts.receivers == receivers.size());
	// The stored share is rounded up by at most 2⁻¹⁰.
	CHECK(counts.greatest_loss == Approx(most).epsilon(0.001).margin(1e-5));
	CHECK(counts.mean_loss == Approx(mean).epsilon(0.001).margin(1e-5));
	CHECK(counts.greatest_loss >= most - 1e-5);
	CHECK(mean > 1e-4);
	CHECK(counts.mean_reach < 0.9);
	CHECK(counts.surface < 0.7);
	CHECK(counts.trimmed > whole.occluders.polygons.size() / 2);

	const GBuffer gbuffer = castGBuffer(tracer, viewOf(level.cameras.front(), 32, 18), 32, 18, NormalKind::geometric, {});
	const fill::FillCount of_whole = fill::countFill(gbuffer, whole, {});
	const fill::FillCount of_cut = fill::countFill(gbuffer, cut, {});
	INFO(of_whole.fragments << " fragments, " << of_cut.fragments << " of the shortened");
	CHECK(10 * of_cut.fragments < 9 * of_whole.fragments);

	VolumeSet again = whole;
	trimVolumes(again, receivers, settings, {1, {}});
	for (std::size_t i = 0; i < cut.occluders.polygons.size(); ++i)
	{
		REQUIRE(again.occluders.polygons[i].reach == cut.occluders.polygons[i].reach);
		REQUIRE(again.occluders.polygons[i].side_reach == cut.occluders.polygons[i].side_reach);
	}
}

TEST_CASE("trim: what few receivers see keeps its reach; a cap leaves receivers out", "[trim]")
{
	// Two squares: one just below the receivers, with nearly all of their occlusion, and a distant one.
	const auto squares = []
	{
		VolumeSet set = squareOf(1.0F, 1.0F, false);
		for (int i = 0; i < 4; ++i)
		{
			set.occluders.corners.push_back(set.occluders.corners[static_cast<std::size_t>(i)] + glm::dvec3(0.0, 0.0, 1.8));
		}
		set.occluders.polygons.push_back({4, 4, 1, 1.0F, false});
		return set;
	};
	VolumeSet set = squares();
	const std::vector<ReferencePoint> three(3, ReferencePoint{{0.5, 0.5, 1.9}, {0.0, 0.0, -1.0}, 0.0});
	const std::vector<ReferencePoint> four(4, three[0]);
	TrimSettings settings;
	settings.share = 1.0;
	CHECK(trimVolumes(set, three, settings, {}).trimmed == 0);
	CHECK((set.occluders.polygons[0].reach == 1.0F && set.occluders.polygons[1].reach == 1.0F));
	CHECK(trimVolumes(set, four, settings, {}).trimmed == 1);
	CHECK(set.occluders.polygons[0].reach == 121.0F / 128.0F); // 0.95, rounded down: they lose it
	CHECK(set.occluders.polygons[1].reach == 1.0F);
	settings.most_shares = 1;
	set = squares();
	const std::vector<ReferencePoint> many(9000, three[0]);
	const TrimCounts capped = trimVolumes(set, many, settings, {});
	CHECK(capped.receivers == 4096);
	CHECK(capped.left_out == 9000 - 4096);
	CHECK(capped.whole == 0);
	set = squares();
	CHECK(trimVolumes(set, three, settings, {}).whole == 2);
}

TEST_CASE("trim: volumes that no receiver was asked about are asked about what their polygons see", "[trim]")
{
	const Level level = builtinLevel("cornell");
	const Tracer tracer(level, {});
	VolumeSet set = volumesOf(level, 0.4, 8);
	TrimSettings settings;
	settings.share = 0.5;
	CHECK(trimVolumes(set, std::span<const ReferencePoint>(), settings, {}).receivers == 0);
	const TrimCounts counts = trimVolumes(set, std::span<const ReferencePoint>(), settings, {}, &tracer);
	CHECK(counts.receivers > 100);
	CHECK(counts.trimmed > 0);
}

TEST_CASE("trim: eight bytes keep what a receiver gets, none less, and the reach that leaves it out", "[trim]")
{
	Random random(11);
	for (int i = 0; i < 100000; ++i)
	{
		const auto occlusion = static_cast<float>(std::exp2(-30.0 * random.uniform()));
		const VolumeReach needed{static_cast<float>(random.uniform()), static_cast<float>(random.uniform())};
		const TrimPart part(static_cast<uint32_t>(i), occlusion, needed);
		const auto asked = static_cast<double>(occlusion);
		REQUIRE(part.receiver() == static_cast<uint32_t>(i));
		REQUIRE((part.occlusion() >= asked && part.occlusion() <= asked * (1.0 + 0x1p-10)));
		const VolumeReach kept = part.reach();
		REQUIRE((kept.height <= needed.height && needed.height < kept.height + 1.0F / 128.0F));
		REQUIRE((kept.side <= needed.side && needed.side < kept.side + 1.0F / 1024.0F));
	}
	CHECK(TrimPart(0, 1.0F, {0.999999F, 0.999999F}).occlusion() == 1.0);
	CHECK(TrimPart(0, 0.0F, {}).occlusion() > 0.0);
	CHECK(TrimPart(0, 0.5F, {0.5F, 0.3F}).along(0, 8) == 512);
	CHECK(TrimPart(0, 0.5F, {0.5F, 0.3F}).along(1, 64) == 256); // 307 of 1024, rounded down to an eighth of half the distance
	CHECK(TrimPart(0, 0.5F, {0.2F, 0.3F}).along(2, 8) == 304);
	CHECK(TrimPart(0, 0.5F, {0.007F, 0.9F}).along(0, 8) == 0); // no height in a file excludes it
}
