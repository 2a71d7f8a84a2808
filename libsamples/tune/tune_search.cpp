// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Kevin Jamieson and Ameet Talwalkar, Non-stochastic Best Arm Identification and Hyperparameter
// Optimization, 2016 (successive halving). Ours keeps a share other than a half, ranks by a goal with a bound, and scales times by
// anchors.
#include "tune/tune_search.h"

#include "core/error.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <exception>
#include <limits>
#include <map>

namespace nook
{
namespace
{

constexpr double kNone = std::numeric_limits<double>::infinity();

// By how much what a rung expects may be off, and the candidate still goes on: at coarse size, and at full size with fewer views.
// Tuned on the grids of test_tune_search.cpp.
constexpr double kTimeSlack = 1.5;
constexpr double kErrorSlack = 1.15;
constexpr double kFullSizeSlack = 1.06;

// Drawn once on all views: errors are what they are, and a time this much longer is not that of the pick.
constexpr double kOnceSlack = 1.15;

// Of those that go on, as many are the best within the bound; the others are the best within bound and slack.
constexpr double kWithin = 0.5;

// Measured once at full size before their turn, for the scale of what is bounded: so many a rung at most, of few candidates one.
constexpr std::size_t kAnchors = 2;
constexpr std::size_t kFewCandidates = 80;

class Search
{
public:
	Search(std::size_t candidates, const TuneGoal& goal, const TuneSearchSettings& settings, const MeasureTrial& measure,
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
		std::vector<std::size_t> left = all();
		for (std::size_t rung = 0; rung < m_settings.once() && left.size() > m_settings.least; ++rung)
		{
			measureAll(left, rung);
			scaleBounded(left, rung);
			left = best(left, rung);
		}
		measureAll(left, m_settings.once());
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
		return m_made;
	}

	TuneSearch whole(const TuneSearch* known)
	{
		ProgressCounter progress(m_progress, "grid", m_made.tried.size());
		for (const std::size_t i : all())
		{
			const Tried* const before = known != nullptr ? &known->tried[i] : nullptr;
			if (before != nullptr && isFrom(*before, last()))
			{
				m_made.tried[i] = *before;
				count(last(), before->trial);
				m_made.rungs.back().candidates += 1;
			}
			else
			{
				measureOne(i, last());
			}
			progress.finishOne();
		}
		choose();
		return m_made;
	}

private:
	std::size_t last() const
	{
		return m_settings.rungs.size() - 1;
	}

	std::vector<std::size_t> all() const
	{
		std::vector<std::size_t> every(m_made.tried.size());
		for (std::size_t i = 0; i < every.size(); ++i)
		{
			every[i] = i;
		}
		return every;
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
			tried.trial = ahead != m_anchors.end() ? ahead->second : m_measure(i, m_settings.rungs[rung]);
			tried.rung = rung;
			tried.time_s = timeOf(tried.trial, m_goal.over);
			tried.error = errorOf(tried.trial, m_goal.over);
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
		left.erase(std::remove_if(left.begin(), left.end(), [this](std::size_t i) { return !m_made.tried[i].failed.empty(); }),
				   left.end());
	}

	// What is bounded, as the last rung would find it. Times grow with the picture, by less than its pixels, for each pass has a
	// part that does not depend on them; errors depend on the views. A few candidates, one after another where the bound seems to
	// be, are drawn once at the last rung's size and views, and correct what the others are expected to have: errors have no noise,
	// and the slack is wide against that of a time.
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

	// What is to be little, and what is bounded.
	double wanted(std::size_t i) const
	{
		return m_goal.budget_s ? m_made.tried[i].error : m_made.tried[i].time_s;
	}
	double bounded(std::size_t i) const
	{
		return m_goal.budget_s ? m_made.tried[i].time_s / *m_goal.budget_s : m_made.tried[i].error / *m_goal.max_error;
	}

	double slackAt(std::size_t rung) const
	{
		return m_settings.rungs[rung].scale == 1.0 ? kFullSizeSlack : m_goal.budget_s ? kTimeSlack : kErrorSlack;
	}

