// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons made from triangles: equal area, convex, and independent of the tessellation.
#include "level_files.h"
#include "small_levels.h"
#include "testing.h"

#include "scene/builtin.h"
#include "volume/evaluate.h"
#include "volume/occluders.h"
#include "volume/surface.h"
#include "volume/volumes.h"

namespace
{

const nook::RunSettings kRun{2, {}};

struct Maker
{
	Level level = emptyLevel();

	// Cells of a grid where `keep` is true, as two triangles each, with alternating diagonals; vertices are never shared.
	void grid(int count, const std::function<glm::dvec3(double, double)>& at, const std::function<bool(double, double)>& keep,
			  uint32_t material = 0)
	{
		for (int i = 0; i < count * count; ++i)
		{
			const double x = static_cast<double>(i % count) / count;
			const double y = static_cast<double>(i / count) / count;
			const double step = 1.0 / count;
			if (!keep(x + 0.5 * step, y + 0.5 * step))
			{
				continue;
			}
			std::array<uint32_t, 4> corners{};
			for (int corner = 0; corner < 4; ++corner)
			{
				// From integers, so that adjacent corners are bit-identical.
				const double u = static_cast<double>(i % count + (corner == 1 || corner == 2 ? 1 : 0)) / count;
				const double v = static_cast<double>(i / count + (corner >= 2 ? 1 : 0)) / count;
				corners[static_cast<std::size_t>(corner)] = addVertex(level, at(u, v), glm::vec2(glm::dvec2(u, v)));
			}
			if (i % 2 == 0)
			{
				addTriangle(level, corners[0], corners[1], corners[2], material);
				addTriangle(level, corners[0], corners[2], corners[3], material);
			}
			else
			{
				addTriangle(level, corners[1], corners[2], corners[3], material);
				addTriangle(level, corners[1], corners[3], corners[0], material);
			}
		}
		level.meshes = {{"made", 0, level.triangles.size()}};
	}

