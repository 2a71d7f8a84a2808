// SPDX-License-Identifier: GPL-3.0-or-later
#include "testing.h"

#include "pattern/cells.h"
#include "pattern/energy.h"
#include "pattern/energy_kernels.h"
#include "pattern/methods.h"

namespace
{

const std::vector<Domain> kCellDomains{Domain::disk, Domain::ball, Domain::sphere, Domain::hemisphere};

std::vector<glm::dvec3> somePoints(Domain domain, int count, uint64_t seed)
{
	Recipe recipe{.domain = domain, .count = count};
	Random random(seed);
	return randomPoints(Layout(recipe), random);
}

double sumOf(const std::vector<double>& values)
{
	return std::accumulate(values.begin(), values.end(), 0.0);
}

glm::dvec3 momentOf(const Cells& cells)
{
	glm::dvec3 moment(0.0);
	for (std::size_t i = 0; i < cells.integrals.size(); ++i)
	{
		moment += cells.integrals[i] * cells.centroids[i];
	}
	return moment;
}

// The discrete cells of Loos and Sloan 2010, §4.5: 512² squares of the disk, 128³ cubes of the ball, or 512² equal-area pieces of
// the sphere (Archimedes), each of which belongs to its nearest point.
Cells gridCells(Domain domain, const std::vector<glm::dvec3>& points)
{
	const int count = domain == Domain::ball ? 128 : 512;
	const auto middle = [count](int k)
	{
		return -1.0 + 2.0 * (k + 0.5) / count;
	};
	Cells cells{std::vector<double>(points.size()), std::vector<glm::dvec3>(points.size()), {}};
	double total = 0.0;
	for (int cell = 0; cell < count * count * (domain == Domain::ball ? count : 1); ++cell)
	{
		glm::dvec3 x(middle(cell % count), middle(cell / count % count),
					 domain == Domain::ball ? middle(cell / count / count) : 0.0);
		if (domain == Domain::sphere)
		{
			const SinCos turn = sinCosOf(2.0 * kPi * (cell % count + 0.5) / count);
			const double r = std::sqrt((1.0 - x.y) * (1.0 + x.y));
			x = {r * turn.cos, r * turn.sin, x.y};
		}
		const double height2 = std::max(0.0, 1.0 - glm::dot(x, x));
		const double mass = domain == Domain::disk ? std::sqrt(height2) : domain == Domain::sphere || height2 > 0.0 ? 1.0 : 0.0;
		const auto nearer = [&x, flat = isPlanar(domain) ? 0.0 : 1.0](const glm::dvec3& a, const glm::dvec3& b)
		{
			const glm::dvec3 axes(1.0, 1.0, flat);
			return glm::length(axes * (a - x)) < glm::length(axes * (b - x));
		};
		const auto nearest = static_cast<std::size_t>(std::min_element(points.begin(), points.end(), nearer) - points.begin());
		cells.integrals[nearest] += mass;
		cells.centroids[nearest] += mass * x;
		total += mass;
	}
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		cells.centroids[i] /= cells.integrals[i];
		cells.integrals[i] /= total;
	}
	return cells;
}

// Moves a point along one axis and back into its domain.
std::vector<glm::dvec3> nudged(Domain domain, std::vector<glm::dvec3> points, std::size_t i, int axis, double step)
{
	points[i][axis] += step;
	points[i] = placeInDomain(domain, points[i]);
	return points;
}

// The derivative by one coordinate, with the others following the domain.
double alongAxis(Domain domain, const glm::dvec3& gradient, const glm::dvec3& p, int axis)
{
	if (domain == Domain::sphere)
	{
		return (gradient - glm::dot(gradient, p) * p)[axis];
	}
	if (domain == Domain::hemisphere)
	{
		return (gradient - gradient.z / p.z * p)[axis];
	}
	return gradient[axis];
}

} // namespace

TEST_CASE("cells: integrals sum to 1 and centroids balance, whatever the points", "[pattern]")
{
	const Domain domain = GENERATE(from_range(kCellDomains));
	const int count = GENERATE(1, 2, 3, 4, 7, 40, 300);
	const Cells cells = exactCells(domain, somePoints(domain, count, 5));
	INFO("domain " << static_cast<int>(domain) << " count " << count);
	CHECK(sumOf(cells.integrals) == Approx(1.0).margin(1e-12));
	const glm::dvec3 moment = momentOf(cells);
	CHECK(std::fabs(moment.x) < 1e-12);
	CHECK(std::fabs(moment.y) < 1e-12);
	CHECK(std::fabs(moment.z) < 1e-12);
}

