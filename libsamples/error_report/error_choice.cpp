// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_report/error_choice.h"

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

// Methods by the places that their rows give them: papers' recipes, rays, nook's forms.
std::vector<std::string> shownMethods()
{
	std::map<int, std::string> papers;
	std::map<int, std::string> ours;
	for (const MethodRow& row : methodTable())
	{
		papers.emplace(row.shown_paper, std::string(row.name) + kOfPaper);
		ours.emplace(row.shown_ours, row.name);
	}
	std::vector<std::string> shown;
	const auto add = [&shown](const std::map<int, std::string>& placed)
	{
		for (const auto& [place, key] : placed)
		{
			if (place > 0)
			{
				shown.push_back(key);
			}
		}
	};
	add(papers);
	shown.emplace_back("rays");
	add(ours);
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

// Of each method and origin.
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

std::vector<Candidate> sweepOf(const std::vector<Candidate>& grid)
{
	std::vector<Candidate> sweep;
	std::set<const MethodRow*> swept;
	for (const Candidate& candidate : grid)
	{
		const MethodRow* const row = candidate.row();
		const bool wanted = candidate.origin == Origin::paper && candidate.resolution() == "full" &&
							candidate.thickness_ratio == 0.0 && row != nullptr && row->swept &&
							(row->swept_count == 0 || candidate.count == row->swept_count);
		if (!wanted || !swept.insert(row).second)
		{
			continue;
		}
		for (const double scale : {0.5, 0.75, 1.0, 1.5, 2.0})
		{
			Candidate scaled = candidate;
			scaled.scale = scale;
			scaled.shade.filter = ShadeFilter::none;
			if (candidate.kind != CandidateKind::volumes || scale <= 1.0)
			{
				sweep.push_back(scaled);
			}
		}
	}
	return sweep;
}

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
