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

	explicit Data(const VolumeSet& of) : set(of) {}
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
	template <class Visit> uint32_t visit(glm::dvec3 position, glm::vec3 normal, double bias_m, const Visit& visit) const;
};

namespace
{

struct Candidates
{
	const std::vector<RTCBounds>& boxes;
	std::vector<uint32_t>& found;
};

// A leaf of the tree has several boxes, not all of which contain the point.
bool collect(RTCPointQueryFunctionArguments* arguments)
{
	const auto& [boxes, found] = *static_cast<const Candidates*>(arguments->userPtr);
	const RTCBounds& box = boxes[arguments->primID];
	const RTCPointQuery& at = *arguments->query;
	if (at.x >= box.lower_x - at.radius && at.x <= box.upper_x + at.radius && at.y >= box.lower_y - at.radius &&
		at.y <= box.upper_y + at.radius && at.z >= box.lower_z - at.radius && at.z <= box.upper_z + at.radius)
	{
		found.push_back(arguments->primID);
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
	constexpr std::size_t kChunk = 1024;
	parallelFor((count + kChunk - 1) / kChunk, run.threads,
				[&](std::size_t chunk)
				{
					for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i)
					{
						data.shape(i);
					}
				});
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

// Calls visit(polygon index, kernels, count, front, height, g) for all volumes that contain the point, in order; returns how many.
template <class Visit>
uint32_t VolumeEvaluator::Data::visit(glm::dvec3 position, glm::vec3 normal, double bias_m, const Visit& visit) const
{
	thread_local std::vector<uint32_t> found;
	found.clear();
	RTCPointQueryContext context;
	rtcInitPointQueryContext(&context);
	const glm::vec3 at(position - centre);
	const auto bias = static_cast<float>(std::max({bias_m, kVolumeBias * set.distance_m, set.plane_error_m}));
	// A point that close behind the plane of one side may be lifted into the volume.
	RTCPointQuery query{at.x, at.y, at.z, 0.0F, grown + bias};
	Candidates candidates{boxes, found};
	rtcPointQuery(scene, &query, &context, collect, &candidates);
	sortIndices(found, set.occluders.polygons.size());

	const auto reach = static_cast<float>(set.distance_m);
	std::array<glm::vec3, kMaxOccluderCorners> corners;
	volume_kernels::Kernels kernels;
	uint32_t count = 0;
	for (const uint32_t index : found)
	{
		const Occluder& polygon = set.occluders.polygons[index];
		const std::span<const glm::dvec3> of = set.occluders.cornersOf(polygon);
		for (std::size_t i = 0; i < of.size(); ++i)
		{
			corners[i] = glm::vec3(of[i] - position);
		}
		kernels.corners = std::span(corners).first(of.size());
		const auto size = static_cast<int>(of.size());
		const glm::vec3 front = fronts[index];
		const float lift =
			kernels.nookLift(kernels.nookHeight(front), polygon.two_sided ? 1.0F : 0.0F, bias, glm::dot(normal, front));
		for (std::size_t i = 0; lift != 0.0F && i < of.size(); ++i)
		{
			corners[i] -= lift * front;
		}
		const float height = kernels.nookHeight(front);
		if (!kernels.nookReaches(height, polygon.two_sided ? 1.0F : 0.0F, reach * polygon.reach, bias))
		{
			continue;
		}
		const float g = polygon.alpha * kernels.nookFalloff(size, front, std::fabs(height), reach, polygon.side_reach);
		if (g > 0.0F && (clamped[index] == 0 || holds(polygon, glm::dvec3(front), position)))
		{
			count += 1;
			visit(index, kernels, size, front, height, g);
		}
	}
	return count;
}

VolumeSum VolumeEvaluator::sum(glm::dvec3 position, glm::dvec3 normal, double bias_m) const
{
	VolumeSum sum;
	const glm::vec3 n(normal);
	sum.volumes = m_data->visit(position, n, bias_m,
								[&](uint32_t, volume_kernels::Kernels& kernels, int count, glm::vec3, float height, float g)
								{
									const float share = g * kernels.nookFormFactor(count, n, height < 0.0F ? -1.0F : 1.0F);
									sum.occlusion += static_cast<double>(share);
								});
	return sum;
}

double VolumeEvaluator::occlusion(glm::dvec3 position, glm::dvec3 normal) const
{
	return sum(position, normal, 0.0).occlusion;
}

void VolumeEvaluator::shares(glm::dvec3 position, glm::dvec3 normal, std::vector<VolumeShare>& shares) const
{
	shares.clear();
	const glm::vec3 n(normal);
	m_data->visit(position, n, 0.0,
				  [&](uint32_t polygon, volume_kernels::Kernels& kernels, int count, glm::vec3, float height, float g)
				  {
					  const float share = g * kernels.nookFormFactor(count, n, height < 0.0F ? -1.0F : 1.0F);
					  if (share > 0.0F)
					  {
						  shares.push_back({polygon, share});
					  }
				  });
}

VolumeMask VolumeEvaluator::mask(glm::dvec3 position, glm::dvec3 normal, int directions, double bias_m) const
{
	const MaskTables& tables = maskTablesOf(directions);
	const auto fours = static_cast<int>(tables.rays.size() / 128);
	std::array<glm::uvec4, kMostDirections / 128> open;
	open.fill(glm::uvec4(~0U));
	const glm::vec3 n(normal);
	const auto reach = static_cast<float>(m_data->set.distance_m);
	VolumeMask mask;
	mask.volumes =
		m_data->visit(position, n, bias_m,
					  [&](uint32_t polygon, volume_kernels::Kernels& kernels, int count, glm::vec3 front, float height, float)
					  {
						  kernels.rays = tables.rays;
						  kernels.half_spaces = tables.half_spaces;
						  const Occluder& occluder = m_data->set.occluders.polygons[polygon];
						  const auto number = static_cast<int>(occluder.first_corner);
						  for (int four = 0; four < fours; ++four)
						  {
							  glm::uvec4& asked = open[static_cast<std::size_t>(four)];
							  asked &= ~kernels.nookMaskBits(count, four, n, front, height, occluder.alpha, number, reach, asked);
						  }
					  });
	int covered = 128 * fours;
	for (int i = 0; i < fours; ++i)
	{
		const glm::uvec4& words = open[static_cast<std::size_t>(i)];
		covered -= std::popcount(words.x) + std::popcount(words.y) + std::popcount(words.z) + std::popcount(words.w);
	}
	mask.visibility = 1.0 - covered / static_cast<double>(directions);
	return mask;
}

double VolumeEvaluator::maskedVisibility(glm::dvec3 position, glm::dvec3 normal, int directions) const
{
	return mask(position, normal, directions, 0.0).visibility;
}

std::function<double(glm::dvec3 position, glm::dvec3 normal)> visibilityByVolumes(const std::string& path, int directions,
																				  const RunSettings& run)
{
	const auto volumes = std::make_shared<const VolumeSet>(readVolumes(path));
	const auto evaluator = std::make_shared<const VolumeEvaluator>(*volumes, run);
	return [volumes, evaluator, directions](glm::dvec3 position, glm::dvec3 normal)
	{
		return directions > 0 ? evaluator->maskedVisibility(position, normal, directions)
							  : 1.0 - volumes->compensation.at(evaluator->occlusion(position, normal));
	};
}

} // namespace nook
