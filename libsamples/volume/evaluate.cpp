// SPDX-License-Identifier: GPL-3.0-or-later
// A tree of bounding boxes finds candidates, four polygons at a time. Sums and masks share it.
#include "volume/evaluate.h"

#include "core/lists.h"
#include "core/math.h"
#include "core/parallel.h"
#include "core/round.h"
#include "methods/aov_text.h"
#include "methods/volume_kernels.h"
#include "volume/form_factors.h"
#include "volume/lanes.h"
#include "volume/mask_receiver.h"
#include "volume/receivers.h"
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

namespace
{

// An edge of each of four polygons. Those that a polygon lacks have the vector 0.
struct Edges
{
	Vectors inward; // unit, in the polygon's plane
	Floats offset;  // along it, of the edge from the first corner
};

// Four polygons near one another; unused lanes have no reach. From afar, a polygon is a point with an area.
struct Pack
{
	std::array<uint32_t, 4> polygons{};
	std::size_t first_edge = 0;
	std::size_t edges = 0;
	Points first{}; // corner
	Vectors front{};
	Vectors middle{}; // of the area, relative to the first corner
	Floats area{};    // over π
	Floats far{};     // squared distance from which a polygon is a point
	Floats alpha{};
	Floats reach{};      // m
	Floats least_side{}; // 1 − side reach
	Ints two_sided{};    // −1: it is
	Ints clamped{};      // −1: by AOV's 2δ, so some points with a falloff > 0 lie outside
};

// From this many radii on, the integrand of the form factor is flat enough: it varies by the square, and a triangle's corners are
// twice as far from its centre as the root mean square of its points.
constexpr double kFar = 7.0;

constexpr std::size_t kAtOnce = 16; // receivers, a multiple of 4

struct Receiver
{
	glm::dvec3 at;
	Points position; // in all lanes
	Vectors normal;
	float bias;
};

// Four boxes: of packs' volumes, or of four nodes of the level below. Unused ones are empty.
struct Boxes
{
	Vectors low;
	Vectors high;

	Ints meet(const Boxes& other) const
	{
		return (low.x <= other.high.x) & (low.y <= other.high.y) & (low.z <= other.high.z) & (high.x >= other.low.x) &
			   (high.y >= other.low.y) & (high.z >= other.low.z);
	}
};

const Boxes kNoBoxes{allOf(glm::vec3(std::numeric_limits<float>::infinity())),
					 allOf(glm::vec3(-std::numeric_limits<float>::infinity()))};

// The values of four polygons at a receiver.
struct Terms
{
	Ints held;     // −1: the volume contains the receiver
	Vectors first; // corner, relative to the receiver, which may be lifted
	Floats lift;   // m
	Floats height;
	Floats outside; // beyond the polygon's edges, ≥ 0
	Floats falloff; // g
	Floats share;   // g · form factor
};

} // namespace

struct VolumeEvaluator::Data
{
	const VolumeSet& set;
	glm::dvec3 centre{0.0};
	float grown = 0.0F; // margin in metres, beyond rounding to 32 bits
	std::vector<Pack> packs;
	std::vector<Edges> edges;    // by pack
	std::vector<Points> corners; // parallel to the edges; those that a polygon lacks are its first
	std::vector<Points> fours;   // for masks, by polygon: corners, the first one again as often as it takes to fill the last four
	std::vector<uint32_t> first_four; // by polygon, and the end
	std::vector<glm::dvec3>
		rings; // extended outlines of the volumes in their planes, parallel to the corners; for clamped polygons
	std::vector<std::vector<Boxes>> tree; // by level; the last one has the root

	explicit Data(const VolumeSet& of) : set(of) {}

