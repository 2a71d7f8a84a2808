// SPDX-License-Identifier: GPL-3.0-or-later
// Levels and a budget, or a bound of error → the method and settings to take, on the renderer at hand (tune_search.h); and how sure
// that is.
#pragma once

#include "emit/module.h"
#include "scene/load.h"
#include "study/candidates.h"
#include "study/measure_view.h"
#include "study/tune_search.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

template <> inline constexpr std::array<std::string_view, 3> kNamesOf<ErrorMeasure>{"rmse", "eq14", "flip"};
template <> inline constexpr std::array<std::string_view, 2> kNamesOf<OverLevels>{"mean", "worst"};

struct TuneSettings
{
	TuneGoal goal;
	ErrorMeasure measure = ErrorMeasure::rmse;
	GridSize grid = GridSize::normal;
	std::vector<std::string> methods; // of Candidate::method(); empty: all that can be emitted
	double radius_m = 0.0;            // reach of the reference's rays; 0: suggestedRadius() each level
	int width_px = 1280;
	int height_px = 720;
	int views = 4; // of each level, 1 or more: the most informative ones
	int reference_rays = 256;
	int repetitions = 7;    // drawings of what gets to the end
	uint64_t max_bytes = 0; // a candidate that needs more of a level is left out; 0: none is
	std::optional<int> gl_device;
	std::string version; // of nook, that they are known by
};

// The facts of one level, or why it failed.
struct TuneLevel
{
	std::string given; // as on the command line
	std::string name;
	std::vector<std::string> files; // that it was read from
	std::string failed;             // why it is not in the figures; else empty
	double radius_m = 0.0;
	std::size_t triangles = 0;
	std::vector<std::string> views;
	std::vector<double> reference_errors; // of each view, root mean square of the standard error
	std::shared_ptr<LevelBench> bench;
};

struct TuneReport
{
	TuneSettings settings;
	std::string renderer;
	std::vector<TuneLevel> levels;
	std::vector<Candidate> candidates;
	TuneSearchSettings rungs;
	TuneSearch search;
	std::size_t measured = 0; // drawings of a candidate on a view
	std::size_t cached = 0;   // that were not made, but known
	double prepared_s = 0.0;  // levels, references at full size, samples, volumes, shaders: what a grid needs as well
	double busy = 0.0;        // share of the processors that other programs took meanwhile
	double coarse_s = 0.0;    // G-buffers and references of coarse pictures: what the search alone needs
	std::optional<CandidateComparison> runner_up; // to the pick
	std::optional<MethodRecipe> shape_before;     // of what was taken, where its strength and power were fitted to these levels
};

// The rungs of a search with that many views in all.
TuneSearchSettings rungsFor(std::size_t views, int repetitions);

// Levels that cannot be read or looked at are left out and say why. Throws Error: as the only level's where there is just one;
// runtime where none of several is left; unsupported without OpenGL.
TuneReport tuneLevels(const std::vector<std::string>& levels, const LoadSettings& load, const TuneSettings& settings,
					  const RunSettings& run);

// "--budget 1ms", "--max-error 0.05".
std::string goalText(const TuneSettings& settings);

// Returns the time and error that were found of a candidate, or are expected: "vo-line 9 tile bilateral-5: 0.84 ms, rmse 0.051",
// and where the level needs an asset for it "bake: 0 ms, rmse 0.04, 0.81 MB a level".
std::string triedText(const TuneReport& report, std::size_t candidate);

// 1234567: "1.23 MB", 1234: "1.23 kB".
std::string bytesText(uint64_t bytes);

// One sentence on how sure the pick is.
std::string confidenceText(const TuneReport& report);

// The pick of a search → the files that an engine needs, the commands that make them again, and the features left out.

struct TuneEmitSettings
{
	GlslTarget target = GlslTarget::gl330; // volumes: gl330 or gl430
	bool device_depth = false;             // depth as a depth buffer holds it
	std::string version;                   // of nook
	LoadSettings load;                     // as the levels were read
};

struct LeftOut
{
	std::string feature;
	std::string why;
};

struct TuneEmission
{
	std::vector<EmittedFile> files;
	std::vector<std::string> commands; // make the files again, in order; those of the search not among them
	std::vector<std::string> use;      // what the engine has to set or to do, a line each
	std::vector<LeftOut> left_out;
};

// Requires something to take (TuneSearch::taken()). Throws Error (unsupported) for volumes in another language than OpenGL's GLSL.
TuneEmission emitPick(const TuneReport& report, const TuneEmitSettings& settings, const RunSettings& run);

// The result of a search → lines for a terminal, one self-contained page, and JSON.

// `emission`: null where nothing was written.
struct TuneText
{
	std::string command; // "nook tune …", as it was given
	std::string version;
	const TuneEmission* emission = nullptr;
};

std::string tuneLines(const TuneReport& report, const TuneText& text);

std::string tuneHtml(const TuneReport& report, const TuneText& text);

// Schema "nook.tune/1".
std::string tuneJson(const TuneReport& report, const TuneText& text);

} // namespace nook