TEST_CASE("cells: two points cut the domain at a known distance", "[pattern]")
{
	const double d = GENERATE(-0.9, -0.3, 0.0, 0.2, 0.75);
	const std::vector<glm::dvec3> points{{d - 0.05, 0.0, 0.0}, {d + 0.05, 0.0, 0.0}};
	const double beyond = 0.25 * (2.0 - 3.0 * d + d * d * d); // a spherical segment; the chord density projects the ball
	CHECK(exactCells(Domain::disk, points).integrals[1] == Approx(beyond).margin(1e-13));
	CHECK(exactCells(Domain::ball, points).integrals[1] == Approx(beyond).margin(1e-13));
	const double segment = (std::acos(d) - d * std::sqrt(1.0 - d * d)) / kPi; // a circular segment
	CHECK(exactCells(Domain::hemisphere, points).integrals[1] == Approx(segment).margin(1e-13));
}

TEST_CASE("cells: symmetric sets, whose cells meet in the centre, share evenly", "[pattern]")
{
	std::vector<glm::dvec3> cube;
	std::vector<glm::dvec3> octahedron;
	for (const double x : {-0.5, 0.5})
	{
		for (const double y : {-0.5, 0.5})
		{
			cube.emplace_back(x, y, -0.5);
			cube.emplace_back(x, y, 0.5);
		}
		octahedron.insert(octahedron.end(), {{x, 0, 0}, {0, x, 0}, {0, 0, x}});
	}
	std::vector<glm::dvec3> ring;
	for (int k = 0; k < 12; ++k)
	{
		ring.emplace_back(0.6 * std::cos(k * kPi / 6.0), 0.6 * std::sin(k * kPi / 6.0), 0.0);
	}
	const auto all_equal = [](Domain domain, std::vector<glm::dvec3> points)
	{
		for (glm::dvec3& p : points)
		{
			p = domain == Domain::sphere ? glm::normalize(p) : p;
		}
		return relativeSpread(exactCells(domain, points).integrals);
	};
	CHECK(all_equal(Domain::ball, cube) < 1e-13);
	CHECK(all_equal(Domain::ball, octahedron) < 1e-13);
	CHECK(all_equal(Domain::ball, ring) < 1e-13);
	CHECK(all_equal(Domain::sphere, cube) < 1e-13);
	CHECK(all_equal(Domain::sphere, octahedron) < 1e-13);
	CHECK(all_equal(Domain::sphere, ring) < 1e-13);
	CHECK(all_equal(Domain::disk, ring) < 1e-13);
	CHECK(all_equal(Domain::hemisphere, ring) < 1e-13);
}

TEST_CASE("cells: doubled points leave one cell and an empty one", "[pattern]")
{
	const Domain domain = GENERATE(from_range(kCellDomains));
	std::vector<glm::dvec3> points = somePoints(domain, 9, 2);
	points.push_back(points[4]);
	const Cells cells = exactCells(domain, points);
	CHECK(sumOf(cells.integrals) == Approx(1.0).margin(1e-12));
	CHECK(std::min(cells.integrals[4], cells.integrals[9]) == 0.0);
}

TEST_CASE("cells: the paper's grids agree with the exact integrals to their own resolution", "[pattern]")
{
	const Domain domain = GENERATE(from_range(kCellDomains));
	const std::vector<glm::dvec3> points = somePoints(domain, 20, 3);
	const Cells exact = exactCells(domain, points);
	const Cells discrete = gridCells(domain, points);
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		CHECK(discrete.integrals[i] == Approx(exact.integrals[i]).margin(5e-4));
		glm::dvec3 difference = discrete.centroids[i] - exact.centroids[i];
		difference.z = isPlanar(domain) ? 0.0 : difference.z; // plane cells have plane centroids
		CHECK(glm::length(difference) < 5e-3);
	}
}

TEST_CASE("cells: the gradient of the integrals is that of finite differences", "[pattern]")
{
	constexpr double kStep = 1e-5;
	const Domain domain = GENERATE(from_range(kCellDomains));
	const std::vector<glm::dvec3> points = somePoints(domain, 12, 7);
	std::vector<double> factors(points.size());
	Random random(11);
	for (double& factor : factors)
	{
		factor = random.uniform();
	}
	const auto value = [&](const std::vector<glm::dvec3>& at)
	{
		const Cells cells = exactCells(domain, at);
		return std::inner_product(factors.begin(), factors.end(), cells.integrals.begin(), 0.0);
	};
	std::vector<glm::dvec3> gradient(points.size(), glm::dvec3(0.0));
	addCellGradient(domain, points, exactCells(domain, points).facets, factors, gradient);
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		for (int axis = 0; axis < (isPlanar(domain) ? 2 : 3); ++axis)
		{
			const double difference =
				(value(nudged(domain, points, i, axis, kStep)) - value(nudged(domain, points, i, axis, -kStep))) / (2.0 * kStep);
			glm::dvec3 g = gradient[i];
			g.z = isPlanar(domain) ? 0.0 : g.z;
			CHECK(alongAxis(domain, g, points[i], axis) == Approx(difference).margin(1e-7));
		}
	}
}