	void place();
	void gather();
	void shape(Pack& pack, std::size_t lane, Bounds& box);
	void addFours(std::size_t polygon);
	void build(const RunSettings& run);
	Boxes shape(std::size_t first_pack);
	const std::vector<uint32_t>& packsAt(const Boxes& near) const;
	bool holds(uint32_t polygon, glm::dvec3 front, glm::dvec3 position) const;
	Receiver receiverOf(const VolumeReceiver& receiver) const;
	void outline(Held& held, float lift, const Receiver& receiver) const;
	bool contains(const Pack& pack, const Receiver& receiver, Terms& terms) const;
	void share(const Pack& pack, const Receiver& receiver, bool roughly, Terms& terms) const;
	template <class Use> void visitTerms(std::span<const VolumeReceiver> receivers, bool roughly, const Use& use) const;
};

// The centre of all corners, and the rounding error of coordinates relative to it.
void VolumeEvaluator::Data::place()
{
	const Bounds box =
		set.occluders.corners.empty() ? Bounds{glm::dvec3(0.0), glm::dvec3(0.0)} : boundsAround(set.occluders.corners);
	centre = 0.5 * (box.least + box.most);
	const glm::dvec3 half = 0.5 * (box.most - box.least);
	grown = static_cast<float>(16.0 * kUnitRoundoff * (std::max({half.x, half.y, half.z}) + 64.0 * set.distance_m));
}

// Packs of neighbours, without their shapes.
void VolumeEvaluator::Data::gather()
{
	const std::vector<Occluder>& polygons = set.occluders.polygons;
	std::vector<uint32_t> order = nearOrder(
		mapped(polygons, [this](const Occluder& of) { return glm::vec3(set.occluders.corners[of.first_corner] - centre); }));
	const std::vector<int> facing = mapped(polygons,
										   [this](const Occluder& of)
										   {
											   const glm::dvec3 front = frontOf(set.occluders.cornersOf(of));
											   const glm::dvec3 size = glm::abs(front);
											   const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
											   return front[axis] < 0.0 ? axis + 3 : axis;
										   });
	std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return facing[a] < facing[b]; });
	packs.resize((order.size() + 3) / 4);
	std::size_t count = 0;
	for (std::size_t i = 0; i < packs.size(); ++i)
	{
		packs[i].first_edge = count;
		for (std::size_t lane = 0; lane < 4; ++lane)
		{
			const uint32_t polygon = order[std::min(4 * i + lane, order.size() - 1)];
			packs[i].polygons[lane] = polygon;
			packs[i].edges = std::max<std::size_t>(packs[i].edges, polygons[polygon].corner_count);
			packs[i].reach[lane] =
				4 * i + lane < order.size() ? static_cast<float>(set.distance_m) * polygons[polygon].reach : 0.0F;
		}
		count += packs[i].edges;
	}
	edges.resize(count);
	corners.resize(count);
}

