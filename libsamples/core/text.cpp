// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/text.h"

#include "core/json_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>

namespace nook
{
namespace
{

bool isControl(char c)
{
	return static_cast<unsigned char>(c) < 0x20 || c == '\x7f';
}

template <class Number> std::string shortest(Number value)
{
	std::array<char, 64> buffer{};
	const std::to_chars_result end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
	std::string text(buffer.data(), end.ptr);
	const std::size_t exponent = text.find('e');
	if (text.find('.') == std::string::npos)
	{
		text.insert(exponent == std::string::npos ? text.size() : exponent, ".0");
	}
	return text;
}

} // namespace

std::string floatText(float value)
{
	return shortest(value);
}

std::string floatText(double value)
{
	return shortest(static_cast<float>(value));
}

std::string doubleText(double value)
{
	return shortest(value);
}

std::string roundedText(double value, int digits)
{
	std::array<char, 64> buffer{};
	const std::to_chars_result end =
		std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, digits);
	return {buffer.data(), end.ptr};
}

double roundedNumber(double value, int digits)
{
	std::array<char, 64> buffer{};
	const std::to_chars_result end =
		std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::scientific, digits - 1);
	double result = 0.0;
	std::from_chars(buffer.data(), end.ptr, result);
	return result;
}

std::string fixedText(double value, int digits)
{
	std::array<char, 64> buffer{};
	const std::to_chars_result end =
		std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, digits);
	return {buffer.data(), end.ptr};
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

bool isIdentifier(std::string_view name)
{
	const auto isLetter = [](char c)
	{
		return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
	};
	const auto isPart = [&](char c)
	{
		return isLetter(c) || (c >= '0' && c <= '9') || c == '_';
	};
	return !name.empty() && isLetter(name.front()) && name.back() != '_' && std::all_of(name.begin(), name.end(), isPart) &&
		   name.find("__") == std::string_view::npos && !name.starts_with("gl_");
}

} // namespace nook
