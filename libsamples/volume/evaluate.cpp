// SPDX-License-Identifier: GPL-3.0-or-later
// A tree of the volumes' bounding boxes (Embree 3) finds candidates; kernels evaluate them in polygon order, so that the result
// does not depend on the tree's layout.
#include "volume/evaluate.h"

#include "core/error.h"
#include "core/math.h"
#include "core/parallel.h"
#include "core/round.h"
#include "methods/aov_text.h"
#include "methods/volume_kernels.h"
#include "scene/embree.h"
#include "volume/receivers.h"
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

namespace
{

// Four receivers or four edges at once, in vector types of GCC and Clang.
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

Vectors operator*(const Vectors& a, const Floats& b)
{
	return {a.x * b, a.y * b, a.z * b};
}

Vectors allOf(glm::vec3 v)
{
	return {Floats{} + v.x, Floats{} + v.y, Floats{} + v.z};
}

Floats magnitudeOf(const Floats& v)
{
	return v < 0.0F ? -v : v;
}

bool anyOf(const Ints& lanes)
{
	const auto halves = bitsAs<std::array<uint64_t, 2>>(lanes);
	return (halves[0] | halves[1]) != 0;
}

Floats rootOf(const Floats& a)
{
	return Floats{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}

// nookUnit()
Floats unitOf(const Vectors& a)
{
	return 1.0F / rootOf(dotOf(a, a) > 1e-30F ? dotOf(a, a) : Floats{} + 1e-30F);
}

// The lanes of both in a row, without the first.
Floats nextOf(const Floats& a, const Floats& b)
{
	return Floats{a[1], a[2], a[3], b[0]};
}

Vectors nextOf(const Vectors& a, const Vectors& b)
{
	return {nextOf(a.x, b.x), nextOf(a.y, b.y), nextOf(a.z, b.z)};
}

void setLane(Vectors& to, std::size_t lane, glm::vec3 v)
{
	to.x[lane] = v.x;
	to.y[lane] = v.y;
	to.z[lane] = v.z;
}

glm::vec3 laneOf(const Vectors& a, std::size_t lane)
{
	return {a.x[lane], a.y[lane], a.z[lane]};
}

Vectors chosen(const Ints& which, const Vectors& a, const Vectors& b)
{
	return {which ? a.x : b.x, which ? a.y : b.y, which ? a.z : b.z};
}

constexpr std::size_t kMostFours = kMaxOccluderCorners / 4;

// Four corners of a polygon, and for each the unit vector in its plane that points into it from the edge to the next corner.
// The first corner follows the last one, as often as it takes to fill the four; such edges have no length and the vector 0.
struct Four
{
	std::array<Doubles, 3> corners; // by axis
	Vectors inward;
};

// A polygon seen from afar: a point with an area.
struct Spot
{
	glm::vec3 centre{0.0F}; // of the area, relative to the first corner
	float area = 0.0F;      // over π
	float far = 0.0F;       // squared distance from which it does
};

// From this many radii on, the integrand of the form factor is flat enough: it varies by the square, and a triangle's corners are
// twice as far from its centre as the root mean square of its points.
constexpr double kFar = 7.0;

// A polygon whose volume contains the receiver, for masks.
struct Held
{
	uint32_t index = 0;
	glm::vec3 front{0.0F};
	float height = 0.0F; // of the receiver above the polygon, m
	std::size_t fours = 0;
	std::array<Vectors, kMostFours> from; // corners relative to the receiver
	std::array<Vectors, kMostFours> to;   // the next ones
};

// Up to four receivers close to one another; the last one fills unused lanes.
struct Group
{
	std::size_t count = 0;
	glm::dvec3 origin{0.0};
	Vectors at; // relative to the origin
	Vectors normals;
	Floats bias;
	float radius = 0.0F; // from the origin, with the bias
};

// The values of a polygon at the receivers of a group.
struct Terms
{
	Ints held; // −1: its volume contains the receiver
	Floats height;
	Floats outside; // beyond its edges, ≥ 0
	Floats share;   // g · form factor
};

} // namespace

struct VolumeEvaluator::Data
{
	const VolumeSet& set;
	glm::dvec3 centre{0.0};
	float grown = 0.0F; // margin in metres, beyond rounding to 32 bits
	std::vector<glm::vec3> fronts;
	std::vector<Four> fours;
	std::vector<Spot> spots;
	std::vector<uint32_t> first_four; // by polygon, and the end
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
	float biasOf(double bias_m) const;
	Group groupOf(std::span<const VolumeReceiver> receivers) const;
	bool reach(Held& held, glm::dvec3 position, glm::vec3 normal, float bias) const;
	bool termsOf(uint32_t index, const Group& group, bool roughly, Terms& terms) const;
	template <class Use> void visitShares(std::span<const VolumeReceiver> receivers, bool roughly, const Use& use) const;
};

namespace
{

// A cube around a point, as a box of Embree.
struct Near
{
	Floats low;
	Floats high;