TEST_CASE("energy: the gradient is that of finite differences, for every part", "[pattern]")
{
	constexpr double kStep = 1e-5;
	for (const Domain domain : kCellDomains)
	{
		const std::vector<glm::dvec3> points = somePoints(domain, 9, 4);
		std::vector<double> weights = exactCells(domain, points).integrals;
		for (const Part part : {Part::whole, Part::window, Part::bias, Part::noise})
		{
			if (domain == Domain::sphere && part != Part::whole && part != Part::noise)
			{
				continue;
			}
			for (const Ensemble ensemble : {Ensemble::plane, Ensemble::cliff})
			{
				if (ensemble == Ensemble::cliff && domain != Domain::disk)
				{
					continue;
				}
				EnergyGradient gradient;
				squaredError(domain, ensemble, part, points, weights, &gradient);
				for (std::size_t i = 0; i < points.size(); ++i)
				{
					for (int axis = 0; axis < (isPlanar(domain) ? 2 : 3); ++axis)
					{
						const double up = squaredError(domain, ensemble, part, nudged(domain, points, i, axis, kStep), weights);
						const double down = squaredError(domain, ensemble, part, nudged(domain, points, i, axis, -kStep), weights);
						CHECK(alongAxis(domain, gradient.points[i], points[i], axis) ==
							  Approx((up - down) / (2.0 * kStep)).margin(1e-8));
					}
					std::vector<double> more = weights;
					more[i] += kStep;
					std::vector<double> less = weights;
					less[i] -= kStep;
					const double difference =
						(squaredError(domain, ensemble, part, points, more) - squaredError(domain, ensemble, part, points, less)) /
						(2.0 * kStep);
					CHECK(gradient.weights[i] == Approx(difference).margin(1e-8));
				}
			}
		}
	}
}

TEST_CASE("energy: noise and bias make up the whole", "[pattern]")
{
	const Domain domain = GENERATE(Domain::disk, Domain::ball, Domain::hemisphere);
	const std::vector<glm::dvec3> points = somePoints(domain, 10, 9);
	const std::vector<double> weights(10, 0.1);
	const auto part = [&](Part which)
	{
		return squaredError(domain, Ensemble::plane, which, points, weights);
	};
	CHECK(part(Part::noise) + part(Part::bias) == Approx(part(Part::whole)).epsilon(1e-10));
	CHECK(part(Part::noise) > 0.0);
	CHECK(part(Part::bias) > 0.0);
}

TEST_CASE("energy: rows of a large set and pairs of a small one are the same sum", "[pattern]")
{
	// 1100 points, and the union of a pattern with itself: equal shares of one half.
	const Domain domain = GENERATE(Domain::disk, Domain::ball);
	const std::vector<glm::dvec3> points = somePoints(domain, 550, 6);
	std::vector<glm::dvec3> twice = points;
	twice.insert(twice.end(), points.begin(), points.end());
	const double one = squaredError(domain, Ensemble::plane, Part::whole, points, std::vector<double>(550, 1.0 / 550.0));
	const double two = squaredError(domain, Ensemble::plane, Part::whole, twice, std::vector<double>(1100, 1.0 / 1100.0));
	const double two_threads =
		squaredError(domain, Ensemble::plane, Part::whole, twice, std::vector<double>(1100, 1.0 / 1100.0), nullptr, 2);
	CHECK(two == Approx(one).epsilon(1e-6));
	CHECK(two == two_threads);
}

TEST_CASE("energy: many pairs of lines have the bits of each alone", "[pattern]")
{
	Random random(3);
	for (const std::size_t count : {std::size_t{1}, std::size_t{7}, std::size_t{8}, LinePairs::kMost})
	{
		LinePairs pairs;
		for (std::size_t i = 0; i < count; ++i)
		{
			// Includes lines that are points, some nearly, and coincident lines.
			const auto half = [&](std::size_t every, double rare)
			{
				return i % every == 3 ? rare : random.uniform();
			};
			pairs.rho2[i] = half(11, 0.0);
			pairs.half_a[i] = half(5, 0.0);
			pairs.half_b[i] = half(7, 5e-5);
			pairs.weight_a[i] = random.uniform();
			pairs.weight_b[i] = random.uniform();
		}
		findTerms(pairs, count);
		for (std::size_t i = 0; i < count; ++i)
		{
			const double a = pairs.half_a[i];
			const double b = pairs.half_b[i];
			const kernels::PairDistance k = kernels::lineDistance(pairs.rho2[i], a, b);
			CHECK(pairs.distance[i] == k.value);
			CHECK(pairs.along_a[i] == 2.0 * pairs.weight_b[i] * k.by_rho2);
			CHECK(pairs.along_b[i] == 2.0 * pairs.weight_a[i] * k.by_rho2);
			CHECK(pairs.turn_a[i] == (a > 0.0 ? pairs.weight_b[i] * k.by_a / a : 0.0));
			CHECK(pairs.turn_b[i] == (b > 0.0 ? pairs.weight_a[i] * k.by_b / b : 0.0));
		}
	}
}