	// Those that go on.
	std::vector<std::size_t> best(const std::vector<std::size_t>& left, std::size_t rung) const
	{
		const double share = m_settings.rungs[rung].scale < 1.0 ? m_settings.keep_coarse : m_settings.keep_full;
		const auto shared = static_cast<std::size_t>(std::ceil(share * static_cast<double>(left.size())));
		const auto count = std::min(left.size(), std::max(m_settings.least, shared));
		const auto within = static_cast<std::size_t>(std::ceil(kWithin * static_cast<double>(count)));
		std::vector<std::size_t> by_wanted = left;
		std::stable_sort(by_wanted.begin(), by_wanted.end(),
						 [this](std::size_t a, std::size_t b) { return wanted(a) < wanted(b); });
		std::vector<std::size_t> by_bounded = left;
		std::stable_sort(by_bounded.begin(), by_bounded.end(),
						 [this](std::size_t a, std::size_t b) { return bounded(a) < bounded(b); });
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
		if (bounded(by_bounded.front()) > 1.0)
		{
			keep(by_bounded.front()); // nothing may reach the bound: then this is what comes nearest
		}
		for (const auto& [slack, until] : {std::pair(1.0, within), std::pair(slackAt(rung), count)})
		{
			for (std::size_t k = 0; k < by_wanted.size() && kept.size() < until; ++k)
			{
				if (bounded(by_wanted[k]) <= slack)
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

	// Of those that were drawn once on all views, the ones that can be the pick, best first; if none can, the nearest.
	std::vector<std::size_t> possible(const std::vector<std::size_t>& left) const
	{
		const double slack = m_goal.budget_s ? kOnceSlack : 1.0; // of what is bounded
		double least = kNone;                                    // wanted, of those that are surely within the bound
		for (const std::size_t i : left)
		{
			least = bounded(i) <= 1.0 / slack ? std::min(least, wanted(i)) : least;
		}
		least *= m_goal.budget_s ? 1.0 : kOnceSlack;
		std::vector<std::size_t> kept;
		std::copy_if(left.begin(), left.end(), std::back_inserter(kept),
					 [&](std::size_t i) { return bounded(i) <= slack && wanted(i) <= least; });
		std::stable_sort(kept.begin(), kept.end(), [this](std::size_t a, std::size_t b) { return wanted(a) < wanted(b); });
		if (kept.empty() && !left.empty())
		{
			kept.push_back(*std::min_element(left.begin(), left.end(),
											 [this](std::size_t a, std::size_t b) { return bounded(a) < bounded(b); }));
		}
		return kept;
	}

	void choose()
	{
		m_made.pick.reset();
		m_made.runner_up.reset();
		m_made.nearest.reset();
		const auto better = [this](std::size_t i, const std::optional<std::size_t>& known)
		{
			return bounded(i) <= 1.0 && (!known || wanted(i) < wanted(*known));
		};
		for (const Tried& tried : m_made.tried)
		{
			const std::size_t i = tried.candidate;
			if (isFrom(tried, last()))
			{
				m_made.nearest = !m_made.nearest || bounded(i) < bounded(*m_made.nearest) ? i : m_made.nearest;
				m_made.pick = better(i, m_made.pick) ? i : m_made.pick;
			}
		}
		for (const Tried& tried : m_made.tried)
		{
			const std::size_t i = tried.candidate;
			m_made.runner_up =
				isFrom(tried, m_settings.once()) && i != m_made.pick && better(i, m_made.runner_up) ? i : m_made.runner_up;
		}
		if (m_made.pick)
		{
			m_made.nearest.reset();
		}
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

	const TuneGoal& m_goal;
	const TuneSearchSettings& m_settings;
	const MeasureTrial& m_measure;
	const Progress& m_progress;
	std::map<std::size_t, Trial> m_anchors;
	TuneSearch m_made;
};

} // namespace

TuneSearch searchCandidates(std::size_t candidates, const TuneGoal& goal, const TuneSearchSettings& settings,
							const MeasureTrial& measure, const Progress& progress)
{
	return Search(candidates, goal, settings, measure, progress).halve();
}

TuneSearch searchGrid(std::size_t candidates, const TuneGoal& goal, const TuneSearchSettings& settings, const MeasureTrial& measure,
					  const TuneSearch* known, const Progress& progress)
{
	return Search(candidates, goal, settings, measure, progress).whole(known);
}

std::vector<std::size_t> frontOf(const TuneSearch& search, std::size_t rung)
{
	std::vector<std::size_t> front;
	for (const Tried& tried : search.tried)
	{
		if (isFrom(tried, rung))
		{
			front.push_back(tried.candidate);
		}
	}
	std::stable_sort(front.begin(), front.end(),
					 [&search](std::size_t a, std::size_t b)
					 {
						 const Tried& one = search.tried[a];
						 const Tried& other = search.tried[b];
						 return one.time_s != other.time_s ? one.time_s < other.time_s : one.error < other.error;
					 });
	double least = kNone;
	std::vector<std::size_t> kept;
	for (const std::size_t i : front)
	{
		if (search.tried[i].error < least)
		{
			least = search.tried[i].error;
			kept.push_back(i);
		}
	}
	return kept;
}

} // namespace nook
