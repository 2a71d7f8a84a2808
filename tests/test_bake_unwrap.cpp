// SPDX-License-Identifier: GPL-3.0-or-later
// Charts: no overlaps, no folds, little stretch, for clean meshes and for broken ones.
#include "bake_levels.h"
#include "testing.h"

#include "bake/unwrap.h"

namespace
{

UnwrapPiece pieceOf(std::size_t first, std::size_t count, std::size_t like = SIZE_MAX)
{
	UnwrapPiece piece;
	piece.triangles.resize(count);
	std::iota(piece.triangles.begin(), piece.triangles.end(), static_cast<uint32_t>(first));
	piece.like = like;
	return piece;
}

Unwrapped unwrapAll(const Level& level, const UnwrapSettings& settings, int threads = 1)
{
	const std::vector<UnwrapPiece> pieces{pieceOf(0, level.triangles.size())};
	return unwrap(level, pieces, settings, {threads, {}});
}

UnwrapSettings across(int size_px)
{
	UnwrapSettings settings{.size_px = size_px};
	return settings;
}

double areaOf(const Unwrapped& made, std::size_t t)
{
	const glm::uvec3 c = made.level.triangles[t];
	const glm::dvec2 u(made.level.uvs[c.y] - made.level.uvs[c.x]);
	const glm::dvec2 v(made.level.uvs[c.z] - made.level.uvs[c.x]);
	return 0.5 * (u.x * v.y - u.y * v.x);
}

// Separates two triangles that share no interior: an edge of one has the other on its far side, up to `slack`.
bool areApart(const Unwrapped& made, std::size_t a, std::size_t b, double slack)
{
	for (const auto& [of, other] : {std::pair(a, b), std::pair(b, a)})
	{
		for (int k = 0; k < 3; ++k)
		{
			const glm::uvec3 t = made.level.triangles[of];
			const glm::dvec2 from(made.level.uvs[t[k]]);
			const glm::dvec2 edge = glm::dvec2(made.level.uvs[t[(k + 1) % 3]]) - from;
			bool outside = true;
			for (int i = 0; i < 3; ++i)
			{
				const glm::dvec2 to = glm::dvec2(made.level.uvs[made.level.triangles[other][i]]) - from;
				outside = outside && edge.x * to.y - edge.y * to.x <= slack * glm::length(edge);
			}
			if (outside)
			{
				return true;
			}
		}
	}
	return false;
}

// Every triangle with an area lies on a page, none is turned over, and no two overlap by more than a thousandth of a texel.
void checkCharts(const Level& level, const Unwrapped& made)
{
	REQUIRE(made.level.triangles.size() == level.triangles.size());
	std::size_t turned = 0;
	std::size_t overlaps = 0;
	for (std::size_t t = 0; t < made.level.triangles.size(); ++t)
	{
		for (int k = 0; k < 3; ++k)
		{
			const uint32_t v = made.level.triangles[t][k];
			const glm::dvec3 before = level.positions[level.triangles[t][k]];
			CHECK((made.level.positions[v] == before || before != before)); // broken meshes have points that are no number
			CHECK((made.level.uvs[v].x >= 0.0F && made.level.uvs[v].x <= 1.0F && made.level.uvs[v].y >= 0.0F &&
				   made.level.uvs[v].y <= 1.0F));
		}
		turned += made.page_of[t] != kNoPage && areaOf(made, t) <= 0.0 ? 1U : 0U;
		for (std::size_t other = 0; other < t && made.page_of[t] != kNoPage; ++other)
		{
			overlaps += made.page_of[other] == made.page_of[t] && !areApart(made, t, other, 1e-3 / made.size_px) ? 1U : 0U;
		}
	}
	CHECK(turned == 0);
	CHECK(overlaps == 0);
	CHECK(made.coverage > 0.0);
	CHECK(made.coverage <= 1.0);
}

Level sphere(int rows)
{
	Level level = emptyLevel();
	const auto at = [&](int row, int column)
	{
		const double theta = kPi * row / rows;
		const double phi = kPi * (column % (2 * rows)) / rows;
		return glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
	};
	for (int row = 0; row <= rows; ++row)
	{
		for (int column = 0; column < 2 * rows; ++column)
		{
			addVertex(level, row == 0 ? glm::dvec3(0.0, 1.0, 0.0) : row == rows ? glm::dvec3(0.0, -1.0, 0.0) : at(row, column));
		}
	}
	const auto index = [&](int row, int column)
	{
		return static_cast<uint32_t>(row * 2 * rows + column % (2 * rows));
	};
	for (int row = 0; row < rows; ++row)
	{
		for (int column = 0; column < 2 * rows; ++column)
		{
			if (row > 0)
			{
				addTriangle(level, index(row, column), index(row + 1, column), index(row, column + 1));
			}
			if (row + 1 < rows)
			{
				addTriangle(level, index(row, column + 1), index(row + 1, column), index(row + 1, column + 1));
			}
		}
	}
	return level;
}

// Adds the level's triangles again, larger and elsewhere.
void addAgain(Level& level, double scale, glm::dvec3 move)
{
	const std::size_t count = level.triangles.size();
	const auto vertices = static_cast<uint32_t>(level.positions.size());
	for (uint32_t v = 0; v < vertices; ++v)
	{
		addVertex(level, scale * level.positions[v] + move);
	}
	for (std::size_t t = 0; t < count; ++t)
	{
		const glm::uvec3 c = level.triangles[t] + vertices;
		addTriangle(level, c.x, c.y, c.z);
	}
}

} // namespace

