// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: L. Kavan, A. Bargteil, P.-P. Sloan, "Least Squares Vertex Baking", 2011: minimises the squared difference
// of samples and interpolated values over the surface, with a regulariser. Theirs is of second order; this one penalises
// differences along edges, weakly, for vertices with few samples around. Solved by conjugate gradients (M. Hestenes, E. Stiefel,
// 1952) with the diagonal as preconditioner; values beyond their bounds are then clamped while the others adapt (projected
// Gauss-Seidel: R. Cottle, J.-S. Pang, R. Stone, "The Linear Complementarity Problem", 1992). One thread, in a fixed order.
#include "bake/surface_samples.h"

#include "core/lists.h"
#include "core/random.h"
#include "scene/topology.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

namespace nook
{

namespace
{

constexpr uint32_t kNone = ~0U;
constexpr float kSameNormal = 0.999F; // cosine; 2.6° changes the direction-dependent part of visibility by about sin 2.6° = 0.045

// Adds a second value for vertices of two-sided triangles.
void addBacks(const Level& level, Unknowns& unknowns)
{
	std::vector<uint32_t> back_of(unknowns.count, kNone);
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		for (int corner = 0; level.material_list[level.materials[t]].two_sided && corner < 3; ++corner)
		{
			back_of[unknowns.of_vertex[level.triangles[t][corner]]] = 0;
		}
	}
	for (uint32_t& back : back_of)
	{
		if (back != kNone)
		{
			back = static_cast<uint32_t>(unknowns.count++);
			unknowns.has_sides = true;
		}
	}
	for (std::size_t v = 0; v < unknowns.of_vertex.size(); ++v)
	{
		const uint32_t back = back_of[unknowns.of_vertex[v]];
		unknowns.of_back[v] = back == kNone ? unknowns.of_vertex[v] : back;
	}
}

constexpr double kSmooth = 3e-3; // relative to a triangle's weight, along its edges: values without samples follow their neighbours
constexpr double kUnseenWeight = 1e-3; // below the weight of one visible sample, above rounding errors
constexpr int kMostSteps = 400;
constexpr double kSmallStep = 1e-5; // value increment; 16-bit files resolve 1.5e-5

// Symmetric positive definite: the diagonal, and the rest by rows.
struct Matrix
{
	std::vector<double> diagonal;
	std::vector<std::size_t> first; // start of each row in `column`, and the end
	std::vector<uint32_t> column;   // ascending within a row
	std::vector<double> value;

	double& at(uint32_t row, uint32_t col)
	{
		const auto begin = column.begin() + static_cast<std::ptrdiff_t>(first[row]);
		const auto end = column.begin() + static_cast<std::ptrdiff_t>(first[row + 1]);
		const auto found = std::lower_bound(begin, end, col) - column.begin();
		return row == col ? diagonal[row] : value[static_cast<std::size_t>(found)];
	}
	double restOf(std::size_t row, const std::vector<double>& x) const
	{
		double sum = 0.0;
		for (std::size_t k = first[row]; k < first[row + 1]; ++k)
		{
			sum += value[k] * x[column[k]];
		}
		return sum;
	}
};

std::array<uint32_t, 3> cornersOf(const Level& level, const Unknowns& unknowns, std::size_t triangle, bool back)
{
	const glm::uvec3 t = level.triangles[triangle];
	const std::vector<uint32_t>& of = back ? unknowns.of_back : unknowns.of_vertex;
	return {of[t.x], of[t.y], of[t.z]};
}

// Sparsity pattern with an entry for every two unknowns of a triangle, all 0.
Matrix emptyMatrix(const Level& level, const Unknowns& unknowns)
{
	Matrix matrix;
	std::vector<uint64_t> pairs;
	pairs.reserve(6 * level.triangles.size());
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		for (const bool back : {false, true})
		{
			const std::array<uint32_t, 3> corner = cornersOf(level, unknowns, t, back);
			if (back && corner == cornersOf(level, unknowns, t, false))
			{
				continue;
			}
			for (std::size_t k = 0; k < 9; ++k)
			{
				if (corner[k / 3] != corner[k % 3])
				{
					pairs.push_back((uint64_t{corner[k / 3]} << 32U) | corner[k % 3]);
				}
			}
		}
	}
	std::sort(pairs.begin(), pairs.end());
	pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
	matrix.diagonal.assign(unknowns.count, 0.0);
	matrix.first.assign(unknowns.count + 1, 0);
	matrix.value.assign(pairs.size(), 0.0);
	matrix.column.reserve(pairs.size());
	for (const uint64_t pair : pairs)
	{
		matrix.first[(pair >> 32U) + 1] += 1;
		matrix.column.push_back(static_cast<uint32_t>(pair));
	}
	for (std::size_t i = 0; i < unknowns.count; ++i)
	{
		matrix.first[i + 1] += matrix.first[i];
	}
	return matrix;
}

