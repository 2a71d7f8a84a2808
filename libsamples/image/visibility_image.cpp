// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/visibility_image.h"

#include "core/lists.h"
#include "core/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

bool isGray(const Image& image, int r, int g, int b)
{
	const auto isColoured = [&](std::size_t i)
	{
		return image.at(i, r) != image.at(i, g) || image.at(i, r) != image.at(i, b);
	};
	return indicesWhere(image.values.size() / image.channels.size(), isColoured).empty();
}

struct Choice
{
	int index = -1;
	std::string name;
};

Choice chosen(const Image& image, const std::string& path, const std::string& wanted)
{
	if (!wanted.empty())
	{
		const int index = image.channel(wanted);
		refuseInputIf(index < 0, path + ": channels", joinedText(image.channels, ", "), wanted + " among them");
		return {index, wanted};
	}
	if (const int index = image.channel("visibility"); index >= 0)
	{
		return {index, "visibility"};
	}
	const auto others = std::count_if(image.channels.begin(), image.channels.end(), [](const std::string& c) { return c != "A"; });
	if (others == 1)
	{
		const int index = image.channels.front() == "A" && image.channels.size() > 1 ? 1 : 0;
		return {index, image.channels[static_cast<std::size_t>(index)]};
	}
	if (const int index = image.channel("Y"); index >= 0)
	{
		return {index, "Y"};
	}
	const int r = image.channel("R");
	const int g = image.channel("G");
	const int b = image.channel("B");
	if (r >= 0 && g >= 0 && b >= 0 && isGray(image, r, g, b))
	{
		return {r, "R,G,B"};
	}
	refuseInput(path + ": channels", joinedText(image.channels, ", "),
				"visibility, a single one, Y, or R, G, B that are all gray (channel picks one)");
}

std::string pixelText(const Image& image, std::size_t pixel)
{
	const auto width = static_cast<std::size_t>(image.width_px);
	return ", pixel " + std::to_string(pixel % width) + "," + std::to_string(pixel / width);
}

std::vector<float> finiteValues(const Image& image, const std::string& path, const Choice& choice)
{
	std::vector<float> values(image.values.size() / image.channels.size());
	for (std::size_t i = 0; i < values.size(); ++i)
	{
		values[i] = image.at(i, choice.index);
		if (!std::isfinite(values[i]))
		{
			refuseInput(path + ": channel " + choice.name + pixelText(image, i), std::isnan(values[i]) ? "NaN" : "infinity",
						"a finite number");
		}
	}
	return values;
}

} // namespace

VisibilityImage visibilityOf(const Image& image, const std::string& path, const std::string& wanted)
{
	const Choice choice = chosen(image, path, wanted);
	VisibilityImage result{path, image.width_px, image.height_px, choice.name, finiteValues(image, path, choice), {}};
	if (const int index = image.channel("standard_error"); index >= 0 && index != choice.index)
	{
		result.standard_error = finiteValues(image, path, {index, "standard_error"});
	}
	return result;
}

std::optional<double> ownUncertainty(const VisibilityImage& image, std::span<const uint8_t> counted)
{
	PixelTally sum;
	for (std::size_t i = 0; i < image.standard_error.size(); ++i)
	{
		if (counts(counted, i))
		{
			const auto error = static_cast<double>(image.standard_error[i]);
			sum.add(error * error);
		}
	}
	return sum.count == 0 ? std::nullopt : std::optional(std::sqrt(sum.sum / static_cast<double>(sum.count)));
}

BentImage bentOf(const Image& image, const std::string& path)
{
	for (const std::string name : {"bent", "N"})
	{
		const std::array<int, 3> axes{image.channel(name + ".X"), image.channel(name + ".Y"), image.channel(name + ".Z")};
		if (std::count(axes.begin(), axes.end(), -1) > 0)
		{
			continue;
		}
		BentImage result{path, image.width_px, image.height_px, name};
		for (std::size_t i = 0; i < image.values.size() / image.channels.size(); ++i)
		{
			const glm::dvec3 way(image.at(i, axes[0]), image.at(i, axes[1]), image.at(i, axes[2]));
			const double length = glm::length(way);
			if (!std::isfinite(length))
			{
				refuseInput(path + ": channels " + name + ".X to Z" + pixelText(image, i), "no direction", "finite numbers");
			}
			result.bent.push_back(length > 0.0 ? way / length : way);
		}
		return result;
	}
	refuseInput(path + ": channels", joinedText(image.channels, ", "), "bent.X, bent.Y and bent.Z, or N.X, N.Y and N.Z");
}

BentAngles anglesBetween(const BentImage& test, const BentImage& reference, std::span<const uint8_t> counted)
{
	checkSameSize(test, reference);
	BentAngles result;
	std::vector<double> angles;
	double sum = 0.0;
	double squares = 0.0;
	for (std::size_t i = 0; i < test.bent.size(); ++i)
	{
		const glm::dvec3& a = test.bent[i];
		const glm::dvec3& b = reference.bent[i];
		if (!counts(counted, i) || a == glm::dvec3(0.0) || b == glm::dvec3(0.0))
		{
			continue;
		}
		// Accurate for small angles too (W. Kahan).
		const double angle = 2.0 * std::atan2(glm::length(a - b), glm::length(a + b)) * 180.0 / kPi;
		sum += angle;
		squares += angle * angle;
		if (angles.empty() || angle > result.max_deg)
		{
			result.max_deg = angle;
			result.worst_x = static_cast<int>(i % static_cast<std::size_t>(test.width_px));
			result.worst_y = static_cast<int>(i / static_cast<std::size_t>(test.width_px));
		}
		angles.push_back(angle);
	}
	refuseInputIf(angles.empty(), test.path, "no direction where " + reference.path + " has one", "some");
	result.pixels = angles.size();
	const auto count = static_cast<double>(angles.size());
	result.mean_deg = sum / count;
	result.rmse_deg = std::sqrt(squares / count);
	const auto place = angles.begin() + static_cast<std::ptrdiff_t>((angles.size() - 1) * 95 / 100);
	std::nth_element(angles.begin(), place, angles.end());
	result.p95_deg = *place;
	return result;
}

} // namespace nook
