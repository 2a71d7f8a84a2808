// SPDX-License-Identifier: GPL-3.0-or-later
// A pattern or a tile → its picture: points, cells, and weights as the cells' colours.
//
// Disk and hemisphere: the cells in the unit disk. Sphere: the cells on its front and on its back, both seen from outside.
// Ball: the points as small spheres of a volume in proportion to their weights, the cells in the section z = 0, and the points'
// distances from the centre along an axis. Colours: weight against the mean; the legend tells the range.
#pragma once

#include "measure/quality.h"
#include "pattern/recipe.h"
#include "pattern/tile.h"
#include "picture/drawing.h"

namespace nook
{

Drawing patternPicture(const Pattern& pattern, const Recipe* recipe, const Quality& quality);

// All variants in their places in the window.
Drawing tilePicture(const PatternTile& tile, const TileQuality& quality);

inline constexpr double kPictureScale = 1.5; // pixels of a PNG file a unit of the drawing

} // namespace nook
