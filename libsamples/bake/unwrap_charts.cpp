// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: M. Garland, A. Willmott, P. Heckbert, "Hierarchical Face Clustering on Polygonal Surfaces", 2001;
// P. Sander, J. Snyder, S. Gortler, H. Hoppe, "Texture Mapping Progressive Meshes", 2001 (stretch).
#include "bake/unwrap.h"

#include "core/lists.h"
#include "core/math.h"
#include "core/parallel.h"
#include "scene/topology.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>
#include <utility>

namespace nook
{
namespace
{

constexpr double kCrease = 0.5;          // cosine: charts end at sharper edges, where visibility jumps
constexpr double kMostBent = 0.13;       // 1 − |mean normal| of a chart: a cap of 42 degrees
constexpr double kRoundness = 0.02;      // weight of the perimeter; tuned on Sponza
constexpr double kMostIrregular = 10.0;  // perimeter² / (4π area)
constexpr double kMostStretch = 1.1;     // of a chart
constexpr double kLeastArea = 0.1;       // of a triangle, in that of its neighbours' scale
constexpr double kFlat = 1e-9;           // 1 − |mean normal| of charts that need no more than a projection
constexpr double kSliver = 1e-6;         // height of triangles that count as lines, in their longest edge
constexpr double kSlack = 1e-6;          // overlap that is rounding, in the square root of a chart's area
constexpr std::size_t kDirections = 200; // of a chart's edges that are tried

struct Triangle
{
	glm::uvec3 corner{0};   // welded
	glm::dvec3 normal{0.0}; // as long as its area
	double area = 0.0;      // 0: a line or a point
	std::array<uint32_t, 3> next{kNoIndex, kNoIndex,
								 kNoIndex}; // 3 × triangle + edge behind each of its edges, from corner k to k + 1
	uint32_t piece = 0;
};

struct Side
{
	std::array<uint32_t, 4> key{}; // piece, layer, lower and higher corner
	uint32_t side = 0;
	bool ascends = false;
};

// A tree of merged triangles: the leaves come first.
struct Cluster
{
	glm::dvec3 normal{0.0}; // sum over the triangles
	double area = 0.0;
	double perimeter = 0.0;
	uint32_t left = kNoIndex;
	uint32_t right = kNoIndex;
	uint32_t parent = kNoIndex;
	std::vector<std::pair<uint32_t, double>> neighbours; // and the length of the common border
};

double bentOf(glm::dvec3 normal, double area)
{
	return 1.0 - glm::length(normal) / area;
}

// Is a triangle on the outer side of an edge of another, up to `slack`?
bool isOutside(const FlatChart& chart, glm::uvec3 of, glm::uvec3 other, double slack)
{
	for (int k = 0; k < 3; ++k)
	{
		const glm::dvec2 from = chart.points[of[k]];
		const glm::dvec2 edge = chart.points[of[(k + 1) % 3]] - from;
		const double most = std::max({crossOf(edge, chart.points[other.x] - from), crossOf(edge, chart.points[other.y] - from),
									  crossOf(edge, chart.points[other.z] - from)});
		if (most <= slack * glm::length(edge))
		{
			return true;
		}
	}
	return false;
}

// Do two of a chart's triangles overlap, none of which is turned over?
bool overlaps(const FlatChart& chart, double slack)
{
	struct Box
	{
		glm::dvec2 low{0.0};
		glm::dvec2 high{0.0};
		glm::uvec3 triangle{0};
	};
	std::vector<Box> boxes = mapped(chart.triangles,
									[&](const glm::uvec3& t)
									{
										const std::array<glm::dvec2, 3> p{chart.points[t.x], chart.points[t.y], chart.points[t.z]};
										return Box{glm::min(p[0], glm::min(p[1], p[2])), glm::max(p[0], glm::max(p[1], p[2])), t};
									});
	std::sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.low.x < b.low.x; });
	std::vector<Box> active;
	for (const Box& box : boxes)
	{
		std::erase_if(active, [&](const Box& other) { return other.high.x <= box.low.x; });
		for (const Box& other : active)
		{
			if (other.low.y < box.high.y && box.low.y < other.high.y && !isOutside(chart, box.triangle, other.triangle, slack) &&
				!isOutside(chart, other.triangle, box.triangle, slack))
			{
				return true;
			}
		}
		active.push_back(box);
	}
	return false;
}