// The normal equations, and a random-sign estimate of how the samples' errors affect their right side.
struct Equations
{
	Matrix matrix;
	std::vector<double> right;
	std::vector<double> noise;
	std::array<std::vector<double>, 3> bent; // right sides of visibility times direction, if requested
};

// Contribution of one side of a triangle to the matrix.
struct Square
{
	std::array<std::array<double, 3>, 3> sum{};
	double weight = 0.0;
};

void addSample(Equations& equations, Square& square, const std::array<uint32_t, 3>& corner, const SurfaceSample& sample,
			   double weight, double noise)
{
	const auto b = static_cast<double>(sample.b);
	const auto c = static_cast<double>(sample.c);
	const std::array<double, 3> share{1.0 - b - c, b, c};
	const auto visibility = static_cast<double>(sample.visibility);
	square.weight += weight;
	for (std::size_t i = 0; i < 3; ++i)
	{
		equations.right[corner[i]] += weight * share[i] * visibility;
		equations.noise[corner[i]] += weight * share[i] * noise * static_cast<double>(sample.standard_error);
		for (std::size_t axis = 0; axis < 3 && !equations.bent[axis].empty(); ++axis)
		{
			const auto along = static_cast<double>(sample.bent[static_cast<int>(axis)]);
			equations.bent[axis][corner[i]] += weight * share[i] * visibility * along;
		}
		for (std::size_t j = 0; j < 3; ++j)
		{
			square.sum[i][j] += weight * share[i] * share[j];
		}
	}
}

void addSquare(Matrix& matrix, const std::array<uint32_t, 3>& corner, const Square& square)
{
	for (std::size_t i = 0; i < 3 && square.weight > 0.0; ++i)
	{
		for (std::size_t j = 0; j < 3; ++j)
		{
			const double smooth = (i == j ? 2.0 : -1.0) * kSmooth * square.weight;
			matrix.at(corner[i], corner[j]) += square.sum[i][j] + smooth;
		}
	}
}

Equations equationsOf(const Level& level, std::span<const double> areas, const Unknowns& unknowns,
					  std::span<const SurfaceSample> samples, uint32_t seed, bool bent)
{
	Equations equations{
		emptyMatrix(level, unknowns), std::vector<double>(unknowns.count, 0.0), std::vector<double>(unknowns.count, 0.0), {}};
	for (std::vector<double>& right : equations.bent)
	{
		right.assign(bent ? unknowns.count : 0, 0.0);
	}
	Random random(seed, 0xfacade);
	const auto addTriangle = [&](std::span<const SurfaceSample> of_triangle)
	{
		const std::size_t triangle = of_triangle.front().triangle;
		const double each = areas[triangle] / static_cast<double>(of_triangle.size());
		const std::array<std::array<uint32_t, 3>, 2> corners{cornersOf(level, unknowns, triangle, false),
															 cornersOf(level, unknowns, triangle, true)};
		std::array<Square, 2> squares{};
		for (const SurfaceSample& sample : of_triangle)
		{
			const std::size_t side = sample.back && corners[1] != corners[0] ? 1 : 0;
			const double noise = (random.next() & 1U) != 0 ? 1.0 : -1.0;
			addSample(equations, squares[side], corners[side], sample, each * (sample.buried || sample.shut ? kUnseenWeight : 1.0),
					  noise);
		}
		addSquare(equations.matrix, corners[0], squares[0]);
		addSquare(equations.matrix, corners[1], squares[1]);
	};
	eachRun(
		samples, [](const SurfaceSample& a, const SurfaceSample& b) { return a.triangle == b.triangle; }, addTriangle);
	return equations;
}

