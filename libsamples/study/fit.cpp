// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/fit.h"

#include "core/error.h"
#include "core/json_text.h"
#include "core/work_units.h"
#include "methods/method_table.h"
#include "scene/camera_choice.h"
#include "study/fit_search.h"
#include "study/shape_fit.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

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

// The search varies positive numbers only, never one that may be 0.
bool isVaried(const RecipeValue& value)
{
	return value.feature->kind == FeatureKind::number && !isShape(value) && value.value > 0.0;
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
		for (std::size_t i = 0; i < levels; ++i)
		{
			m_fit.errors.push_back({before[i], after[i]});
		}
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
	nlohmann::ordered_json errors = nlohmann::ordered_json::array();
	for (std::size_t i = 0; i < report.levels.size(); ++i)
	{
		errors.push_back({{"level", report.levels[i].name},
						  {"held_out", report.levels[i].held_out},
						  {"paper", fourPlaces(fit.errors[i].paper)},
						  {"rays", fourPlaces(fit.errors[i].rays)}});
	}
	return errors;
}

// Reads the report's levels and says of each what it is; `benches` holds what the views point to.
std::vector<FitView> readViews(FitReport& report, std::vector<LevelBench>& benches, const LoadSettings& load,
							   const RunSettings& run)
{
	const FitSettings& settings = report.settings;
	const RunSettings whole = withoutUnits(run); // what every part needs
	const auto samples = std::make_shared<SampleStore>();
	std::vector<FitView> views;
	benches.reserve(report.levels.size()); // views point to them
	ProgressCounter read(run.progress, "levels", countIfSeveral(report.levels.size()));
	for (std::size_t i = 0; i < report.levels.size(); ++i)
	{
		FitLevel& level = report.levels[i];
		LoadedLevel loaded = loadLevel(level.given, load, whole);
		addInputs(loaded.level.files, run);
		level.name = loaded.level.name;
		level.files = loaded.level.files;
		LevelBench& bench = benches.emplace_back(std::move(loaded.level), settings.radius_m, whole, samples);
		level.radius_m = bench.radiusM();
		for (const LevelCamera& camera : chooseCameras(bench.tracer(), settings.views, whole))
		{
			level.views.push_back(camera.name);
			views.push_back(
				{i, ViewBench(bench, camera, {settings.width_px, settings.height_px, settings.reference_rays}, whole), {}});
			views.back().counted = surfacesOf(views.back().bench.gbuffer());
			if (!(views.back().bench.surfaceShare() > 0.0))
			{
				throw Error(ExitCode::invalid_input, level.given + ": found a view without a surface, expected one to fit to");
			}
		}
		read.finishOne();
	}
	return views;
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
	std::vector<LevelBench> benches;
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

} // namespace nook
