// SPDX-License-Identifier: GPL-3.0-or-later
// JSON fields shared by pattern and tile files.
#pragma once

#include "core/json_reader.h"
#include "core/lists.h"
#include "format/notes.h"

#include <limits>
#include <string>

namespace nook
{

// "schema", licence, "command" and "version", one per line with trailing commas.
std::string jsonHead(const char* schema, const EmitContext& context);

// {"plane": 0.0181, …}; non-finite values become null.
std::string measuresJson(const std::vector<Measure>& measures);

// "points", "weights" and, if present, "powers"; without a trailing comma or newline.
std::string samplesJson(const Pattern& pattern, const std::string& indent);

void requireSchema(const JsonValue& root, const char* schema);
void readHead(const JsonValue& root, std::string& command, std::string& version);

// Reads points, weights (if `weights_given`) and powers of an object; counts must agree and be 1 to kMaxCount.
Pattern readSamples(const JsonValue& object, Domain domain, bool weights_given);

template <class Enum> Enum enumOf(const JsonValue& value)
{
	const std::optional<Enum> found = valueNamed<Enum>(value.string());
	value.require(found.has_value(), "one of " + joinedText(namesOf<Enum>(), ", "));
	return *found;
}

// Reads Quality or TileQuality; null means infinity. Measures that are not optional must be present.
template <class Measures> Measures readMeasures(const JsonValue& object)
{
	object.requireObject();
	Measures measures;
	for (const auto& item : object.value->items())
	{
		const JsonValue field = object.at(item.key());
		const double value = field.value->is_null() ? std::numeric_limits<double>::infinity() : field.number();
		failIf(!setMeasure(measures, item.key(), value), field, "an unknown measure", "one of those that nook writes");
	}
	for (const Measure& measure : measuresOf(Measures{}))
	{
		object.at(measure.name);
	}
	return measures;
}

} // namespace nook
