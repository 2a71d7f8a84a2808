// SPDX-License-Identifier: GPL-3.0-or-later
// Rasterises shapes: each is cut into closed outlines, which are scan-converted on a grid four times as fine.
#include "core/image.h"
#include "core/math.h"
#include "image/drawing.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

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

void paintText(Canvas& canvas, const Shape& shape, double scale)
{
	const double share = shape.anchor == Anchor::start ? 0.0 : shape.anchor == Anchor::middle ? 0.5 : 1.0;
	const double size = shape.size * scale;
	const glm::dvec2 origin = shape.points[0] * scale - glm::dvec2(share * strokeWidthOf(shape.text) * size, 0.0);
	for (const Stroke& stroke : strokesOf(shape.text))
	{
		std::vector<glm::dvec2> points;
		for (const glm::dvec2& p : stroke)
		{
			points.push_back(origin + p * size);
		}
		paintLine(canvas, points, false, 0.085 * size, shape.fill);
	}
}

void paint(Canvas& canvas, const Shape& shape, double scale)
{
	if (shape.kind == ShapeKind::text)
	{
		paintText(canvas, shape, scale);
		return;
	}
	if (shape.kind == ShapeKind::circle)
	{
		return;
	}
	std::vector<glm::dvec2> points = shape.points;
	for (glm::dvec2& p : points)
	{
		p *= scale;
	}
	const bool stroked = shape.stroke.opacity > 0.0 && shape.stroke_width > 0.0;
	const double width = shape.stroke_width * scale;
	if (shape.kind == ShapeKind::polygon)
	{
		canvas.fill(points, shape.fill);
	}
	if (stroked)
	{
		paintLine(canvas, points, shape.kind == ShapeKind::polygon, width, shape.stroke);
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

} // namespace nook
