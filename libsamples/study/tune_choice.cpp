// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/tune_choice.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace nook
{
namespace
{

// This share of those that go on are the best within the bound; the others are the best within bound and slack.
constexpr double kWithin = 0.5;

} // namespace

std::vector<std::size_t> TuneChoice::best(const TuneSearch& search, const std::vector<std::size_t>& left, std::size_t rung) const
{
	const double share = m_settings.rungs[rung].scale < 1.0 ? m_settings.keep_coarse : m_settings.keep_full;
	const auto shared = static_cast<std::size_t>(std::ceil(share * static_cast<double>(left.size())));
	const auto count = std::min(left.size(), std::max(m_settings.least, shared));
	const auto within = static_cast<std::size_t>(std::ceil(kWithin * static_cast<double>(count)));
	std::vector<std::size_t> by_wanted = left;
	std::stable_sort(by_wanted.begin(), by_wanted.end(),
					 [&](std::size_t a, std::size_t b) { return wanted(search.tried[a]) < wanted(search.tried[b]); });
	std::vector<std::size_t> by_bounded = left;
	std::stable_sort(by_bounded.begin(), by_bounded.end(),
					 [&](std::size_t a, std::size_t b) { return bounded(search.tried[a]) < bounded(search.tried[b]); });
	std::vector<std::size_t> kept;
	const auto keep = [&kept](std::size_t i)
	{
		if (std::find(kept.begin(), kept.end(), i) == kept.end())
		{
			kept.push_back(i);
		}
	};
	if (left.empty())
	{
		return kept;
	}
	if (bounded(search.tried[by_bounded.front()]) > 1.0)
	{
		keep(by_bounded.front()); // nothing may reach the bound: then this is what comes nearest
	}
	for (const auto& [slack, until] : {std::pair(1.0, within), std::pair(slackAt(rung), count)})
	{
		for (std::size_t k = 0; k < by_wanted.size() && kept.size() < until; ++k)
		{
			if (bounded(search.tried[by_wanted[k]]) <= slack)
			{
				keep(by_wanted[k]);
			}
		}
	}
	for (std::size_t k = 0; kept.size() < count; ++k)
	{
		keep(by_bounded[k]);
	}
	return kept;
}

std::vector<std::size_t> TuneChoice::possible(const TuneSearch& search, const std::vector<std::size_t>& left) const
{
	const double slack = m_goal.budget_s ? kOnceSlack : 1.0; // of what is bounded
	double least = std::numeric_limits<double>::infinity();  // wanted, of those that are surely within the bound
	for (const std::size_t i : left)
	{
		least = bounded(search.tried[i]) <= 1.0 / slack ? std::min(least, wanted(search.tried[i])) : least;
	}
	least *= m_goal.budget_s ? 1.0 : kOnceSlack;
	std::vector<std::size_t> kept;
	std::copy_if(left.begin(), left.end(), std::back_inserter(kept),
				 [&](std::size_t i) { return bounded(search.tried[i]) <= slack && wanted(search.tried[i]) <= least; });
	std::stable_sort(kept.begin(), kept.end(),
					 [&](std::size_t a, std::size_t b) { return wanted(search.tried[a]) < wanted(search.tried[b]); });
	if (kept.empty() && !left.empty())
	{
		kept.push_back(*std::min_element(left.begin(), left.end(),
										 [&](std::size_t a, std::size_t b)
										 { return bounded(search.tried[a]) < bounded(search.tried[b]); }));
	}
	return kept;
}

double TuneChoice::slackAt(std::size_t rung) const
{
	return m_settings.rungs[rung].scale == 1.0 ? kFullSizeSlack : m_goal.budget_s ? kTimeSlack : kErrorSlack;
}

// Where an error is what counts: under a budget that is met, or a bound of error that is missed.
bool TuneChoice::isAlike(const Tried& best, const Tried& other) const
{
	const bool reaches = m_goal.budget_s ? bounded(other) <= 1.0 : bounded(best) > 1.0;
	if (!isFrom(other, m_once) || !reaches || other.time_s > kAlikeTime * best.time_s || other.error > kAlikeError * best.error)
	{
		return false;
	}
	const CandidateComparison found = compareTrials(best.trial, other.trial);
	return found.error_standard && !found.errors_differ;
}

bool TuneChoice::isCheaper(const Tried& one, const Tried& other)
{
	return one.time_s != other.time_s ? one.time_s < other.time_s : bytesOf(one.trial) < bytesOf(other.trial);
}

void TuneChoice::choose(TuneSearch& search) const
{
	search.pick.reset();
	search.nearest.reset();
	search.instead_of.reset();
	search.runner_up.reset();
	const auto isBetter = [&](const Tried& tried, const std::optional<std::size_t>& known)
	{
		return bounded(tried) <= 1.0 && (!known || wanted(tried) < wanted(search.tried[*known]));
	};
	for (const Tried& tried : search.tried)
	{
		if (isFrom(tried, m_last))
		{
			const bool nearer = !search.nearest || bounded(tried) < bounded(search.tried[*search.nearest]);
			search.nearest = nearer ? tried.candidate : search.nearest;
			search.pick = isBetter(tried, search.pick) ? tried.candidate : search.pick;
		}
	}
	std::optional<std::size_t>& taken = search.pick ? search.pick : search.nearest;
	const bool of_error = search.pick ? m_goal.budget_s.has_value() : m_goal.max_error.has_value();
	if (taken && of_error)
	{
		const std::size_t best = *taken;
		for (const Tried& tried : search.tried)
		{
			if (isFrom(tried, m_last) && isAlike(search.tried[best], tried) && isCheaper(tried, search.tried[*taken]))
			{
				taken = tried.candidate;
				search.instead_of = best;
			}
		}
	}
	for (const Tried& tried : search.tried)
	{
		const bool known = isFrom(tried, m_once) && tried.candidate != search.pick;
		search.runner_up = known && isBetter(tried, search.runner_up) ? tried.candidate : search.runner_up;
	}
	if (search.pick)
	{
		search.nearest.reset();
	}
}

std::optional<std::size_t> TuneChoice::expectedBetter(const TuneSearch& search) const
{
	if (!search.pick)
	{
		return std::nullopt;
	}
	const Tried& best = search.tried[search.instead_of.value_or(*search.pick)];
	std::optional<std::size_t> found;
	for (const Tried& tried : search.tried)
	{
		if (tried.failed.empty() && !tried.trial.views.empty() && !isFrom(tried, m_last) && bounded(tried) <= 1.0 &&
			wanted(tried) < wanted(best) && (!found || wanted(tried) < wanted(search.tried[*found])))
		{
			found = tried.candidate;
		}
	}
	return found;
}

std::optional<std::size_t> TuneChoice::expectedAlike(const TuneSearch& search) const
{
	const std::optional<std::size_t> taken = search.taken();
	const bool of_error = search.pick ? m_goal.budget_s.has_value() : m_goal.max_error.has_value();
	if (!taken || !of_error)
	{
		return std::nullopt;
	}
	const Tried& best = search.tried[search.instead_of.value_or(*taken)];
	std::optional<std::size_t> found;
	for (const Tried& tried : search.tried)
	{
		if (tried.failed.empty() && !isFrom(tried, m_last) && isAlike(best, tried) && isCheaper(tried, search.tried[*taken]) &&
			(!found || isCheaper(tried, search.tried[*found])))
		{
			found = tried.candidate;
		}
	}
	return found;
}

} // namespace nook
