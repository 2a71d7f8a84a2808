// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Kevin Jamieson and Ameet Talwalkar, Non-stochastic Best Arm Identification and Hyperparameter
// Optimization, 2016 (successive halving). Ours keeps a share other than a half, ranks by a goal with a bound, and scales times by
// anchors.
#include "study/tune_search.h"
#include "study/tune_choice.h"

#include "core/error.h"
#include "study/front.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <exception>
#include <map>

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
		std::vector<std::size_t> left = all();
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
		left.erase(std::remove_if(left.begin(), left.end(), [this](std::size_t i) { return !m_made.tried[i].failed.empty(); }),
				   left.end());
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

} // namespace

TuneSearch searchCandidates(std::size_t candidates, const TuneGoal& goal, const TuneSearchSettings& settings,
							const MeasureTrial& measure, const Progress& progress)
{
	return HalvingSearch(candidates, goal, settings, measure, progress).halve();
}

TuneSearch searchGrid(std::size_t candidates, const TuneGoal& goal, const TuneSearchSettings& settings, const MeasureTrial& measure,
					  const TuneSearch* known, const Progress& progress)
{
	return HalvingSearch(candidates, goal, settings, measure, progress).whole(known);
}

std::vector<std::size_t> frontOf(const TuneSearch& search, std::size_t rung)
{
	std::vector<FrontPlace> places;
	for (const Tried& tried : search.tried)
	{
		if (isFrom(tried, rung))
		{
			places.push_back({tried.candidate, tried.time_s, tried.error});
		}
	}
	return frontOf(std::move(places));
}

} // namespace nook
