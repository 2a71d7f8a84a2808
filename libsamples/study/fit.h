// SPDX-License-Identifier: GPL-3.0-or-later
// Levels, and a recipe of a method to begin with → the recipe whose pictures are nearest to rays, and its errors there and on
// levels that were kept out.
//
// Radius, lengths and other numbers of the recipe are searched with the method drawn again for each try, on the CPU, so that the
// same recipe comes out everywhere; strength and power follow from each picture without drawing it again (shape_fit.h). Choices and
// whole numbers stay. What is made least is the root mean square error over levels, each of which counts alike.
#pragma once

#include "scene/load.h"
#include "study/measure_view.h"

#include <string>
#include <vector>

namespace nook
{

struct FitSettings
{
	std::vector<MethodRecipe> starts; // one a method
	double radius_m = 0.0;            // reach of the rays; 0: radiusFor() each level
	int views = 2;                    // of each level, the most informative ones
	int width_px = 480;
	int height_px = 270;
	int reference_rays = 256;
};

// Errors of a method on a level: means over its views.
struct FitError
{
	double paper = 0.0; // as published
	double rays = 0.0;  // by the recipe
};

struct MethodFit
{
	Candidate candidate;          // with the recipe
	int tried = 0;                // pictures of each view
	std::vector<FitError> errors; // of each level
};

struct FitLevel
{
	std::string given;
	bool held_out = false;
	std::string name;
	std::vector<std::string> files; // that it was read from
	double radius_m = 0.0;
	std::vector<std::string> views;
};

struct FitReport
{
	FitSettings settings;
	std::vector<FitLevel> levels; // to fit, then those kept out
	std::vector<MethodFit> fits;
};

// The candidate that stands for a method while it is fitted: few samples of nook's own with a variant a pixel, five taps.
Candidate fittedCandidate(const MethodRow& row);

// Throws Error as loadLevel, LevelBench and chooseCameras do; naming the level, invalid input, for one whose views show nothing.
FitReport fitRecipes(const std::vector<std::string>& levels, const std::vector<std::string>& held_out, const LoadSettings& load,
					 const FitSettings& settings, const RunSettings& run);

// A file of kRecipesFormat, which nook shade and nook emit take. `command` made it.
std::string fitJson(const FitReport& report, const std::string& command, const std::string& version);

} // namespace nook
