// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/studies.h"

#include "core/math.h"
#include "core/random.h"
#include "noise_report/explain.h"
#include "noise_report/measures.h"
#include "pattern/energy.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

Series defaultSeries(Domain domain, Variant variant, Method method)
{
	return {domain, variant, method, WeightRule::voronoi, VoronoiMode::exact};
}

// The centred rings, one after the other: what one more sample does to noise and bias.
StudyTable ringTable(const NoiseReport& report)
{
	StudyTable table;
	table.title = "Disk with a centre, refine: one ring grows until a second opens";
	table.head = {"N", "rings", "order", "noise × N^p", "bias × N^p", "plane × N^p", "centre"};
	for (int count = 4; count <= std::min(14, report.settings.max_count); ++count)
	{
		const NoiseRow* row = findRow(report.rows, defaultSeries(Domain::disk, Variant::centred, Method::refine), count);
		if (row == nullptr)
		{
			continue;
		}
		const double centre = row->quality.centre.value_or(0.0);
		const auto scaled = [&](double value)
		{
			return fixedText(value * powOf(count, exponentOf(report, Domain::disk, "plane")), 4);
		};
		table.rows.push_back({std::to_string(count), ringText(row->symmetry), std::to_string(row->symmetry.order),
							  scaled(row->quality.noise), scaled(row->quality.bias), scaled(row->quality.plane),
							  centre < kNegligible ? "0" : fixedText(centre, 4)});
	}
	table.note = "All three columns use the exponent of plane, p = " + fixedText(exponentOf(report, Domain::disk, "plane"), 3) +
				 ", so that noise² + bias² = plane² holds in every row.";
	return table;
}

struct Group
{
	std::string name;
	int least;
	int most;
	double log_noise = 0.0;
	double log_bias = 0.0;
	double log_plane = 0.0;
	int patterns = 0;
};

void addGroups(const NoiseReport& report, Domain domain, StudyTable& table)
{
	std::array<Group, 4> groups{{{"none", 1, 1}, {"2", 2, 2}, {"3 to 5", 3, 5}, {"6 and more", 6, 1000}}};
	for (const Variant variant : {Variant::free, Variant::centred, Variant::symmetric})
	{
		const Series series = defaultSeries(domain, variant, Method::electro);
		const auto ratios = [&](std::string_view measure, int count)
		{
			return localRatio(valuesOf(report.rows, series, measureNamed(measure)), count, exponentOf(report, domain, measure))
				.value_or(0.0);
		};
		for (int count = 4; count <= report.settings.max_count; ++count)
		{
			const NoiseRow* row = findRow(report.rows, series, count);
			const double noise = row != nullptr ? ratios("noise", count) : 0.0;
			const double bias = row != nullptr ? ratios("bias", count) : 0.0;
			const double plane = row != nullptr ? ratios("plane", count) : 0.0;
			if (noise <= 0.0 || bias <= 0.0 || plane <= 0.0)
			{
				continue;
			}
			const auto group =
				std::find_if(groups.begin(), groups.end(),
							 [&](const Group& g) { return row->symmetry.order >= g.least && row->symmetry.order <= g.most; });
			group->log_noise += logOf(noise);
			group->log_bias += logOf(bias);
			group->log_plane += logOf(plane);
			group->patterns += 1;
		}
	}
	for (const Group& g : groups)
	{
		if (g.patterns > 0)
		{
			const auto mean = [&](double sum)
			{
				return fixedText(expOf(sum / g.patterns), 3);
			};
			table.rows.push_back({std::string(nameOf(domain)), g.name, std::to_string(g.patterns), mean(g.log_noise),
								  mean(g.log_bias), mean(g.log_plane)});
		}
	}
}

StudyTable symmetryTable(const NoiseReport& report)
{
	StudyTable table;
	table.title = "Does symmetry lower the noise? Every electro pattern from N = 4, by the number of its rotations";
	table.head = {"domain", "rotations", "patterns", "noise to trend", "bias to trend", "plane to trend"};
	addGroups(report, Domain::disk, table);
	addGroups(report, Domain::ball, table);
	table.note = "Geometric means of the ratios to the local trend, over free, centred and symmetric. Disk: rotations about the "
				 "view axis; ball: "
				 "rotations in space (12 for a tetrahedron, 24 for an octahedron, 60 for an icosahedron).";
	return table;
}

double errorOf(const Pattern& pattern, Part part)
{
	return std::sqrt(std::max(0.0, squaredError(pattern.domain, Ensemble::plane, part, pattern.points, pattern.weights)));
}