	void box(glm::dvec3 least, glm::dvec3 most, bool inside_out = false)
	{
		std::array<uint32_t, 8> at{};
		for (uint32_t i = 0; i < 8; ++i)
		{
			at[i] = addVertex(
				level, {(i & 1U) != 0 ? most.x : least.x, (i & 2U) != 0 ? most.y : least.y, (i & 4U) != 0 ? most.z : least.z});
		}
		for (const std::array<uint32_t, 4>& face :
			 {std::array<uint32_t, 4>{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
		{
			const uint32_t b = at[face[inside_out ? 3 : 1]];
			const uint32_t d = at[face[inside_out ? 1 : 3]];
			addTriangle(level, at[face[0]], b, at[face[2]]);
			addTriangle(level, at[face[0]], at[face[2]], d);
		}
	}
};

// Without cutting long polygons, which has its own test.
Occluding occluders(const Level& level, nook::OccluderSettings settings = {})
{
	settings.extent = 0.0;
	return nook::occludersOf(level, settings, kRun);
}

std::span<const glm::dvec3> cornersOf(const nook::Occluders& occluders, const nook::Occluder& polygon)
{
	return std::span(occluders.corners).subspan(polygon.first_corner, polygon.corner_count);
}

glm::dvec3 doubleAreaOf(std::span<const glm::dvec3> corners)
{
	glm::dvec3 sum(0.0);
	for (std::size_t i = 1; i + 1 < corners.size(); ++i)
	{
		sum += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
	}
	return sum;
}

double areaOf(const nook::Occluders& occluders)
{
	const double sum = sumOver(occluders.polygons, [&](const nook::Occluder& polygon)
							   { return 0.5 * glm::length(doubleAreaOf(cornersOf(occluders, polygon))); });
	return sum;
}

// 3 to 16 corners, convex, flat, with area.
void requireSound(const nook::Occluders& occluders, double flat_m)
{
	for (const nook::Occluder& polygon : occluders.polygons)
	{
		REQUIRE((polygon.corner_count >= 3 && polygon.corner_count <= nook::kMaxOccluderCorners));
		REQUIRE((polygon.alpha > 0.0F && polygon.alpha <= 1.0F));
		const std::span<const glm::dvec3> corners = cornersOf(occluders, polygon);
		const glm::dvec3 front = nook::frontOf(corners);
		REQUIRE(glm::length(front) > 0.5);
		bool sound = true;
		for (std::size_t i = 0; i < corners.size(); ++i)
		{
			const glm::dvec3 side = corners[(i + 1) % corners.size()] - corners[i];
			const glm::dvec3 next = corners[(i + 2) % corners.size()] - corners[(i + 1) % corners.size()];
			sound = sound && glm::length(side) > 0.0 && std::fabs(glm::dot(corners[i] - corners[0], front)) <= 4.0 * flat_m &&
					glm::dot(glm::cross(side, next), front) >= -1e-9 * glm::length(side) * glm::length(next);
		}
		REQUIRE(sound); // distinct corners, flat, and no right turns
	}
}

// Corners of all polygons, rounded and sorted: equal for equal sets.
std::vector<std::string> listed(const nook::Occluders& occluders)
{
	std::vector<std::string> list;
	for (const nook::Occluder& polygon : occluders.polygons)
	{
		std::string text;
		for (const glm::dvec3 corner : cornersOf(occluders, polygon))
		{
			for (int axis = 0; axis < 3; ++axis)
			{
				text += std::to_string(std::lround(corner[axis] * 1e6)) + " ";
			}
			text += "; ";
		}
		list.push_back(text);
	}
	std::sort(list.begin(), list.end());
	return list;
}

bool everywhere(double, double)
{
	return true;
}

// Tilted and rounded to 32-bit floats, as in a file: no three of its points need be coplanar.
glm::dvec3 tilted(double u, double v)
{
	const glm::dvec3 exact =
		glm::dvec3(3.0, 1.0, -20.0) + 8.0 * u * glm::dvec3(0.36, 0.48, 0.8) + 4.0 * v * glm::dvec3(-0.8, 0.6, 0.0);
	return glm::dvec3(glm::vec3(exact));
}

// A ball of 16 × 16 × 6 × 2 triangles on a grid of 2⁻²⁰, so that midpoints of edges are exact. `slits` of them, at edges inside it,
// have a third vertex on an edge with a degenerate triangle between them and their neighbour: the result of cleaning up a scan.
Level ballWith(int slits)
{
	Maker ball;
	for (int face = 0; face < 6; ++face)
	{
		const double sign = face < 3 ? 1.0 : -1.0;
		const auto at = [&](int u, int v)
		{
			glm::dvec3 p(0.0);
			p[face % 3] = sign;
			p[(face + 1) % 3] = u / 8.0 - 1.0;
			p[(face + 2) % 3] = sign * (v / 8.0 - 1.0);
			p *= 0x1p20 / glm::length(p);
			return addVertex(ball.level, glm::dvec3(std::round(p.x), std::round(p.y), std::round(p.z)) * 0x1p-20);
		};
		for (int i = 0; i < 256; ++i)
		{
			const uint32_t a = at(i % 16, i / 16);
			const uint32_t b = at(i % 16 + 1, i / 16);
			const uint32_t c = at(i % 16 + 1, i / 16 + 1);
			const uint32_t d = at(i % 16, i / 16 + 1);
			addTriangle(ball.level, a, b, c);
			if (slits > 0 && i % 3 == 0)
			{
				slits -= 1;
				const uint32_t middle = addVertex(ball.level, 0.5 * (ball.level.positions[a] + ball.level.positions[c]));
				addTriangle(ball.level, a, middle, d);
				addTriangle(ball.level, middle, c, d);
				addTriangle(ball.level, a, c, middle); // without area
			}
			else
			{
				addTriangle(ball.level, a, c, d);
			}
		}
	}
	return ball.level;
}

} // namespace

TEST_CASE("volume: a wall of 2, 200 and 20,000 triangles becomes the same polygon", "[volume][occluders]")
{
	const int count = GENERATE(1, 10, 100);
	Maker maker;
	maker.grid(count, tilted, everywhere);
	REQUIRE(maker.level.triangles.size() == static_cast<std::size_t>(2 * count * count));
	const Occluding merged = occluders(maker.level);
	REQUIRE(merged.occluders.polygons.size() == 1);
	REQUIRE(merged.occluders.polygons[0].corner_count == 4);
	REQUIRE(merged.counts.regions == 1);
	Maker single;
	single.grid(1, tilted, everywhere);
	REQUIRE(listed(merged.occluders) == listed(occluders(single.level).occluders));
}

TEST_CASE("volume: walls with windows become the same polygons from any tessellation", "[volume][occluders]")
{
	// Windows of 2/8 × 2/8 and a door down to the edge; two windows that touch at a corner.
	const auto solid = [](double x, double y)
	{
		const auto within = [&](double left, double low, double right, double high)
		{
			return x > left / 8 && x < right / 8 && y > low / 8 && y < high / 8;
		};
		return !within(1, 5, 3, 7) && !within(3, 3, 5, 5) && !within(6, 0, 7, 4);
	};
	std::vector<std::string> first;
	for (const int count : {8, 16, 64})
	{
		Maker maker;
		maker.grid(count, tilted, solid);
		const Occluding merged = occluders(maker.level);
		requireSound(merged.occluders, 1e-4);
		REQUIRE(areaOf(merged.occluders) == Approx(areaOf(maker.level)).epsilon(1e-6));
		REQUIRE(merged.counts.fallbacks == 0);
		REQUIRE(merged.counts.regions == 1);
		REQUIRE(merged.counts.with_holes == 1);
		first = first.empty() ? listed(merged.occluders) : first;
		REQUIRE(first.size() <= 12);
		REQUIRE(listed(merged.occluders) == first);
	}
}

TEST_CASE("volume: regions that touch in corners keep their area", "[volume][occluders]")
{
	nook::Random random(3);
	for (int round = 0; round < 60; ++round)
	{
		std::array<bool, 64> kept{};
		std::generate(kept.begin(), kept.end(), [&] { return random.uniform() < 0.6; });
		kept[0] = true;
		Maker maker;
		maker.grid(8, tilted,
				   [&](double x, double y) { return kept[static_cast<std::size_t>(8 * x) + 8 * static_cast<std::size_t>(8 * y)]; });
		const Occluding merged = occluders(maker.level);
		requireSound(merged.occluders, 1e-4);
		REQUIRE(merged.counts.fallbacks == 0);
		REQUIRE(areaOf(merged.occluders) == Approx(areaOf(maker.level)).epsilon(1e-6));
		REQUIRE(merged.counts.polygons < maker.level.triangles.size() / 2);
	}
}

TEST_CASE("volume: a disk of many corners is cut to sixteen a polygon", "[volume][occluders]")
{
	Maker maker;
	const uint32_t centre = addVertex(maker.level, {0, 0, 0});
	for (int i = 0; i < 100; ++i)
	{
		const nook::SinCos at = nook::sinCosOf(2.0 * nook::kPi * i / 100.0);
		addVertex(maker.level, {at.cos, 0.0, -at.sin});
	}
	for (uint32_t i = 0; i < 100; ++i)
	{
		addTriangle(maker.level, centre, 1 + i, 1 + (i + 1) % 100);
	}
	const Occluding merged = occluders(maker.level);
	requireSound(merged.occluders, 1e-4);
	REQUIRE(merged.counts.polygons == 8);
	REQUIRE(areaOf(merged.occluders) == Approx(areaOf(maker.level)).epsilon(1e-9));
	REQUIRE(nook::frontOf(cornersOf(merged.occluders, merged.occluders.polygons[0])).y == Approx(1.0));
}

TEST_CASE("volume: duplicates go, and a triangle with its back becomes one polygon of two sides", "[volume][occluders]")
{
	Maker maker;
	const uint32_t a = addVertex(maker.level, {0, 0, 0});
	const uint32_t b = addVertex(maker.level, {1, 0, 0});
	const uint32_t c = addVertex(maker.level, {0, 1, 0});
	addTriangle(maker.level, a, b, c);
	addTriangle(maker.level, b, c, a);
	addTriangle(maker.level, addVertex(maker.level, {0, 1, 0}), b, a); // another vertex at the same place
	const nook::Sides sides = GENERATE(nook::Sides::automatic, nook::Sides::oriented);
	nook::OccluderSettings settings{.sides = sides};
	const Occluding merged = occluders(maker.level, settings);
	REQUIRE(merged.counts.polygons == 1);
	REQUIRE(merged.counts.duplicates == 1);
	REQUIRE(merged.counts.reversed == 1);
	REQUIRE(merged.occluders.polygons[0].two_sided);
}

TEST_CASE("volume: closed surfaces are oriented; sheets, rooms and masks have two sides", "[volume][occluders]")
{
	const auto twoSided = [](const Level& level, nook::Sides sides = nook::Sides::automatic)
	{
		nook::OccluderSettings settings{.sides = sides};
		return occluders(level, settings).counts.two_sided;
	};
	Maker box;
	box.box({0, 0, 0}, {1, 2, 3});
	REQUIRE(occluders(box.level).counts.polygons == 6);
	REQUIRE(occluders(box.level).counts.closed == 1);
	REQUIRE(twoSided(box.level) == 0);
	REQUIRE(twoSided(box.level, nook::Sides::two_sided) == 6);
	Maker room;
	room.box({0, 0, 0}, {1, 2, 3}, true);
	REQUIRE(twoSided(room.level) == 6);
	REQUIRE(twoSided(room.level, nook::Sides::oriented) == 0);
	Maker touching; // the shared face and its back are merged
	touching.box({0, 0, 0}, {1, 1, 1});
	touching.box({1, 0, 0}, {2, 1, 1});
	REQUIRE(occluders(touching.level).counts.closed == 1);
	REQUIRE(twoSided(touching.level) == 1);
	Maker open;
	open.box({0, 0, 0}, {1, 2, 3});
	open.level.triangles.pop_back();
	open.level.materials.pop_back();
	REQUIRE(twoSided(open.level) == 6);
	Maker ball; // then without a few triangles: small holes
	ball.box({0, 0, 0}, {1, 1, 1});
	ball.level.triangles.clear();
	ball.level.materials.clear();
	for (int face = 0; face < 6; ++face)
	{
		ball.grid(
			16, // a power of two, so that both halves are equal

			[&](double u, double v)
			{
				const double sign = face < 3 ? 1.0 : -1.0;
				glm::dvec3 at(0.0);
				at[face % 3] = sign;
				at[(face + 1) % 3] = 2.0 * u - 1.0;
				at[(face + 2) % 3] = sign * (2.0 * v - 1.0);
				return at;
			},
			everywhere);
	}
	REQUIRE(occluders(ball.level).counts.closed == 1);
	ball.level.triangles.resize(ball.level.triangles.size() - 3);
	ball.level.materials.resize(ball.level.triangles.size());
	REQUIRE(occluders(ball.level).counts.closed == 1);
	REQUIRE(twoSided(ball.level) == 0);
	const Occluding exact = occluders(ball.level, {.holes = 0.0});
	REQUIRE(exact.counts.closed == 0);
	REQUIRE(exact.counts.two_sided == exact.counts.polygons);
	Maker glass;
	glass.box({0, 0, 0}, {1, 2, 3});
	glass.level.material_list[0].alpha_mode = nook::AlphaMode::mask;
	REQUIRE(twoSided(glass.level) == 6);
}

TEST_CASE("volume: triangles without area change nothing about a closed scan's sides, there or dropped", "[volume][occluders]")
{
	const Level whole = ballWith(0);
	REQUIRE(occluders(whole).counts.closed == 1);
	REQUIRE(occluders(whole).counts.two_sided == 0);
	const bool cleaned = GENERATE(false, true);
	Level level = ballWith(80);
	if (cleaned)
	{
		for (std::size_t i = level.triangles.size(); i-- > 0;)
		{
			const glm::uvec3& t = level.triangles[i];
			const std::vector<glm::dvec3>& p = level.positions;
			if (glm::length(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x])) == 0.0)
			{
				level.triangles.erase(level.triangles.begin() + static_cast<std::ptrdiff_t>(i));
				level.materials.erase(level.materials.begin() + static_cast<std::ptrdiff_t>(i));
			}
		}
		REQUIRE(level.triangles.size() == whole.triangles.size() + 80);
	}
	const Occluding made = occluders(level);
	CHECK(made.counts.components == 1);
	CHECK(made.counts.closed == 1);
	CHECK(made.counts.two_sided == 0);
	CHECK(made.counts.thin == (cleaned ? 0U : 80U));
	CHECK(areaOf(made.occluders) == Approx(areaOf(whole)).epsilon(1e-6));
	// Equal volumes, except that some are halved.
	nook::VolumeSet set;
	set.distance_m = 0.5;
	set.exact_bounds = true;
	nook::VolumeSet expected = set;
	set.occluders = made.occluders;
	expected.occluders = occluders(whole).occluders;
	const nook::VolumeEvaluator of_set(set, kRun);
	const nook::VolumeEvaluator of_whole(expected, kRun);
	nook::Random random(8);
	for (int i = 0; i < 500; ++i)
	{
		const glm::dvec3 way = glm::normalize(glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 0.5);
		for (const double radius : {0.9, 1.05, 1.3})
		{
			const double sum = of_whole.occlusion(radius * way, -way);
			REQUIRE(of_set.occlusion(radius * way, -way) == Approx(sum).margin(0.01));
		}
	}
}

TEST_CASE("volume: what an open line bounds: slits nothing, a square's hole its area, loops at one corner their sum",
		  "[volume][occluders]")
{
	const std::vector<glm::dvec3> p{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 0, 0}, {-1, 0, 0}, {-1, -1, 0}};
	const auto areaWithin = [&](std::vector<nook::detail::OpenEdge> edges)
	{
		std::vector<double> holes(8, 0.0);
		nook::detail::addHoles(edges, p, holes);
		CHECK(std::count(holes.begin(), holes.end(), 0.0) >= 7);
		return 0.5 * holes[3];
	};
	CHECK(areaWithin({{3, 0, 4}, {3, 4, 1}, {3, 1, 0}}) == 0.0);
	const double square = 16.0 / nook::kPi; // bounded by its length of 8; the cone has 4
	CHECK(areaWithin({{3, 0, 1}, {3, 1, 2}, {3, 2, 3}, {3, 3, 0}}) == Approx(std::min(square, 4.0)));
	CHECK(areaWithin({{3, 0, 1}, {3, 1, 2}, {3, 0, 5}, {3, 2, 3}, {3, 5, 6}, {3, 3, 0}, {3, 6, 0}}) == Approx(4.5));
	CHECK(areaWithin({{3, 0, 1}, {3, 1, 2}}) == Approx(2.0)); // not closed
	CHECK(areaWithin({}) == 0.0);
}

