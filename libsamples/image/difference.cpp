// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/drawing.h"

#include "core/image.h"
#include "core/text.h"
#include "image/picture_parts.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

constexpr int kLeastWidth = 360; // pixels: minimum for the legend's text
constexpr int kGreatestFactor = 32;
constexpr int kLegendHeight = 64;
constexpr Colour kNotCounted = colourOf(0x9a9a9a);

// `share` is −1 to 1. The blue and red are distinguishable for the colour-blind, and both darken evenly from white, so that size
// reads before sign.
Colour differenceColour(double share)
{
	constexpr std::array kDarker{colourOf(0xffffff), colourOf(0x8cbfe6), colourOf(0x2a6fbb), colourOf(0x08306b)};
	constexpr std::array kLighter{colourOf(0xffffff), colourOf(0xf7b38c), colourOf(0xd3482f), colourOf(0x67000d)};
	const auto& stops = share < 0.0 ? kDarker : kLighter;
	const double at = 3.0 * std::min(std::fabs(share), 1.0);
	const auto stop = std::min<std::size_t>(static_cast<std::size_t>(at), 2);
	return mixed(stops[stop], stops[stop + 1], at - static_cast<double>(stop));
}

uint8_t byteOf(double channel)
{
	return static_cast<uint8_t>(std::floor(255.0 * channel + 0.5));
}

void addSlice(Drawing& drawing, double left, double right, double top, double bottom, const Colour& fill)
{
	Shape shape;
	shape.points = {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
	shape.fill = fill;
	drawing.shapes.push_back(std::move(shape));
}

Drawing legend(int width_px, double range, bool all_count)
{
	Drawing drawing;
	drawing.width_px = width_px;
	drawing.height_px = kLegendHeight;
	drawing.background = kBackground;
	const double half = std::min(0.5 * width_px - 30.0, 300.0);
	const double centre = 0.5 * width_px;
	constexpr int kSlices = 121;
	for (int i = 0; i < kSlices; ++i)
	{
		const double left = centre + half * (2.0 * i / kSlices - 1.0);
		addSlice(drawing, left, left + 2.0 * half / kSlices + 0.5, 10.0, 22.0, differenceColour(2.0 * i / (kSlices - 1) - 1.0));
	}
	for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0})
	{
		const double x = centre + half * share;
		addLine(drawing, {{x, 22.0}, {x, 26.0}}, kBorder, 1.0);
		addText(drawing, {x, 39.0}, 11.0, kInk, (share > 0.0 ? "+" : "") + roundedText(share * range, 3), Anchor::middle);
	}
	addText(drawing, {centre, 56.0}, 11.0, kSoftInk,
			std::string("test - reference (blue: test darker, red: lighter)") + (all_count ? "" : ", gray: not counted"),
			Anchor::middle);
	return drawing;
}

std::vector<uint8_t> colours(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
							 double range)
{
	std::vector<uint8_t> rgb;
	rgb.reserve(3 * test.values.size());
	for (std::size_t i = 0; i < test.values.size(); ++i)
	{
		const double difference = static_cast<double>(test.values[i]) - static_cast<double>(reference.values[i]);
		const Colour colour = counted.empty() || counted[i] != 0 ? differenceColour(difference / range) : kNotCounted;
		for (const double channel : {colour.red, colour.green, colour.blue})
		{
			rgb.push_back(byteOf(channel));
		}
	}
	return rgb;
}

} // namespace

double differenceRange(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted)
{
	std::vector<double> sizes;
	for (std::size_t i = 0; i < test.values.size(); ++i)
	{
		if (counted.empty() || counted[i] != 0)
		{
			sizes.push_back(std::fabs(static_cast<double>(test.values[i]) - static_cast<double>(reference.values[i])));
		}
	}
	if (sizes.empty())
	{
		return 1.0;
	}
	const auto at = sizes.begin() + static_cast<std::ptrdiff_t>((99 * sizes.size() + 99) / 100 - 1);
	std::nth_element(sizes.begin(), at, sizes.end());
	for (const double round : {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5})
	{
		if (*at <= round)
		{
			return round;
		}
	}
	return 1.0;
}

std::string differencePng(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
						  double range, const Notes& notes)
{
	assert(test.width_px == reference.width_px && test.height_px == reference.height_px && range > 0.0);
	const int factor = std::clamp(kLeastWidth / test.width_px, 1, kGreatestFactor);
	const int width = std::max(test.width_px * factor, kLeastWidth);
	const int height = test.height_px * factor;
	const std::vector<uint8_t> picture = colours(test, reference, counted, range);
	const bool all_count = std::find(counted.begin(), counted.end(), uint8_t{0}) == counted.end();
	const std::vector<uint8_t> strip = rasterised(legend(width, range, all_count));
	const std::array<uint8_t, 3> paper{byteOf(kBackground.red), byteOf(kBackground.green), byteOf(kBackground.blue)};
	std::vector<uint8_t> rgb;
	rgb.reserve(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height) + strip.size());
	const int margin = (width - test.width_px * factor) / 2;
	for (int y = 0; y < height; ++y)
	{
		for (int x = 0; x < width; ++x)
		{
			const int from = (x - margin) / factor;
			const bool inside = x >= margin && from < test.width_px;
			const auto pixel = static_cast<std::ptrdiff_t>(3) * (y / factor * test.width_px + (inside ? from : 0));
			const auto first = inside ? picture.begin() + pixel : picture.end();
			inside ? rgb.insert(rgb.end(), first, first + 3) : rgb.insert(rgb.end(), paper.begin(), paper.end());
		}
	}
	rgb.insert(rgb.end(), strip.begin(), strip.end());
	return pngBytes(width, height + kLegendHeight, rgb, notes);
}

} // namespace nook