double dot(const std::vector<double>& a, const std::vector<double>& b)
{
	return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// Unknowns without a triangle are left unchanged.
void solve(const Matrix& matrix, const std::vector<double>& right, std::vector<double>& x)
{
	const std::size_t count = x.size();
	std::vector<double> residual(count);
	std::vector<double> scaled(count);
	std::vector<double> product(count);
	const auto precondition = [&]
	{
		for (std::size_t i = 0; i < count; ++i)
		{
			scaled[i] = matrix.diagonal[i] > 0.0 ? residual[i] / matrix.diagonal[i] : 0.0;
		}
	};
	for (std::size_t i = 0; i < count; ++i)
	{
		residual[i] = right[i] - matrix.diagonal[i] * x[i] - matrix.restOf(i, x);
	}
	precondition();
	std::vector<double> way = scaled;
	double square = dot(residual, scaled);
	for (int step = 0; step < kMostSteps && square > 0.0; ++step)
	{
		for (std::size_t i = 0; i < count; ++i)
		{
			product[i] = matrix.diagonal[i] * way[i] + matrix.restOf(i, way);
		}
		const double length = square / dot(way, product);
		double most = 0.0;
		for (std::size_t i = 0; i < count; ++i)
		{
			x[i] += length * way[i];
			residual[i] -= length * product[i];
			most = std::max(most, std::fabs(length * way[i]));
		}
		precondition();
		const double next = dot(residual, scaled);
		if (most < kSmallStep)
		{
			break;
		}
		for (std::size_t i = 0; i < count; ++i)
		{
			way[i] = scaled[i] + next / square * way[i];
		}
		square = next;
	}
}

// Starts from the unbounded solution.
void keepWithin(const Matrix& matrix, const std::vector<double>& right, double least, std::vector<double>& x)
{
	bool beyond = false;
	for (double& value : x)
	{
		beyond = beyond || value < least || value > 1.0;
		value = std::clamp(value, least, 1.0);
	}
	double most = beyond ? 1.0 : 0.0;
	for (int sweep = 0; sweep < kMostSteps && most > kSmallStep; ++sweep)
	{
		most = 0.0;
		for (std::size_t i = 0; i < x.size(); ++i)
		{
			if (matrix.diagonal[i] > 0.0)
			{
				const double value = std::clamp((right[i] - matrix.restOf(i, x)) / matrix.diagonal[i], least, 1.0);
				most = std::max(most, std::fabs(value - x[i]));
				x[i] = value;
			}
		}
	}
}

} // namespace

std::vector<glm::vec3> vertexNormals(const Level& level)
{
	std::vector<glm::dvec3> sums(level.positions.size(), glm::dvec3(0.0));
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		for (int corner = 0; corner < 3; ++corner)
		{
			sums[level.triangles[t][corner]] += twiceAreaOf(level, t);
		}
	}
	std::vector<glm::vec3> normals = level.normals;
	for (std::size_t v = 0; v < normals.size(); ++v)
	{
		const double length = glm::length(sums[v]);
		if (normals[v] == glm::vec3(0.0F) && length > 0.0)
		{
			normals[v] = glm::vec3(sums[v] / length);
		}
	}
	return normals;
}

