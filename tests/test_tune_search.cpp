// SPDX-License-Identifier: GPL-3.0-or-later
// The search of nook tune on grids whose every value is known.
#include "testing.h"

#include "study/tune.h"
#include "study/tune_search.h"

namespace
{

constexpr std::size_t kTuneViews = 6; // three of each of two levels

// Methods × counts × filters × resolutions, each with a time, an error on each view, and how noisy clocks are.
class Grid
{
public:
	// part: of a drawing's time that does not depend on the pixels; noise: relative, of times
	Grid(uint32_t seed, double part, double noise) : m_part(part), m_noise(noise), m_random(seed)
	{
		for (int method = 0; method < 6; ++method)
		{
			const double cost = std::exp(1.5 * m_random.uniform());
			const double floor = 0.02 + 0.08 * m_random.uniform(); // what the method leaves out
			const double slope = 0.4 + 0.6 * m_random.uniform();
			for (const int count : {3, 4, 6, 9, 12, 16, 24})
			{
				for (const int filter : {0, 1, 2})
				{
					for (const double resolution : {1.0, 0.25})
					{
						const double time = 1e-3 * (cost * count * resolution + 0.8 * filter + (resolution < 1.0 ? 0.4 : 0.0));
						const double samples = count * (1.0 + 3.0 * filter) * (resolution < 1.0 ? 0.6 : 1.0);
						const double error = floor + (resolution < 1.0 ? 0.004 : 0.0) + 0.25 / std::pow(samples, slope);
						m_times.push_back(time);
						std::vector<double> errors;
						for (std::size_t view = 0; view < kTuneViews; ++view)
						{
							// Hard views are hard for all, and a little more for some.
							errors.push_back(error * (0.7 + 0.12 * static_cast<double>(view)) * (0.95 + 0.1 * m_random.uniform()));
						}
						m_errors.push_back(errors);
					}
				}
			}
		}
	}

	std::size_t size() const
	{
		return m_times.size();
	}

	Trial measure(std::size_t i, const Fidelity& fidelity)
	{
		Trial trial;
		for (std::size_t view = 0; view < fidelity.views; ++view)
		{
			const double pixels = fidelity.scale * fidelity.scale;
			const double exact = m_times[i] * (m_part + (1.0 - m_part) * pixels);
			std::vector<double> drawn;
			for (int k = 0; k < std::max(fidelity.repetitions, 1); ++k)
			{
				// Mostly a little more, now and then much more.
				const double late = m_random.uniform() < 0.03 ? 1.0 : 0.0;
				drawn.push_back(exact * (1.0 + m_noise * (m_random.uniform() + late)));
				trial.cost_s += drawn.back();
			}
			trial.cost_s += exact; // warms up
			trial.pictures += pixels * (1.0 + fidelity.repetitions);
			std::sort(drawn.begin(), drawn.end());
			const double coarse = 1.0 + 0.1 * (1.0 - fidelity.scale); // coarse pictures have larger errors
			trial.views.push_back({view % 2, drawn[drawn.size() / 2], drawn.front(), drawn.back(), coarse * m_errors[i][view]});
		}
		return trial;
	}

