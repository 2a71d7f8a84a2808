// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/volume_kernels.h"
#include "stress/form_factor_twin.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>

#include <array>
#include <limits>
#include <vector>

using namespace nook;
using namespace nook::stress;

namespace
{

namespace mp = boost::multiprecision;
using Big = mp::number<mp::cpp_bin_float<256, mp::digit_base_2>, mp::et_off>;

float formFactor(const std::vector<glm::vec3>& corners, glm::vec3 normal, float side)
{
	volume_kernels::Kernels kernels;
	kernels.corners = corners;
	return kernels.nookFormFactor(static_cast<int>(corners.size()), normal, side);
}

// The greatest error of `count` hard polygons; `failed` counts results that are no share.
template <class T> double greatestError(uint32_t count, int& failed)
{
	double greatest = 0.0;
	for (uint32_t i = 0; i < count; ++i)
	{
		Random random(7, i);
		const HardPolygon hard = hardPolygon(random, static_cast<int>(i % kHardKinds));
		const float found = formFactor(hard.corners, hard.normal, hard.side);
		failed += found >= 0.0F && found <= 1.0F ? 0 : 1;
		const auto expected = static_cast<double>(referenceFormFactor<T>(hard.corners, hard.normal));
		greatest = std::max(greatest, std::fabs(static_cast<double>(found) - expected));
	}
	return greatest;
}

// Between the twins of 64-bit mantissas and of 256 bits.
double greatestTwinDifference(uint32_t count)
{
	double greatest = 0.0;
	for (uint32_t i = 0; i < count; ++i)
	{
		Random random(7, i);
		const HardPolygon hard = hardPolygon(random, static_cast<int>(i % kHardKinds));
		const Big difference =
			Big(referenceFormFactor<long double>(hard.corners, hard.normal)) - referenceFormFactor<Big>(hard.corners, hard.normal);
		greatest = std::max(greatest, std::fabs(static_cast<double>(difference)));
	}
	return greatest;
}

} // namespace

TEST_CASE("form factor: a square one unit above is the known one", "[form_factor]")
{
	const std::vector<glm::vec3> square{{1, 1, 1}, {1, -1, 1}, {-1, -1, 1}, {-1, 1, 1}};
	CHECK(formFactor(square, {0, 0, 1}, 1.0F) == Approx(0.55412642).margin(2e-7));
	const std::vector<glm::vec3> behind(square.rbegin(), square.rend());
	CHECK(formFactor(behind, {0, 0, 1}, -1.0F) == Approx(0.55412642).margin(2e-7));
	CHECK(formFactor(behind, {0, 0, -1}, -1.0F) == 0.0F);
}

TEST_CASE("form factor: an endless slope covers (1 - cos a) / 2 up to its angle a", "[form_factor]")
{
	for (const double angle : {0.2, 0.8, 1.3, 1.5707963})
	{
		const glm::vec3 up(static_cast<float>(std::cos(angle)), 0.0F, static_cast<float>(std::sin(angle)));
		const glm::vec3 left(0.01F, -1e5F, 0);
		const glm::vec3 right(0.01F, 1e5F, 0);
		const float found = formFactor({right, left, left + 1e5F * up, right + 1e5F * up}, {0, 0, 1}, 1.0F);
		INFO("angle " << angle);
		CHECK(static_cast<double>(found) == Approx(0.5 * (1.0 - std::cos(angle))).margin(2e-6));
	}
}

TEST_CASE("form factor: exact to 2e-6 against 256 bits, whatever the polygon", "[form_factor]")
{
	int failed = 0;
	const double error = greatestError<Big>(3000, failed);
	INFO("greatest error " << error);
	CHECK(error < 1e-6);
	CHECK(failed == 0);
}

// So millions can be held against the twin of 64-bit mantissas, which takes a hundredth of the time.
TEST_CASE("form factor: the twin of 64-bit mantissas is that of 256 bits, to far less than what is asked", "[form_factor]")
{
	const double apart = greatestTwinDifference(3000);
	INFO("twins differ by " << apart);
	CHECK(apart < 1e-9);
}

