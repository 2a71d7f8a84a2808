// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes in clusters and with 16-bit corners: no losses beyond the stated ones.
#include "volume/packed.h"
#include "volume/prism.h"
#include "volume/volumes.h"

#include "random_volumes.h"
#include "small_levels.h"
#include "small_volumes.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <map>
#include <set>

using namespace nook;
using namespace nook::test;

namespace
{

template <class Item> bool equalBytes(const std::vector<Item>& a, const std::vector<Item>& b)
{
	return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Item)) == 0);
}

} // namespace

TEST_CASE("volume: clusters cover all polygons, hold what they reach, and are no larger than asked", "[volume][clusters]")
{
	const VolumeSet before = randomVolumes(3000);
	const VolumeSet after = clustered(before);
	REQUIRE(after.occluders.polygons.size() == before.occluders.polygons.size());
	CHECK(sameVolumes(after, clustered(before, 128, 3)));

	std::multiset<double> xs_before;
	std::multiset<double> xs_after;
	for (std::size_t i = 0; i < before.occluders.corners.size(); ++i)
	{
		xs_before.insert(before.occluders.corners[i].x);
		xs_after.insert(after.occluders.corners.at(i).x);
	}
	CHECK(xs_before == xs_after);

	std::size_t polygon = 0;
	for (const VolumeCluster& cluster : after.clusters)
	{
		REQUIRE(cluster.first_polygon == polygon);
		REQUIRE((cluster.polygon_count >= 1 && cluster.polygon_count <= 128));
		for (; polygon < cluster.first_polygon + cluster.polygon_count; ++polygon)
		{
			const VolumeBox box = volumeBox(after, polygon);
			REQUIRE(glm::all(glm::lessThanEqual(cluster.least, box.least)));
			REQUIRE(glm::all(glm::greaterThanEqual(cluster.most, box.most)));
		}
	}
	CHECK(polygon == after.occluders.polygons.size());
	CHECK(after.clusters.size() < 60);
}

TEST_CASE("volume: clusters are tight, and larger polygons come first", "[volume][clusters]")
{
	Level level = test::emptyLevel();
	for (int x = 0; x < 64; ++x)
	{
		for (int z = 0; z < 64; ++z)
		{
			test::addQuad(level, {x, 0.0, z}, {0.0, 0.0, 0.5}, {0.25 + 0.001 * (x ^ z), 0.0, 0.0});
		}
	}
	const VolumeSet volumes = test::volumesOf(level, 1.0, 128);
	REQUIRE(volumes.clusters.size() == 128);
	for (const VolumeCluster& cluster : volumes.clusters)
	{
		// 32 quads of one square metre, plus up to 2 m at sharp corners.
		const glm::dvec3 size = cluster.most - cluster.least;
		REQUIRE(size.x * size.z < 13.0 * 13.0);
		double before = 1e300;
		for (uint32_t p = cluster.first_polygon; p < cluster.first_polygon + cluster.polygon_count; ++p)
		{
			const Corners corners = cornersOf(volumes, p);
			const double share = static_cast<double>(volumes.occluders.polygons[p].alpha) *
								 glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
			REQUIRE(share <= before + 1e-3); // rounded after sorting
			before = share;
		}
	}
}

