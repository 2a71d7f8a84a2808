// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes as files: 16-bit round trips, and no file breaks its reader.
#include "core/error.h"
#include "core/file.h"
#include "core/random.h"
#include "core/text.h"
#include "scene/load.h"
#include "volume/packed.h"
#include "volume/volume_glb.h"

#include "random_volumes.h"
#include "temporary_folder.h"

#include <catch2/catch.hpp>

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <set>

using namespace nook;
using namespace nook::test;

namespace
{

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
			sum += volumes.hasPrisms() ? volumes.vertices()[cluster.first_vertex + at].x
									   : volumes.corners()[cluster.first_corner + at].x;
		}
	}
	return sum;
}

} // namespace

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
	for (const glm::dvec3 middle : {glm::dvec3(0.0), glm::dvec3(1e5, 0.0, -9e4)})
	{
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
				CHECK(facts.vertices == file.packed.vertices.size());
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
	for (const glm::dvec3 middle : {glm::dvec3(0.0), glm::dvec3(1e5, 0.0, -9e4)})
	{
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
		std::size_t found = 0;
		for (const glm::dvec3 p : level.positions)
		{
			found += corners.count({p.x, p.y, p.z});
		}
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
}

TEST_CASE("emit: every truncation of a volume file is refused", "[emit][volume]")
{
	const VolumeSet volumes = clustered(randomVolumes(12), 5);
	for (const bool compress : {false, true})
	{
		const std::string whole = glbOf(volumes, {VolumeLayout::prisms, compress});
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
}

TEST_CASE("emit: volume files with some bytes changed are refused or safe to use", "[emit][volume]")
{
	const TemporaryFolder folder;
	const VolumeSet volumes = clustered(randomVolumes(40), 16);
	Random random(3);
	std::size_t refused = 0;
	std::size_t used = 0;
	for (int round = 0; round < 4000; ++round)
	{
		const bool compress = round % 2 == 1;
		static const std::array<std::string, 2> kWhole{glbOf(volumes, {VolumeLayout::prisms, false}),
													   glbOf(volumes, {VolumeLayout::prisms, true})};
		std::string changed = kWhole[compress ? 1 : 0];
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
	for (const VolumeLayout layout : {VolumeLayout::polygons, VolumeLayout::prisms})
	{
		for (const bool compress : {false, true})
		{
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
	}
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
