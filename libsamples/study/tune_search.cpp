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

// Where the errors of two candidates do not differ significantly, the second is taken if its error is no greater than this many
// times the first's, and its time no longer than this many times the first's. A significance over few views is coarse, and less
// than 5 % of a time is the clock's.
constexpr double kAlikeError = 1.02;
constexpr double kAlikeTime = 0.95;

// A candidate goes on if what its rung expects exceeds the bound by no more than these factors: at coarse size, and at full size
// with fewer views.
// Tuned on the grids of test_tune_search.cpp.
constexpr double kTimeSlack = 1.5;
constexpr double kErrorSlack = 1.15;
constexpr double kFullSizeSlack = 1.06;

// Candidates drawn once on all views have their final errors; a time that exceeds the budget by more than this factor rules one
// out.
constexpr double kOnceSlack = 1.15;

// This share of those that go on are the best within the bound; the others are the best within bound and slack.
constexpr double kWithin = 0.5;

class HalvingSearch
{
public:
	HalvingSearch(std::size_t candidates, const TuneGoal& goal, const TuneSearchSettings& settings, const MeasureTrial& measure,
				  const Progress& progress)
		: m_goal(goal), m_settings(settings), m_measure(measure), m_progress(progress)
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
		for (std::size_t rung = 0; rung < once() && left.size() > m_settings.least; ++rung)
		{
			measureAll(left, rung);
			scaleBounded(left, rung);
			for (const std::size_t i : left)
			{
				m_coarse[rung][i] = wanted(i);
			}
			left = best(left, rung);
		}
		measureAll(left, once());
		const std::vector<std::size_t> finalists = possible(left);
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

