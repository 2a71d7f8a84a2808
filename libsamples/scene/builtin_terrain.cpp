// SPDX-License-Identifier: GPL-3.0-or-later
// Hills with ridges, 512 m wide, on a regular grid, with sides and an underside, so that it is a solid.
// This work is based on: K. Perlin, "Improving Noise", 2002 (gradients at lattice points, smoothly interpolated); F. K. Musgrave,
// C. E. Kolb, R. S. Mace, "The Synthesis and Rendering of Eroded Fractal Terrains", 1989 (octaves attenuated by earlier ones).
#include "core/math.h"
#include "scene/builtin.h"
#include "scene/builtin_shapes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace nook
{
namespace
{

constexpr double kWidth = 512.0;
constexpr double kBottom = -60.0;

// Smooth step with continuous second derivatives.
double fade(double t)
{
	return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

// One of eight gradients at a lattice point, chosen by a 32-bit integer hash.
glm::dvec2 gradientAt(int x, int y, uint32_t seed)
{
	static constexpr double kDiagonal = 0.70710678118654752;
	static constexpr glm::dvec2 kGradients[8] = {{1.0, 0.0},
												 {-1.0, 0.0},
												 {0.0, 1.0},
												 {0.0, -1.0},
												 {kDiagonal, kDiagonal},
												 {-kDiagonal, kDiagonal},
												 {kDiagonal, -kDiagonal},
												 {-kDiagonal, -kDiagonal}};
	uint32_t h = static_cast<uint32_t>(x) * 0x8da6b343U ^ static_cast<uint32_t>(y) * 0xd8163841U ^ seed * 0xcb1ab31fU;
	h = (h ^ (h >> 16U)) * 0x7feb352dU;
	h = (h ^ (h >> 15U)) * 0x846ca68bU;
	return kGradients[(h >> 16U) & 7U];
}

// About −0.7 to 0.7.
double noiseAt(glm::dvec2 p, uint32_t seed)
{
	const glm::dvec2 cell = {std::floor(p.x), std::floor(p.y)};
	const glm::dvec2 f = p - cell;
	const int x = static_cast<int>(cell.x);
	const int y = static_cast<int>(cell.y);
	const auto corner = [&](int dx, int dy)
	{
		return glm::dot(gradientAt(x + dx, y + dy, seed), f - glm::dvec2(dx, dy));
	};
	const double lower = corner(0, 0) + fade(f.x) * (corner(1, 0) - corner(0, 0));
	const double upper = corner(0, 1) + fade(f.x) * (corner(1, 1) - corner(0, 1));
	return lower + fade(f.y) * (upper - lower);
}

// Metres. Leaves out ridges too narrow for a grid of that step.
double heightAt(glm::dvec2 p, double step)
{
	// Broad hills and valleys, then ridges, sharp where the noise changes sign; each octave is weighted by the previous one.
	const double hills = 26.0 * noiseAt(p * (1.0 / 210.0), 1) + 9.0 * noiseAt(p * (1.0 / 90.0), 2);
	double ridges = 0.0;
	double weight = 1.0;
	double amplitude = 22.0;
	double frequency = 1.0 / 130.0;
	for (uint32_t octave = 0; octave < 10 && frequency * step < 0.3; ++octave)
	{
		const double crest = 1.0 - 1.6 * std::fabs(noiseAt(p * frequency, 3 + octave));
		const double sharp = crest * crest * weight;
		ridges += amplitude * sharp;
		weight = std::clamp(1.3 * sharp, 0.0, 1.0);
		amplitude *= 0.47;
		frequency *= 2.07;
	}
	return hills + ridges - 20.0;
}

class Grid
{
public:
	explicit Grid(std::size_t cells) : m_cells(cells), m_heights((cells + 1) * (cells + 1))
	{
		for (std::size_t z = 0; z <= cells; ++z)
		{
			for (std::size_t x = 0; x <= cells; ++x)
			{
				m_heights[z * (cells + 1) + x] = heightAt(planOf(x, z), kWidth / static_cast<double>(cells));
			}
		}
	}

	glm::dvec2 planOf(std::size_t x, std::size_t z) const
	{
		const double step = kWidth / static_cast<double>(m_cells);
		return {static_cast<double>(x) * step - 0.5 * kWidth, static_cast<double>(z) * step - 0.5 * kWidth};
	}

	double height(std::size_t x, std::size_t z) const
	{
		return m_heights[z * (m_cells + 1) + x];
	}

	glm::dvec3 position(std::size_t x, std::size_t z) const
	{
		const glm::dvec2 p = planOf(x, z);
		return {p.x, height(x, z), p.y};
	}

	// Area-weighted mean of the up to six adjacent triangles.
	glm::dvec3 normal(std::size_t x, std::size_t z) const
	{
		static constexpr std::array<glm::ivec2, 7> kAround{
			{{1, 0}, {0, -1}, {-1, -1}, {-1, 0}, {0, 1}, {1, 1}, {1, 0}}}; // x and z, counter-clockwise from above
		const auto edge = [this, x, z](glm::ivec2 step) -> std::optional<glm::dvec3>
		{
			const std::size_t to_x = x + static_cast<std::size_t>(step.x); // wraps around below 0
			const std::size_t to_z = z + static_cast<std::size_t>(step.y);
			return to_x > m_cells || to_z > m_cells ? std::nullopt : std::optional(position(to_x, to_z) - position(x, z));
		};
		glm::dvec3 sum(0.0);
		for (std::size_t i = 0; i < 6; ++i)
		{
			const std::optional<glm::dvec3> from = edge(kAround[i]);
			const std::optional<glm::dvec3> to = edge(kAround[i + 1]);
			sum += from && to ? glm::cross(*from, *to) : glm::dvec3(0.0);
		}
		return glm::normalize(sum);
	}

	// The highest ground within a cell of a place; above it there is air.
	double groundNear(double x, double z) const
	{
		const double step = kWidth / static_cast<double>(m_cells);
		const auto column = static_cast<std::size_t>((x + 0.5 * kWidth) / step);
		const auto row = static_cast<std::size_t>((z + 0.5 * kWidth) / step);
		double highest = kBottom;
		for (std::size_t j = row; j <= std::min(row + 1, m_cells); ++j)
		{
			for (std::size_t i = column; i <= std::min(column + 1, m_cells); ++i)
			{
				highest = std::max(highest, height(i, j));
			}
		}
		return highest;
	}

private:
	std::size_t m_cells;
	std::vector<double> m_heights;
};

void addGround(LevelBuilder& builder, const Grid& grid, std::size_t cells)
{
	for (std::size_t z = 0; z <= cells; ++z)
	{
		for (std::size_t x = 0; x <= cells; ++x)
		{
			builder.addVertex(grid.position(x, z), grid.normal(x, z), grid.planOf(x, z));
		}
	}
	const auto vertex = [cells](std::size_t x, std::size_t z)
	{
		return static_cast<uint32_t>(z * (cells + 1) + x);
	};
	for (std::size_t z = 0; z < cells; ++z)
	{
		for (std::size_t x = 0; x < cells; ++x)
		{
			builder.addQuad(vertex(x, z), vertex(x, z + 1), vertex(x + 1, z + 1), vertex(x + 1, z));
		}
	}
}

// Sides down to the bottom and a fan below, sharing corners with the ground.
void addUnderside(LevelBuilder& builder, const Grid& grid, std::size_t cells)
{
	// Around the rim, counter-clockwise from above.
	std::vector<glm::dvec3> rim;
	for (std::size_t k = 0; k < 4 * cells; ++k)
	{
		const std::size_t i = k % cells;
		const std::array<glm::dvec3, 4> sides{grid.position(0, i), grid.position(i, cells), grid.position(cells, cells - i),
											  grid.position(cells - i, 0)};
		rim.push_back(sides[k / cells]);
	}
	const uint32_t middle = builder.addVertex({0.0, kBottom, 0.0}, {0.0, -1.0, 0.0}, {0.0, 0.0});
	for (std::size_t i = 0; i < rim.size(); ++i)
	{
		const glm::dvec3 p = rim[i];
		const glm::dvec3 q = rim[(i + 1) % rim.size()];
		const glm::dvec3 p0 = {p.x, kBottom, p.z};
		const glm::dvec3 q0 = {q.x, kBottom, q.z};
		const glm::dvec3 out = glm::normalize(glm::cross(q0 - p0, glm::dvec3(0.0, 1.0, 0.0)));
		const double along = static_cast<double>(i);
		const uint32_t a = builder.addVertex(p0, out, {along, kBottom});
		const uint32_t b = builder.addVertex(q0, out, {along + 1.0, kBottom});
		const uint32_t c = builder.addVertex(q, out, {along + 1.0, q.y});
		const uint32_t d = builder.addVertex(p, out, {along, p.y});
		builder.addQuad(a, b, c, d);
		const uint32_t e = builder.addVertex(q0, {0.0, -1.0, 0.0}, {q.x, q.z});
		const uint32_t f = builder.addVertex(p0, {0.0, -1.0, 0.0}, {p.x, p.z});
		builder.addTriangle(middle, e, f);
	}
}

// A tunnel of 60 m through a rock, with halls and narrow passages: as dense and as uneven as a scan. One closed surface: the wall,
// out at one mouth, along the outside of the rock and in at the other mouth. This work is based on: K. Perlin, "Improving Noise",
// 2002 (gradients at lattice points, smoothly interpolated).

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
		const double floor = (kSediment + waves) / down;
		constexpr double kBlend = 0.3; // about the width of the smooth minimum's blend
		radius = 0.5 * (radius + floor - std::sqrt((radius - floor) * (radius - floor) + kBlend * kBlend));
	}
	return std::max(radius, 0.7);
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
	const auto addSide = [&stations](std::size_t count, const auto& stationAt)
	{
		for (std::size_t i = 0; i < count; ++i)
		{
			stations.push_back(stationAt(static_cast<double>(i) / static_cast<double>(count)));
		}
	};
	addSide(along, [](double share) { return Station{kTunnelHalf * (2.0 * share - 1.0), 0.0}; });
	addSide(mouth, [](double share) { return Station{kTunnelHalf, share}; });
	addSide(back, [](double share) { return Station{kTunnelHalf * (1.0 - 2.0 * share), 1.0}; });
	addSide(mouth, [](double share) { return Station{-kTunnelHalf, 1.0 - share}; });
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
				const glm::dvec3 rock = glm::dvec3(station.x, 0.0, 0.0) + kRockRadius * way;
				const double outside = station.out > 0.0 ? kRockRadius + 2.0 * noiseAt(rock * (1.0 / 13.0), 41) : 0.0;
				m_points.push_back(middleAt(station.x) + way * (wall + station.out * (outside - wall)));
			}
		}
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

Level makeHeightfield(std::size_t triangles)
{
	std::size_t cells = 1;
	while (2 * cells * cells < triangles)
	{
		cells += 1;
	}
	const Grid grid(cells);
	LevelBuilder builder;
	builder.beginMesh("ground", builder.addMaterial("ground"));
	addGround(builder, grid, cells);
	addUnderside(builder, grid, cells);

	const auto look = [&](const char* name, glm::dvec3 eye, glm::dvec3 target)
	{
		builder.addCamera(name, {eye.x, eye.y + grid.groundNear(eye.x, eye.z), eye.z},
						  {target.x, target.y + grid.groundNear(target.x, target.z), target.z});
	};
	look("main", {40.0, 12.0, 200.0}, {-20.0, 0.0, 20.0});
	look("valley", {-120.0, 2.0, 60.0}, {0.0, 5.0, -60.0});
	look("above", {0.0, 220.0, 250.0}, {0.0, 0.0, 0.0});
	return builder.finish();
}

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
