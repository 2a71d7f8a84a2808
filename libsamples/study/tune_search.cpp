// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Kevin Jamieson and Ameet Talwalkar, Non-stochastic Best Arm Identification and Hyperparameter
// Optimization, 2016 (successive halving). Ours keeps a share other than a half, ranks by a goal with a bound, and scales times by
// anchors.
#include "study/tune_search.h"

#include "core/lists.h"
#include "study/front.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <utility>

namespace nook
{
namespace
{

// Measured once at full size before their turn, for the scale of what is bounded: so many a rung at most, of few candidates one.
constexpr std::size_t kAnchors = 2;
constexpr std::size_t kFewCandidates = 80;

class HalvingSearch
{
public:
	HalvingSearch(std::size_t candidates, const TuneGoal& goal, const TuneSearchSettings& settings, const MeasureTrial& measure,
				  const Progress& progress)
		: m_goal(goal), m_settings(settings), m_measure(measure), m_progress(progress), m_choice(goal, settings)
	{
		assert(candidates > 0 && settings.rungs.size() > 1 && settings.rungs.back().scale == 1.0);
		assert(settings.rungs[settings.once()].scale == 1.0 &&
			   settings.rungs[settings.once()].views == settings.rungs.back().views);
		assert(goal.budget_s.has_value() != goal.max_error.has_value());
		m_made.tried.resize(candidates);
		m_made.rungs.resize(settings.rungs.size());
		for (std::size_t i = 0; i < candidates; ++i)
		{
			m_made.tried[i].candidate = i;
		}
	}

	TuneSearch halve()
	{
		std::vector<std::size_t> left = listOf(m_made.tried.size(), [](std::size_t i) { return i; });
		for (std::size_t rung = 0; rung < m_settings.once() && left.size() > m_settings.least; ++rung)
		{
			measureAll(left, rung);
			scaleBounded(left, rung);
			for (const std::size_t i : left)
			{
				m_coarse[rung][i] = wanted(i);
			}
			left = m_choice.best(m_made, left, rung);
		}
		measureAll(left, m_settings.once());
		const std::vector<std::size_t> finalists = m_choice.possible(m_made, left);
		ProgressCounter progress(m_progress, nameOfRung(last()), finalists.size());
		for (const std::size_t i : finalists)
		{
			measureOne(i, last());
			progress.finishOne();
			if (m_goal.budget_s && isFrom(m_made.tried[i], last()) && bounded(i) <= 1.0)
			{
				break; // errors are known by now, and the others' are larger
			}
		}
		choose();
		widen();
		settle();
		return m_made;
	}

private:
	std::size_t last() const
	{
		return m_settings.rungs.size() - 1;
	}

	std::string nameOfRung(std::size_t rung) const
	{
		return "rung " + std::to_string(rung + 1) + " of " + std::to_string(m_settings.rungs.size());
	}

	void count(std::size_t rung, const Trial& trial)
	{
		m_made.rungs[rung].cost_s += trial.cost_s;
		m_made.cost_s += trial.cost_s;
		m_made.pictures += trial.pictures;
	}

	void set(Tried& tried, const Trial& trial, std::size_t rung) const
	{
		tried.trial = trial;
		tried.rung = rung;
		tried.time_s = timeOf(trial, m_goal.over);
		tried.error = errorOf(trial, m_goal.over);
	}

	void measureOne(std::size_t i, std::size_t rung)
	{
		Tried& tried = m_made.tried[i];
		if (isFrom(tried, m_settings.once()) && m_settings.rungs[rung].repetitions == 1)
		{
			tried.rung = rung; // it was drawn once
			m_made.rungs[rung].candidates += 1;
			return;
		}
		try
		{
			const auto ahead = rung == m_settings.once() ? m_anchors.find(i) : m_anchors.end();
			set(tried, ahead != m_anchors.end() ? ahead->second : m_measure(i, m_settings.rungs[rung]), rung);
			if (ahead == m_anchors.end())
			{
				count(rung, tried.trial);
			}
			m_made.rungs[rung].candidates += 1;
		}
		catch (const std::exception& problem) // memory may end as well
		{
			tried.failed = problem.what();
		}
	}

	void measureAll(std::vector<std::size_t>& left, std::size_t rung)
	{
		ProgressCounter progress(m_progress, nameOfRung(rung), left.size());
		for (const std::size_t i : left)
		{
			measureOne(i, rung);
			progress.finishOne();
		}
		std::erase_if(left, [this](std::size_t i) { return !m_made.tried[i].failed.empty(); });
	}

