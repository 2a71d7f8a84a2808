// SPDX-License-Identifier: GPL-3.0-or-later
// Packs charts into pages: the largest first, each at the first row where its texels and their margin are free.
#include "bake/unwrap.h"
#include "core/lists.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>

namespace nook
{
namespace
{

// Texels of a row from `begin` up to `end`.
struct Run
{
	int row = 0;
	int begin = 0;
	int end = 0;
};

// The texels that a chart touches, with their margin.
struct Shape
{
	int width = 0;
	int height = 0;
	std::vector<Run> runs;
};

// Joins runs that touch; they are then in the order of rows.
void joinRuns(std::vector<Run>& runs)
{
	std::sort(runs.begin(), runs.end(),
			  [](const Run& a, const Run& b) { return std::tie(a.row, a.begin, a.end) < std::tie(b.row, b.begin, b.end); });
	std::size_t kept = 0;
	for (const Run& run : runs)
	{
		if (kept > 0 && runs[kept - 1].row == run.row && run.begin <= runs[kept - 1].end)
		{
			runs[kept - 1].end = std::max(runs[kept - 1].end, run.end);
		}
		else
		{
			runs[kept++] = run;
		}
	}
	runs.resize(kept);
}

// Adds the texels that a triangle touches.
void addTriangle(const std::array<glm::dvec2, 3>& corners, std::vector<Run>& runs)
{
	const auto [low, high] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
	for (int row = static_cast<int>(low); row <= static_cast<int>(high); ++row)
	{
		double least = 1e300;
		double most = -1e300;
		for (std::size_t i = 0; i < 3; ++i)
		{
			const glm::dvec2 a = corners[i];
			const glm::dvec2 b = corners[(i + 1) % 3];
			for (const double y : {std::clamp(static_cast<double>(row), std::min(a.y, b.y), std::max(a.y, b.y)),
								   std::clamp(row + 1.0, std::min(a.y, b.y), std::max(a.y, b.y))})
			{
				if (y >= row && y <= row + 1.0)
				{
					const double x = a.y == b.y ? a.x : a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
					least = std::min({least, x, a.y == b.y ? b.x : x});
					most = std::max({most, x, a.y == b.y ? b.x : x});
				}
			}
		}
		if (least <= most)
		{
			runs.push_back({row, static_cast<int>(least), static_cast<int>(most) + 1});
		}
	}
}

Shape shapeOf(const FlatChart& chart, const ChartPlace& place, int margin)
{
	std::vector<Run> texels;
	for (const glm::uvec3& t : chart.triangles)
	{
		addTriangle({place.at(chart.points[t.x]), place.at(chart.points[t.y]), place.at(chart.points[t.z])}, texels);
	}
	joinRuns(texels);
	Shape shape;
	for (const Run& run : texels)
	{
		for (int row = run.row; row <= run.row + 2 * margin; ++row)
		{
			shape.runs.push_back({row, run.begin, run.end + 2 * margin});
		}
	}
	joinRuns(shape.runs);
	for (const Run& run : shape.runs)
	{
		shape.width = std::max(shape.width, run.end);
		shape.height = std::max(shape.height, run.row + 1);
	}
	// Wide runs meet what is there first.
	std::stable_sort(shape.runs.begin(), shape.runs.end(),
					 [](const Run& a, const Run& b) { return a.end - a.begin > b.end - b.begin; });
	return shape;
}

class Page
{
public:
	explicit Page(int size_px)
		: m_size(size_px), m_words(static_cast<std::size_t>(size_px + 63) / 64),
		  m_used(static_cast<std::size_t>(size_px) * m_words, 0)
	{
	}

	// The first free place in or below that row, in rows before `end`.
	std::optional<glm::ivec2> find(const Shape& shape, int row, int end) const
	{
		for (int y = row; y < std::min(end, m_size - shape.height + 1); ++y)
		{
			for (int x = 0; x <= m_size - shape.width;)
			{
				const int next = firstFree(shape, x, y);
				if (next == x)
				{
					return glm::ivec2(x, y);
				}
				x = next;
			}
		}
		return {};
	}

	void take(const Shape& shape, glm::ivec2 at)
	{
		for (const Run& run : shape.runs)
		{
			for (int x = at.x + run.begin; x < at.x + run.end; ++x)
			{
				m_used[wordOf(at.y + run.row, x)] |= uint64_t{1} << static_cast<unsigned>(x % 64);
			}
		}
	}

private:
	std::size_t wordOf(int y, int x) const
	{
		return static_cast<std::size_t>(y) * m_words + static_cast<std::size_t>(x) / 64;
	}

