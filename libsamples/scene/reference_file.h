// SPDX-License-Identifier: GPL-3.0-or-later
// Reads points from a file and writes reference visibility.
#pragma once

#include "core/image.h"
#include "scene/reference.h"

#include <span>
#include <string>
#include <vector>

namespace nook
{

// Comma-separated rows x,y,z,nx,ny,nz (position in metres, normal of any length), after an optional header with these names and
// comments (#). Positions are assumed to be rounded to 32 bits: rays start that much above them. Throws Error: file; invalid_input
// with the line.
std::vector<ReferencePoint> readPoints(const std::string& path);

// Channels `visibility` and `standard_error`, 32-bit floats.
std::string visibilityExr(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes);

// Additionally `bent.X`, `bent.Y`, `bent.Z` (unit, view space, 0 for sky) and `cone_angle` (coneAngle, radians).
std::string bentExr(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes);

// For a method, without a standard error: channels `bent.X`, `bent.Y`, `bent.Z`, `cone_angle`, `visibility`. Both lists have equal
// sizes.
std::string bentExr(int width_px, int height_px, std::span<const glm::vec3> bent, std::span<const float> visibility,
					const Notes& notes);

// Bent normals as colours: 127.5 + 127.5 times each component; sky is black.
std::string bentPng(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes);
std::string bentPng(int width_px, int height_px, std::span<const glm::vec3> bent, const Notes& notes);

// Header visibility,standard_error,rays,bx,by,bz,cone_angle and one row per point; bent normals in world space.
std::string bentCsv(std::span<const ReferenceValue> values);

// Channel `visibility` only.
std::string visibilityExr(int width_px, int height_px, std::span<const float> visibility, const Notes& notes);

// Visibility as 8-bit gray: black 0, white 1, linear.
std::string visibilityPng(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes);
std::string visibilityPng(int width_px, int height_px, std::span<const float> visibility, const Notes& notes);

// Header visibility,standard_error,rays and one row per point, in the order of the points.
std::string visibilityCsv(std::span<const ReferenceValue> values);

} // namespace nook
