// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: B. Loos and P.-P. Sloan, "Volumetric Obscurance", 2010, §4.5 and figure 4.
#include "noise_report/claims.h"

#include "noise_report/explain.h"
#include "noise_report/measures.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

// Conventions, stated on the page (verdictRules): a twentieth is what its charts mark as a dip.
constexpr double kClear = kDipRatio;
constexpr double kSlight = 0.98;
constexpr double kLittle = 1.02;
constexpr double kAlike = 1.05;
constexpr double kUnlike = 1.15;

// The rows behind one line of a claim's table.
struct Source
{
	std::string name;
	const std::vector<NoiseRow>* rows;
	Series series;
};

std::string nameOf(const Series& series)
{
	if (series.voronoi == VoronoiMode::discrete)
	{
		return "electro, paper’s grid";
	}
	return series.weights == WeightRule::equal ? "electro, equal weights" : std::string(nook::nameOf(series.method));
}

// The paper's method as we make it, the same with the paper's equal weights, on the paper's grids, and our default.
std::vector<Source> sourcesOf(const NoiseReport& report, Domain domain, Variant variant)
{
	const std::array<Series, 4> all{{
		{domain, variant, Method::electro, WeightRule::voronoi, VoronoiMode::exact},
		{domain, variant, Method::electro, WeightRule::equal, VoronoiMode::exact},
		{domain, variant, Method::electro, WeightRule::equal, VoronoiMode::discrete},
		{domain, variant, Method::refine, WeightRule::voronoi, VoronoiMode::exact},
	}};
	std::vector<Source> sources;
	for (const Series& series : all)
	{
		sources.push_back({nameOf(series), series.weights == WeightRule::equal ? &report.paper_rows : &report.rows, series});
	}
	return sources;
}

double noiseAt(const Source& source, int count)
{
	const NoiseRow* row = findRow(*source.rows, source.series, count);
	return row != nullptr ? row->quality.noise : 0.0;
}

Claim dipClaim(const NoiseReport& report, Domain domain, Variant variant, int count)
{
	const bool ball = domain == Domain::ball;
	Claim claim;
	claim.id = std::string(nook::nameOf(domain)) + (variant == Variant::centred ? "-centred-" : "-") + std::to_string(count);
	claim.statement =
		std::to_string(count) + (ball ? " points in the ball have extremely low error compared with other numbers"
									  : (variant == Variant::centred ? " lines work well with the centre among the samples"
																	 : " lines work well without the centre"));
	for (const Source& source : sourcesOf(report, domain, variant))
	{
		const auto ratioOf = [&](std::string_view measure)
		{
			return localRatio(valuesOf(*source.rows, source.series, measureNamed(measure)), count,
							  exponentOf(report, domain, measure));
		};
		const std::optional<double> noise = ratioOf("noise");
		const std::optional<double> plane = ratioOf("plane");
		if (!noise || !plane)
		{
			continue;
		}
		const NoiseRow* row = findRow(*source.rows, source.series, count);
		ClaimFigure figure;
		figure.series = source.name;
		figure.subject = std::to_string(count);
		figure.noise = row->quality.noise;
		figure.before = noiseAt(source, count - 1);
		figure.after = noiseAt(source, count + 1);
		figure.ratio = *noise;
		figure.plane_ratio = *plane;
		figure.centre = row->quality.centre.value_or(0.0);
		figure.decides = source.series.method == Method::electro;
		figure.verdict = judgeDip(figure.ratio, figure.plane_ratio);
		claim.figures.push_back(figure);
	}
	claim.verdict = judgeAll(claim.figures);
	claim.explanation = explainCount(report, domain, variant, count) + explainScatter(claim.figures);
	for (const int n : {count - 1, count, count + 1})
	{
		claim.pictures.push_back({domain, Method::electro, variant, n});
	}
	return claim;
}

struct Sample
{
	Source source;
	int count;
};