// Adds the volume's bounds.
void VolumeEvaluator::Data::shape(Pack& pack, std::size_t lane, Bounds& box)
{
	const Occluder& polygon = set.occluders.polygons[pack.polygons[lane]];
	const std::span<const glm::dvec3> outline = set.occluders.cornersOf(polygon);
	const glm::dvec3 front = frontOf(outline);
	std::array<glm::dvec3, 2 * kMaxOccluderCorners> points;
	const std::span<glm::dvec3> used(points.data(), 2 * outline.size());
	const VolumeShape shape = shapeOf(set, polygon);
	prismOf(outline, front, shape, used);
	const Bounds own = boundsAround(used);
	box = lane == 0 ? own : Bounds{glm::min(box.least, own.least), glm::max(box.most, own.most)};
	glm::dvec3 middle(0.0);
	double area = 0.0;
	for (std::size_t i = 0; i < outline.size(); ++i)
	{
		// Component within the plane; clamped corners (eq. 13's 2δ) end exactly there.
		const glm::dvec3 moved = used[i] - outline[i];
		const double across = glm::length(moved - glm::dot(moved, front) * front);
		pack.clamped[lane] |= !set.exact_bounds && across > (2.0 - 1e-9) * shape.distance_m * shape.side_share ? -1 : 0;
		rings[polygon.first_corner + i] = used[i];
		const glm::dvec3 next = outline[(i + 1) % outline.size()];
		const glm::dvec3 inward = glm::normalize(glm::cross(front, next - outline[i]));
		setLane(edges[pack.first_edge + i].inward, lane, glm::vec3(inward));
		edges[pack.first_edge + i].offset[lane] = static_cast<float>(glm::dot(outline[i] - outline[0], inward));
		const double part = 0.5 * glm::length(glm::cross(outline[i] - outline[0], next - outline[0]));
		middle += part / 3.0 * (outline[i] - outline[0] + next - outline[0]);
		area += part;
	}
	middle = area > 0.0 ? middle / area : middle;
	double far = 0.0;
	for (const glm::dvec3& corner : outline)
	{
		far = std::max(far, kFar * kFar * glm::dot(corner - outline[0] - middle, corner - outline[0] - middle));
	}
	for (std::size_t i = 0; i < pack.edges; ++i)
	{
		setLane(corners[pack.first_edge + i], lane, outline[i < outline.size() ? i : 0] - centre);
	}
	setLane(pack.first, lane, outline[0] - centre);
	setLane(pack.front, lane, glm::vec3(front));
	setLane(pack.middle, lane, glm::vec3(middle));
	pack.area[lane] = static_cast<float>(area / kPi);
	pack.far[lane] = static_cast<float>(far);
	pack.alpha[lane] = polygon.alpha;
	pack.least_side[lane] = 1.0F - polygon.side_reach;
	pack.two_sided[lane] = polygon.two_sided ? -1 : 0;
}

// Shapes four packs.
Boxes VolumeEvaluator::Data::shape(std::size_t first_pack)
{
	Boxes node = kNoBoxes;
	for (std::size_t i = 0; i < 4 && first_pack + i < packs.size(); ++i)
	{
		Bounds box;
		for (std::size_t lane = 0; lane < 4; ++lane)
		{
			shape(packs[first_pack + i], lane, box);
		}
		setLane(node.low, i, glm::vec3(box.least - centre) - grown);
		setLane(node.high, i, glm::vec3(box.most - centre) + grown);
	}
	return node;
}

void VolumeEvaluator::Data::addFours(std::size_t index)
{
	const std::span<const glm::dvec3> outline = set.occluders.cornersOf(set.occluders.polygons[index]);
	for (std::size_t i = 0; i < 4 * (first_four[index + 1] - first_four[index]); ++i)
	{
		setLane(fours[first_four[index] + i / 4], i % 4, outline[i < outline.size() ? i : 0] - centre);
	}
}

void VolumeEvaluator::Data::build(const RunSettings& run)
{
	gather();
	rings.resize(set.occluders.corners.size());
	tree.emplace_back((packs.size() + 3) / 4);
	inBlocks(tree[0].size(), 64, run, nullptr, [this](std::size_t i) { tree[0][i] = shape(4 * i); });
	while (tree.back().size() > 1)
	{
		std::vector<Boxes> above((tree.back().size() + 3) / 4, kNoBoxes);
		for (std::size_t i = 0; i < tree.back().size(); ++i)
		{
			const Boxes& node = tree.back()[i];
			glm::vec3 low = laneOf(node.low, 0);
			glm::vec3 high = laneOf(node.high, 0);
			for (std::size_t lane = 1; lane < 4; ++lane)
			{
				low = glm::min(low, laneOf(node.low, lane));
				high = glm::max(high, laneOf(node.high, lane));
			}
			setLane(above[i / 4].low, i % 4, low);
			setLane(above[i / 4].high, i % 4, high);
		}
		tree.push_back(std::move(above));
	}
}

// Those with volumes near, ascending. Without branches, which would be mispredicted.
const std::vector<uint32_t>& VolumeEvaluator::Data::packsAt(const Boxes& near) const
{
	thread_local std::vector<uint32_t> found;
	thread_local std::vector<uint32_t> above;
	found.assign(tree.empty() ? 0 : 1, 0);
	for (std::size_t level = tree.size(); level-- > 0;)
	{
		above.swap(found);
		found.resize(4 * above.size());
		std::size_t count = 0;
		for (const uint32_t index : above)
		{
			const Ints met = near.meet(tree[level][index]);
			for (uint32_t lane = 0; lane < 4; ++lane)
			{
				found[count] = 4 * index + lane;
				count -= static_cast<std::size_t>(met[lane]);
			}
		}
		found.resize(count);
	}
	return found;
}

