// SPDX-License-Identifier: GPL-3.0-or-later
// Raw triangles → clean triangles, and a list of everything that was wrong with them.
#pragma once

#include "core/progress.h"
#include "scene/level.h"

#include <cstdint>
#include <string>
#include <vector>

namespace nook
{

// From here on neighbouring 32-bit numbers are 2^13 × 2^-23 m ≈ 0.98 mm apart, or more.
inline constexpr double kLarge_m = 8192.0;

struct Finding
{
	std::string id;     // stable: "non-finite-vertices"
	uint64_t count = 0; // ≥ 1
	std::string first;  // the first place: "mesh 'wall', triangle 12"
	std::string action; // what was done: "dropped", "welded", "kept"
};

struct Diagnosis
{
	std::vector<Finding> findings; // in the order of the table in docs/reference/levels.md; empty: nothing found
};

// Drops what cannot be used and reports what is odd. The level keeps every triangle that a ray can hit once. `more`, one a vertex,
// loses the values of the vertices that the level loses, and decides nothing.
Diagnosis cleanLevel(Level& level, const RunSettings& run, std::vector<glm::vec2>* more = nullptr);

} // namespace nook
