// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/bent_image.h"

#include "core/error.h"
#include "core/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

std::string sizeText(const BentImage& image)
{
	return std::to_string(image.width_px) + "x" + std::to_string(image.height_px) + " pixels";
}

} // namespace

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
				const auto width = static_cast<std::size_t>(image.width_px);
				throw Error(ExitCode::invalid_input, path + ": channels " + name + ".X to Z, pixel " + std::to_string(i % width) +
														 "," + std::to_string(i / width) +
														 ": found no direction, expected finite numbers");
			}
			result.bent.push_back(length > 0.0 ? way / length : way);
		}
		return result;
	}
	std::string names;
	for (const std::string& channel : image.channels)
	{
		names += (names.empty() ? "" : ", ") + channel;
	}
	throw Error(ExitCode::invalid_input,
				path + ": channels: found " + names + ", expected bent.X, bent.Y and bent.Z, or N.X, N.Y and N.Z");
}

BentAngles anglesBetween(const BentImage& test, const BentImage& reference, std::span<const uint8_t> counted)
{
	if (test.width_px != reference.width_px || test.height_px != reference.height_px)
	{
		throw Error(ExitCode::invalid_input,
					test.path + ": size: found " + sizeText(test) + ", expected " + sizeText(reference) + " as " + reference.path);
	}
	BentAngles result;
	std::vector<double> angles;
	double sum = 0.0;
	double squares = 0.0;
	for (std::size_t i = 0; i < test.bent.size(); ++i)
	{
		const glm::dvec3& a = test.bent[i];
		const glm::dvec3& b = reference.bent[i];
		if ((!counted.empty() && counted[i] == 0) || a == glm::dvec3(0.0) || b == glm::dvec3(0.0))
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
	if (angles.empty())
	{
		throw Error(ExitCode::invalid_input,
					test.path + ": found no direction where " + reference.path + " has one, expected some");
	}
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
