// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/tune.h"

#include "core/decimal.h"
#include "core/lists.h"
#include "core/system.h"
#include "core/text.h"
#include "emit/module.h"
#include "emit/module_parts.h"
#include "format/pattern_json.h"
#include "format/tile_json.h"
#include "methods/feature_table.h"
#include "pattern/quality.h"
#include "pattern/recipe.h"
#include "study/fit.h"

#include <algorithm>
#include <cctype>
#include <set>

namespace nook
{
namespace
{

constexpr const char* kPatternFile = "pattern.json";
constexpr const char* kTileFile = "tile.json";
constexpr const char* kModule = "nook_ao.glsl";
constexpr const char* kHeader = "nook_ao.h";

// Lengths for people to type.
std::string length(double value_m)
{
	return roundedText(value_m, 6);
}

class Emitter
{
public:
	Emitter(const TuneReport& report, const TuneEmitSettings& settings, const RunSettings& run)
		: m_report(report), m_settings(settings), m_run(run), m_candidate(report.candidates[*report.search.taken()])
	{
	}

	TuneEmission take()
	{
		if (m_candidate.kind == CandidateKind::asset)
		{
			addAsset();
		}
		else
		{
			addModule();
		}
		return std::move(m_made);
	}

private:
	std::string addSamples(ModuleMethod& method)
	{
		const CandidatePattern samples = patternOf(m_candidate, m_run);
		const std::string command = patternCommand(samples.recipe);
		const Quality quality = measurePattern(samples.pattern, m_run, samples.recipe.exponent);
		m_made.files.push_back({kPatternFile,
								patternJson(samples.pattern, &samples.recipe, quality, {command, m_settings.version, {}, {}}),
								"the pattern, " + std::to_string(samples.pattern.count()) + " samples"});
		m_made.commands.push_back(command + " -o " + kPatternFile);
		const PatternTile tile = generateTile(samples.pattern, samples.tile, m_run);
		const std::string tile_command = tileCommand(samples.tile, kPatternFile);
		m_made.files.push_back(
			{kTileFile,
			 tileJson(tile, &samples.tile, measureTile(tile, samples.pattern, m_run),
					  {tile_command, m_settings.version, {}, command}),
			 "its variants for the pixels of a window of " + std::to_string(tile.size) + " × " + std::to_string(tile.size)});
		m_made.commands.push_back(tile_command + " -o " + kTileFile);
		method.variants = m_candidate.shade.volume.paired ? mapped(tile.variants, pairedPattern) : tile.variants;
		return tile_command;
	}

	void addModule()
	{
		ModuleSettings module;
		module.target = m_settings.target;
		module.device_depth = m_settings.device_depth;
		module.shade = m_candidate.recipe ? m_candidate.shade : shadeSettingsOf(m_candidate, 1.0);
		ModuleMethod method{m_candidate.shade.method, {}};
		std::string base;
		std::string command = "nook emit --methods " + m_candidate.method();
		if (takesPattern(method.method))
		{
			base = addSamples(method);
			command += std::string(" --patterns ") + kTileFile;
		}
		if (m_candidate.recipe)
		{
			method.recipe = m_candidate.recipe;
			method.shade = shadeSettingsOf(m_candidate, 1.0);
		}
		command += m_candidate.recipe ? "" : " --recipe paper";
		if (m_report.shape_before)
		{
			const CurveShape shape = shapeOf(*m_candidate.recipe);
			command += " --strength " + numberText(shape.strength) + " --power " + numberText(shape.power);
		}
		module.methods.push_back(method);
		const std::string glsl = (m_settings.device_depth ? std::string(" --depth device") : std::string()) +
								 emitOptions(module.shade) + " --glsl " + std::string(nook::nameOf(m_settings.target));
		m_made.files.push_back(
			{kModule, moduleGlsl(module, {command + glsl, m_settings.version, {}, base}),
			 "the shader's functions, GLSL " + std::string(nook::nameOf(m_settings.target)) + "; its head lists the passes"});
		m_made.files.push_back(
			{kHeader, moduleHeader(module, {command, m_settings.version, {}, base}),
			 std::string("C++: fills the shader's block") + (base.empty() ? "" : ", and holds the tile's texels")});
		m_made.commands.push_back(command + glsl + " -o " + kModule + " -o " + kHeader);
		useOfModule();
	}

	void useOfModule()
	{
		for (const TuneLevel& level : m_report.levels)
		{
			if (level.failed.empty())
			{
				const ShadeSettings shade = shadeSettingsOf(m_candidate, level.radius_m);
				if (m_candidate.recipe)
				{
					m_made.use.push_back(level.name + ": " + stemOf(*m_candidate.row()) + "_settings(" + length(level.radius_m) +
										 ") fills nook_settings");
					continue;
				}
				m_made.use.push_back(
					level.name + ": nook_settings.radius = " + length(shade.radius_m) + " m" +
					(shade.volume.thickness_m > 0.0 ? ", thickness = " + length(shade.volume.thickness_m) + " m" : std::string()));
			}
		}
		if (m_report.shape_before)
		{
			const CurveShape before = shapeOf(*m_report.shape_before);
			const CurveShape now = shapeOf(*m_candidate.recipe);
			m_made.use.push_back("strength and power are fitted to these levels: " + numberText(now.strength) + " and " +
								 numberText(now.power) + ", in place of " + numberText(before.strength) + " and " +
								 numberText(before.power));
		}
		m_made.use.emplace_back(m_settings.device_depth ? "the module reads the depth buffer as it is: nook_settings.device_depth"
														: "the module reads depth along the view direction, metres");
	}

