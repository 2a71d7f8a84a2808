// SPDX-License-Identifier: GPL-3.0-or-later
// A level's surfaces, simplified: where detail is small against δ, fewer triangles block the same light.
#pragma once

#include "core/progress.h"
#include "scene/level.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace nook::detail
{

struct Proxies
{
	std::vector<glm::uvec3> triangles; // vertices of the level
	std::vector<uint32_t> materials;
	std::vector<uint32_t> sources; // the level's triangle that stands for each: the first of its piece of surface
	double deviation_m = 0.0;      // greatest error that the simplification reports
};

// Of the triangles with may_change ≠ 0 each piece of surface (joined by corners, one material) is simplified on its own by
// meshoptimizer (quadric errors), by at most about `error_m`. Borders stay as they are, so nothing opens: pieces keep their seams,
// and closed pieces stay closed. A piece that would vanish stays whole; so do all other triangles.
Proxies proxiesOf(const Level& level, std::span<const uint8_t> may_change, double error_m, const RunSettings& run);

} // namespace nook::detail
