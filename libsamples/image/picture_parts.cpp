// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/picture_parts.h"

#include "core/text.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

constexpr Colour kMean = colourOf(0xf1f0ed);
constexpr std::array kAbove{colourOf(0xf2b968), colourOf(0xc8511f)}; // at the middle and the end of the range
constexpr std::array kBelow{colourOf(0x8fbcd9), colourOf(0x2a5e9e)};
constexpr double kEqual = 2e-6; // relative: differences up to the rounding of 32-bit floats count as equal

// The least value 1, 2 or 5 × a power of ten that is at least `value`.
double roundedUp(double value)
{
	for (double decade = 1e-6;; decade *= 10.0)
	{
		for (const double step : {1.0, 2.0, 5.0})
		{
			if (decade * step >= value)
			{
				return decade * step;
			}
		}
	}
}

std::string percentText(double share)
{
	std::string text = roundedText(100.0 * share, 3) + "%";
	if (share > 0.0)
	{
		text.insert(text.begin(), '+');
	}
	return text;
}

} // namespace

Colour WeightScale::colour(double deviation) const
{
	if (range <= 0.0)
	{
		return kMean;
	}
	const double share = std::clamp(deviation / range, -1.0, 1.0);
	const std::array<Colour, 2>& side = share > 0.0 ? kAbove : kBelow;
	const double along = 2.0 * std::fabs(share);
	return along <= 1.0 ? mixed(kMean, side[0], along) : mixed(side[0], side[1], along - 1.0);
}

double deviationOf(const Pattern& pattern, std::size_t i)
{
	return pattern.weights[i] * static_cast<double>(pattern.count()) - 1.0;
}

WeightScale weightScaleOf(std::span<const Pattern> patterns)
{
	double greatest = 0.0;
	for (const Pattern& pattern : patterns)
	{
		for (std::size_t i = 0; i < pattern.count(); ++i)
		{
			greatest = std::max(greatest, std::fabs(deviationOf(pattern, i)));
		}
	}
	return {greatest <= kEqual ? 0.0 : roundedUp(greatest)};
}

void addText(Drawing& drawing, const glm::dvec2& at, double size, const Colour& colour, const std::string& text, Anchor anchor)
{
	Shape shape;
	shape.kind = ShapeKind::text;
	shape.points = {at};
	shape.size = size;
	shape.fill = colour;
	shape.anchor = anchor;
	shape.text = text;
	drawing.shapes.push_back(std::move(shape));
}

void addCircle(Drawing& drawing, const glm::dvec2& centre, double radius, const Colour& fill, const Colour& stroke,
			   double stroke_width)
{
	Shape shape;
	shape.kind = ShapeKind::circle;
	shape.points = {centre};
	shape.radius = radius;
	shape.fill = fill;
	shape.stroke = stroke;
	shape.stroke_width = stroke_width;
	drawing.shapes.push_back(std::move(shape));
}

void addLine(Drawing& drawing, std::vector<glm::dvec2> points, const Colour& stroke, double width)
{
	Shape shape;
	shape.kind = ShapeKind::line;
	shape.points = std::move(points);
	shape.stroke = stroke;
	shape.stroke_width = width;
	drawing.shapes.push_back(std::move(shape));
}

void addCells(Drawing& drawing, const PictureFrame& frame, const std::vector<CellPolygon>& cells, const Pattern& pattern,
			  const WeightScale& scale)
{
	// Thin enough to keep the colours of thousands of cells visible.
	const double width = std::clamp(0.02 * frame.radius_px * dotRadius({{}, 1.0}, pattern.count()) * 10.0, 0.25, 1.3);
	for (std::size_t i = 0; i < cells.size(); ++i)
	{
		if (cells[i].size() < 3)
		{
			continue;
		}
		Shape shape;
		for (const glm::dvec2& corner : cells[i])
		{
			shape.points.push_back(frame.at(corner));
		}
		shape.fill = scale.colour(deviationOf(pattern, i));
		shape.stroke = kBorder;
		shape.stroke_width = width;
		drawing.shapes.push_back(std::move(shape));
	}
	addCircle(drawing, frame.centre, frame.radius_px, {}, kInk, std::max(1.0, 0.008 * frame.radius_px));
}

double dotRadius(const PictureFrame& frame, std::size_t count)
{
	return std::min(0.03, 0.14 / std::sqrt(static_cast<double>(count))) * frame.radius_px;
}

void addDot(Drawing& drawing, const glm::dvec2& at, double radius)
{
	addCircle(drawing, at, radius, kInk);
}

void addLegend(Drawing& drawing, const glm::dvec2& top, double width, const WeightScale& scale)
{
	const double height = 10.0;
	if (scale.range <= 0.0)
	{
		addText(drawing, {top.x, top.y + height}, 12.0, kSoftInk, "all weights are equal", Anchor::middle);
		return;
	}
	const double least = std::max(-1.0, -scale.range); // weights are never negative
	const int steps = 100;
	const double left = top.x - 0.5 * width;
	for (int i = 0; i < steps; ++i)
	{
		const double share = (i + 0.5) / steps;
		Shape shape;
		const double x0 = left + width * i / steps;
		const double x1 = left + width * (i + 1) / steps + (i + 1 < steps ? 0.5 : 0.0); // overlaps the next one to avoid seams
		shape.points = {{x0, top.y}, {x1, top.y}, {x1, top.y + height}, {x0, top.y + height}};
		shape.fill = scale.colour(least + (scale.range - least) * share);
		drawing.shapes.push_back(std::move(shape));
	}
	const double text_y = top.y + height - 1.0;
	addText(drawing, {left - 8.0, text_y}, 12.0, kSoftInk, percentText(least), Anchor::end);
	addText(drawing, {left + width + 8.0, text_y}, 12.0, kSoftInk, percentText(scale.range));
	addText(drawing, {top.x, top.y + height + 16.0}, 12.0, kSoftInk, "weight against the mean", Anchor::middle);
}

} // namespace nook