	Near(glm::vec3 at, float radius)
		: low{at.x - radius, at.y - radius, at.z - radius, 0.0F}, high{at.x + radius, at.y + radius, at.z + radius, 0.0F}
	{
	}

	bool meets(const RTCBounds& box) const
	{
		const auto sides = bitsAs<std::array<Floats, 2>>(box);
		return !anyOf((high < sides[0]) | (low > sides[1]));
	}
};

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
	if (Near(candidates.at, candidates.radius).meets((*candidates.boxes)[arguments->primID]))
	{
		candidates.found.push_back(arguments->primID);
	}
	return false;
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
	glm::dvec3 mean(0.0);
	double area = 0.0;
	for (std::size_t i = 2; i < corners.size(); ++i)
	{
		const double part = 0.5 * glm::length(glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]));
		mean += part / 3.0 * (corners[i - 1] - corners[0] + corners[i] - corners[0]);
		area += part;
	}
	mean = area > 0.0 ? mean / area : mean;
	double far = 0.0;
	for (const glm::dvec3& corner : corners)
	{
		far = std::max(far, kFar * kFar * glm::dot(corner - corners[0] - mean, corner - corners[0] - mean));
	}
	spots[index] = {glm::vec3(mean), static_cast<float>(area / kPi), static_cast<float>(far)};
	for (std::size_t i = 0; i < 4 * (first_four[index + 1] - first_four[index]); ++i)
	{
		Four& four = fours[first_four[index] + i / 4];
		const glm::dvec3 from = corners[i < corners.size() ? i : 0];
		const glm::dvec3 to = corners[i + 1 < corners.size() ? i + 1 : 0];
		const glm::vec3 inward = from == to ? glm::vec3(0.0F) : glm::vec3(glm::normalize(glm::cross(front, to - from)));
		for (int axis = 0; axis < 3; ++axis)
		{
			four.corners[static_cast<std::size_t>(axis)][i % 4] = from[axis];
		}
		setLane(four.inward, i % 4, inward);
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
	refuseIf(rtcGetDeviceError(device) != RTC_ERROR_NONE,
			 "volumes: found no memory left for a tree of " + std::to_string(boxes.size()) + " volumes, expected more",
			 ExitCode::runtime);
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
	data.spots.resize(count);
	data.rings.resize(volumes.occluders.corners.size());
	data.first_four.push_back(0);
	for (const Occluder& polygon : volumes.occluders.polygons)
	{
		data.first_four.push_back(data.first_four.back() + (polygon.corner_count + 3) / 4);
	}
	data.fours.resize(data.first_four.back());
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
		std::sort(candidates.found.begin(), candidates.found.end());
	}
	return candidates.found;
}

