// SPDX-License-Identifier: GPL-3.0-or-later
#include "feature_options.h"

#include "methods/aov_text.h"

namespace nook
{

OptionRow featureOption(const FeatureRow& row, ShadeSettings& settings, const std::string& more, OptionRules rules)
{
	const auto add = [&row, &settings](CLI::App& app, const std::string& name, const std::string& help) -> CLI::Option*
	{
		const auto set = [&row, &settings](auto value)
		{
			row.value.set(settings, static_cast<double>(value));
		};
		switch (row.kind)
		{
		case FeatureKind::flag:
			return app.add_flag_function(
				name, [set](std::int64_t count) { set(count > 0 ? 1 : 0); }, help);
		case FeatureKind::whole:
			return takesWholeBy(set, static_cast<uint64_t>(row.least), static_cast<uint64_t>(row.most))(app, name, help);
		case FeatureKind::number: return takesNumberBy(set, row.least, row.most)(app, name, help);
		case FeatureKind::choice: break;
		}
		return takesIndex(row.choices, set)(app, name, help);
	};
	return {std::string(row.option), add, std::string(row.help) + more, std::move(rules)};
}

std::vector<OptionRow> featureOptions(unsigned place, const std::function<bool(const FeatureRow&)>& fits, ShadeSettings& settings,
									  const OptionRules& rules)
{
	std::vector<OptionRow> options;
	for (const FeatureRow& row : featureTable())
	{
		if ((row.places & place) != 0 && fits(row))
		{
			const bool shade = place == kInShade;
			std::string more;
			more += shade && !row.needs.empty() ? "; needs " + std::string(row.needs) : "";
			more += !shade && !row.setting.empty() ? "; nook_settings." + std::string(row.setting) : "";
			options.push_back(featureOption(row, settings, more, rules));
		}
	}
	return options;
}

GivenFeatures givenFeatures(const CLI::App& app, unsigned place)
{
	GivenFeatures given;
	for (const FeatureRow& row : featureTable())
	{
		const CLI::Option* const option = app.get_option_no_throw(std::string(row.option));
		if ((row.places & place) != 0 && option != nullptr && option->count() > 0)
		{
			given.push_back(&row);
		}
	}
	return given;
}

std::string featuresText(const CLI::App& app, const GivenFeatures& features)
{
	std::string text;
	for (const FeatureRow* const row : features)
	{
		const std::string option(row->option);
		text += " " + option + (row->kind == FeatureKind::flag ? "" : " " + app.get_option(option)->results().front());
	}
	return text;
}

OptionRow recipeRow(std::string& name, OptionRules rules)
{
	return {
		"--recipe", takesText(name, "paper|rays|FILE.json"),
		"rays (default): --radius is the reach of rays with linear falloff, and radii, thickness, strength and power are fitted to "
		"them; paper: the method as published, --radius its own; or a file of nook fit. Options that are given count more",
		std::move(rules)};
}

std::string volumeMethods(const std::string& between)
{
	return methodNames([](const MethodRow& row) { return row.kind == MethodKind::volumes; }, between);
}

std::string sumMethod()
{
	return std::string(volumeRow(false).name);
}

std::string maskMethod()
{
	return std::string(volumeRow(true).name);
}

OptionRow directionsRow(int& directions, OptionRules rules)
{
	const auto take = [&directions](uint64_t number)
	{
		if (number % 32 != 0)
		{
			refuseValue("--directions", std::to_string(number), "a multiple of 32");
		}
		directions = static_cast<int>(number);
	};
	return {"--directions", takesWholeBy(take, kLeastDirections, kMostDirections),
			maskMethod() + ": directions of a pixel's mask, a multiple of 32 (default 128)", std::move(rules)};
}

} // namespace nook
