// SPDX-License-Identifier: MIT
// Reads a file of occlusion volumes that `nook volumes` wrote. No glTF library is needed: C++17, no dependencies, this file alone.
//
//	nook_volumes::Volumes volumes;
//	if (const char* const problem = volumes.open(bytes, size)) { … } // bytes of the .glb, of a mapped file for instance
//	upload(volumes.corners(), volumes.cornerCount() * sizeof(nook_volumes::Corner)); // buffer texture RGBA16UI, or SSBO
//
// Only the content of compressed arrays is copied, so the bytes must stay where they are. Nothing is read outside them, and after
// open() every index is in range, even for a hostile file. Units are metres.
//
// The numbers of a file are little-endian, and this machine has to be.
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
constexpr std::uint32_t kExactBounds = 1;   // flag of Header: volumes contain every point with a falloff > 0
constexpr std::uint32_t kHasPrisms = 2;     // flag of Header: it has prisms
constexpr std::uint32_t kSharedCorners = 4; // flag of Header: polygons share corners, which are stored once, as vertices
constexpr std::uint8_t kTwoSided = 1;       // flag of Polygon: occludes on both sides
constexpr double kReachSteps = 128.0;       // the other bits of the flags count 1/128 of the distance
constexpr double kSideSteps = 8.0;          // the upper bits of corner_bits count eighths of that reach
constexpr std::size_t kKnots = 33;          // knots of the compensation curve
constexpr std::uint32_t kMostCorners = 16;  // maximum corners per polygon

// A corner of a polygon, or a vertex of a prism: world position = origin + step * (x, y, z), with origin and step of its cluster;
// exact in 64 bits.
struct Corner
{
	std::uint16_t x, y, z;
	std::uint16_t polygon; // number of the polygon in its cluster
};

// A convex polygon. Its corners are consecutive and counter-clockwise as seen from its front.
struct Polygon
{
	std::uint32_t first_corner; // index among all corners of the file
	std::uint8_t corner_bits; // low five bits: number of corners, 3 to 16; upper three: by how many eighths of its reach it reaches
							  // less far beyond its edges
	std::uint8_t flags;       // kTwoSided; the other seven bits: by how many 1/128 of the distance its reach is shorter
	std::uint16_t alpha;      // share of the light that it blocks; 65535 is all of it
};

inline std::uint32_t cornerCountOf(const Polygon& polygon)
{
	return polygon.corner_bits & 31U;
}

// How far the volume of a polygon extends along its normal, as a fraction of the distance, 1/128 to 1; it occludes nothing beyond.
// The falloff inside is still that of the whole distance.
inline double reachOf(const Polygon& polygon)
{
	return 1.0 - (polygon.flags >> 1) / kReachSteps;
}

// How far the volume extends beyond the edges of its polygon, as a fraction of the distance.
inline double sideReachOf(const Polygon& polygon)
{
	return reachOf(polygon) * (1.0 - (polygon.corner_bits >> 5) / kSideSteps);
}

// Polygons that lie close together and are drawn or culled as one. Steps are powers of two; origins are integer multiples of them.
struct Cluster
{
	double origin[3];        // origin of corners, world space
	double vertex_origin[3]; // origin of vertices
	float step[3];
	float vertex_step[3];
	float least[3]; // bounds of its volumes, relative to `origin`
	float most[3];
	std::uint32_t first_polygon, polygon_count;
	std::uint32_t first_corner, corner_count;
	std::uint32_t first_vertex, vertex_count; // vertices of prisms, or shared corners; 0 where the file has neither
	std::uint32_t first_index, index_count;   // triangles, relative to first_vertex, or to first_corner without vertices
};

// Where an array is in the file.
enum Encoding : std::uint16_t
{
	kPlain = 0,
	kMeshoptVertices = 1,  // meshopt_decodeVertexBuffer
	kMeshoptTriangles = 2, // meshopt_decodeIndexBuffer
};

struct Array
{
	std::uint64_t offset; // from the first byte of the header, a multiple of 16
	std::uint64_t bytes;  // in the file
	std::uint32_t count;
	std::uint16_t stride; // bytes per decoded item
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
	double distance;       // how far a volume reaches, metres
	double ray_distance;   // radius of ray-traced occlusion with linear falloff that it corresponds to, metres
	double origin[3];      // the nodes of the glTF scene are relative to it; not needed here
	double greatest_error; // largest distance of a corner from its position in the level, metres
	double plane_error;    // largest distance of a surface from the plane of its polygon, metres: a receiver so close to a plane is
						   // not occluded
	double sum_range;      // summed occlusion at the last knot of the compensation curve; it is constant beyond
	double occlusion[kKnots]; // occlusion at the sum sum_range * i / 32; linear between knots
	Array arrays[kArrays];
};

static_assert(sizeof(Corner) == 8 && sizeof(Polygon) == 8 && sizeof(Cluster) == 128 && sizeof(Array) == 24, "as in the file");
static_assert(sizeof(Header) == 464, "as in the file");