TEST_CASE("volume: what is not in one plane is not merged", "[volume][occluders]")
{
	for (const double bend_m : {5e-5, 2.5e-3}) // with a flatness of 1e-4 m
	{
		Maker maker;
		maker.grid(
			2, [&](double u, double v) { return glm::dvec3(u, v, u == 0.5 ? bend_m : 0.0); }, everywhere);
		nook::OccluderSettings settings{.sides = nook::Sides::oriented};
		REQUIRE(occluders(maker.level, settings).counts.polygons == (bend_m < 1e-4 ? 1U : 2U));
	}
	Maker maker; // a fine sphere: neighbours are nearly coplanar, distant ones are not
	maker.grid(
		200,
		[](double u, double v)
		{
			const nook::SinCos around = nook::sinCosOf(2.0 * u);
			const nook::SinCos up = nook::sinCosOf(2.0 * v - 1.0);
			return glm::dvec3(around.cos * up.cos, up.sin, around.sin * up.cos);
		},
		everywhere);
	nook::OccluderSettings settings{.distance_m = 10.0};
	const Occluding merged = occluders(maker.level, settings);
	requireSound(merged.occluders, 1e-3);
	REQUIRE(merged.counts.polygons > 100);
	REQUIRE(merged.counts.polygons < 20000);
	for (const glm::dvec3 corner : merged.occluders.corners)
	{
		REQUIRE(glm::length(corner) == Approx(1.0).epsilon(1e-9));
	}
	REQUIRE(areaOf(merged.occluders) == Approx(areaOf(maker.level)).epsilon(2e-3));
}

