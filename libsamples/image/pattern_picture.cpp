// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image.h"
#include "core/lists.h"
#include "core/math.h"
#include "image/drawing.h"
#include "pattern/cells.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

namespace nook
{
namespace
{

constexpr Colour kBackground = colourOf(0xfcfbf8);
constexpr Colour kInk = colourOf(0x1f2733);
constexpr Colour kSoftInk = colourOf(0x667080);
constexpr Colour kBorder = colourOf(0x4a5568);
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

	Colour colour(double deviation) const
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
};

// weight · count − 1.
double deviationOf(const Pattern& pattern, std::size_t i)
{
	return pattern.weights[i] * static_cast<double>(pattern.count()) - 1.0;
}

// A round range that covers all deviations of the patterns.
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

void addText(Drawing& drawing, const glm::dvec2& at, double size, const Colour& colour, const std::string& text,
			 Anchor anchor = Anchor::start)
{
	drawing.shapes.push_back(
		{.kind = ShapeKind::text, .points = {at}, .fill = colour, .size = size, .anchor = anchor, .text = text});
}

void addCircle(Drawing& drawing, const glm::dvec2& centre, double radius, const Colour& fill, const Colour& stroke = {},
			   double stroke_width = 0.0)
{
	drawing.shapes.push_back({.kind = ShapeKind::circle,
							  .points = {centre},
							  .fill = fill,
							  .stroke = stroke,
							  .stroke_width = stroke_width,
							  .radius = radius});
}

void addLine(Drawing& drawing, std::vector<glm::dvec2> points, const Colour& stroke, double width)
{
	drawing.shapes.push_back({.kind = ShapeKind::line, .points = std::move(points), .stroke = stroke, .stroke_width = width});
}

// Radius in pixels of each dot for `count` points in a frame.
double dotRadius(const PictureFrame& frame, std::size_t count)
{
	return std::min(0.03, 0.14 / std::sqrt(static_cast<double>(count))) * frame.radius_px;
}

// Cells coloured by weight, inside their circle; one polygon per point.
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
		Shape& shape = drawing.shapes.emplace_back();
		shape.points = mapped(cells[i], [&frame](const glm::dvec2& corner) { return frame.at(corner); });
		shape.fill = scale.colour(deviationOf(pattern, i));
		shape.stroke = kBorder;
		shape.stroke_width = width;
	}
	addCircle(drawing, frame.centre, frame.radius_px, {}, kInk, std::max(1.0, 0.008 * frame.radius_px));
}

// A colour bar with labelled ends, centred below `top`.
void addLegend(Drawing& drawing, const glm::dvec2& top, const WeightScale& scale)
{
	const double width = 200.0;
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
		const double right = left + width * (i + 1) / steps + (i + 1 < steps ? 0.5 : 0.0); // overlaps the next one to avoid seams
		const double from = left + width * i / steps;
		drawing.shapes.push_back({.points = {{from, top.y}, {right, top.y}, {right, top.y + height}, {from, top.y + height}},
								  .fill = scale.colour(least + (scale.range - least) * ((i + 0.5) / steps))});
	}
	const double text_y = top.y + height - 1.0;
	addText(drawing, {left - 8.0, text_y}, 12.0, kSoftInk, percentText(least), Anchor::end);
	addText(drawing, {left + width + 8.0, text_y}, 12.0, kSoftInk, percentText(scale.range));
	addText(drawing, {top.x, top.y + height + 16.0}, 12.0, kSoftInk, "weight against the mean", Anchor::middle);
}

constexpr int kHeight = 576;
constexpr double kTop = 306.0; // centre of the frames
constexpr double kRadius = 198.0;

// Rows: picture x, picture y, direction to the viewer. A view from above and from a side that no symmetric pattern is aligned with.
glm::dmat3 tiltedView()
{
	const SinCos turn = sinCosOf(0.41);
	const SinCos tilt = sinCosOf(0.37);
	const glm::dvec3 right{turn.cos, turn.sin, 0.0};
	const glm::dvec3 towards{turn.sin * tilt.cos, -turn.cos * tilt.cos, tilt.sin};
	return {right, glm::cross(towards, right), towards};
}

std::string sampleWord(Domain domain, std::size_t count)
{
	const char* word = domain == Domain::disk    ? " line"
					   : domain == Domain::ball  ? " point"
					   : domain == Domain::slice ? " slice"
												 : " direction";
	return std::to_string(count) + word + (count == 1 ? "" : "s");
}

