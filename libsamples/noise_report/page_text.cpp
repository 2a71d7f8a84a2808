// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/page_text.h"

#include "noise_report/measures.h"

#include <algorithm>

namespace nook
{
namespace
{

std::string listOf(const std::vector<int>& counts)
{
	std::string text;
	for (std::size_t i = 0; i < counts.size(); ++i)
	{
		text += i == 0 ? "" : (i + 1 == counts.size() ? " and " : ", ");
		text += std::to_string(counts[i]);
	}
	return text.empty() ? "none" : text;
}

// Counts from 3 up whose measure lies clearly below the trend of their neighbours.
std::vector<int> dipsOf(const NoiseReport& report, const Series& series, std::string_view measure)
{
	const NoiseFit* fit = findFit(report.fits, series.domain, measure);
	const MeasureByCount values = valuesOf(report.rows, series, measureNamed(measure));
	std::vector<int> dips;
	for (const auto& [count, value] : values)
	{
		if (count >= 3 && localRatio(values, count, fit != nullptr ? fit->exponent : 0.0).value_or(1.0) <= kDipRatio)
		{
			dips.push_back(count);
		}
	}
	return dips;
}

std::string dipSentence(const NoiseReport& report, Domain domain, Variant variant, Method method)
{
	const Series series{domain, variant, method, WeightRule::voronoi, VoronoiMode::exact};
	return std::string("`") + std::string(nameOf(method)) + "`, " + std::string(nameOf(domain)) + ", " +
		   std::string(nameOf(variant)) + ": noise dips at " + listOf(dipsOf(report, series, "noise")) + "; plane at " +
		   listOf(dipsOf(report, series, "plane")) + ".";
}

// "16 (N up to 20), 3 (others)" would be many words for a table; the rows say each, this says the range.
std::string startsText(const NoiseReport& report)
{
	std::string text;
	for (const Domain domain : {Domain::disk, Domain::ball, Domain::sphere, Domain::hemisphere})
	{
		for (const Method method : {Method::refine, Method::electro, Method::equal, Method::lloyd})
		{
			int least = 0;
			int most = 0;
			for (const NoiseRow& row : report.rows)
			{
				if (row.recipe.domain == domain && row.recipe.method == method)
				{
					least = least == 0 ? row.recipe.starts : std::min(least, row.recipe.starts);
					most = std::max(most, row.recipe.starts);
				}
			}
			if (most > 0)
			{
				text += text.empty() ? "" : "; ";
				text += std::string(nameOf(domain)) + " " + std::string(nameOf(method)) + " " +
						(least == most ? std::to_string(most) : std::to_string(least) + " to " + std::to_string(most));
			}
		}
	}
	return text;
}

} // namespace

std::string leadText(const NoiseReport& report)
{
	const auto tally = [&](Verdict verdict)
	{
		return std::to_string(
			std::count_if(report.claims.begin(), report.claims.end(), [&](const Claim& c) { return c.verdict == verdict; }));
	};
	return "Patterns for line samples, point samples and directions, N = 1 to " + std::to_string(report.settings.max_count) +
		   ", made by every method and measured over the same half-spaces. Of the paper’s claims about special counts, " +
		   tally(Verdict::confirmed) + " are confirmed, " + tally(Verdict::refuted) + " refuted, " + tally(Verdict::mixed) +
		   " mixed and " + tally(Verdict::untested) + " untested here.";
}

std::vector<std::string> whyText(const NoiseReport& report)
{
	std::vector<std::string> text{
		"On the disk, a rotation of the pattern at every pixel turns the error’s dependence on the azimuth into noise. A pattern "
		"that maps to "
		"itself under "
		"m rotations has only the harmonics m, 2m, … of that dependence, and they are weak. What remains is bias: the mean over "
		"all rotations, "
		"which depends on the radii and the weights alone. One ring around a centre is the extreme case: its noise falls with "
		"every sample that is "
		"added, its bias hardly at all, until the error is better spent on a second ring; there the noise jumps up and the bias "
		"down. So the noise has "
		"dips just below the counts where a ring opens, and plane, which holds both, is smooth there.",
		"The second property is the antipode: a pattern that holds −p with every p measures planes through P exactly. A flat wall "
		"or floor without normals "
		"is such a plane, so these counts look clean on most of an image whatever their noise over all half-spaces is.",
	};
	for (const Variant variant : {Variant::free, Variant::centred})
	{
		text.push_back(dipSentence(report, Domain::disk, variant, Method::electro));
	}
	text.push_back(dipSentence(report, Domain::disk, Variant::free, Method::refine));
	text.push_back(dipSentence(report, Domain::ball, Variant::free, Method::electro));
	text.push_back(dipSentence(report, Domain::ball, Variant::free, Method::refine));
	return text;
}

std::vector<std::pair<std::string, std::string>> readingText(const NoiseReport& report, const std::string& command,
															 const std::string& version)
{
	const NoiseReportSettings& s = report.settings;
	return {
		{"plane",
		 "Rms error of the free share over half-spaces n·x > c, as a share of the unit ball (directions: of the domain’s measure). "
		 "n is uniform over the directions that a depth buffer can show (disk) or over all (others), c uniform in [−1, 1]. "
		 "Grid: 24 midpoints in n_z × 40 midpoints in c × 97 azimuths, moved by the golden ratio from cell to cell."},
		{"noise, bias", "plane² = noise² + bias². noise² is the variance over the azimuth (what a random rotation at every pixel "
						"shows), bias² the squared "
						"error of the mean over the azimuth (what no blur removes)."},
		{"cliff",
		 "The same over vertical planes: a line is wholly free or wholly occluded, the hardest case for lines. Disk only."},
		{"centre", "Planes through P: what a flat surface shows without normals. 0 for antipodal patterns. Disk and ball."},
		{"crease", "Two half-spaces through P, opening angle uniform in 30° to 175°. Disk only."},
		{"spread", "Relative standard deviation of the cells’ integrals."},
		{"free, centred, symmetric",
		 "Nothing asked of the pattern; a sample at the centre; −p with every p (and a centre where N is odd)."},
		{"methods", "`refine` descends the gradient of the error itself from the best of many starts and is the default of `nook "
					"pattern`; `electro` is the "
					"paper’s repulsion and pull to centroids; `equal` makes cells of equal integrals; `lloyd` is centroidal "
					"Voronoi; `vogel` the "
					"golden-angle spiral; `halton`, `poisson` and `random` need no search. Weights are the cells’ integrals."},
		{"averages", "`random` and `poisson` are root mean squares over " + std::to_string(s.random_seeds) +
						 " seeds (an expectation); every other curve is the one pattern that the recipe makes. Their pictures show "
						 "the first seed."},
		{"starts",
		 (s.starts != 0 ? "As asked for: " : "Cut below the generator’s defaults where the report would take too long: ") +
			 startsText(report) +
			 ". More starts lower a curve a little and smooth it; single counts of methods with one start are a sample, not the "
			 "best."},
		{"trend, dips", "factor · N^−p is a least-squares fit in logarithms to refine, free, N ≥ 4. “To neighbours” is the value "
						"over the geometric mean of up to "
						"two neighbours a side, carried along N^−p; a ring and a number mark 0.95 and less."},
		{"symmetry", "Found with a tolerance of 0.02 radii and 5 % of weight. Rings and shells are samples whose radii lie within "
					 "0.02 of the next."},
		{"made by", std::string("`") + command + "`, nook " + version + ", seed " + std::to_string(s.seed) +
						". The same command makes the same bytes, on any number of threads. The figures are also to be had as JSON "
						"(`--json FILE`)."},
	};
}

} // namespace nook
