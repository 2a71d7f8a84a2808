// SPDX-License-Identifier: GPL-3.0-or-later
// Procedural levels in metres with named cameras; the first camera is called "main".
#pragma once

#include "scene/level.h"

#include <cstddef>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr std::string_view kBuiltinPrefix = "builtin:";

// "cornell", "courtyard", …: valid names after the prefix.
std::vector<std::string_view> builtinNames();

// `name` without prefix; "heightfield:1000000", "cave:20000": at least that many triangles. Throws Error (usage) for others.
Level builtinLevel(std::string_view name);

// The built-in levels, one function and one file each.

Level makeCornell();
Level makeCourtyard();
Level makeSuburb();
Level makeFoliage();
// At least that many triangles, in the range that builtin.cpp states; a cave is one closed surface.
Level makeHeightfield(std::size_t triangles);
Level makeCave(std::size_t triangles);
Level makeNulls();

} // namespace nook
