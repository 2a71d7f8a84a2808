// SPDX-License-Identifier: GPL-3.0-or-later
// Greedy, in rising order of the greatest share that a polygon can have at any receiver; every triangle's side has `below` to lose.
#include "core/parallel.h"
#include "volume/drop_search.h"

#include <algorithm>

namespace nook::detail
{
namespace
{

struct Loss
{
	uint32_t side; // 2 · triangle + side
	float share;   // rounded up
};

// What a polygon can take from each receiver's side, as long as that is at most `below` everywhere; else none, and more than that.
double lossesOf(const DropSearch& search, std::size_t polygon, std::vector<Loss>& losses)
{
	double most = 0.0;
	for (unsigned side = 0; side < 2; ++side)
	{
		if (search.found[polygon][side] != Finding::needed)
		{
			continue;
		}
		const VolumeRegion region = search.region(polygon, side);
		const auto alpha = static_cast<double>(search.occluders.polygons[polygon].alpha);
		const auto add = [&](const FoundReceiver& found)
		{
			const double share =
				found.finding != Finding::needed
					? 0.0
					: greatestShare(region, search.corners(polygon), search.areas[polygon], alpha, found.receiver, found.rise_m);
			most = std::max(most, share);
			if (share > 0.0)
			{
				losses.push_back({2 * found.triangle + found.side, static_cast<float>(share * (1.0 + 0x1p-22))});
			}
			return most <= search.settings.below;
		};
		search.forReceivers(polygon, region, add);
		if (most > search.settings.below)
		{
			losses.clear();
			return most;
		}
	}
	return most;
}

bool isNeeded(const DropSearch& search, std::size_t polygon)
{
	return search.inside[polygon] == 0 &&
		   (search.found[polygon][0] == Finding::needed || search.found[polygon][1] == Finding::needed);
}

} // namespace

void findLeast(DropSearch& search)
{
	const std::size_t count = search.found.size();
	const double below = search.settings.below;
	std::vector<std::vector<Loss>> losses(count);
	std::vector<double> greatest(count, 2.0);
	ProgressCounter progress(search.run.progress, "contributions", (count + kDropBlock - 1) / kDropBlock);
	parallelFor((count + kDropBlock - 1) / kDropBlock, search.run.threads,
				[&](std::size_t block)
				{
					std::vector<Loss> here;
					for (std::size_t i = block * kDropBlock; i < std::min(count, (block + 1) * kDropBlock); ++i)
					{
						if (isNeeded(search, i))
						{
							here.clear();
							greatest[i] = lossesOf(search, i, here);
							losses[i] = here;
						}
					}
					progress.finishOne();
				});
	std::vector<uint32_t> order;
	for (std::size_t i = 0; i < count; ++i)
	{
		if (greatest[i] <= below)
		{
			order.push_back(static_cast<uint32_t>(i));
		}
	}
	std::sort(order.begin(), order.end(),
			  [&](uint32_t a, uint32_t b) { return greatest[a] != greatest[b] ? greatest[a] < greatest[b] : a < b; });
	std::vector<double> lost(2 * search.sides.seen.size(), 0.0);
	for (const uint32_t i : order)
	{
		const bool fits = std::all_of(losses[i].begin(), losses[i].end(),
									  [&](const Loss& loss) { return lost[loss.side] + static_cast<double>(loss.share) <= below; });
		if (fits)
		{
			search.least[i] = 1;
			for (const Loss& loss : losses[i])
			{
				lost[loss.side] += static_cast<double>(loss.share);
				search.counts.greatest_loss = std::max(search.counts.greatest_loss, lost[loss.side]);
			}
		}
		losses[i] = {};
	}
}

} // namespace nook::detail
