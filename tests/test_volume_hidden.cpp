// SPDX-License-Identifier: GPL-3.0-or-later
// Sides that see none of what they darken are dropped; those that see a little of it are kept.
#include "small_levels.h"

#include "core/random.h"
#include "volume/build.h"
#include "volume/evaluate.h"
#include "volume/occluders.h"
#include "volume/receivers.h"
#include "volume/sight.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

using namespace nook;
using namespace nook::test;

namespace
{

VolumeSet clampedSetOf(const Occluders& occluders, double distance_m)
{
	VolumeSet set;
	set.occluders = occluders;
	set.distance_m = distance_m;
	return set;
}

// Merged and uncut, as large as possible.
Occluders polygonsOf(const Level& level, double distance_m)
{
	OccluderSettings settings;
	settings.distance_m = distance_m;
	settings.extent = 0.0;
	return occludersOf(level, settings, {2, {}}).occluders;
}

Dropped drop(const Level& level, const Occluders& occluders, double distance_m)
{
	const Tracer tracer(level, {});
	DropSettings settings;
	settings.hidden = true;
	return dropVolumes(occluders, tracer, distance_m, false, settings, {2, {}});
}

double sumAt(const Occluders& occluders, glm::dvec3 position, glm::dvec3 normal)
{
	const VolumeSet set = clampedSetOf(occluders, 1.0);
	return VolumeEvaluator(set, {}).occlusion(position, normal);
}

// Rooms to the left and right of a solid wall of 0.2 m that extends below their floors; all of a two-sided material.
Level twoRooms()
{
	Level level = emptyLevel();
	level.material_list[0].two_sided = true;
	addQuad(level, {-5.0, 0.0, 3.0}, {4.9, 0.0, 0.0}, {0.0, 0.0, -6.0});
	addQuad(level, {0.1, 0.0, 3.0}, {4.9, 0.0, 0.0}, {0.0, 0.0, -6.0});
	addBox(level, {-0.1, -0.2, -3.0}, {0.1, 3.0, 3.0});
	return level;
}

SightPiece pieceOf(const std::vector<glm::dvec3>& corners)
{
	return {corners, glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]))};
}

} // namespace

TEST_CASE("hidden: the base of a house on a great plain keeps its volumes", "[volume_hidden]")
{
	for (const double half_m : {6.0, 40.0})
	{
		Level level = emptyLevel();
		addBox(level, {-100.0, -1.0, -100.0}, {100.0, 0.0, 100.0});
		addBox(level, {-half_m, 0.0, -half_m}, {half_m, 8.0, half_m});
		const Occluders all = polygonsOf(level, 1.0);
		const Dropped kept = drop(level, all, 1.0);
		CHECK(kept.counts.kept >= 5); // four walls and the ground
		CHECK(kept.counts.kept <= 6); // and the bottom of the house if it is not found to be inside
		CHECK(kept.counts.hidden_check.greatest < 1e-3);
		for (const double along_m : {-0.99, -0.5, 0.0, 0.7, 0.99})
		{
			for (const double off_m : {0.01, 0.1, 0.4})
			{
				// On the ground in front of a wall, and on the wall above the ground.
				const glm::dvec3 ground(half_m + off_m, 0.0, along_m * half_m);
				CHECK(sumAt(kept.occluders, ground, {0.0, 1.0, 0.0}) > 0.4 * (1.0 - off_m) - 0.1);
				CHECK(sumAt(kept.occluders, ground, {0.0, 1.0, 0.0}) == Approx(sumAt(all, ground, {0.0, 1.0, 0.0})));
				const glm::dvec3 wall(half_m, off_m, along_m * half_m);
				CHECK(sumAt(kept.occluders, wall, {1.0, 0.0, 0.0}) == Approx(sumAt(all, wall, {1.0, 0.0, 0.0})));
			}
		}
	}
}

