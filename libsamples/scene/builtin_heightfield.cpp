// SPDX-License-Identifier: GPL-3.0-or-later
// Hills with ridges, 512 m wide, on a regular grid, with sides and an underside, so that it is a solid.
// This work is based on: K. Perlin, "Improving Noise", 2002 (gradients at lattice points, smoothly interpolated); F. K. Musgrave,
// C. E. Kolb, R. S. Mace, "The Synthesis and Rendering of Eroded Fractal Terrains", 1989 (octaves attenuated by earlier ones).
#include "scene/builtin_levels.h"
#include "scene/builtin_shapes.h"

#include "core/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace nook
{
namespace
{

constexpr double kWidth = 512.0;
constexpr double kBottom = -60.0;

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
	const auto fade = [](double t)
	{
		return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
	};
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
	// Broad hills and valleys, then ridges: 1 − |noise| is sharp where the noise changes sign; each octave is weighted by the
	// previous one.
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
		struct Step
		{
			int x;
			int z;
		};
		static constexpr Step kAround[7] = {{1, 0}, {0, -1}, {-1, -1}, {-1, 0},
											{0, 1}, {1, 1},  {1, 0}}; // counter-clockwise from above
		const auto isThere = [this, x, z](Step step)
		{
			const auto within = [this](std::size_t at, int by)
			{
				return by < 0 ? at > 0 : by == 0 || at < m_cells;
			};
			return within(x, step.x) && within(z, step.z);
		};
		const auto edge = [this, x, z](Step step)
		{
			const auto moved = [](std::size_t at, int by)
			{
				return by < 0 ? at - 1 : at + static_cast<std::size_t>(by);
			};
			return position(moved(x, step.x), moved(z, step.z)) - position(x, z);
		};
		glm::dvec3 sum(0.0);
		for (int i = 0; i < 6; ++i)
		{
			if (isThere(kAround[i]) && isThere(kAround[i + 1]))
			{
				sum += glm::cross(edge(kAround[i]), edge(kAround[i + 1]));
			}
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
	for (std::size_t i = 0; i < cells; ++i)
	{
		rim.push_back(grid.position(0, i));
	}
	for (std::size_t i = 0; i < cells; ++i)
	{
		rim.push_back(grid.position(i, cells));
	}
	for (std::size_t i = cells; i > 0; --i)
	{
		rim.push_back(grid.position(cells, i));
	}
	for (std::size_t i = cells; i > 0; --i)
	{
		rim.push_back(grid.position(i, 0));
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
	builder.reserve((cells + 1) * (cells + 1) + 24 * cells + 1, 2 * cells * cells + 12 * cells);
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

} // namespace nook