TEST_CASE("volume: a masked polygon's alpha is that of its own part of the texture", "[volume][occluders]")
{
	Maker maker;
	nook::Material& material = maker.level.material_list[0];
	material.alpha_mode = nook::AlphaMode::mask;
	material.mask = 0;
	nook::Mask mask;
	mask.width_px = 64;
	mask.height_px = 64;
	for (int i = 0; i < 64 * 64; ++i) // left quarter clear, then a quarter disk that grows to the right edge
	{
		mask.alpha.push_back(i % 64 < 16 ? 0 : 255);
	}
	maker.level.masks.push_back(mask);
	const auto plain = [](double u, double v)
	{
		return glm::dvec3(u, v, 0.0);
	};
	maker.grid(4, plain, everywhere);
	const Occluding whole = occluders(maker.level);
	REQUIRE(whole.counts.polygons == 1); // one texture mapping: merged
	REQUIRE(whole.occluders.polygons[0].alpha == Approx(0.75).margin(0.005));
	nook::OccluderSettings gaps{.gap_halvings = 4};
	const Occluding merged = occluders(maker.level, gaps);
	REQUIRE(merged.counts.uncut == merged.counts.polygons);
	double solid = 0.0;
	for (const nook::Occluder& polygon : merged.occluders.polygons)
	{
		REQUIRE((polygon.alpha < 0.05F || polygon.alpha > 0.95F));
		solid += polygon.alpha * 0.5 * glm::length(nook::areaVector(merged.occluders.cornersOf(polygon)));
	}
	REQUIRE(solid == Approx(0.75 * areaOf(maker.level)).epsilon(0.01));
	for (std::size_t i = 0; i < maker.level.masks[0].alpha.size(); ++i) // a net: no part differs from the whole
	{
		maker.level.masks[0].alpha[i] = (i + i / 64) % 2 == 0 ? 0 : 255;
	}
	const Occluding net = occluders(maker.level, gaps);
	REQUIRE(net.counts.polygons == 1);
	REQUIRE(net.occluders.polygons[0].alpha == Approx(0.5).margin(0.02));
	maker.level.masks[0] = mask;
	nook::OccluderSettings single{.merge = false};
	const Occluding cut = occluders(maker.level, single); // the column from 0 to 1/4 is gone, except for the line with mixed alpha
	REQUIRE(cut.counts.polygons + cut.counts.clear == 32);
	REQUIRE(cut.counts.clear + static_cast<uint64_t>(std::count_if(cut.occluders.polygons.begin(), cut.occluders.polygons.end(),
																   [](const nook::Occluder& p) { return p.alpha < 0.05F; })) ==
			8);
	REQUIRE(std::count_if(cut.occluders.polygons.begin(), cut.occluders.polygons.end(),
						  [](const nook::Occluder& p) { return p.alpha > 0.95F; }) == 24);
	for (glm::vec2& uv : maker.level.uvs) // the mapping is discontinuous between the columns
	{
		uv.x = uv.x > 0.5F ? 2.0F * uv.x : uv.x;
	}
	REQUIRE(occluders(maker.level).counts.polygons > 1);
}

