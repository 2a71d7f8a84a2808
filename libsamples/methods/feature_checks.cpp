// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/feature_checks.h"

#include "core/error.h"

#include <algorithm>
#include <string>

namespace nook
{
namespace
{

// The option with which the method has the view; empty: none.
std::string_view optionThatShows(DebugView view, const MethodRow& row)
{
	for (const FeatureRow& feature : featureTable())
	{
		ShadeSettings settings;
		settings.method = row.method;
		if (feature.kind == FeatureKind::whole && takesFeature(row, feature))
		{
			feature.value.set(settings, feature.most);
			if (debugShows(view, settings))
			{
				return feature.option;
			}
		}
	}
	return {};
}

// The methods that a view says something of: "--method vo-area, sao, or alchemy with --depth-levels".
std::string shownBy(DebugView view)
{
	const auto shows = [view](const MethodRow& row)
	{
		ShadeSettings settings;
		settings.method = row.method;
		return row.kind == MethodKind::screen && debugShows(view, settings);
	};
	switch (view)
	{
	case DebugView::edges: return "any method";
	case DebugView::samples:
	case DebugView::noise:
		return "a method with samples, any but " +
			   methodNames([&](const MethodRow& row) { return row.kind == MethodKind::screen && !shows(row); });
	case DebugView::lod:
	case DebugView::layers: break;
	}
	std::string text = "--method " + methodNames(shows);
	for (const MethodRow& row : methodTable())
	{
		const std::string_view option = row.kind == MethodKind::screen && !shows(row) ? optionThatShows(view, row) : "";
		text += option.empty() ? "" : ", or " + std::string(row.name) + " with " + std::string(option);
	}
	return text;
}

bool isAmong(const GivenFeatures& given, std::string_view name)
{
	return std::any_of(given.begin(), given.end(), [name](const FeatureRow* row) { return row->option == name; });
}

std::string namesOfTaking(const FeatureRow& row, bool emitted)
{
	return methodNames([&](const MethodRow& method) { return takesFeature(method, row) && (!emitted || method.emitted); }, " or ");
}

// Values that the table alone cannot tell: layers, taps, bands.
void checkValues(const GivenFeatures& given, const ShadeSettings& settings)
{
	refuseIf(isAmong(given, "--taps") && settings.filter != ShadeFilter::bilateral,
			 "--taps: found with another filter, expected --filter bilateral");
	refuseIf(settings.filter_taps % 2 == 0, "--taps: found '" + std::to_string(settings.filter_taps) + "', expected an odd number");
	refuseIf(settings.slices.bent && settings.filter == ShadeFilter::window,
			 "--bent: found with --filter window, expected bilateral or none");
	const StatVoSettings& statvo = settings.statvo;
	const bool halves = statvo.layers == 1 || statvo.layers == 2 || statvo.layers == 4;
	refuseIf(statvo.layering == StatVoLayering::adaptive && !halves,
			 "--layers: found '" + std::to_string(statvo.layers) + "', expected 1, 2 or 4, or --layering uniform");
	for (const FeatureRow& row : featureTable())
	{
		refuseIf(isAmong(given, row.option) && !row.base.empty() && !isOn(featureOf(row.base), settings),
				 std::string(row.option) + ": found without " + std::string(row.base) + ", expected both or none");
		refuseIf(!row.conflict.empty() && isOn(row, settings) && isOn(featureOf(row.conflict), settings),
				 std::string(row.option) + ": found with " + std::string(row.conflict) + ", expected one of them");
	}
}

} // namespace

void refuseSlicesWithTile(const GivenFeatures& given)
{
	refuseIf(isAmong(given, "--slices"), "--slices: found with a tile, whose own slices a pixel has, expected one of them");
}

void checkShadeFeatures(const GivenFeatures& given, const ShadeSettings& settings)
{
	for (const FeatureRow* const row : given)
	{
		refuseIf(!takesFeature(rowOf(settings.method), *row),
				 std::string(row->option) + ": found with another method, expected --method " + namesOfTaking(*row, false));
	}
	for (const FeatureRow& row : featureTable())
	{
		refuseIf(!row.needs.empty() && isAmong(given, row.option) != isAmong(given, row.needs),
				 std::string(row.option) + ", " + std::string(row.needs) + ": found one of them, expected both or none");
	}
	checkValues(given, settings);
	const BandSettings& bands = settings.bands;
	refuseIf((isAmong(given, "--band1-pixels") && bands.count < 2) || (isAmong(given, "--band2-pixels") && bands.count < 3),
			 "--bands: found " + std::to_string(bands.count) + ", expected more bands than limits given");
	refuseIf(bands.count == 3 && !(bands.first_px < bands.second_px),
			 "--band1-pixels: found no less than --band2-pixels, expected less");
}

void checkEmitFeatures(const GivenFeatures& given, const ShadeSettings& settings, const std::vector<ShadeMethod>& methods)
{
	for (const FeatureRow* const row : given)
	{
		refuseIf(
			std::none_of(methods.begin(), methods.end(), [row](ShadeMethod method) { return takesFeature(rowOf(method), *row); }),
			std::string(row->option) + ": found without a method that it changes, expected " + namesOfTaking(*row, true) +
				" among --methods");
	}
	checkValues(given, settings);
}

ShadeSettings withRecipe(const ShadeSettings& settings, const std::optional<MethodRecipe>& recipe, double reach_m,
						 const GivenFeatures& given)
{
	ShadeSettings result = settings;
	if (recipe)
	{
		applyRecipe(result, *recipe, reach_m);
		for (const FeatureRow* const row : given)
		{
			row->value.set(result, row->value.get(settings));
		}
	}
	return result;
}

std::string_view debugName(const ShadeSettings& settings)
{
	return settings.debug ? nameOf(*settings.debug) : "visibility";
}

void checkDebug(const ShadeSettings& settings)
{
	if (settings.debug && !debugShows(*settings.debug, settings))
	{
		throw Error(ExitCode::usage, "--debug: found " + std::string(debugName(settings)) + " with --method " +
										 std::string(nameOf(settings.method)) + ", of which it says nothing, expected " +
										 shownBy(*settings.debug));
	}
}

void checkDebug(const ShadeSettings& settings, const ShadeSamples& samples)
{
	refuseIf(settings.debug == DebugView::noise && samples.size == 1 && rowOf(settings.method).noise_variants == 0,
			 "--debug: found noise with a pattern, the same at every pixel, expected --pattern with a tile");
}

} // namespace nook