TEST_CASE("volume: 16-bit corners are no further away than stated, convex, and the same when packed again", "[volume][packed]")
{
	for (const glm::dvec3 middle : {glm::dvec3(0.0), glm::dvec3(1e5, -3e4, 2e5)})
	{
		const VolumeSet exact = clustered(randomVolumes(2000, middle));
		const PackedVolumes packed = packVolumes(exact, {}, {});
		const VolumeSet rounded = unpacked(packed, exact);
		// A step and a half on each axis of the widest clusters, about 100 m: 2^-9 m. Much less across a polygon.
		CHECK(packed.greatest_error_m < 2.6 * 0x1p-9);
		CHECK(packed.plane_error_m < 0.5 * packed.greatest_error_m);
		CHECK(packed.plane_error_m > 0.0);
		CHECK(packed.flat_polygons < 20);
		CHECK(rounded.occluders.polygons.size() + packed.flat_polygons == exact.occluders.polygons.size());
		REQUIRE(packed.clusters.size() == exact.clusters.size());
		double greatest = 0.0;
		std::size_t narrow = 0;
		for (std::size_t p = 0; p < rounded.occluders.polygons.size(); ++p)
		{
			const Corners corners = cornersOf(rounded, p);
			const glm::dvec3 front = frontOf(corners);
			for (std::size_t i = 0; i < corners.size(); ++i)
			{
				const glm::dvec3 a = corners[i];
				const glm::dvec3 b = corners[(i + 1) % corners.size()];
				const glm::dvec3 c = corners[(i + 2) % corners.size()];
				narrow += glm::dot(glm::cross(b - a, c - b), front) > 0.0 ? 0U : 1U;
				double nearest = 1e300;
				for (const glm::dvec3 corner : exact.occluders.corners)
				{
					nearest = std::min(nearest, glm::distance(corner, a));
				}
				greatest = std::max(greatest, nearest);
			}
		}
		CHECK(narrow == 0);
		CHECK(greatest <= packed.greatest_error_m);
		CHECK(greatest > 0.3 * packed.greatest_error_m);

		const PackedVolumes again = packVolumes(rounded, {}, {});
		CHECK(again.greatest_error_m == 0.0);
		CHECK(again.flat_corners == 0);
		CHECK(unpacked(again, rounded).occluders.corners == rounded.occluders.corners);
		const VolumeSet shifted = unpacked(again, rounded);
		for (std::size_t i = 0; i < shifted.clusters.size(); ++i)
		{
			REQUIRE(shifted.clusters[i].polygon_count == rounded.clusters[i].polygon_count);
		}
		RunSettings threads;
		threads.threads = 3;
		const PackedVolumes parallel = packVolumes(exact, {}, threads);
		CHECK((equalBytes(parallel.corners, packed.corners) && equalBytes(parallel.clusters, packed.clusters)));
	}
}

TEST_CASE("volume: coordinates that are multiples of the step stay as they are, however far away", "[volume][packed]")
{
	for (const double away : {0.0, 8192.0, 1e6 + 0.25})
	{
		VolumeSet volumes;
		addPolygon(volumes, {{away, 0.5, 0.25}, {away + 16.0, 0.5, 0.25}, {away + 16.0, 12.125, 0.25}, {away, 12.125, 0.25}});
		const VolumeSet exact = clustered(volumes);
		const PackedVolumes packed = packVolumes(exact, {}, {});
		CHECK(packed.greatest_error_m == 0.0);
		CHECK(unpacked(packed, exact).occluders.corners == exact.occluders.corners);
	}
}

TEST_CASE("volume: what 16 bits make flat is left out and counted", "[volume][packed]")
{
	VolumeSet volumes;
	volumes.distance_m = 1.5;
	// A corner in the middle of an edge, one slightly inside, and a triangle smaller than a step of a cluster of 64 m.
	addPolygon(volumes, {{0.0, 0.0, 0.0}, {32.0, 0.0, 0.0}, {64.0, 0.0, 0.0}, {64.0, 0.0, -64.0}, {0.0, 0.0, -64.0}});
	addPolygon(volumes, {{0.0, 1.0, 0.0}, {64.0, 1.0, 0.0}, {64.0, 1.0, -64.0}, {32.0, 1.0, -64.00001}, {0.0, 1.0, -64.0}}, 0.5F);
	const VolumeSet two = clustered(volumes);
	const PackedVolumes packed = packVolumes(two, {}, {});
	CHECK(packed.flat_corners == 2);
	CHECK(packed.polygons.size() == 2);
	CHECK(packed.corners.size() == 8);
	CHECK(packed.flat_polygons == 0);
	CHECK(packed.polygons[0].alpha == 65535); // the larger contribution comes first
	CHECK(packed.polygons[1].alpha == 32768);

	addPolygon(volumes, {{1.0, 2.0, 1.0}, {1.00001, 2.0, 1.0}, {1.00001, 2.0, 1.00001}});
	VolumeSet three = clustered(volumes);
	REQUIRE(three.clusters.size() == 2); // very different sizes are kept apart
	CHECK(packVolumes(three, {}, {}).flat_polygons == 0);
	three.clusters = {{0, 3, three.clusters[0].least, three.clusters[0].most}};
	const PackedVolumes flat = packVolumes(three, {}, {});
	CHECK(flat.flat_polygons == 1);
	CHECK(flat.flat_area_m2 == Approx(5e-11).epsilon(1e-3));
	CHECK(flat.polygons.size() == 2);
}