	// Scales the bounded quantity to what the last rung would find. Times grow with the picture, by less than its pixels, for each
	// pass has a part that does not depend on them; errors depend on the views. A few candidates, one after another where the bound
	// seems to be, are drawn once at the last rung's size and views, and correct what the others are expected to have: errors have
	// no noise, and the slack is wide against that of a time.
	void scaleBounded(const std::vector<std::size_t>& left, std::size_t rung)
	{
		const double scale = m_settings.rungs[rung].scale;
		double Tried::*const what = m_goal.budget_s ? &Tried::time_s : &Tried::error;
		const double bound = m_goal.budget_s ? *m_goal.budget_s : *m_goal.max_error;
		double ratio = m_goal.budget_s ? 1.0 / (scale * scale) : 1.0;
		const auto found = [&](std::size_t i)
		{
			const Trial& trial = m_anchors.at(i);
			const double full = m_goal.budget_s ? timeOf(trial, m_goal.over) : errorOf(trial, m_goal.over);
			return std::max(full, 1e-30) / std::max(m_made.tried[i].*what, 1e-30);
		};
		double logarithms = 0.0;
		double known = 0.0;
		for (const std::size_t i : left)
		{
			if (m_anchors.count(i) > 0)
			{
				logarithms += std::log(found(i));
				known += 1.0;
			}
		}
		ratio = known > 0.0 ? std::exp(logarithms / known) : ratio;
		std::size_t before = m_made.tried.size();
		for (std::size_t step = 0; step <= anchors() && !left.empty(); ++step)
		{
			const auto away = [&](std::size_t i)
			{
				return std::fabs(std::log(std::max(m_made.tried[i].*what * ratio, 1e-30) / bound));
			};
			const std::size_t i =
				*std::min_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) { return away(a) < away(b); });
			if (i == before || !anchorAt(i, rung))
			{
				break;
			}
			before = i;
			ratio = found(i);
		}
		for (const std::size_t i : left)
		{
			m_made.tried[i].*what *= ratio;
		}
	}

	std::size_t anchors() const
	{
		return m_made.tried.size() < kFewCandidates ? 1 : kAnchors;
	}

	// False where no more of them are to be measured, or this one cannot be.
	bool anchorAt(std::size_t i, std::size_t rung)
	{
		if (m_anchors.count(i) > 0)
		{
			return true;
		}
		if (m_anchors.size() >= anchors() * (rung + 1))
		{
			return false;
		}
		try
		{
			const Trial trial = m_measure(i, m_settings.rungs[m_settings.once()]);
			count(rung, trial);
			m_anchors.emplace(i, trial);
			return true;
		}
		catch (const std::exception&)
		{
			return false; // its own rung will say why
		}
	}

	double wanted(std::size_t i) const
	{
		return m_choice.wanted(m_made.tried[i]);
	}
	double bounded(std::size_t i) const
	{
		return m_choice.bounded(m_made.tried[i]);
	}
	void choose()
	{
		m_choice.choose(m_made);
	}

	// Nothing that went on reaches the goal: others, nearest first, as many as went on, before it is said that nothing does.
	void widen()
	{
		std::vector<std::size_t> others;
		for (const Tried& tried : m_made.tried)
		{
			const bool drawn = isFrom(tried, m_settings.once());
			const double slack = !drawn ? kTimeSlack : m_goal.budget_s ? kOnceSlack : 1.0;
			if (tried.failed.empty() && !isFrom(tried, last()) && bounded(tried.candidate) <= slack)
			{
				others.push_back(tried.candidate);
			}
		}
		std::stable_sort(others.begin(), others.end(), [this](std::size_t a, std::size_t b) { return bounded(a) < bounded(b); });
		others.resize(std::min(others.size(), m_settings.least));
		for (std::size_t k = 0; k < others.size() && !m_made.pick; ++k)
		{
			measureOne(others[k], last());
			choose();
		}
	}

	// Those measured ahead are as known as others; and what is wanted of a coarse picture, as the last rung would find it: errors
	// are larger there, and times shorter.
	void scaleWanted()
	{
		for (const auto& [i, trial] : m_anchors)
		{
			if (Tried& tried = m_made.tried[i]; tried.failed.empty() && !isFrom(tried, m_settings.once()))
			{
				set(tried, trial, m_settings.once());
			}
		}
		for (const auto& [rung, before] : m_coarse)
		{
			double logarithms = 0.0;
			double known = 0.0;
			for (const auto& [i, value] : before)
			{
				if (isFrom(m_made.tried[i], m_settings.once()) && value > 0.0) // a bake takes no time at any size
				{
					logarithms += std::log(std::max(wanted(i), 1e-30) / std::max(value, 1e-30));
					known += 1.0;
				}
			}
			for (const auto& [i, value] : before)
			{
				if (Tried& tried = m_made.tried[i]; tried.failed.empty() && tried.rung == rung)
				{
					(m_goal.budget_s ? tried.error : tried.time_s) *= std::exp(logarithms / std::max(known, 1.0));
				}
			}
		}
	}

