// SPDX-License-Identifier: GPL-3.0-or-later
// What papers say of time and error, held against what was measured.
#include "error_report/error_claims.h"

#include <algorithm>
#include <cmath>

namespace nook
{

std::vector<ClaimPlace> placesOf(const ErrorReport& report)
{
	std::vector<ClaimPlace> places;
	for (const ErrorLevel& level : report.levels)
	{
		for (const ErrorView& view : level.views)
		{
			places.push_back({level.name + ", " + view.camera, &view});
		}
	}
	return places;
}

std::vector<const ErrorPoint*> pointsOf(const ErrorView& view, const CandidateQuery& query)
{
	std::vector<const ErrorPoint*> found;
	for (const ErrorPoint& point : view.points)
	{
		if (point.candidate && fits(*point.candidate, query))
		{
			found.push_back(&point);
		}
	}
	return found;
}

const ErrorPoint* pointOf(const ErrorView& view, const CandidateQuery& query)
{
	const std::vector<const ErrorPoint*> found = pointsOf(view, query);
	return found.empty() ? nullptr : found.front();
}

void JudgedClaim::add(std::vector<std::string> cells, bool holds)
{
	cells.emplace_back(holds ? "holds" : "does not");
	m_claim.rows.push_back(std::move(cells));
	m_told += 1;
	m_held += holds ? 1U : 0U;
}

void JudgedClaim::addOpen(std::vector<std::string> cells)
{
	cells.emplace_back("out of reach");
	m_claim.rows.push_back(std::move(cells));
}

ErrorClaim JudgedClaim::take()
{
	m_claim.verdict = m_told == 0           ? ClaimVerdict::out_of_reach
					  : m_held == m_told    ? ClaimVerdict::confirmed
					  : 2 * m_held > m_told ? ClaimVerdict::mixed
											: ClaimVerdict::refuted;
	m_claim.text += m_told == 0 ? " Nothing here can tell: what it speaks of was not measured."
								: " It holds in " + std::to_string(m_held) + " of " + std::to_string(m_told) + ".";
	return std::move(m_claim);
}

namespace
{

// Error at a time, along straight lines in logarithms between points of one method; none beyond them.
std::optional<double> errorAt(std::vector<std::pair<double, double>> curve, double seconds)
{
	std::sort(curve.begin(), curve.end());
	for (std::size_t i = 0; i + 1 < curve.size(); ++i)
	{
		const auto& [t0, e0] = curve[i];
		const auto& [t1, e1] = curve[i + 1];
		if (t0 <= seconds && seconds <= t1 && t0 > 0.0 && t1 > t0 && e0 > 0.0 && e1 > 0.0)
		{
			const double place = std::log(seconds / t0) / std::log(t1 / t0);
			return std::exp(std::log(e0) + place * std::log(e1 / e0));
		}
	}
	return std::nullopt;
}

// The paper's recipe of a method: VO §4.6, one window of 4 × 4 pixels.
CandidateQuery recipeOf(const MethodRow& row, std::optional<int> count = std::nullopt)
{
	return {&row, count, SampleSource::electro, ShadeFilter::window, std::nullopt};
}

CandidateQuery volumesOf(VolumeRecipe recipe)
{
	CandidateQuery query;
	query.row = &claimedVolumes();
	query.volumes = recipe;
	return query;
}

ErrorClaim linesAgainstPoints(const ErrorReport& report)
{
	JudgedClaim claim(
		{"lines-points",
		 "Line samples beat point samples at equal time.",
		 "VO, abstract and §5",
		 {},
		 "Points' error over that of lines at the same time, between the counts that were measured; both by the paper's "
		 "recipe. Noise is the difference to the method's own limit, which is what the paper speaks of; eq. 14 is against rays. "
		 "Holds where the noise's geometric mean over the counts is above 1.",
		 {"view", "counts of points compared", "noise: points / lines", "eq. 14: points / lines", ""},
		 {}});
	for (const ClaimPlace& place : placesOf(report))
	{
		std::vector<std::pair<double, double>> noise;
		std::vector<std::pair<double, double>> error;
		for (const ErrorPoint* const line : pointsOf(*place.view, recipeOf(claimedLines())))
		{
			noise.emplace_back(claimTime(*line), line->measured.own_rmse.value_or(0.0));
			error.emplace_back(claimTime(*line), line->measured.errors.eq14);
		}
		double noise_ratio = 0.0;
		double error_ratio = 0.0;
		std::string counts;
		int compared = 0;
		for (const ErrorPoint* const point : pointsOf(*place.view, recipeOf(claimedPoints())))
		{
			const std::optional<double> lines_noise = errorAt(noise, claimTime(*point));
			const std::optional<double> lines_error = errorAt(error, claimTime(*point));
			if (lines_noise && lines_error && point->measured.own_rmse.value_or(0.0) > 0.0 && point->measured.errors.eq14 > 0.0)
			{
				noise_ratio += std::log(*point->measured.own_rmse / *lines_noise);
				error_ratio += std::log(point->measured.errors.eq14 / *lines_error);
				counts += (compared > 0 ? ", " : "") + std::to_string(point->count);
				compared += 1;
			}
		}
		if (compared > 0)
		{
			const double ratio = std::exp(noise_ratio / compared);
			claim.add({place.name, counts, shortText(ratio), shortText(std::exp(error_ratio / compared))}, ratio > 1.0);
		}
	}
	return claim.take();
}

ErrorClaim fiveLikeTwelve(const ErrorReport& report)
{
	JudgedClaim claim(
		{"five-twelve",
		 "Five lines look like twelve points.",
		 "VO §5, table 1",
		 {},
		 "Noise (the difference to the method's own limit) of five lines over that of twelve points, both by the paper's "
		 "recipe. Holds up to 1.15.",
		 {"view", "noise of 5 lines", "of 12 points", "ratio", "time: 5 lines / 12 points", ""},
		 {}});
	for (const ClaimPlace& place : placesOf(report))
	{
		const ErrorPoint* const lines = pointOf(*place.view, recipeOf(claimedLines(), 5));
		const ErrorPoint* const points = pointOf(*place.view, recipeOf(claimedPoints(), 12));
		if (lines == nullptr || points == nullptr || !lines->measured.own_rmse || !(points->measured.own_rmse.value_or(0.0) > 0.0))
		{
			continue;
		}
		const double ratio = *lines->measured.own_rmse / *points->measured.own_rmse;
		claim.add({place.name, shortText(*lines->measured.own_rmse), shortText(*points->measured.own_rmse), shortText(ratio),
				   shortText(claimTime(*lines) / claimTime(*points))},
				  ratio <= 1.15);
	}
	return claim.take();
}

ErrorClaim volumesBeatScreen(const ErrorReport& report)
{
	JudgedClaim claim(
		{"aov-screen",
		 "AOV's error is below every screen-space method's.",
		 "AOV §6, figures 1 and 9",
		 {},
		 "Eq. 14 of the paper's volumes (one a triangle, every pixel, its own curve) against the best of all screen-space "
		 "candidates, papers' recipes and ours. Holds where it is the lesser.",
		 {"view", "AOV", "nook's volumes", "best in screen space", "which", ""},
		 {}});
	for (const ClaimPlace& place : placesOf(report))
	{
		const ErrorPoint* const volumes = pointOf(*place.view, volumesOf(VolumeRecipe::triangles));
		const ErrorPoint* const built = pointOf(*place.view, volumesOf(VolumeRecipe::built));
		const ErrorPoint* best = nullptr;
		for (const ErrorPoint& point : place.view->points)
		{
			const bool screen = point.candidate && point.candidate->kind == CandidateKind::screen;
			if (screen && (best == nullptr || point.measured.errors.eq14 < best->measured.errors.eq14))
			{
				best = &point;
			}
		}
		if (volumes != nullptr && built != nullptr && best != nullptr)
		{
			const bool holds = volumes->measured.errors.eq14 < best->measured.errors.eq14;
			claim.add({place.name, shortText(volumes->measured.errors.eq14), shortText(built->measured.errors.eq14),
					   shortText(best->measured.errors.eq14), best->name},
					  holds);
		}
	}
	return claim.take();
}

ErrorClaim volumesLikeRays(const ErrorReport& report)
{
	JudgedClaim claim(
		{"aov-rays",
		 "AOV is about as good as hundreds of rays a pixel, in a small part of their time.",
		 "AOV, figures 1 and 9",
		 {},
		 "How many rays a pixel have the eq. 14 of the paper's volumes, between the counts that were measured, and how long those "
		 "take against the volumes. Holds from 100 rays on that take longer; out of reach where fewer were tried and all err more.",
		 {"view", "AOV's eq. 14", "rays of that error", "their time / AOV's", "nook's volumes: rays", ""},
		 {}});
	for (const ClaimPlace& place : placesOf(report))
	{
		const ErrorPoint* const volumes = pointOf(*place.view, volumesOf(VolumeRecipe::triangles));
		const ErrorPoint* const built = pointOf(*place.view, volumesOf(VolumeRecipe::built));
		std::vector<std::pair<double, double>> counts; // error → rays, error → time
		std::vector<std::pair<double, double>> times;
		for (const ErrorPoint& point : place.view->points)
		{
			if (point.origin == Origin::rays)
			{
				counts.emplace_back(point.measured.errors.eq14, point.count);
				times.emplace_back(point.measured.errors.eq14, claimTime(point));
			}
		}
		if (volumes == nullptr || built == nullptr || counts.empty())
		{
			continue;
		}
		const double least = std::min_element(counts.begin(), counts.end())->first;
		const auto most = std::min_element(counts.begin(), counts.end())->second;
		const auto raysOf = [&](const ErrorPoint& point)
		{
			const double error = point.measured.errors.eq14;
			const std::optional<double> rays = errorAt(counts, error);
			return rays ? shortText(*rays) : error < least ? "> " + shortText(most) : std::string("< 1");
		};
		const double error = volumes->measured.errors.eq14;
		const std::optional<double> rays = errorAt(counts, error);
		const std::optional<double> seconds = errorAt(times, error);
		const bool beyond = error < least;
		const double ratio = seconds ? *seconds / claimTime(*volumes) : 0.0;
		const std::vector<std::string> cells{place.name, shortText(error), raysOf(*volumes), seconds ? shortText(ratio) : "–",
											 raysOf(*built)};
		if (beyond && most < 100.0)
		{
			claim.addOpen(cells);
			continue;
		}
		claim.add(cells, beyond || (rays && *rays >= 100.0 && ratio > 1.0));
	}
	return claim.take();
}

} // namespace

std::vector<ErrorClaim> checkErrorClaims(const ErrorReport& report)
{
	return {linesAgainstPoints(report), fiveLikeTwelve(report),  statVoRadius(report),  samplesRadius(report),
			volumesBeatScreen(report),  volumesLikeRays(report), timeOverSquare(report)};
}

} // namespace nook