	// Without noise, as the search adds up.
	double time(std::size_t i) const
	{
		return m_times[i];
	}
	double error(std::size_t i, OverLevels over) const
	{
		Trial trial;
		for (std::size_t view = 0; view < kTuneViews; ++view)
		{
			trial.views.push_back({view % 2, 0.0, 0.0, 0.0, m_errors[i][view]});
		}
		return errorOf(trial, over);
	}

private:
	double m_part;
	double m_noise;
	Random m_random;
	std::vector<double> m_times;
	std::vector<std::vector<double>> m_errors;
};

TuneSearchSettings rungs()
{
	return {{{0.5, 1, 1}, {1.0, 2, 1}, {1.0, kTuneViews, 1}, {1.0, kTuneViews, 5}}};
}

// Measures everything at the last rung.
TuneSearch searchGrid(std::size_t candidates, const TuneGoal& goal, const TuneSearchSettings& settings, const MeasureTrial& measure)
{
	TuneSearch all;
	for (std::size_t i = 0; i < candidates; ++i)
	{
		const Trial trial = measure(i, settings.rungs.back());
		all.tried.push_back({i, settings.rungs.size() - 1, trial, timeOf(trial, goal.over), errorOf(trial, goal.over), {}});
		all.cost_s += trial.cost_s;
		all.pictures += trial.pictures;
	}
	return chooseOf(all, goal, settings);
}

struct Outcome
{
	int within = 0; // runs whose pick is at most 5 % worse than the best of the grid
	int runs = 0;
	double worst = 1.0;
	double greatest_cost = 0.0; // of the grid's
};

// The goal is so that a third to nearly all of the grid reaches it.
Outcome outcomeOf(bool of_time, OverLevels over, double part, double noise, uint32_t seeds = 10)
{
	Outcome outcome;
	for (uint32_t seed = 1; seed <= seeds; ++seed)
	{
		for (const double share : {0.05, 0.3, 0.6, 0.95})
		{
			Grid grid(seed, part, noise);
			std::vector<double> bounds =
				listOf(grid.size(), [&](std::size_t i) { return of_time ? grid.time(i) : grid.error(i, over); });
			std::sort(bounds.begin(), bounds.end());
			const double bound = 1.05 * bounds[static_cast<std::size_t>(share * static_cast<double>(bounds.size()))];
			TuneGoal goal;
			goal.over = over;
			(of_time ? goal.budget_s : goal.max_error) = bound;
			const TuneSearchSettings settings = rungs();
			const MeasureTrial measure = [&grid](std::size_t i, const Fidelity& fidelity)
			{
				return grid.measure(i, fidelity);
			};
			const TuneSearch found = searchCandidates(grid.size(), goal, settings, measure);
			const TuneSearch all = searchGrid(grid.size(), goal, settings, measure);
			REQUIRE(found.pick);
			REQUIRE(all.pick);
			const auto value = [&](std::size_t i)
			{
				return of_time ? grid.error(i, over) : grid.time(i);
			};
			const double ratio = value(*found.pick) / value(*all.pick);
			outcome.runs += 1;
			outcome.within += ratio <= 1.05 ? 1 : 0;
			outcome.worst = std::max(outcome.worst, ratio);
			outcome.greatest_cost = std::max(outcome.greatest_cost, found.cost_s / all.cost_s);
			CHECK(reaches(goal, found.tried[*found.pick].time_s, found.tried[*found.pick].error));
		}
	}
	return outcome;
}

// Candidates of known times and errors, on four views that differ by `spread` for the second one of each pair.
MeasureTrial known(const std::vector<double>& times, const std::vector<double>& errors, double spread)
{
	return [=](std::size_t i, const Fidelity& fidelity)
	{
		Trial trial;
		for (std::size_t view = 0; view < fidelity.views; ++view)
		{
			const double pixels = fidelity.scale * fidelity.scale;
			const double off = i % 2 == 0 ? 0.0 : view % 2 == 0 ? spread : -spread;
			const double time = times[i] * pixels;
			trial.views.push_back({0, time, 0.99 * time, 1.01 * time, errors[i] + off});
		}
		return trial;
	};
}

TuneSearchSettings fourViews()
{
	return {{{0.5, 1, 1}, {1.0, 2, 1}, {1.0, 4, 1}, {1.0, 4, 5}}};
}

} // namespace

TEST_CASE("tune: within 5 % of the grid's best for at most a fifth of its cost", "[tune]")
{
	const bool of_time = GENERATE(true, false);
	const OverLevels over = GENERATE(OverLevels::mean, OverLevels::worst);
	// Drawings whose time is that of their pixels, as on a CPU, and such that are mostly passes, as on a GPU.
	const double part = GENERATE(0.02, 0.6);
	const Outcome outcome = outcomeOf(of_time, over, part, 0.05);
	INFO((of_time ? "budget" : "error") << (over == OverLevels::mean ? ", mean" : ", worst") << ", fixed part " << part << ": "
										<< outcome.within << " of " << outcome.runs << ", worst " << outcome.worst << ", cost "
										<< outcome.greatest_cost);
	CHECK(outcome.within >= outcome.runs - 1);
	CHECK(outcome.worst <= 1.15);
	CHECK(outcome.greatest_cost <= 0.2);
}

