// SPDX-License-Identifier: GPL-3.0-or-later
// A tree of the volumes' bounding boxes (Embree 3) finds candidates; kernels evaluate them in polygon order, so that the result
// does not depend on the tree's layout.
#include "volume/evaluate.h"

#include "core/error.h"
#include "core/parallel.h"
#include "core/round.h"
#include "methods/aov_text.h"
#include "methods/volume_kernels.h"
#include "scene/tracer_tree.h"
#include "volume/volume_glb.h"
#include "volume/volumes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>

namespace nook
{

struct VolumeEvaluator::Data
{
	const VolumeSet& set;
	glm::dvec3 centre{0.0};
	float grown = 0.0F; // margin in metres, beyond rounding to 32 bits
	std::vector<glm::vec3> fronts;
	std::vector<glm::dvec3>
		rings;                    // extended outlines of the volumes in their planes, parallel to the corners; for clamped polygons
	std::vector<uint8_t> clamped; // clamped by AOV's 2δ: some points with a falloff > 0 lie outside
	std::vector<RTCBounds> boxes;
	RTCDevice device = nullptr;
	RTCScene scene = nullptr;
	uint64_t number; // no other evaluator's

	explicit Data(const VolumeSet& of) : set(of)
	{
		static std::atomic<uint64_t> count{0};
		number = ++count;
	}
	Data(const Data&) = delete;
	Data& operator=(const Data&) = delete;
	~Data()
	{
		rtcReleaseScene(scene);
		rtcReleaseDevice(device);
	}

