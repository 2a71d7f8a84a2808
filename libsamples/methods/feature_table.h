// SPDX-License-Identifier: GPL-3.0-or-later
// The feature table: one row per option of the screen-space methods, with its values, default, unit, setter and constraints. It
// defines the options of `nook shade` and `nook emit`, their checks, the commands stored in outputs, words in candidates' names,
// and the docs' tables.
#pragma once

#include "methods/settings.h"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

struct MethodRow;

enum class FeatureKind
{
	flag,
	whole,
	number,
	choice,
};

// The verbs that have the option.
inline constexpr unsigned kInShade = 1U << 0U;
inline constexpr unsigned kInEmit = 1U << 1U;

// A number; 1 for a flag that is on; the index of a choice, -1 for none.
struct FeatureValue
{
	std::function<double(const ShadeSettings&)> get{};
	std::function<void(ShadeSettings&, double)> set{};
};

struct FeatureRow
{
	std::string_view option{}; // "--thickness"
	FeatureKind kind = FeatureKind::flag;
	unsigned places = kInShade | kInEmit;
	unsigned features = 0;     // allowed with methods that have one of these bits (method_table.h); 0: with any
	std::string_view method{}; // only with that method, which lists it among its options
	std::vector<std::string_view> choices{};
	double least = 0.0; // range of whole and number
	double most = 0.0;
	std::string_view unit{};
	FeatureValue value{};
	std::string_view help{};
	std::string_view range{};                            // describes the range instead of choices, or least and most
	std::string_view nothing{};                          // meaning of a default of 0: "no end"
	std::string_view needs{};                            // nook shade: valid only together with that option
	std::string_view base{};                             // valid only if that option is on
	std::string_view conflict{};                         // excludes that option
	std::string_view setting{};                          // members of nook_settings that a module with this feature reads
	bool stated = false;                                 // included in commands even at its default
	bool (*applies)(const ShadeSettings&) = nullptr;     // null: always
	std::string (*word)(const ShadeSettings&) = nullptr; // for the names of candidates; empty: none
};

// In the order of help texts and commands.
std::span<const FeatureRow> featureTable();
const FeatureRow& featureOf(std::string_view option); // must exist

bool takesFeature(const MethodRow& method, const FeatureRow& feature);

// Every method takes it.
inline bool isForAll(const FeatureRow& feature)
{
	return feature.features == 0 && feature.method.empty();
}

// The value of a parameter in ShadeSettings::own, or its default. Requires an option of the table.
double ownValue(const ShadeSettings& settings, std::string_view option);

// True if the value differs from the default.
bool isOn(const FeatureRow& feature, const ShadeSettings& settings);

// The value as typed on the command line: "half", "0.25"; empty for flags and for no choice.
std::string valueText(const FeatureRow& feature, const ShadeSettings& settings);

// Options of `nook emit` for the enabled features, each preceded by a blank: " --cut --filter window".
std::string emitOptions(const ShadeSettings& settings);

// Words for a candidate's name, each preceded by a blank: " thick half".
std::string featureWords(const ShadeSettings& settings);

} // namespace nook