TEST_CASE("form factor: exact to 2e-6 for a hundred thousand hard polygons", "[form_factor]")
{
	int failed = 0;
	const double error = greatestError<long double>(100'000, failed);
	INFO("greatest error " << error);
	CHECK(error < 1e-6);
	CHECK(failed == 0);
}

// Two minutes; nook_tests "[form_factor_all]". Against 256 bits throughout it would be half an hour, for 1e-17 more.
TEST_CASE("form factor: exact to 2e-6 for ten million hard polygons", "[.][form_factor_all]")
{
	int failed = 0;
	const double error = greatestError<long double>(10'000'000, failed);
	const double apart = greatestTwinDifference(300'000);
	INFO("greatest error " << error << ", twins differ by " << apart);
	CHECK(error + apart < 2e-6);
	CHECK(failed == 0);
}

TEST_CASE("form factor: coordinates of 1e5 m lose nothing once corners are relative to the receiver", "[form_factor]")
{
	double greatest = 0.0;
	for (uint32_t i = 0; i < 3000; ++i)
	{
		Random random(8, i);
		const HardPolygon hard = hardPolygon(random, 0);
		const glm::dvec3 receiver = 1e5 * randomDirection(random);
		std::vector<glm::dvec3> exact;
		std::vector<glm::vec3> relative;
		for (const glm::vec3& corner : hard.corners)
		{
			const glm::dvec3 world = receiver + glm::dvec3(corner);
			exact.push_back(world - receiver); // 64 bits of the world keep 1.5e-11 m
			relative.emplace_back(world - receiver);
		}
		const double expected = referenceFormFactor<double>(exact, hard.normal);
		greatest = std::max(greatest, std::fabs(static_cast<double>(formFactor(relative, hard.normal, hard.side)) - expected));
	}
	INFO("greatest error " << greatest);
	CHECK(greatest < 2e-6);
}

TEST_CASE("form factor: a closed box around the receiver is the whole hemisphere", "[form_factor]")
{
	for (uint32_t i = 0; i < 300; ++i)
	{
		Random random(9, i);
		const glm::vec3 least(-static_cast<float>(logUniform(random, 1e-3, 1e3)),
							  -static_cast<float>(logUniform(random, 1e-3, 1e3)),
							  -static_cast<float>(logUniform(random, 1e-3, 1e3)));
		const glm::vec3 most = -least * static_cast<float>(logUniform(random, 0.1, 10.0));
		const glm::vec3 normal(randomDirection(random));
		double sum = 0.0;
		for (int axis = 0; axis < 3; ++axis)
		{
			for (const bool upper : {false, true})
			{
				// Counter-clockwise as seen from inside.
				std::vector<glm::vec3> face(4, upper ? most : least);
				const int u = (axis + 1) % 3;
				const int v = (axis + 2) % 3;
				for (std::size_t k = 0; k < 4; ++k)
				{
					const std::size_t turned = upper ? 3 - k : k;
					face[k][u] = turned == 1 || turned == 2 ? most[u] : least[u];
					face[k][v] = turned >= 2 ? most[v] : least[v];
				}
				sum += static_cast<double>(formFactor(face, normal, 1.0F));
			}
		}
		CHECK(sum == Approx(1.0).margin(1e-5));
	}
}

TEST_CASE("form factor: a share and no NaN where the receiver touches the polygon", "[form_factor]")
{
	const std::vector<glm::vec3> square{{1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {-1, 1, 0}};
	const std::array<glm::vec3, 6> places{glm::vec3(0), {1, 1, 0}, {1, 0, 0}, {0.3F, 0.2F, 0}, {1, 1, 1e-30F}, {1, 0, 1e-12F}};
	for (const glm::vec3& place : places)
	{
		std::vector<glm::vec3> corners;
		for (const glm::vec3& corner : square)
		{
			corners.push_back(corner - place);
		}
		for (uint32_t i = 0; i < 200; ++i)
		{
			Random random(10, i);
			const glm::vec3 normal = i == 0 ? glm::vec3(0, 0, 1) : i == 1 ? glm::vec3(1, 0, 0) : glm::vec3(randomDirection(random));
			const float found = formFactor(corners, normal, i % 2 == 0 ? 1.0F : -1.0F);
			CHECK((found >= 0.0F && found <= 1.0F));
		}
	}
	// No area at all.
	CHECK(formFactor({{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}, {1, 0, 0}, 1.0F) == 0.0F);
	CHECK(formFactor({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {1, 0, 0}, 1.0F) == 0.0F);
	CHECK(formFactor({{1, 0, 1}, {0, 0, 1}, {-1, 0, 1}}, {0, 0, 1}, 1.0F) == Approx(0.0).margin(1e-6));
}
