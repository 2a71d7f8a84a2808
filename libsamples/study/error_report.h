// SPDX-License-Identifier: GPL-3.0-or-later
// Levels → what every method costs and how wrong it is on their views, as JSON and as one page: `nook report error`.
#pragma once

#include "core/progress.h"
#include "pattern/recipe.h"
#include "scene/load.h"
#include "study/measure_view.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace nook
{

// Volumes that would take longer a picture are not drawn, if nothing else is asked for; and in a first look.
inline constexpr double kSlowestPicture_s = 60.0;
inline constexpr double kSlowestQuickPicture_s = 4.0;

struct ErrorReportSettings
{
	std::vector<std::string> levels; // files, or "builtin:NAME"; at least one
	LoadSettings load;
	std::string camera;    // of each level by name; empty: its first, or one chosen
	int automatic = 0;     // > 0: that many chosen views of each level
	int width_px = 320;    // of each picture
	int height_px = 180;   //
	int rays = 1024;       // of the reference, a pixel
	double radius_m = 0.0; // reach of its rays; 0: suggestedRadius() each level
	GridSize grid = GridSize::normal;
	std::vector<std::string> methods; // of the grid, as Candidate::method() names them; empty: all
	std::vector<Candidate> only;      // measured in place of the grid; empty: the grid
	MeasureSettings measure;
	int pictures = 8;    // of each view, beside the reference; 0 to 64
	int shifts = 4;      // parts of a pixel by which a view is moved, for stability; 0: not measured
	std::string version; // of nook
};

// Whose numbers these are; no host, path or time.
struct ErrorContext
{
	std::string renderer;
	bool software = false; // draws on a CPU: its times say nothing of a GPU's
	int threads = 1;       // of rays and of methods on the CPU
	std::string version;
};

// A candidate on a view.
struct ErrorPoint
{
	std::string name;
	std::string method;
	Origin origin = Origin::ours;
	int count = 0; // samples, layers, directions or rays
	std::string resolution;
	Measurement measured;
	std::optional<double> flicker; // standard deviation of a pixel's visibility when the view moves by parts of a pixel
	bool front = false;            // nothing else has less time and less eq14; rays are not asked
	std::vector<uint8_t> picture;  // visibility × 255, rows from the top; empty: not shown
	bool front_bytes = false;      // nothing else that needs bytes of the level needs fewer and has less eq14
};

// Volumes whose picture would have taken longer than it is worth.
struct StoppedPoint
{
	std::string name;
	std::string method;
	double expected_s = 0.0; // a picture
};

// Budgets at which the best of nook's forms errs no more than the best of the papers' recipes (eq14).
struct FrontShare
{
	double held = 0.0;               // share of the logarithm of time, from the fastest candidate to the slowest of the front
	std::vector<std::string> papers; // recipes of papers on the common front
	std::optional<double>
		worst_ratio;         // ours / theirs, at the budget where they lead most; none: nowhere, or nothing of ours is so fast
	std::string worst_paper; // which leads there
};

// About what one layer of depth can know of a view: slices at their most (16 of 32 steps on either side, no filter), with the
// thickness, the strength and the power that suit this very view.
struct ScreenLimit
{
	double thickness = 0.0; // in radii
	double strength = 1.0;
	double power = 1.0;
	ViewErrors errors;
};
void visit(Archive& archive, ScreenLimit& limit);

struct ErrorView
{
	std::string camera;
	int width_px = 0;
	int height_px = 0;
	double surface_share = 1.0;
	double reference_error = 0.0; // rms of the standard error
	double mean_visibility = 1.0; // of the reference, over surfaces
	std::vector<ErrorPoint> points;
	std::vector<StoppedPoint> stopped;
	FrontShare share;
	std::optional<ScreenLimit> limit; // none in reports of before
	std::vector<uint8_t> picture;     // the reference
};

struct ErrorLevel
{
	std::string name;
	std::string failure; // empty, or the line that says what is missing and why
	std::size_t triangles = 0;
	double radius_m = 0.0;
	std::vector<ErrorView> views;
};

struct ErrorReport
{
	ErrorContext context;
	std::string command; // without outputs
	int rays = 0;
	int repetitions = 0;
	std::vector<ErrorLevel> levels;
};

// Counts and files that the verb states afterwards.
struct ErrorReportCounts
{
	std::size_t measured = 0;
	std::size_t cached = 0;
	std::vector<std::string> files; // that the levels were read from, each once; of a level that cannot be read, its own
};

// "nook report error LEVEL… --grid quick …", without outputs; levels by their names without folders.
std::string errorReportCommand(const ErrorReportSettings& settings);

// A level that fails becomes a line of the report. Throws Error: unsupported where there is no renderer; file where the cache
// cannot be written.
ErrorReport measureErrors(const ErrorReportSettings& settings, const RunSettings& run, ErrorReportCounts* counts = nullptr);

// Sets `front` of every point and the share.
void setFront(ErrorView& view);

// Which candidates share what takes long to make, and about how long each takes: how a report is shared out.

// Candidates of one name draw the same samples, on whatever level, or the same volumes or bake of this level. `level`: any name
// that is its own.
std::string sharedBy(const Candidate& candidate, const std::string& level);

// The facts of a view that its costs depend on.
struct ViewCost
{
	std::string level; // a name that is its own
	std::size_t pixels = 0;
	std::size_t triangles = 0; // of its level
	int repetitions = 0;
};

// Estimates of the seconds that each candidate takes on one thread. The first candidate of each name bears what is made once.
// `made`: the names of views before; grows.
std::vector<double> candidateSeconds(std::span<const Candidate> candidates, const ViewCost& view, std::set<std::string>& made);

// Returns at most `count` points: the front's, evenly spaced, and the best recipe of each method.
std::set<std::size_t> chosenPoints(const ErrorView& view, std::size_t count);

// Returns all that chosenPoints() chooses from: the front, and the best recipe of each method. With some of a view's points and
// their own front, the result contains whatever of them is chosen from all points.
std::set<std::size_t> likelyPoints(const ErrorView& view);

// Schema "nook.error-report/1": everything that the page shows.
nlohmann::ordered_json errorReportFields(const ErrorReport& report);
std::string errorReportJson(const ErrorReport& report);

// Throws Error (invalid_input), naming the element, for anything that errorReportJson() does not write.
ErrorReport errorReportFrom(const std::string& text, const std::string& path);

// One page that works without network; several reports of other renderers side by side. Requires at least one.
std::string errorReportHtml(std::span<const ErrorReport> reports, const std::string& version);

// Where errors have grown since.
struct Regression
{
	std::string level;
	std::string camera;
	std::string candidate;
	std::string metric; // "eq14", "rmse"
	double before = 0.0;
	double now = 0.0;
};

struct BaselineResult
{
	std::size_t compared = 0;
	std::vector<Regression> regressions; // the worst share first
	std::vector<std::string> missing;    // "level, camera, candidate" of the baseline that the report has not
};

// Times are not compared. Throws Error (invalid_input) where sizes, rays or radii of a view differ: errors of other pictures.
BaselineResult compareWithBaseline(const ErrorReport& report, const ErrorReport& baseline);

} // namespace nook
