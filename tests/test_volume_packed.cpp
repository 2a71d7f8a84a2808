// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes in clusters and with 16-bit corners: no losses beyond the stated ones.
#include "small_levels.h"
#include "small_volumes.h"
#include "testing.h"

#include "core/text.h"
#include "scene/load.h"
#include "volume/volume_glb.h"

#include <meshoptimizer.h>

namespace
{

Corners cornersOf(const VolumeSet& volumes, std::size_t polygon)
{
	const std::span<const glm::dvec3> corners = volumes.occluders.cornersOf(volumes.occluders.polygons[polygon]);
	return {corners.begin(), corners.end()};
}

// Polygons of 3 to 8 corners on circles and ellipses anywhere in a box, from millimetres to tens of metres in size.
VolumeSet randomVolumes(std::size_t count, glm::dvec3 middle = {})
{
	Random random(7);
	const auto number = [&random](double least, double most)
	{
		return least + (most - least) * random.below(1U << 20U) / (1U << 20U);
	};
	VolumeSet volumes;
	volumes.distance_m = 0.75;
	volumes.ray_distance_m = 1.25;
	while (volumes.occluders.polygons.size() < count)
	{
		const glm::dvec3 at = middle + glm::dvec3{number(-40.0, 40.0), number(0.0, 9.0), number(-40.0, 40.0)};
		const glm::dvec3 u{number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0)};
		const glm::dvec3 v = glm::cross(u, glm::dvec3{number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0)});
		const double size = std::exp2(number(-8.0, 4.0));
		const auto corners = 3 + random.below(6);
		const double turn = number(0.0, 6.0);
		Corners made;
		for (uint32_t i = 0; i < corners; ++i)
		{
			const double angle = turn + 6.283185307179586 * i / corners;
			made.push_back(at + size * (std::cos(angle) * u + std::sin(angle) * v));
		}
		const auto alpha = static_cast<float>(number(0.01, 1.0));
		volumes.occluders.add({.alpha = alpha, .two_sided = random.below(2) == 1}, made);
	}
	return volumes;
}

VolumeSet clustered(VolumeSet volumes, std::size_t polygons = 128, int threads = 1)
{
	RunSettings run;
	run.threads = threads;
	clusterVolumes(volumes, {polygons}, run);
	return volumes;
}

bool sameVolumes(const VolumeSet& a, const VolumeSet& b)
{
	const auto same = [](const Occluder& x, const Occluder& y)
	{
		return x.first_corner == y.first_corner && x.corner_count == y.corner_count && x.alpha == y.alpha &&
			   x.two_sided == y.two_sided;
	};
	const auto same_cluster = [](const VolumeCluster& x, const VolumeCluster& y)
	{
		return x.first_polygon == y.first_polygon && x.polygon_count == y.polygon_count && x.least == y.least && x.most == y.most;
	};
	return a.occluders.corners == b.occluders.corners && a.distance_m == b.distance_m && a.ray_distance_m == b.ray_distance_m &&
		   a.exact_bounds == b.exact_bounds && a.compensation.range == b.compensation.range &&
		   a.compensation.occlusion == b.compensation.occlusion &&
		   std::equal(a.occluders.polygons.begin(), a.occluders.polygons.end(), b.occluders.polygons.begin(),
					  b.occluders.polygons.end(), same) &&
		   std::equal(a.clusters.begin(), a.clusters.end(), b.clusters.begin(), b.clusters.end(), same_cluster);
}

template <class Item> bool equalBytes(const std::vector<Item>& a, const std::vector<Item>& b)
{
	return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Item)) == 0);
}

std::string glbOf(const VolumeSet& volumes, const VolumeFileSettings& settings = {})
{
	return volumeGlb(volumes, settings, "test", "nook test", {}).bytes;
}