	void place();
	void shape(std::size_t polygon);
	void build(const RunSettings& run);
	bool holds(const Occluder& polygon, glm::dvec3 front, glm::dvec3 position) const;
	const std::vector<uint32_t>& candidatesAt(glm::vec3 at, float radius) const;
	template <class Within, class Visit>
	uint32_t visit(glm::dvec3 position, glm::vec3 normal, double bias_m, const Within& within, const Visit& visit) const;
	template <class Use> uint32_t visitShares(glm::dvec3 position, glm::vec3 normal, double bias_m, const Use& use) const;
};

namespace
{

// Distances along the axes, not Euclidean.
bool isNear(const RTCBounds& box, glm::vec3 at, float radius)
{
	return at.x >= box.lower_x - radius && at.x <= box.upper_x + radius && at.y >= box.lower_y - radius &&
		   at.y <= box.upper_y + radius && at.z >= box.lower_z - radius && at.z <= box.upper_z + radius;
}

// Volumes near the last point of a thread, ascending. The next pixel is usually near it.
struct Candidates
{
	uint64_t evaluator = 0;
	const std::vector<RTCBounds>* boxes = nullptr;
	glm::vec3 at{0.0F};
	float radius = -1.0F;
	std::vector<uint32_t> found;
};

// A leaf of the tree has several boxes, not all of which contain the point.
bool collect(RTCPointQueryFunctionArguments* arguments)
{
	Candidates& candidates = *static_cast<Candidates*>(arguments->userPtr);
	if (isNear((*candidates.boxes)[arguments->primID], candidates.at, candidates.radius))
	{
		candidates.found.push_back(arguments->primID);
	}
	return false;
}

// Ascending. Long lists use radix sort with 11-bit digits: two to three times as fast as a comparison sort.
void sortIndices(std::vector<uint32_t>& indices, std::size_t below)
{
	constexpr std::size_t kFew = 192;
	constexpr unsigned kBits = 11;
	if (indices.size() < kFew)
	{
		std::sort(indices.begin(), indices.end());
		return;
	}
	thread_local std::vector<uint32_t> other;
	other.resize(indices.size());
	for (unsigned shift = 0; shift < 32 && (below >> shift) != 0; shift += kBits)
	{
		std::array<uint32_t, std::size_t{1} << kBits> ends{};
		const auto digitOf = [shift](uint32_t index)
		{
			return (index >> shift) & ((1U << kBits) - 1U);
		};
		for (const uint32_t index : indices)
		{
			ends[digitOf(index)] += 1;
		}
		uint32_t end = 0;
		for (uint32_t& count : ends)
		{
			const uint32_t begin = end;
			end += count;
			count = begin;
		}
		for (const uint32_t index : indices)
		{
			other[ends[digitOf(index)]++] = index;
		}
		indices.swap(other);
	}
}

void boundsOfBox(const RTCBoundsFunctionArguments* arguments)
{
	*arguments->bounds_o = (*static_cast<const std::vector<RTCBounds>*>(arguments->geometryUserPtr))[arguments->primID];
}

// Never called by queries, but Embree requires an intersection function.
void noHit(const RTCIntersectFunctionNArguments*) {}
void noOcclusion(const RTCOccludedFunctionNArguments*) {}

} // namespace

// The centre of all corners, and the rounding error of coordinates relative to it.
void VolumeEvaluator::Data::place()
{
	const Bounds box =
		set.occluders.corners.empty() ? Bounds{glm::dvec3(0.0), glm::dvec3(0.0)} : boundsAround(set.occluders.corners);
	centre = 0.5 * (box.least + box.most);
	const glm::dvec3 half = 0.5 * (box.most - box.least);
	grown = static_cast<float>(16.0 * kUnitRoundoff * (std::max({half.x, half.y, half.z}) + 64.0 * set.distance_m));
}

void VolumeEvaluator::Data::shape(std::size_t index)
{
	const Occluder& polygon = set.occluders.polygons[index];
	const std::span<const glm::dvec3> corners = set.occluders.cornersOf(polygon);
	const glm::dvec3 front = frontOf(corners);
	std::array<glm::dvec3, 2 * kMaxOccluderCorners> points;
	const std::span<glm::dvec3> used(points.data(), 2 * corners.size());
	const VolumeShape shape = shapeOf(set, polygon);
	prismOf(corners, front, shape, used);
	fronts[index] = glm::vec3(front);
	const Bounds box = boundsAround(used);
	for (std::size_t i = 0; i < corners.size(); ++i)
	{
		// Component within the plane; clamped corners (eq. 13's 2δ) end exactly there.
		const glm::dvec3 moved = used[i] - corners[i];
		const double across = glm::length(moved - glm::dot(moved, front) * front);
		clamped[index] |= !set.exact_bounds && across > (2.0 - 1e-9) * shape.distance_m * shape.side_share ? 1 : 0;
		rings[polygon.first_corner + i] = used[i];
	}
	const glm::vec3 low = glm::vec3(box.least - centre) - grown;
	const glm::vec3 high = glm::vec3(box.most - centre) + grown;
	boxes[index] = {low.x, low.y, low.z, 0.0F, high.x, high.y, high.z, 0.0F};
}

void VolumeEvaluator::Data::build(const RunSettings& run)
{
	device = newEmbreeDevice();
	scene = rtcNewScene(device);
	RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
	rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(boxes.size()));
	rtcSetGeometryUserData(geometry, &boxes);
	rtcSetGeometryBoundsFunction(geometry, boundsOfBox, nullptr);
	rtcSetGeometryIntersectFunction(geometry, noHit);
	rtcSetGeometryOccludedFunction(geometry, noOcclusion);
	rtcCommitGeometry(geometry);
	rtcAttachGeometryByID(scene, geometry, 0);
	rtcReleaseGeometry(geometry);
	onThreads(run.threads, [this] { rtcCommitScene(scene); });
	if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
	{
		throw Error(ExitCode::runtime,
					"volumes: found no memory left for a tree of " + std::to_string(boxes.size()) + " volumes, expected more");
	}
}

