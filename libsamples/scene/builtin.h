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
// At least that many triangles, 2 to kMaxHeightfieldTriangles.
Level makeHeightfield(std::size_t triangles);
// At least that many triangles, kMinCaveTriangles to kMaxCaveTriangles; one closed surface.
Level makeCave(std::size_t triangles);
Level makeNulls();

inline constexpr std::size_t kDefaultHeightfieldTriangles = 131072;
inline constexpr std::size_t kMaxHeightfieldTriangles = 20'000'000;
inline constexpr std::size_t kDefaultCaveTriangles = 600'000;
inline constexpr std::size_t kMinCaveTriangles = 1000;
inline constexpr std::size_t kMaxCaveTriangles = 20'000'000;

} // namespace nook
