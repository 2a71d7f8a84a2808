// SPDX-License-Identifier: GPL-3.0-or-later
// Sample sets: their means, and the errors that they state.
#include "core/random.h"
#include "scene/sample_set.h"

#include <catch2/catch.hpp>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <vector>

using namespace nook;

TEST_CASE("samples: standard errors hold for half-spaces, in every domain", "[reference]")
{
	// Occupied where n·p > c; the truth is the mean of many placements. Compares errors over placements with the stated ones.
	for (const SampleDomain domain : {SampleDomain::hemisphere, SampleDomain::ball, SampleDomain::box})
	{
		for (const int count : {16, 64, 256, 1024})
		{
			const SampleSet set(domain, count);
			const auto n = static_cast<std::size_t>(count);
			std::vector<float> x(n);
			std::vector<float> y(n);
			std::vector<float> z(n);
			std::vector<float> values(n);
			Random random(2);
			double errors = 0.0;
			double stated = 0.0;
			for (int plane = 0; plane < 8; ++plane)
			{
				const double a = random.uniform() - 0.5;
				const double b = random.uniform() - 0.5;
				const double c = random.uniform() - 0.5;
				const glm::vec3 normal(glm::normalize(glm::dvec3(a, b, c)));
				const auto offset = static_cast<float>(0.8 * random.uniform() - 0.4);
				constexpr int kPlacements = 100;
				double sum = 0.0;
				double squares = 0.0;
				for (int p = 0; p < kPlacements; ++p)
				{
					set.place(random, x, y, z);
					double occupied = 0.0;
					for (std::size_t i = 0; i < n; ++i)
					{
						values[i] = normal.x * x[i] + normal.y * y[i] + normal.z * z[i] > offset ? 1.0F : 0.0F;
						occupied += static_cast<double>(values[i]) / count;
					}
					sum += occupied;
					squares += occupied * occupied;
					stated += set.squaredError(values);
				}
				errors += squares - sum * sum / kPlacements;
			}
			CAPTURE(static_cast<int>(domain), count, std::sqrt(errors / stated));
			CHECK(errors <= 1.2 * stated);
			CHECK(errors >= 0.1 * stated);
		}
	}
}

TEST_CASE("samples: every placement has the mean of its domain in expectation", "[reference]")
{
	for (const SampleDomain domain : {SampleDomain::hemisphere, SampleDomain::ball, SampleDomain::box})
	{
		for (const int count : {1, 2, 5, 33})
		{
			const SampleSet set(domain, count);
			Random random(11);
			const auto n = static_cast<std::size_t>(count);
			std::vector<float> x(n);
			std::vector<float> y(n);
			std::vector<float> z(n);
			double mean = 0.0;
			double first = 0.0;
			const int placements = 200000 / count;
			for (int p = 0; p < placements; ++p)
			{
				set.place(random, x, y, z);
				for (std::size_t i = 0; i < n; ++i)
				{
					mean += static_cast<double>(x[i] * x[i] + y[i] * y[i]) / (static_cast<double>(placements) * count);
					first += static_cast<double>(x[i]) / (static_cast<double>(placements) * count);
				}
			}
			const double expected = domain == SampleDomain::hemisphere ? 0.5 : domain == SampleDomain::ball ? 0.4 : 2.0 / 3.0;
			CAPTURE(static_cast<int>(domain), count);
			CHECK(mean == Approx(expected).margin(0.004));
			CHECK(std::fabs(first) < 0.006);
		}
	}
}
