// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/reference.h"

#include "core/decimal.h"
#include "core/file.h"
#include "core/lists.h"
#include "core/words.h"
#include "scene/level.h"
#include "scene/load.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

namespace nook
{
namespace
{

constexpr std::string_view kHeader = "x,y,z,nx,ny,nz";

std::string_view trimmed(std::string_view text)
{
	const std::size_t first = text.find_first_not_of(" \t\r");
	return first == std::string_view::npos ? std::string_view() : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Six finite numbers, or nothing.
std::optional<std::array<double, 6>> parseRow(std::string_view row)
{
	std::array<double, 6> numbers{};
	for (std::size_t i = 0; i < 6; ++i)
	{
		const std::size_t comma = row.find(',');
		if ((comma == std::string_view::npos) != (i == 5))
		{
			return std::nullopt;
		}
		std::string_view field = trimmed(row.substr(0, comma));
		field.remove_prefix(field.starts_with('+') && !field.starts_with("+-") ? 1 : 0); // from_chars does not accept it
		const std::from_chars_result result = std::from_chars(field.data(), field.data() + field.size(), numbers[i]);
		if (result.ec != std::errc{} || result.ptr != field.data() + field.size() || !std::isfinite(numbers[i]))
		{
			return std::nullopt;
		}
		row.remove_prefix(comma == std::string_view::npos ? row.size() : comma + 1);
	}
	return numbers;
}

// Possible error of a coordinate: usually of a 32-bit number, but map coordinates would be millimetres apart.
double roundingOf(double size_m)
{
	return size_m * (size_m < kLarge_m ? 0x1p-24 : 0x1p-53);
}

std::string rowOf(const ReferenceValue& value)
{
	return numberText(value.visibility) + "," + numberText(value.standard_error) + "," + std::to_string(value.rays);
}

} // namespace

std::optional<ReferencePoint> pointOf(glm::dvec3 position, glm::dvec3 normal)
{
	const double length = glm::length(normal);
	const glm::dvec3 size = glm::abs(position);
	const bool near = size.x <= kFarthest_m && size.y <= kFarthest_m && size.z <= kFarthest_m; // false for NaN
	if (!(length > 0.0) || !std::isfinite(length) || !near)
	{
		return std::nullopt;
	}
	return ReferencePoint{position, normal / length, roundingOf(size.x) + roundingOf(size.y) + roundingOf(size.z)};
}

std::vector<ReferencePoint> readPoints(const std::string& path)
{
	const std::string text = readFile(path);
	std::string_view rest = text;
	std::vector<ReferencePoint> points;
	bool first = true;
	for (std::size_t line = 1; !rest.empty(); ++line)
	{
		const std::size_t end = rest.find('\n');
		const std::string_view row = trimmed(rest.substr(0, end));
		rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
		std::string names(row);
		std::erase_if(names, [](char c) { return c == ' ' || c == '\t' || c == '"'; });
		const bool header = first && names == kHeader;
		if (row.empty() || row.front() == '#' || header)
		{
			first = first && !header;
			continue;
		}
		first = false;
		const std::optional<std::array<double, 6>> n = parseRow(row);
		const std::optional<ReferencePoint> point =
			n ? pointOf({(*n)[0], (*n)[1], (*n)[2]}, {(*n)[3], (*n)[4], (*n)[5]}) : std::nullopt;
		if (!point)
		{
			refuseInput(path + ":" + std::to_string(line), "'" + std::string(row.substr(0, 80)) + "'",
						"six numbers " + std::string(kHeader) + ", positions to 1e15 m and a normal that is not 0");
		}
		points.push_back(*point);
	}
	refuseInputIf(points.empty(), path, "no point", "rows " + std::string(kHeader));
	return points;
}

std::string visibilityExr(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes)
{
	Image image{width_px, height_px, {"visibility", "standard_error"}, {}, notes, {}};
	image.values.reserve(2 * values.size());
	for (const ReferenceValue& value : values)
	{
		image.values.insert(image.values.end(), {static_cast<float>(value.visibility), static_cast<float>(value.standard_error)});
	}
	return exrBytes(std::move(image));
}

std::string bentExr(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes)
{
	Image image{width_px, height_px, {"bent.X", "bent.Y", "bent.Z", "cone_angle", "standard_error", "visibility"}, {}, notes, {}};
	image.values.reserve(6 * values.size());
	for (const ReferenceValue& value : values)
	{
		image.values.insert(image.values.end(),
							{value.bent.x, value.bent.y, value.bent.z, static_cast<float>(coneAngle(value.visibility)),
							 static_cast<float>(value.standard_error), static_cast<float>(value.visibility)});
	}
	return exrBytes(std::move(image));
}

std::string bentExr(int width_px, int height_px, std::span<const glm::vec3> bent, std::span<const float> visibility,
					const Notes& notes)
{
	Image image{width_px, height_px, {"bent.X", "bent.Y", "bent.Z", "cone_angle", "visibility"}, {}, notes, {}};
	image.values.reserve(5 * visibility.size());
	for (std::size_t i = 0; i < visibility.size(); ++i)
	{
		const auto cone = static_cast<float>(coneAngle(static_cast<double>(visibility[i])));
		image.values.insert(image.values.end(), {bent[i].x, bent[i].y, bent[i].z, cone, visibility[i]});
	}
	return exrBytes(std::move(image));
}

std::string bentPng(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes)
{
	return bentPng(width_px, height_px,
				   mapped(values, [](const ReferenceValue& value) { return value.rays == 0 ? glm::vec3(0.0F) : value.bent; }),
				   notes);
}

std::string bentPng(int width_px, int height_px, std::span<const glm::vec3> bent, const Notes& notes)
{
	std::vector<uint8_t> rgb;
	rgb.reserve(3 * bent.size());
	for (const glm::vec3& direction : bent)
	{
		for (int axis = 0; axis < 3; ++axis)
		{
			const float level = direction == glm::vec3(0.0F) ? 0.0F : 127.5F + 127.5F * direction[axis];
			rgb.push_back(static_cast<uint8_t>(std::floor(level + 0.5F)));
		}
	}
	return pngBytes(width_px, height_px, rgb, notes);
}

std::string bentCsv(std::span<const ReferenceValue> values)
{
	std::string text = "visibility,standard_error,rays,bx,by,bz,cone_angle\n";
	for (const ReferenceValue& value : values)
	{
		text += rowOf(value);
		for (int axis = 0; axis < 3; ++axis)
		{
			text += "," + numberText(static_cast<double>(value.bent[axis]));
		}
		text += "," + numberText(coneAngle(value.visibility)) + "\n";
	}
	return text;
}

std::string visibilityExr(int width_px, int height_px, std::span<const float> visibility, const Notes& notes)
{
	return exrBytes({width_px, height_px, {"visibility"}, {visibility.begin(), visibility.end()}, notes, {}});
}

std::string visibilityPng(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes)
{
	return visibilityPng(width_px, height_px,
						 mapped(values, [](const ReferenceValue& value) { return static_cast<float>(value.visibility); }), notes);
}

std::string visibilityPng(int width_px, int height_px, std::span<const float> visibility, const Notes& notes)
{
	std::vector<uint8_t> rgb;
	rgb.reserve(3 * visibility.size());
	for (const float v : visibility)
	{
		const auto gray = static_cast<uint8_t>(std::floor(255.0F * std::clamp(v, 0.0F, 1.0F) + 0.5F));
		rgb.insert(rgb.end(), 3, gray);
	}
	return pngBytes(width_px, height_px, rgb, notes);
}

std::string visibilityCsv(std::span<const ReferenceValue> values)
{
	return "visibility,standard_error,rays\n" +
		   joinedText(values, "", [](const ReferenceValue& value) { return rowOf(value) + "\n"; });
}

} // namespace nook