std::string titleOf(const Pattern& pattern, const Recipe* recipe)
{
	std::string title = std::string(nameOf(pattern.domain)) + ", " + sampleWord(pattern.domain, pattern.count());
	if (recipe != nullptr)
	{
		const Recipe plain;
		title += recipe->centre ? ", centre" : "";
		title += recipe->symmetric ? ", symmetric" : "";
		title += recipe->method != plain.method ? ", " + std::string(nameOf(recipe->method)) : "";
		title += recipe->minimise != plain.minimise ? ", least " + std::string(nameOf(recipe->minimise)) : "";
	}
	return title;
}

std::string measureLine(const Quality& quality)
{
	const auto part = [](const char* name, double value)
	{
		return std::string(name) + " " + (std::fabs(value) < 5e-7 ? "0" : roundedText(value, 3));
	};
	std::string line = part("plane", quality.plane) + "    " + part("noise", quality.noise);
	line += quality.cliff.has_value() ? "    " + part("cliff", *quality.cliff) : "";
	line += quality.centre.has_value() ? "    " + part("centre", *quality.centre) : "";
	return line + (quality.cap.has_value() ? "    " + part("cap", *quality.cap) : "");
}

Drawing sheet(int width_px, int height_px, const std::string& title, const std::string& measures)
{
	Drawing drawing;
	drawing.width_px = width_px;
	drawing.height_px = height_px;
	drawing.background = kBackground;
	drawing.title = title;
	addText(drawing, {0.5 * width_px, 38.0}, 20.0, kInk, title, Anchor::middle);
	addText(drawing, {0.5 * width_px, 62.0}, 13.0, kSoftInk, measures, Anchor::middle);
	return drawing;
}

void addDots(Drawing& drawing, const PictureFrame& frame, const Pattern& pattern)
{
	for (const glm::dvec3& p : pattern.points)
	{
		addCircle(drawing, frame.at(glm::dvec2(p)), dotRadius(frame, pattern.count()), kInk);
	}
}

// Draws each slice as a line at its azimuth, with a dot whose distance shows its jitter as a fraction of a step.
void addSlices(Drawing& drawing, const PictureFrame& frame, const Pattern& pattern)
{
	addCircle(drawing, frame.centre, frame.radius_px, colourOf(0xf3f1eb), kInk, 1.6);
	for (const glm::dvec3& p : pattern.points)
	{
		const SinCos turn = sinCosOf(kPi * p.x);
		const glm::dvec2 along(turn.cos, turn.sin);
		addLine(drawing, {frame.at(-along), frame.at(along)}, kBorder, 1.2);
		addCircle(drawing, frame.at(p.y * along), dotRadius(frame, std::max<std::size_t>(pattern.count(), 8)), kInk);
	}
}

void addSphereView(Drawing& drawing, const PictureFrame& frame, const Pattern& pattern, const glm::dmat3& view,
				   const WeightScale& scale)
{
	addCells(drawing, frame, spherePolygons(pattern, view), pattern, scale);
	for (const glm::dvec3& p : pattern.points)
	{
		const glm::dvec3 seen = p * view;
		if (seen.z > 0.0)
		{
			addCircle(drawing, frame.at(glm::dvec2(seen)), dotRadius(frame, (pattern.count() + 1) / 2), kInk);
		}
	}
}

// Draws one point of the ball as a small sphere, paler with distance.
void addBead(Drawing& drawing, const PictureFrame& frame, const glm::dvec3& seen, double radius, const Colour& colour)
{
	const double distance = std::clamp(0.5 - 0.5 * seen.z, 0.0, 1.0);
	const glm::dvec2 at = frame.at(glm::dvec2(seen));
	const double r = radius * frame.radius_px;
	const auto faded = [&](const Colour& c)
	{
		return mixed(c, kBackground, 0.72 * distance);
	};
	addCircle(drawing, at, r, faded(mixed(colour, kInk, 0.3)), faded(kInk), std::clamp(0.06 * r, 0.3, 1.1));
	if (r > 1.5)
	{
		addCircle(drawing, at + glm::dvec2(-0.08, -0.1) * r, 0.8 * r, faded(mixed(colour, kInk, 0.12)));
		addCircle(drawing, at + glm::dvec2(-0.15, -0.19) * r, 0.58 * r, faded(colour));
		addCircle(drawing, at + glm::dvec2(-0.27, -0.33) * r, 0.24 * r, faded(mixed(colour, colourOf(0xffffff), 0.7)));
	}
}

void addBeads(Drawing& drawing, const PictureFrame& frame, const Pattern& pattern, const glm::dmat3& view, const WeightScale& scale)
{
	addCircle(drawing, frame.centre, frame.radius_px, colourOf(0xf3f1eb), kInk, 1.6);
	std::vector<std::size_t> order = countingFrom(std::size_t{0}, pattern.count());
	const auto depth = [&](std::size_t i)
	{
		return (pattern.points[i] * view).z;
	};
	std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return depth(a) < depth(b); });
	for (const std::size_t i : order)
	{
		const double radius = 0.36 * powOf(std::max(1e-12, pattern.weights[i]), 1.0 / 3.0); // 1 at full volume
		addBead(drawing, frame, pattern.points[i] * view, radius, scale.colour(deviationOf(pattern, i)));
	}
}

