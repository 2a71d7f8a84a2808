// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/drawing.h"

#include "core/lists.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace nook
{
namespace
{

// Hundredths, without trailing zeros.
std::string lengthText(double value)
{
	const auto hundredths = static_cast<long>(std::floor(value * 100.0 + 0.5));
	std::string text = (hundredths < 0 ? "-" : "") + std::to_string(std::labs(hundredths) / 100);
	const long rest = std::labs(hundredths) % 100;
	if (rest != 0)
	{
		text += "." + std::to_string(rest / 10) + (rest % 10 == 0 ? "" : std::to_string(rest % 10));
	}
	return text;
}

std::string hexOf(const Colour& colour)
{
	std::array<char, 8> text{};
	const auto byte = [](double value)
	{
		return static_cast<unsigned>(std::floor(value * 255.0 + 0.5));
	};
	std::snprintf(text.data(), text.size(), "#%02x%02x%02x", byte(colour.red), byte(colour.green), byte(colour.blue));
	return text.data();
}

std::string paint(const char* attribute, const Colour& colour)
{
	if (colour.opacity <= 0.0)
	{
		return std::string(" ") + attribute + "=\"none\"";
	}
	std::string text = std::string(" ") + attribute + "=\"" + hexOf(colour) + "\"";
	if (colour.opacity < 1.0)
	{
		text += std::string(" ") + attribute + "-opacity=\"" + lengthText(colour.opacity) + "\"";
	}
	return text;
}

std::string paints(const Shape& shape)
{
	const bool stroked = shape.stroke.opacity > 0.0;
	return paint("fill", shape.fill) +
		   (stroked ? paint("stroke", shape.stroke) + " stroke-width=\"" + lengthText(shape.stroke_width) + "\"" : "");
}

std::string pathOf(const Shape& shape)
{
	return "M" + joinedText(shape.points, "L", [](const glm::dvec2& p) { return lengthText(p.x) + " " + lengthText(p.y); }) +
		   (shape.kind == ShapeKind::polygon ? "Z" : "");
}

std::string elementOf(const Shape& shape)
{
	switch (shape.kind)
	{
	case ShapeKind::circle:
		return "<circle cx=\"" + lengthText(shape.points[0].x) + "\" cy=\"" + lengthText(shape.points[0].y) + "\" r=\"" +
			   lengthText(shape.radius) + "\"" + paints(shape) + "/>\n";
	case ShapeKind::text:
	{
		const std::array<const char*, 3> anchors{"", " text-anchor=\"middle\"", " text-anchor=\"end\""};
		return "<text x=\"" + lengthText(shape.points[0].x) + "\" y=\"" + lengthText(shape.points[0].y) + "\" font-size=\"" +
			   lengthText(shape.size) + "\"" + anchors[static_cast<std::size_t>(shape.anchor)] + paint("fill", shape.fill) + ">" +
			   xmlText(shape.text) + "</text>\n";
	}
	default: return "<path d=\"" + pathOf(shape) + "\"" + paints(shape) + "/>\n";
	}
}

} // namespace

Colour mixed(const Colour& a, const Colour& b, double share_of_b)
{
	const auto mix = [&](double x, double y)
	{
		return x + (y - x) * share_of_b;
	};
	return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue), mix(a.opacity, b.opacity)};
}

std::string svgText(const Drawing& drawing, const Notes& notes)
{
	const std::string width = std::to_string(drawing.width_px);
	const std::string height = std::to_string(drawing.height_px);
	std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
					   "\" viewBox=\"0 0 " + width + " " + height +
					   "\" role=\"img\" xml:space=\"preserve\" font-family=\"system-ui, sans-serif\" stroke-linejoin=\"round\" "
					   "stroke-linecap=\"round\">\n<title>" +
					   xmlText(drawing.title) + "</title>\n<desc>\n" + xmlText(commentBlock(notes, "")) + "</desc>\n";
	text += "<rect width=\"" + width + "\" height=\"" + height + "\"" + paint("fill", drawing.background) + "/>\n";
	text += joinedText(drawing.shapes, "", [](const Shape& shape) { return elementOf(shape); });
	return text + "</svg>\n";
}

} // namespace nook
