// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/fit.h"

#include "core/error.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/math.h"
#include "core/work_units.h"
#include "methods/method_table.h"
#include "scene/camera_choice.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <utility>

namespace nook
{

void visit(Archive& archive, FitError& error)
{
	archive(error.paper, error.rays);
}

namespace
{

constexpr int kFitCount = 5; // samples of a tile: more change the recipe by less than its digits

// Few steps miss what more of them see: a recipe fitted with four would darken pictures of nine by too much.
constexpr SliceSettings kFitSlices{.count = 2, .steps = 6};

constexpr std::string_view kStrength = "--strength";
constexpr std::string_view kPower = "--power";

// The search varies positive numbers only, never one that may be 0.
bool isVaried(const RecipeValue& value)
{
	const bool shapes = value.feature->option == kStrength || value.feature->option == kPower;
	return value.feature->kind == FeatureKind::number && !shapes && value.value > 0.0;
}

struct FitView
{
	std::size_t level = 0;
	ViewBench bench;
	std::vector<char> counted; // pixels with a surface
};

std::vector<FitNumber> numbersOf(const MethodRecipe& recipe)
{
	std::vector<FitNumber> numbers{{recipe.radius, 0.05, 4.0}};
	for (const RecipeValue& one : recipe.values)
	{
		if (isVaried(one))
		{
			numbers.push_back({one.value, std::max(one.feature->least, 1e-3), one.feature->most});
		}
	}
	return numbers;
}

// The recipe with these numbers, and a shape.
MethodRecipe recipeWith(MethodRecipe recipe, const std::vector<double>& numbers, const CurveShape& shape)
{
	recipe.radius = numbers.front();
	std::size_t next = 1;
	for (RecipeValue& one : recipe.values)
	{
		if (isVaried(one))
		{
			one.value = numbers[next++];
		}
	}
	setShape(recipe, shape);
	return recipe;
}

class MethodFitter
{
public:
	MethodFitter(std::vector<FitView>& views, const MethodRecipe& start) : m_views(views), m_start(start)
	{
		m_how.device = Device::cpu;
		m_how.errors = false;
		m_fit.candidate = fittedCandidate(rowOf(start.method));
	}

	// `fitted`: how many levels, the first ones, are fitted to.
	MethodFit fit(std::size_t fitted, std::size_t levels, const FitSearch& search)
	{
		const std::vector<double> found = fitNumbers(numbersOf(m_start), search,
													 [&](const std::vector<double>& numbers)
													 {
														 const std::vector<ShapeView> views = drawn(numbers, fitted);
														 return shapedError(views, fitShape(views));
													 });
		const Candidate paper = m_fit.candidate;
		m_fit.candidate.recipe = recipeWith(m_start, found, fitShape(drawn(found, fitted)));
		const std::vector<double> before = errorsOf(paper, levels);
		const std::vector<double> after = errorsOf(m_fit.candidate, levels);
		m_fit.errors = listOf(levels, [&](std::size_t i) { return FitError{before[i], after[i]}; });
		return m_fit;
	}

private:
	std::vector<ShapeView> drawn(const std::vector<double>& numbers, std::size_t fitted)
	{
		Candidate candidate = m_fit.candidate;
		candidate.recipe = recipeWith(m_start, numbers, CurveShape{});
		m_fit.tried += 1;
		std::vector<ShapeView> views;
		for (FitView& view : m_views)
		{
			if (view.level < fitted)
			{
				views.push_back(
					shapeView(view.level, view.bench.draw(candidate, m_how), view.bench.reference().visibility, view.counted));
			}
		}
		return views;
	}

	std::vector<double> errorsOf(const Candidate& candidate, std::size_t levels)
	{
		std::vector<double> sums(levels);
		std::vector<double> counts(levels);
		for (FitView& view : m_views)
		{
			sums[view.level] += view.bench.errorBy(ErrorMeasure::rmse, view.bench.draw(candidate, m_how));
			counts[view.level] += 1.0;
		}
		for (std::size_t i = 0; i < levels; ++i)
		{
			sums[i] /= std::max(1.0, counts[i]);
		}
		return sums;
	}

