// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/noise_report.h"

#include "core/error.h"
#include "core/work_units.h"
#include "noise_report/claims.h"
#include "noise_report/measures.h"
#include "noise_report/row_bytes.h"
#include "noise_report/studies.h"
#include "noise_report/trend.h"
#include "pattern/generate.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{

template <> std::span<const std::string_view> namesOf<Variant>()
{
	static constexpr std::array<std::string_view, 3> names{"free", "centred", "symmetric"};
	return names;
}

template <> std::span<const std::string_view> namesOf<Verdict>()
{
	static constexpr std::array<std::string_view, 4> names{"confirmed", "mixed", "refuted", "untested"};
	return names;
}

namespace
{

bool searches(Method method)
{
	return method == Method::refine || method == Method::electro || method == Method::equal || method == Method::lloyd;
}

bool isAverage(Method method)
{
	return method == Method::random || method == Method::poisson;
}

bool isAllowed(const Recipe& recipe)
{
	try
	{
		checkRecipe(recipe);
	}
	catch (const Error&)
	{
		return false; // this count or variant is not offered; the chart has no point there
	}
	return true;
}

// The dear comparisons: a ball's cells, moved hundreds of times.
bool isAffordable(const NoiseRow& row)
{
	const bool cells = row.recipe.method == Method::equal || row.recipe.method == Method::lloyd;
	return !(cells && row.recipe.domain == Domain::ball && row.variant != Variant::free);
}

NoiseRow rowFor(const NoiseReportSettings& settings, Domain domain, Variant variant, Method method, int count)
{
	NoiseRow row;
	row.variant = variant;
	row.recipe.domain = domain;
	row.recipe.method = method;
	row.recipe.count = count;
	row.recipe.seed = settings.seed;
	row.recipe.centre = variant == Variant::centred;
	row.recipe.symmetric = variant == Variant::symmetric;
	if (searches(method))
	{
		row.recipe.starts = settings.starts != 0 ? settings.starts : reportStarts(row.recipe);
	}
	return row;
}

std::vector<NoiseRow> listRows(const NoiseReportSettings& settings)
{
	std::vector<NoiseRow> rows;
	for (const Domain domain : {Domain::disk, Domain::ball, Domain::sphere, Domain::hemisphere})
	{
		for (const Variant variant : {Variant::free, Variant::centred, Variant::symmetric})
		{
			for (std::size_t m = 0; m < namesOf<Method>().size(); ++m)
			{
				for (int count = 1; count <= settings.max_count; ++count)
				{
					NoiseRow row = rowFor(settings, domain, variant, static_cast<Method>(m), count);
					if (isAllowed(row.recipe) && isAffordable(row))
					{
						rows.push_back(std::move(row));
					}
				}
			}
		}
	}
	return rows;
}

// The paper's own settings around the counts that it names: samples that count alike, and its discrete cells.
std::vector<NoiseRow> listPaperRows(const NoiseReportSettings& settings)
{
	struct Range
	{
		Domain domain;
		Variant variant;
		int first;
		int last;
		bool grid;
	};
	constexpr std::array<Range, 4> ranges{{
		{Domain::disk, Variant::free, 3, 18, true},
		{Domain::disk, Variant::centred, 3, 18, true},
		{Domain::ball, Variant::free, 4, 14, true},
		{Domain::ball, Variant::free, 31, 35, false},
	}};
	std::vector<NoiseRow> rows;
	for (const VoronoiMode mode : {VoronoiMode::exact, VoronoiMode::discrete})
	{
		for (const Range& range : ranges)
		{
			for (int count = range.first; count <= std::min(range.last, settings.max_count); ++count)
			{
				NoiseRow row = rowFor(settings, range.domain, range.variant, Method::electro, count);
				row.recipe.weights = WeightRule::equal;
				row.recipe.voronoi = mode;
				if (mode == VoronoiMode::discrete)
				{
					row.recipe.starts = std::min(row.recipe.starts, range.domain == Domain::disk ? kPaperGridStarts : 1);
				}
				if (mode == VoronoiMode::exact || range.grid)
				{
					rows.push_back(std::move(row));
				}
			}
		}
	}
	return rows;
}

// Root mean square over the seeds; what is not a mean of squares (greatest error, spread, distance, energy) as a plain mean.
Quality averageOf(const std::vector<Quality>& samples)
{
	const auto count = static_cast<double>(samples.size());
	const auto rms = [&](auto get)
	{
		double sum = 0.0;
		for (const Quality& q : samples)
		{
			sum += get(q) * get(q);
		}
		return std::sqrt(sum / count);
	};
	const auto mean = [&](auto get)
	{
		double sum = 0.0;
		for (const Quality& q : samples)
		{
			sum += get(q);
		}
		return sum / count;
	};
	Quality average = samples.front();
	for (const auto field : {&Quality::plane, &Quality::noise, &Quality::bias, &Quality::plane_exact})
	{
		average.*field = rms([&](const Quality& q) { return q.*field; });
	}
	for (const auto field : {&Quality::greatest, &Quality::spread, &Quality::smallest_distance, &Quality::energy})
	{
		average.*field = mean([&](const Quality& q) { return q.*field; });
	}
	for (const auto field : {&Quality::cliff, &Quality::cliff_greatest, &Quality::centre, &Quality::crease, &Quality::cap})
	{
		if (average.*field)
		{
			average.*field = rms([&](const Quality& q) { return *(q.*field); });
		}
	}
	return average;
}

void measureRow(const NoiseReportSettings& settings, NoiseRow& row)
{
	row.pattern = generatePattern(row.recipe);
	row.symmetry = findSymmetry(row.pattern);
	if (!isAverage(row.recipe.method))
	{
		row.quality = measurePattern(row.pattern);
		return;
	}
	std::vector<Quality> samples;
	for (int k = 0; k < settings.random_seeds; ++k)
	{
		Recipe recipe = row.recipe;
		recipe.seed += static_cast<uint32_t>(k);
		samples.push_back(measurePattern(generatePattern(recipe)));
	}
	row.quality = averageOf(samples);
}

// About what it takes: starts by pairs of samples, each the dearer in the ball; the paper's grids cost a hundred times exact cells.
double costOf(const NoiseRow& row)
{
	const double count = row.recipe.count;
	const double each =
		(row.recipe.domain == Domain::ball ? 10.0 : 1.0) * (row.recipe.voronoi == VoronoiMode::discrete ? 100.0 : 1.0);
	return 50.0 + each * std::max(1, row.recipe.starts) * (count + count * count / 8.0);
}

std::vector<NoiseFit> fitTrends(const std::vector<NoiseRow>& rows)
{
	std::vector<NoiseFit> fits;
	for (const Domain domain : {Domain::disk, Domain::ball, Domain::sphere, Domain::hemisphere})
	{
		for (const MeasureField& measure : measureFields())
		{
			const Series series{domain, Variant::free, Method::refine, WeightRule::voronoi, VoronoiMode::exact};
			if (const std::optional<PowerFit> fit = fitPower(valuesOf(rows, series, measure)))
			{
				fits.push_back({domain, std::string(measure.name), fit->factor, fit->exponent});
			}
		}
	}
	return fits;
}

void checkRange(const char* option, int value, int most)
{
	if (value < 1 || value > most)
	{
		throw Error(ExitCode::usage, std::string(option) + ": expected a whole number from 1 to " + std::to_string(most));
	}
}

} // namespace

