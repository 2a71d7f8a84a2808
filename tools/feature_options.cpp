// SPDX-License-Identifier: GPL-3.0-or-later
#include "feature_options.h"

#include "options.h"

#include "core/error.h"

#include <algorithm>

namespace nook
{
namespace
{

bool given(const std::vector<FeatureOption>& options, std::string_view name)
{
	return std::any_of(options.begin(), options.end(),
					   [name](const FeatureOption& one) { return one.row->option == name && one.option->count() > 0; });
}

std::string namesOfTaking(const FeatureRow& row, bool emitted)
{
	return methodNames([&](const MethodRow& method) { return takesFeature(method, row) && (!emitted || method.emitted); }, " or ");
}

void refuseTogether(std::string_view option, std::string_view other)
{
	throw Error(ExitCode::usage, std::string(option) + ": found with " + std::string(other) + ", expected one of them");
}

} // namespace

FeatureOption addFeature(CLI::App& app, const FeatureRow& row, ShadeSettings& settings, const std::string& more)
{
	const std::string name(row.option);
	const std::string help = std::string(row.help) + more;
	const auto set = [&row, &settings](auto value)
	{
		row.value.set(settings, static_cast<double>(value));
	};
	CLI::Option* option = nullptr;
	switch (row.kind)
	{
	case FeatureKind::flag:
		option = app.add_flag_function(
			name, [set](std::int64_t count) { set(count > 0 ? 1 : 0); }, help);
		break;
	case FeatureKind::whole:
		option = addWhole(app, name, set, static_cast<int>(row.least), static_cast<int>(row.most), help);
		break;
	case FeatureKind::number: option = addNumber(app, name, set, row.least, row.most, help); break;
	case FeatureKind::choice: option = addChoiceText(app, name, row.choices, set, help); break;
	}
	return {&row, option};
}

std::vector<FeatureOption> addFeatures(CLI::App& app, unsigned place, const std::function<bool(const FeatureRow&)>& fits,
									   ShadeSettings& settings)
{
	std::vector<FeatureOption> options;
	for (const FeatureRow& row : featureTable())
	{
		if ((row.places & place) != 0 && fits(row))
		{
			const bool shade = place == kInShade;
			std::string more;
			more += shade && !row.needs.empty() ? "; needs " + std::string(row.needs) : "";
			more += !shade && !row.setting.empty() ? "; nook_settings." + std::string(row.setting) : "";
			options.push_back(addFeature(app, row, settings, more));
		}
	}
	return options;
}

void refuseSlicesBesideTile(const std::vector<FeatureOption>& options)
{
	if (given(options, "--slices"))
	{
		throw Error(ExitCode::usage, "--slices: found with a tile, whose own slices a pixel has, expected one of them");
	}
}

void checkValues(const std::vector<FeatureOption>& options, const ShadeSettings& settings)
{
	if (given(options, "--taps") && settings.filter != ShadeFilter::bilateral)
	{
		throw Error(ExitCode::usage, "--taps: found with another filter, expected --filter bilateral");
	}
	if (settings.filter_taps % 2 == 0)
	{
		refuseValue("--taps", std::to_string(settings.filter_taps), "an odd number");
	}
	if (settings.slices.bent && settings.filter == ShadeFilter::window)
	{
		throw Error(ExitCode::usage, "--bent: found with --filter window, expected bilateral or none");
	}
	const StatVoSettings& statvo = settings.statvo;
	const bool halves = statvo.layers == 1 || statvo.layers == 2 || statvo.layers == 4;
	if (statvo.layering == StatVoLayering::adaptive && !halves)
	{
		refuseValue("--layers", std::to_string(statvo.layers), "1, 2 or 4, or --layering uniform");
	}
	for (const FeatureOption& one : options)
	{
		if (one.option->count() > 0 && !one.row->base.empty() && !isOn(featureOf(one.row->base), settings))
		{
			throw Error(ExitCode::usage,
						std::string(one.row->option) + ": found without " + std::string(one.row->base) + ", expected both or none");
		}
		if (!one.row->conflict.empty() && isOn(*one.row, settings) && isOn(featureOf(one.row->conflict), settings))
		{
			refuseTogether(one.row->option, one.row->conflict);
		}
	}
}

void checkShadeFeatures(const std::vector<FeatureOption>& options, const ShadeSettings& settings)
{
	for (const FeatureOption& one : options)
	{
		if (one.option->count() > 0 && !takesFeature(rowOf(settings.method), *one.row))
		{
			throw Error(ExitCode::usage, one.option->get_name() + ": found with another method, expected --method " +
											 namesOfTaking(*one.row, false));
		}
	}
	for (const FeatureOption& one : options)
	{
		if (!one.row->needs.empty() && (one.option->count() > 0) != given(options, one.row->needs))
		{
			throw Error(ExitCode::usage, std::string(one.row->option) + ", " + std::string(one.row->needs) +
											 ": found one of them, expected both or none");
		}
	}
	checkValues(options, settings);
	const BandSettings& bands = settings.bands;
	if ((given(options, "--band1-pixels") && bands.count < 2) || (given(options, "--band2-pixels") && bands.count < 3))
	{
		throw Error(ExitCode::usage, "--bands: found " + std::to_string(bands.count) + ", expected more bands than limits given");
	}
	if (bands.count == 3 && !(bands.first_px < bands.second_px))
	{
		throw Error(ExitCode::usage, "--band1-pixels: found no less than --band2-pixels, expected less");
	}
}

void checkEmitFeatures(const std::vector<FeatureOption>& options, const ShadeSettings& settings,
					   const std::vector<ShadeMethod>& methods)
{
	for (const FeatureOption& one : options)
	{
		const auto takes = [&one](ShadeMethod method)
		{
			return takesFeature(rowOf(method), *one.row);
		};
		if (one.option->count() > 0 && std::none_of(methods.begin(), methods.end(), takes))
		{
			throw Error(ExitCode::usage, one.option->get_name() + ": found without a method that it changes, expected " +
											 namesOfTaking(*one.row, true) + " among --methods");
		}
	}
	checkValues(options, settings);
}

std::string featuresText(const std::vector<FeatureOption>& options)
{
	std::string text;
	for (const FeatureOption& one : options)
	{
		if (one.option->count() > 0)
		{
			text += " " + std::string(one.row->option);
			text += one.row->kind == FeatureKind::flag ? "" : " " + one.option->results().front();
		}
	}
	return text;
}

} // namespace nook