	std::vector<FitView>& m_views;
	const MethodRecipe& m_start;
	MeasureSettings m_how;
	MethodFit m_fit;
};

void passFit(Archive& archive, const MethodRecipe& start, MethodFit& fit)
{
	std::string recipe = archive.reads() ? "" : recipesFile({*fit.candidate.recipe}, "");
	archive(recipe, fit.tried, fit.errors);
	if (archive.reads())
	{
		fit.candidate = fittedCandidate(rowOf(start.method));
		fit.candidate.recipe = recipesOf(recipe, "a kept recipe").front();
	}
}

double fourPlaces(double error)
{
	return std::floor(1e4 * error + 0.5) / 1e4;
}

nlohmann::ordered_json errorsJson(const FitReport& report, const MethodFit& fit)
{
	const auto errorJson = [&](std::size_t i)
	{
		return nlohmann::ordered_json{{"level", report.levels[i].name},
									  {"held_out", report.levels[i].held_out},
									  {"paper", fourPlaces(fit.errors[i].paper)},
									  {"rays", fourPlaces(fit.errors[i].rays)}};
	};
	return listOf(report.levels.size(), errorJson);
}

// Reads the report's levels and says of each what it is; `benches` holds what the views point to.
std::vector<FitView> readViews(FitReport& report, std::deque<LevelBench>& benches, const LoadSettings& load, const RunSettings& run)
{
	const FitSettings& settings = report.settings;
	const RunSettings whole = withoutUnits(run); // what every part needs
	const auto samples = std::make_shared<SampleStore>();
	std::vector<FitView> views;
	ProgressCounter read(run.progress, "levels", countIfSeveral(report.levels.size()));
	for (std::size_t i = 0; i < report.levels.size(); ++i)
	{
		FitLevel& level = report.levels[i];
		LoadedLevel loaded = loadLevel(level.given, load, whole);
		addInputs(loaded.level.files, run);
		level.name = loaded.level.name;
		level.files = loaded.level.files;
		LevelBench& bench = benches.emplace_back(std::move(loaded.level), settings.radius_m, whole, samples);
		level.radius_m = bench.radius_m;
		for (const LevelCamera& camera : chooseCameras(bench.tracer, settings.views, whole))
		{
			level.views.push_back(camera.name);
			views.push_back(
				{i, ViewBench(bench, camera, {settings.width_px, settings.height_px, settings.reference_rays}, whole), {}});
			views.back().counted = surfacesOf(views.back().bench.gbuffer());
			refuseIf(!(views.back().bench.surfaceShare() > 0.0),
					 level.given + ": found a view without a surface, expected one to fit to", ExitCode::invalid_input);
		}
		read.finishOne();
	}
	return views;
}

// Rounds to three digits, the same on every machine: powers of ten up to 1e22 are exact.
double threeDigits(double value)
{
	double unit = 1.0;
	while (value * unit < 100.0)
	{
		unit *= 10.0;
	}
	return std::floor(value * unit + 0.5) / unit;
}

class NumberSearch
{
public:
	NumberSearch(const std::vector<FitNumber>& numbers, const std::function<double(const std::vector<double>&)>& error)
		: m_numbers(numbers), m_error(error)
	{
	}

	double at(const std::vector<double>& values)
	{
		const auto found = m_known.find(values);
		return found != m_known.end() ? found->second : m_known.emplace(values, m_error(values)).first->second;
	}

	double moved(std::size_t i, double value) const
	{
		return threeDigits(std::clamp(value, m_numbers[i].least, m_numbers[i].most));
	}

	// The best of each number up and down by a factor.
	std::vector<double> explored(std::vector<double> from, double factor)
	{
		for (std::size_t i = 0; i < from.size(); ++i)
		{
			for (const double by : {factor, 1.0 / factor})
			{
				std::vector<double> tried = from;
				tried[i] = moved(i, from[i] * by);
				if (at(tried) < at(from))
				{
					from = tried;
					break;
				}
			}
		}
		return from;
	}