VolumeEvaluator::VolumeEvaluator(const VolumeSet& volumes, const RunSettings& run) : m_data(std::make_unique<Data>(volumes))
{
	assert(run.threads >= 1 && volumes.distance_m > 0.0);
	Data& data = *m_data;
	data.place();
	const std::size_t count = volumes.occluders.polygons.size();
	data.fronts.resize(count);
	data.clamped.resize(count);
	data.boxes.resize(count);
	data.rings.resize(volumes.occluders.corners.size());
	inBlocks(count, 1024, run, nullptr, [&data](std::size_t i) { data.shape(i); });
	data.build(run);
}

VolumeEvaluator::~VolumeEvaluator() = default;

// True if a point with a falloff above 0 is inside the clamped outline.
bool VolumeEvaluator::Data::holds(const Occluder& polygon, glm::dvec3 front, glm::dvec3 position) const
{
	const std::span<const glm::dvec3> ring = std::span(rings).subspan(polygon.first_corner, polygon.corner_count);
	glm::dvec3 a = ring.back();
	for (const glm::dvec3& b : ring)
	{
		if (glm::dot(glm::cross(front, b - a), position - a) < 0.0)
		{
			return false;
		}
		a = b;
	}
	return true;
}

const std::vector<uint32_t>& VolumeEvaluator::Data::candidatesAt(glm::vec3 at, float radius) const
{
	thread_local Candidates candidates;
	const glm::vec3 moved = glm::abs(at - candidates.at);
	if (candidates.evaluator != number || std::max({moved.x, moved.y, moved.z}) + radius > candidates.radius)
	{
		// Tuned on builtin:suburb: a smaller radius has more queries, a larger one more candidates.
		candidates = {number, &boxes, at, radius + 0.15F * static_cast<float>(set.distance_m), std::move(candidates.found)};
		candidates.found.clear();
		RTCPointQueryContext context;
		rtcInitPointQueryContext(&context);
		RTCPointQuery query{at.x, at.y, at.z, 0.0F, 1.7320509F * candidates.radius};
		rtcPointQuery(scene, &query, &context, collect, &candidates);
		sortIndices(candidates.found, set.occluders.polygons.size());
	}
	return candidates.found;
}

// Calls visit(index, kernels, front, height) for all volumes that contain the point, in order; returns how many. within() with the
// same arguments says whether a point at that height has a falloff above 0.
template <class Within, class Visit>
uint32_t VolumeEvaluator::Data::visit(glm::dvec3 position, glm::vec3 normal, double bias_m, const Within& within,
									  const Visit& visit) const
{
	const glm::vec3 at(position - centre);
	const auto bias = static_cast<float>(std::max({bias_m, kVolumeBias * set.distance_m, set.plane_error_m}));
	// A point that close behind the plane of one side may be lifted into the volume.
	const float radius = grown + bias;
	const auto reach = static_cast<float>(set.distance_m);
	std::array<glm::vec3, kMaxOccluderCorners> corners;
	volume_kernels::Kernels kernels;
	uint32_t count = 0;
	for (const uint32_t index : candidatesAt(at, radius))
	{
		if (!isNear(boxes[index], at, radius))
		{
			continue;
		}
		const Occluder& polygon = set.occluders.polygons[index];
		const std::span<const glm::dvec3> of = set.occluders.cornersOf(polygon);
		const glm::vec3 front = fronts[index];
		const float two_sided = polygon.two_sided ? 1.0F : 0.0F;
		corners[0] = glm::vec3(of[0] - position);
		kernels.corners = std::span(corners).first(of.size());
		const float lift = kernels.nookLift(kernels.nookHeight(front), two_sided, bias, glm::dot(normal, front));
		corners[0] -= lift * front;
		const float height = kernels.nookHeight(front);
		if (!kernels.nookReaches(height, two_sided, reach * polygon.reach, bias))
		{
			continue;
		}
		for (std::size_t i = 1; i < of.size(); ++i)
		{
			corners[i] = glm::vec3(of[i] - position) - lift * front;
		}
		if (within(index, kernels, front, height) && (clamped[index] == 0 || holds(polygon, glm::dvec3(front), position)))
		{
			count += 1;
			visit(index, kernels, front, height);
		}
	}
	return count;
}