Unknowns unknownsOf(const Level& level, BakeSides sides, std::vector<uint32_t> places)
{
	const std::vector<glm::vec3> normals = vertexNormals(level);
	const std::size_t count = level.positions.size();
	// For each vertex the first one that it shares a value with; values are then numbered in vertex order.
	std::vector<uint32_t> first_of(count);
	std::vector<uint32_t> next(count, kNone); // the next vertex with a value of its own at the same place
	Unknowns unknowns;
	unknowns.place_of_vertex = places.empty() ? weldPositions(level.positions, 1) : std::move(places);
	for (uint32_t v = 0; v < count; ++v)
	{
		uint32_t first = unknowns.place_of_vertex[v];
		while (first != v && normals[v] != normals[first] && !(glm::dot(normals[v], normals[first]) > kSameNormal))
		{
			next[first] = std::min(next[first], v);
			first = next[first];
		}
		first_of[v] = first;
	}
	unknowns.of_vertex.resize(count);
	for (std::size_t v = 0; v < count; ++v) // the first one precedes those that share its value
	{
		unknowns.of_vertex[v] = first_of[v] == v ? static_cast<uint32_t>(unknowns.count++) : unknowns.of_vertex[first_of[v]];
	}
	unknowns.of_back = unknowns.of_vertex;
	if (sides == BakeSides::separate)
	{
		addBacks(level, unknowns);
	}
	return unknowns;
}

FittedValues fitValues(const Level& level, std::span<const double> areas, const Unknowns& unknowns,
					   std::span<const SurfaceSample> samples, const BakeSettings& settings)
{
	assert(areas.size() == level.triangles.size());
	const Equations equations = equationsOf(level, areas, unknowns, samples, settings.seed, settings.bent);
	std::vector<double> x(unknowns.count, 1.0);
	solve(equations.matrix, equations.right, x);
	keepWithin(equations.matrix, equations.right, settings.base ? -1.0 : 0.0, x);
	std::vector<double> noise(unknowns.count, 0.0);
	solve(equations.matrix, equations.noise, noise);
	FittedValues fitted;
	fitted.values.assign(x.begin(), x.end());
	fitted.bent.resize(settings.bent ? unknowns.count : 0, glm::dvec3(0.0));
	for (int axis = 0; settings.bent && axis < 3; ++axis)
	{
		std::vector<double> along(unknowns.count, 0.0);
		solve(equations.matrix, equations.bent[static_cast<std::size_t>(axis)], along);
		for (std::size_t i = 0; i < along.size(); ++i)
		{
			fitted.bent[i][axis] = along[i];
		}
	}
	std::size_t used = 0;
	for (std::size_t i = 0; i < x.size(); ++i)
	{
		fitted.standard_error += noise[i] * noise[i];
		used += equations.matrix.diagonal[i] > 0.0 ? 1U : 0U;
	}
	fitted.standard_error = std::sqrt(fitted.standard_error / static_cast<double>(std::max<std::size_t>(used, 1)));
	return fitted;
}

void take(VertexBake& bake, const Level& level, const Unknowns& unknowns, const FittedValues& fitted)
{
	bake.standard_error = fitted.standard_error;
	bake.unknowns = unknowns.count;
	const auto takeSide = [&](const std::vector<uint32_t>& of, std::vector<float>& values, std::vector<glm::vec3>& bent)
	{
		values.resize(of.size());
		std::transform(of.begin(), of.end(), values.begin(), [&](uint32_t i) { return fitted.values[i]; });
		if (fitted.bent.empty())
		{
			return;
		}
		bent = vertexNormals(level);
		for (std::size_t v = 0; v < of.size(); ++v)
		{
			const glm::dvec3 mean = fitted.bent[of[v]];
			const double length = glm::length(mean);
			bent[v] = length > 1e-9                    ? glm::vec3(mean / length)
					  : bent[v] == glm::vec3(0.0F)     ? glm::vec3(0.0F, 1.0F, 0.0F)
					  : of[v] == unknowns.of_vertex[v] ? bent[v]
													   : -bent[v];
		}
	};
	takeSide(unknowns.of_vertex, bake.visibility, bake.bent);
	if (unknowns.has_sides)
	{
		takeSide(unknowns.of_back, bake.back, bake.bent_back);
	}
}

} // namespace nook
