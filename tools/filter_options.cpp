// SPDX-License-Identifier: GPL-3.0-or-later
#include "filter_options.h"

#include "core/error.h"
#include "core/text.h"
#include "format/filter_json.h"

#include <cstdio>

namespace nook
{
namespace
{

constexpr std::string_view kFile = "file:";

} // namespace

void addFilters(CLI::App& app, FilterOptions& options, const std::string& help)
{
	options.filter_given = app.add_option("--filter", options.names, help)->type_name("KERNEL")->allow_extra_args(false);
	options.ema_given =
		addNumber(app, "--ema", options.ema, 1e-6, 1.0, "Weight of the newest frame in the mean over frames (default 0.1)");
}

std::vector<TileFilter> filtersOf(const std::vector<std::string>& names)
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
				std::fprintf(stderr, "nook: warning: %s: taps: found the sum %s, divided by it\n", oneLine(path).c_str(),
							 roundedText(file.sum, 6).c_str());
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

std::vector<Measure> measuresBehind(const PatternTile& tile, const std::vector<TileFilter>& filters, double ema, double most_steps,
									const RunSettings& run)
{
	std::vector<Measure> measures;
	const TileTime time{tile.frames, ema, tile.moves};
	const std::size_t count = tile.variants.front().count();
	for (const TileFilter& filter : filters)
	{
		const auto add = [&](const std::string& name, const std::vector<TileFilter>& parts, int last, glm::ivec2 pan)
		{
			std::vector<TileShares> shares;
			double steps = 0.0;
			for (const TileFilter& part : parts)
			{
				steps += stepsOfShares(tile.size, part, time, pan != glm::ivec2(0));
				if (steps > most_steps)
				{
					return;
				}
				shares.push_back(sharesOf(tile.size, part, time, last, pan));
			}
			if (stepsOfError(shares.front(), count) <= most_steps)
			{
				measures.push_back({filter.name + name, errorBehind(tile, shares, run)});
			}
		};
		add("", {filter}, 1, {0, 0});
		add(", half", halvesOf(filter), 1, {0, 0});
		if (tile.frames > 1)
		{
			add(", frames", {filter}, 0, {0, 0});
			add(", frames, panned", {filter}, 0, {1, 0});
			for (const int last : {2, 4, 8})
			{
				if (last < tile.frames)
				{
					add(", first " + std::to_string(last), {filter}, last, {0, 0});
				}
			}
			add(", cycle", {filter}, tile.frames, {0, 0});
		}
	}
	return measures;
}

} // namespace nook
