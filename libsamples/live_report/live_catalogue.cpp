// SPDX-License-Identifier: GPL-3.0-or-later
// The catalogue's files → their measures, to stand beside those of a pattern just made.
#include "core/file.h"
#include "core/system.h"
#include "core/text.h"
#include "format/input.h"
#include "format/notes.h"
#include "live_report/live_parts.h"

#include <cmath>
#include <filesystem>

namespace nook
{
namespace
{

constexpr int kMostListed = 64;

std::string nameOfEntry(Domain domain, int count, const std::string& variant)
{
	const std::string number = std::to_string(count);
	return std::string(nameOf(domain)) + "/" + std::string(nameOf(domain)) + "_" + std::string(3 - number.size(), '0') + number +
		   variant + ".json";
}

LiveJson measuresOfFile(const std::string& path)
{
	LiveJson measures = LiveJson::object();
	const std::variant<PatternFile, TileFile> input = readInput(path, std::nullopt);
	const PatternFile* const file = std::get_if<PatternFile>(&input);
	if (file != nullptr && file->quality)
	{
		for (const Measure& measure : measuresOf(*file->quality))
		{
			measures[measure.name] = std::isfinite(measure.value) ? roundedText(measure.value, 6) : "infinite";
		}
	}
	return measures;
}

} // namespace

LiveJson liveCatalogue(const LiveReportSettings& settings, std::vector<std::string>& read)
{
	LiveJson all = LiveJson::object();
	for (const Domain domain : {Domain::disk, Domain::ball, Domain::sphere, Domain::hemisphere})
	{
		for (const std::string variant : {"", "_centred", "_symmetric"})
		{
			LiveJson counts = LiveJson::object();
			for (int count = 1; count <= kMostListed; ++count)
			{
				const std::string path = settings.catalogue + "/" + nameOfEntry(domain, count, variant);
				if (std::filesystem::exists(nativePath(path)))
				{
					read.push_back(path);
					counts[std::to_string(count)] = measuresOfFile(path);
				}
			}
			if (!counts.empty())
			{
				all[std::string(nameOf(domain)) + variant] = std::move(counts);
			}
		}
	}
	return all;
}

} // namespace nook