// Moves a chart to the origin, turned along the edge with the bounding box of least area.
void settle(FlatChart& chart)
{
	glm::dvec2 low(0.0);
	glm::dvec2 high(0.0);
	const auto measure = [&](glm::dvec2 axis)
	{
		low = glm::dvec2(1e300);
		high = glm::dvec2(-1e300);
		for (const glm::dvec2 p : chart.points)
		{
			const glm::dvec2 turned(glm::dot(axis, p), crossOf(axis, p));
			low = glm::min(low, turned);
			high = glm::max(high, turned);
		}
	};
	glm::dvec2 best(1.0, 0.0);
	double least = 1e300;
	for (std::size_t i = 0; i < 3 * chart.triangles.size(); i += 1 + 3 * chart.triangles.size() / kDirections)
	{
		const glm::uvec3 t = chart.triangles[i / 3];
		const int k = static_cast<int>(i % 3);
		const glm::dvec2 axis = glm::normalize(chart.points[t[(k + 1) % 3]] - chart.points[t[k]]);
		measure(axis);
		const double area = (high.x - low.x) * (high.y - low.y);
		if (area < 0.999 * least) // rounding decides nothing
		{
			least = area;
			best = axis;
		}
	}
	measure(best);
	for (glm::dvec2& p : chart.points)
	{
		p = glm::dvec2(glm::dot(best, p), crossOf(best, p)) - low;
	}
	chart.size = high - low;
}

class ChartMaker
{
public:
	// `charted`: the piece that has each piece's charts.
	ChartMaker(const Level& level, std::span<const UnwrapPiece> pieces, std::span<const std::size_t> charted, int threads)
		: m_level(level), m_weld(weldPositions(level.positions, threads))
	{
		for (uint32_t p = 0; p < pieces.size(); ++p)
		{
			for (std::size_t i = 0; charted[p] == p && i < pieces[p].triangles.size(); ++i)
			{
				add(level.triangles[pieces[p].triangles[i]], p);
			}
		}
		link();
	}

	std::vector<Chart> charts(int threads)
	{
		merge();
		std::vector<uint32_t> roots;
		m_root.resize(m_triangles.size(), kNoIndex);
		for (uint32_t c = 0; c < m_clusters.size(); ++c)
		{
			if (m_clusters[c].parent == kNoIndex && m_clusters[c].area > 0.0)
			{
				for (const uint32_t t : leavesOf(c))
				{
					m_root[t] = c;
				}
				roots.push_back(c);
			}
			m_clusters[c].neighbours = {};
		}
		for (uint32_t t = 0; t < m_triangles.size(); ++t)
		{
			for (uint32_t& next : m_triangles[t].next)
			{
				next = next != kNoIndex && m_root[next / 3] == m_root[t] ? next : kNoIndex;
			}
		}
		m_member.resize(m_triangles.size(), kNoIndex);
		m_local.resize(m_triangles.size(), 0);
		std::vector<std::vector<Chart>> made(roots.size());
		parallelFor(roots.size(), threads, [&](std::size_t i) { flattenAll(roots[i], made[i]); });
		std::vector<Chart> all;
		for (std::vector<Chart>& some : made)
		{
			std::move(some.begin(), some.end(), std::back_inserter(all));
		}
		return all;
	}

private:
	const glm::dvec3& at(uint32_t welded) const
	{
		return m_level.positions[welded];
	}

	void add(glm::uvec3 corners, uint32_t piece)
	{
		Triangle& made = m_triangles.emplace_back();
		made.piece = piece;
		made.corner = {m_weld[corners.x], m_weld[corners.y], m_weld[corners.z]};
		const std::array<glm::dvec3, 3> p{at(made.corner.x), at(made.corner.y), at(made.corner.z)};
		const glm::dvec3 twice = glm::cross(p[1] - p[0], p[2] - p[0]);
		const double longest = std::max({glm::distance(p[0], p[1]), glm::distance(p[1], p[2]), glm::distance(p[2], p[0])});
		if (glm::length(twice) > kSliver * longest * longest && longest < kFarthest_m)
		{
			made.normal = 0.5 * twice;
			made.area = glm::length(made.normal);
		}
	}