// Calls use(polygon index, g · form factor) for all volumes that contain the point, in order; returns how many.
template <class Use>
uint32_t VolumeEvaluator::Data::visitShares(glm::dvec3 position, glm::vec3 normal, double bias_m, const Use& use) const
{
	float g = 0.0F;
	const auto within = [&](uint32_t index, volume_kernels::Kernels& kernels, glm::vec3 front, float height)
	{
		const Occluder& polygon = set.occluders.polygons[index];
		const auto count = static_cast<int>(kernels.corners.size());
		g = polygon.alpha *
			kernels.nookFalloff(count, front, std::fabs(height), static_cast<float>(set.distance_m), polygon.side_reach);
		return g > 0.0F;
	};
	const auto share = [&](uint32_t index, volume_kernels::Kernels& kernels, glm::vec3, float height)
	{
		use(index, g * kernels.nookFormFactor(static_cast<int>(kernels.corners.size()), normal, height < 0.0F ? -1.0F : 1.0F));
	};
	return visit(position, normal, bias_m, within, share);
}

VolumeSum VolumeEvaluator::sum(glm::dvec3 position, glm::dvec3 normal, double bias_m) const
{
	VolumeSum sum;
	sum.volumes = m_data->visitShares(position, glm::vec3(normal), bias_m,
									  [&](uint32_t, float share) { sum.occlusion += static_cast<double>(share); });
	return sum;
}

double VolumeEvaluator::occlusion(glm::dvec3 position, glm::dvec3 normal) const
{
	return sum(position, normal, 0.0).occlusion;
}

void VolumeEvaluator::shares(glm::dvec3 position, glm::dvec3 normal, std::vector<VolumeShare>& shares) const
{
	shares.clear();
	m_data->visitShares(position, glm::vec3(normal), 0.0,
						[&](uint32_t polygon, float share)
						{
							if (share > 0.0F)
							{
								shares.push_back({polygon, share});
							}
						});
}

namespace
{

using MaskBits = std::array<glm::uvec4, kMostDirections / 128>;

// Four edges at once, in vector types of GCC and Clang: for each the same operations as in the kernels.
using Floats = float __attribute__((vector_size(16)));
using Ints = int32_t __attribute__((vector_size(16)));
using Doubles = double __attribute__((vector_size(32)));

struct Vectors
{
	Floats x;
	Floats y;
	Floats z;
};

Floats dotOf(const Vectors& a, const Vectors& b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}

Vectors allOf(glm::vec3 v)
{
	return {Floats{} + v.x, Floats{} + v.y, Floats{} + v.z};
}

// a.y * b.z - b.y * a.z. Products of 32-bit floats are exact in 64 bits, as the kernel's split ones nearly are.
Floats exactProducts(Floats ay, Floats bz, Floats by, Floats az)
{
	const Doubles left = __builtin_convertvector(ay, Doubles) * __builtin_convertvector(bz, Doubles);
	return __builtin_convertvector(left - __builtin_convertvector(by, Doubles) * __builtin_convertvector(az, Doubles), Floats);
}

Floats magnitudeOf(Floats v)
{
	return v < 0.0F ? -v : v;
}

// A receiver of masks. Its functions return what those of mask.glsl and volume.glsl do, but compute the frame once per receiver, a
// length only for edges that may be too far, and only rays that no edge has ruled out.
class MaskReceiver
{
public:
	MaskReceiver(glm::vec3 normal, const MaskTables& tables, float reach)
		: m_normal(normal), m_x(m_kernels.nookTangent(normal, 0)), m_y(m_kernels.nookTangent(normal, 1)), m_tables(tables),
		  m_fours(static_cast<int>(tables.rays.size() / 128)), m_reach(reach)
	{
	}

