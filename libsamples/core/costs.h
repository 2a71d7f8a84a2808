// SPDX-License-Identifier: GPL-3.0-or-later
// One table of costs for plans, advice and reports: seconds of one thread of a machine of 2020 and bytes of memory;
// estimates, not bounds (docs/measurements/bake.md, docs/reference/plan.md).
#pragma once

namespace nook::cost
{

inline constexpr double kStart_s = 0.1;          // a program, its libraries and its readers
inline constexpr double kLoad_s = 1e-6;          // per triangle: reading, checking, the tree
inline constexpr double kRay_s = 2e-7;           // per ray in a level of 10⁵ triangles
inline constexpr double kVolume_s = 3e-5;        // per triangle: its volume
inline constexpr double kBuiltVolume_s = 1.6e-4; // per triangle, with trimming, compensation or simplification
inline constexpr double kPixel_s = 2e-6;         // per pixel: depth, normals, one method
inline constexpr double kTriangle_bytes = 400.0; // arrays, tree, diagnosis
inline constexpr double kVolume_bytes = 300.0;   // per triangle, in addition
inline constexpr double kBuiltVolume_bytes = 1600.0;
inline constexpr double kPixel_bytes = 150.0; // a G-buffer, values, the picture as it is written
inline constexpr double kProgram_bytes = 2e8;

} // namespace nook::cost