// A meshoptimizer decoder for an encoding; returns 0 on success. Needed only for files made with --compress.
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
	Volumes(const Volumes&) = delete; // it owns the arrays of compressed files
	Volumes& operator=(const Volumes&) = delete;

	// Returns null, or a short description of what is wrong with the file. `bytes` must be aligned to 8, as mapped files and
	// allocated memory are.
	const char* open(const void* bytes, std::size_t size, const Decoders& decoders = {})
	{
		*this = Volumes();
		const char* problem = findHeader(static_cast<const unsigned char*>(bytes), size);
		problem = problem ? problem : checkHeader();
		for (std::size_t i = 0; i < kArrays && !problem; ++i)
		{
			problem = openArray(i, decoders);
		}
		problem = problem ? problem : expandCorners();
		problem = problem ? problem : checkClusters();
		if (problem)
		{
			*this = Volumes();
		}
		return problem;
	}

	// Header of the opened file; zeros before open().
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
	bool sharesCorners() const
	{
		return (header().flags & kSharedCorners) != 0;
	}

	// Position in world space.
	void position(const Cluster& cluster, const Corner& corner, double world[3]) const
	{
		const std::uint16_t at[3] = {corner.x, corner.y, corner.z};
		for (int i = 0; i < 3; ++i)
		{
			world[i] = cluster.origin[i] + static_cast<double>(cluster.step[i]) * at[i];
		}
	}

	// Converts the summed occlusion of all volumes at a point to its occlusion.
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

	// glTF 2.0, section 4.4: a header of 12 bytes, then chunks with a length, a type and content; the second chunk is binary.
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
		return value >= least && value <= most; // rejects NaN
	}

	const char* checkHeader() const
	{
		const Header& head = header();
		if (head.version != kVersion)
		{
			return "another version of the format than 1";
		}
		if ((head.flags & ~(kExactBounds | kHasPrisms | kSharedCorners)) != 0 || (hasPrisms() && sharesCorners()))
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
		// meshoptimizer needs at least 2 bits for 16 bytes of items, and 1 byte for a triangle.
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

	// Makes the corners of polygons from the triangles of a file that stores shared corners as vertices. A polygon of n corners has
	// n - 2 triangles; each after its first adds a corner, at an edge that it shares with those before. The decoder may have turned
	// triangles.
	const char* expandCorners()
	{
		if (!sharesCorners())
		{
			return nullptr;
		}
		std::uint64_t expected = 0;
		for (std::size_t i = 0; i < polygonCount(); ++i)
		{
			if (cornerCountOf(polygons()[i]) < 3 || cornerCountOf(polygons()[i]) > kMostCorners)
			{
				return "a polygon that cannot be";
			}
			expected += cornerCountOf(polygons()[i]);
		}
		if (cornerCount() != 0 || indexCount() != 3 * (expected - 2 * std::uint64_t{polygonCount()}))
		{
			return "other triangles than those of its polygons";
		}
		std::vector<unsigned char>& made = m_decoded[kCorners];
		made.resize(static_cast<std::size_t>(expected) * sizeof(Corner));
		m_items[kCorners] = made.data();
		m_count[kCorners] = static_cast<std::size_t>(expected);
		auto* corner = reinterpret_cast<Corner*>(made.data());
		const std::uint16_t* triangle = indices();
		std::size_t polygon = 0;
		for (std::size_t c = 0; c < clusterCount(); ++c)
		{
			const Cluster& cluster = clusters()[c];
			if (cluster.polygon_count > polygonCount() - polygon || cluster.first_vertex > vertexCount() ||
				cluster.vertex_count > vertexCount() - cluster.first_vertex)
			{
				return "clusters of more than there is";
			}
			for (std::uint32_t i = 0; i < cluster.polygon_count; ++i, ++polygon)
			{
				const std::uint32_t count = cornerCountOf(polygons()[polygon]);
				std::uint16_t ring[kMostCorners] = {};
				if (!joinTriangles(triangle, count, ring))
				{
					return "triangles that are no polygon";
				}
				triangle += 3 * (count - 2);
				for (std::uint32_t k = 0; k < count; ++k)
				{
					if (ring[k] >= cluster.vertex_count)
					{
						return "an index beyond its cluster";
					}
					*corner = vertices()[cluster.first_vertex + ring[k]];
					corner->polygon = static_cast<std::uint16_t>(i);
					++corner;
				}
			}
		}
		return polygon == polygonCount() ? nullptr : "clusters of less than there is";
	}

	static bool joinTriangles(const std::uint16_t* triangle, std::uint32_t count, std::uint16_t (&ring)[kMostCorners])
	{
		std::memcpy(ring, triangle, 3 * sizeof *ring);
		const auto placeOf = [&ring](std::uint32_t size, std::uint16_t corner)
		{
			std::uint32_t place = 0;
			while (place < size && ring[place] != corner)
			{
				++place;
			}
			return place;
		};
		for (std::uint32_t n = 3; n < count; ++n)
		{
			triangle += 3;
			std::uint32_t added = 0; // its corner that the ring lacks
			while (added < 3 && placeOf(n, triangle[added]) < n)
			{
				++added;
			}
			const std::uint32_t before = placeOf(n, triangle[(added + 2) % 3]);
			if (added == 3 || before == n || ring[(before + 1) % n] != triangle[(added + 1) % 3])
			{
				return false;
			}
			std::memmove(ring + before + 2, ring + before + 1, (n - 1 - before) * sizeof *ring);
			ring[before + 1] = triangle[added];
		}
		return true;
	}

	// Each cluster's ranges start where those of the previous cluster end.
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
		const bool has_vertices = hasPrisms() || sharesCorners();
		if (cluster.index_count % 3 != 0 || (!has_vertices && cluster.vertex_count != 0))
		{
			return "a cluster with a part of a triangle";
		}
		const std::uint32_t most = has_vertices ? cluster.vertex_count : cluster.corner_count;
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