// Fills `held` for the polygon of its index; returns false if its volume does not contain the point.
bool VolumeEvaluator::Data::reach(Held& held, glm::dvec3 position, glm::vec3 normal, float bias) const
{
	const Occluder& polygon = set.occluders.polygons[held.index];
	const Four* const shape = &fours[first_four[held.index]];
	held.front = fronts[held.index];
	const float two_sided = polygon.two_sided ? 1.0F : 0.0F;
	volume_kernels::Kernels kernels;
	glm::vec3 corner(glm::dvec3(shape->corners[0][0], shape->corners[1][0], shape->corners[2][0]) - position);
	kernels.corners = std::span(&corner, 1);
	const float lift = kernels.nookLift(kernels.nookHeight(held.front), two_sided, bias, glm::dot(normal, held.front));
	corner -= lift * held.front;
	held.height = kernels.nookHeight(held.front);
	const auto reach = static_cast<float>(set.distance_m);
	if (!kernels.nookReaches(held.height, two_sided, reach * polygon.reach, bias))
	{
		return false;
	}
	const float scale = 1.0F / reach;
	const float least = 1.0F - polygon.side_reach;
	held.fours = first_four[held.index + 1] - first_four[held.index];
	for (std::size_t i = 0; i < held.fours; ++i)
	{
		Vectors& from = held.from[i];
		from.x = __builtin_convertvector(shape[i].corners[0] - position.x, Floats) - lift * held.front.x;
		from.y = __builtin_convertvector(shape[i].corners[1] - position.y, Floats) - lift * held.front.y;
		from.z = __builtin_convertvector(shape[i].corners[2] - position.z, Floats) - lift * held.front.z;
		const Floats outside = dotOf(from, shape[i].inward); // AOV eq. 7
		const Floats side = 1.0F - outside * scale;
		if (anyOf((side <= 0.0F) | (side < least)))
		{
			return false;
		}
	}
	for (std::size_t i = 0; i < held.fours; ++i)
	{
		held.to[i] = nextOf(held.from[i], held.from[i + 1 < held.fours ? i + 1 : 0]);
	}
	return clamped[held.index] == 0 || holds(polygon, glm::dvec3(held.front), position);
}

float VolumeEvaluator::Data::biasOf(double bias_m) const
{
	return static_cast<float>(std::max({bias_m, kVolumeBias * set.distance_m, set.plane_error_m}));
}

namespace
{

// nookArc()
Floats arcOf(const Floats& x)
{
	const Floats p = 0.522759580F + x * (-0.345475831F + x * (0.152677448F - x * 0.0317200786F));
	return 1.57079595F + x * (-0.999943104F + x * (0.783984789F + x * (-0.653083218F + x * p)));
}

// nookFormFactor() for the receivers among `held`. Edges that appear nearly as long as half a turn take more digits: the kernel
// itself evaluates such receivers.
Floats formFactors(std::span<const Vectors> corners, const Vectors& n, const Floats& side, const Ints& held)
{
	const Floats upward = n.z < 0.0F ? Floats{} - 1.0F : Floats{} + 1.0F;
	const Floats q = -1.0F / (upward + n.z);
	const Floats mixed = n.x * n.y * q;
	const Vectors right{1.0F + upward * n.x * n.x * q, upward * mixed, -upward * n.x};
	const Vectors forward{mixed, upward + n.y * n.y * q, -n.y};
	const auto directionOf = [&](const Vectors& corner)
	{
		const Vectors away = corner * unitOf(corner);
		return Vectors{dotOf(away, right), dotOf(away, forward), dotOf(away, n)};
	};
	Vectors from = directionOf(corners.back());
	Floats edges{};
	Vectors cut{Floats{} + 1.0F, Floats{}, Floats{}};
	Ints hard{};
	for (const Vectors& corner : corners)
	{
		const Vectors to = directionOf(corner);
		const Ints above = held & ((from.z > 0.0F) | (to.z > 0.0F));
		if (anyOf(above))
		{
			Floats cosine = dotOf(from, to);
			Vectors first = from;
			Vectors last = to;
			hard |= above & (cosine < -0.95F);
			const Ints exits = above & (to.z <= 0.0F);
			const Ints crosses = exits | (above & (from.z <= 0.0F));
			if (anyOf(crosses))
			{
				const Floats wa = magnitudeOf(to.z);
				const Floats wb = magnitudeOf(from.z);
				Vectors node{from.x * wa + to.x * wb, from.y * wa + to.y * wb, Floats{}};
				node = node * unitOf(node);
				first = chosen(crosses & ~exits, node, from);
				last = chosen(exits, node, to);
				cosine = dotOf(first, last);
				const Floats turn = exits ? node.y : -node.y;
				cut = chosen(crosses, {cut.x * node.x - cut.y * turn, cut.x * turn + cut.y * node.x, Floats{}}, cut);
			}
			const Floats sine = last.x * first.y - last.y * first.x;
			const Floats term = sine * arcOf(magnitudeOf(cosine));
			const Ints obtuse = above & (cosine < 0.0F);
			const Floats rest = anyOf(obtuse) ? 3.14159265F * (sine / rootOf(1.0F - cosine * cosine)) - term : term;
			edges += above ? (obtuse ? rest : term) : Floats{};
		}
		from = to;
	}
	const Floats arc = arcOf(magnitudeOf(cut.x));
	const Floats rise = side * cut.y;
	const Floats cuts = cut.x < 0.0F ? 3.14159265F - arc * magnitudeOf(rise) : arc * rise;
	Floats factor = (side * edges + cuts) * 0.159154943F;
	factor = factor > 0.0F ? factor : Floats{};
	factor = factor < 1.0F ? factor : Floats{} + 1.0F;
	for (std::size_t lane = 0; anyOf(hard) && lane < 4; ++lane)
	{
		if (hard[lane] != 0)
		{
			std::array<glm::vec3, kMaxOccluderCorners> of_lane;
			std::transform(corners.begin(), corners.end(), of_lane.begin(), [lane](const Vectors& v) { return laneOf(v, lane); });
			volume_kernels::Kernels kernels;
			kernels.corners = of_lane;
			factor[lane] = kernels.nookFormFactor(static_cast<int>(corners.size()), laneOf(n, lane), side[lane]);
		}
	}
	return factor;
}

} // namespace