// Draws the points' distances from the centre along an axis; equal distances are stacked, which shows the shells.
void addShells(Drawing& drawing, const glm::dvec2& left, double width, const Pattern& pattern)
{
	const int places = 120;
	std::vector<int> stacked(static_cast<std::size_t>(places) + 1, 0);
	for (const glm::dvec3& p : pattern.points)
	{
		++stacked[static_cast<std::size_t>(std::floor(std::min(1.0, glm::length(p)) * places + 0.5))];
	}
	const int highest = *std::max_element(stacked.begin(), stacked.end());
	for (int i = 0; i <= places; ++i)
	{
		const double height = 26.0 * stacked[static_cast<std::size_t>(i)] / std::max(highest, 4);
		if (height > 0.0)
		{
			const double x = left.x + width * i / places;
			addLine(drawing, {{x, left.y}, {x, left.y - height}}, kInk, 2.0);
		}
	}
	addLine(drawing, {left, {left.x + width, left.y}}, kSoftInk, 1.0);
	addText(drawing, {left.x - 10.0, left.y + 4.0}, 12.0, kSoftInk, "0", Anchor::end);
	addText(drawing, {left.x + width + 10.0, left.y + 4.0}, 12.0, kSoftInk, "1");
	addText(drawing, {left.x + 0.5 * width, left.y + 18.0}, 12.0, kSoftInk, "points by distance from the centre", Anchor::middle);
}

Drawing pairPicture(const Pattern& pattern, const std::string& title, const std::string& measures, const WeightScale& scale)
{
	Drawing drawing = sheet(960, kHeight, title, measures);
	const PictureFrame left{{250.0, kTop}, kRadius};
	const PictureFrame right{{710.0, kTop}, kRadius};
	const glm::dmat3 front = tiltedView();
	const auto label = [&](const PictureFrame& frame, const char* text)
	{
		addText(drawing, {frame.centre.x, frame.centre.y - frame.radius_px - 12.0}, 13.0, kSoftInk, text, Anchor::middle);
	};
	if (pattern.domain == Domain::sphere)
	{
		label(left, "front");
		label(right, "back");
		addSphereView(drawing, left, pattern, front, scale);
		addSphereView(drawing, right, pattern, {-front[0], front[1], -front[2]}, scale);
		addLegend(drawing, {480.0, 536.0}, scale);
		return drawing;
	}
	label(left, "points, size by weight");
	label(right, "cells, cut at z = 0");
	addBeads(drawing, left, pattern, front, scale);
	addCells(drawing, right, sectionPolygons(pattern), pattern, scale);
	addShells(drawing, {150.0, 546.0}, 200.0, pattern);
	addLegend(drawing, {710.0, 538.0}, scale);
	return drawing;
}

constexpr int kLeastWidth = 360; // pixels: minimum for the legend's values
constexpr int kGreatestFactor = 32;
constexpr int kLegendHeight = 48;
constexpr Colour kNotCounted = colourOf(0x9a9a9a);

// `share`: −1 to 1. The colour-blind can tell this blue and red, and both darken evenly from white.
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

void append(std::vector<uint8_t>& rgb, const Colour& colour)
{
	for (const double channel : {colour.red, colour.green, colour.blue})
	{
		rgb.push_back(byteOf(channel));
	}
}

// Characters of three columns and five rows, as bits from the upper left one.
constexpr std::string_view kCharacters = "0123456789.-+e";
constexpr std::array<unsigned, 14> kCharacterBits{0x7b6f, 0x2c97, 0x73e7, 0x73cf, 0x5bc9, 0x79cf, 0x79ef,
												  0x7249, 0x7bef, 0x7bcf, 0x0002, 0x01c0, 0x05d0, 0x7be7};