	// Nothing is left that is only expected to be better, or as good in less time.
	void settle()
	{
		scaleWanted();
		choose();
		ProgressCounter progress(m_progress, "expected to be better");
		for (;;)
		{
			std::optional<std::size_t> next = m_choice.expectedBetter(m_made);
			next = next ? next : m_choice.expectedAlike(m_made);
			if (!next)
			{
				break;
			}
			measureOne(*next, isFrom(m_made.tried[*next], m_settings.once()) ? last() : m_settings.once());
			choose();
		}
	}

	const TuneGoal& m_goal;
	const TuneSearchSettings& m_settings;
	const MeasureTrial& m_measure;
	const Progress& m_progress;
	TuneChoice m_choice;
	std::map<std::size_t, Trial> m_anchors;
	std::map<std::size_t, std::map<std::size_t, double>> m_coarse; // what is wanted, by rung and candidate
	TuneSearch m_made;
};

double overLevels(const Trial& trial, OverLevels over, double ViewTrial::*value)
{
	std::map<std::size_t, std::pair<double, std::size_t>> sums;
	for (const ViewTrial& view : trial.views)
	{
		sums[view.level].first += view.*value;
		sums[view.level].second += 1;
	}
	double mean = 0.0;
	double worst = 0.0;
	for (const auto& [level, sum] : sums)
	{
		const double of_level = sum.first / static_cast<double>(sum.second);
		mean += of_level / static_cast<double>(sums.size());
		worst = std::max(worst, of_level);
	}
	return over == OverLevels::mean ? mean : worst;
}

// This share of those that go on are the best within the bound; the others are the best within bound and slack.
constexpr double kWithin = 0.5;

} // namespace

TuneSearch searchCandidates(std::size_t candidates, const TuneGoal& goal, const TuneSearchSettings& settings,
							const MeasureTrial& measure, const Progress& progress)
{
	return HalvingSearch(candidates, goal, settings, measure, progress).halve();
}

std::vector<std::size_t> frontOf(const TuneSearch& search, std::size_t rung)
{
	const auto known = itemsWhere(search.tried, [rung](const Tried& tried) { return isFrom(tried, rung); });
	return frontOf(mapped(known, [](const Tried& tried) { return FrontPlace{tried.candidate, tried.time_s, tried.error}; }));
}

double timeOf(const Trial& trial, OverLevels over)
{
	return overLevels(trial, over, &ViewTrial::time_s);
}

double errorOf(const Trial& trial, OverLevels over)
{
	return overLevels(trial, over, &ViewTrial::error);
}

uint64_t bytesOf(const Trial& trial)
{
	uint64_t most = 0;
	for (const ViewTrial& view : trial.views)
	{
		most = std::max(most, view.bytes);
	}
	return most;
}

bool reaches(const TuneGoal& goal, double time_s, double error)
{
	return goal.budget_s ? time_s <= *goal.budget_s : error <= *goal.max_error;
}

CandidateComparison compareTrials(const Trial& first, const Trial& second)
{
	assert(first.views.size() == second.views.size() && !first.views.empty());
	CandidateComparison made;
	made.views = first.views.size();
	const auto n = static_cast<double>(made.views);
	double first_time = 0.0;
	double second_time = 0.0;
	bool spread = true;
	bool differ = true;
	for (std::size_t i = 0; i < made.views; ++i)
	{
		const ViewTrial& one = first.views[i];
		const ViewTrial& other = second.views[i];
		made.error_difference += (other.error - one.error) / n;
		first_time += one.time_s;
		second_time += other.time_s;
		spread = spread && one.high_s > one.low_s && other.high_s > other.low_s;
		differ = differ && (one.high_s < other.low_s || other.high_s < one.low_s);
	}
	if (spread)
	{
		made.times_differ = differ;
	}
	if (first_time > 0.0)
	{
		made.time_ratio = second_time / first_time;
	}
	if (made.views > 1)
	{
		double squares = 0.0;
		for (std::size_t i = 0; i < made.views; ++i)
		{
			const double off = second.views[i].error - first.views[i].error - made.error_difference;
			squares += off * off;
		}
		made.error_standard = std::sqrt(squares / (n - 1.0) / n);
		made.errors_differ = std::fabs(made.error_difference) > 2.0 * *made.error_standard;
	}
	return made;
}

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
	std::vector<std::size_t> kept =
		itemsWhere(left, [&](std::size_t i) { return bounded(search.tried[i]) <= slack && wanted(search.tried[i]) <= least; });
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
