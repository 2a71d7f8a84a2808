// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/drawing.h"

#include "core/math.h"
#include "core/text.h"
#include "image/picture_parts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace nook
{
namespace
{

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
		addDot(drawing, frame.at(glm::dvec2(p)), dotRadius(frame, pattern.count()));
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
		addDot(drawing, frame.at(p.y * along), dotRadius(frame, std::max<std::size_t>(pattern.count(), 8)));
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
			addDot(drawing, frame.at(glm::dvec2(seen)), dotRadius(frame, (pattern.count() + 1) / 2));
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
	std::vector<std::size_t> order(pattern.count());
	std::iota(order.begin(), order.end(), std::size_t{0});
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
		addLegend(drawing, {480.0, 536.0}, 200.0, scale);
		return drawing;
	}
	label(left, "points, size by weight");
	label(right, "cells, cut at z = 0");
	addBeads(drawing, left, pattern, front, scale);
	addCells(drawing, right, sectionPolygons(pattern), pattern, scale);
	addShells(drawing, {150.0, 546.0}, 200.0, pattern);
	addLegend(drawing, {710.0, 538.0}, 200.0, scale);
	return drawing;
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
	addLegend(drawing, {256.0, 536.0}, 200.0, scale);
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
	if (tile.domain == Domain::slice)
	{
		return drawing; // all weights are equal
	}
	addLegend(drawing, {340.0, 748.0}, 200.0, scale);
	return drawing;
}

} // namespace nook