VolumeEvaluator::VolumeEvaluator(const VolumeSet& volumes, const RunSettings& run, bool masks)
	: m_data(std::make_unique<Data>(volumes))
{
	assert(run.threads >= 1 && volumes.distance_m > 0.0);
	Data& data = *m_data;
	data.place();
	if (!volumes.occluders.polygons.empty())
	{
		data.build(run);
	}
	if (masks)
	{
		data.first_four.push_back(0);
		for (const Occluder& polygon : volumes.occluders.polygons)
		{
			data.first_four.push_back(data.first_four.back() + (polygon.corner_count + 3) / 4);
		}
		data.fours.resize(data.first_four.back());
		inBlocks(volumes.occluders.polygons.size(), 1024, run, nullptr, [&data](std::size_t i) { data.addFours(i); });
	}
}

VolumeEvaluator::~VolumeEvaluator() = default;

// True if a point with a falloff above 0 is inside the clamped outline.
bool VolumeEvaluator::Data::holds(uint32_t index, glm::dvec3 front, glm::dvec3 position) const
{
	const Occluder& polygon = set.occluders.polygons[index];
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

// Fills in the corners.
void VolumeEvaluator::Data::outline(Held& held, float lift, const Receiver& receiver) const
{
	const std::span<const Points> shape =
		std::span(fours).subspan(first_four[held.index], first_four[held.index + 1] - first_four[held.index]);
	held.fours = shape.size();
	for (std::size_t i = 0; i < held.fours; ++i)
	{
		const Vectors away = shape[i] - receiver.position;
		held.from[i] = {away.x - lift * held.front.x, away.y - lift * held.front.y, away.z - lift * held.front.z};
	}
	for (std::size_t i = 0; i < held.fours; ++i)
	{
		held.to[i] = nextOf(held.from[i], held.from[i + 1 < held.fours ? i + 1 : 0]);
	}
}

Receiver VolumeEvaluator::Data::receiverOf(const VolumeReceiver& receiver) const
{
	const glm::dvec3 position = receiver.position - centre;
	const glm::vec3 at(position);
	const double bias = std::max({receiver.bias_m, kVolumeBias * set.distance_m, set.plane_error_m});
	return {receiver.position,
			{allOf(at), allOf(glm::vec3(position - glm::dvec3(at)))},
			allOf(glm::vec3(receiver.normal)),
			static_cast<float>(bias)};
}

// Returns false if no volume of the pack contains the receiver; else fills in all but the shares.
bool VolumeEvaluator::Data::contains(const Pack& pack, const Receiver& receiver, Terms& terms) const
{
	const float bias = receiver.bias;
	terms.first = pack.first - receiver.position;
	terms.height = -dotOf(pack.front, terms.first);
	terms.lift = Floats{};
	const Ints lifted = (magnitudeOf(terms.height) <= bias) & (magnitudeOf(dotOf(receiver.normal, pack.front)) <= 0.7F);
	if (anyOf(lifted)) // nookLift()
	{
		const Floats above = Floats{} + 1.01F * bias;
		terms.lift = lifted ? ((pack.two_sided & (terms.height < 0.0F)) ? -above : above) - terms.height : terms.lift;
		terms.height += terms.lift;
	}
	const Floats up = pack.two_sided ? magnitudeOf(terms.height) : terms.height;
	terms.held = (up > bias) & (up < pack.reach);
	if (!anyOf(terms.held))
	{
		return false;
	}
	const float scale = 1.0F / static_cast<float>(set.distance_m);
	terms.outside = Floats{};
	terms.falloff = pack.alpha * (1.0F - magnitudeOf(terms.height) * scale);
	for (std::size_t i = 0; i < pack.edges; ++i)
	{
		const Edges& edge = edges[pack.first_edge + i];
		const Floats outside = edge.offset + dotOf(terms.first, edge.inward); // AOV eq. 7; a lift does not change it
		const Floats side = 1.0F - outside * scale;
		terms.held &= (side > 0.0F) & (side >= pack.least_side);
		terms.outside = outside > terms.outside ? outside : terms.outside;
		terms.falloff *= side < 1.0F ? side : Floats{} + 1.0F;
	}
	for (std::size_t lane = 0; anyOf(terms.held & pack.clamped) && lane < 4; ++lane)
	{
		const bool is_held =
			pack.clamped[lane] == 0 || holds(pack.polygons[lane], glm::dvec3(laneOf(pack.front, lane)), receiver.at);
		terms.held[lane] &= is_held ? -1 : 0;
	}
	return anyOf(terms.held);
}

// Evaluates polygons like nookVolume().
void VolumeEvaluator::Data::share(const Pack& pack, const Receiver& receiver, bool roughly, Terms& terms) const
{
	const auto lifted = [&](const Vectors& corner)
	{
		return Vectors{corner.x - terms.lift * pack.front.x, corner.y - terms.lift * pack.front.y,
					   corner.z - terms.lift * pack.front.z};
	};
	const Vectors way = lifted({terms.first.x + pack.middle.x, terms.first.y + pack.middle.y, terms.first.z + pack.middle.z});
	const Floats square = dotOf(way, way);
	const Floats rise = dotOf(way, receiver.normal);
	terms.share = (rise > 0.0F ? rise : Floats{}) * magnitudeOf(terms.height) * (pack.area / (square * square));
	const Ints near = roughly ? terms.held & (square < pack.far) : terms.held;
	if (anyOf(near))
	{
		std::array<Vectors, kMaxOccluderCorners> outlines;
		for (std::size_t i = 0; i < pack.edges; ++i)
		{
			outlines[i] = lifted(corners[pack.first_edge + i] - receiver.position);
		}
		const Floats side = terms.height < 0.0F ? Floats{} - 1.0F : Floats{} + 1.0F;
		const Floats factors = formFactors(std::span(outlines).first(pack.edges), receiver.normal, side, near);
		terms.share = near ? factors : terms.share;
	}
	terms.share *= terms.falloff;
}

// Calls use(receiver number, pack, terms) for all packs with a volume that contains a receiver, for each of at most kAtOnce
// receivers in an order that depends on the volumes only, until it returns true. Neighbours share what is read of a pack.
template <class Use> void VolumeEvaluator::Data::visitTerms(std::span<const VolumeReceiver> of, bool roughly, const Use& use) const
{
	std::array<Receiver, kAtOnce> receivers;
	std::array<Boxes, kAtOnce / 4> boxes;
	boxes.fill(kNoBoxes);
	glm::vec3 least(std::numeric_limits<float>::infinity());
	glm::vec3 most = -least;
	for (std::size_t i = 0; i < of.size(); ++i)
	{
		receivers[i] = receiverOf(of[i]);
		const glm::vec3 at = laneOf(receivers[i].position.high, 0);
		const float radius = grown + receivers[i].bias; // a point that close behind a plane may be lifted into the volume
		setLane(boxes[i / 4].low, i % 4, at - radius);
		setLane(boxes[i / 4].high, i % 4, at + radius);
		least = glm::min(least, at - radius);
		most = glm::max(most, at + radius);
	}
	Terms terms;
	for (const uint32_t index : packsAt({allOf(least), allOf(most)}))
	{
		const Boxes& node = tree[0][index / 4];
		const Boxes box{allOf(laneOf(node.low, index % 4)), allOf(laneOf(node.high, index % 4))};
		for (std::size_t four = 0; 4 * four < of.size(); ++four)
		{
			const Ints met = box.meet(boxes[four]);
			for (std::size_t lane = 0; lane < 4; ++lane)
			{
				const std::size_t i = 4 * four + lane;
				if (met[lane] != 0 && contains(packs[index], receivers[i], terms))
				{
					share(packs[index], receivers[i], roughly, terms);
					if (use(i, packs[index], terms))
					{
						setLane(boxes[four].low, lane, laneOf(kNoBoxes.low, 0));
					}
				}
			}
		}
	}
}

void VolumeEvaluator::sums(std::span<const VolumeReceiver> receivers, std::span<VolumeSum> sums, bool roughly, double enough) const
{
	for (std::size_t first = 0; first < receivers.size(); first += kAtOnce)
	{
		const std::size_t size = std::min(kAtOnce, receivers.size() - first);
		std::array<Doubles, kAtOnce> totals{};
		std::array<Ints, kAtOnce> counts{};
		const auto totalOf = [&totals](std::size_t i)
		{
			return totals[i][0] + totals[i][1] + totals[i][2] + totals[i][3];
		};
		m_data->visitTerms(receivers.subspan(first, size), roughly,
						   [&](std::size_t i, const Pack&, const Terms& terms)
						   {
							   totals[i] += __builtin_convertvector(terms.held ? terms.share : Floats{}, Doubles);
							   counts[i] -= terms.held;
							   return totalOf(i) >= enough;
						   });
		for (std::size_t i = 0; i < size; ++i)
		{
			const Ints& count = counts[i];
			sums[first + i] = {totalOf(i), static_cast<uint32_t>(count[0] + count[1] + count[2] + count[3])};
		}
	}
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
	for (std::size_t first = 0; first < receivers.size(); first += kAtOnce)
	{
		m_data->visitTerms(receivers.subspan(first, std::min(kAtOnce, receivers.size() - first)), true,
						   [&](std::size_t i, const Pack& pack, const Terms& terms)
						   {
							   for (std::size_t lane = 0; lane < 4; ++lane)
							   {
								   if (terms.held[lane] != 0 && terms.share[lane] > 0.0F)
								   {
									   shares[first + i].push_back({pack.polygons[lane], terms.share[lane],
																	std::fabs(terms.height[lane]), terms.outside[lane]});
								   }
							   }
							   return false;
						   });
	}
}

VolumeMask VolumeEvaluator::mask(glm::dvec3 position, glm::dvec3 normal, int directions, double bias_m) const
{
	assert(m_data->packs.empty() || !m_data->fours.empty());
	const MaskTables& tables = maskTablesOf(directions);
	MaskBits open;
	open.fill(glm::uvec4(~0U));
	const auto reach = static_cast<float>(m_data->set.distance_m);
	MaskReceiver receiver(glm::vec3(normal), tables, reach);
	VolumeMask mask;
	const Receiver at = m_data->receiverOf({position, normal, bias_m});
	const glm::vec3 point = laneOf(at.position.high, 0);
	const float radius = m_data->grown + at.bias;
	Held held;
	Terms terms;
	for (const uint32_t index : m_data->packsAt({allOf(point - radius), allOf(point + radius)}))
	{
		const Pack& pack = m_data->packs[index];
		const bool any = m_data->contains(pack, at, terms);
		for (std::size_t lane = 0; any && lane < 4; ++lane)
		{
			if (terms.held[lane] != 0)
			{
				held.index = pack.polygons[lane];
				held.front = laneOf(pack.front, lane);
				held.height = terms.height[lane];
				m_data->outline(held, terms.lift[lane], at);
				receiver.cover(held, m_data->set.occluders.polygons[held.index], open);
				mask.volumes += 1;
			}
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
	const auto evaluator = std::make_shared<const VolumeEvaluator>(*volumes, run, directions > 0);
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
		values = sumsAt(*evaluator, points, {threads, {}}, true, volumes->compensation.enough());
		std::transform(values.begin(), values.end(), values.begin(),
					   [&](double sum) { return 1.0 - volumes->compensation.at(sum); });
		return values;
	};
}

} // namespace nook