	// nookFalloff() > 0. Keeps the corners for cover().
	bool isWithin(std::span<const glm::vec3> corners, glm::vec3 front, float height, float share)
	{
		const float scale = 1.0F / m_reach;
		if (!(1.0F - std::fabs(height) * scale > 0.0F))
		{
			return false;
		}
		m_blocks = (corners.size() + 3) / 4;
		for (std::size_t i = 0; i < 4 * m_blocks; ++i)
		{
			const std::size_t edge = std::min(i, corners.size() - 1); // again, where there are fewer
			set(m_from[i / 4], i % 4, corners[edge > 0 ? edge - 1 : corners.size() - 1]);
			set(m_to[i / 4], i % 4, corners[edge]);
		}
		const float limit = share * m_reach;
		const Vectors normal = allOf(front);
		for (std::size_t block = 0; block < m_blocks; ++block)
		{
			const Vectors& a = m_from[block];
			const Vectors& b = m_to[block];
			const Vectors along{b.x - a.x, b.y - a.y, b.z - a.z};
			const Vectors inward{normal.y * along.z - along.y * normal.z, normal.z * along.x - along.z * normal.x,
								 normal.x * along.y - along.x * normal.y};
			const Floats outside = dotOf(a, inward);
			const Ints far = (outside > 0.0F) & (outside * outside > 0.99F * limit * limit * dotOf(inward, inward));
			for (std::size_t i = 0; (far[0] | far[1] | far[2] | far[3]) != 0 && i < 4; ++i)
			{
				const float side = 1.0F - outside[i] * (scale * m_kernels.nookUnit({inward.x[i], inward.y[i], inward.z[i]}));
				if (far[i] != 0 && !(side > 0.0F && side >= 1.0F - share))
				{
					return false;
				}
			}
		}
		return true;
	}

	// Removes the bits that nookMaskBits() has for the polygon of isWithin().
	void cover(glm::vec3 front, float height, const Occluder& polygon, MaskBits& open)
	{
		const float side = height < 0.0F ? -1.0F : 1.0F;
		const float least = std::fabs(height) / m_reach;
		const glm::vec3 down = glm::vec3(glm::dot(front, m_x), glm::dot(front, m_y), glm::dot(front, m_normal)) * -side;
		if (down.z < 0.0F && least * least > down.x * down.x + down.y * down.y + 1e-3F)
		{
			return; // no ray of the hemisphere reaches the plane
		}
		MaskBits bits = open;
		for (std::size_t block = 0; block < m_blocks; ++block)
		{
			if (!cutByEdges(m_from[block], m_to[block], side, bits))
			{
				return;
			}
		}
		const float shift = m_kernels.nookShift(static_cast<int>(polygon.first_corner));
		for (int word = 0; word < 4 * m_fours; ++word)
		{
			uint32_t& left = open[static_cast<std::size_t>(word / 4)][word % 4];
			uint32_t asked = bits[static_cast<std::size_t>(word / 4)][word % 4];
			if (asked != 0 && polygon.alpha < 1.0F)
			{
				asked &= m_kernels.nookMaskShare(word, polygon.alpha, shift);
			}
			for (; asked != 0; asked &= asked - 1)
			{
				const int i = std::countr_zero(asked);
				const glm::vec3& ray = m_tables.rays[static_cast<std::size_t>(32 * word + i)];
				left &= ~(uint32_t{glm::dot(ray, down) > least} << i);
			}
		}
	}

private:
	static void set(Vectors& to, std::size_t i, glm::vec3 v)
	{
		to.x[i] = v.x;
		to.y[i] = v.y;
		to.z[i] = v.z;
	}