// The colours from −range to +range, with five values below.
std::vector<uint8_t> legend(int width_px, double range)
{
	std::vector<Colour> pixels(static_cast<std::size_t>(width_px * kLegendHeight), kBackground);
	const auto paint = [&](int x, int y, int size, const Colour& colour)
	{
		for (int i = 0; i < size * size; ++i)
		{
			pixels[static_cast<std::size_t>((y + i / size) * width_px + x + i % size)] = colour;
		}
	};
	const int half = std::min(width_px / 2 - 30, 300);
	for (int i = 0; i <= 2 * half * 12; ++i)
	{
		paint(width_px / 2 - half + i / 12, 10 + i % 12, 1, differenceColour(static_cast<double>(i / 12) / half - 1.0));
	}
	for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0})
	{
		const int x = width_px / 2 + static_cast<int>(half * share);
		const std::string text = (share > 0.0 ? "+" : "") + roundedText(share * range, 3);
		paint(x, 23, 2, kBorder);
		for (std::size_t i = 0; i < 15 * text.size(); ++i)
		{
			const int bit = static_cast<int>(i % 15);
			if ((kCharacterBits[std::min(kCharacters.find(text[i / 15]), kCharacterBits.size() - 1)] >> (14 - bit) & 1U) != 0)
			{
				paint(x - 4 * static_cast<int>(text.size()) + 8 * static_cast<int>(i / 15) + 2 * (bit % 3), 30 + 2 * (bit / 3), 2,
					  kInk);
			}
		}
	}
	std::vector<uint8_t> rgb;
	for (const Colour& colour : pixels)
	{
		append(rgb, colour);
	}
	return rgb;
}

std::vector<uint8_t> colours(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
							 double range)
{
	std::vector<uint8_t> rgb;
	rgb.reserve(3 * test.values.size());
	for (std::size_t i = 0; i < test.values.size(); ++i)
	{
		const double difference = static_cast<double>(test.values[i]) - static_cast<double>(reference.values[i]);
		append(rgb, counted.empty() || counted[i] != 0 ? differenceColour(difference / range) : kNotCounted);
	}
	return rgb;
}

} // namespace

Drawing patternPicture(const Pattern& pattern, const Recipe* recipe, const Quality& quality)
{
	const WeightScale scale = weightScaleOf({&pattern, 1});
	const std::string title = titleOf(pattern, recipe);
	if (!isPlanar(pattern.domain))
	{
		return pairPicture(pattern, title, measureLine(quality), scale);
	}
	Drawing drawing = sheet(512, kHeight, title, measureLine(quality));
	const PictureFrame frame{{256.0, 298.0}, 214.0};
	addCells(drawing, frame, planeCellPolygons(pattern), pattern, scale);
	addDots(drawing, frame, pattern);
	addLegend(drawing, {256.0, 536.0}, scale);
	return drawing;
}

Drawing tilePicture(const PatternTile& tile, const TileQuality& quality)
{
	const std::string side = std::to_string(tile.size);
	const std::string title = side + " x " + side + " variants of " + std::string(nameOf(tile.domain)) + ", " +
							  sampleWord(tile.domain, tile.variants.front().count());
	std::string measures;
	const auto add = [&](const char* name, const std::optional<double>& value)
	{
		measures += value ? (measures.empty() ? "" : "    ") + std::string(name) + " " + roundedText(*value, 3) : "";
	};
	add("window", quality.window);
	add("each variant", quality.variant_plane);
	add("base pattern", quality.base_plane);
	const double pitch = 640.0 / tile.size;
	Drawing drawing = sheet(680, 800, title, measures);
	const WeightScale scale = weightScaleOf(tile.variants);
	for (std::size_t i = 0; i < tile.variants.size(); ++i)
	{
		const Pattern& variant = tile.variants[i];
		const auto column = static_cast<double>(i % static_cast<std::size_t>(tile.size));
		const auto row = static_cast<double>(i / static_cast<std::size_t>(tile.size));
		const PictureFrame frame{{20.0 + pitch * (column + 0.5), 84.0 + pitch * (row + 0.5)}, 0.455 * pitch};
		if (tile.domain == Domain::ball)
		{
			addBeads(drawing, frame, variant, tiltedView(), scale);
			continue;
		}
		if (tile.domain == Domain::slice)
		{
			addSlices(drawing, frame, variant);
			continue;
		}
		addCells(drawing, frame, planeCellPolygons(variant), variant, scale);
		addDots(drawing, frame, variant);
	}
	if (tile.domain != Domain::slice) // whose weights are equal
	{
		addLegend(drawing, {340.0, 748.0}, scale);
	}
	return drawing;
}

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
	constexpr std::array kRound{0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0};
	return *std::lower_bound(kRound.begin(), kRound.end() - 1, *at);
}

std::string differencePng(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
						  double range, const Notes& notes)
{
	assert(test.width_px == reference.width_px && test.height_px == reference.height_px && range > 0.0);
	const int factor = std::clamp(kLeastWidth / test.width_px, 1, kGreatestFactor);
	const int width = std::max(test.width_px * factor, kLeastWidth);
	const int height = test.height_px * factor;
	const std::vector<uint8_t> picture = colours(test, reference, counted, range);
	const std::vector<uint8_t> strip = legend(width, range);
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
			append(rgb, kBackground);
			std::copy_n(picture.begin() + pixel, inside ? 3 : 0, rgb.end() - 3);
		}
	}
	append(rgb, strip);
	return pngBytes(width, height + kLegendHeight, rgb, notes);
}

} // namespace nook