	// Repeats the step from `before` to `now`.
	std::vector<double> onward(const std::vector<double>& before, const std::vector<double>& now) const
	{
		std::vector<double> next = now;
		for (std::size_t i = 0; i < next.size(); ++i)
		{
			next[i] = moved(i, now[i] * now[i] / before[i]);
		}
		return next;
	}

private:
	const std::vector<FitNumber>& m_numbers;
	const std::function<double(const std::vector<double>&)>& m_error;
	std::map<std::vector<double>, double> m_known;
};

// Less leaves closed niches bright, for 1 % of the error (a power makes up for it elsewhere).
constexpr double kLeastStrength = 0.8;

constexpr std::size_t kBins = 512; // of visibility: half a step of eight bits

double shapedAt(double visibility, const CurveShape& shape)
{
	const double open = 1.0 - shape.strength * (1.0 - visibility);
	return open > 0.0 ? powOf(open, shape.power) : 0.0;
}

} // namespace

Candidate fittedCandidate(const MethodRow& row)
{
	Candidate candidate;
	candidate.shade.method = row.method;
	candidate.shade.slices = kFitSlices;
	candidate.radius_ratio = row.radius_ratio;
	const bool tiled = row.domain && row.own_pattern == nullptr;
	candidate.source = tiled ? SampleSource::tile : SampleSource::own;
	candidate.count = tiled ? kFitCount : row.domain ? row.default_count : ownSamples(candidate.shade).count;
	candidate.shade.filter = hasNoise(row) ? ShadeFilter::bilateral : ShadeFilter::none;
	return candidate;
}

FitReport fitRecipes(const std::vector<std::string>& levels, const std::vector<std::string>& held_out, const LoadSettings& load,
					 const FitSettings& settings, const RunSettings& run)
{
	FitReport report;
	report.settings = settings;
	for (const auto* const list : {&levels, &held_out})
	{
		for (const std::string& given : *list)
		{
			report.levels.push_back({given, list == &held_out, {}, {}, 0.0, {}});
		}
	}
	std::deque<LevelBench> benches;
	std::vector<FitView> views = readViews(report, benches, load, run);
	FitSearch search;
	std::optional<ProgressCounter> fitted(std::in_place, run.progress, "methods", settings.starts.size() * stepsOf(search));
	search.step_done = [&fitted]
	{
		fitted->finishOne();
	};
	report.fits.resize(settings.starts.size());
	const auto fit = [&](std::size_t i)
	{
		report.fits[i] = MethodFitter(views, settings.starts[i]).fit(levels.size(), report.levels.size(), search);
	};
	const RunSettings one_by_one{1, {}, run.units}; // each on all threads
	runStage({"methods", settings.starts.size(),
			  [&](std::size_t i) { return static_cast<double>(numbersOf(settings.starts[i]).size()); }, fit,
			  [&](std::size_t i, Archive& archive)
			  {
				  passFit(archive, settings.starts[i], report.fits[i]);
			  }},
			 one_by_one);
	fitted.reset();
	return report;
}

std::string fitJson(const FitReport& report, const std::string& command, const std::string& version)
{
	nlohmann::ordered_json recipes = nlohmann::ordered_json::array();
	for (const MethodFit& fit : report.fits)
	{
		recipes.push_back(recipeJson(*fit.candidate.recipe));
		recipes.back()["errors"] = errorsJson(report, fit);
	}
	return jsonFile(
		nlohmann::ordered_json{{"format", kRecipesFormat}, {"nook_version", version}, {"command", command}, {"recipes", recipes}});
}

std::size_t stepsOf(const FitSearch& search)
{
	std::size_t steps = 0;
	for (double factor = search.first_step; factor >= search.last_step; factor = std::sqrt(factor))
	{
		steps += 1;
	}
	return steps;
}

std::vector<double> fitNumbers(const std::vector<FitNumber>& numbers, const FitSearch& settings,
							   const std::function<double(const std::vector<double>&)>& error)
{
	NumberSearch search(numbers, error);
	std::vector<double> best = listOf(numbers.size(), [&](std::size_t i) { return search.moved(i, numbers[i].start); });
	for (double factor = settings.first_step; factor >= settings.last_step; factor = std::sqrt(factor))
	{
		for (std::vector<double> next = search.explored(best, factor); search.at(next) < search.at(best);)
		{
			const std::vector<double> before = best;
			best = next;
			next = search.explored(search.onward(before, best), factor);
			if (!(search.at(next) < search.at(best)))
			{
				next = search.explored(best, factor);
			}
		}
		if (settings.step_done)
		{
			settings.step_done();
		}
	}
	return best;
}

std::vector<char> surfacesOf(const GBuffer& gbuffer)
{
	return mapped(gbuffer.depth, [](const float depth) { return static_cast<char>(std::isfinite(depth) ? 1 : 0); });
}

CurveShape shapeOf(const MethodRecipe& recipe)
{
	CurveShape shape;
	for (const RecipeValue& one : recipe.values)
	{
		shape.strength = one.feature->option == kStrength ? one.value : shape.strength;
		shape.power = one.feature->option == kPower ? one.value : shape.power;
	}
	return shape;
}

void setShape(MethodRecipe& recipe, const CurveShape& shape)
{
	for (const auto& [option, value] : {std::pair(kStrength, shape.strength), std::pair(kPower, shape.power)})
	{
		const FeatureRow* const feature = &featureOf(option);
		RecipeValue* const found = firstWhere(recipe.values, [=](const RecipeValue& one) { return one.feature == feature; });
		(found != nullptr ? *found : recipe.values.emplace_back()) = {feature, value};
	}
}

ShapeView shapeView(std::size_t level, std::span<const float> visibility, std::span<const float> rays,
					std::span<const char> counted)
{
	ShapeView view;
	view.level = level;
	view.pixels.resize(kBins);
	view.sums.resize(kBins);
	view.rays.resize(kBins);
	for (std::size_t i = 0; i < visibility.size(); ++i)
	{
		if (counted[i] != 0)
		{
			const auto value = static_cast<double>(visibility[i]);
			const auto truth = static_cast<double>(rays[i]);
			const std::size_t bin = std::min(kBins - 1, static_cast<std::size_t>(value * static_cast<double>(kBins)));
			view.pixels[bin] += 1.0;
			view.sums[bin] += value;
			view.rays[bin] += truth;
			view.squares += truth * truth;
		}
	}
	return view;
}

double shapedError(std::span<const ShapeView> views, const CurveShape& shape)
{
	std::vector<double> sums;
	std::vector<double> counts;
	for (const ShapeView& view : views)
	{
		double squares = view.squares;
		double pixels = 0.0;
		for (std::size_t i = 0; i < view.pixels.size(); ++i)
		{
			if (view.pixels[i] > 0.0)
			{
				const double value = shapedAt(view.sums[i] / view.pixels[i], shape);
				squares += value * (value * view.pixels[i] - 2.0 * view.rays[i]);
				pixels += view.pixels[i];
			}
		}
		sums.resize(std::max(sums.size(), view.level + 1));
		counts.resize(sums.size());
		sums[view.level] += pixels > 0.0 ? std::max(0.0, squares / pixels) : 0.0;
		counts[view.level] += 1.0;
	}
	double sum = 0.0;
	double levels = 0.0;
	for (std::size_t i = 0; i < sums.size(); ++i)
	{
		sum += counts[i] > 0.0 ? sums[i] / counts[i] : 0.0;
		levels += counts[i] > 0.0 ? 1.0 : 0.0;
	}
	return levels > 0.0 ? std::sqrt(sum / levels) : 0.0;
}

CurveShape fitShape(std::span<const ShapeView> views)
{
	const auto error = [views](const std::vector<double>& values)
	{
		return shapedError(views, {values[0], values[1]});
	};
	const std::vector<double> found = fitNumbers({{1.0, kLeastStrength, 5.0}, {1.0, 0.2, 5.0}}, {1.6, 1.005}, error);
	return {found[0], found[1]};
}

} // namespace nook
