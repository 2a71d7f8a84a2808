// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the vertex values of a file made by nook bake.
#pragma once

#include "scene/load.h"

#include <string>
#include <vector>

namespace nook
{

// Meaning of the values.
enum class BakedKind
{
	visibility,            // _VISIBILITY, 0 to 1
	volume_difference,     // _DIFFERENCE, −1 to 1: added to the visibility of volumes (aov)
	mask_volume_difference // _DIFFERENCE_MASK: likewise for aov-mask
};

struct BakedValues
{
	BakedKind kind = BakedKind::visibility;
	std::vector<float> front; // one per vertex of the level; NaN for vertices without a value
	std::vector<float> back;  // the clockwise side; same as the front if the file has only one
};

// `level`: the result of loadLevel() for the same file. Throws Error (invalid_input) if the file has no values or one is out of
// range; otherwise like loadSecondUvs().
BakedValues loadBakedValues(const std::string& path, const Level& level, const RunSettings& run);

} // namespace nook
