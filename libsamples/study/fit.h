// SPDX-License-Identifier: GPL-3.0-or-later
// Levels, and a recipe of a method to begin with → the recipe whose pictures are nearest to rays, and its errors there and on
// levels that were kept out.
//
// Radius, lengths and other numbers of the recipe are searched with the method drawn again for each try, on the CPU, so that the
// same recipe comes out everywhere; strength and power follow from each picture without drawing it again. Choices and
// whole numbers stay. What is made least is the root mean square error over levels, each of which counts alike.
#pragma once

#include "methods/recipes.h"
#include "scene/gbuffer.h"
#include "scene/load.h"
#include "study/measure_view.h"

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace nook
{

struct FitSettings
{
	std::vector<MethodRecipe> starts; // one a method
	double radius_m = 0.0;            // reach of the rays; 0: suggestedRadius() each level
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

// Numbers above 0 and what is wrong with them → numbers with less of that.

struct FitNumber
{
	double start = 1.0;
	double least = 1e-3;
	double most = 1e3;
};

struct FitSearch
{
	double first_step = 1.4; // factor
	double last_step = 1.03;
	std::function<void()> step_done{}; // after each of stepsOf(); may be empty
};

std::size_t stepsOf(const FitSearch& search);

// Pattern search (R. Hooke, T. A. Jeeves, "Direct Search Solution of Numerical and Statistical Problems", 1961) over logarithms:
// one number after another up and down by a step, on along what helped, steps halved where nothing does. Numbers have three digits,
// so that what is written down is what was tried. `error` is asked once for equal numbers.
std::vector<double> fitNumbers(const std::vector<FitNumber>& numbers, const FitSearch& search,
							   const std::function<double(const std::vector<double>&)>& error);

// Pictures of visibility beside the rays' → the strength and the power that bring them nearest, without drawing them again.

// The figures of a picture that a shape is fitted to: pixels by their visibility.
struct ShapeView
{
	std::size_t level = 0;      // views of one level count as one level
	std::vector<double> pixels; // of each bin
	std::vector<double> sums;   // of the pixels' visibilities
	std::vector<double> rays;   // of the rays' visibilities there
	double squares = 0.0;       // of all rays' visibilities
};

// Pixels that show one: 1.
std::vector<char> surfacesOf(const GBuffer& gbuffer);

// Visibilities from 0 to 1; pixels that do not count have a 0 in `counted`.
ShapeView shapeView(std::size_t level, std::span<const float> visibility, std::span<const float> rays,
					std::span<const char> counted);

struct CurveShape
{
	double strength = 1.0; // 0.8 to 5
	double power = 1.0;    // 0.2 to 5
};

// A recipe's shape: 1 where it states none.
CurveShape shapeOf(const MethodRecipe& recipe);
void setShape(MethodRecipe& recipe, const CurveShape& shape);

// Root mean square against the rays, of bins, over levels: each counts alike, and its views alike. The worst level weighs most.
double shapedError(std::span<const ShapeView> views, const CurveShape& shape);

// The least such error, by a pattern search (Hooke, Jeeves 1961) from 1, 1; both with three digits.
CurveShape fitShape(std::span<const ShapeView> views);

} // namespace nook