TEST_CASE("unwrap: the faces of a cube are six squares without stretch", "[bake]")
{
	Level level = emptyLevel();
	addBox(level, {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0});
	const Unwrapped made = unwrapAll(level, across(128));
	checkCharts(level, made);
	CHECK(made.charts == 6);
	CHECK(made.pages == 1);
	CHECK(made.stretch == Approx(1.0).margin(1e-9));
	CHECK(made.coverage > 0.45); // three squares in a row of 128 texels, each with 6 texels of margin: 0.49 at most
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		CHECK(areaOf(made, t) == Approx(0.5 / std::pow(made.texel_m * made.size_px, 2.0)).epsilon(1e-5));
	}
}

TEST_CASE("unwrap: a sphere has few charts with little stretch, whatever the number of threads", "[bake]")
{
	const Level level = sphere(24);
	const Unwrapped made = unwrapAll(level, across(256));
	checkCharts(level, made);
	CAPTURE(made.charts, made.stretch, made.coverage);
	CHECK(made.charts <= 16);
	CHECK(made.stretch < 1.06);
	CHECK(made.coverage > 0.4);
	const Unwrapped again = unwrapAll(level, across(256), 3);
	CHECK(again.level.uvs == made.level.uvs);
	CHECK(again.level.triangles == made.level.triangles);
}

TEST_CASE("unwrap: texels have the size that is asked for, on as many pages as they need", "[bake]")
{
	const Level level = sphere(8);
	UnwrapSettings settings{.texel_m = 0.02};
	const Unwrapped one = unwrapAll(level, settings);
	checkCharts(level, one);
	CHECK(one.size_px == 256); // 30000 texels, with margins more than 128 x 128
	CHECK(one.texel_m == 0.02);
	settings.size_px = 128;
	settings.pages = 8;
	const Unwrapped many = unwrapAll(level, settings);
	checkCharts(level, many);
	CHECK(many.pages > 2);
	CHECK(many.pages <= 8);
	settings.pages = 2;
	CHECK_THROWS_WITH(unwrapAll(level, settings), Catch::Contains("that 2 pages of 128 texels do not hold"));
	settings.pages = 1;
	settings.size_px = 16;
	settings.texel_m = 0.0;
	settings.margin_px = 8;
	CHECK_THROWS_AS(unwrapAll(level, settings), Error);
}