// Evaluates a polygon at the receivers, like nookVolume(); returns false if its volume contains none of them.
bool VolumeEvaluator::Data::termsOf(uint32_t index, const Group& group, bool roughly, Terms& terms) const
{
	const Occluder& polygon = set.occluders.polygons[index];
	const Four* const shape = &fours[first_four[index]];
	const Vectors front = allOf(fronts[index]);
	const auto cornerOf = [&](std::size_t i)
	{
		const std::array<Doubles, 3>& corners = shape[i / 4].corners;
		return allOf(glm::dvec3(corners[0][i % 4], corners[1][i % 4], corners[2][i % 4]) - group.origin);
	};
	const auto minus = [](const Vectors& a, const Vectors& b)
	{
		return Vectors{a.x - b.x, a.y - b.y, a.z - b.z};
	};
	const Vectors first = cornerOf(0);
	Vectors at = group.at;
	terms.height = -dotOf(front, minus(first, at));
	const Ints lifted = (magnitudeOf(terms.height) <= group.bias) & (magnitudeOf(dotOf(group.normals, front)) <= 0.7F);
	if (anyOf(lifted)) // nookLift()
	{
		const Floats out =
			polygon.two_sided ? (terms.height < 0.0F ? -1.01F * group.bias : 1.01F * group.bias) : 1.01F * group.bias;
		const Vectors lift = front * (lifted ? out - terms.height : Floats{});
		at = {at.x + lift.x, at.y + lift.y, at.z + lift.z};
		terms.height = -dotOf(front, minus(first, at));
	}
	const auto reach = static_cast<float>(set.distance_m);
	const Floats up = polygon.two_sided ? magnitudeOf(terms.height) : terms.height;
	terms.held = (up > group.bias) & (up < reach * polygon.reach);
	if (!anyOf(terms.held))
	{
		return false;
	}
	const float scale = 1.0F / reach;
	const float least = 1.0F - polygon.side_reach;
	std::array<Vectors, kMaxOccluderCorners> corners;
	terms.outside = Floats{};
	Floats falloff = polygon.alpha * (1.0F - magnitudeOf(terms.height) * scale);
	for (std::size_t i = 0; i < polygon.corner_count; ++i)
	{
		corners[i] = minus(cornerOf(i), at);
		const Floats outside = dotOf(corners[i], allOf(laneOf(shape[i / 4].inward, i % 4))); // AOV eq. 7
		const Floats side = 1.0F - outside * scale;
		terms.held &= (side > 0.0F) & (side >= least);
		terms.outside = outside > terms.outside ? outside : terms.outside;
		falloff *= side < 1.0F ? side : Floats{} + 1.0F;
	}
	for (std::size_t lane = 0; clamped[index] != 0 && lane < 4; ++lane)
	{
		terms.held[lane] &= holds(polygon, glm::dvec3(fronts[index]), group.origin + glm::dvec3(laneOf(group.at, lane))) ? -1 : 0;
	}
	if (!anyOf(terms.held))
	{
		return false;
	}
	const Spot& spot = spots[index];
	const Vectors way{corners[0].x + spot.centre.x, corners[0].y + spot.centre.y, corners[0].z + spot.centre.z};
	const Floats square = dotOf(way, way);
	if (roughly && !anyOf(terms.held & (square < spot.far)))
	{
		const Floats rise = dotOf(way, group.normals);
		terms.share = falloff * (rise > 0.0F ? rise : Floats{}) * magnitudeOf(terms.height) * (spot.area / (square * square));
		return true;
	}
	const Floats side = terms.height < 0.0F ? Floats{} - 1.0F : Floats{} + 1.0F;
	terms.share = falloff * formFactors(std::span(corners).first(polygon.corner_count), group.normals, side, terms.held);
	return true;
}