TEST_CASE("volume: coverage agrees with a dense count", "[volume][occluders]")
{
	const Level level = nook::builtinLevel("foliage");
	double square = 0.0;
	double worst = 0.0;
	int count = 0;
	for (std::size_t i = 0; i < level.triangles.size(); i += 97)
	{
		const nook::Material& material = level.material_list[level.materials[i]];
		if (material.alpha_mode == nook::AlphaMode::opaque)
		{
			continue;
		}
		const glm::uvec3& t = level.triangles[i];
		const std::array<glm::dvec2, 3> uvs{glm::dvec2(level.uvs[t.x]), glm::dvec2(level.uvs[t.y]), glm::dvec2(level.uvs[t.z])};
		int solid = 0;
		constexpr int kSide = 150;
		for (int j = 0; j < kSide * kSide; ++j)
		{
			double x = (j % kSide + 0.5) / kSide;
			double y = (j / kSide + 0.5) / kSide;
			if (x + y > 1.0)
			{
				x = 1.0 - x;
				y = 1.0 - y;
			}
			solid += nook::isSolidAt(level, material, uvs[0] + x * (uvs[1] - uvs[0]) + y * (uvs[2] - uvs[0])) ? 1 : 0;
		}
		const double error = nook::detail::coverageOf(level, material, uvs) - static_cast<double>(solid) / (kSide * kSide);
		square += error * error;
		worst = std::max(worst, std::fabs(error));
		count += 1;
	}
	REQUIRE(count > 20);
	INFO("worst " << worst << ", root of mean square " << std::sqrt(square / count) << ", triangles " << count);
	CHECK(worst < 0.02);
	CHECK(std::sqrt(square / count) < 0.005);
}