TEST_CASE("unwrap: charts keep their margin", "[bake]")
{
	Level level = emptyLevel();
	for (int i = 0; i < 5; ++i)
	{
		addQuad(level, {2.0 * i, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0});
	}
	UnwrapSettings settings = across(64);
	settings.margin_px = 4;
	const Unwrapped made = unwrapAll(level, settings);
	checkCharts(level, made);
	REQUIRE(made.charts == 5);
	std::vector<glm::dvec2> least(5, glm::dvec2(1e9));
	std::vector<glm::dvec2> most(5, glm::dvec2(-1e9));
	for (std::size_t t = 0; t < made.level.triangles.size(); ++t)
	{
		for (int k = 0; k < 3; ++k)
		{
			const glm::dvec2 p = 64.0 * glm::dvec2(made.level.uvs[made.level.triangles[t][k]]);
			least[t / 2] = glm::min(least[t / 2], p);
			most[t / 2] = glm::max(most[t / 2], p);
		}
	}
	for (std::size_t a = 0; a < 5; ++a)
	{
		CHECK(std::min(least[a].x, least[a].y) >= 4.0 - 1e-3);
		CHECK(std::max(most[a].x, most[a].y) <= 60.0 + 1e-3);
		for (std::size_t b = 0; b < a; ++b)
		{
			const glm::dvec2 gap = glm::max(least[a] - most[b], least[b] - most[a]);
			CHECK(std::max(gap.x, gap.y) >= 8.0 - 1e-3);
		}
	}
}

TEST_CASE("unwrap: broken meshes get charts as well", "[bake]")
{
	Level level = emptyLevel();
	Random random(7, 0);
	for (int i = 0; i < 60; ++i)
	{
		addVertex(level, {random.uniform(), random.uniform(), random.uniform()});
	}
	addVertex(level, glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
	addVertex(level, glm::dvec3(1e300));
	for (int i = 0; i < 200; ++i) // edges with many triangles, in any direction
	{
		addTriangle(level, static_cast<uint32_t>(random.below(60)), static_cast<uint32_t>(random.below(60)),
					static_cast<uint32_t>(random.below(60)));
	}
	addTriangle(level, 0, 1, 2);
	addTriangle(level, 0, 1, 2); // again
	addTriangle(level, 2, 1, 0); // its back
	addTriangle(level, 3, 3, 4);
	addTriangle(level, 5, 5, 5);
	addTriangle(level, 6, 7, 60);
	addTriangle(level, 6, 7, 61);
	const Unwrapped made = unwrapAll(level, across(512));
	checkCharts(level, made);
	for (std::size_t t = 203; t < 207; ++t)
	{
		CHECK(made.page_of[t] == kNoPage);
	}
	CHECK(made.page_of[200] != kNoPage);
	CHECK(made.page_of[201] != kNoPage);
	CHECK(made.page_of[202] != kNoPage);
	CHECK_THROWS_WITH(unwrap(level, std::vector<UnwrapPiece>{pieceOf(203, 4)}, across(64), {}),
					  Catch::Contains("no triangle with an area"));
}

TEST_CASE("unwrap: a mesh whose first place has no size gets charts at the others", "[bake]")
{
	Level level = sphere(8);
	const std::size_t count = level.triangles.size();
	const auto vertices = static_cast<std::ptrdiff_t>(level.positions.size());
	addAgain(level, 1.0, {});
	std::fill_n(level.positions.begin(), vertices, glm::dvec3(0.0));
	const std::vector<UnwrapPiece> pieces{pieceOf(0, count), pieceOf(count, count, 0)};
	const Unwrapped made = unwrap(level, pieces, across(256), {});
	checkCharts(level, made);
	CHECK(std::count(made.page_of.begin(), made.page_of.end(), kNoPage) == static_cast<std::ptrdiff_t>(count));
	CHECK(made.page_of.front() == kNoPage);
}

TEST_CASE("unwrap: places of one mesh get the same charts in their own sizes", "[bake]")
{
	Level level = sphere(8);
	const std::size_t count = level.triangles.size();
	addAgain(level, 2.0, {5.0, 0.0, 0.0});
	const std::vector<UnwrapPiece> pieces{pieceOf(0, count), pieceOf(count, count, 0)};
	const Unwrapped made = unwrap(level, pieces, across(512), {});
	checkCharts(level, made);
	REQUIRE(made.level.positions.size() % 2 == 0);
	for (std::size_t t = 0; t < count; ++t)
	{
		CHECK(areaOf(made, t + count) == Approx(4.0 * areaOf(made, t)).epsilon(1e-2));
		CHECK(made.level.triangles[t + count] == made.level.triangles[t] + static_cast<uint32_t>(made.level.positions.size() / 2));
	}
}
