// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/facts.h"

#include "core/lists.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nook
{
namespace
{

constexpr int kDigits = 4; // of a number for people

std::string numberJson(double value)
{
	return std::isfinite(value) ? doubleText(value) : "null";
}

// One per line in columns.
std::string measureLines(const std::vector<Measure>& measures)
{
	std::size_t width = 0;
	for (const Measure& measure : measures)
	{
		width = std::max(width, measure.name.size());
	}
	const auto lineOf = [width](const Measure& measure)
	{
		return "  " + measure.name + std::string(width - measure.name.size() + 2, ' ') +
			   (std::isfinite(measure.value) ? roundedText(measure.value, 6) : "infinite") + "\n";
	};
	return joinedText(measures, "", lineOf);
}

} // namespace

void Facts::add(std::string_view name, std::string json, std::string_view words, std::string shown)
{
	if (!std::exchange(m_skips, false))
	{
		m_facts.push_back({std::string(name), std::move(json), std::string(words), std::move(shown)});
	}
}

void Facts::text(std::string_view name, std::string_view value, std::string_view words)
{
	add(name, jsonText(value), words, ": " + std::string(value));
}

void Facts::number(std::string_view name, double value, std::string_view words, std::string_view unit)
{
	add(name, numberJson(value), words, ": " + roundedText(value, kDigits) + std::string(unit));
}

void Facts::measures(std::string_view name, const std::vector<Measure>& values, std::string_view words)
{
	const std::string lines = ":\n" + measureLines(values);
	add(name, measuresJson(values), words, lines.substr(0, lines.size() - 1));
}

void Facts::texts(std::string_view name, const std::vector<std::string>& values)
{
	add(name, "[" + joinedText(values, ", ", jsonText) + "]");
}

void Facts::numbers(std::string_view name, const std::vector<double>& values)
{
	add(name, "[" + joinedText(values, ", ", numberJson) + "]");
}

void Facts::items(std::string_view name, const std::vector<Facts>& values)
{
	const auto textOf = [](const Facts& item) // in one line
	{
		const auto inLine = [](const char c)
		{
			return c == '\n' ? "" : std::string(1, c == '\t' ? ' ' : c);
		};
		return "\n\t\t{" + joinedText(item.fields(), "", inLine) + " }";
	};
	add(name, values.empty() ? "[]" : "[" + joinedText(values, ",", textOf) + "\n\t]");
}

void Facts::line(std::string_view words)
{
	add({}, {}, words);
}

std::string Facts::fields() const
{
	const std::vector<Fact> named = itemsWhere(m_facts, [](const Fact& fact) { return !fact.name.empty(); });
	return joinedText(named, ",", [](const Fact& fact) { return "\n\t" + jsonText(fact.name) + ": " + fact.json; });
}

std::string Facts::json() const
{
	return "{" + fields() + "\n}\n";
}

std::string Facts::lines() const
{
	return joinedText(m_facts, "", [](const Fact& fact) { return fact.words.empty() ? "" : fact.words + fact.shown + "\n"; });
}

std::string measuresJson(const std::vector<Measure>& measures)
{
	const auto textOf = [](const Measure& measure)
	{
		return "\n\t\t" + jsonText(measure.name) + ": " + numberJson(measure.value);
	};
	return "{" + joinedText(measures, ",", textOf) + "\n\t}";
}

} // namespace nook
