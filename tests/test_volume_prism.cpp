// SPDX-License-Identifier: GPL-3.0-or-later
// The closed volume around a polygon: outward, convex, and covering all points with a falloff above 0 in AOV eq. 5.
#include "core/math.h"
#include "core/random.h"
#include "volume/prism.h"

#include <catch2/catch.hpp>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{

using Corners = std::vector<glm::dvec3>;

// Convex, in a random plane: corners on an ellipse at random angles.
Corners randomPolygon(nook::Random& random, std::size_t count, double width, double height, glm::dvec3 centre)
{
	glm::dvec3 normal(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
	normal = glm::normalize(normal);
	const glm::dvec3 side =
		glm::normalize(glm::cross(normal, std::fabs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
	const glm::dvec3 up = glm::cross(normal, side);
	std::vector<double> angles;
	for (std::size_t i = 0; i < count; ++i)
	{
		angles.push_back(2.0 * nook::kPi * (static_cast<double>(i) + 0.9 * random.uniform()) / static_cast<double>(count));
	}
	Corners corners;
	for (const double angle : angles)
	{
		const nook::SinCos at = nook::sinCosOf(angle);
		corners.push_back(centre + side * (width * at.cos) + up * (height * at.sin));
	}
	return corners;
}

// AOV eq. 5 without ᾱ, and for two-sided polygons by |height|: a straightforward reference.
double falloff(const Corners& corners, const nook::VolumeShape& shape, glm::dvec3 x)
{
	const glm::dvec3 front = nook::frontOf(corners);
	double g = 1.0;
	for (std::size_t i = 0; i < corners.size(); ++i)
	{
		const glm::dvec3 inward = glm::normalize(glm::cross(front, corners[(i + 1) % corners.size()] - corners[i]));
		const double side = glm::dot(x - corners[i], inward);
		g *= side <= -shape.distance_m * shape.side_share ? 0.0 : std::clamp(side / shape.distance_m + 1.0, 0.0, 1.0);
	}
	const double height = glm::dot(x - corners[0], front);
	if (height < 0.0 && !shape.two_sided)
	{
		return 0.0;
	}
	return g * std::clamp(1.0 - std::fabs(height) / shape.distance_m, 0.0, 1.0);
}

struct Face
{
	std::vector<std::size_t> at;
};

std::vector<Face> facesOf(std::size_t count)
{
	Face low;
	Face high;
	std::vector<Face> faces;
	for (std::size_t i = 0; i < count; ++i)
	{
		const std::size_t next = (i + 1) % count;
		low.at.insert(low.at.begin(), i);
		high.at.push_back(count + i);
		faces.push_back({{i, next, count + next, count + i}});
	}
	faces.push_back(low);
	faces.push_back(high);
	return faces;
}

// The greatest height of a point above a face, metres: ≤ 0 inside.
double outsideOf(const std::vector<glm::dvec3>& points, glm::dvec3 x)
{
	double most = -1e300;
	for (const Face& face : facesOf(points.size() / 2))
	{
		Corners corners;
		for (const std::size_t at : face.at)
		{
			corners.push_back(points[at]);
		}
		most = std::max(most, glm::dot(x - corners[0], nook::frontOf(corners)));
	}
	return most;
}

std::vector<glm::dvec3> prism(const Corners& corners, const nook::VolumeShape& shape)
{
	std::vector<glm::dvec3> points(2 * corners.size());
	nook::prismOf(corners, nook::frontOf(corners), shape, points);
	return points;
}

void requireSound(const Corners& corners, const std::vector<glm::dvec3>& points, double scale)
{
	double volume = 0.0;
	for (const Face& face : facesOf(corners.size()))
	{
		Corners ring;
		for (const std::size_t at : face.at)
		{
			ring.push_back(points[at] - corners[0]);
		}
		REQUIRE(glm::length(nook::frontOf(ring)) > 0.5); // not degenerate
		for (std::size_t i = 1; i + 1 < ring.size(); ++i)
		{
			volume += glm::dot(ring[0], glm::cross(ring[i], ring[i + 1])) / 6.0;
		}
	}
	REQUIRE(volume > 0.0);
	for (const glm::dvec3 point : points) // convex with outward faces: no corner is above any face
	{
		REQUIRE(outsideOf(points, point) <= 1e-9 * scale);
	}
	for (const glm::dvec3 corner : corners)
	{
		REQUIRE(outsideOf(points, corner) <= 1e-9 * scale);
	}
}

} // namespace

TEST_CASE("volume: a square's prism is the square moved outward by the distance", "[volume][prism]")
{
	const Corners square{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
	REQUIRE(nook::frontOf(square) == glm::dvec3(0, 0, 1));
	for (const bool two_sided : {false, true})
	{
		const std::vector<glm::dvec3> points = prism(square, {0.5, two_sided, false});
		REQUIRE(glm::distance(points[0], {-0.5, -0.5, two_sided ? -0.5 : 0.0}) < 1e-15);
		REQUIRE(glm::distance(points[6], {2.5, 2.5, 0.5}) < 1e-15);
	}
}

TEST_CASE("volume: collinear neighbours move straight outward", "[volume][prism]")
{
	const Corners corners{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}};
	for (const bool exact : {false, true})
	{
		REQUIRE(glm::distance(prism(corners, {0.25, false, exact})[1], {1.0, -0.25, 0.0}) < 1e-15);
	}
}

TEST_CASE("volume: the clamp takes corners below 60 degrees to twice the distance, no other", "[volume][prism]")
{
	for (const double half_deg : {1e-5, 1.0, 20.0, 29.9, 30.1, 60.0, 80.0})
	{
		const nook::SinCos half = nook::sinCosOf(half_deg * nook::kPi / 180.0);
		const Corners corners{{0, 0, 0}, {half.cos, -half.sin, 0}, {half.cos, half.sin, 0}};
		const double moved = glm::distance(prism(corners, {1.0, false, false})[0], corners[0]);
		REQUIRE(moved == Approx(std::min(2.0, 1.0 / half.sin)).epsilon(1e-9));
		const double whole = glm::distance(prism(corners, {1.0, false, true})[0], corners[0]);
		REQUIRE(whole == Approx(std::min(256.0, 1.0 / half.sin)).epsilon(1e-9));
	}
}

TEST_CASE("volume: prisms are closed, convex and outward, from needles of 1e-7 to sixteen corners", "[volume][prism]")
{
	nook::Random random(7);
	for (int round = 0; round < 3000; ++round)
	{
		const std::size_t count = 3 + static_cast<std::size_t>(round) % 14;
		const double width = nook::powOf(10.0, -4.0 + 7.0 * random.uniform());
		const double thin = nook::powOf(10.0, -7.0 * random.uniform());
		const Corners corners = randomPolygon(random, count, width, width * thin, {});
		const nook::VolumeShape shape{nook::powOf(10.0, -1.0 + 2.0 * random.uniform()), round % 2 == 0, round % 3 == 0,
									  round % 5 == 0 ? 0.25 : 1.0};
		const std::vector<glm::dvec3> points = prism(corners, shape);
		requireSound(corners, points, (shape.exact_bounds ? 100.0 : 1.0) * (width + shape.distance_m));
	}
}

TEST_CASE("volume: with exact bounds no point with a falloff lies outside", "[volume][prism]")
{
	nook::Random random(8);
	for (int round = 0; round < 400; ++round)
	{
		const double width = nook::powOf(10.0, -2.0 + 4.0 * random.uniform());
		const double thin = nook::powOf(10.0, -1.5 * random.uniform());
		const Corners corners = randomPolygon(random, 3 + static_cast<std::size_t>(round) % 6, width, width * thin, {});
		const nook::VolumeShape shape{1.0, round % 2 == 0, true, round % 3 == 0 ? 0.375 : 1.0};
		const std::vector<glm::dvec3> points = prism(corners, shape);
		for (const glm::dvec3 point : points) // also beyond needle tips: towards and past every corner
		{
			for (int i = 0; i < 100; ++i)
			{
				const glm::dvec3 offset(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
				const glm::dvec3 x = point * (1.2 * random.uniform()) + offset * 3.0;
				if (falloff(corners, shape, x) > 0.0)
				{
					REQUIRE(outsideOf(points, x) <= 1e-9 * (width + 1.0));
				}
			}
		}
	}
}

TEST_CASE("volume: with exact bounds needles lose less than 1/8192 of occlusion", "[volume][prism]")
{
	// The mitre of a corner of 1e-7 is 2e7 times the distance; it is cut. Points outside then receive at most g times the form
	// factor of a receiver that faces every part of the needle: the sum of area · height / (π r³).
	nook::Random random(9);
	int outside = 0;
	for (int round = 0; round < 300; ++round)
	{
		const double half = nook::powOf(10.0, -7.0 + 6.0 * random.uniform());
		const double length = nook::powOf(10.0, -1.0 + 4.0 * random.uniform());
		const Corners corners{{0, 0, 0}, {length, -length * half, 0}, {length, length * half, 0}};
		const nook::VolumeShape shape{1.0, false, true};
		const std::vector<glm::dvec3> points = prism(corners, shape);
		for (int i = 0; i < 300; ++i)
		{
			const glm::dvec3 x(length * (1.2 - 4.0 * random.uniform()), 4.0 * random.uniform() - 2.0, random.uniform());
			const double g = falloff(corners, shape, x);
			if (g == 0.0 || outsideOf(points, x) <= 1e-9)
			{
				continue;
			}
			outside += 1;
			double factor = 0.0; // for the receiver that sees most of it: cos ≤ 1
			constexpr int kParts = 2000;
			for (int part = 0; part < kParts; ++part)
			{
				const double at = length * (part + 0.5) / kParts;
				const double area = 2.0 * at * half * length / kParts;
				const glm::dvec3 offset = glm::dvec3(at, 0.0, 0.0) - x;
				const double square = glm::dot(offset, offset);
				factor += area * std::fabs(offset.z) / (nook::kPi * square * std::sqrt(square));
			}
			REQUIRE(g * factor < 1.0 / 8192.0);
		}
	}
	REQUIRE(outside > 20);
}