	// Joins triangles across edges that two of them share, in opposite directions. Repeated triangles join among themselves.
	void link()
	{
		std::vector<uint32_t> order = countingFrom(0U, m_triangles.size());
		const auto key = [&](uint32_t t)
		{
			std::array<uint32_t, 4> corners{m_triangles[t].piece, m_triangles[t].corner.x, m_triangles[t].corner.y,
											m_triangles[t].corner.z};
			std::sort(corners.begin() + 1, corners.end());
			return corners;
		};
		std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
		std::vector<Side> sides;
		uint32_t layer = 0;
		for (std::size_t i = 0; i < order.size(); ++i)
		{
			const Triangle& triangle = m_triangles[order[i]];
			layer = i > 0 && key(order[i]) == key(order[i - 1]) ? layer + 1 : 0;
			for (uint32_t k = 0; k < 3 && triangle.area > 0.0; ++k)
			{
				const uint32_t a = triangle.corner[static_cast<int>(k)];
				const uint32_t b = triangle.corner[static_cast<int>((k + 1) % 3)];
				sides.push_back({{triangle.piece, layer, std::min(a, b), std::max(a, b)}, 3 * order[i] + k, a < b});
			}
		}
		std::sort(sides.begin(), sides.end(),
				  [](const Side& a, const Side& b) { return std::tie(a.key, a.side) < std::tie(b.key, b.side); });
		const auto join = [&](std::span<const Side> edge)
		{
			Triangle& a = m_triangles[edge.front().side / 3];
			Triangle& b = m_triangles[edge.back().side / 3];
			if (edge.size() == 2 && edge[0].ascends != edge[1].ascends && glm::dot(a.normal, b.normal) >= kCrease * a.area * b.area)
			{
				a.next[edge[0].side % 3] = edge[1].side;
				b.next[edge[1].side % 3] = edge[0].side;
			}
		};
		eachRun(
			std::span<const Side>(sides), [](const Side& a, const Side& b) { return a.key == b.key; }, join);
	}

	double edgeLength(const Triangle& triangle, uint32_t k) const
	{
		return glm::distance(at(triangle.corner[static_cast<int>(k)]), at(triangle.corner[static_cast<int>((k + 1) % 3)]));
	}

	using Merge = std::tuple<double, uint32_t, uint32_t>; // cost, clusters

	// The cost of a merge, if it is allowed.
	std::optional<double> costOf(uint32_t a, uint32_t b, double border) const
	{
		const double area = m_clusters[a].area + m_clusters[b].area;
		const double bent = bentOf(m_clusters[a].normal + m_clusters[b].normal, area);
		const auto irregular = [](double perimeter, double of)
		{
			return perimeter * perimeter / (4.0 * kPi * of);
		};
		const double made = irregular(m_clusters[a].perimeter + m_clusters[b].perimeter - 2.0 * border, area);
		const double before = std::max(irregular(m_clusters[a].perimeter, m_clusters[a].area),
									   irregular(m_clusters[b].perimeter, m_clusters[b].area));
		const bool allowed = bent <= kMostBent && made <= std::max(kMostIrregular, before);
		return allowed ? std::optional(area * (bent + kRoundness * made)) : std::nullopt;
	}

	// Merges neighbours, the cheapest first.
	void merge()
	{
		m_clusters.resize(m_triangles.size());
		std::priority_queue<Merge, std::vector<Merge>, std::greater<>> queue;
		const auto ask = [&](uint32_t a, uint32_t b, double border)
		{
			if (const std::optional<double> cost = costOf(a, b, border))
			{
				queue.emplace(*cost, std::min(a, b), std::max(a, b));
			}
		};
		for (uint32_t t = 0; t < m_triangles.size(); ++t)
		{
			const Triangle& triangle = m_triangles[t];
			Cluster& cluster = m_clusters[t];
			cluster.normal = triangle.normal;
			cluster.area = triangle.area;
			for (uint32_t k = 0; k < 3; ++k)
			{
				cluster.perimeter += edgeLength(triangle, k);
				if (triangle.next[k] != kNoIndex)
				{
					addBorder(cluster, triangle.next[k] / 3, edgeLength(triangle, k));
				}
			}
		}
		for (uint32_t t = 0; t < m_triangles.size(); ++t)
		{
			for (const auto& [other, border] : m_clusters[t].neighbours)
			{
				if (other > t)
				{
					ask(t, other, border);
				}
			}
		}
		while (!queue.empty())
		{
			const auto [cost, a, b] = queue.top();
			queue.pop();
			if (m_clusters[a].parent == kNoIndex && m_clusters[b].parent == kNoIndex)
			{
				const uint32_t made = join(a, b);
				for (const auto& [other, border] : m_clusters[made].neighbours)
				{
					ask(other, made, border);
				}
			}
		}
	}