	// The first x, from `begin` up to `end`, whose bit is set after flipping by `flip`; `end` if there is none.
	int firstSet(int y, int begin, int end, uint64_t flip) const
	{
		for (int x = begin; x < end; x = (x / 64 + 1) * 64)
		{
			const uint64_t bits = (m_used[wordOf(y, x)] ^ flip) >> static_cast<unsigned>(x % 64);
			if (bits != 0)
			{
				return std::min(end, x + std::countr_zero(bits));
			}
		}
		return end;
	}

	// x if the shape is free there, else the next place that may be.
	int firstFree(const Shape& shape, int x, int y) const
	{
		for (const Run& run : shape.runs)
		{
			const int used = firstSet(y + run.row, x + run.begin, x + run.end, 0);
			if (used < x + run.end)
			{
				return firstSet(y + run.row, used, m_size, ~uint64_t{0}) - run.begin;
			}
		}
		return x;
	}

	int m_size;
	std::size_t m_words;
	std::vector<uint64_t> m_used; // a bit per texel
};

} // namespace

std::optional<std::vector<ChartPlace>> packCharts(std::span<const FlatChart> charts, std::span<const ScaledChart> scaled,
												  double texels_per_m, const UnwrapSettings& settings, int threads)
{
	const auto margin = static_cast<std::size_t>(settings.margin_px);
	std::vector<std::array<ChartPlace, 2>> sides(scaled.size()); // both orientations
	std::vector<std::array<Shape, 2>> shapes(scaled.size());
	const auto size = static_cast<double>(settings.size_px);
	double area = 0.0;
	for (std::size_t i = 0; i < scaled.size(); ++i)
	{
		const double scale = scaled[i].scale * texels_per_m;
		const glm::dvec2 most = scale * charts[scaled[i].chart].size;
		sides[i] = {ChartPlace{0, false, scale, glm::dvec2(0.0)}, ChartPlace{0, true, scale, {std::ceil(most.y), 0.0}}};
		area += static_cast<double>((2 * margin + 1) * (2 * margin + 1));
		if (std::max(most.x, most.y) + 2.0 * static_cast<double>(margin) > size)
		{
			return {};
		}
	}
	if (area > size * size * static_cast<double>(settings.pages))
	{
		return {};
	}
	parallelFor(2 * scaled.size(), threads,
				[&](std::size_t i)
				{ shapes[i / 2][i % 2] = shapeOf(charts[scaled[i / 2].chart], sides[i / 2][i % 2], settings.margin_px); });
	std::vector<uint32_t> order = countingFrom(0U, shapes.size());
	const auto key = [&](uint32_t i)
	{
		const auto [less, more] = std::minmax(shapes[i][0].width, shapes[i][0].height);
		return std::tuple(-more, -less, i);
	};
	std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
	std::vector<ChartPlace> places(shapes.size());
	std::vector<Page> pages;
	// Where a shape of that size was last found, on each page: another one needs no look above.
	std::map<std::tuple<std::size_t, int, int>, int> rows;
	for (const uint32_t i : order)
	{
		const std::array<Shape, 2>& both = shapes[i];
		bool found = false;
		for (std::size_t p = 0; p < settings.pages && !found; ++p)
		{
			if (p == pages.size())
			{
				pages.emplace_back(settings.size_px);
			}
			std::optional<glm::ivec2> best;
			std::size_t side = 0;
			for (std::size_t k = 0; k < 2; ++k)
			{
				int& row = rows[{p, both[k].width, both[k].height}];
				const int end = best ? best->y + both[side].height - both[k].height + 1 : settings.size_px;
				const std::optional<glm::ivec2> at = pages[p].find(both[k], row, end);
				row = at ? at->y : std::max(row, std::min(end, settings.size_px));
				if (at && (!best || at->y + both[k].height < best->y + both[side].height))
				{
					best = at;
					side = k;
				}
			}
			if (best)
			{
				pages[p].take(both[side], *best);
				places[i] = sides[i][side];
				places[i].page = static_cast<uint32_t>(p);
				places[i].corner += glm::dvec2(*best) + static_cast<double>(margin);
				found = true;
			}
		}
		if (!found)
		{
			return {};
		}
	}
	return places;
}

} // namespace nook