// One sample set against another; absent where either was not made.
std::optional<ClaimFigure> compare(const Sample& subject, const Sample& other, const std::string& name)
{
	const NoiseRow* a = findRow(*subject.source.rows, subject.source.series, subject.count);
	const NoiseRow* b = findRow(*other.source.rows, other.source.series, other.count);
	if (a == nullptr || b == nullptr)
	{
		return std::nullopt;
	}
	ClaimFigure figure;
	figure.series = name;
	figure.subject = std::to_string(subject.count);
	figure.noise = a->quality.noise;
	figure.before = b->quality.noise;
	figure.ratio = a->quality.noise / b->quality.noise;
	figure.plane_ratio = a->quality.plane / b->quality.plane;
	figure.centre = a->quality.centre.value_or(0.0);
	return figure;
}

void addPair(Claim& claim, const Sample& subject, const Sample& other, const std::string& name, bool alike)
{
	if (std::optional<ClaimFigure> figure = compare(subject, other, name))
	{
		figure->decides = subject.source.series.method == Method::electro;
		figure->verdict = alike ? judgeAlike(figure->ratio, figure->plane_ratio) : judgeLess(figure->ratio);
		claim.figures.push_back(*figure);
	}
}

Claim nineAgainstTen(const NoiseReport& report)
{
	Claim claim;
	claim.id = "disk-9-10";
	claim.statement = "9 lines are much less noisy than 10";
	claim.against = "10 lines";
	const std::vector<Source> free = sourcesOf(report, Domain::disk, Variant::free);
	const std::vector<Source> centred = sourcesOf(report, Domain::disk, Variant::centred);
	for (std::size_t i = 0; i < free.size(); ++i)
	{
		addPair(claim, {free[i], 9}, {free[i], 10}, free[i].name + ": free", false);
		addPair(claim, {centred[i], 9}, {centred[i], 10}, centred[i].name + ": centred", false);
		addPair(claim, {centred[i], 9}, {free[i], 10}, centred[i].name + ": centred, free", false);
	}
	claim.verdict = judgeAll(claim.figures);
	claim.explanation = explainNineAndTen(report);
	for (const Variant variant : {Variant::free, Variant::centred})
	{
		claim.pictures.push_back({Domain::disk, Method::electro, variant, 9});
		claim.pictures.push_back({Domain::disk, Method::electro, variant, 10});
	}
	return claim;
}

Claim twelveAgainstThirteen(const NoiseReport& report)
{
	Claim claim;
	claim.id = "ball-12-13";
	claim.statement = "12 points are much less noisy than 13";
	claim.against = "13 points";
	for (const Source& source : sourcesOf(report, Domain::ball, Variant::free))
	{
		addPair(claim, {source, 12}, {source, 13}, source.name, false);
	}
	claim.verdict = judgeAll(claim.figures);
	claim.explanation = explainTwelveAndThirteen(report);
	for (const int n : {12, 13})
	{
		claim.pictures.push_back({Domain::ball, Method::electro, Variant::free, n});
	}
	for (const int n : {12, 13})
	{
		claim.pictures.push_back({Domain::ball, Method::electro, Variant::symmetric, n});
	}
	return claim;
}

Claim linesAgainstPoints(const NoiseReport& report)
{
	Claim claim;
	claim.id = "disk-5-ball-12";
	claim.statement = "5 lines look like 12 points";
	claim.against = "12 points";
	const std::vector<Source> points = sourcesOf(report, Domain::ball, Variant::free);
	for (const Variant variant : {Variant::free, Variant::centred})
	{
		const std::vector<Source> lines = sourcesOf(report, Domain::disk, variant);
		for (std::size_t i = 0; i < lines.size(); ++i)
		{
			addPair(claim, {lines[i], 5}, {points[i], 12}, lines[i].name + ": " + std::string(nook::nameOf(variant)), true);
		}
	}
	claim.verdict = judgeAll(claim.figures);
	claim.explanation = explainLinesAndPoints(report);
	claim.pictures.push_back({Domain::disk, Method::electro, Variant::free, 5});
	claim.pictures.push_back({Domain::disk, Method::electro, Variant::centred, 5});
	claim.pictures.push_back({Domain::ball, Method::electro, Variant::free, 12});
	return claim;
}

