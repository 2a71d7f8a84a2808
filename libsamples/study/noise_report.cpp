// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/noise_report.h"

#include "core/error.h"
#include "core/math.h"
#include "core/work_units.h"
#include "pattern/recipe.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{

void visit(Archive& archive, NoiseRow& row)
{
	Quality& q = row.quality;
	archive(q.plane, q.noise, q.bias, q.plane_exact, q.greatest, q.cliff, q.cliff_greatest, q.centre, q.crease, q.cap, q.spread,
			q.smallest_distance, q.energy, q.energy_exponent);
	archive(row.pattern.domain, row.pattern.points, row.pattern.weights, row.pattern.powers);
}

template <> std::span<const std::string_view> namesOf<Variant>()
{
	static constexpr std::array<std::string_view, 3> names{"free", "centred", "symmetric"};
	return names;
}

namespace
{

constexpr double kNegligible = 2e-5;

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

// Methods that move a ball's cells hundreds of times are made for free patterns only.
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

// Root mean square over the seeds; a plain mean of the greatest error, spread, distance and energy, which are no means of squares.
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

// A rough cost: starts by pairs of samples, each more expensive in the ball.
double costOf(const NoiseRow& row)
{
	const double count = row.recipe.count;
	const double each = row.recipe.domain == Domain::ball ? 10.0 : 1.0;
	return 50.0 + each * std::max(1, row.recipe.starts) * (count + count * count / 8.0);
}

std::vector<NoiseFit> fitTrends(const std::vector<NoiseRow>& rows)
{
	std::vector<NoiseFit> fits;
	for (const Domain domain : {Domain::disk, Domain::ball, Domain::sphere, Domain::hemisphere})
	{
		for (const MeasureField& measure : measureFields())
		{
			std::map<int, double> values;
			for (const NoiseRow& row : rows)
			{
				const std::optional<double> value = measure.get(row.quality);
				if (value && row.recipe.domain == domain && row.variant == Variant::free && row.recipe.method == Method::refine)
				{
					values[row.recipe.count] = *value;
				}
			}
			if (const std::optional<PowerFit> fit = fitPower(values))
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

std::span<const MeasureField> measureFields()
{
	using Value = std::optional<double>;
	static constexpr std::array<MeasureField, 7> fields{{
		{"noise",
		 [](const Quality& q) -> Value
		 {
			 return q.noise;
		 }},
		{"plane",
		 [](const Quality& q) -> Value
		 {
			 return q.plane;
		 }},
		{"bias",
		 [](const Quality& q) -> Value
		 {
			 return q.bias;
		 }},
		{"cliff",
		 [](const Quality& q) -> Value
		 {
			 return q.cliff;
		 }},
		{"centre",
		 [](const Quality& q) -> Value
		 {
			 return q.centre;
		 }},
		{"crease",
		 [](const Quality& q) -> Value
		 {
			 return q.crease;
		 }},
		{"spread",
		 [](const Quality& q) -> Value
		 {
			 return q.spread;
		 }},
	}};
	return fields;
}

std::optional<PowerFit> fitPower(const std::map<int, double>& values, int first_count)
{
	int n = 0;
	double sum_x = 0.0;
	double sum_y = 0.0;
	double sum_xx = 0.0;
	double sum_xy = 0.0;
	for (const auto& [count, value] : values)
	{
		if (count >= first_count && value > kNegligible)
		{
			const double x = logOf(count);
			const double y = logOf(value);
			n += 1;
			sum_x += x;
			sum_y += y;
			sum_xx += x * x;
			sum_xy += x * y;
		}
	}
	if (n < 4)
	{
		return std::nullopt;
	}
	const double slope = (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
	return PowerFit{expOf((sum_y - slope * sum_x) / n), -slope};
}

int reportStarts(const Recipe& recipe)
{
	if (!searches(recipe.method))
	{
		return 1;
	}
	const bool chief = recipe.method == Method::refine || recipe.method == Method::electro;
	const bool many = recipe.count <= 20 || (recipe.count >= 31 && recipe.count <= 35); // around the counts that VO §4.5 names
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

std::string noiseReportCommand(const NoiseReportSettings& settings)
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
	runStage({"patterns", report.rows.size(), [&](std::size_t i) { return costOf(report.rows[i]); },
			  [&](std::size_t i) { measureRow(settings, report.rows[i]); },
			  [&](std::size_t i, Archive& archive)
			  {
				  archive(report.rows[i]);
			  }},
			 run);
	if (isShare(run))
	{
		return report;
	}
	report.fits = fitTrends(report.rows);
	return report;
}

} // namespace nook
