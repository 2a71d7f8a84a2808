// SPDX-License-Identifier: GPL-3.0-or-later
// Settings → the noise of every domain, method and count, and the page that shows it.
#pragma once

#include "core/progress.h"
#include "pattern/quality.h"
#include "pattern/recipe.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

struct NoiseReportSettings
{
	int max_count = 64;   // counts 1 to this are made, 1 to kMaxReportCount
	int starts = 0;       // starting sets of every method that searches, 1 to 1000; 0: by recipe
	int random_seeds = 3; // seeds over which `random` and `poisson` are averaged (rms), 1 to 100
	uint32_t seed = 1;
};

inline constexpr int kMaxReportCount = 128;

// One pattern with its measures. `random` and `poisson` have rms measures over the seeds and the pattern of the first seed.
struct NoiseRow
{
	Recipe recipe; // with the starts that were used
	Variant variant = Variant::free;
	Quality quality;
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

struct NoiseReport
{
	NoiseReportSettings settings;
	std::vector<NoiseRow> rows; // by domain, variant, method, count
	std::vector<NoiseFit> fits;
};

struct PowerFit // value ≈ factor · count^−exponent
{
	double factor = 0.0;
	double exponent = 0.0;
};

// Least squares in logarithms over the counts from `first_count` up. Values up to 2e-5 are zero but for rounding and the grid (the
// centre error of symmetric patterns, the sphere's bias) and are left out. Absent with fewer than 4 values.
std::optional<PowerFit> fitPower(const std::map<int, double>& values, int first_count = 4);

// Returns "nook report noise" with the settings that differ from the defaults, without output files.
std::string noiseReportCommand(const NoiseReportSettings& settings);

// Makes and measures everything; the same result on any number of threads. Minutes at the default settings.
NoiseReport measureNoise(const NoiseReportSettings& settings = {}, const RunSettings& run = {});

// One self-contained page (no network). `command` is shown as what made it.
std::string noiseReportHtml(const NoiseReport& report, const std::string& command, const std::string& version);

// Schema "nook.report.noise/1": every figure of the page, without the patterns' points.
std::string noiseReportJson(const NoiseReport& report, const std::string& command, const std::string& version);

} // namespace nook
