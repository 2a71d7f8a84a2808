// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/error_points.h"

#include "methods/method_table.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

namespace nook
{
namespace
{

constexpr const char* kOfPaper = " paper";

// Keys of bestOf() in the order in which pictures are shown: papers' recipes, rays, nook's forms. A method that is not among them
// is shown where it holds the front.
const std::vector<std::string>& shownMethods()
{
	static const std::vector<std::string> shown{"vo-line paper", "aov paper", "alchemy paper", "statvo paper", "vo-point paper",
												"hbao paper",    "rays",      "aov",           "vo-line",      "alchemy",
												"aov-mask",      "statvo",    "slices"};
	return shown;
}

std::vector<std::size_t> frontOf(const ErrorView& view)
{
	std::vector<std::size_t> front;
	for (std::size_t i = 0; i < view.points.size(); ++i)
	{
		if (view.points[i].front)
		{
			front.push_back(i);
		}
	}
	return front;
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
		if (!fresh && point.measured.errors.eq14 < view.points[found->second].measured.errors.eq14)
		{
			found->second = i;
		}
	}
	return best;
}

} // namespace

std::vector<std::size_t> framesPoints(const std::vector<Candidate>& candidates, const ErrorView& view)
{
	std::map<std::string, std::size_t> best;
	const auto before = [&](std::size_t a, std::size_t b)
	{
		const auto rank = [&](std::size_t i)
		{
			return std::tuple(candidates[i].shade.filter == ShadeFilter::none, candidates[i].shade.half_resolution,
							  candidates[i].count, view.points[i].measured.errors.rmse);
		};
		return rank(a) < rank(b);
	};
	for (std::size_t i = 0; i < candidates.size(); ++i)
	{
		if (candidates[i].kind == CandidateKind::screen && hasNoise(*candidates[i].row()))
		{
			const auto [found, fresh] = best.emplace(candidates[i].method(), i);
			found->second = !fresh && before(i, found->second) ? i : found->second;
		}
	}
	std::vector<std::size_t> chosen;
	for (const auto& [method, i] : best)
	{
		chosen.push_back(i);
	}
	std::sort(chosen.begin(), chosen.end());
	return chosen;
}

std::set<std::size_t> chosenPoints(const ErrorView& view, std::size_t count)
{
	std::vector<std::size_t> front = frontOf(view);
	const std::map<std::string, std::size_t> best = bestOf(view);
	std::sort(front.begin(), front.end(),
			  [&](std::size_t a, std::size_t b)
			  { return view.points[a].measured.total.median_s < view.points[b].measured.total.median_s; });
	std::set<std::size_t> chosen;
	const std::size_t of_front = std::min(front.size(), (count + 1) / 2);
	for (std::size_t i = 0; i < of_front; ++i)
	{
		chosen.insert(front[of_front == 1 ? 0 : i * (front.size() - 1) / (of_front - 1)]);
	}
	for (const std::string& key : shownMethods())
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