TEST_CASE("hidden: nothing is darkened through the wall between two rooms", "[volume_hidden]")
{
	const Level level = twoRooms();
	OccluderSettings settings;
	settings.sides = Sides::two_sided;
	settings.extent = 0.0;
	const Occluders all = occludersOf(level, settings, {}).occluders;
	const Dropped kept = drop(level, all, 1.0);
	CHECK(kept.counts.hidden_sides >= 2); // the backs of both faces of the wall
	CHECK(kept.counts.hidden_check.greatest == 0.0);
	CHECK(kept.counts.hidden_check.volumes > 100);
	const Tracer tracer(level, {});
	const Dropped with_hidden = dropVolumes(all, tracer, 1.0, false, {}, {2, {}});
	CHECK(with_hidden.counts.hidden_sides == 0);

	// Next to the wall: only its near face, with its contribution as a one-sided polygon.
	const glm::dvec3 position(0.3, 0.0, 0.2);
	const glm::dvec3 up(0.0, 1.0, 0.0);
	Occluders face;
	face.corners = {{0.1, -0.2, 3.0}, {0.1, -0.2, -3.0}, {0.1, 3.0, -3.0}, {0.1, 3.0, 3.0}};
	face.polygons.push_back({0, 4, 0, 1.0F, false});
	CHECK(sumAt(kept.occluders, position, up) == Approx(sumAt(face, position, up)).epsilon(1e-4));
	CHECK(sumAt(with_hidden.occluders, position, up) > 1.2 * sumAt(kept.occluders, position, up));

	// The change is reported separately.
	const std::vector<ReferencePoint> receivers = sampleReceivers(tracer, 1.0, {2, 200, 2000, 1000, 3}, {2, {}});
	const HiddenShares shares =
		hiddenShares(clampedSetOf(kept.hidden, 1.0), tracer, receivers, sightLift(tracer, 1.0, 1e-4), {2, {}});
	const VerifyResult verified =
		verifyVolumes(clampedSetOf(all, 1.0), clampedSetOf(kept.occluders, 1.0), receivers, {2, {}}, shares.behind);
	CHECK(verified.greatest > 0.05);
	CHECK(verified.behind > 10);
	CHECK(verified.greatest_behind == Approx(verified.greatest).epsilon(0.01));
	CHECK(verified.greatest_seen < 1e-4);
	CHECK(verified.mean_seen <= verified.mean);
}

TEST_CASE("hidden: sides are kept again until no point of a sample loses more than the bound, or it is said", "[volume_hidden]")
{
	const Level level = twoRooms();
	const Tracer tracer(level, {});
	OccluderSettings two_sided;
	two_sided.sides = Sides::two_sided;
	two_sided.extent = 0.0;
	const Occluders all = occludersOf(level, two_sided, {}).occluders;
	DropSettings settings;
	settings.hidden = true;
	const DropCounts enough = dropVolumes(all, tracer, 1.0, false, settings, {2, {}}).counts;
	CHECK(enough.hidden_sides > 0);
	CHECK(enough.hidden_samples == 1);
	CHECK(!enough.hidden_lost);
	settings.hidden_bound = -1.0; // no loss is acceptable
	const DropCounts never = dropVolumes(all, tracer, 1.0, false, settings, {2, {}}).counts;
	CHECK(never.hidden_samples == 12);
	CHECK(never.hidden_lost);
	CHECK(never.hidden_sides + never.hidden_restored == enough.hidden_sides + enough.hidden_restored);
}

TEST_CASE("hidden: what is lost above the bound is a warning", "[volume_hidden]")
{
	VolumeSettings settings;
	settings.distance_m = 1.0;
	settings.occluders.sides = Sides::two_sided;
	settings.drop.hidden = true;
	CHECK(buildVolumes(twoRooms(), settings, {2, {}}).warnings.empty());
	settings.drop.hidden_bound = -1.0; // no loss is acceptable
	const BuiltVolumes built = buildVolumes(twoRooms(), settings, {2, {}});
	CHECK(built.dropped.hidden_lost);
	REQUIRE(built.warnings.size() == 1);
	CHECK(built.warnings.front().find("drop-hidden: a sampled point still loses 0 of what it sees, after 12 samples kept") !=
		  std::string::npos);
	CHECK(built.warnings.front().ends_with("expected at most -1"));
}

