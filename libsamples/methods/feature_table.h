// SPDX-License-Identifier: GPL-3.0-or-later
// The table of features: a row an option of the screen-space methods, with its values, default, unit and setter, and what it goes
// with. Options of `nook shade` and `nook emit`, their checks, the commands that outputs carry, words in candidates' names and the
// tables of the docs read it.
#pragma once

#include "methods/settings.h"

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

// Where an option is.
inline constexpr unsigned kInShade = 1U << 0U;
inline constexpr unsigned kInEmit = 1U << 1U;

// A number; 1 of a flag that is on; the index of a choice, -1 for none of them.
struct FeatureValue
{
	double (*get)(const ShadeSettings&) = nullptr;
	void (*set)(ShadeSettings&, double) = nullptr;
};

struct FeatureRow
{
	std::string_view option{}; // "--thickness"
	FeatureKind kind = FeatureKind::flag;
	unsigned places = kInShade | kInEmit;
	unsigned features = 0; // it goes with methods that have one of these bits (method_table.h); 0: with any
	std::vector<std::string_view> choices{};
	double least = 0.0; // of whole and number
	double most = 0.0;
	std::string_view unit{};
	FeatureValue value{};
	std::string_view help{};
	std::string_view range{};                            // in place of choices, or least and most
	std::string_view nothing{};                          // what a default of 0 means: "no end"
	std::string_view needs{};                            // nook shade: given with that option or not at all
	std::string_view base{};                             // given only where that option is on
	std::string_view conflict{};                         // not on together with that option
	std::string_view setting{};                          // members of nook_settings that a module with it reads
	bool stated = false;                                 // in commands by its default as well
	bool (*applies)(const ShadeSettings&) = nullptr;     // null: always
	std::string (*word)(const ShadeSettings&) = nullptr; // in the names of candidates; empty: none
};

// In the order of help and of commands.
std::span<const FeatureRow> featureTable();
const FeatureRow& featureOf(std::string_view option); // requires one of the table

bool takesFeature(const MethodRow& method, const FeatureRow& feature);

// Other than by default.
bool isOn(const FeatureRow& feature, const ShadeSettings& settings);

// The value as one types it: "half", "0.25"; empty for flags, and for none of the choices.
std::string valueText(const FeatureRow& feature, const ShadeSettings& settings);

// Options of `nook emit` for what the settings have on, each after a blank: " --cut --filter window".
std::string emitOptions(const ShadeSettings& settings);

// Words for a candidate's name, each after a blank: " thick half".
std::string featureWords(const ShadeSettings& settings);

} // namespace nook
