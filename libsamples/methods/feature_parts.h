// SPDX-License-Identifier: GPL-3.0-or-later
// Builders of rows for the table of features.
#pragma once

#include "methods/feature_table.h"

#include <cstddef>
#include <type_traits>
#include <utility>

namespace nook::feature_parts
{

using S = ShadeSettings;

// Accesses a member of the settings by its path.
template <auto... path> FeatureValue member()
{
	const auto set = [](S& settings, double value)
	{
		auto& held = (settings.*....*path);
		held = static_cast<std::remove_reference_t<decltype(held)>>(value);
	};
	return {[](const S& settings) { return static_cast<double>((settings.*....*path)); }, set};
}

// Likewise for choices of yes, then no.
template <auto... path> FeatureValue yesNo()
{
	const auto set = [](S& settings, double value)
	{
		(settings.*....*path) = value == 0.0;
	};
	return {[](const S& settings) { return (settings.*....*path) ? 0.0 : 1.0; }, set};
}

// A parameter in ShadeSettings::own, for options that a single method has.
inline FeatureValue ownMember(std::string_view option, double normal)
{
	const auto get = [option, normal](const S& settings)
	{
		const auto found = settings.own.find(option);
		return found != settings.own.end() ? found->second : normal;
	};
	const auto set = [option](S& settings, double value)
	{
		settings.own[option] = value;
	};
	return {get, set};
}

template <std::size_t size> struct Word
{
	char letters[size]{}; // NOLINT: of a constant

	consteval Word(const char (&text)[size]) // NOLINT: from a literal, unsaid
	{
		for (std::size_t i = 0; i < size; ++i)
		{
			letters[i] = text[i];
		}
	}
};

// Adds `word` to a candidate's name if a member is not 0.
template <Word word, auto... path> std::string wordIf(const S& settings)
{
	return static_cast<double>((settings.*....*path)) != 0.0 ? word.letters : "";
}

inline const std::vector<std::string_view> kYesNo{"yes", "no"};

// Adds a number option of `nook shade`.
inline FeatureRow& addNumber(std::vector<FeatureRow>& rows, unsigned features, std::string_view option, double least, double most,
							 std::string_view unit, FeatureValue value, std::string_view help)
{
	rows.push_back({.option = option,
					.kind = FeatureKind::number,
					.places = kInShade,
					.features = features,
					.least = least,
					.most = most,
					.unit = unit,
					.value = value,
					.help = help});
	return rows.back();
}

// Adds an integer option.
inline FeatureRow& addWhole(std::vector<FeatureRow>& rows, unsigned features, std::string_view option, int least, int most,
							FeatureValue value, std::string_view help)
{
	FeatureRow& row = addNumber(rows, features, option, least, most, "", value, help);
	row.kind = FeatureKind::whole;
	return row;
}

// Adds an option with a choice of words.
inline FeatureRow& addChoice(std::vector<FeatureRow>& rows, unsigned features, std::string_view option,
							 std::vector<std::string_view> choices, FeatureValue value, std::string_view help)
{
	rows.push_back({.option = option,
					.kind = FeatureKind::choice,
					.features = features,
					.choices = std::move(choices),
					.value = value,
					.help = help});
	return rows.back();
}

// For options of a single method, whose values are in ShadeSettings::own.
inline FeatureRow& addOwnNumber(std::vector<FeatureRow>& rows, std::string_view option, double least, double most,
								std::string_view unit, double normal, std::string_view help)
{
	return addNumber(rows, 0, option, least, most, unit, ownMember(option, normal), help);
}
inline FeatureRow& addOwnWhole(std::vector<FeatureRow>& rows, std::string_view option, int least, int most, int normal,
							   std::string_view help)
{
	return addWhole(rows, 0, option, least, most, ownMember(option, normal), help);
}

inline FeatureRow& addFlag(std::vector<FeatureRow>& rows, unsigned features, std::string_view option, FeatureValue value,
						   std::string_view help)
{
	rows.push_back({.option = option, .features = features, .value = value, .help = help});
	return rows.back();
}

} // namespace nook::feature_parts