std::string percent(double ratio)
{
	return std::to_string(static_cast<int>(std::fabs(ratio - 1.0) * 100.0 + 0.5)) + " %";
}

} // namespace

Verdict judgeDip(double noise_ratio, double plane_ratio)
{
	const double better = std::min(noise_ratio, plane_ratio);
	const double worse = std::max(noise_ratio, plane_ratio);
	if (better <= kClear && worse <= kLittle)
	{
		return Verdict::confirmed;
	}
	return better > kSlight ? Verdict::refuted : Verdict::mixed;
}

Verdict judgeLess(double noise_ratio)
{
	return noise_ratio <= kClear ? Verdict::confirmed : (noise_ratio >= 1.0 ? Verdict::refuted : Verdict::mixed);
}

Verdict judgeAlike(double noise_ratio, double plane_ratio)
{
	const double worse = std::max(noise_ratio, plane_ratio);
	return worse <= kAlike ? Verdict::confirmed : (worse > kUnlike ? Verdict::refuted : Verdict::mixed);
}

Verdict judgeAll(const std::vector<ClaimFigure>& figures)
{
	const auto tally = [&](Verdict verdict)
	{
		return std::count_if(figures.begin(), figures.end(),
							 [&](const ClaimFigure& f) { return f.decides && f.verdict == verdict; });
	};
	const auto confirmed = tally(Verdict::confirmed);
	const auto mixed = tally(Verdict::mixed);
	const auto refuted = tally(Verdict::refuted);
	if (confirmed + mixed + refuted == 0)
	{
		return Verdict::untested;
	}
	if (confirmed > mixed && refuted == 0)
	{
		return Verdict::confirmed;
	}
	return refuted > mixed && confirmed == 0 ? Verdict::refuted : Verdict::mixed;
}

std::vector<std::string> verdictRules()
{
	return {
		"A count is compared with its local trend: the geometric mean of its two neighbours on each side in the same series, each "
		"carried to "
		"this count along the domain’s N^−p. A figure confirms when noise or plane lies at least " +
			percent(kClear) + " below that trend and the other at most " + percent(kLittle) +
			" above; it refutes when neither lies " + percent(kSlight) + " below. “Less noisy than” confirms from " +
			percent(kClear) +
			" less noise, and refutes where the noise is not less. “Look like” confirms when neither noise nor plane is more "
			"than " +
			percent(kAlike) + " above the other’s, and refutes above " + percent(kUnlike) +
			". Everything else is mixed. A claim is about the paper’s method, so the `electro` figures decide: it is confirmed "
			"when most of them "
			"confirm and none refutes, refuted when most refute and none confirms, else mixed.",
		"`electro` is the paper’s method with exact cells and the cells’ integrals as weights; “equal weights” lets all samples "
		"count alike, as the paper does; “paper’s grid” has also its 512² and 128³ cells, with " +
			std::to_string(kPaperGridStarts) +
			" starting sets at most and one in the ball (the grids are slow). `refine`, nook’s default, stands beside them. Ratios "
			"below 1 are better; "
			"centre is the error over planes through P, 0 for antipodal patterns.",
	};
}

std::vector<Claim> judgeClaims(const NoiseReport& report)
{
	std::vector<Claim> claims;
	for (const int count : {6, 12, 33})
	{
		claims.push_back(dipClaim(report, Domain::ball, Variant::free, count));
	}
	for (const int count : {5, 7, 9, 13, 16})
	{
		claims.push_back(dipClaim(report, Domain::disk, Variant::centred, count));
	}
	for (const int count : {12, 13, 15})
	{
		claims.push_back(dipClaim(report, Domain::disk, Variant::free, count));
	}
	claims.push_back(nineAgainstTen(report));
	claims.push_back(twelveAgainstThirteen(report));
	claims.push_back(linesAgainstPoints(report));
	return claims;
}

} // namespace nook
