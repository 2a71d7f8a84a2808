// SPDX-License-Identifier: GPL-3.0-or-later
// A tunnel of 60 m through a rock, with halls and narrow passages: as dense and as uneven as a scan. One closed surface: the wall,
// out at one mouth, along the outside of the rock and in at the other mouth. This work is based on: K. Perlin, "Improving Noise",
// 2002 (gradients at lattice points, smoothly interpolated).
#include "scene/builtin_levels.h"
#include "scene/builtin_shapes.h"

#include "core/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace nook
{
namespace
{

constexpr double kTunnelHalf = 30.0;  // m
constexpr double kTunnelRadius = 3.4; // mean radius of the tunnel, m
constexpr double kRockRadius = 11.0;  // mean radius of the rock, m
constexpr double kSediment = 1.5;     // below the centre, m

// One of the twelve edge directions of a cube at a lattice point, chosen by a 32-bit integer hash.
glm::dvec3 gradientAt(std::array<int, 3> at, uint32_t seed)
{
	uint32_t h = static_cast<uint32_t>(at[0]) * 0x8da6b343U ^ static_cast<uint32_t>(at[1]) * 0xd8163841U ^
				 static_cast<uint32_t>(at[2]) * 0xcb1ab31fU ^ seed * 0x165667b1U;
	h = (h ^ (h >> 16U)) * 0x7feb352dU;
	h = (h ^ (h >> 15U)) * 0x846ca68bU;
	h = (h >> 16U) % 12U;
	const double a = h % 2U == 0U ? 1.0 : -1.0;
	const double b = h / 2U % 2U == 0U ? 1.0 : -1.0;
	return h < 4U ? glm::dvec3(a, b, 0.0) : h < 8U ? glm::dvec3(a, 0.0, b) : glm::dvec3(0.0, a, b);
}

// Within −1 to 1, mostly within half of that.
double noiseAt(glm::dvec3 p, uint32_t seed)
{
	const glm::dvec3 cell = {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
	const glm::dvec3 f = p - cell;
	const auto fade = [](double t)
	{
		return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
	};
	const glm::dvec3 share = {fade(f.x), fade(f.y), fade(f.z)};
	double sum = 0.0;
	for (int corner = 0; corner < 8; ++corner)
	{
		const std::array<int, 3> step = {corner & 1, (corner >> 1) & 1, corner >> 2};
		const std::array<int, 3> at = {static_cast<int>(cell.x) + step[0], static_cast<int>(cell.y) + step[1],
									   static_cast<int>(cell.z) + step[2]};
		double weight = 1.0;
		for (int axis = 0; axis < 3; ++axis)
		{
			weight *= step[static_cast<std::size_t>(axis)] == 1 ? share[axis] : 1.0 - share[axis];
		}
		sum += weight * glm::dot(gradientAt(at, seed), f - glm::dvec3(step[0], step[1], step[2]));
	}
	return sum;
}

// Smooth minimum with a blend of about `width`.
double lesserOf(double a, double b, double width)
{
	return 0.5 * (a + b - std::sqrt((a - b) * (a - b) + width * width));
}

// Centre of the tunnel at x.
glm::dvec3 middleAt(double x)
{
	return {x, 1.4 * sinCosOf(x / 11.0).sin, 4.0 * sinCosOf(x / 8.0).sin};
}

// Distance from the centre, m; `way` is a unit vector orthogonal to x. Leaves out waves too short for a grid of that step.
double wallAt(double x, glm::dvec3 way, double step_m)
{
	const glm::dvec3 at = glm::dvec3(x, 0.0, 0.0) + kTunnelRadius * way;
	double radius = kTunnelRadius;
	double amplitude = 2.4;
	double length = 7.0;
	for (uint32_t octave = 0; octave < 9 && length > 4.0 * step_m; ++octave)
	{
		// Ridged from the second octave on: sharp towards the tunnel, where the noise changes sign.
		const double noise = noiseAt(at * (1.0 / length), octave);
		radius += amplitude * (octave == 0 ? noise : 1.6 * std::fabs(noise) - 0.3);
		amplitude *= 0.47;
		length *= 0.47;
	}
	// Sediment: a floor with shallow waves.
	const double down = -way.y;
	if (down > 0.05)
	{
		const double waves = step_m < 0.4 ? 0.08 * noiseAt(at * (1.0 / 1.7), 31) : 0.0;
		radius = lesserOf(radius, (kSediment + waves) / down, 0.3);
	}
	return std::max(radius, 0.7);
}

double outsideAt(double x, glm::dvec3 way)
{
	const glm::dvec3 at = glm::dvec3(x, 0.0, 0.0) + kRockRadius * way;
	return kRockRadius + 2.0 * noiseAt(at * (1.0 / 13.0), 41);
}

// A ring of the surface: its position along x, and from the wall (0) to the outside (1).
struct Station
{
	double x = 0.0;
	double out = 0.0;
};

std::vector<Station> stationsOf(std::size_t along, std::size_t mouth, std::size_t back)
{
	std::vector<Station> stations;
	const auto share = [](std::size_t i, std::size_t count)
	{
		return static_cast<double>(i) / static_cast<double>(count);
	};
	for (std::size_t i = 0; i < along; ++i)
	{
		stations.push_back({kTunnelHalf * (2.0 * share(i, along) - 1.0), 0.0});
	}
	for (std::size_t i = 0; i < mouth; ++i)
	{
		stations.push_back({kTunnelHalf, share(i, mouth)});
	}
	for (std::size_t i = 0; i < back; ++i)
	{
		stations.push_back({kTunnelHalf * (1.0 - 2.0 * share(i, back)), 1.0});
	}
	for (std::size_t i = 0; i < mouth; ++i)
	{
		stations.push_back({-kTunnelHalf, 1.0 - share(i, mouth)});
	}
	return stations;
}

// A torus of quads.
class Rings
{
public:
	Rings(std::vector<Station> stations, std::size_t around, double step_m) : m_rings(stations.size()), m_around(around)
	{
		for (const Station& station : stations)
		{
			for (std::size_t j = 0; j < around; ++j)
			{
				const SinCos turn = sinCosOf(2.0 * kPi * static_cast<double>(j) / static_cast<double>(around));
				const glm::dvec3 way(0.0, turn.cos, turn.sin);
				const double wall = station.out < 1.0 ? wallAt(station.x, way, step_m) : 0.0;
				const double outside = station.out > 0.0 ? outsideAt(station.x, way) : 0.0;
				m_points.push_back(middleAt(station.x) + way * (wall + station.out * (outside - wall)));
			}
		}
	}

	std::size_t rings() const
	{
		return m_rings;
	}

	glm::dvec3 point(std::size_t ring, std::size_t at) const
	{
		return m_points[(ring % m_rings) * m_around + at % m_around];
	}

	// Unweighted mean over the six adjacent triangles, because rings are closer in the tunnel than outside.
	glm::dvec3 normal(std::size_t ring, std::size_t at) const
	{
		const std::size_t r = ring + m_rings;
		const std::size_t a = at + m_around;
		const glm::dvec3 here = point(r, a);
		const std::array<glm::dvec3, 6> about = {point(r + 1, a), point(r + 1, a + 1), point(r, a + 1),
												 point(r - 1, a), point(r - 1, a - 1), point(r, a - 1)};
		glm::dvec3 sum(0.0);
		for (std::size_t i = 0; i < about.size(); ++i)
		{
			sum += glm::normalize(glm::cross(about[i] - here, about[(i + 1) % about.size()] - here));
		}
		return glm::normalize(sum);
	}

	void addTo(LevelBuilder& builder) const
	{
		const auto vertex = [this](std::size_t ring, std::size_t at)
		{
			return static_cast<uint32_t>((ring % m_rings) * m_around + at % m_around);
		};
		for (std::size_t ring = 0; ring < m_rings; ++ring)
		{
			for (std::size_t at = 0; at < m_around; ++at)
			{
				const glm::dvec3 p = point(ring, at);
				builder.addVertex(p, normal(ring, at), {p.x, p.z});
			}
		}
		for (std::size_t ring = 0; ring < m_rings; ++ring)
		{
			for (std::size_t at = 0; at < m_around; ++at)
			{
				builder.addQuad(vertex(ring, at), vertex(ring + 1, at), vertex(ring + 1, at + 1), vertex(ring, at + 1));
			}
		}
	}

private:
	std::size_t m_rings;
	std::size_t m_around;
	std::vector<glm::dvec3> m_points;
};

} // namespace

Level makeCave(std::size_t triangles)
{
	// The tunnel is about three times as long as its circumference; its wall has nine tenths of all rings.
	std::size_t around = 3;
	const auto rings_of = [](std::size_t columns)
	{
		return std::array<std::size_t, 3>{3 * columns, std::max<std::size_t>(1, columns / 12),
										  std::max<std::size_t>(2, columns / 6)};
	};
	const auto count_of = [&](std::size_t columns)
	{
		const auto [along, mouth, back] = rings_of(columns);
		return 2 * columns * (along + 2 * mouth + back);
	};
	while (count_of(around) < triangles)
	{
		around += 1;
	}
	const auto [along, mouth, back] = rings_of(around);
	const Rings rings(stationsOf(along, mouth, back), around, 2.0 * kTunnelHalf / static_cast<double>(along));
	LevelBuilder builder;
	builder.reserve(rings.rings() * around, 2 * rings.rings() * around);
	builder.beginMesh("rock", builder.addMaterial("rock"));
	rings.addTo(builder);
	const auto look = [&](const char* name, double from_x, double to_x, double up_m)
	{
		builder.addCamera(name, middleAt(from_x) + glm::dvec3(0.0, up_m, 0.0), middleAt(to_x));
	};
	look("main", -14.0, -4.0, 0.0);
	look("hall", 12.0, 2.0, 0.2);
	look("mouth", 44.0, 20.0, 1.0);
	return builder.finish();
}

} // namespace nook
