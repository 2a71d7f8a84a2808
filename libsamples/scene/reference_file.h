// SPDX-License-Identifier: GPL-3.0-or-later
// Points to work on, from a file; reference visibility, into one.
#pragma once

#include "core/image.h"
#include "scene/reference.h"

#include <span>
#include <string>
#include <vector>

namespace nook
{

// Comma-separated rows x,y,z,nx,ny,nz (position in metres, normal of any length), after an optional header of these names and
// comments (#). Positions are taken as rounded to 32 bits: rays begin that much above them. Throws Error: file; invalid_input with
// the line.
std::vector<ReferencePoint> readPoints(const std::string& path);

// Channels `visibility` and `standard_error`, 32-bit floats.
std::string visibilityExr(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes);

// The same, and `bent.X`, `bent.Y`, `bent.Z` (unit, view space, 0 for sky) and `cone_angle` (coneAngle, radians).
std::string bentExr(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes);

// Of a method, without a standard error: channels `bent.X`, `bent.Y`, `bent.Z`, `cone_angle`, `visibility`. As many of both.
std::string bentExr(int width_px, int height_px, std::span<const glm::vec3> bent, std::span<const float> visibility,
					const Notes& notes);

// Bent normals as colours: 127.5 + 127.5 of each coordinate; sky black.
std::string bentPng(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes);
std::string bentPng(int width_px, int height_px, std::span<const glm::vec3> bent, const Notes& notes);

// Header visibility,standard_error,rays,bx,by,bz,cone_angle and one row a point; the bent normals in world space.
std::string bentCsv(std::span<const ReferenceValue> values);

// Channel `visibility` alone.
std::string visibilityExr(int width_px, int height_px, std::span<const float> visibility, const Notes& notes);

// Visibility as 8-bit gray: black 0, white 1, linear.
std::string visibilityPng(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes);
std::string visibilityPng(int width_px, int height_px, std::span<const float> visibility, const Notes& notes);

// Header visibility,standard_error,rays and one row a point, in the order of the points.
std::string visibilityCsv(std::span<const ReferenceValue> values);

} // namespace nook