TEST_CASE("tune: from 18 candidates on at most a fifth of the pixels that the grid draws", "[tune]")
{
	const std::size_t step =
		GENERATE(std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{7}, std::size_t{14}); // 252 to 18 candidates
	const double share = GENERATE(0.05, 0.3, 0.6, 0.95);
	Grid grid(7, 0.1, 0.05);
	const std::size_t candidates = grid.size() / step;
	const MeasureTrial measure = [&](std::size_t i, const Fidelity& fidelity)
	{
		return grid.measure(step * i, fidelity);
	};
	const bool of_time = GENERATE(true, false);
	std::vector<double> bounds;
	for (std::size_t i = 0; i < candidates; ++i)
	{
		bounds.push_back(of_time ? grid.time(step * i) : grid.error(step * i, OverLevels::mean));
	}
	std::sort(bounds.begin(), bounds.end());
	TuneGoal goal;
	(of_time ? goal.budget_s : goal.max_error) = 1.05 * bounds[static_cast<std::size_t>(share * static_cast<double>(candidates))];
	const TuneSearchSettings settings = rungsFor(kTuneViews, 7);
	const TuneSearch found = searchCandidates(candidates, goal, settings, measure);
	const TuneSearch all = searchGrid(candidates, goal, settings, measure);
	REQUIRE(found.pick);
	CHECK(all.pictures == static_cast<double>(candidates * kTuneViews * 8));
	INFO(candidates << " candidates, " << (of_time ? "budget" : "error") << " of " << share);
	CHECK(found.pictures <= 0.2 * all.pictures);
}

TEST_CASE("tune: clocks that are off by a quarter seldom change the pick", "[tune]")
{
	const Outcome outcome = outcomeOf(true, OverLevels::mean, 0.1, 0.25, 40);
	INFO(outcome.within << " of " << outcome.runs << ", worst " << outcome.worst << ", cost " << outcome.greatest_cost);
	CHECK(10 * outcome.within >= 9 * outcome.runs);
	CHECK(outcome.worst <= 2.0);
	CHECK(outcome.greatest_cost <= 0.2);
}

TEST_CASE("tune: a budget that nothing meets has a nearest candidate and no pick", "[tune]")
{
	Grid grid(3, 0.1, 0.0);
	const MeasureTrial measure = [&grid](std::size_t i, const Fidelity& fidelity)
	{
		return grid.measure(i, fidelity);
	};
	std::size_t fastest = 0;
	std::size_t best = 0;
	for (std::size_t i = 0; i < grid.size(); ++i)
	{
		fastest = grid.time(i) < grid.time(fastest) ? i : fastest;
		best = grid.error(i, OverLevels::mean) < grid.error(best, OverLevels::mean) ? i : best;
	}
	const TuneSearch slow = searchCandidates(grid.size(), {0.5 * grid.time(fastest), {}, OverLevels::mean}, rungs(), measure);
	CHECK_FALSE(slow.pick);
	REQUIRE(slow.nearest);
	CHECK(grid.time(*slow.nearest) == grid.time(fastest));
	const TuneSearch bad =
		searchCandidates(grid.size(), {{}, 0.5 * grid.error(best, OverLevels::mean), OverLevels::mean}, rungs(), measure);
	CHECK_FALSE(bad.pick);
	REQUIRE(bad.nearest);
	CHECK(grid.error(*bad.nearest, OverLevels::mean) <= 1.05 * grid.error(best, OverLevels::mean));
}

TEST_CASE("tune: candidates that cannot be drawn are left out, and said why", "[tune]")
{
	Grid grid(4, 0.1, 0.0);
	const MeasureTrial measure = [&grid](std::size_t i, const Fidelity& fidelity)
	{
		// Some never, some not at full size.
		if (i % 3 == 0 || (i % 3 == 1 && fidelity.scale == 1.0))
		{
			throw Error(ExitCode::unsupported, "no");
		}
		return grid.measure(i, fidelity);
	};
	const TuneSearch found = searchCandidates(grid.size(), {0.02, {}, OverLevels::mean}, rungs(), measure);
	REQUIRE(found.pick);
	CHECK(*found.pick % 3 == 2);
	for (const Tried& tried : found.tried)
	{
		CHECK((tried.candidate % 3 != 0 || tried.failed == "no"));
	}
	const TuneSearch none =
		searchCandidates(5, {0.02, {}, OverLevels::mean}, rungs(),
						 [](std::size_t, const Fidelity&) -> Trial { throw Error(ExitCode::unsupported, "no"); });
	CHECK_FALSE(none.pick);
	CHECK_FALSE(none.nearest);
}

