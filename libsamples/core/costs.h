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

// For the estimates of `nook info`: `nook volumes --masks` and `nook bake` at the suggested distance. docs/measurements/bake.md,
// "What nook info expects", has the levels that these were fitted to, and others.
inline constexpr double kMaskKept = 0.96;          // share of the polygons that darken something
inline constexpr double kMaskCorner_bytes = 14.0;  // in the file: a corner and a triangle
inline constexpr double kMaskPolygon_bytes = -1.7; // a polygon (8) and its part of a cluster (2.3), without two triangles (12)
inline constexpr double kMaskFile_bytes = 7e3;     // header and clusters that are not full
inline constexpr double kMaskTriangle_s = 1.1e-5;  // tree, sides, what its volume darkens
inline constexpr double kMaskSheet_s = 1.1e-5; // in addition if it is two-sided: rays that find out whether its back is in matter
inline constexpr double kMaskLeaf_s = 2.4e-5;  // per part of an alpha-tested polygon: texels, its volume
inline constexpr double kMaskCameras_s = 0.3;  // choosing cameras where a level has none
inline constexpr double kMaskTriangle_memory = 250.0;
inline constexpr double kMaskPolygon_memory = 480.0;
inline constexpr double kBakeRay_s = 6.1e-8;     // a ray in the open
inline constexpr double kBakeNear_s = 1.5e-8;    // in addition for each doubling of the triangles within its reach
inline constexpr double kBakeLeaves_s = 5.2e-8;  // in addition for each doubling of the leaves within its reach
inline constexpr double kBakeCheck_rays = 1.4e6; // rays that take as long as the check
inline constexpr double kBakeVertex_bytes = 4.0; // per vertex and side
inline constexpr double kBakeTriangle_memory = 290.0;
inline constexpr double kBakeValue_memory = 500.0; // points of the surface, equations
inline constexpr double kBakeFile_memory = 2.0;    // per byte of the level's file: as read and as written
inline constexpr double kLeast_memory = 1.6e7;     // program and libraries

} // namespace nook::cost
