// SPDX-License-Identifier: GPL-3.0-or-later
// Rasterises shapes: each is cut into closed outlines, which are scan-converted on a grid four times as fine.
#include "image/drawing.h"

#include "core/image.h"
#include "core/lists.h"
#include "core/math.h"
#include "core/words.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace nook
{
namespace
{

constexpr int kSupersampling = 4;

class Canvas
{
public:
	Canvas(int width, int height, const Colour& background)
		: m_width(width), m_height(height), m_pixels(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
	{
		for (int y = 0; y < height; ++y)
		{
			blend(y, 0, width, background);
		}
	}

	// Even-odd fill of a closed outline; a sample is inside if its centre is.
	void fill(const std::vector<glm::dvec2>& outline, const Colour& colour)
	{
		if (colour.opacity <= 0.0 || outline.size() < 3)
		{
			return;
		}
		const auto [low, high] =
			std::minmax_element(outline.begin(), outline.end(), [](const glm::dvec2& a, const glm::dvec2& b) { return a.y < b.y; });
		const int first = std::max(0, static_cast<int>(std::floor(low->y)));
		const int last = std::min(m_height - 1, static_cast<int>(std::ceil(high->y)));
		for (int y = first; y <= last; ++y)
		{
			crossings(outline, y + 0.5);
			for (std::size_t k = 0; k + 1 < m_crossings.size(); k += 2)
			{
				const int from = std::max(0, static_cast<int>(std::ceil(m_crossings[k] - 0.5)));
				const int to = std::min(m_width, static_cast<int>(std::ceil(m_crossings[k + 1] - 0.5)));
				blend(y, from, to, colour);
			}
		}
	}

	// Averages the fine samples.
	std::vector<uint8_t> reduced() const
	{
		const int width = m_width / kSupersampling;
		const int height = m_height / kSupersampling;
		std::vector<uint8_t> rgb(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
		for (std::size_t i = 0; i < rgb.size(); ++i)
		{
			const std::size_t pixel = i / 3;
			const std::size_t x = pixel % static_cast<std::size_t>(width) * kSupersampling;
			const std::size_t y = pixel / static_cast<std::size_t>(width) * kSupersampling;
			double sum = 0.0;
			for (std::size_t k = 0; k < kSupersampling * kSupersampling; ++k)
			{
				const std::size_t row = y + k / kSupersampling;
				sum +=
					static_cast<double>(m_pixels[3 * (row * static_cast<std::size_t>(m_width) + x + k % kSupersampling) + i % 3]);
			}
			rgb[i] = static_cast<uint8_t>(std::floor(sum / (kSupersampling * kSupersampling) + 0.5));
		}
		return rgb;
	}

private:
	void crossings(const std::vector<glm::dvec2>& outline, double y)
	{
		m_crossings.clear();
		for (std::size_t i = 0; i < outline.size(); ++i)
		{
			const glm::dvec2& a = outline[i];
			const glm::dvec2& b = outline[i + 1 < outline.size() ? i + 1 : 0];
			if ((a.y <= y) != (b.y <= y))
			{
				m_crossings.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
			}
		}
		std::sort(m_crossings.begin(), m_crossings.end());
	}

	void blend(int y, int from, int to, const Colour& colour)
	{
		const double channels[3] = {255.0 * colour.red, 255.0 * colour.green, 255.0 * colour.blue};
		for (int x = from; x < to; ++x)
		{
			const std::size_t at =
				3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) + static_cast<std::size_t>(x));
			for (std::size_t c = 0; c < 3; ++c)
			{
				const auto old = static_cast<double>(m_pixels[at + c]);
				m_pixels[at + c] = static_cast<uint8_t>(old + (channels[c] - old) * colour.opacity + 0.5);
			}
		}
	}

	int m_width;
	int m_height;
	std::vector<uint8_t> m_pixels; // sRGB
	std::vector<double> m_crossings;
};

std::vector<glm::dvec2> circleOutline(const glm::dvec2& centre, double radius)
{
	const int corners = std::clamp(static_cast<int>(radius * 2.0), 12, 256);
	std::vector<glm::dvec2> outline;
	for (int i = 0; i < corners; ++i)
	{
		const SinCos turn = sinCosOf(2.0 * kPi * i / corners);
		outline.push_back(centre + radius * glm::dvec2(turn.cos, turn.sin));
	}
	return outline;
}

// A thick segment with round ends as one outline.
std::vector<glm::dvec2> capsule(const glm::dvec2& a, const glm::dvec2& b, double radius)
{
	const glm::dvec2 along = b - a;
	const double length = glm::length(along);
	if (length == 0.0)
	{
		return circleOutline(a, radius);
	}
	const double start = atan2Of(along.y, along.x) + 0.5 * kPi;
	const int steps = std::clamp(static_cast<int>(radius), 4, 32);
	std::vector<glm::dvec2> outline;
	for (int i = 0; i <= 2 * steps + 1; ++i)
	{
		const bool at_a = i <= steps;
		const SinCos turn = sinCosOf(start + kPi * (at_a ? i : i - 1) / steps);
		outline.push_back((at_a ? a : b) + radius * glm::dvec2(turn.cos, turn.sin));
	}
	return outline;
}

void paintLine(Canvas& canvas, const std::vector<glm::dvec2>& points, bool closed, double width, const Colour& colour)
{
	const std::size_t segments = closed || points.size() == 1 ? points.size() : points.size() - 1;
	for (std::size_t i = 0; i < segments; ++i)
	{
		canvas.fill(capsule(points[i], points[i + 1 < points.size() ? i + 1 : 0], 0.5 * width), colour);
	}
}

// Strokes of a small plain font, so that pictures need no font file and look the same everywhere.

using Stroke = std::vector<glm::dvec2>; // a polyline; a single point is a dot

constexpr double kUnit = 0.7 / 6.0; // size of a grid unit; capitals are six units high
constexpr double kSpacing = 1.9;    // units between characters
constexpr double kSpace = 2.0;      // width of a blank in units
constexpr int kBaseline = 2;        // grid row

struct Glyph
{
	char character;
	const char* strokes; // pairs of digits: x and y on the grid; blanks separate strokes
};

constexpr std::array kGlyphs{
	Glyph{'a', "4642 4536160503123243"},
	Glyph{'b', "0802 0516364543321203"},
	Glyph{'c', "4536160503123243"},
	Glyph{'d', "4842 4536160503123243"},
	Glyph{'e', "04444536160503123243"},
	Glyph{'f', "38281712 0636"},
	Glyph{'g', "46413010 4536160503123243"},
	Glyph{'h', "0802 0516364542"},
	Glyph{'i', "0602 08"},
	Glyph{'j', "161100 18"},
	Glyph{'k', "0802 3603 1432"},
	Glyph{'l', "0802"},
	Glyph{'m', "0602 0516263532 3546566562"},
	Glyph{'n', "0602 0516364542"},
	Glyph{'o', "160503123243453616"},
	Glyph{'p', "0600 0516364543321203"},
	Glyph{'q', "4640 4536160503123243"},
	Glyph{'r', "0602 051636"},
	Glyph{'s', "45361605143443321203"},
	Glyph{'t', "18132232 0636"},
	Glyph{'u', "0603123243 4642"},
	Glyph{'v', "062246"},
	Glyph{'w', "0612365266"},
	Glyph{'x', "0642 4602"},
	Glyph{'y', "0622 4610"},
	Glyph{'z', "06460242"},
	Glyph{'0', "180703123243473818"},
	Glyph{'1', "062822"},
	Glyph{'2', "07183847460242"},
	Glyph{'3', "07183847463515 354443321203"},
	Glyph{'4', "32380444"},
	Glyph{'5', "480805354443321203"},
	Glyph{'6', "473818070312324344351504"},
	Glyph{'7', "084812"},
	Glyph{'8', "15060718384746351504031232434435"},
	Glyph{'9', "031232434738180706153546"},
	Glyph{'.', "02"},
	Glyph{',', "1201"},
	Glyph{':', "05 02"},
	Glyph{'-', "0535"},
	Glyph{'+', "0545 2327"},
	Glyph{'=', "0646 0444"},
	Glyph{'_', "0141"},
	Glyph{'/', "0238"},
	Glyph{'(', "18060412"},
	Glyph{')', "08161402"},
	Glyph{'%', "0248 0818170708 3343423233"},
};

const char* formOf(char c)
{
	const char lower = lowerCase(c);
	const auto found = std::find_if(kGlyphs.begin(), kGlyphs.end(), [&](const Glyph& glyph) { return glyph.character == lower; });
	return found == kGlyphs.end() ? "" : found->strokes;
}

// Adds the character's strokes at x (units) and returns its width.
double addGlyph(const char* form, double x, std::vector<Stroke>& strokes)
{
	if (*form == '\0')
	{
		return kSpace;
	}
	double width = 0.0;
	strokes.emplace_back();
	for (; *form != '\0'; form += *form == ' ' ? 1 : 2)
	{
		if (*form == ' ')
		{
			strokes.emplace_back();
			continue;
		}
		const double right = form[0] - '0';
		const double up = form[1] - '0' - kBaseline;
		width = std::max(width, right);
		strokes.back().emplace_back((x + right) * kUnit, -up * kUnit);
	}
	return width;
}

// Strokes of a line of text with its baseline starting at (0, 0), y down, for a font size of 1 (capital height about 0.7), and its
// width. Letters are drawn as lower case; unsupported characters are blank.
std::pair<std::vector<Stroke>, double> strokesOf(std::string_view text)
{
	std::vector<Stroke> strokes;
	double x = 0.0;
	for (const char c : text)
	{
		x += addGlyph(formOf(c), x, strokes) + kSpacing;
	}
	return {strokes, std::max(0.0, x - kSpacing) * kUnit};
}

void paintText(Canvas& canvas, const Shape& shape, double scale)
{
	const double share = shape.anchor == Anchor::start ? 0.0 : shape.anchor == Anchor::middle ? 0.5 : 1.0;
	const double size = shape.size * scale;
	const auto [strokes, width] = strokesOf(shape.text);
	const glm::dvec2 origin = shape.points[0] * scale - glm::dvec2(share * width * size, 0.0);
	for (const Stroke& stroke : strokes)
	{
		std::vector<glm::dvec2> points = mapped(stroke, [&](const glm::dvec2& p) { return origin + p * size; });
		paintLine(canvas, points, false, 0.085 * size, shape.fill);
	}
}

void paint(Canvas& canvas, const Shape& shape, double scale)
{
	if (shape.kind == ShapeKind::circle)
	{
		return; // only svgText() draws them
	}
	if (shape.kind == ShapeKind::text)
	{
		paintText(canvas, shape, scale);
		return;
	}
	std::vector<glm::dvec2> points = shape.points;
	for (glm::dvec2& p : points)
	{
		p *= scale;
	}
	const bool closed = shape.kind == ShapeKind::polygon;
	if (closed)
	{
		canvas.fill(points, shape.fill);
	}
	if (shape.stroke.opacity > 0.0 && shape.stroke_width > 0.0)
	{
		paintLine(canvas, points, closed, shape.stroke_width * scale, shape.stroke);
	}
}

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
	std::string text;
	for (const glm::dvec2& p : shape.points)
	{
		text += (text.empty() ? "M" : "L") + lengthText(p.x) + " " + lengthText(p.y);
	}
	return text + (shape.kind == ShapeKind::polygon ? "Z" : "");
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

std::vector<uint8_t> rasterised(const Drawing& drawing)
{
	Canvas canvas(drawing.width_px * kSupersampling, drawing.height_px * kSupersampling, drawing.background);
	for (const Shape& shape : drawing.shapes)
	{
		paint(canvas, shape, kSupersampling);
	}
	return canvas.reduced();
}

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