	// nookInsideEdge() of nookInward(). Returns false if no bit remains.
	bool cutByEdges(const Vectors& from, const Vectors& to, float side, MaskBits& bits)
	{
		const Vectors across{exactProducts(to.y, from.z, from.y, to.z), exactProducts(to.z, from.x, from.z, to.x),
							 exactProducts(to.x, from.y, from.x, to.y)};
		const Vectors inward{dotOf(across, allOf(m_x)) * side, dotOf(across, allOf(m_y)) * side,
							 dotOf(across, allOf(m_normal)) * side};
		const Floats size = magnitudeOf(inward.x) + magnitudeOf(inward.y) + magnitudeOf(inward.z);
		const Floats sign = inward.z != 0.0F ? inward.z : inward.y != 0.0F ? inward.y : inward.x;
		const int texels = m_kernels.nookHalfSpaces();
		const float half_side = 0.5F * static_cast<float>(texels);
		const Floats positive = half_side / (size > 1e-37F ? size : Floats{} + 1e-37F);
		const Floats scale = sign < 0.0F ? -positive : positive;
		const Ints x = __builtin_convertvector(half_side + scale * (inward.x + inward.y), Ints);
		const Ints y = __builtin_convertvector(half_side + scale * (inward.x - inward.y), Ints);
		for (std::size_t i = 0; i < 4; ++i)
		{
			if (!(size[i] > 0.0F))
			{
				continue;
			}
			const glm::uvec4 other(sign[i] < 0.0F ? ~0U : 0U);
			const int texel = std::min(y[i], texels - 1) * texels + std::min(x[i], texels - 1);
			uint32_t any = 0;
			for (int four = 0; four < m_fours; ++four)
			{
				glm::uvec4& cut = bits[static_cast<std::size_t>(four)];
				cut &= m_tables.half_spaces[static_cast<std::size_t>(four * texels * texels + texel)] ^ other;
				any |= cut.x | cut.y | cut.z | cut.w;
			}
			if (any == 0)
			{
				return false;
			}
		}
		return true;
	}

	volume_kernels::Kernels m_kernels;
	glm::vec3 m_normal;
	glm::vec3 m_x;
	glm::vec3 m_y;
	const MaskTables& m_tables;
	int m_fours;
	float m_reach;
	std::array<Vectors, kMaxOccluderCorners / 4> m_from;
	std::array<Vectors, kMaxOccluderCorners / 4> m_to;
	std::size_t m_blocks = 0;
};

} // namespace

VolumeMask VolumeEvaluator::mask(glm::dvec3 position, glm::dvec3 normal, int directions, double bias_m) const
{
	const MaskTables& tables = maskTablesOf(directions);
	MaskBits open;
	open.fill(glm::uvec4(~0U));
	const auto reach = static_cast<float>(m_data->set.distance_m);
	MaskReceiver receiver(glm::vec3(normal), tables, reach);
	VolumeMask mask;
	const std::vector<Occluder>& polygons = m_data->set.occluders.polygons;
	const auto within = [&](uint32_t index, volume_kernels::Kernels& kernels, glm::vec3 front, float height)
	{
		return receiver.isWithin(kernels.corners, front, height, polygons[index].side_reach);
	};
	const auto cover = [&](uint32_t index, volume_kernels::Kernels&, glm::vec3 front, float height)
	{
		receiver.cover(front, height, polygons[index], open);
	};
	mask.volumes = m_data->visit(position, glm::vec3(normal), bias_m, within, cover);
	int covered = static_cast<int>(tables.rays.size());
	for (std::size_t i = 0; i < tables.rays.size() / 128; ++i)
	{
		const glm::uvec4& words = open[i];
		covered -= std::popcount(words.x) + std::popcount(words.y) + std::popcount(words.z) + std::popcount(words.w);
	}
	mask.visibility = 1.0 - covered / static_cast<double>(directions);
	return mask;
}

std::function<double(glm::dvec3 position, glm::dvec3 normal)> visibilityByVolumes(const std::string& path, int directions,
																				  const RunSettings& run)
{
	const auto volumes = std::make_shared<const VolumeSet>(readVolumes(path));
	const auto evaluator = std::make_shared<const VolumeEvaluator>(*volumes, run);
	return [volumes, evaluator, directions](glm::dvec3 position, glm::dvec3 normal)
	{
		return directions > 0 ? evaluator->mask(position, normal, directions).visibility
							  : 1.0 - volumes->compensation.at(evaluator->occlusion(position, normal));
	};
}

} // namespace nook
