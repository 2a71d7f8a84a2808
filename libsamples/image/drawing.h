// SPDX-License-Identifier: GPL-3.0-or-later
// A list of flat shapes, painted in order, that can be written as SVG.
#pragma once

#include "core/text.h"
#include "image/compare.h"
#include "pattern/quality.h"
#include "pattern/recipe.h"
#include "pattern/tile.h"
#include <span>

#include <glm/vec2.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace nook
{

struct Colour
{
	double red = 0.0; // sRGB, 0 to 1
	double green = 0.0;
	double blue = 0.0;
	double opacity = 0.0; // 0: not painted
};

// 0xrrggbb.
constexpr Colour colourOf(uint32_t rgb, double opacity = 1.0)
{
	return {static_cast<double>(rgb >> 16U & 255U) / 255.0, static_cast<double>(rgb >> 8U & 255U) / 255.0,
			static_cast<double>(rgb & 255U) / 255.0, opacity};
}

Colour mixed(const Colour& a, const Colour& b, double share_of_b);

enum class ShapeKind
{
	polygon, // closed
	line,    // open, stroke only, round ends
	circle,  // points[0], radius
	text,    // baseline at points[0], in the fill colour
};

enum class Anchor
{
	start,
	middle,
	end,
};

struct Shape
{
	ShapeKind kind = ShapeKind::polygon;
	std::vector<glm::dvec2> points; // pixels, y down
	Colour fill{};
	Colour stroke{};
	double stroke_width = 0.0; // pixels
	double radius = 0.0;       // circle: pixels
	double size = 0.0;         // text: font size in pixels
	Anchor anchor = Anchor::start;
	std::string text{};
};

struct Drawing
{
	int width_px = 0;
	int height_px = 0;
	Colour background;
	std::string title;
	std::vector<Shape> shapes;
};

// A stand-alone file: title, notes as its description, shapes. Coordinates are rounded to a hundredth of a pixel.
std::string svgText(const Drawing& drawing, const Notes& notes);

// Picture of test − reference: blue where the test is darker, red where it is lighter, with a legend.

// A round range (1, 2 or 5 × a power of ten, 0.001 to 1) that covers 99 % of the counted pixels' |differences|.
double differenceRange(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted);

// A PNG file: white is 0, the strongest colours are ±range and beyond, gray pixels are not counted. Small pictures are enlarged by
// an integer factor to make room for the legend. Requires equal sizes and range > 0.
std::string differencePng(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
						  double range, const Notes& notes);

// Picture of a pattern or a tile: points and cells, coloured by weight.
//
// Disk and hemisphere: the cells in the unit disk. Sphere: the cells on its front and on its back, both seen from outside. Ball:
// the points as small spheres with volumes proportional to their weights, the cells in the section z = 0, and the points' distances
// from the centre along an axis. Colours show the weight relative to the mean; the legend gives the range.

Drawing patternPicture(const Pattern& pattern, const Recipe* recipe, const Quality& quality);

// All variants at their positions in the window.
Drawing tilePicture(const PatternTile& tile, const TileQuality& quality);

} // namespace nook