TEST_CASE("tune: the front has less error with every longer time", "[tune]")
{
	Grid grid(5, 0.1, 0.02);
	const MeasureTrial measure = [&grid](std::size_t i, const Fidelity& fidelity)
	{
		return grid.measure(i, fidelity);
	};
	const TuneSearch all = searchGrid(grid.size(), {0.02, {}, OverLevels::mean}, rungs(), measure);
	const std::vector<std::size_t> front = frontOf(all, 3);
	REQUIRE(front.size() > 3);
	for (const Tried& tried : all.tried)
	{
		// Each candidate is on the front, or some of the front is as fast and as good.
		CHECK(std::any_of(front.begin(), front.end(),
						  [&](std::size_t i) { return all.tried[i].time_s <= tried.time_s && all.tried[i].error <= tried.error; }));
	}
	for (std::size_t k = 1; k < front.size(); ++k)
	{
		CHECK(all.tried[front[k]].time_s > all.tried[front[k - 1]].time_s);
		CHECK(all.tried[front[k]].error < all.tried[front[k - 1]].error);
	}
}

TEST_CASE("tune: two candidates differ when their differences agree over views", "[tune]")
{
	const auto trial = [](std::vector<double> errors, double low, double high)
	{
		Trial made;
		for (const double error : errors)
		{
			made.views.push_back({0, 0.5 * (low + high), low, high, error});
		}
		return made;
	};
	const CandidateComparison sure = compareTrials(trial({0.1, 0.2, 0.3}, 1.0, 1.1), trial({0.11, 0.212, 0.311}, 1.2, 1.3));
	CHECK(sure.errors_differ);
	CHECK(sure.times_differ == std::optional(true));
	CHECK(sure.error_difference == Approx(0.011));
	// The standard error of the mean of 0.010, 0.012, 0.011.
	CHECK(*sure.error_standard == Approx(0.001 / std::sqrt(3.0)));
	const CandidateComparison unsure = compareTrials(trial({0.1, 0.2, 0.3}, 1.0, 1.2), trial({0.12, 0.19, 0.305}, 1.1, 1.3));
	CHECK_FALSE(unsure.errors_differ);
	CHECK(unsure.times_differ == std::optional(false));
	CHECK_FALSE(compareTrials(trial({0.1, 0.2}, 1.0, 1.1), trial({0.2, 0.3}, 1.3, 1.3)).times_differ.has_value()); // drawn once
	const CandidateComparison one = compareTrials(trial({0.1}, 1.0, 1.1), trial({0.2}, 1.0, 1.1));
	CHECK_FALSE(one.errors_differ);
	CHECK_FALSE(one.error_standard.has_value());
}

TEST_CASE("tune: of errors that do not differ significantly the cheapest is taken", "[tune]")
{
	const std::vector<double> times{0.053, 0.017, 0.017, 0.004};
	const TuneGoal goal{0.06, {}, OverLevels::mean};
	// 0.0801 in a third of the time of 0.0797, now more, now less in a view.
	const TuneSearch alike = searchCandidates(4, goal, fourViews(), known(times, {0.0797, 0.0801, 0.0900, 0.2}, 0.002));
	REQUIRE(alike.pick);
	CHECK(*alike.pick == 1);
	CHECK(alike.instead_of == std::optional<std::size_t>(0));
	CHECK(alike.runner_up == std::optional<std::size_t>(0));
	CHECK(isFrom(alike.tried[1], 3)); // drawn in full
	// Equal in every view: it is significant.
	const TuneSearch sure = searchCandidates(4, goal, fourViews(), known(times, {0.0797, 0.0801, 0.0900, 0.2}, 0.0));
	CHECK(*sure.pick == 0);
	CHECK_FALSE(sure.instead_of);
	// A twentieth more is more, however much views differ.
	const TuneSearch far = searchCandidates(4, goal, fourViews(), known(times, {0.0797, 0.0840, 0.0900, 0.2}, 0.02));
	CHECK(*far.pick == 0);
	// No reason for more error: it takes no less time.
	const TuneSearch slow =
		searchCandidates(4, goal, fourViews(), known({0.053, 0.052, 0.06, 0.004}, {0.0797, 0.0801, 0.09, 0.2}, 0.002));
	CHECK(*slow.pick == 0);
	// A bound that is missed: the cheapest of those that come nearest.
	const TuneSearch missed =
		searchCandidates(4, {{}, 0.05, OverLevels::mean}, fourViews(), known(times, {0.0797, 0.0801, 0.0900, 0.2}, 0.002));
	CHECK_FALSE(missed.pick);
	CHECK(missed.nearest == std::optional<std::size_t>(1));
	CHECK(missed.taken() == missed.nearest);
}

