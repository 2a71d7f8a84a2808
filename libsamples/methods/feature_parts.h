// SPDX-License-Identifier: GPL-3.0-or-later
// What rows of the table of features are made of, and the groups of them that stand in files of their own.
#pragma once

#include "methods/feature_table.h"
#include "methods/method_table.h"

#include <cstddef>
#include <type_traits>
#include <utility>

namespace nook::feature_parts
{

using S = ShadeSettings;

// A member of the settings, through the members that hold it.
template <auto... path> FeatureValue member()
{
	const auto get = [](const S& settings)
	{
		return static_cast<double>((settings.*....*path));
	};
	const auto set = [](S& settings, double value)
	{
		auto& held = (settings.*....*path);
		held = static_cast<std::remove_reference_t<decltype(held)>>(value);
	};
	return {get, set};
}

// The same for choices of yes, then no.
template <auto... path> FeatureValue yesNo()
{
	const auto get = [](const S& settings)
	{
		return (settings.*....*path) ? 0.0 : 1.0;
	};
	const auto set = [](S& settings, double value)
	{
		(settings.*....*path) = value == 0.0;
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

// The word of a candidate's name where a member is not 0.
template <Word word, auto... path> std::string wordIf(const S& settings)
{
	return static_cast<double>((settings.*....*path)) != 0.0 ? word.letters : "";
}

inline const std::vector<std::string_view> kYesNo{"yes", "no"};

// Adds the row of a number that `nook shade` takes.
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

// Of a whole number.
inline FeatureRow& addWhole(std::vector<FeatureRow>& rows, unsigned features, std::string_view option, int least, int most,
							FeatureValue value, std::string_view help)
{
	FeatureRow& row = addNumber(rows, features, option, least, most, "", value, help);
	row.kind = FeatureKind::whole;
	return row;
}

// Of a word among some.
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

inline FeatureRow& addFlag(std::vector<FeatureRow>& rows, unsigned features, std::string_view option, FeatureValue value,
						   std::string_view help)
{
	rows.push_back({.option = option, .features = features, .value = value, .help = help});
	return rows.back();
}

void addVolumeRows(std::vector<FeatureRow>& rows);
void addTableRows(std::vector<FeatureRow>& rows);
void addRivalRows(std::vector<FeatureRow>& rows);

} // namespace nook::feature_parts
