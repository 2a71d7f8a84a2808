// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/text.h"

#include "core/decimal.h"
#include "core/json_text.h"
#include "core/lists.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>

namespace nook
{
namespace
{

bool isControl(char c)
{
	return static_cast<unsigned char>(c) < 0x20 || c == '\x7f';
}

std::string withPoint(std::string text)
{
	const std::size_t exponent = text.find('e');
	if (text.find('.') == std::string::npos)
	{
		text.insert(exponent == std::string::npos ? text.size() : exponent, ".0");
	}
	return text;
}

// Every file that writes or parses JSON by itself instantiates half of nlohmann-json.
template <typename Json> std::string lineOf(const Json& value)
{
	return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

} // namespace

std::string jsonLine(const nlohmann::json& value)
{
	return lineOf(value);
}

std::string jsonLine(const nlohmann::ordered_json& value)
{
	return lineOf(value);
}

std::string jsonFile(const nlohmann::ordered_json& value)
{
	return value.dump(1, '\t', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

nlohmann::json looseJson(std::string_view text)
{
	return nlohmann::json::parse(text, nullptr, false);
}

std::string floatText(float value)
{
	return withPoint(shortestDecimal(value));
}

std::string floatText(double value)
{
	return floatText(static_cast<float>(value));
}

std::string doubleText(double value)
{
	return withPoint(shortestDecimal(value));
}

std::string roundedText(double value, int digits)
{
	return decimalOf(value, std::chars_format::general, digits);
}

double roundedNumber(double value, int digits)
{
	const std::string text = decimalOf(value, std::chars_format::scientific, digits - 1);
	double result = 0.0;
	readDecimal(text.data(), text.data() + text.size(), result);
	return result;
}

std::string fixedText(double value, int digits)
{
	return decimalOf(value, std::chars_format::fixed, digits);
}

std::string oneLine(std::string_view text)
{
	std::string line = nlohmann::json::parse(jsonText(text)).get<std::string>(); // UTF-8
	std::replace_if(line.begin(), line.end(), isControl, ' ');
	return line;
}

std::string jsonText(std::string_view text)
{
	return jsonLine(nlohmann::json(std::string(text)));
}

std::string xmlText(std::string_view text)
{
	std::string escaped;
	for (const char c : text)
	{
		switch (c)
		{
		case '&': escaped += "&amp;"; break;
		case '<': escaped += "&lt;"; break;
		case '>': escaped += "&gt;"; break;
		case '"': escaped += "&quot;"; break;
		default: escaped += isControl(c) && c != '\n' ? ' ' : c;
		}
	}
	return escaped;
}

std::string shellQuoted(std::string_view text)
{
	return "'" + joinedText(text, "", [](char c) { return c == '\'' ? "'\\''" : std::string(1, c); }) + "'";
}

std::string shellWord(const std::string& text)
{
	const auto isPlain = [](char c)
	{
		return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::string_view("_-./:+=,").find(c) != std::string_view::npos;
	};
	return !text.empty() && std::all_of(text.begin(), text.end(), isPlain) ? text : shellQuoted(text);
}

bool isIdentifier(std::string_view name)
{
	const auto isLetter = [](char c)
	{
		return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
	};
	return !name.empty() && isLetter(name.front()) && name.back() != '_' &&
		   std::all_of(name.begin(), name.end(), [&](char c) { return isLetter(c) || (c >= '0' && c <= '9') || c == '_'; }) &&
		   name.find("__") == std::string_view::npos && !name.starts_with("gl_");
}

std::string commentBlock(const Notes& notes, std::string_view prefix)
{
	return joinedText(notes, "", [&](const Note& note) { return std::string(prefix) + note.key + ": " + note.value + "\n"; });
}

} // namespace nook
