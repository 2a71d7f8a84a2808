// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: L. Liu, L. Zhang, Y. Xu, C. Gotsman, S. Gortler, "A Local/Global Approach to Mesh Parameterization", 2008
// (as rigid as possible).
#include "bake/unwrap.h"

#include <glm/geometric.hpp>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

using SparseMatrix = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;
using FlatTriangle = std::array<glm::dvec2, 3>;

constexpr int kRounds = 12;        // of the local and global steps: more change the stretch of a hemisphere by less than 0.001
constexpr double kMostCot = 1e3;   // of slivers, whose weights would hide all others
constexpr double kLeastCot = 1e-3; // positive, so that the equations have one solution

// A triangle in its own plane.
FlatTriangle flatten(std::span<const glm::dvec3> positions, glm::uvec3 t)
{
	const glm::dvec3 u = positions[t.y] - positions[t.x];
	const glm::dvec3 v = positions[t.z] - positions[t.x];
	const double length = glm::length(u);
	return {glm::dvec2(0.0), glm::dvec2(length, 0.0), glm::dvec2(glm::dot(u, v), glm::length(glm::cross(u, v))) / length};
}

Eigen::Index indexOf(uint32_t i)
{
	return static_cast<Eigen::Index>(i);
}

} // namespace

void flattenRigid(std::span<const glm::uvec3> triangles, std::span<const glm::dvec3> positions, std::vector<glm::dvec2>& points)
{
	const Eigen::Index size = static_cast<Eigen::Index>(positions.size()) - 1; // the first vertex stays at the origin
	std::vector<FlatTriangle> flat;
	std::vector<std::array<double, 3>> cots; // of the angle at each corner
	Entries entries;
	for (const glm::uvec3& t : triangles)
	{
		flat.push_back(flatten(positions, t));
		std::array<double, 3>& of = cots.emplace_back();
		const double area = flat.back()[1].x * flat.back()[2].y;
		for (std::size_t i = 0; i < 3; ++i)
		{
			const FlatTriangle& f = flat.back();
			of[i] = std::clamp(glm::dot(f[(i + 1) % 3] - f[i], f[(i + 2) % 3] - f[i]) / area, kLeastCot, kMostCot);
			const Eigen::Index a = indexOf(t[static_cast<int>((i + 1) % 3)]) - 1;
			const Eigen::Index b = indexOf(t[static_cast<int>((i + 2) % 3)]) - 1;
			for (const auto& [row, column] : {std::pair(a, b), std::pair(b, a)})
			{
				if (row >= 0)
				{
					entries.emplace_back(row, row, of[i]);
				}
				if (row >= 0 && column >= 0)
				{
					entries.emplace_back(row, column, -of[i]);
				}
			}
		}
	}
	SparseMatrix matrix(size, size);
	matrix.setFromTriplets(entries.begin(), entries.end());
	const Eigen::SimplicialLDLT<SparseMatrix> factors(matrix);
	if (factors.info() != Eigen::Success)
	{
		return;
	}
	std::vector<glm::dvec2> sums;
	Eigen::MatrixXd right(size, 2);
	for (int round = 0; round < kRounds; ++round)
	{
		sums.assign(positions.size(), glm::dvec2(0.0));
		for (std::size_t i = 0; i < triangles.size(); ++i)
		{
			// The rotation nearest to the map from the triangle to its coordinates.
			const glm::uvec3 t = triangles[i];
			double cosine = 0.0;
			double sine = 0.0;
			for (std::size_t k = 0; k < 3; ++k)
			{
				const glm::dvec2 edge = flat[i][(k + 2) % 3] - flat[i][(k + 1) % 3];
				const glm::dvec2 image = points[t[static_cast<int>((k + 2) % 3)]] - points[t[static_cast<int>((k + 1) % 3)]];
				cosine += cots[i][k] * glm::dot(edge, image);
				sine += cots[i][k] * (edge.x * image.y - edge.y * image.x);
			}
			const double length = std::sqrt(cosine * cosine + sine * sine);
			cosine = length > 0.0 ? cosine / length : 1.0;
			sine = length > 0.0 ? sine / length : 0.0;
			for (std::size_t k = 0; k < 3; ++k)
			{
				const glm::dvec2 edge = cots[i][k] * (flat[i][(k + 2) % 3] - flat[i][(k + 1) % 3]);
				const glm::dvec2 turned(cosine * edge.x - sine * edge.y, sine * edge.x + cosine * edge.y);
				sums[t[static_cast<int>((k + 2) % 3)]] += turned;
				sums[t[static_cast<int>((k + 1) % 3)]] -= turned;
			}
		}
		for (Eigen::Index v = 0; v < size; ++v)
		{
			right(v, 0) = sums[static_cast<std::size_t>(v) + 1].x;
			right(v, 1) = sums[static_cast<std::size_t>(v) + 1].y;
		}
		const Eigen::MatrixXd solved = factors.solve(right);
		points[0] = glm::dvec2(0.0);
		for (Eigen::Index v = 0; v < size; ++v)
		{
			points[static_cast<std::size_t>(v) + 1] = {solved(v, 0), solved(v, 1)};
		}
	}
}

} // namespace nook