Group VolumeEvaluator::Data::groupOf(std::span<const VolumeReceiver> receivers) const
{
	Group group;
	group.count = receivers.size();
	group.origin = receivers.front().position;
	for (std::size_t lane = 0; lane < 4; ++lane)
	{
		const VolumeReceiver& receiver = receivers[std::min(lane, receivers.size() - 1)];
		const glm::vec3 at(receiver.position - group.origin);
		setLane(group.at, lane, at);
		setLane(group.normals, lane, glm::vec3(receiver.normal));
		group.bias[lane] = biasOf(receiver.bias_m);
		group.radius = std::max({group.radius, std::fabs(at.x) + group.bias[lane], std::fabs(at.y) + group.bias[lane],
								 std::fabs(at.z) + group.bias[lane]});
	}
	return group;
}

// Calls use(receiver number, polygon, terms, lane) for all volumes that contain a receiver, for each receiver in polygon order.
template <class Use>
void VolumeEvaluator::Data::visitShares(std::span<const VolumeReceiver> receivers, bool roughly, const Use& use) const
{
	constexpr float kWidest = 0.1F; // of δ: receivers farther apart share too few volumes. Tuned on an apartment.
	for (std::size_t begin = 0, end = 0; begin < receivers.size(); begin = end)
	{
		end = std::min(begin + 4, receivers.size());
		Group group = groupOf(receivers.subspan(begin, end - begin));
		if (end > begin + 1 && group.radius > kWidest * static_cast<float>(set.distance_m))
		{
			end = begin + 1;
			group = groupOf(receivers.subspan(begin, 1));
		}
		const glm::vec3 at(group.origin - centre);
		const float radius = grown + group.radius; // a point that close behind a plane may be lifted into the volume
		const Near near(at, radius);
		Terms terms;
		for (const uint32_t index : candidatesAt(at, radius))
		{
			const bool any = near.meets(boxes[index]) && termsOf(index, group, roughly, terms);
			for (std::size_t lane = 0; any && lane < group.count; ++lane)
			{
				if (terms.held[lane] != 0)
				{
					use(begin + lane, index, terms, lane);
				}
			}
		}
	}
}

void VolumeEvaluator::sums(std::span<const VolumeReceiver> receivers, std::span<VolumeSum> sums, bool roughly) const
{
	std::fill(sums.begin(), sums.end(), VolumeSum{});
	m_data->visitShares(receivers, roughly,
						[&](std::size_t i, uint32_t, const Terms& terms, std::size_t lane)
						{
							sums[i].occlusion += static_cast<double>(terms.share[lane]);
							sums[i].volumes += 1;
						});
}

double VolumeEvaluator::occlusion(glm::dvec3 position, glm::dvec3 normal) const
{
	const VolumeReceiver receiver{position, normal};
	VolumeSum sum;
	sums({&receiver, 1}, {&sum, 1});
	return sum.occlusion;
}

