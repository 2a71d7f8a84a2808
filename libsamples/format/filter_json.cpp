// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/tile_json.h"

#include "core/decimal.h"
#include "core/file.h"
#include "core/system.h"
#include "core/text.h"

#include <cmath>
#include <filesystem>

namespace nook
{
namespace
{

// Returns the sum; throws if negative taps cancel it, which leaves no mean.
double checkedSum(const JsonValue& taps, const std::vector<double>& numbers)
{
	double sum = 0.0;
	double below = 0.0;
	for (const double tap : numbers)
	{
		sum += tap;
		below += tap < 0.0 ? -tap : 0.0;
	}
	if (!(sum > below) || sum > 1e9)
	{
		taps.fail("taps with the sum " + numberText(sum) + ", " + numberText(-below) + " of it negative",
				  "a sum above what the negative ones take away, at most 1e9");
	}
	return sum;
}

constexpr std::string_view kFile = "file:";

} // namespace

FilterFile parseFilter(const std::string& text, const std::string& path)
{
	const nlohmann::json document = parseJson(text, path);
	const JsonValue root{&document, &path, ""};
	root.allowOnly({"taps"});
	const JsonValue rows = root.at("taps");
	const std::size_t height = rows.arraySize();
	if (height < 1 || height > kMaxTaps)
	{
		rows.expected("an array of 1 to " + std::to_string(kMaxTaps) + " rows");
	}
	std::vector<double> taps;
	std::size_t width = 0;
	for (std::size_t y = 0; y < height; ++y)
	{
		const JsonValue row = rows.at(y);
		const std::size_t found = row.arraySize();
		width = y == 0 ? found : width;
		if (found < 1 || found > kMaxTaps || found != width)
		{
			row.expected("an array of " + (y == 0 ? "1 to " + std::to_string(kMaxTaps) : std::to_string(width)) + " numbers");
		}
		for (std::size_t x = 0; x < width; ++x)
		{
			taps.push_back(row.at(x).number());
		}
	}
	const double sum = checkedSum(rows, taps);
	return {tileFilterOf("file:" + nativePath(path).filename().string(), static_cast<int>(width), std::move(taps)), sum};
}

FilterFile readFilter(const std::string& path)
{
	return parseFilter(readFile(path), path);
}

nlohmann::ordered_json filterJson(const TileFilter& filter)
{
	return {{"name", filter.name}, {"share", filter.share}, {"width", filter.width}, {"taps", filter.taps}};
}

TileFilter readFilterFields(const JsonValue& object)
{
	object.allowOnly({"name", "share", "width", "taps"});
	const auto width = static_cast<std::size_t>(object.at("width").integer(1, kMaxTaps));
	const JsonValue taps = object.at("taps");
	const std::size_t count = taps.arraySize();
	if (count < 1 || count % width != 0 || count / width > kMaxTaps)
	{
		taps.expected("rows of " + std::to_string(width) + " numbers, at most " + std::to_string(kMaxTaps));
	}
	std::vector<double> numbers;
	for (std::size_t i = 0; i < count; ++i)
	{
		numbers.push_back(taps.at(i).number());
	}
	checkedSum(taps, numbers);
	TileFilter filter{object.at("name").string(), object.at("share").number(), static_cast<int>(width), std::move(numbers)};
	if (!(filter.share > 0.0 && filter.share <= 1e6))
	{
		object.at("share").expected("a number above 0, at most 1e6");
	}
	return filter;
}

std::vector<TileFilter> filtersOf(const std::vector<std::string>& names, std::vector<std::string>& warnings)
{
	std::vector<TileFilter> filters;
	for (const std::string& text : names)
	{
		const auto [name, share] = nameAndShare(text);
		if (name.starts_with(kFile))
		{
			const std::string path = name.substr(kFile.size());
			FilterFile file = readFilter(path);
			if (std::fabs(file.sum - 1.0) > 1e-6)
			{
				warnings.push_back(path + ": taps: found the sum " + roundedText(file.sum, 6) + ", divided by it");
			}
			filters.push_back(std::move(file.filter));
		}
		else
		{
			filters.push_back(tileFilterNamed(name));
		}
		filters.back().share = share;
	}
	return filters;
}

std::vector<std::string> filterFiles(const std::vector<std::string>& names)
{
	std::vector<std::string> files;
	for (const std::string& text : names)
	{
		if (text.starts_with(kFile))
		{
			files.push_back(nameAndShare(text).first.substr(kFile.size()));
		}
	}
	return files;
}

} // namespace nook
