// SPDX-License-Identifier: GPL-3.0-or-later
// A file of nook bake → the values at its vertices.
#pragma once

#include "scene/load.h"

#include <string>
#include <vector>

namespace nook
{

// What values stand for.
enum class BakedKind
{
	visibility,         // _VISIBILITY, 0 to 1
	beside_volumes,     // _DIFFERENCE, −1 to 1: what is added to the visibility of volumes (aov)
	beside_mask_volumes // _DIFFERENCE_MASK: the same for aov-mask
};

struct BakedValues
{
	BakedKind kind = BakedKind::visibility;
	std::vector<float> front; // one a vertex of the level; NaN for vertices without
	std::vector<float> back;  // of the clockwise side; the front's where the file has no other
};

// `level`: what loadLevel() made of the same file. Throws Error (invalid_input) for a file without values, or with one that is out
// of range; else as loadSecondUvs().
BakedValues loadBakedValues(const std::string& path, const Level& level, const RunSettings& run);

} // namespace nook
