// SPDX-License-Identifier: GPL-3.0-or-later
// A picture as a list of flat shapes, painted in order → SVG text or pixels.
#pragma once

#include "core/notes.h"

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

// 0xrrggbb, opaque.
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
	Colour fill;
	Colour stroke;
	double stroke_width = 0.0; // pixels
	double radius = 0.0;       // circle: pixels
	double size = 0.0;         // text: font size in pixels
	Anchor anchor = Anchor::start;
	std::string text; // lower-case letters, digits and ". , : - + % ( ) / = _" have a form in pixels
};

struct Drawing
{
	int width_px = 0;
	int height_px = 0;
	Colour background;
	std::string title;
	std::vector<Shape> shapes;
};

// A file that stands alone: title, notes as its description, shapes. Coordinates to a hundredth of a pixel.
std::string svgText(const Drawing& drawing, const Notes& notes);

// 8-bit RGB rows from the top, `scale` pixels a unit, each pixel the mean of 4 × 4 samples.
std::vector<uint8_t> rasterised(const Drawing& drawing, double scale);

// A PNG file of it.
std::string pngBytes(const Drawing& drawing, double scale, const Notes& notes);

} // namespace nook
