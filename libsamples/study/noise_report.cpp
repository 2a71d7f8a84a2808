// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/noise_report.h"

#include "core/error.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/math.h"
#include "core/text.h"
#include "core/work_units.h"
#include "format/notes.h"
#include "page/assets.h"
#include "page/page_fill.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace nook
{

void visit(Archive& archive, NoiseRow& row)
{
	Quality& q = row.quality;
	archive(q.plane, q.noise, q.bias, q.plane_exact, q.greatest, q.cliff, q.cliff_greatest, q.centre, q.crease, q.cap, q.spread,
			q.smallest_distance, q.energy, q.energy_exponent);
	archive(row.pattern.domain, row.pattern.points, row.pattern.weights, row.pattern.powers);
}

namespace
{

constexpr double kNegligible = 2e-5;

bool searches(Method method)
{
	return method == Method::refine || method == Method::electro || method == Method::equal || method == Method::lloyd;
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

// The number of starting sets that a recipe gets when `starts` is 0: the generator's default, cut where the whole report would take
// too long. 1 for methods that do not search.
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
		return std::sqrt(sumOver(samples, [&](const Quality& q) { return get(q) * get(q); }) / count);
	};
	Quality average = samples.front();
	for (const auto field : {&Quality::plane, &Quality::noise, &Quality::bias, &Quality::plane_exact})
	{
		average.*field = rms([&](const Quality& q) { return q.*field; });
	}
	for (const auto field : {&Quality::greatest, &Quality::spread, &Quality::smallest_distance, &Quality::energy})
	{
		average.*field = sumOver(samples, [&](const Quality& q) { return q.*field; }) / count;
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
	if (row.recipe.method != Method::random && row.recipe.method != Method::poisson)
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

// The measures that the page offers.
constexpr std::array kMeasures{"noise", "plane", "bias", "cliff", "centre", "crease", "spread"};

std::optional<double> measureOf(const Quality& quality, std::string_view name)
{
	const std::vector<Measure> all = measuresOf(quality);
	const Measure* const found = firstWhere(all, [name](const Measure& one) { return one.name == name; });
	return found != nullptr ? std::optional(found->value) : std::nullopt;
}

std::vector<NoiseFit> fitTrends(const std::vector<NoiseRow>& rows)
{
	std::vector<NoiseFit> fits;
	for (const Domain domain : {Domain::disk, Domain::ball, Domain::sphere, Domain::hemisphere})
	{
		for (const char* const measure : kMeasures)
		{
			std::map<int, double> values;
			for (const NoiseRow& row : rows)
			{
				const std::optional<double> value = measureOf(row.quality, measure);
				if (value && row.recipe.domain == domain && row.variant == Variant::free && row.recipe.method == Method::refine)
				{
					values[row.recipe.count] = *value;
				}
			}
			if (const std::optional<PowerFit> fit = fitPower(values))
			{
				fits.push_back({domain, measure, fit->factor, fit->exponent});
			}
		}
	}
	return fits;
}

using Json = nlohmann::ordered_json;

// Seven significant digits are more than the grids are worth, and keep the page small.
double rounded(double value)
{
	return roundedNumber(value, 7);
}

double roundedCoordinate(double value)
{
	return std::floor(value * 1e4 + 0.5) / 1e4 + 0.0; // + 0.0: no −0
}

Json optionalNumber(const std::optional<double>& value)
{
	return value ? Json(rounded(*value)) : Json();
}

Json measuresJson(std::span<const NoiseRow> rows)
{
	Json measures = Json::object();
	for (const char* const measure : kMeasures)
	{
		if (measureOf(rows.front().quality, measure)) // this domain defines it
		{
			measures[measure] = mapped(rows, [&](const NoiseRow& row) { return optionalNumber(measureOf(row.quality, measure)); });
		}
	}
	return measures;
}

void addPoints(Json& series, std::span<const NoiseRow> rows)
{
	series["points"] = Json::array();
	series["weights"] = Json::array();
	for (const NoiseRow& row : rows)
	{
		Json points = Json::array();
		for (const glm::dvec3& p : row.pattern.points)
		{
			points.push_back(roundedCoordinate(p.x));
			points.push_back(roundedCoordinate(p.y));
			if (!isPlanar(row.pattern.domain))
			{
				points.push_back(roundedCoordinate(p.z));
			}
		}
		series["points"].push_back(points);
		series["weights"].push_back(mapped(row.pattern.weights, [](double weight) { return roundedNumber(weight, 4); }));
	}
}

// The rows have all but the count in common.
Json seriesJson(std::span<const NoiseRow> rows, bool with_points)
{
	const Method method = rows.front().recipe.method;
	Json series;
	series["domain"] = nameOf(rows.front().recipe.domain);
	series["variant"] = nameOf(rows.front().variant);
	series["method"] = nameOf(method);
	series["weights_rule"] = nameOf(WeightRule::voronoi);
	series["voronoi"] = "exact";
	series["counts"] = mapped(rows, [](const NoiseRow& row) { return row.recipe.count; });
	series["starts"] = mapped(rows, [](const NoiseRow& row) { return row.recipe.starts; });
	series["measures"] = measuresJson(rows);
	if (with_points && (method == Method::refine || method == Method::electro))
	{
		addPoints(series, rows);
	}
	return series;
}

Json allSeries(const NoiseReport& report, bool with_points)
{
	Json list = Json::array();
	const auto inSeries = [](const NoiseRow& a, const NoiseRow& b)
	{
		return a.recipe.domain == b.recipe.domain && a.variant == b.variant && a.recipe.method == b.recipe.method;
	};
	eachRun(std::span(report.rows), inSeries,
			[&](std::span<const NoiseRow> rows) { list.push_back(seriesJson(rows, with_points)); });
	return list;
}

Json figuresJson(const NoiseReport& report, const std::string& command, const std::string& version, bool with_points)
{
	Json json;
	json["schema"] = "nook.report.noise/1";
	json["command"] = command;
	json["version"] = version;
	const NoiseReportSettings& s = report.settings;
	json["settings"] = {{"max_count", s.max_count}, {"starts", s.starts}, {"random_seeds", s.random_seeds}, {"seed", s.seed}};
	json["series"] = allSeries(report, with_points);
	const auto fitJson = [](const NoiseFit& fit)
	{
		return Json{{"domain", nameOf(fit.domain)},
					{"measure", fit.measure},
					{"factor", rounded(fit.factor)},
					{"exponent", rounded(fit.exponent)}};
	};
	json["fits"] = mapped(report.fits, fitJson);
	return json;
}

// The range of starts of each domain and method.
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

// Term and explanation.
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
		{"made by", std::string("`") + command + "`, nook " + version + ", seed " + std::to_string(s.seed) +
						". The same command makes the same bytes, on any number of threads. The figures are also to be had as JSON "
						"(`--json FILE`)."},
	};
}

} // namespace

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

std::string noiseReportJson(const NoiseReport& report, const std::string& command, const std::string& version)
{
	return jsonFile(figuresJson(report, command, version, false));
}

std::string noiseReportHtml(const NoiseReport& report, const std::string& command, const std::string& version)
{
	Json data = figuresJson(report, command, version, true);
	const int most = report.settings.max_count;
	data["lead"] = "Patterns for line samples, point samples and directions, N = 1 to " + std::to_string(most) +
				   ", made by every method and measured over the same half-spaces.";
	data["reading"] = readingText(report, command, version);
	for (const auto& [name, wanted] :
		 {std::pair{"selected", std::vector<int>{3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 19, 24, 32, 33, 48, 64}},
		  std::pair{"compared", std::vector<int>{4, 8, 9, 16, 32, 64}}})
	{
		data[name] = itemsWhere(wanted, [most](int count) { return count <= most; });
	}
	return pageHtml({"noise against sample count",
					 version,
					 assets::page_html,
					 {},
					 {assets::charts_js, assets::pictures_js, assets::page_js},
					 jsonLine(data)});
}

} // namespace nook
