// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/shape_fit.h"

#include "core/math.h"
#include "study/fit_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nook
{
namespace
{

// Less leaves closed niches bright, for 1 % of the error (a power makes up for it elsewhere).
constexpr double kLeastStrength = 0.8;

constexpr std::string_view kStrength = "--strength";
constexpr std::string_view kPower = "--power";
constexpr std::size_t kBins = 512; // of visibility: half a step of eight bits

double shapedAt(double visibility, const CurveShape& shape)
{
	const double open = 1.0 - shape.strength * (1.0 - visibility);
	return open > 0.0 ? powOf(open, shape.power) : 0.0;
}

} // namespace

std::vector<char> surfacesOf(const GBuffer& gbuffer)
{
	std::vector<char> surfaces;
	for (const float depth : gbuffer.depth)
	{
		surfaces.push_back(static_cast<char>(std::isfinite(depth) ? 1 : 0));
	}
	return surfaces;
}

bool isShape(const RecipeValue& value)
{
	return value.feature->option == kStrength || value.feature->option == kPower;
}

CurveShape shapeOf(const MethodRecipe& recipe)
{
	CurveShape shape;
	for (const RecipeValue& one : recipe.values)
	{
		shape.strength = one.feature->option == kStrength ? one.value : shape.strength;
		shape.power = one.feature->option == kPower ? one.value : shape.power;
	}
	return shape;
}

void setShape(MethodRecipe& recipe, const CurveShape& shape)
{
	for (const auto& [option, value] : {std::pair(kStrength, shape.strength), std::pair(kPower, shape.power)})
	{
		const FeatureRow* const feature = &featureOf(option);
		const auto found = std::find_if(recipe.values.begin(), recipe.values.end(),
										[=](const RecipeValue& one) { return one.feature == feature; });
		if (found == recipe.values.end())
		{
			recipe.values.push_back({feature, value});
			continue;
		}
		found->value = value;
	}
}

ShapeView shapeView(std::size_t level, std::span<const float> visibility, std::span<const float> rays,
					std::span<const char> counted)
{
	ShapeView view;
	view.level = level;
	view.pixels.resize(kBins);
	view.sums.resize(kBins);
	view.rays.resize(kBins);
	for (std::size_t i = 0; i < visibility.size(); ++i)
	{
		if (counted[i] != 0)
		{
			const auto value = static_cast<double>(visibility[i]);
			const auto truth = static_cast<double>(rays[i]);
			const std::size_t bin = std::min(kBins - 1, static_cast<std::size_t>(value * static_cast<double>(kBins)));
			view.pixels[bin] += 1.0;
			view.sums[bin] += value;
			view.rays[bin] += truth;
			view.squares += truth * truth;
		}
	}
	return view;
}

double shapedError(std::span<const ShapeView> views, const CurveShape& shape)
{
	std::vector<double> sums;
	std::vector<double> counts;
	for (const ShapeView& view : views)
	{
		double squares = view.squares;
		double pixels = 0.0;
		for (std::size_t i = 0; i < view.pixels.size(); ++i)
		{
			if (view.pixels[i] > 0.0)
			{
				const double value = shapedAt(view.sums[i] / view.pixels[i], shape);
				squares += value * (value * view.pixels[i] - 2.0 * view.rays[i]);
				pixels += view.pixels[i];
			}
		}
		sums.resize(std::max(sums.size(), view.level + 1));
		counts.resize(sums.size());
		sums[view.level] += pixels > 0.0 ? std::max(0.0, squares / pixels) : 0.0;
		counts[view.level] += 1.0;
	}
	double sum = 0.0;
	double levels = 0.0;
	for (std::size_t i = 0; i < sums.size(); ++i)
	{
		sum += counts[i] > 0.0 ? sums[i] / counts[i] : 0.0;
		levels += counts[i] > 0.0 ? 1.0 : 0.0;
	}
	return levels > 0.0 ? std::sqrt(sum / levels) : 0.0;
}

CurveShape fitShape(std::span<const ShapeView> views)
{
	const auto error = [views](const std::vector<double>& values)
	{
		return shapedError(views, {values[0], values[1]});
	};
	const std::vector<double> found = fitNumbers({{1.0, kLeastStrength, 5.0}, {1.0, 0.2, 5.0}}, {1.6, 1.005}, error);
	return {found[0], found[1]};
}

} // namespace nook