	TuneSearch choose(TuneSearch measured)
	{
		m_made = std::move(measured);
		choose();
		return m_made;
	}

private:
	// The rung where all views are drawn once, and the last one.
	std::size_t once() const
	{
		return m_settings.once();
	}
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
		if (isFrom(tried, once()) && m_settings.rungs[rung].repetitions == 1)
		{
			tried.rung = rung; // it was drawn once
			m_made.rungs[rung].candidates += 1;
			return;
		}
		try
		{
			const auto ahead = rung == once() ? m_anchors.find(i) : m_anchors.end();
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
			const Trial trial = m_measure(i, m_settings.rungs[once()]);
			count(rung, trial);
			m_anchors.emplace(i, trial);
			return true;
		}
		catch (const std::exception&)
		{
			return false; // its own rung will say why
		}
	}

	// The quantity to minimise, and the bounded one as a share of its bound.
	double wanted(std::size_t i) const
	{
		return m_goal.budget_s ? m_made.tried[i].error : m_made.tried[i].time_s;
	}
	double bounded(std::size_t i) const
	{
		return m_goal.budget_s ? m_made.tried[i].time_s / *m_goal.budget_s : m_made.tried[i].error / *m_goal.max_error;
	}

	// Sorts candidates by a quantity, the least first.
	std::vector<std::size_t> sorted(std::vector<std::size_t> list, double (HalvingSearch::*quantity)(std::size_t) const) const
	{
		std::stable_sort(list.begin(), list.end(),
						 [&](std::size_t a, std::size_t b) { return (this->*quantity)(a) < (this->*quantity)(b); });
		return list;
	}

	// Nothing that went on reaches the goal: others, nearest first, as many as went on, before it is said that nothing does.
	void widen()
	{
		std::vector<std::size_t> others;
		for (const Tried& tried : m_made.tried)
		{
			const bool drawn = isFrom(tried, once());
			const double slack = !drawn ? kTimeSlack : m_goal.budget_s ? kOnceSlack : 1.0;
			if (tried.failed.empty() && !isFrom(tried, last()) && bounded(tried.candidate) <= slack)
			{
				others.push_back(tried.candidate);
			}
		}
		others = sorted(others, &HalvingSearch::bounded);
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
			if (Tried& tried = m_made.tried[i]; tried.failed.empty() && !isFrom(tried, once()))
			{
				set(tried, trial, once());
			}
		}
		for (const auto& [rung, before] : m_coarse)
		{
			double logarithms = 0.0;
			double known = 0.0;
			for (const auto& [i, value] : before)
			{
				if (isFrom(m_made.tried[i], once()) && value > 0.0) // a bake takes no time at any size
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
			std::optional<std::size_t> next = expectedBetter();
			next = next ? next : expectedAlike();
			if (!next)
			{
				break;
			}
			measureOne(*next, isFrom(m_made.tried[*next], once()) ? last() : once());
			choose();
		}
	}

	// Returns the candidates `left` at a rung that go on.
	std::vector<std::size_t> best(const std::vector<std::size_t>& left, std::size_t rung) const
	{
		const bool coarse = m_settings.rungs[rung].scale < 1.0;
		const double share = coarse ? m_settings.keep_coarse : m_settings.keep_full;
		const double slack_here = !coarse ? kFullSizeSlack : m_goal.budget_s ? kTimeSlack : kErrorSlack;
		const auto shared = static_cast<std::size_t>(std::ceil(share * static_cast<double>(left.size())));
		const auto count = std::min(left.size(), std::max(m_settings.least, shared));
		const auto within = static_cast<std::size_t>(std::ceil(kWithin * static_cast<double>(count)));
		const std::vector<std::size_t> by_wanted = sorted(left, &HalvingSearch::wanted);
		const std::vector<std::size_t> by_bounded = sorted(left, &HalvingSearch::bounded);
		std::vector<std::size_t> kept;
		if (left.empty())
		{
			return kept;
		}
		if (bounded(by_bounded.front()) > 1.0)
		{
			addOnce(kept, by_bounded.front()); // nothing may reach the bound: then this is what comes nearest
		}
		for (const auto& [slack, until] : {std::pair(1.0, within), std::pair(slack_here, count)})
		{
			for (std::size_t k = 0; k < by_wanted.size() && kept.size() < until; ++k)
			{
				if (bounded(by_wanted[k]) <= slack)
				{
					addOnce(kept, by_wanted[k]);
				}
			}
		}
		for (std::size_t k = 0; kept.size() < count; ++k)
		{
			addOnce(kept, by_bounded[k]);
		}
		return kept;
	}

	// Returns those drawn once on all views that can be the pick, best first; the nearest where none can.
	std::vector<std::size_t> possible(const std::vector<std::size_t>& left) const
	{
		const double slack = m_goal.budget_s ? kOnceSlack : 1.0; // of what is bounded
		double least = std::numeric_limits<double>::infinity();  // wanted, of those that are surely within the bound
		for (const std::size_t i : left)
		{
			least = bounded(i) <= 1.0 / slack ? std::min(least, wanted(i)) : least;
		}
		least *= m_goal.budget_s ? 1.0 : kOnceSlack;
		const auto kept = itemsWhere(left, [&](std::size_t i) { return bounded(i) <= slack && wanted(i) <= least; });
		if (kept.empty() && !left.empty())
		{
			return {sorted(left, &HalvingSearch::bounded).front()};
		}
		return sorted(kept, &HalvingSearch::wanted);
	}

	// Where an error is what counts: under a budget that is met, or a bound of error that is missed.
	bool isAlike(const Tried& best, const Tried& other) const
	{
		const bool reaches = m_goal.budget_s ? bounded(other.candidate) <= 1.0 : bounded(best.candidate) > 1.0;
		if (!isFrom(other, once()) || !reaches || other.time_s > kAlikeTime * best.time_s || other.error > kAlikeError * best.error)
		{
			return false;
		}
		const CandidateComparison found = compareTrials(best.trial, other.trial);
		return found.error_standard && !found.errors_differ;
	}

	// In time, and of equal times in bytes.
	static bool isCheaper(const Tried& one, const Tried& other)
	{
		return one.time_s != other.time_s ? one.time_s < other.time_s : bytesOf(one.trial) < bytesOf(other.trial);
	}

	// Sets pick, or nearest, and instead_of and runner_up. The pick has the least wanted quantity of those measured in full; where
	// that is an error, it is the fastest of those that are alike.
	void choose()
	{
		m_made.pick.reset();
		m_made.nearest.reset();
		m_made.instead_of.reset();
		m_made.runner_up.reset();
		const auto isBetter = [&](const Tried& tried, const std::optional<std::size_t>& known)
		{
			return bounded(tried.candidate) <= 1.0 && (!known || wanted(tried.candidate) < wanted(*known));
		};
		for (const Tried& tried : m_made.tried)
		{
			if (isFrom(tried, last()))
			{
				const bool nearer = !m_made.nearest || bounded(tried.candidate) < bounded(*m_made.nearest);
				m_made.nearest = nearer ? tried.candidate : m_made.nearest;
				m_made.pick = isBetter(tried, m_made.pick) ? tried.candidate : m_made.pick;
			}
		}
		std::optional<std::size_t>& taken = m_made.pick ? m_made.pick : m_made.nearest;
		const bool of_error = m_made.pick ? m_goal.budget_s.has_value() : m_goal.max_error.has_value();
		if (taken && of_error)
		{
			const std::size_t best = *taken;
			for (const Tried& tried : m_made.tried)
			{
				if (isFrom(tried, last()) && isAlike(m_made.tried[best], tried) && isCheaper(tried, m_made.tried[*taken]))
				{
					taken = tried.candidate;
					m_made.instead_of = best;
				}
			}
		}
		for (const Tried& tried : m_made.tried)
		{
			const bool known = isFrom(tried, once()) && tried.candidate != m_made.pick;
			m_made.runner_up = known && isBetter(tried, m_made.runner_up) ? tried.candidate : m_made.runner_up;
		}
		if (m_made.pick)
		{
			m_made.nearest.reset();
		}
	}

	// Returns the best candidate that was not measured in full, but is expected to reach the goal and to be better than the pick.
	// Without a pick there is none.
	std::optional<std::size_t> expectedBetter() const
	{
		const auto isBetter = [this](std::size_t i)
		{
			const Tried& tried = m_made.tried[i];
			return m_made.pick && tried.failed.empty() && !tried.trial.views.empty() && !isFrom(tried, last()) &&
				   bounded(i) <= 1.0 && wanted(i) < wanted(m_made.instead_of.value_or(*m_made.pick));
		};
		const auto better = sorted(indicesWhere(m_made.tried.size(), isBetter), &HalvingSearch::wanted);
		return better.empty() ? std::nullopt : std::optional(better.front());
	}

	// Returns a candidate that was not measured in full, and is expected to be the fastest of those that are like the pick, or the
	// nearest.
	std::optional<std::size_t> expectedAlike() const
	{
		const std::optional<std::size_t> taken = m_made.taken();
		const bool of_error = m_made.pick ? m_goal.budget_s.has_value() : m_goal.max_error.has_value();
		if (!taken || !of_error)
		{
			return std::nullopt;
		}
		const Tried& best = m_made.tried[m_made.instead_of.value_or(*taken)];
		std::optional<std::size_t> found;
		for (const Tried& tried : m_made.tried)
		{
			if (tried.failed.empty() && !isFrom(tried, last()) && isAlike(best, tried) && isCheaper(tried, m_made.tried[*taken]) &&
				(!found || isCheaper(tried, m_made.tried[*found])))
			{
				found = tried.candidate;
			}
		}
		return found;
	}

	const TuneGoal& m_goal;
	const TuneSearchSettings& m_settings;
	const MeasureTrial& m_measure;
	const Progress& m_progress;
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

} // namespace

TuneSearch searchCandidates(std::size_t candidates, const TuneGoal& goal, const TuneSearchSettings& settings,
							const MeasureTrial& measure, const Progress& progress)
{
	return HalvingSearch(candidates, goal, settings, measure, progress).halve();
}

TuneSearch chooseOf(TuneSearch measured, const TuneGoal& goal, const TuneSearchSettings& settings)
{
	return HalvingSearch(measured.tried.size(), goal, settings, {}, {}).choose(std::move(measured));
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

} // namespace nook
