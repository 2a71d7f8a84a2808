// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/explain.h"

#include "noise_report/measures.h"

#include <algorithm>

namespace nook
{
namespace
{

const char* const kTooSmall = "The report was made with too small a --max-count for this claim.";

Series chiefSeries(Domain domain, Variant variant, Method method = Method::electro)
{
	return {domain, variant, method, WeightRule::voronoi, VoronoiMode::exact};
}

// Over the local trend; 0: none.
double ratioOf(const NoiseReport& report, const Series& series, std::string_view measure, int count)
{
	const NoiseFit* fit = findFit(report.fits, series.domain, measure);
	const MeasureByCount values = valuesOf(report.rows, series, measureNamed(measure));
	return localRatio(values, count, fit != nullptr ? fit->exponent : 0.0).value_or(0.0);
}

std::string describe(const NoiseRow& row)
{
	return std::to_string(row.recipe.count) + ": " + symmetryText(row.recipe.domain, row.symmetry);
}

std::string centreText(const NoiseRow& row)
{
	const double centre = row.quality.centre.value_or(0.0);
	return centre < kNegligible ? "0" : fixedText(centre, 4);
}

// What the neighbours' symmetry has to do with it.
std::string symmetrySentences(const NoiseRow& row, const NoiseRow& below, const NoiseRow& above, double noise_ratio)
{
	std::string text;
	const Symmetry& symmetry = row.symmetry;
	const int other_order = std::max(below.symmetry.order, above.symmetry.order);
	if (noise_ratio <= 0.98 && symmetry.order > 2 && symmetry.order > other_order)
	{
		text += " It has the highest symmetry of the three: ";
		text +=
			row.recipe.domain == Domain::ball
				? "its error varies over the rotations only by harmonics that share its symmetry."
				: "m rotations that leave the pattern as it is leave only the harmonics m, 2m, … of the azimuth, the weak ones.";
	}
	if (noise_ratio > 0.98 && symmetry.order > 2 && symmetry.order >= other_order)
	{
		text += " Its symmetry is as high as its neighbours’ or higher, and yet it buys no noise here.";
	}
	if (noise_ratio <= 0.98 && symmetry.order > 2 && symmetry.order <= other_order)
	{
		text += " A neighbour is as symmetric, so the symmetry alone does not set this count apart.";
	}
	const auto centreOf = [](const NoiseRow& r)
	{
		return r.quality.centre.value_or(0.0);
	};
	constexpr double kSeen = 0.004; // a grey level of 8 bits
	constexpr double kUnseen = 0.001;
	if (centreOf(row) < kUnseen && centreOf(below) > kSeen && centreOf(above) > kSeen)
	{
		text += " It is antipodal and its neighbours are not, or hold a centre sample that lies in every such plane: planes "
				"through P are measured exactly (centre error 0, against " +
				centreText(below) + " and " + centreText(above) +
				"), so that without normals a flat surface shows no noise at all. On most images that is what the eye sees first.";
	}
	return text;
}

} // namespace

std::string explainCount(const NoiseReport& report, Domain domain, Variant variant, int count)
{
	const Series series = chiefSeries(domain, variant);
	const NoiseRow* row = findRow(report.rows, series, count);
	const NoiseRow* below = findRow(report.rows, series, count - 1);
	const NoiseRow* above = findRow(report.rows, series, count + 1);
	if (row == nullptr || below == nullptr || above == nullptr)
	{
		return kTooSmall;
	}
	const double noise = ratioOf(report, series, "noise", count);
	const double bias = ratioOf(report, series, "bias", count);
	std::string text = "`electro` makes " + describe(*below) + "; " + describe(*row) + "; " + describe(*above) + ".";
	const std::string found = symmetrySentences(*row, *below, *above, noise);
	text += found;
	if (bias > 0.0 && bias <= 0.95 && noise > 0.98)
	{
		text += " What it gains is bias (" + fixedText(bias, 2) +
				" of its trend), which no rotation shows and no blur removes, not noise (" + fixedText(noise, 2) + ").";
	}
	if (noise <= 0.95 && bias > 1.02)
	{
		text += " The noise (" + fixedText(noise, 2) + " of its trend) is paid for with bias (" + fixedText(bias, 2) + ").";
	}
	if (above->symmetry.rings.size() > row->symmetry.rings.size() && above->symmetry.order < row->symmetry.order)
	{
		text += " One sample more opens another " + std::string(domain == Domain::ball ? "shell" : "ring") +
				" and the symmetry is lost.";
	}
	if (found.empty() && noise > 0.95 && bias > 0.95)
	{
		text += " Nothing in its symmetry or its " + std::string(domain == Domain::ball ? "shells" : "rings") +
				" sets it apart; no explanation was found.";
	}
	if (const NoiseRow* ours = findRow(report.rows, chiefSeries(domain, variant, Method::refine), count))
	{
		if (symmetryText(domain, ours->symmetry) != symmetryText(domain, row->symmetry))
		{
			text += " `refine` settles on another pattern (" + symmetryText(domain, ours->symmetry) + ").";
			if (ours->symmetry.order > row->symmetry.order && ours->symmetry.order > 2)
			{
				text += " `electro` goes by equal integrals (relative spread " + fixedText(row->quality.spread, 3) + " against " +
						fixedText(ours->quality.spread, 3) + " for the symmetric one), and equal cells do not ask for symmetry.";
			}
		}
	}
	return text;
}

std::string explainScatter(const std::vector<ClaimFigure>& figures)
{
	double least = 0.0;
	double most = 0.0;
	for (const ClaimFigure& f : figures)
	{
		if (f.decides)
		{
			least = least == 0.0 ? f.noise : std::min(least, f.noise);
			most = std::max(most, f.noise);
		}
	}
	if (most <= 1.1 * least)
	{
		return "";
	}
	return " The `electro` series disagree (noise " + fixedText(least, 4) + " to " + fixedText(most, 4) +
		   "): several different patterns have nearly equal cells, and which of them is found depends on the starts, the grid and "
		   "the "
		   "weights. A good count is then one run’s luck.";
}

std::string explainNineAndTen(const NoiseReport& report)
{
	const auto rowOf = [&](Variant variant, int count)
	{
		return findRow(report.rows, chiefSeries(Domain::disk, variant, Method::refine), count);
	};
	const NoiseRow* nine = rowOf(Variant::centred, 9);
	const NoiseRow* ten = rowOf(Variant::centred, 10);
	const NoiseRow* free_ten = rowOf(Variant::free, 10);
	if (nine == nullptr || ten == nullptr || free_ten == nullptr)
	{
		return kTooSmall;
	}
	const auto figures = [](const NoiseRow& row)
	{
		return symmetryText(Domain::disk, row.symmetry) + ", noise " + fixedText(row.quality.noise, 4) + ", bias " +
			   fixedText(row.quality.bias, 4) + ", centre " + centreText(row);
	};
	std::string text = "The answer depends on which nine and which ten. `refine` makes nine with the centre (" + figures(*nine) +
					   "), ten with the centre (" + figures(*ten) + ") and ten without (" + figures(*free_ten) + ").";
	if (nine->quality.noise < free_ten->quality.noise && nine->quality.plane > free_ten->quality.plane)
	{
		text += " Ten is better by the whole error (plane " + fixedText(free_ten->quality.plane, 4) + " against " +
				fixedText(nine->quality.plane, 4) +
				") and noisier all the same: it gives up symmetry for less bias. So a generator that goes by the error or by equal "
				"cells ships "
				"a ten that looks noisier than nine, as in the paper’s figure.";
	}
	if (nine->symmetry.order > free_ten->symmetry.order)
	{
		text += " Where `electro` finds the same " + std::to_string(nine->symmetry.order) +
				"-fold nine, the claim holds for it too; where it stops at another set of equal cells, it does not.";
	}
	return text;
}

std::string explainTwelveAndThirteen(const NoiseReport& report)
{
	const NoiseRow* twelve = findRow(report.rows, chiefSeries(Domain::ball, Variant::free), 12);
	const NoiseRow* thirteen = findRow(report.rows, chiefSeries(Domain::ball, Variant::free), 13);
	const NoiseRow* solid = findRow(report.rows, chiefSeries(Domain::ball, Variant::symmetric), 12);
	if (twelve == nullptr || thirteen == nullptr || solid == nullptr)
	{
		return kTooSmall;
	}
	return "`electro` makes " + describe(*twelve) + " and " + describe(*thirteen) +
		   ". The icosahedron (12 points, symmetric: " + symmetryText(Domain::ball, solid->symmetry) + ") has noise " +
		   fixedText(solid->quality.noise, 4) + ", bias " + fixedText(solid->quality.bias, 4) +
		   "; with a centre it is the pattern of 13 (noise " + fixedText(thirteen->quality.noise, 4) + ", bias " +
		   fixedText(thirteen->quality.bias, 4) +
		   "). Over all half-spaces 12 gains nothing on 13. Over planes through P the icosahedron does (centre error " +
		   centreText(*solid) + "; 12 free " + centreText(*twelve) + ", 13 free " + centreText(*thirteen) +
		   "): a centre sample lies in every such plane, and whether it counts is decided by rounding and the depth buffer, which "
		   "no half-space "
		   "off the centre shows.";
}

int pointsAsGoodAs(const NoiseReport& report, std::string_view measure, double value)
{
	int enough = 0;
	for (const auto& [count, error] :
		 valuesOf(report.rows, chiefSeries(Domain::ball, Variant::free, Method::refine), measureNamed(measure)))
	{
		if (error > value)
		{
			enough = 0;
		}
		else if (enough == 0 && count > 1) // one sample at the centre has no noise, and is no pattern
		{
			enough = count;
		}
	}
	return enough;
}

std::string explainLinesAndPoints(const NoiseReport& report)
{
	const NoiseRow* five = findRow(report.rows, chiefSeries(Domain::disk, Variant::free), 5);
	const NoiseRow* twelve = findRow(report.rows, chiefSeries(Domain::ball, Variant::free), 12);
	if (five == nullptr || twelve == nullptr)
	{
		return kTooSmall;
	}
	std::string text =
		"A line integrates depth exactly, so only the two image directions are sampled: five lines have plane error " +
		fixedText(five->quality.plane, 4) + " and noise " + fixedText(five->quality.noise, 4) + ", twelve points " +
		fixedText(twelve->quality.plane, 4) + " and " + fixedText(twelve->quality.noise, 4) + ".";
	const int by_plane = pointsAsGoodAs(report, "plane", five->quality.plane);
	const int by_noise = pointsAsGoodAs(report, "noise", five->quality.noise);
	if (by_plane > 0 && by_noise > 0)
	{
		text += " It takes " + std::to_string(by_plane) + " points to reach the five lines’ plane error and " +
				std::to_string(by_noise) + " to reach their noise.";
	}
	return text;
}

} // namespace nook
