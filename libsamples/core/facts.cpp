// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/facts.h"

#include "core/lists.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>

namespace nook
{
namespace
{

constexpr int kDigits = 4; // of a number for people

std::string numberJson(double value)
{
	return std::isfinite(value) ? doubleText(value) : "null";
}

// In one line.
std::string itemJson(std::string_view fields)
{
	std::string line;
	for (const char c : fields)
	{
		line += c == '\n' ? "" : std::string(1, c == '\t' ? ' ' : c);
	}
	return "{" + line + " }";
}

} // namespace

void Facts::add(std::string_view name, Value value, std::string_view words, std::string_view unit)
{
	m_facts.push_back({std::string(name), std::move(value), std::string(words), std::string(unit)});
}

void Facts::text(std::string_view name, std::string_view value, std::string_view words)
{
	add(name, std::string(value), words);
}

void Facts::number(std::string_view name, double value, std::string_view words, std::string_view unit)
{
	add(name, value, words, unit);
}

void Facts::measures(std::string_view name, std::vector<Measure> values, std::string_view words)
{
	add(name, std::move(values), words);
}

void Facts::texts(std::string_view name, std::vector<std::string> values)
{
	add(name, std::move(values), {});
}

void Facts::numbers(std::string_view name, std::vector<double> values)
{
	add(name, std::move(values), {});
}

void Facts::items(std::string_view name, std::vector<Facts> values)
{
	add(name, std::move(values), {});
}

void Facts::line(std::string_view words)
{
	add({}, std::monostate{}, words);
}

std::string Facts::fields() const
{
	struct Json
	{
		std::string operator()(std::monostate) const
		{
			return "null";
		}
		std::string operator()(const std::string& value) const
		{
			return jsonText(value);
		}
		std::string operator()(uint64_t value) const
		{
			return std::to_string(value);
		}
		std::string operator()(double value) const
		{
			return numberJson(value);
		}
		std::string operator()(const std::vector<Measure>& values) const
		{
			return measuresJson(values);
		}
		std::string operator()(const std::vector<std::string>& values) const
		{
			return "[" + joinedText(values, ", ", jsonText) + "]";
		}
		std::string operator()(const std::vector<double>& values) const
		{
			return "[" + joinedText(values, ", ", numberJson) + "]";
		}
		std::string operator()(const std::vector<Facts>& values) const
		{
			const auto textOf = [](const Facts& item)
			{
				return "\n\t\t" + itemJson(item.fields());
			};
			return values.empty() ? "[]" : "[" + joinedText(values, ",", textOf) + "\n\t]";
		}
	};
	std::string json;
	for (const Fact& fact : m_facts)
	{
		if (!fact.name.empty())
		{
			json += (json.empty() ? "\n\t" : ",\n\t") + jsonText(fact.name) + ": " + std::visit(Json{}, fact.value);
		}
	}
	return json;
}

std::string Facts::json() const
{
	return "{" + fields() + "\n}\n";
}

std::string Facts::lines() const
{
	std::string lines;
	for (const Fact& fact : m_facts)
	{
		if (fact.words.empty())
		{
			continue;
		}
		lines += fact.words;
		if (const auto* const measures = std::get_if<std::vector<Measure>>(&fact.value))
		{
			lines += ":\n" + measureLines(*measures);
			continue;
		}
		const auto* const text = std::get_if<std::string>(&fact.value);
		const auto* const whole = std::get_if<uint64_t>(&fact.value);
		const auto* const number = std::get_if<double>(&fact.value);
		lines += text != nullptr     ? ": " + *text
				 : whole != nullptr  ? ": " + std::to_string(*whole)
				 : number != nullptr ? ": " + roundedText(*number, kDigits)
									 : "";
		lines += fact.unit + "\n";
	}
	return lines;
}

std::string measuresJson(const std::vector<Measure>& measures)
{
	const auto textOf = [](const Measure& measure)
	{
		return "\n\t\t" + jsonText(measure.name) + ": " + numberJson(measure.value);
	};
	return "{" + joinedText(measures, ",", textOf) + "\n\t}";
}

std::string measureLines(const std::vector<Measure>& measures)
{
	std::size_t width = 0;
	for (const Measure& measure : measures)
	{
		width = std::max(width, measure.name.size());
	}
	std::string lines;
	for (const Measure& measure : measures)
	{
		lines += "  " + measure.name + std::string(width - measure.name.size() + 2, ' ') +
				 (std::isfinite(measure.value) ? roundedText(measure.value, 6) : "infinite") + "\n";
	}
	return lines;
}

} // namespace nook