	// Returns a file name from the level's name that no other level of this run has.
	std::string nameOf(const TuneLevel& level, const std::string& ending)
	{
		std::string stem = level.name.empty() ? "level" : level.name;
		std::replace_if(
			stem.begin(), stem.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '-'; }, '_');
		std::string name = stem;
		for (int i = 2; !m_names.insert(name).second; ++i)
		{
			name = stem + "-" + std::to_string(i);
		}
		return name + ending;
	}

	void addAsset()
	{
		const AssetKind& kind = *m_candidate.asset;
		AssetEmission made{m_candidate, m_settings.target, m_settings.device_depth, m_settings.version, {}};
		made.add_levels = [&]
		{
			for (const TuneLevel& level : m_report.levels)
			{
				if (level.failed.empty())
				{
					addAssetOf(level, kind, made);
				}
			}
		};
		kind.emit(made);
		m_made.files = std::move(made.files);
		m_made.commands = std::move(made.commands);
		m_made.use = std::move(made.use);
	}

	void addAssetOf(const TuneLevel& level, const AssetKind& kind, AssetEmission& made)
	{
		LevelAsset& asset = level.bench->asset(m_candidate);
		const std::string name = nameOf(level, std::string(kind.ending));
		std::string what;
		const std::string load = loadOptions(m_settings.load);
		const std::string file = nativePath(level.given).filename().string();
		std::string bytes = asset.file(
			{m_settings.version, kind.command(m_candidate, {file + load, level.radius_m}), level.given, m_settings.load, m_run},
			what);
		what += kind.with_level ? ", " + bytesText(asset.bytes()) + " more than the level" : "";
		made.files.push_back({name, std::move(bytes), what});
		made.commands.push_back(kind.command(m_candidate, {shellWord(level.given) + load, level.radius_m}) + " -o " + name);
	}

	const TuneReport& m_report;
	const TuneEmitSettings& m_settings;
	RunSettings m_run;
	const Candidate& m_candidate;
	std::set<std::string> m_names;
	TuneEmission m_made;
};

struct Feature
{
	const char* name;
	bool has; // the candidate
};

// In a fixed order, the same for every candidate.
std::vector<Feature> featuresOf(const Candidate& c)
{
	const bool screen = c.kind == CandidateKind::screen;
	std::vector<Feature> features{{"a filter", screen && c.shade.filter != ShadeFilter::none},
								  {"half resolution", screen && c.shade.half_resolution},
								  {"thickness", c.thickness_ratio > 0.0},
								  {"areas (moments of depth)", screen && c.row()->moments},
								  {"summed-area tables (StatVO)", screen && c.row()->layers_text != nullptr},
								  {"quadrants", screen && c.shade.statvo.quadrants},
								  {"screen space, which what moves needs", screen}};
	for (const bool is_method : {false, true}) // kinds with a row in the method table last
	{
		for (const AssetKind& kind : assetTable())
		{
			if ((methodNamed(kind.name) != nullptr) == is_method)
			{
				features.push_back({kind.what.data(), c.asset == &kind});
			}
		}
	}
	return features;
}

// Returns the best candidate with a feature, by what was found of it or is expected: of those that reach the goal, else the
// nearest.
std::optional<std::size_t> bestWith(const TuneReport& report, std::size_t feature)
{
	const TuneGoal& goal = report.settings.goal;
	const auto rank = [&](const Tried& tried)
	{
		const bool reached = reaches(goal, tried.time_s, tried.error);
		const double wanted = goal.budget_s ? tried.error : tried.time_s;
		const double bounded = goal.budget_s ? tried.time_s : tried.error;
		return std::pair(reached ? 0 : 1, reached ? wanted : bounded);
	};
	std::optional<std::size_t> best;
	for (const Tried& tried : report.search.tried)
	{
		if (tried.failed.empty() && !tried.trial.views.empty() && featuresOf(report.candidates[tried.candidate])[feature].has &&
			(!best || rank(tried) < rank(report.search.tried[*best])))
		{
			best = tried.candidate;
		}
	}
	return best;
}

std::vector<LeftOut> leftOut(const TuneReport& report, const TuneEmitSettings& settings)
{
	const Candidate& pick = report.candidates[*report.search.taken()];
	const TuneGoal& goal = report.settings.goal;
	std::vector<LeftOut> left;
	const std::vector<Feature> features = featuresOf(pick);
	for (std::size_t i = 0; i < features.size(); ++i)
	{
		const std::optional<std::size_t> best = features[i].has ? std::nullopt : bestWith(report, i);
		if (!best)
		{
			continue;
		}
		const Tried& tried = report.search.tried[*best];
		std::string why = "best with it is " + triedText(report, *best);
		why += isFrom(tried, report.rungs.once()) ? "" : " (expected from coarser measurements)";
		why += reaches(goal, tried.time_s, tried.error) ? "" : ", which does not reach the goal";
		left.push_back({features[i].name, why});
	}
	if (pick.kind == CandidateKind::screen)
	{
		left.push_back(
			{"two radii, quadratic falloff, a cut, samples of MSAA, bands of fewer samples, coarser depths for far samples, "
			 "paired lines, samples without normals",
			 "not searched: `nook emit` has them"});
	}
	if (!drawsVolumes(settings.target, true))
	{
		left.push_back({"masks of directions", "not searched: they are drawn by `--glsl 330`, `430` or `vulkan`"});
	}
	return left;
}

} // namespace

TuneEmission emitPick(const TuneReport& report, const TuneEmitSettings& settings, const RunSettings& run)
{
	TuneEmission made = Emitter(report, settings, run).take();
	made.left_out = leftOut(report, settings);
	return made;
}

} // namespace nook
