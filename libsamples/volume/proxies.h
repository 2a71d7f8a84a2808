// SPDX-License-Identifier: GPL-3.0-or-later
// A level's opaque surfaces, simplified: where detail is small against δ, fewer triangles block the same light.
#pragma once

#include "core/progress.h"
#include "scene/level.h"

#include <glm/vec3.hpp>

#include <cstdint>
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

// Each piece of opaque surface (joined by edges) is simplified on its own by meshoptimizer (quadric errors), by at most about
// `error_m`. Borders stay as they are, so nothing opens: pieces keep their seams, and closed pieces stay closed. A piece that would
// vanish stays whole. Masked surfaces are untouched.
Proxies proxiesOf(const Level& level, double error_m, const RunSettings& run);

} // namespace nook::detail