TEST_CASE("tune: what takes no time is searched as others are", "[tune]")
{
	const auto bytes = [](const MeasureTrial& measure)
	{
		return [measure](std::size_t i, const Fidelity& fidelity)
		{
			Trial trial = measure(i, fidelity);
			for (ViewTrial& view : trial.views)
			{
				view.bytes = 1000 * (8 - i); // the later, the fewer
			}
			return trial;
		};
	};
	const std::vector<double> times{0.053, 0.017, 0.0, 0.0, 0.004, 0.009};
	const std::vector<double> errors{0.0797, 0.0801, 0.0400, 0.0402, 0.2, 0.1};
	const MeasureTrial measure = bytes(known(times, errors, 0.002));
	// Least error; of two that are alike in error and in time the one that needs fewer bytes.
	const TuneSearch budget = searchCandidates(6, {0.06, {}, OverLevels::mean}, fourViews(), measure);
	REQUIRE(budget.pick);
	CHECK(*budget.pick == 3);
	CHECK(budget.instead_of == std::optional<std::size_t>(2));
	CHECK(bytesOf(budget.tried[3].trial) == 5000);
	// Least time.
	const TuneSearch error = searchCandidates(6, {{}, 0.05, OverLevels::mean}, fourViews(), measure);
	REQUIRE(error.pick);
	CHECK(error.tried[*error.pick].time_s == 0.0);
	REQUIRE(error.pick == searchGrid(6, {{}, 0.05, OverLevels::mean}, fourViews(), measure).pick);
	// The others' times are scaled by others alone: what is expected of the slowest is what it takes.
	const TuneSearch other = searchCandidates(6, {{}, 0.09, OverLevels::mean}, fourViews(), known(times, errors, 0.0));
	for (const Tried& tried : other.tried)
	{
		CHECK(tried.time_s == Approx(times[tried.candidate]).margin(1e-12));
	}
	const CandidateComparison found = compareTrials(budget.tried[3].trial, budget.tried[2].trial);
	CHECK_FALSE(found.time_ratio.has_value());
}

TEST_CASE("tune: nothing is only expected to be better than the pick", "[tune]")
{
	const bool of_time = GENERATE(true, false);
	for (uint32_t seed = 1; seed <= 10; ++seed)
	{
		Grid grid(seed, 0.3, 0.1);
		const MeasureTrial measure = [&grid](std::size_t i, const Fidelity& fidelity)
		{
			return grid.measure(i, fidelity);
		};
		const TuneGoal goal{of_time ? std::optional(0.02) : std::nullopt, of_time ? std::nullopt : std::optional(0.08),
							OverLevels::mean};
		const TuneSearchSettings settings = rungs();
		const TuneSearch found = searchCandidates(grid.size(), goal, settings, measure);
		REQUIRE(found.pick);
		const Tried& best = found.tried[found.instead_of.value_or(*found.pick)];
		for (const Tried& tried : found.tried)
		{
			const bool within = of_time ? tried.time_s <= 0.02 : tried.error <= 0.08;
			const bool less = of_time ? tried.error < best.error : tried.time_s < best.time_s;
			const bool measured = isFrom(tried, settings.rungs.size() - 1);
			INFO(tried.candidate << " in place of " << best.candidate << ", seed " << seed);
			CHECK((measured || !within || !less));
			// Where an error is minimised, the second of two that are alike is taken if it is faster.
			if (of_time && within && !measured && isFrom(tried, settings.once()) && tried.error <= 1.02 * best.error &&
				tried.time_s <= 0.95 * best.time_s && tried.time_s < found.tried[*found.pick].time_s)
			{
				CHECK(compareTrials(best.trial, tried.trial).errors_differ);
			}
		}
	}
}
