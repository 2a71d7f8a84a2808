// SPDX-License-Identifier: GPL-3.0-or-later
// The built-in levels, one function and one file each.
#pragma once

#include "scene/level.h"

#include <cstddef>

namespace nook
{

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
