// SPDX-License-Identifier: GPL-3.0-or-later
// Named arrays as a C/C++ header, a GLSL include or an HLSL include.
#pragma once

#include "format/arrays.h"

#include <string>

namespace nook
{

// Compiles as C11 and as C++17 without warnings; has include guards.
// Rows are float[4]; constants are macros.
std::string headerText(const Source& source);

// For GLSL 1.30 and later and GLSL ES 3.00 and later. Has no #version of its own, so that any shader may include it; compiled
// alone, where the version is then 1.00 or 1.10, it declares nothing, since those have no constant arrays. The arrays are highp, so
// a fragment shader of ES needs no default precision.
std::string glslText(const Source& source);

std::string hlslText(const Source& source);

// The four floats, comma-separated.
std::string rowText(const Sample& sample);

} // namespace nook
