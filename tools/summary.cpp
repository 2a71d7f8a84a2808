// SPDX-License-Identifier: GPL-3.0-or-later
#include "summary.h"

#include "core/text.h"
#include "version.h"

#include <algorithm>
#include <cmath>

namespace nook
{
namespace
{

std::string numberJson(double value)
{
	return std::isfinite(value) ? doubleText(value) : "null";
}

} // namespace

Summary::Summary(std::string_view verb)
{
	text("schema", "nook.summary/1");
	text("verb", verb);
	text("version", NOOK_VERSION);
}

void Summary::field(std::string_view name, const std::string& json)
{
	m_fields += (m_fields.empty() ? "\n\t" : ",\n\t") + jsonText(name) + ": " + json;
}

void Summary::text(std::string_view name, std::string_view value)
{
	field(name, jsonText(value));
}

void Summary::number(std::string_view name, double value)
{
	field(name, numberJson(value));
}

void Summary::whole(std::string_view name, std::size_t value)
{
	field(name, std::to_string(value));
}

void Summary::measures(std::string_view name, const std::vector<Measure>& measures)
{
	std::string json;
	for (const Measure& measure : measures)
	{
		json += (json.empty() ? "\n\t\t" : ",\n\t\t") + jsonText(measure.name) + ": " + numberJson(measure.value);
	}
	field(name, "{" + json + "\n\t}");
}

void Summary::texts(std::string_view name, const std::vector<std::string>& values)
{
	std::string json;
	for (const std::string& value : values)
	{
		json += (json.empty() ? "" : ", ") + jsonText(value);
	}
	field(name, "[" + json + "]");
}

void Summary::numbers(std::string_view name, const std::vector<double>& values)
{
	std::string json;
	for (const double value : values)
	{
		json += (json.empty() ? "" : ", ") + numberJson(value);
	}
	field(name, "[" + json + "]");
}

void Summary::items(std::string_view name, const std::vector<Summary>& items)
{
	std::string json;
	for (const Summary& item : items)
	{
		std::string line;
		for (const char c : item.m_fields)
		{
			line += c == '\n' ? "" : std::string(1, c == '\t' ? ' ' : c);
		}
		json += (json.empty() ? "\n\t\t{" : ",\n\t\t{") + line + " }";
	}
	field(name, json.empty() ? "[]" : "[" + json + "\n\t]");
}

std::string Summary::json() const
{
	return "{" + m_fields + "\n}\n";
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