TEST_CASE("volume: a level of any size keeps what it keeps in metres", "[volume][packed]")
{
	const VolumeSet whole = clustered(randomVolumes(500));
	const PackedVolumes expected = packVolumes(whole, {}, {});
	REQUIRE(expected.polygons.size() > 490);
	for (const double scale : {0x1p-10, 0x1p-19, 0x1p20}) // a kilometre as unit, a distance of 1.4 micrometres, a millimetre
	{
		VolumeSet scaled = whole;
		scaled.distance_m *= scale;
		for (glm::dvec3& corner : scaled.occluders.corners)
		{
			corner *= scale;
		}
		const PackedVolumes packed = packVolumes(scaled, {}, {});
		CHECK(packed.flat_polygons == expected.flat_polygons);
		CHECK(equalBytes(packed.corners, expected.corners));
		CHECK(equalBytes(packed.polygons, expected.polygons));
	}
}

TEST_CASE("volume: prisms are closed, face outward, and are those of the rounded polygons", "[volume][packed]")
{
	const VolumeSet exact = clustered(randomVolumes(500));
	const PackedVolumes packed = packVolumes(exact, {true}, {});
	const VolumeSet rounded = unpacked(packed, exact);
	REQUIRE(packed.vertices.size() == 2 * packed.corners.size());
	for (const nook_volumes::Cluster& cluster : packed.clusters)
	{
		std::map<std::pair<uint32_t, uint32_t>, int> edges;
		std::vector<double> volumes(cluster.polygon_count, 0.0);
		const auto point = [&](uint32_t i)
		{
			const nook_volumes::Corner& v = packed.vertices[cluster.first_vertex + i];
			const glm::dvec3 step(cluster.vertex_step[0], cluster.vertex_step[1], cluster.vertex_step[2]);
			return glm::dvec3(cluster.vertex_origin[0], cluster.vertex_origin[1], cluster.vertex_origin[2]) +
				   step * glm::dvec3(v.x, v.y, v.z);
		};
		for (uint32_t i = 0; i < cluster.index_count; i += 3)
		{
			const uint16_t* const t = &packed.indices[cluster.first_index + i];
			for (int k = 0; k < 3; ++k)
			{
				edges[{t[k], t[(k + 1) % 3]}] += 1;
			}
			const glm::dvec3 o = point(t[0]);
			const uint16_t polygon = packed.vertices[cluster.first_vertex + t[0]].polygon;
			const uint32_t first = packed.polygons[cluster.first_polygon + polygon].first_corner;
			const glm::dvec3 inside = rounded.occluders.corners[first]; // of the polygon, which the prism contains
			volumes.at(polygon) += glm::dot(o - inside, glm::cross(point(t[1]) - inside, point(t[2]) - inside)) / 6.0;
		}
		std::size_t open = 0;
		for (const auto& [edge, count] : edges)
		{
			open += count == 1 && edges.count({edge.second, edge.first}) == 1 ? 0U : 1U;
		}
		REQUIRE(open == 0);
		std::size_t at = 0;
		for (uint32_t p = 0; p < cluster.polygon_count; ++p)
		{
			REQUIRE(volumes[p] > 0.0);
			const Corners corners = cornersOf(rounded, cluster.first_polygon + p);
			Corners points(2 * corners.size());
			const bool two_sided = rounded.occluders.polygons[cluster.first_polygon + p].two_sided;
			prismOf(corners, frontOf(corners), {exact.distance_m, two_sided, false}, points);
			for (const glm::dvec3 expected : points)
			{
				const glm::dvec3 off = glm::abs(point(static_cast<uint32_t>(at++)) - expected);
				REQUIRE(std::max({off.x, off.y, off.z}) <=
						0.51 * static_cast<double>(cluster.vertex_step[0] + cluster.vertex_step[1] + cluster.vertex_step[2]));
				for (int k = 0; k < 3; ++k)
				{
					REQUIRE(static_cast<double>(cluster.least[k]) <= expected[k] - cluster.origin[k]);
					REQUIRE(static_cast<double>(cluster.most[k]) >= expected[k] - cluster.origin[k]);
				}
			}
		}
	}
}