void VolumeEvaluator::shares(std::span<const VolumeReceiver> receivers, std::span<std::vector<VolumeShare>> shares) const
{
	std::for_each(shares.begin(), shares.end(), [](std::vector<VolumeShare>& of) { of.clear(); });
	m_data->visitShares(
		receivers, true,
		[&](std::size_t i, uint32_t polygon, const Terms& terms, std::size_t lane)
		{
			if (terms.share[lane] > 0.0F)
			{
				shares[i].push_back({polygon, terms.share[lane], std::fabs(terms.height[lane]), terms.outside[lane]});
			}
		});
}

namespace
{

using MaskBits = std::array<glm::uvec4, kMostDirections / 128>;

// a.y * b.z - b.y * a.z. Products of 32-bit floats are exact in 64 bits, as the kernel's split ones nearly are.
Floats exactProducts(Floats ay, Floats bz, Floats by, Floats az)
{
	const Doubles left = __builtin_convertvector(ay, Doubles) * __builtin_convertvector(bz, Doubles);
	return __builtin_convertvector(left - __builtin_convertvector(by, Doubles) * __builtin_convertvector(az, Doubles), Floats);
}

// A receiver of masks. Its functions return what those of mask.glsl do, but compute the frame once per receiver, and only rays that
// no edge has ruled out.
class MaskReceiver
{
public:
	MaskReceiver(glm::vec3 normal, const MaskTables& tables, float reach)
		: m_normal(normal), m_x(m_kernels.nookTangent(normal, 0)), m_y(m_kernels.nookTangent(normal, 1)), m_tables(tables),
		  m_fours(static_cast<int>(tables.rays.size() / 128)), m_reach(reach)
	{
	}

	// Removes the bits that nookMaskBits() has for the polygon.
	void cover(const Held& held, const Occluder& polygon, MaskBits& open)
	{
		const float side = held.height < 0.0F ? -1.0F : 1.0F;
		const float least = std::fabs(held.height) / m_reach;
		const glm::vec3 down =
			glm::vec3(glm::dot(held.front, m_x), glm::dot(held.front, m_y), glm::dot(held.front, m_normal)) * -side;
		if (down.z < 0.0F && least * least > down.x * down.x + down.y * down.y + 1e-3F)
		{
			return; // no ray of the hemisphere reaches the plane
		}
		MaskBits bits = open;
		for (std::size_t i = 0; i < held.fours; ++i)
		{
			if (!cutByEdges(held.from[i], held.to[i], side, bits))
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
	const glm::vec3 at(position - m_data->centre);
	const float bias = m_data->biasOf(bias_m);
	const Near near(at, m_data->grown + bias);
	Held held;
	for (const uint32_t index : m_data->candidatesAt(at, m_data->grown + bias))
	{
		held.index = index;
		if (near.meets(m_data->boxes[index]) && m_data->reach(held, position, glm::vec3(normal), bias))
		{
			receiver.cover(held, m_data->set.occluders.polygons[index], open);
			mask.volumes += 1;
		}
	}
	int covered = static_cast<int>(tables.rays.size());
	for (std::size_t i = 0; i < tables.rays.size() / 128; ++i)
	{
		const glm::uvec4& words = open[i];
		covered -= std::popcount(words.x) + std::popcount(words.y) + std::popcount(words.z) + std::popcount(words.w);
	}
	mask.visibility = 1.0 - covered / static_cast<double>(directions);
	return mask;
}

VisibilityAtPoints visibilityByVolumes(const std::string& path, int directions, const RunSettings& run)
{
	const auto volumes = std::make_shared<const VolumeSet>(readVolumes(path));
	const auto evaluator = std::make_shared<const VolumeEvaluator>(*volumes, run);
	return [volumes, evaluator, directions, threads = run.threads](std::span<const ReferencePoint> points)
	{
		std::vector<double> values(points.size());
		if (directions > 0)
		{
			parallelFor(points.size(), threads,
						[&](std::size_t i)
						{ values[i] = evaluator->mask(points[i].position, points[i].normal, directions).visibility; });
			return values;
		}
		values = sumsAt(*evaluator, points, {threads, {}}, true);
		std::transform(values.begin(), values.end(), values.begin(),
					   [&](double sum) { return 1.0 - volumes->compensation.at(sum); });
		return values;
	};
}

} // namespace nook
