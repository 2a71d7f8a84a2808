// SPDX-License-Identifier: GPL-3.0-or-later
#include "tune/tune_emit.h"

#include "bench/command_words.h"
#include "core/error.h"
#include "core/number.h"
#include "core/text.h"
#include "emit/module_parts.h"
#include "emit/module_volumes.h"
#include "fit/shape_fit.h"
#include "format/pattern_json.h"
#include "format/tile_json.h"
#include "measure/quality.h"
#include "methods/feature_table.h"
#include "pattern/generate.h"
#include "scene/level_glb.h"
#include "volume/runtime_assets.h"
#include "volume/volume_glb.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <set>

namespace nook
{
namespace
{

constexpr const char* kPatternFile = "pattern.json";
constexpr const char* kTileFile = "tile.json";
constexpr const char* kModule = "nook_ao.glsl";
constexpr const char* kHeader = "nook_ao.h";
constexpr const char* kVolumeModule = "nook_aov.glsl";

// Lengths for people to type.
std::string length(double value_m)
{
	return roundedText(value_m, 6);
}

std::string targetName(GlslTarget target)
{
	return std::string(glslTargets()[static_cast<std::size_t>(target)]);
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
		if (m_candidate.kind == CandidateKind::volumes)
		{
			addVolumes();
		}
		else if (m_candidate.kind == CandidateKind::bake)
		{
			addBakes();
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
		const std::string command = commandOf(samples.recipe);
		const Quality quality = measurePattern(samples.pattern, m_run, samples.recipe.exponent);
		m_made.files.push_back({kPatternFile,
								patternJson(samples.pattern, &samples.recipe, quality, {command, m_settings.version, {}, {}}),
								"the pattern, " + std::to_string(samples.pattern.count()) + " samples"});
		m_made.commands.push_back(command + " -o " + kPatternFile);
		const PatternTile tile = generateTile(samples.pattern, samples.tile, m_run);
		const std::string tile_command = commandOf(samples.tile, kPatternFile);
		m_made.files.push_back(
			{kTileFile,
			 tileJson(tile, &samples.tile, measureTile(tile, samples.pattern, m_run),
					  {tile_command, m_settings.version, {}, command}),
			 "its variants for the pixels of a window of " + std::to_string(tile.size) + " × " + std::to_string(tile.size)});
		m_made.commands.push_back(tile_command + " -o " + kTileFile);
		method.variants = tile.variants;
		if (m_candidate.shade.volume.paired)
		{
			for (Pattern& variant : method.variants)
			{
				variant = pairedPattern(variant);
			}
		}
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
								 emitOptions(module.shade) + " --glsl " + targetName(m_settings.target);
		m_made.files.push_back({kModule, moduleGlsl(module, {command + glsl, m_settings.version, {}, base}),
								"the shader's functions, GLSL " + targetName(m_settings.target) + "; its head lists the passes"});
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

	// Of the level's own name what a file may be called, and no other level of this run is.
	std::string nameOf(const TuneLevel& level, const char* ending)
	{
		std::string stem;
		for (const char c : level.name)
		{
			stem += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
		}
		stem = stem.empty() ? "level" : stem;
		std::string name = stem;
		for (int i = 2; !m_names.insert(name).second; ++i)
		{
			name = stem + "-" + std::to_string(i);
		}
		return name + ending;
	}

	void addVolumes()
	{
		const AovTextSettings text{m_settings.target == GlslTarget::gl430, m_candidate.aov.mask ? m_candidate.aov.directions : 0,
								   m_settings.device_depth};
		if (!drawsVolumes(m_settings.target))
		{
			throw Error(ExitCode::unsupported, "glsl: found " + targetName(m_settings.target) + " with " + m_candidate.method() +
												   " as the pick, expected 330 or 430, or methods without it");
		}
		std::string command = "nook emit --methods " + m_candidate.method() + (m_settings.device_depth ? " --depth device" : "");
		command += m_candidate.aov.mask ? " --directions " + std::to_string(m_candidate.aov.directions) : "";
		command += " --glsl " + targetName(m_settings.target);
		m_made.files.push_back({kVolumeModule, volumesGlsl(text, {command, m_settings.version, {}, {}}),
								"the stages that draw volumes; its head says how"});
		m_made.commands.push_back(command + " -o " + kVolumeModule);
		for (const TuneLevel& level : m_report.levels)
		{
			if (level.failed.empty())
			{
				addVolumesOf(level);
			}
		}
		for (const auto& [name, bytes, what] :
			 {std::tuple("nook_volumes.h", assets::nook_volumes_h, "C++: reads the volumes"),
			  std::tuple("nook_volumes_draw.h", assets::nook_volumes_draw_h, "C++: what a frame needs of them")})
		{
			m_made.files.push_back({name, std::string(bytes), what});
		}
		m_made.use.push_back("nook_volumes::Camera::every = " + std::to_string(m_candidate.aov.every_px) +
							 (m_candidate.aov.every_px > 1 ? ", and the stage NOOK_SPARSE over the whole picture" : ""));
		m_made.use.emplace_back(
			"they are of static geometry: for what moves take a screen-space method as well, and the lesser visibility of the two");
	}

	void addVolumesOf(const TuneLevel& level)
	{
		const VolumeSet& set = level.bench->volumes(m_candidate.volumes);
		const std::string name = nameOf(level, ".volumes.glb");
		m_made.files.push_back({name, volumeGlb(set, {}, level.name, "nook " + m_settings.version, m_run).bytes,
								"volumes of " + level.name + ": " + std::to_string(set.occluders.polygons.size())});
		std::string command =
			"nook volumes " + shellWord(level.given) + loadOptions(m_settings.load) + " --distance " + numberText(set.distance_m);
		command += " --ray-distance " + numberText(level.radius_m);
		command += m_candidate.volumes == VolumeRecipe::built ? " --trim " + numberText(kBuiltTrim) + " --compensate" : "";
		m_made.commands.push_back(command + " -o " + name);
	}

	// The level again with visibility at its vertices: what an engine multiplies its ambient light by.
	void addBakes()
	{
		for (const TuneLevel& level : m_report.levels)
		{
			if (level.failed.empty())
			{
				addBakeOf(level);
			}
		}
		m_made.use.emplace_back(
			"multiply ambient light by the vertices' _VISIBILITY; where a material has two sides and gl_FrontFacing is false, by "
			"_VISIBILITY_BACK");
		m_made.use.emplace_back("a bake is of static geometry: for what moves take a screen-space method as well, which darkens by "
								"screen / screen without what moves");
	}

	void addBakeOf(const TuneLevel& level)
	{
		const BakedLevel& baked = level.bench->bake(m_candidate.bake_error);
		const std::string name = nameOf(level, ".baked.glb");
		GlbBake bake;
		bake.visibility = baked.values.front;
		bake.back = baked.values.back;
		m_made.files.push_back({name, levelGlb(baked.level, "nook " + m_settings.version, bake),
								level.name + " with visibility at its vertices: " + std::to_string(baked.level.positions.size()) +
									", " + bytesText(baked.bytes) + " more than the level"});
		std::string command = "nook bake " + shellWord(level.given) + loadOptions(m_settings.load) + " --radius " +
							  numberText(level.radius_m) + " --falloff linear";
		command += m_candidate.bake_error > 0.0 ? " --max-error " + numberText(m_candidate.bake_error) : "";
		m_made.commands.push_back(command + " -o " + name);
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
	std::function<bool(const Candidate&)> has;
};

const std::vector<Feature>& features()
{
	static const std::vector<Feature> all{
		{"a filter",
		 [](const Candidate& c)
		 {
			 return c.kind == CandidateKind::screen && c.shade.filter != ShadeFilter::none;
		 }},
		{"half resolution",
		 [](const Candidate& c)
		 {
			 return c.kind == CandidateKind::screen && c.shade.half_resolution;
		 }},
		{"thickness",
		 [](const Candidate& c)
		 {
			 return c.thickness_ratio > 0.0;
		 }},
		{"areas (moments of depth)",
		 [](const Candidate& c)
		 {
			 return c.kind == CandidateKind::screen && c.row()->moments;
		 }},
		{"summed-area tables (StatVO)",
		 [](const Candidate& c)
		 {
			 return c.kind == CandidateKind::screen && (c.row()->features & kOfLayers) != 0;
		 }},
		{"quadrants",
		 [](const Candidate& c)
		 {
			 return c.kind == CandidateKind::screen && c.shade.statvo.quadrants;
		 }},
		{"screen space, which what moves needs",
		 [](const Candidate& c)
		 {
			 return c.kind == CandidateKind::screen;
		 }},
		{"a bake",
		 [](const Candidate& c)
		 {
			 return c.kind == CandidateKind::bake;
		 }},
		{"occlusion volumes",
		 [](const Candidate& c)
		 {
			 return c.kind == CandidateKind::volumes && !c.aov.mask;
		 }},
		{"masks of directions",
		 [](const Candidate& c)
		 {
			 return c.kind == CandidateKind::volumes && c.aov.mask;
		 }},
	};
	return all;
}

// The best with a feature, by what was found of it or is expected: of those that reach the goal, else what is nearest to it.
std::optional<std::size_t> bestWith(const TuneReport& report, const Feature& feature)
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
		if (tried.failed.empty() && !tried.trial.views.empty() && feature.has(report.candidates[tried.candidate]) &&
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
	for (const Feature& feature : features())
	{
		if (feature.has(pick))
		{
			continue;
		}
		const std::optional<std::size_t> best = bestWith(report, feature);
		if (!best)
		{
			continue;
		}
		const Tried& tried = report.search.tried[*best];
		std::string why = "best with it is " + triedText(report, *best);
		why += isFrom(tried, report.rungs.once()) ? "" : " (expected from coarser measurements)";
		why += reaches(goal, tried.time_s, tried.error) ? "" : ", which does not reach the goal";
		left.push_back({feature.name, why});
	}
	if (pick.kind == CandidateKind::screen)
	{
		left.push_back(
			{"two radii, quadratic falloff, a cut, samples of MSAA, bands of fewer samples, coarser depths for far samples, "
			 "paired lines, samples without normals",
			 "not searched: `nook emit` has them"});
	}
	if (!drawsVolumes(settings.target))
	{
		left.push_back({"occlusion volumes, masks of directions", "not searched: they are drawn by `--glsl 330` or `430`"});
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