TEST_CASE("volume: built-in levels keep their area, on any number of threads", "[volume][occluders]")
{
	const auto name =
		GENERATE(as<std::string>{}, "cornell", "courtyard", "suburb", "foliage", "heightfield:20000", "cave:20000", "nulls");
	INFO(name);
	const Level level = nook::builtinLevel(name);
	const Occluding merged = occluders(level);
	requireSound(merged.occluders, 1e-4);
	REQUIRE(merged.counts.fallbacks == 0);
	REQUIRE(merged.counts.clear == 0);
	REQUIRE(areaOf(merged.occluders) == Approx(areaOf(level)).epsilon(1e-6));
	REQUIRE(merged.counts.polygons < merged.counts.triangles);
	const Occluding cut = nook::occludersOf(level, {}, kRun);
	requireSound(cut.occluders, 1e-4);
	REQUIRE(areaOf(cut.occluders) == Approx(areaOf(level)).epsilon(1e-6));
	nook::OccluderSettings settings{.extent = 0.0};
	const Occluding alone = nook::occludersOf(level, settings, {1, {}});
	REQUIRE(alone.occluders.corners == merged.occluders.corners);
	REQUIRE(std::equal(alone.occluders.polygons.begin(), alone.occluders.polygons.end(), merged.occluders.polygons.begin(),
					   merged.occluders.polygons.end(),
					   [](const nook::Occluder& a, const nook::Occluder& b)
					   { return a.alpha == b.alpha && a.first_corner == b.first_corner && a.two_sided == b.two_sided; }));
}