TEST_CASE("hidden: a gap in the wall is enough to be seen", "[volume_hidden]")
{
	const std::vector<glm::dvec3> wall{{0.0, 0.0, 0.0}, {0.0, 2.0, 0.0}, {0.0, 2.0, 2.0}, {0.0, 0.0, 2.0}};
	const std::vector<glm::dvec3> other{{0.8, 0.0, 0.0}, {0.8, 0.0, 2.0}, {0.8, 2.0, 2.0}, {0.8, 2.0, 0.0}};
	const SightPiece polygon = pieceOf(wall);
	const SightPiece piece = pieceOf(other);
	REQUIRE(polygon.normal.x > 0.99);
	REQUIRE(piece.normal.x < -0.99);
	const auto counts = [](std::size_t index, glm::dvec3 point)
	{
		return index == 0 && std::fabs(point.x - 0.8) < 1e-9;
	};
	const auto sees = [&](double gap_m, uint64_t most, uint64_t& segments)
	{
		Level level = emptyLevel();
		addQuad(level, {0.4, -9.0, -9.0}, {0.0, 0.0, 10.3 - 0.5 * gap_m}, {0.0, 18.0, 0.0});
		addQuad(level, {0.4, -9.0, 1.3 + 0.5 * gap_m}, {0.0, 0.0, 9.0}, {0.0, 18.0, 0.0});
		const Tracer tracer(level, {});
		segments = 0;
		return Sight(tracer, {1.0, 1e-4, most}).sees(polygon, std::span(&piece, 1), counts, segments);
	};
	uint64_t segments = 0;
	CHECK(sees(0.2, 20'000, segments));
	CHECK(sees(0.1, 20'000, segments));
	CHECK_FALSE(sees(0.0, 20'000, segments));
	CHECK(segments > 100);
	CHECK(sees(0.0, 50, segments)); // inconclusive, so not hidden

	// A thin sheet that covers it entirely, too; a masked one may let light through anywhere.
	for (const bool masked : {false, true})
	{
		Level level = emptyLevel();
		addQuad(level, {0.4, -9.0, -9.0}, {0.0, 18.0, 0.0}, {0.0, 0.0, 18.0});
		level.material_list[0].alpha_mode = masked ? AlphaMode::mask : AlphaMode::opaque;
		level.material_list[0].coverage = masked ? 0.5 : 1.0;
		const Tracer tracer(level, {});
		segments = 0;
		CHECK(Sight(tracer, {1.0, 1e-4}).sees(polygon, std::span(&piece, 1), counts, segments) == masked);
		CHECK(tracer.blocked({0.0, 1.0, 1.0}, {0.8, 1.0, 1.0}) == !masked);
		CHECK_FALSE(tracer.blocked({0.0, 1.0, 1.0}, {0.3, 1.0, 1.0}));
		CHECK(Sight(tracer, {1.0, 1e-4}).seesFrom(polygon, {0.8, 1.0, 1.0}, piece.normal, 16, 3) == masked);
		for (const bool counted : {false, true})
		{
			const Segment met = Sight(tracer, {1.0, 1e-4}).middles(polygon, piece, [&](glm::dvec3) { return counted; });
			CHECK(met == (!masked ? Segment::blocked : counted ? Segment::open : Segment::discounted));
		}
	}
}

TEST_CASE("hidden: a surface that touches the polygon is seen where it does", "[volume_hidden]")
{
	// A corner of floor and wall; a cover over both leaves only 0.3 m along the crease open.
	Level level = emptyLevel();
	addQuad(level, {0.05, 0.05, -0.1}, {0.0, 3.0, 0.0}, {0.0, 0.0, 1.6});
	addQuad(level, {0.05, 0.05, 1.8}, {0.0, 3.0, 0.0}, {0.0, 0.0, 1.6});
	addQuad(level, {0.05, 0.05, -0.1}, {3.0, 0.0, 0.0}, {0.0, 0.0, 1.6});
	addQuad(level, {0.05, 0.05, 1.8}, {3.0, 0.0, 0.0}, {0.0, 0.0, 1.6});
	addQuad(level, {0.0, 0.0, 1.5}, {0.05, 0.0, 0.0}, {0.0, 0.05, 0.0});
	addQuad(level, {0.0, 0.0, 1.8}, {0.05, 0.0, 0.0}, {0.0, 0.05, 0.0});
	const std::vector<glm::dvec3> wall{{0.0, 0.0, 0.0}, {0.0, 2.0, 0.0}, {0.0, 2.0, 3.0}, {0.0, 0.0, 3.0}};
	const std::vector<glm::dvec3> floor{{0.0, 0.0, 0.0}, {0.0, 0.0, 3.0}, {2.0, 0.0, 3.0}, {2.0, 0.0, 0.0}};
	const Tracer tracer(level, {});
	uint64_t segments = 0;
	const SightPiece piece = pieceOf(floor);
	REQUIRE(piece.normal.y > 0.99);
	CHECK(Sight(tracer, {1.0, 1e-4})
			  .sees(
				  pieceOf(wall), std::span(&piece, 1), [](std::size_t, glm::dvec3) { return true; }, segments));
}

TEST_CASE("hidden: the nearest point of a triangle, and what a plane leaves of a polygon", "[volume_hidden]")
{
	Random random(5);
	const auto point = [&]
	{
		const double x = random.uniform();
		const double y = random.uniform();
		return glm::dvec3(x, y, random.uniform()) * 2.0 - 1.0;
	};
	for (int trial = 0; trial < 300; ++trial)
	{
		const std::array<glm::dvec3, 3> triangle{point(), point(), point()};
		const glm::dvec3 to = 2.0 * point();
		const double nearest = glm::length(nearestOf(triangle, to) - to);
		double sampled = 1e300;
		for (int i = 0; i <= 40; ++i)
		{
			for (int k = 0; k <= 40 - i; ++k)
			{
				const glm::dvec3 at = triangle[0] + i / 40.0 * (triangle[1] - triangle[0]) + k / 40.0 * (triangle[2] - triangle[0]);
				sampled = std::min(sampled, glm::length(at - to));
			}
		}
		CHECK(nearest <= sampled + 1e-12);
		CHECK(nearest >= sampled - 0.1);

		std::vector<glm::dvec3> kept;
		const glm::dvec3 normal = glm::normalize(point());
		const double offset = 0.3 * random.uniform();
		const std::size_t count = clipTo(triangle, normal, offset, kept);
		CHECK(count == kept.size());
		for (const glm::dvec3& corner : kept)
		{
			CHECK(glm::dot(normal, corner) >= offset - 1e-12);
		}
		for (const glm::dvec3& corner : triangle)
		{
			CHECK((glm::dot(normal, corner) < offset || std::count(kept.begin(), kept.end(), corner) > 0));
		}
	}
}