int reportStarts(const Recipe& recipe)
{
	if (!searches(recipe.method))
	{
		return 1;
	}
	const bool chief = recipe.method == Method::refine || recipe.method == Method::electro;
	const bool many = recipe.count <= 20 || (recipe.count >= 31 && recipe.count <= 35); // around the counts that the paper names
	if (recipe.domain == Domain::ball)                                                  // its cells cost ten times a disk's
	{
		const bool free = !recipe.centre && !recipe.symmetric;
		return chief ? (many ? 16 : 4) / (free ? 1 : 2) : 1;
	}
	return chief ? (many ? 32 : 4) : 2;
}

void checkNoiseReportSettings(const NoiseReportSettings& settings)
{
	checkRange("max-count", settings.max_count, kMaxReportCount);
	checkRange("seeds", settings.random_seeds, 100);
	if (settings.starts != 0)
	{
		checkRange("starts", settings.starts, 1000);
	}
}

std::string commandOf(const NoiseReportSettings& settings)
{
	const NoiseReportSettings plain;
	std::string command = "nook report noise";
	const auto option = [&](const char* name, auto value, auto usual)
	{
		if (value != usual)
		{
			command += std::string(" ") + name + " " + std::to_string(value);
		}
	};
	option("--max-count", settings.max_count, plain.max_count);
	option("--starts", settings.starts, plain.starts);
	option("--seeds", settings.random_seeds, plain.random_seeds);
	option("--seed", settings.seed, plain.seed);
	return command;
}

NoiseReport measureNoise(const NoiseReportSettings& settings, const RunSettings& run)
{
	checkNoiseReportSettings(settings);
	NoiseReport report;
	report.settings = settings;
	report.rows = listRows(settings);
	report.paper_rows = listPaperRows(settings);

	std::vector<NoiseRow*> work;
	for (std::vector<NoiseRow>* list : {&report.rows, &report.paper_rows})
	{
		for (NoiseRow& row : *list)
		{
			work.push_back(&row);
		}
	}
	runStage({"patterns", work.size(), [&](std::size_t i) { return costOf(*work[i]); },
			  [&](std::size_t i) { measureRow(settings, *work[i]); }, [&](std::size_t i) { return savedRow(*work[i]); },
			  [&](std::size_t i, std::string_view bytes)
			  {
				  return loadRow(bytes, *work[i]);
			  }},
			 run);
	for (NoiseRow& row : report.rows)
	{
		if (&row == rowOfFilters(report) && row.pattern.count() == 0)
		{
			measureRow(settings, row); // another part's, and quick
		}
	}
	report.filters = filterTables(report, run);
	finishUnits(run);
	const ProgressCounter stage(run.progress, "studies");
	report.fits = fitTrends(report.rows);
	report.claims = judgeClaims(report);
	report.studies = makeStudies(report);
	return report;
}

} // namespace nook
