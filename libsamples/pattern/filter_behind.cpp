// SPDX-License-Identifier: GPL-3.0-or-later
#include "pattern/quality.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace nook
{
namespace
{

constexpr std::array<int, 3> kBegun{2, 4, 8}; // frames in means that have just begun

} // namespace

std::vector<Measure> measuresBehind(const PatternTile& tile, const std::vector<TileFilter>& filters, double ema, double most_steps,
									const RunSettings& run)
{
	std::vector<Measure> measures;
	const TileTime time{tile.frames, ema, tile.moves};
	const std::size_t count = tile.variants.front().count();
	std::vector<int> lasts;
	std::copy_if(kBegun.begin(), kBegun.end(), std::back_inserter(lasts), [&](int last) { return last < tile.frames; });
	ProgressCounter progress(run.progress, "behind filters", filters.size() * (tile.frames > 1 ? 5 + lasts.size() : 2));
	for (const TileFilter& filter : filters)
	{
		const auto error = [&](const std::vector<TileFilter>& parts, int last, glm::ivec2 pan) -> std::optional<double>
		{
			std::vector<TileShares> shares;
			double steps = 0.0;
			for (const TileFilter& part : parts)
			{
				steps += stepsOfShares(tile.size, part, time, pan != glm::ivec2(0));
				if (steps > most_steps)
				{
					return std::nullopt;
				}
				shares.push_back(sharesOf(tile.size, part, time, last, pan));
			}
			return stepsOfError(shares.front(), count) <= most_steps ? std::optional(errorBehind(tile, shares, run)) : std::nullopt;
		};
		const auto add = [&](const std::string& name, const std::vector<TileFilter>& parts, int last, glm::ivec2 pan)
		{
			if (const std::optional<double> found = error(parts, last, pan))
			{
				measures.push_back({filter.name + name, *found});
			}
			progress.finishOne();
		};
		add("", {filter}, 1, {0, 0});
		add(", half", halvesOf(filter), 1, {0, 0});
		if (tile.frames > 1)
		{
			add(", frames", {filter}, 0, {0, 0});
			add(", frames, panned", {filter}, 0, {1, 0});
			for (const int last : lasts)
			{
				add(", first " + std::to_string(last), {filter}, last, {0, 0});
			}
			add(", cycle", {filter}, tile.frames, {0, 0});
		}
	}
	return measures;
}

} // namespace nook
