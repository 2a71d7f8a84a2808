// SPDX-License-Identifier: GPL-3.0-or-later
// Cleans raw triangles and lists everything that was wrong with them.
#pragma once

#include "core/progress.h"
#include "scene/level.h"

#include <cstdint>
#include <string>
#include <vector>

namespace nook
{

// From here on adjacent 32-bit numbers are at least 2^13 × 2^-23 m ≈ 0.98 mm apart.
inline constexpr double kLarge_m = 8192.0;

struct Finding
{
	std::string id;     // stable: "non-finite-vertices"
	uint64_t count = 0; // ≥ 1
	std::string first;  // first occurrence: "mesh 'wall', triangle 12"
	std::string action; // what was done: "dropped", "welded", "kept"
};

struct Diagnosis
{
	std::vector<Finding> findings; // in the order of the table in docs/reference/levels.md; empty: no findings
};

// Drops unusable triangles and reports oddities. Keeps every triangle that a ray can hit, once. `more`, one per vertex, is filtered
// like the vertices and affects nothing else.
Diagnosis cleanLevel(Level& level, const RunSettings& run, std::vector<glm::vec2>* more = nullptr);

} // namespace nook