TEST_CASE("volume: without merging there is one polygon a triangle", "[volume][occluders]")
{
	const Level level = nook::builtinLevel("cornell");
	nook::OccluderSettings settings{.merge = false};
	const Occluding single = occluders(level, settings);
	REQUIRE(single.counts.polygons == level.triangles.size());
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		REQUIRE(single.occluders.polygons[i].triangle == i);
	}
}

TEST_CASE("volume: proxies have fewer triangles, stay closed, and move little", "[volume][occluders]")
{
	const Level level = nook::builtinLevel("courtyard");
	nook::OccluderSettings settings;
	const nook::OccluderCounts whole = occluders(level, settings).counts;
	settings.detail = 0.02;
	const Occluding simpler = occluders(level, settings);
	requireSound(simpler.occluders, 1e-4);
	REQUIRE(simpler.counts.proxies < whole.triangles / 2);
	REQUIRE(4 * simpler.counts.polygons < 3 * whole.polygons);
	REQUIRE(simpler.counts.deviation_m > 0.0);
	REQUIRE(simpler.counts.deviation_m <= 0.0201);
	REQUIRE(simpler.counts.closed == simpler.counts.components); // as before: nothing opened
	REQUIRE(whole.closed == whole.components);
	REQUIRE(areaOf(simpler.occluders) == Approx(areaOf(level)).epsilon(0.03));
}

TEST_CASE("volume: a closed surface is simplified unless its backs are known to be seen", "[volume][occluders]")
{
	Level level = emptyLevel();
	addSphere(level, {0.0, 0.0, 0.0}, 1.0, 40, 60);
	nook::OccluderSettings settings;
	settings.detail = 0.02;
	REQUIRE(occluders(level, settings).counts.proxies < level.triangles.size() / 2);
	const uint8_t is_idle = GENERATE(uint8_t{0}, uint8_t{1});
	settings.one_sided.assign(level.triangles.size(), is_idle);
	const nook::OccluderCounts counts = occluders(level, settings).counts;
	REQUIRE((counts.proxies == level.triangles.size()) == (is_idle == 0));
	REQUIRE(counts.two_sided == 0);
}