// A copy without slack at its end, so that a sanitizer detects overruns.
class ExactBytes
{
public:
	explicit ExactBytes(std::string_view bytes) : m_bytes(new char[bytes.size()]), m_size(bytes.size())
	{
		std::copy(bytes.begin(), bytes.end(), m_bytes.get());
	}
	const char* open(nook_volumes::Volumes& volumes) const
	{
		return volumes.open(m_bytes.get(), m_size, {meshopt_decodeVertexBuffer, meshopt_decodeIndexBuffer});
	}

private:
	std::unique_ptr<char[]> m_bytes;
	std::size_t m_size;
};

// Reads everything an engine would, into a sum, so that nothing is optimised away.
double walked(const nook_volumes::Volumes& volumes)
{
	double sum = volumes.compensated(0.3) + volumes.header().distance;
	for (std::size_t c = 0; c < volumes.clusterCount(); ++c)
	{
		const nook_volumes::Cluster& cluster = volumes.clusters()[c];
		for (uint32_t p = cluster.first_polygon; p < cluster.first_polygon + cluster.polygon_count; ++p)
		{
			const nook_volumes::Polygon& polygon = volumes.polygons()[p];
			for (uint32_t i = 0; i < nook_volumes::cornerCountOf(polygon); ++i)
			{
				double at[3];
				volumes.position(cluster, volumes.corners()[polygon.first_corner + i], at);
				sum += at[0] + at[1] + at[2];
			}
		}
		for (uint32_t i = cluster.first_index; i < cluster.first_index + cluster.index_count; ++i)
		{
			const uint32_t at = volumes.indices()[i];
			sum += volumes.hasPrisms() || volumes.sharesCorners() ? volumes.vertices()[cluster.first_vertex + at].x
																  : volumes.corners()[cluster.first_corner + at].x;
		}
	}
	return sum;
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
			const Bounds box = volumeBox(after, polygon);
			REQUIRE(glm::all(glm::lessThanEqual(cluster.least, box.least)));
			REQUIRE(glm::all(glm::greaterThanEqual(cluster.most, box.most)));
		}
	}
	CHECK(polygon == after.occluders.polygons.size());
	CHECK(after.clusters.size() < 60);
}

TEST_CASE("volume: clusters are tight, and neighbours follow one another", "[volume][clusters]")
{
	Level level = test::emptyLevel();
	for (int x = 0; x < 64; ++x)
	{
		for (int z = 0; z < 64; ++z)
		{
			test::addQuad(level, {x, 0.0, z}, {0.0, 0.0, 0.5}, {0.25, 0.0, 0.0});
		}
	}
	const VolumeSet volumes = test::volumesOf(level, 1.0, 128);
	REQUIRE(volumes.clusters.size() == 128);
	for (const VolumeCluster& cluster : volumes.clusters)
	{
		// 32 quads of one square metre, plus up to 2 m at sharp corners.
		const glm::dvec3 size = cluster.most - cluster.least;
		REQUIRE(size.x * size.z < 13.0 * 13.0);
		double steps = 0.0; // from polygon to polygon; about 3.2 m each in random order
		for (uint32_t p = cluster.first_polygon + 1; p < cluster.first_polygon + cluster.polygon_count; ++p)
		{
			steps += glm::distance(cornersOf(volumes, p)[0], cornersOf(volumes, p - 1)[0]);
		}
		REQUIRE(steps < 2.0 * cluster.polygon_count);
	}
}

