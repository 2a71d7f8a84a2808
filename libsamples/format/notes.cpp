// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/notes.h"

#include "core/lists.h"

#include <array>
#include <cmath>

namespace nook
{
namespace
{

template <class Struct, class Member> struct Field
{
	std::string_view name;
	Member Struct::*member;
};

using Required = Field<Quality, double>;
using Optional = Field<Quality, std::optional<double>>;
using OfTile = Field<TileQuality, std::optional<double>>;

constexpr std::array kErrors{Required{"plane", &Quality::plane}, Required{"noise", &Quality::noise},
							 Required{"bias", &Quality::bias}, Required{"plane_exact", &Quality::plane_exact},
							 Required{"greatest", &Quality::greatest}};
constexpr std::array kPartial{Optional{"cliff", &Quality::cliff}, Optional{"cliff_greatest", &Quality::cliff_greatest},
							  Optional{"centre", &Quality::centre}, Optional{"crease", &Quality::crease},
							  Optional{"cap", &Quality::cap}};
constexpr std::array kGeometry{Required{"spread", &Quality::spread}, Required{"smallest_distance", &Quality::smallest_distance},
							   Required{"energy", &Quality::energy}, Required{"energy_exponent", &Quality::energy_exponent}};
constexpr std::array kTile{OfTile{"window", &TileQuality::window}, OfTile{"window_exact", &TileQuality::window_exact},
						   OfTile{"variant_plane", &TileQuality::variant_plane},
						   OfTile{"worst_variant", &TileQuality::worst_variant}, OfTile{"base_plane", &TileQuality::base_plane}};

template <class Fields, class Struct> bool setIn(const Fields& fields, Struct& quality, std::string_view name, double value)
{
	for (const auto& field : fields)
	{
		if (field.name == name)
		{
			quality.*field.member = value;
			return true;
		}
	}
	return false;
}

// Leaves out measures that are absent.
template <class Fields, class Struct> void addTo(std::vector<Measure>& measures, const Fields& fields, const Struct& quality)
{
	for (const auto& field : fields)
	{
		if (const std::optional<double> value = quality.*field.member)
		{
			measures.push_back({std::string(field.name), *value});
		}
	}
}

// A backslash (or its trigraph) at the end would continue a // comment on the next line.
std::string withoutContinuation(std::string line)
{
	if (line.ends_with('\\') || line.ends_with("?\?/"))
	{
		line += " .";
	}
	return line;
}

std::string measureText(const std::vector<Measure>& measures)
{
	const auto textOf = [](const Measure& measure)
	{
		return measure.name + " " + (std::isfinite(measure.value) ? roundedText(measure.value, 6) : "infinite");
	};
	return joinedText(measures, ", ", textOf);
}

} // namespace

std::vector<Measure> measuresOf(const Quality& quality)
{
	std::vector<Measure> measures;
	addTo(measures, kErrors, quality);
	addTo(measures, kPartial, quality);
	addTo(measures, kGeometry, quality);
	return measures;
}

std::vector<Measure> measuresOf(const TileQuality& quality)
{
	std::vector<Measure> measures;
	addTo(measures, kTile, quality);
	return measures;
}

bool setMeasure(Quality& quality, std::string_view name, double value)
{
	return setIn(kErrors, quality, name, value) || setIn(kPartial, quality, name, value) || setIn(kGeometry, quality, name, value);
}

bool setMeasure(TileQuality& quality, std::string_view name, double value)
{
	return setIn(kTile, quality, name, value);
}

Notes notesOf(const EmitContext& context, const std::vector<Measure>& measures)
{
	Notes notes;
	const auto add = [&](const char* key, const std::string& value)
	{
		if (!value.empty())
		{
			notes.push_back({key, withoutContinuation(oneLine(value))});
		}
	};
	add("Made by", context.command);
	add("Version", context.version.empty() ? "" : "nook " + context.version);
	add("Base pattern", context.base_command);
	add("Measures", measureText(measures));
	notes.push_back({"SPDX-License-Identifier", "MIT"});
	return notes;
}

std::string shortName(Domain domain, std::size_t count, const Recipe* recipe)
{
	std::string name = std::string(nameOf(domain)) + std::to_string(count);
	if (recipe == nullptr)
	{
		return name;
	}
	const Recipe plain;
	name += recipe->centre ? "_centre" : "";
	name += recipe->symmetric ? "_symmetric" : "";
	const auto part = [&](bool differs, std::string_view text)
	{
		name += differs ? "_" + std::string(text) : "";
	};
	part(recipe->method != plain.method, nameOf(recipe->method));
	part(recipe->minimise != plain.minimise, nameOf(recipe->minimise));
	part(recipe->weights != plain.weights, std::string(nameOf(recipe->weights)) + "_weights");
	part(recipe->order != plain.order, nameOf(recipe->order));
	return name;
}

} // namespace nook
