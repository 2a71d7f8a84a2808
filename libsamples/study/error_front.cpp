// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the best candidate at each budget of time, and errors that have grown since an earlier report.
#include "core/decimal.h"
#include "core/error.h"
#include "core/lists.h"
#include "study/error_report.h"
#include "study/front.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>

namespace nook
{
namespace
{

double timeOf(const ErrorPoint& point)
{
	return point.measured.total.median_s;
}

double errorOf(const ErrorPoint& point)
{
	return point.measured.errors.eq14;
}

// Least error of what takes no more than `seconds`, among those of an origin; null where there is nothing.
const ErrorPoint* bestWithin(const std::vector<ErrorPoint>& points, Origin origin, double seconds)
{
	const ErrorPoint* best = nullptr;
	for (const ErrorPoint& point : points)
	{
		if (point.origin == origin && timeOf(point) > 0.0 && timeOf(point) <= seconds &&
			(best == nullptr || errorOf(point) < errorOf(*best)))
		{
			best = &point;
		}
	}
	return best;
}

// `budgets`: times at which something becomes affordable.
void setShare(ErrorView& view, const std::vector<double>& budgets)
{
	FrontShare& share = view.share;
	share = {};
	double held = 0.0;
	for (std::size_t i = 0; i < budgets.size(); ++i)
	{
		const ErrorPoint* const ours = bestWithin(view.points, Origin::ours, budgets[i]);
		const ErrorPoint* const paper = bestWithin(view.points, Origin::paper, budgets[i]);
		const bool leads = ours != nullptr && (paper == nullptr || errorOf(*ours) <= errorOf(*paper));
		if (leads && i + 1 < budgets.size())
		{
			held += std::log(budgets[i + 1] / budgets[i]);
		}
		if (!leads && ours != nullptr)
		{
			const double ratio = errorOf(*ours) / errorOf(*paper);
			if (!share.worst_ratio || ratio > *share.worst_ratio)
			{
				share.worst_ratio = ratio;
				share.worst_paper = paper->name;
			}
		}
	}
	const double all = budgets.size() > 1 ? std::log(budgets.back() / budgets.front()) : 0.0;
	share.held = all > 0.0 ? held / all : 0.0;
	share.papers = mapped(itemsWhere(view.points, [](const ErrorPoint& p) { return p.front && p.origin == Origin::paper; }),
						  [](const ErrorPoint& point) { return point.name; });
}

const ErrorView* viewNamed(const ErrorReport& report, const std::string& level, const std::string& camera)
{
	for (const ErrorLevel& one : report.levels)
	{
		for (const ErrorView& view : one.views)
		{
			if (one.name == level && view.camera == camera)
			{
				return &view;
			}
		}
	}
	return nullptr;
}

void requireSame(const std::string& where, const char* what, double before, double now)
{
	refuseIf(before != now, "baseline: " + where + ": " + what + ": found " + numberText(before) + ", expected " + numberText(now),
			 ExitCode::invalid_input);
}

void compareViews(const std::string& level, const ErrorView& before, const ErrorView& now, BaselineResult& result)
{
	constexpr double kShare = 0.02; // errors are the same from run to run on one renderer; another one rounds differently
	const std::string where = level + ", " + before.camera;
	requireSame(where, "width", before.width_px, now.width_px);
	requireSame(where, "height", before.height_px, now.height_px);
	for (const ErrorPoint& old : before.points)
	{
		const ErrorPoint* const fresh = firstWhere(now.points, [&](const ErrorPoint& point) { return point.name == old.name; });
		if (fresh == nullptr)
		{
			result.missing.push_back(where + ", " + old.name);
			continue;
		}
		result.compared += 1;
		for (const auto& [metric, was, is, least] :
			 {std::tuple<const char*, double, double, double>{"eq14", errorOf(old), errorOf(*fresh), 2e-3},
			  {"rmse", old.measured.errors.rmse, fresh->measured.errors.rmse, 2e-4}})
		{
			if (is > was * (1.0 + kShare) + least)
			{
				result.regressions.push_back({level, before.camera, old.name, metric, was, is});
			}
		}
	}
}

constexpr const char* kOfPaper = " paper";

// Keys of bestOf() in the order in which pictures are shown: papers' recipes, rays, nook's forms. A method that is not among them
// is shown where it holds the front.
constexpr std::array<const char*, 13> kShown{"vo-line paper", "aov paper", "alchemy paper", "statvo paper", "vo-point paper",
											 "hbao paper",    "rays",      "aov",           "vo-line",      "alchemy",
											 "aov-mask",      "statvo",    "slices"};

std::vector<std::size_t> frontOf(const ErrorView& view)
{
	return indicesWhere(view.points.size(), [&](std::size_t i) { return view.points[i].front; });
}

// Returns the point with the least error of each method and origin.
std::map<std::string, std::size_t> bestOf(const ErrorView& view)
{
	std::map<std::string, std::size_t> best;
	for (std::size_t i = 0; i < view.points.size(); ++i)
	{
		const ErrorPoint& point = view.points[i];
		const std::string key = point.method + (point.origin == Origin::paper ? kOfPaper : "");
		const auto [found, fresh] = best.emplace(key, i);
		if (!fresh && errorOf(point) < errorOf(view.points[found->second]))
		{
			found->second = i;
		}
	}
	return best;
}

} // namespace

void setFront(ErrorView& view)
{
	std::vector<FrontPlace> by_bytes;
	std::vector<FrontPlace> by_time;
	std::set<double> times;
	for (std::size_t i = 0; i < view.points.size(); ++i)
	{
		ErrorPoint& point = view.points[i];
		point.front = false;
		point.front_bytes = false;
		if (point.measured.bytes > 0)
		{
			by_bytes.push_back({i, static_cast<double>(point.measured.bytes), errorOf(point)});
		}
		if (point.origin != Origin::rays && timeOf(point) > 0.0)
		{
			by_time.push_back({i, timeOf(point), errorOf(point)});
			times.insert(timeOf(point));
		}
	}
	for (const std::size_t i : frontOf(by_bytes))
	{
		view.points[i].front_bytes = true;
	}
	double slowest = 0.0;
	for (const std::size_t i : frontOf(by_time))
	{
		view.points[i].front = true;
		slowest = timeOf(view.points[i]);
	}
	setShare(view, {times.begin(), times.upper_bound(slowest)});
}

BaselineResult compareWithBaseline(const ErrorReport& report, const ErrorReport& baseline)
{
	BaselineResult result;
	requireSame("whole", "rays", baseline.rays, report.rays);
	for (const ErrorLevel& level : baseline.levels)
	{
		for (const ErrorView& before : level.views)
		{
			const ErrorView* const now = viewNamed(report, level.name, before.camera);
			if (now == nullptr)
			{
				result.missing.push_back(level.name + ", " + before.camera);
				continue;
			}
			compareViews(level.name, before, *now, result);
		}
		for (const ErrorLevel& fresh : report.levels)
		{
			if (fresh.name == level.name && fresh.failure.empty() && level.failure.empty())
			{
				requireSame(level.name, "radius", level.radius_m, fresh.radius_m);
			}
		}
	}
	std::stable_sort(result.regressions.begin(), result.regressions.end(),
					 [](const Regression& a, const Regression& b) { return a.now * b.before > b.now * a.before; });
	return result;
}

std::set<std::size_t> chosenPoints(const ErrorView& view, std::size_t count)
{
	std::vector<std::size_t> front = frontOf(view);
	const std::map<std::string, std::size_t> best = bestOf(view);
	std::sort(front.begin(), front.end(),
			  [&](std::size_t a, std::size_t b) { return timeOf(view.points[a]) < timeOf(view.points[b]); });
	std::set<std::size_t> chosen;
	const std::size_t of_front = std::min(front.size(), (count + 1) / 2);
	for (std::size_t i = 0; i < of_front; ++i)
	{
		chosen.insert(front[of_front == 1 ? 0 : i * (front.size() - 1) / (of_front - 1)]);
	}
	for (const char* const key : kShown)
	{
		const auto found = best.find(key);
		if (found != best.end() && chosen.size() < count)
		{
			chosen.insert(found->second);
		}
	}
	return chosen;
}

std::set<std::size_t> likelyPoints(const ErrorView& view)
{
	const std::vector<std::size_t> front = frontOf(view);
	std::set<std::size_t> likely(front.begin(), front.end());
	for (const auto& [key, i] : bestOf(view))
	{
		likely.insert(i);
	}
	return likely;
}

} // namespace nook
