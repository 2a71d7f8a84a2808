// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/volume_kernels.h"

#include <catch2/catch.hpp>

#include <array>
#include <vector>

using namespace nook;

TEST_CASE("volume: the form factor of a square one unit above is the known one", "[volume]")
{
	const std::array<glm::vec3, 4> square{glm::vec3(1, 1, 1), {1, -1, 1}, {-1, -1, 1}, {-1, 1, 1}};
	volume_kernels::Kernels kernels;
	kernels.corners = square;
	CHECK(kernels.nookFormFactor(4, {0, 0, 1}, 1.0F) == Approx(0.55412642).margin(2e-7));
	const std::array<glm::vec3, 4> behind{square[3], square[2], square[1], square[0]};
	kernels.corners = behind;
	CHECK(kernels.nookFormFactor(4, {0, 0, 1}, -1.0F) == Approx(0.55412642).margin(2e-7));
	CHECK(kernels.nookFormFactor(4, {0, 0, -1}, -1.0F) == 0.0F);
}