// The experiment: the same radii and weights without the symmetry.
StudyTable brokenTable(const NoiseReport& report)
{
	constexpr int kSeeds = 16;
	StudyTable table;
	table.title = "The symmetry taken away: samples shifted along their rings, radii and weights as before";
	table.head = {"disk pattern", "symmetry", "noise", "shifted", "ratio", "bias", "shifted"};
	for (const Variant variant : {Variant::free, Variant::centred})
	{
		for (int count = 4; count <= std::min(20, report.settings.max_count); ++count)
		{
			const NoiseRow* row = findRow(report.rows, defaultSeries(Domain::disk, variant, Method::electro), count);
			const bool centred_too =
				row != nullptr && variant == Variant::centred && !row->pattern.points.empty() &&
				findRow(report.rows, defaultSeries(Domain::disk, Variant::free, Method::electro), count)->symmetry.order ==
					row->symmetry.order;
			if (row == nullptr || row->symmetry.order < 4 || centred_too)
			{
				continue;
			}
			double noise2 = 0.0;
			double bias2 = 0.0;
			for (uint64_t seed = 1; seed <= kSeeds; ++seed)
			{
				const Pattern broken = breakSymmetry(row->pattern, row->symmetry, seed);
				const double noise = errorOf(broken, Part::noise);
				const double bias = errorOf(broken, Part::bias);
				noise2 += noise * noise / kSeeds;
				bias2 += bias * bias / kSeeds;
			}
			const double noise = errorOf(row->pattern, Part::noise);
			table.rows.push_back({std::to_string(count) + ", " + std::string(nameOf(variant)),
								  symmetryText(Domain::disk, row->symmetry), fixedText(noise, 4), fixedText(std::sqrt(noise2), 4),
								  fixedText(std::sqrt(noise2) / noise, 2), fixedText(errorOf(row->pattern, Part::bias), 4),
								  fixedText(std::sqrt(bias2), 4)});
		}
	}
	table.note = "electro patterns of 4-fold symmetry and more, up to N = 20. Every sample is turned about the centre by a random "
				 "angle of up to a "
				 "quarter of its ring’s spacing; root mean squares over " +
				 std::to_string(kSeeds) +
				 " seeds. The bias depends on radii and weights alone, so it stays; what rises is the noise.";
	return table;
}

StudyTable pointsTable(const NoiseReport& report)
{
	StudyTable table;
	table.title = "Lines against points: how many points are as good";
	table.head = {"lines (refine, free)", "plane", "noise", "points for that plane", "points for that noise"};
	for (const int count : {3, 4, 5, 6, 7, 8, 9, 12, 16})
	{
		if (const NoiseRow* row = findRow(report.rows, defaultSeries(Domain::disk, Variant::free, Method::refine), count))
		{
			const auto text = [&](int points)
			{
				return points > 0 ? std::to_string(points) : "more than " + std::to_string(report.settings.max_count);
			};
			table.rows.push_back({std::to_string(count), fixedText(row->quality.plane, 4), fixedText(row->quality.noise, 4),
								  text(pointsAsGoodAs(report, "plane", row->quality.plane)),
								  text(pointsAsGoodAs(report, "noise", row->quality.noise))});
		}
	}
	return table;
}

} // namespace

Pattern breakSymmetry(const Pattern& pattern, const Symmetry& symmetry, uint64_t seed)
{
	Random random(seed);
	Pattern broken = pattern;
	broken.powers.clear(); // the cells are no longer those of the weights
	for (glm::dvec3& p : broken.points)
	{
		const double radius = std::sqrt(p.x * p.x + p.y * p.y);
		const auto ring = std::min_element(symmetry.rings.begin(), symmetry.rings.end(),
										   [&](const Ring& a, const Ring& b)
										   { return std::fabs(a.radius - radius) < std::fabs(b.radius - radius); });
		const SinCos turn = sinCosOf((2.0 * random.uniform() - 1.0) * 0.25 * 2.0 * kPi / ring->samples);
		p = glm::dvec3(turn.cos * p.x - turn.sin * p.y, turn.sin * p.x + turn.cos * p.y, p.z);
	}
	return broken;
}

std::vector<StudyTable> makeStudies(const NoiseReport& report)
{
	std::vector<StudyTable> tables;
	for (StudyTable& table :
		 std::array<StudyTable, 4>{ringTable(report), symmetryTable(report), brokenTable(report), pointsTable(report)})
	{
		if (!table.rows.empty())
		{
			tables.push_back(std::move(table));
		}
	}
	return tables;
}

} // namespace nook