	static void addBorder(Cluster& cluster, uint32_t other, double length)
	{
		auto* const found = firstWhere(cluster.neighbours, [other](const auto& neighbour) { return neighbour.first == other; });
		(found != nullptr ? *found : cluster.neighbours.emplace_back(other, 0.0)).second += length;
	}

	uint32_t join(uint32_t a, uint32_t b)
	{
		const auto made = static_cast<uint32_t>(m_clusters.size());
		Cluster cluster;
		cluster.normal = m_clusters[a].normal + m_clusters[b].normal;
		cluster.area = m_clusters[a].area + m_clusters[b].area;
		cluster.perimeter = m_clusters[a].perimeter + m_clusters[b].perimeter;
		cluster.left = a;
		cluster.right = b;
		std::vector<std::pair<uint32_t, double>> all = std::move(m_clusters[a].neighbours);
		append(all, m_clusters[b].neighbours);
		std::sort(all.begin(), all.end());
		for (const auto& [other, border] : all)
		{
			if (other == a || other == b)
			{
				cluster.perimeter -= border;
			}
			else if (!cluster.neighbours.empty() && cluster.neighbours.back().first == other)
			{
				cluster.neighbours.back().second += border;
			}
			else
			{
				cluster.neighbours.emplace_back(other, border);
			}
		}
		for (const auto& [other, border] : cluster.neighbours)
		{
			std::erase_if(m_clusters[other].neighbours, [&](const auto& item) { return item.first == a || item.first == b; });
			m_clusters[other].neighbours.emplace_back(made, border);
		}
		m_clusters[b].neighbours = {};
		m_clusters[a].parent = m_clusters[b].parent = made;
		m_clusters.push_back(std::move(cluster));
		return made;
	}

	std::vector<uint32_t> leavesOf(uint32_t cluster) const
	{
		std::vector<uint32_t> leaves;
		std::vector<uint32_t> open{cluster};
		while (!open.empty())
		{
			const uint32_t c = open.back();
			open.pop_back();
			if (m_clusters[c].left == kNoIndex)
			{
				leaves.push_back(c);
				continue;
			}
			open.push_back(m_clusters[c].right);
			open.push_back(m_clusters[c].left);
		}
		std::sort(leaves.begin(), leaves.end());
		return leaves;
	}

	// Flattens a cluster as one chart or, where that fails, its parts.
	void flattenAll(uint32_t root, std::vector<Chart>& made)
	{
		std::vector<uint32_t> open{root};
		while (!open.empty())
		{
			const uint32_t cluster = open.back();
			open.pop_back();
			if (std::optional<Chart> chart = chartOf(leavesOf(cluster), cluster))
			{
				made.push_back(std::move(*chart));
				continue;
			}
			open.push_back(m_clusters[cluster].right);
			open.push_back(m_clusters[cluster].left);
		}
	}

	// Numbers the chart's vertices. Triangles around one position that share no edge have different ones.
	void numberCorners(Chart& chart, std::vector<glm::dvec3>& positions)
	{
		Groups groups(3 * chart.triangles.size());
		for (uint32_t i = 0; i < chart.triangles.size(); ++i)
		{
			const Triangle& triangle = m_triangles[chart.triangles[i]];
			for (uint32_t k = 0; k < 3; ++k)
			{
				const uint32_t next = triangle.next[k];
				if (next != kNoIndex && m_member[next / 3] == m_member[chart.triangles[i]])
				{
					const uint32_t other = 3 * m_local[next / 3];
					groups.join(3 * i + k, other + (next + 1 - next / 3 * 3) % 3);
					groups.join(3 * i + (k + 1) % 3, other + next % 3);
				}
			}
			chart.area += triangle.area;
		}
		std::vector<uint32_t> numbers(3 * chart.triangles.size(), kNoIndex);
		for (uint32_t i = 0; i < numbers.size(); ++i)
		{
			uint32_t& number = numbers[groups.rootOf(i)];
			if (number == kNoIndex)
			{
				number = static_cast<uint32_t>(positions.size());
				positions.push_back(at(m_triangles[chart.triangles[i / 3]].corner[static_cast<int>(i % 3)]));
			}
			if (i % 3 == 0)
			{
				chart.flat.triangles.emplace_back();
			}
			chart.flat.triangles.back()[static_cast<int>(i % 3)] = number;
		}
	}

