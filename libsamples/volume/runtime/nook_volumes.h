// SPDX-License-Identifier: MIT
// Reads the occlusion volumes that `nook volumes` wrote, for engines that need no glTF library. C++17, no dependency, this file
// alone.
//
//	nook_volumes::Volumes volumes;
//	if (const char* const problem = volumes.open(bytes, size)) { … } // bytes of the .glb: a mapped file will do
//	upload(volumes.corners(), volumes.cornerCount() * sizeof(nook_volumes::Corner)); // buffer texture RGBA16UI, or SSBO
//
// Nothing is copied but a compressed array's content, so the bytes must stay where they are. Nothing is read outside of them, and
// after open() every index is in range: file contents can be relied on, also those of a hostile file. Units are metres.
//
// The numbers of a file are little-endian, as those of this machine have to be.
#ifndef NOOK_VOLUMES_H
#define NOOK_VOLUMES_H

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace nook_volumes
{

constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kExactBounds = 1;  // flags of Header: volumes hold every point with a falloff > 0
constexpr std::uint32_t kHasPrisms = 2;    // vertices and indices are prisms; else indices are of the polygons' corners
constexpr std::uint8_t kTwoSided = 1;      // flag of Polygon: darkens what lies before its back, too
constexpr double kReachSteps = 128.0;      // of the distance: what the other bits of those flags count
constexpr double kSideSteps = 8.0;         // of that reach: what the upper bits of corner_bits count
constexpr std::size_t kKnots = 33;         // of the compensation curve
constexpr std::uint32_t kMostCorners = 16; // of a polygon

// A corner of a polygon, or a point of a prism: world = origin + step * (x, y, z) of the cluster, exact in 64 bits.
struct Corner
{
	std::uint16_t x, y, z;
	std::uint16_t polygon; // which of the cluster's
};

// Convex; its corners are consecutive and run counter-clockwise seen from its front.
struct Polygon
{
	std::uint32_t first_corner; // of the whole file
	std::uint8_t corner_bits;   // low five: how many, 3 to 16; upper three: eighths of its reach by which its sides reach less far
	std::uint8_t flags;         // kTwoSided; the other seven bits: 1/128 of the distance by which its volume is shorter
	std::uint16_t alpha;        // share of light that it stops, 65535 is all
};

inline std::uint32_t cornerCountOf(const Polygon& polygon)
{
	return polygon.corner_bits & 31U;
}

// Share of the distance that a polygon's volume reaches, 1/128 to 1: what is further above it gets nothing. The falloff within is
// that of the whole distance.
inline double reachOf(const Polygon& polygon)
{
	return 1.0 - (polygon.flags >> 1) / kReachSteps;
}

// The same of what is beyond an edge.
inline double sideReachOf(const Polygon& polygon)
{
	return reachOf(polygon) * (1.0 - (polygon.corner_bits >> 5) / kSideSteps);
}

// Polygons that lie close together: draw or leave out all of them. Steps are powers of two, origins whole multiples of them.
struct Cluster
{
	double origin[3];        // of corners, world space
	double vertex_origin[3]; // of prisms
	float step[3];
	float vertex_step[3];
	float least[3]; // box of all points that its volumes reach, counted from `origin`
	float most[3];
	std::uint32_t first_polygon, polygon_count;
	std::uint32_t first_corner, corner_count;
	std::uint32_t first_vertex, vertex_count; // of prisms; 0 where the file has none
	std::uint32_t first_index, index_count;   // triangles; they count from first_vertex, or first_corner where there are no prisms
};

// How an array lies in the file.
enum Encoding : std::uint16_t
{
	kPlain = 0,
	kMeshoptVertices = 1,  // meshopt_decodeVertexBuffer
	kMeshoptTriangles = 2, // meshopt_decodeIndexBuffer
};

struct Array
{
	std::uint64_t offset; // from the header's first byte, a multiple of 16
	std::uint64_t bytes;  // in the file
	std::uint32_t count;
	std::uint16_t stride; // bytes of an item, decoded
	std::uint16_t encoding;
};

enum ArrayName : std::size_t
{
	kClusters,
	kPolygons,
	kCorners,
	kIndices,
	kVertices,
	kArrays,
};

// The first bytes of the binary chunk of the file.
struct Header
{
	char magic[8]; // "NOOKVOLS"
	std::uint32_t version;
	std::uint32_t flags;
	double distance;          // how far a volume reaches, metres
	double ray_distance;      // radius of the ray-traced reference with linear falloff that it stands for, metres
	double origin[3];         // what the nodes of the glTF scene count from; not needed here
	double greatest_error;    // distance of a corner from where the level had it, at most, metres
	double plane_error;       // of a surface from the plane of its polygon; within that of a plane nothing can be told, metres
	double sum_range;         // the compensation curve's last knot; constant beyond
	double occlusion[kKnots]; // at sum_range * i / 32; linear between
	Array arrays[kArrays];
};

static_assert(sizeof(Corner) == 8 && sizeof(Polygon) == 8 && sizeof(Cluster) == 128 && sizeof(Array) == 24, "as in the file");
static_assert(sizeof(Header) == 464, "as in the file");

// The decoder of meshoptimizer that an encoding names; 0: done. Only files made with --compress need them.
using Decode = int (*)(void* destination, std::size_t count, std::size_t stride, const unsigned char* source, std::size_t size);
struct Decoders
{
	Decode vertices = nullptr;
	Decode triangles = nullptr;
};

class Volumes
{
public:
	Volumes() = default;
	Volumes(Volumes&&) = default;
	Volumes& operator=(Volumes&&) = default;
	Volumes(const Volumes&) = delete; // arrays of compressed files lie in here
	Volumes& operator=(const Volumes&) = delete;

	// Null, or what is wrong with the file, in a few words. `bytes` must lie at a multiple of 8, as mapped files and blocks of
	// memory do.
	const char* open(const void* bytes, std::size_t size, const Decoders& decoders = {})
	{
		*this = Volumes();
		const char* problem = findHeader(static_cast<const unsigned char*>(bytes), size);
		problem = problem ? problem : checkHeader();
		for (std::size_t i = 0; i < kArrays && !problem; ++i)
		{
			problem = openArray(i, decoders);
		}
		problem = problem ? problem : checkClusters();
		if (problem)
		{
			*this = Volumes();
		}
		return problem;
	}

	// Of the file that open() has taken; all zeros before.
	const Header& header() const
	{
		static constexpr Header kNone = {};
		return m_chunk ? *reinterpret_cast<const Header*>(m_chunk) : kNone;
	}
	const Cluster* clusters() const
	{
		return items<Cluster>(kClusters);
	}
	const Polygon* polygons() const
	{
		return items<Polygon>(kPolygons);
	}
	const Corner* corners() const
	{
		return items<Corner>(kCorners);
	}
	const std::uint16_t* indices() const
	{
		return items<std::uint16_t>(kIndices);
	}
	const Corner* vertices() const
	{
		return items<Corner>(kVertices);
	}
	std::size_t clusterCount() const
	{
		return m_count[kClusters];
	}
	std::size_t polygonCount() const
	{
		return m_count[kPolygons];
	}
	std::size_t cornerCount() const
	{
		return m_count[kCorners];
	}
	std::size_t indexCount() const
	{
		return m_count[kIndices];
	}
	std::size_t vertexCount() const
	{
		return m_count[kVertices];
	}
	bool hasPrisms() const
	{
		return (header().flags & kHasPrisms) != 0;
	}

	// World space.
	void position(const Cluster& cluster, const Corner& corner, double world[3]) const
	{
		const std::uint16_t at[3] = {corner.x, corner.y, corner.z};
		for (int i = 0; i < 3; ++i)
		{
			world[i] = cluster.origin[i] + static_cast<double>(cluster.step[i]) * at[i];
		}
	}

	// The sum of all volumes' occlusion at a point → its occlusion.
	double compensated(double sum) const
	{
		const double at = sum > 0.0 ? sum / header().sum_range * (kKnots - 1) : 0.0;
		if (!(at < kKnots - 1))
		{
			return header().occlusion[kKnots - 1];
		}
		const auto knot = static_cast<std::size_t>(at);
		const double share = at - static_cast<double>(knot);
		return header().occlusion[knot] * (1.0 - share) + header().occlusion[knot + 1] * share;
	}

private:
	static std::uint32_t word(const unsigned char* bytes)
	{
		std::uint32_t value = 0;
		std::memcpy(&value, bytes, sizeof value);
		return value;
	}

	// glTF 2.0, section 4.4: a header of 12 bytes, then chunks of a length, a kind and content; the second one is binary.
	const char* findHeader(const unsigned char* bytes, std::size_t size)
	{
		if (!bytes || size < 20 || std::memcmp(bytes, "glTF", 4) != 0 || word(bytes + 4) != 2)
		{
			return "no binary glTF 2.0";
		}
		if (reinterpret_cast<std::uintptr_t>(bytes) % 8 != 0)
		{
			return "bytes that do not lie at a multiple of 8";
		}
		if (word(bytes + 8) != size)
		{
			return "another length than the file says";
		}
		const std::size_t text = word(bytes + 12);
		if (word(bytes + 16) != 0x4E4F534AU || text > size - 20 || size - 20 - text < 8)
		{
			return "no chunk of JSON before a binary one";
		}
		const unsigned char* const chunk = bytes + 20 + text;
		if (word(chunk + 4) != 0x004E4942U || word(chunk) > size - 28 - text)
		{
			return "no binary chunk";
		}
		m_chunk = chunk + 8;
		m_size = word(chunk);
		if (m_size < sizeof(Header) || reinterpret_cast<std::uintptr_t>(m_chunk) % 8 != 0 ||
			std::memcmp(m_chunk, "NOOKVOLS", 8) != 0)
		{
			return "glTF without volumes of nook";
		}
		return nullptr;
	}

	static bool within(double value, double least, double most)
	{
		return value >= least && value <= most; // not NaN
	}

	const char* checkHeader() const
	{
		const Header& head = header();
		if (head.version != kVersion)
		{
			return "another version of the format than 1";
		}
		if ((head.flags & ~(kExactBounds | kHasPrisms)) != 0)
		{
			return "unknown flags";
		}
		bool good = within(head.distance, 1e-30, 1e30) && within(head.ray_distance, 0.0, 1e30) &&
					within(head.greatest_error, 0.0, 1e30) && within(head.plane_error, 0.0, 1e30) &&
					within(head.sum_range, 1e-30, 1e30);
		for (const double value : head.origin)
		{
			good = good && within(value, -1e30, 1e30);
		}
		double before = 0.0;
		for (const double value : head.occlusion)
		{
			good = good && within(value, before, 1.0);
			before = value;
		}
		return good ? nullptr : "numbers out of range in the header";
	}

	const char* openArray(std::size_t i, const Decoders& decoders)
	{
		constexpr std::size_t kStrides[kArrays] = {sizeof(Cluster), sizeof(Polygon), sizeof(Corner), 2, sizeof(Corner)};
		const Array& array = header().arrays[i];
		if (array.offset % 16 != 0 || array.offset > m_size || array.bytes > m_size - array.offset)
		{
			return "an array that reaches beyond the file";
		}
		if (array.stride != kStrides[i])
		{
			return "an array with items of another size";
		}
		const std::uint64_t plain = std::uint64_t{array.count} * array.stride;
		const unsigned char* const source = m_chunk + array.offset;
		m_count[i] = array.count;
		if (array.encoding == kPlain)
		{
			m_items[i] = source;
			return plain == array.bytes ? nullptr : "an array with another length than its items";
		}
		const bool triangles = array.encoding == kMeshoptTriangles;
		if ((!triangles && array.encoding != kMeshoptVertices) || triangles != (i == kIndices) || i == kClusters)
		{
			return "an unknown encoding";
		}
		const Decode decode = triangles ? decoders.triangles : decoders.vertices;
		if (!decode)
		{
			return "compressed arrays, and no decoder";
		}
		// meshoptimizer needs 2 bits at least for 16 bytes of items, 1 byte for a triangle.
		if (plain / 64 > array.bytes || plain > static_cast<std::size_t>(-1) || (triangles && array.count % 3 != 0))
		{
			return "an array that holds more than its bytes can say";
		}
		std::vector<unsigned char>& decoded = m_decoded[i];
		decoded.resize(static_cast<std::size_t>(plain));
		m_items[i] = decoded.data();
		const int result = decode(decoded.data(), array.count, array.stride, source, static_cast<std::size_t>(array.bytes));
		return result == 0 ? nullptr : "compressed bytes that cannot be decoded";
	}

	// Every range of a cluster begins where the last one ended.
	const char* checkClusters() const
	{
		std::uint64_t polygon = 0;
		std::uint64_t corner = 0;
		std::uint64_t vertex = 0;
		std::uint64_t index = 0;
		for (std::size_t i = 0; i < clusterCount(); ++i)
		{
			const Cluster& cluster = clusters()[i];
			if (cluster.first_polygon != polygon || cluster.first_corner != corner || cluster.first_vertex != vertex ||
				cluster.first_index != index)
			{
				return "clusters with gaps between them";
			}
			polygon += cluster.polygon_count;
			corner += cluster.corner_count;
			vertex += cluster.vertex_count;
			index += cluster.index_count;
			if (polygon > polygonCount() || corner > cornerCount() || vertex > vertexCount() || index > indexCount())
			{
				return "clusters of more than there is";
			}
			const char* problem = checkFrame(cluster);
			problem = problem ? problem : checkPolygons(cluster);
			problem = problem ? problem : checkTriangles(cluster);
			if (problem)
			{
				return problem;
			}
		}
		const bool all = polygon == polygonCount() && corner == cornerCount() && vertex == vertexCount() && index == indexCount();
		return all ? nullptr : "clusters of less than there is";
	}

	static const char* checkFrame(const Cluster& cluster)
	{
		bool good = cluster.polygon_count >= 1 && cluster.polygon_count <= 65536;
		for (int i = 0; i < 3; ++i)
		{
			const auto least = static_cast<double>(cluster.least[i]);
			good = good && within(cluster.origin[i], -1e30, 1e30) && within(cluster.vertex_origin[i], -1e30, 1e30) &&
				   within(static_cast<double>(cluster.step[i]), 1e-30, 1e30) &&
				   within(static_cast<double>(cluster.vertex_step[i]), 0.0, 1e30) && within(least, -1e30, 1e30) &&
				   within(static_cast<double>(cluster.most[i]), least, 1e30);
		}
		return good ? nullptr : "numbers out of range in a cluster";
	}

	const char* checkPolygons(const Cluster& cluster) const
	{
		std::uint64_t corner = cluster.first_corner;
		for (std::uint32_t i = 0; i < cluster.polygon_count; ++i)
		{
			const Polygon& polygon = polygons()[cluster.first_polygon + i];
			if (polygon.first_corner != corner || cornerCountOf(polygon) < 3 || cornerCountOf(polygon) > kMostCorners ||
				polygon.alpha == 0)
			{
				return "a polygon that cannot be";
			}
			corner += cornerCountOf(polygon);
			if (corner > std::uint64_t{cluster.first_corner} + cluster.corner_count)
			{
				return "polygons of more corners than their cluster";
			}
			for (std::uint64_t c = polygon.first_corner; c < corner; ++c)
			{
				if (corners()[c].polygon != i)
				{
					return "a corner of another polygon";
				}
			}
		}
		return corner == std::uint64_t{cluster.first_corner} + cluster.corner_count ? nullptr : "corners without a polygon";
	}

	const char* checkTriangles(const Cluster& cluster) const
	{
		if (cluster.index_count % 3 != 0 || (!hasPrisms() && cluster.vertex_count != 0))
		{
			return "a cluster with a part of a triangle";
		}
		const std::uint32_t most = hasPrisms() ? cluster.vertex_count : cluster.corner_count;
		for (std::uint32_t i = 0; i < cluster.index_count; ++i)
		{
			if (indices()[cluster.first_index + i] >= most)
			{
				return "an index beyond its cluster";
			}
		}
		for (std::uint32_t i = 0; i < cluster.vertex_count; ++i)
		{
			if (vertices()[cluster.first_vertex + i].polygon >= cluster.polygon_count)
			{
				return "a prism of no polygon";
			}
		}
		return nullptr;
	}

	template <class Item> const Item* items(std::size_t array) const
	{
		return reinterpret_cast<const Item*>(m_items[array]);
	}

	const unsigned char* m_chunk = nullptr;
	std::size_t m_size = 0;
	const unsigned char* m_items[kArrays] = {};
	std::size_t m_count[kArrays] = {};
	std::vector<unsigned char> m_decoded[kArrays];
};

} // namespace nook_volumes

#endif
