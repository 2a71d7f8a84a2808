// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of pictures: colours by weight, cells, points, labels, legend.
#pragma once

#include "image/drawing.h"
#include "pattern/cells.h"

#include <span>

namespace nook
{

inline constexpr Colour kBackground = colourOf(0xfcfbf8);
inline constexpr Colour kInk = colourOf(0x1f2733);
inline constexpr Colour kSoftInk = colourOf(0x667080);
inline constexpr Colour kBorder = colourOf(0x4a5568);

// The circle of the picture that represents the unit circle; y up.
struct PictureFrame
{
	glm::dvec2 centre; // pixels
	double radius_px = 0.0;

	glm::dvec2 at(const glm::dvec2& p) const
	{
		return {centre.x + radius_px * p.x, centre.y - radius_px * p.y};
	}
};

// Colours for weights: blue below the mean, orange above.
struct WeightScale
{
	double range = 0.0; // greatest relative deviation from the mean on the scale; 0: all weights are equal

	Colour colour(double deviation) const;
};

// weight · count − 1.
double deviationOf(const Pattern& pattern, std::size_t i);

// A round range that covers all deviations of the patterns.
WeightScale weightScaleOf(std::span<const Pattern> patterns);

void addText(Drawing& drawing, const glm::dvec2& at, double size, const Colour& colour, const std::string& text,
			 Anchor anchor = Anchor::start);
void addCircle(Drawing& drawing, const glm::dvec2& centre, double radius, const Colour& fill, const Colour& stroke = {},
			   double stroke_width = 0.0);
void addLine(Drawing& drawing, std::vector<glm::dvec2> points, const Colour& stroke, double width);

// Cells coloured by weight, inside their circle; one polygon per point.
void addCells(Drawing& drawing, const PictureFrame& frame, const std::vector<CellPolygon>& cells, const Pattern& pattern,
			  const WeightScale& scale);

// Radius in pixels of each dot for `count` points in a frame.
double dotRadius(const PictureFrame& frame, std::size_t count);
void addDot(Drawing& drawing, const glm::dvec2& at, double radius);

// A colour bar with labelled ends, `width` wide and centred below `top`.
void addLegend(Drawing& drawing, const glm::dvec2& top, double width, const WeightScale& scale);

} // namespace nook