TEST_CASE("volume: long polygons are cut, whatever their tessellation", "[volume][occluders]")
{
	std::vector<std::string> first;
	for (const int count : {1, 10, 100})
	{
		Maker maker;
		maker.grid(count, tilted, everywhere); // 8 m × 4 m
		for (int i = 0; i < 40; ++i)           // small ones: cutting may add a quarter to the total
		{
			maker.box({i, 10, 0}, {i + 0.5, 11, 1});
		}
		const Occluding cut = nook::occludersOf(maker.level, {}, kRun);
		requireSound(cut.occluders, 1e-4);
		REQUIRE(cut.counts.uncut == 241);
		REQUIRE(cut.counts.extent_m == 2.0);
		REQUIRE(areaOf(cut.occluders) == Approx(32.0 + 40 * 4.0).epsilon(1e-6));
		REQUIRE(cut.counts.polygons >= 240 + 8); // of at most 2 m × 2 m
		REQUIRE(cut.counts.polygons <= 240 + 32);
		first = first.empty() ? listed(cut.occluders) : first;
		REQUIRE(listed(cut.occluders) == first);
	}
	nook::Random random(4);
	for (int round = 0; round < 200; ++round)
	{
		const double thin = nook::powOf(10.0, -4.0 * random.uniform());
		std::vector<glm::dvec3> corners;
		for (int i = 0; i < 3 + round % 14; ++i)
		{
			const nook::SinCos at = nook::sinCosOf(2.0 * nook::kPi * (i + 0.9 * random.uniform()) / (3 + round % 14));
			corners.push_back(glm::dvec3(1e5, -3e4, 2e4) + at.cos * glm::dvec3(6.0, 0.0, 8.0) +
							  at.sin * thin * glm::dvec3(0, 5, 0));
		}
		double area = 0.0;
		for (const std::vector<glm::dvec3>& piece : nook::detail::halvedPolygon(corners, 1.5, 5))
		{
			REQUIRE((piece.size() >= 3 && piece.size() <= 5));
			for (const glm::dvec3 corner : piece)
			{
				REQUIRE(glm::distance(corner, piece[0]) <= 1.5 * 1.42);
			}
			area += 0.5 * glm::length(doubleAreaOf(piece));
		}
		REQUIRE(area == Approx(0.5 * glm::length(doubleAreaOf(corners))).epsilon(1e-5));
	}
}

TEST_CASE("volume: a surface that overlaps itself keeps all of its area", "[volume][occluders]")
{
	Maker maker; // a flat ring of one and a half turns
	for (int i = 0; i <= 30; ++i)
	{
		const nook::SinCos at = nook::sinCosOf(3.0 * nook::kPi * i / 30.0);
		addVertex(maker.level, {at.cos, at.sin, 0.0});
		addVertex(maker.level, {2.0 * at.cos, 2.0 * at.sin, 0.0});
	}
	for (uint32_t i = 0; i < 30; ++i)
	{
		addTriangle(maker.level, 2 * i, 2 * i + 1, 2 * i + 2);
		addTriangle(maker.level, 2 * i + 2, 2 * i + 1, 2 * i + 3);
	}
	const Occluding merged = occluders(maker.level);
	requireSound(merged.occluders, 1e-4);
	REQUIRE(merged.counts.regions == 1);
	REQUIRE(merged.counts.fallbacks == 1);
	REQUIRE(merged.counts.polygons <= 30);
	REQUIRE(areaOf(merged.occluders) == Approx(areaOf(maker.level)).epsilon(1e-9));
}

TEST_CASE("volume: lines that cross are not cut into pieces", "[volume][occluders]")
{
	const std::vector<std::vector<glm::dvec2>> crossed{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}};
	REQUIRE(nook::detail::convexPieces(crossed, 16).empty());
	const std::vector<std::vector<glm::dvec2>> line{{{0, 0}, {1, 1}, {2, 2}}};
	REQUIRE(nook::detail::convexPieces(line, 16).empty());
	REQUIRE_FALSE(nook::detail::isConvex(crossed[0]));
	// A pentagram turns left everywhere but winds twice.
	std::vector<glm::dvec2> star;
	for (int i = 0; i < 5; ++i)
	{
		const nook::SinCos at = nook::sinCosOf(2.0 * nook::kPi * 2.0 * i / 5.0);
		star.emplace_back(at.cos, at.sin);
	}
	REQUIRE_FALSE(nook::detail::isConvex(star));
}
