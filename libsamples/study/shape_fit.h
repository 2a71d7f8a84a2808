// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of visibility beside the rays' → the strength and the power that bring them nearest, without drawing them again.
#pragma once

#include "methods/recipes.h"
#include "scene/gbuffer.h"

#include <cstddef>
#include <span>
#include <vector>

namespace nook
{

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

bool isShape(const RecipeValue& value);

// A recipe's shape: 1 where it states none.
CurveShape shapeOf(const MethodRecipe& recipe);
void setShape(MethodRecipe& recipe, const CurveShape& shape);

// Root mean square against the rays, of bins, over levels: each counts alike, and its views alike. The worst level weighs most.
double shapedError(std::span<const ShapeView> views, const CurveShape& shape);

// The least such error, by a pattern search (Hooke, Jeeves 1961) from 1, 1; both with three digits.
CurveShape fitShape(std::span<const ShapeView> views);

} // namespace nook