	std::optional<Chart> chartOf(std::vector<uint32_t> triangles, uint32_t cluster)
	{
		Chart chart;
		chart.triangles = std::move(triangles);
		for (uint32_t i = 0; i < chart.triangles.size(); ++i)
		{
			m_member[chart.triangles[i]] = cluster;
			m_local[chart.triangles[i]] = i;
		}
		std::vector<glm::dvec3> positions;
		numberCorners(chart, positions);
		const glm::dvec3 normal = glm::normalize(m_clusters[cluster].normal);
		const glm::dvec3 side = std::fabs(normal.x) < 0.7 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
		const glm::dvec3 u = glm::normalize(glm::cross(side, normal));
		const glm::dvec3 v = glm::cross(normal, u);
		for (const glm::dvec3 position : positions)
		{
			const glm::dvec3 from = position - positions[0];
			chart.flat.points.emplace_back(glm::dot(u, from), glm::dot(v, from));
		}
		if (bentOf(m_clusters[cluster].normal, chart.area) > kFlat)
		{
			flattenRigid(chart.flat.triangles, positions, chart.flat.points);
		}
		if (!isGood(chart) && chart.triangles.size() > 1)
		{
			return {};
		}
		settle(chart.flat);
		return chart;
	}

	// Scales a chart to its area and measures its stretch; false if it folds, overlaps or is stretched too much.
	bool isGood(Chart& chart)
	{
		const auto areaOf = [&](const glm::uvec3& t)
		{
			return areaIn(chart.flat.points, t);
		};
		const double scale = std::sqrt(chart.area / sumOver(chart.flat.triangles, areaOf));
		for (glm::dvec2& p : chart.flat.points)
		{
			p *= scale;
		}
		chart.stretch = 0.0;
		for (std::size_t i = 0; i < chart.triangles.size(); ++i)
		{
			const Triangle& triangle = m_triangles[chart.triangles[i]];
			const glm::uvec3 t = chart.flat.triangles[i];
			const double flat = areaOf(t);
			if (!(flat >= kLeastArea * triangle.area))
			{
				return false;
			}
			// Sander et al., section 3: derivatives of the surface by the coordinates.
			const std::array<glm::dvec2, 3> p{chart.flat.points[t.x], chart.flat.points[t.y], chart.flat.points[t.z]};
			const std::array<glm::dvec3, 3> q{at(triangle.corner.x), at(triangle.corner.y), at(triangle.corner.z)};
			const glm::dvec3 by_u = ((p[2].y - p[0].y) * (q[1] - q[0]) - (p[1].y - p[0].y) * (q[2] - q[0])) / (2.0 * flat);
			const glm::dvec3 by_v = ((p[1].x - p[0].x) * (q[2] - q[0]) - (p[2].x - p[0].x) * (q[1] - q[0])) / (2.0 * flat);
			chart.stretch += 0.5 * (glm::dot(by_u, by_u) + glm::dot(by_v, by_v)) * triangle.area;
		}
		return chart.stretch <= kMostStretch * kMostStretch * chart.area && !overlaps(chart.flat, kSlack * std::sqrt(chart.area));
	}

	const Level& m_level;
	std::vector<uint32_t> m_weld;
	std::vector<Triangle> m_triangles;
	std::vector<Cluster> m_clusters;
	std::vector<uint32_t> m_root;   // per triangle
	std::vector<uint32_t> m_member; // per triangle: cluster of the chart that is being made
	std::vector<uint32_t> m_local;  // and its number there
};

} // namespace

std::vector<Chart> chartsOf(const Level& level, std::span<const UnwrapPiece> pieces, std::span<const std::size_t> charted,
							int threads)
{
	return ChartMaker(level, pieces, charted, threads).charts(threads);
}

} // namespace nook
