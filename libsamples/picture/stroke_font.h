// SPDX-License-Identifier: GPL-3.0-or-later
// Text → the strokes of a small plain font, so that pictures need no font file and look the same everywhere.
#pragma once

#include <glm/vec2.hpp>

#include <string_view>
#include <vector>

namespace nook
{

using Stroke = std::vector<glm::dvec2>; // a polyline; a single point is a dot

// Strokes of a line of text whose baseline starts at (0, 0), y down, for a font size of 1 (capital height about 0.7).
// Letters become lower case; a character without a form is left blank.
std::vector<Stroke> strokesOf(std::string_view text);

// How far the text reaches, for a font size of 1.
double strokeWidthOf(std::string_view text);

} // namespace nook