TEST_CASE("volume: 16-bit corners are no further away than stated, convex, and the same when packed again", "[volume][packed]")
{
	const glm::dvec3 middle = GENERATE(glm::dvec3(0.0), glm::dvec3(1e5, -3e4, 2e5));
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

TEST_CASE("volume: coordinates that are multiples of the step stay as they are, however far away", "[volume][packed]")
{
	const double away = GENERATE(0.0, 8192.0, 1e6 + 0.25);
	VolumeSet volumes;
	volumes.occluders.add({},
						  Corners{{away, 0.5, 0.25}, {away + 16.0, 0.5, 0.25}, {away + 16.0, 12.125, 0.25}, {away, 12.125, 0.25}});
	const VolumeSet exact = clustered(volumes);
	const PackedVolumes packed = packVolumes(exact, {}, {});
	CHECK(packed.greatest_error_m == 0.0);
	CHECK(unpacked(packed, exact).occluders.corners == exact.occluders.corners);
}

TEST_CASE("volume: what 16 bits make flat is left out and counted", "[volume][packed]")
{
	VolumeSet volumes;
	volumes.distance_m = 1.5;
	// A corner in the middle of an edge, one slightly inside, and a triangle smaller than a step of a cluster of 64 m.
	volumes.occluders.add({}, Corners{{0.0, 0.0, 0.0}, {32.0, 0.0, 0.0}, {64.0, 0.0, 0.0}, {64.0, 0.0, -64.0}, {0.0, 0.0, -64.0}});
	volumes.occluders.add(
		{.alpha = 0.5F}, Corners{{0.0, 1.0, 0.0}, {64.0, 1.0, 0.0}, {64.0, 1.0, -64.0}, {32.0, 1.0, -64.00001}, {0.0, 1.0, -64.0}});
	const VolumeSet two = clustered(volumes);
	const PackedVolumes packed = packVolumes(two, {}, {});
	CHECK(packed.flat_corners == 2);
	CHECK(packed.polygons.size() == 2);
	CHECK(packed.corners.size() == 8);
	CHECK(packed.flat_polygons == 0);
	CHECK(packed.polygons[0].alpha == 65535); // the larger contribution comes first
	CHECK(packed.polygons[1].alpha == 32768);

	volumes.occluders.add({}, Corners{{1.0, 2.0, 1.0}, {1.00001, 2.0, 1.0}, {1.00001, 2.0, 1.00001}});
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
	const double scale = GENERATE(0x1p-10, 0x1p-19, 0x1p20); // a kilometre as unit, a distance of 1.4 micrometres, a millimetre
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

// Volumes as files: 16-bit round trips, and no file breaks its reader.

TEST_CASE("emit: a file above its limit is refused with the options that would make it smaller", "[emit][volume]")
{
	const VolumeSet volumes = clustered(randomVolumes(700, glm::dvec3(0.0)), 100);
	VolumeFileSettings settings{VolumeLayout::prisms, false};
	const std::size_t size = volumeGlb(volumes, settings, "test", "nook test", {}).bytes.size();
	settings.most_bytes = size;
	CHECK(volumeGlb(volumes, settings, "test", "nook test", {}).bytes.size() == size);
	const auto refused = [&]
	{
		return Catch::Contains("volumes: found a file of more than " + capText(settings.most_bytes) + " for ");
	};
	for (const std::size_t most : {size - 1, std::size_t{1} << 10U}) // limits exceeded by the text around the arrays; by an array
	{
		settings.most_bytes = most;
		CHECK_THROWS_WITH(volumeGlb(volumes, settings, "test", "nook test", {}),
						  refused() && Catch::Contains(" polygons, expected less: --layout polygons, --compress, --detail auto, "));
	}
	settings = {VolumeLayout::polygons, true, 1 << 10U};
	CHECK_THROWS_WITH(volumeGlb(volumes, settings, "test", "nook test", {}),
					  refused() && Catch::Contains(" polygons, expected less: --detail auto, "));
}

TEST_CASE("emit: volumes come back from their file as 16 bits left them, in both layouts, compressed or not", "[emit][volume]")
{
	const TemporaryFolder folder;
	const glm::dvec3 middle = GENERATE(glm::dvec3(0.0), glm::dvec3(1e5, 0.0, -9e4));
	VolumeSet volumes = randomVolumes(700, middle);
	volumes.exact_bounds = true;
	volumes.compensation.range = 3.5;
	volumes.compensation.occlusion.fill(0.25);
	volumes.compensation.occlusion.back() = 0.75;
	volumes = clustered(volumes, 100);
	const VolumeSet rounded = unpacked(packVolumes(volumes, {}, {}), volumes);
	std::map<std::string, std::size_t> sizes;
	for (const VolumeLayout layout : {VolumeLayout::polygons, VolumeLayout::prisms})
	{
		for (const bool compress : {false, true})
		{
			const std::string path = folder / "v.glb";
			const VolumeFileSettings settings{layout, compress};
			const VolumeFile file = volumeGlb(volumes, settings, "level \"x\"", "nook test", {});
			RunSettings threads;
			threads.threads = 3;
			CHECK(volumeGlb(volumes, settings, "level \"x\"", "nook test", threads).bytes == file.bytes);
			writeFile(path, file.bytes);
			CHECK(holdsVolumes(file.bytes));
			VolumeFileFacts facts;
			CHECK(sameVolumes(readVolumes(path, facts), rounded));
			CHECK(facts.level == "level \"x\"");
			CHECK(facts.generator == "nook test");
			CHECK(facts.layout == layout);
			CHECK(facts.compressed == compress);
			CHECK(facts.greatest_error_m == file.packed.greatest_error_m);
			CHECK(facts.vertices == (layout == VolumeLayout::prisms ? file.packed.vertices.size() : 0));
			CHECK(facts.indices == file.packed.indices.size());
			nook_volumes::Volumes opened;
			REQUIRE(ExactBytes(file.bytes).open(opened) == nullptr);
			sizes[std::string(layout == VolumeLayout::prisms ? "prisms" : "polygons") + (compress ? " compressed" : "")] =
				file.bytes.size();
		}
	}
	CHECK(sizes["polygons compressed"] < sizes["polygons"]);
	CHECK(sizes["prisms compressed"] < sizes["prisms"]);
	CHECK(sizes["polygons"] < sizes["prisms"]);
}

TEST_CASE("emit: compressed polygons share corners and are read back unchanged", "[emit][volume]")
{
	const TemporaryFolder folder;
	VolumeSet volumes = randomVolumes(0);
	constexpr int kSide = 20;
	for (int i = 0; i < kSide * kSide; ++i) // a honeycomb on a slope, and its triangles above
	{
		const glm::dvec2 at(2 * (i % kSide) + i / kSide, 2 * (i / kSide));
		Corners corners;
		for (const glm::dvec2 corner : {glm::dvec2(0, 1), {1, 0}, {2, 1}, {2, 2}, {1, 3}, {0, 2}})
		{
			corners.emplace_back(0.0625 * (at + corner), 0.01 * (at.x + corner.x));
		}
		volumes.occluders.add({}, corners);
		for (glm::dvec3& corner : corners)
		{
			corner.z += 0.3;
		}
		volumes.occluders.add({}, Corners{corners[0], corners[2], corners[4]});
	}
	volumes = clustered(volumes);
	const VolumeSet plain = unpacked(packVolumes(volumes, {}, {}), volumes);
	const VolumeFile file = volumeGlb(volumes, {VolumeLayout::polygons, true}, "level", "nook test", {});
	CHECK(2 * file.packed.vertices.size() < plain.occluders.corners.size());
	writeFile(folder / "v.glb", file.bytes);
	const VolumeSet read = readVolumes(folder / "v.glb");
	REQUIRE(read.occluders.polygons.size() == plain.occluders.polygons.size());
	for (std::size_t i = 0; i < plain.occluders.polygons.size(); ++i)
	{
		const std::span<const glm::dvec3> expected = plain.occluders.cornersOf(plain.occluders.polygons[i]);
		const std::span<const glm::dvec3> found = read.occluders.cornersOf(read.occluders.polygons[i]);
		std::vector<glm::dvec3> turned(found.begin(), found.end());
		const auto first = std::find(turned.begin(), turned.end(), expected[0]); // the codec may start at another corner
		REQUIRE(first != turned.end());
		std::rotate(turned.begin(), first, turned.end());
		REQUIRE(std::equal(turned.begin(), turned.end(), expected.begin(), expected.end()));
	}
	const Level scene = loadLevel(folder / "v.glb", {}, {}).level;
	CHECK(scene.triangles.size() == file.packed.indices.size() / 3);
}

TEST_CASE("emit: a reader without a decoder refuses compressed volumes and reads others", "[emit][volume]")
{
	const VolumeSet volumes = clustered(randomVolumes(30));
	const std::string plain = glbOf(volumes);
	const std::string compressed = glbOf(volumes, {VolumeLayout::polygons, true});
	nook_volumes::Volumes opened;
	REQUIRE(opened.open(plain.data(), plain.size()) == nullptr);
	CHECK(opened.polygonCount() == 30);
	CHECK(opened.header().distance == 0.75);
	CHECK(opened.compensated(0.0) == 0.0);
	CHECK(opened.compensated(0.5) == Approx(0.5 - 0.25 * 0.25));
	CHECK(opened.compensated(1.0 / 64.0) == Approx(volumes.compensation.at(1.0 / 64.0)));
	CHECK(opened.compensated(7.0) == 0.75);
	CHECK(std::string(opened.open(compressed.data(), compressed.size())) == "compressed arrays, and no decoder");
	CHECK(opened.polygonCount() == 0);
	const std::string odd = " " + plain;
	CHECK(std::string(opened.open(odd.data() + 1, plain.size())) == "bytes that do not lie at a multiple of 8");
	CHECK(opened.open(nullptr, 100) != nullptr);
}

TEST_CASE("emit: the scene of a volume file is what its arrays hold", "[emit][volume]")
{
	const TemporaryFolder folder;
	const glm::dvec3 middle = GENERATE(glm::dvec3(0.0), glm::dvec3(1e5, 0.0, -9e4));
	const VolumeSet volumes = clustered(randomVolumes(300, middle));
	const VolumeFile polygons = volumeGlb(volumes, {}, "test", "nook test", {});
	const VolumeSet rounded = unpacked(polygons.packed, volumes);
	writeFile(folder / "v.glb", polygons.bytes);
	const Level level = loadLevel(folder / "v.glb", {}, {}).level;
	CHECK(level.triangles.size() == polygons.packed.indices.size() / 3);
	std::set<std::array<double, 3>> corners;
	for (const glm::dvec3 p : rounded.occluders.corners)
	{
		corners.insert({p.x, p.y, p.z});
	}
	const std::size_t found = sumOver(level.positions, [&](const glm::dvec3 p) { return corners.count({p.x, p.y, p.z}); });
	CHECK(found == level.positions.size());

	const VolumeFile prisms = volumeGlb(volumes, {VolumeLayout::prisms, false}, "test", "nook test", {});
	writeFile(folder / "v.glb", prisms.bytes);
	const Bounds bounds = boundsOf(loadLevel(folder / "v.glb", {}, {}).level);
	glm::dvec3 least(1e300);
	glm::dvec3 most(-1e300);
	for (const VolumeCluster& cluster : rounded.clusters)
	{
		least = glm::min(least, cluster.least);
		most = glm::max(most, cluster.most);
	}
	CHECK(glm::distance(bounds.least, least) < 0.01);
	CHECK(glm::distance(bounds.most, most) < 0.01);
}

const std::array<VolumeFileSettings, 3> kPrismsPackedShared{
	{{VolumeLayout::prisms, false}, {VolumeLayout::prisms, true}, {VolumeLayout::polygons, true}}};

TEST_CASE("emit: every truncation of a volume file is refused", "[emit][volume]")
{
	const VolumeSet volumes = clustered(randomVolumes(12), 5);
	const VolumeFileSettings settings = GENERATE(from_range(kPrismsPackedShared));
	const std::string whole = glbOf(volumes, settings);
	for (std::size_t size = 0; size < whole.size(); ++size)
	{
		std::string part = whole.substr(0, size);
		nook_volumes::Volumes opened;
		REQUIRE(ExactBytes(part).open(opened) != nullptr);
		if (size >= 12) // corrects the file's length; and that of the chunk
		{
			const auto length = static_cast<uint32_t>(size);
			std::memcpy(part.data() + 8, &length, sizeof length);
			REQUIRE(ExactBytes(part).open(opened) != nullptr);
			uint32_t text = 0;
			std::memcpy(&text, whole.data() + 12, sizeof text);
			if (size >= 28 + text)
			{
				const auto chunk = static_cast<uint32_t>(size - 28 - text);
				std::memcpy(part.data() + 20 + text, &chunk, sizeof chunk);
				const bool padding = size + 16 > whole.size(); // only padding of the last array is missing
				REQUIRE((ExactBytes(part).open(opened) != nullptr || padding));
			}
		}
		REQUIRE(opened.polygonCount() <= 12);
	}
}

TEST_CASE("emit: volume files with some bytes changed are refused or safe to use", "[emit][volume]")
{
	const TemporaryFolder folder;
	const VolumeSet volumes = clustered(randomVolumes(40), 16);
	Random random(3);
	std::size_t refused = 0;
	std::size_t used = 0;
	const std::vector<std::string> wholes =
		mapped(kPrismsPackedShared, [&](const VolumeFileSettings& settings) { return glbOf(volumes, settings); });
	for (int round = 0; round < 6000; ++round)
	{
		std::string changed = wholes[static_cast<std::size_t>(round) / 24 % 3];
		uint32_t text = 0;
		std::memcpy(&text, changed.data() + 12, sizeof text);
		for (int i = 0; i < 2; ++i)
		{
			// Mostly where the reader looks; bit flips, small numbers and random ones.
			const uint32_t from = round % 4 < 2 ? 20 + text : 0;
			const uint32_t span = round % 8 < 4 ? 700 : static_cast<uint32_t>(changed.size()) - from;
			char& byte = changed[from + random.below(std::min(span, static_cast<uint32_t>(changed.size()) - from))];
			byte = static_cast<char>(round % 3 == 0 ? byte ^ (1 << random.below(8)) : static_cast<int>(random.below(256)));
		}
		nook_volumes::Volumes opened;
		const ExactBytes bytes(changed);
		if (bytes.open(opened) == nullptr)
		{
			used += 1;
			REQUIRE_FALSE(std::isnan(walked(opened)));
		}
		else
		{
			refused += 1;
		}
		if (round % 20 == 0)
		{
			writeFile(folder / "v.glb", changed);
			try
			{
				const VolumeSet read = readVolumes(folder / "v.glb");
				REQUIRE(read.occluders.polygons.size() <= 40);
			}
			catch (const Error& error)
			{
				REQUIRE(error.code() == ExitCode::invalid_input);
				REQUIRE(std::string(error.what()).find(folder / "v.glb") == 0);
			}
		}
	}
	CHECK(refused > 500);
	CHECK(used > 500);
}

TEST_CASE("emit: a level that needs no volume has a file of none", "[emit][volume]")
{
	const TemporaryFolder folder;
	VolumeSet none;
	none.distance_m = 1.5;
	const VolumeLayout layout = GENERATE(VolumeLayout::polygons, VolumeLayout::prisms);
	const bool compress = GENERATE(false, true);
	const std::string file = glbOf(none, {layout, compress});
	nook_volumes::Volumes opened;
	const ExactBytes bytes(file);
	REQUIRE(bytes.open(opened) == nullptr);
	CHECK(opened.polygonCount() + opened.cornerCount() + opened.clusterCount() == 0);
	CHECK(opened.header().distance == 1.5);
	CHECK(opened.hasPrisms() == (layout == VolumeLayout::prisms));
	CHECK(file.find("\"nodes\"") == std::string::npos); // glTF allows no empty lists
	CHECK(file.find("\"meshes\"") == std::string::npos);
	writeFile(folder / "v.glb", file);
	const VolumeSet read = readVolumes(folder / "v.glb");
	CHECK(read.occluders.polygons.empty());
	CHECK(read.distance_m == 1.5);
}

TEST_CASE("emit: a level's file and other files are no volumes", "[emit][volume]")
{
	const TemporaryFolder folder;
	CHECK_FALSE(holdsVolumes(""));
	CHECK_FALSE(holdsVolumes("glTF"));
	writeFile(folder / "v.glb", "no glTF");
	CHECK_THROWS_AS(readVolumes(folder / "v.glb"), Error);
	CHECK_THROWS_AS(readVolumes(folder / "none.glb"), Error);
}
