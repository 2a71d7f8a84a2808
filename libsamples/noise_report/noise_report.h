// SPDX-License-Identifier: GPL-3.0-or-later
// Settings → the noise of every domain, method and count, what the paper claims about them, and the page that shows it.
#pragma once

#include "core/progress.h"
#include "measure/quality.h"
#include "noise_report/symmetry.h"
#include "pattern/recipe.h"

#include <string>
#include <vector>

namespace nook
{

enum class Variant
{
	free,
	centred,
	symmetric,
};
template <> std::span<const std::string_view> namesOf<Variant>();

struct NoiseReportSettings
{
	int max_count = 64;   // counts 1 to this are made, 1 to kMaxReportCount
	int starts = 0;       // starting sets of every method that searches, 1 to 1000; 0: reportStarts of each
	int random_seeds = 3; // seeds over which `random` and `poisson` are averaged (rms), 1 to 100
	uint32_t seed = 1;
};

inline constexpr int kMaxReportCount = 128;

// Greatest number of starting sets on the paper’s grids, which cost a hundred times the exact cells; one in the ball.
inline constexpr int kPaperGridStarts = 2;

// The number of starting sets the report gives a recipe when `starts` is 0: the generator's default, cut where the whole
// report would take too long. 1 for methods that do not search.
int reportStarts(const Recipe& recipe);

// One pattern, made and measured. `random` and `poisson`: the measures are rms values over the seeds, the pattern is the first
// seed's.
struct NoiseRow
{
	Recipe recipe; // with the starts that were used
	Variant variant = Variant::free;
	Quality quality;
	Symmetry symmetry;
	Pattern pattern;
};

// How one measure falls with the count in one series (domain, method, variant): measure ≈ factor · count^−exponent.
struct NoiseFit
{
	Domain domain = Domain::disk;
	std::string measure;
	double factor = 0.0;
	double exponent = 0.0; // least squares in logarithms over the counts from 4 of `refine`, free
};

enum class Verdict
{
	confirmed,
	mixed,
	refuted,
	untested, // the report's greatest count is too small
};
template <> std::span<const std::string_view> namesOf<Verdict>();

// One figure that bears on a claim.
struct ClaimFigure
{
	std::string series;       // "electro, centred"
	std::string subject;      // "9"
	double noise = 0.0;       // of the subject
	double before = 0.0;      // noise of the neighbour below, or of what it is compared with
	double after = 0.0;       // noise of the neighbour above; 0: compared with one thing only
	double ratio = 0.0;       // noise over its local trend, or over what it is compared with; below 1 is better
	double plane_ratio = 0.0; // the same for plane
	double centre = 0.0;      // the subject's error over planes through the centre
	bool decides = true;      // the paper’s method; others stand beside it
	Verdict verdict = Verdict::untested;
};

struct ClaimPicture
{
	Domain domain = Domain::disk;
	Method method = Method::electro;
	Variant variant = Variant::free;
	int count = 0;
};

struct Claim
{
	std::string id;          // "ball-12"
	std::string statement;   // what the paper says
	std::string against;     // what the subject is compared with; empty: its neighbours
	std::string explanation; // what the figures and the patterns' symmetry say about why
	std::vector<ClaimFigure> figures;
	std::vector<ClaimPicture> pictures;
	Verdict verdict = Verdict::untested;
};

// A table of figures, ready to show.
struct StudyTable
{
	std::string title;
	std::vector<std::string> head;
	std::vector<std::vector<std::string>> rows;
	std::string note;
};

struct NoiseReport
{
	NoiseReportSettings settings;
	std::vector<NoiseRow> rows; // by domain, variant, method, count
	std::vector<NoiseRow>
		paper_rows; // `electro` with equal weights, on exact cells and on the paper's grids, around the counts it names
	std::vector<NoiseFit> fits;
	std::vector<Claim> claims;
	std::vector<StudyTable> studies; // why some counts are good
	std::vector<StudyTable> filters; // our tiles and turned patterns, behind filters and over frames
};

// Throws Error (usage) when a setting is out of range; the message names the option (--max-count, --starts, --seeds, --seed).
void checkNoiseReportSettings(const NoiseReportSettings& settings);

// "nook report noise", with what differs from the defaults, without output files.
std::string commandOf(const NoiseReportSettings& settings);

// Makes and measures everything; the same result on any number of threads. Minutes at the default settings.
NoiseReport measureNoise(const NoiseReportSettings& settings = {}, const RunSettings& run = {});

// One self-contained page (no network). `command` is shown as what made it.
std::string noiseReportHtml(const NoiseReport& report, const std::string& command, const std::string& version);

// Schema "nook.report.noise/1": every figure of the page, without the patterns' points.
std::string noiseReportJson(const NoiseReport& report, const std::string& command, const std::string& version);

} // namespace nook
