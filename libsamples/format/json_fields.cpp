// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/json_fields.h"

#include "core/text.h"
#include "format/pattern_json.h"

namespace nook
{
namespace
{

constexpr std::size_t kWeightsPerLine = 8;

std::size_t dimensions(Domain domain)
{
	return domain == Domain::disk || domain == Domain::slice ? 2 : 3;
}

template <class Text> std::string listJson(std::span<const double> values, const std::string& indent, const Text& text_of)
{
	std::string text = "[";
	for (std::size_t i = 0; i < values.size(); ++i)
	{
		text += i % kWeightsPerLine == 0 ? "\n" + indent + "\t" : " ";
		text += text_of(values[i]) + (i + 1 < values.size() ? "," : "");
	}
	return text + "\n" + indent + "]";
}

glm::dvec3 readPoint(const JsonValue& point, Domain domain)
{
	const std::size_t size = dimensions(domain);
	const std::string expected = std::to_string(size) + " numbers";
	if (!point.value->is_array() || point.value->size() != size)
	{
		point.expected("an array of " + expected);
	}
	glm::dvec3 p{0.0};
	for (std::size_t axis = 0; axis < size; ++axis)
	{
		p[static_cast<glm::length_t>(axis)] = point.at(axis).number();
	}
	return checkedPoint(domain, p, *point.path + ": " + point.element);
}

std::vector<double> readNumbers(const JsonValue& list, std::size_t count)
{
	if (list.arraySize() != count)
	{
		list.expected("an array of " + std::to_string(count) + ", one a point");
	}
	std::vector<double> numbers(count);
	for (std::size_t i = 0; i < count; ++i)
	{
		numbers[i] = list.at(i).number();
	}
	return numbers;
}

} // namespace

std::string jsonHead(const char* schema, const EmitContext& context)
{
	return "\t\"schema\": " + jsonText(schema) + ",\n\t\"command\": " + jsonText(context.command) +
		   ",\n\t\"version\": " + jsonText(context.version) + ",\n\t\"SPDX-License-Identifier\": \"MIT\",\n";
}

std::string measuresJson(const std::vector<Measure>& measures)
{
	std::string text = "{";
	for (const Measure& measure : measures)
	{
		text += (text.size() == 1 ? "\n\t\t" : ",\n\t\t") + jsonText(measure.name) + ": " +
				(std::isfinite(measure.value) ? doubleText(measure.value) : "null");
	}
	return text + "\n\t}";
}

std::string samplesJson(const Pattern& pattern, const std::string& indent)
{
	std::string text = indent + "\"points\": [";
	for (std::size_t i = 0; i < pattern.count(); ++i)
	{
		const glm::dvec3& p = pattern.points[i];
		text += (i == 0 ? "\n" : ",\n") + indent + "\t[" + floatText(p.x) + ", " + floatText(p.y);
		text += dimensions(pattern.domain) == 3 ? ", " + floatText(p.z) + "]" : "]";
	}
	text += "\n" + indent + "],\n" + indent + "\"weights\": ";
	text += listJson(pattern.weights, indent, [](double value) { return floatText(value); });
	if (!pattern.powers.empty())
	{
		text += ",\n" + indent + "\"powers\": " + listJson(pattern.powers, indent, doubleText);
	}
	return text;
}

void requireSchema(const JsonValue& root, const char* schema)
{
	root.requireObject();
	if (root.at("schema").string() != schema)
	{
		root.at("schema").expected(jsonText(schema));
	}
}

void readHead(const JsonValue& root, std::string& command, std::string& version)
{
	for (const auto& [field, target] : {std::pair{"command", &command}, std::pair{"version", &version}})
	{
		if (root.has(field))
		{
			*target = root.at(field).string();
		}
	}
	for (const char* field : {"comment", "SPDX-License-Identifier"})
	{
		if (root.has(field))
		{
			root.at(field).string();
		}
	}
}

Pattern readSamples(const JsonValue& object, Domain domain, bool weights_given)
{
	Pattern pattern;
	pattern.domain = domain;
	const JsonValue points = object.at("points");
	const std::size_t count = points.arraySize();
	if (count < 1 || count > static_cast<std::size_t>(kMaxCount))
	{
		points.expected("an array of 1 to " + std::to_string(kMaxCount) + " points");
	}
	pattern.points.resize(count);
	for (std::size_t i = 0; i < count; ++i)
	{
		pattern.points[i] = readPoint(points.at(i), domain);
	}
	if (weights_given)
	{
		const JsonValue weights = object.at("weights");
		pattern.weights = readNumbers(weights, count);
		const std::string where = *object.path + ": " + weights.element;
		checkWeights(pattern.weights, where, [&](std::size_t i) { return where + "[" + std::to_string(i) + "]"; });
	}
	if (object.has("powers"))
	{
		pattern.powers = readNumbers(object.at("powers"), count);
	}
	return pattern;
}

} // namespace nook
