// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers ↔ decimal text like std::to_chars and std::from_chars, which some standard libraries lack for floating point.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace nook
{

// Shortest text that reads back as the same number, like std::to_chars(value).
std::string shortestDecimal(float value);
std::string shortestDecimal(double value);

// Shortest text in scientific form: "2.5e-06".
std::string shortestScientific(float value);

// `digits` counts significant digits (general) or digits after the point (scientific, fixed).
std::string decimalOf(double value, std::chars_format format, int digits);

// Like std::from_chars(first, last, value).
std::from_chars_result readDecimal(const char* first, const char* last, double& value);

// The whole text as a number in decimal, or nothing.
template <class Number> std::optional<Number> numberFrom(std::string_view text)
{
	Number value{};
	std::from_chars_result result{};
	if constexpr (std::is_floating_point_v<Number>)
	{
		result = readDecimal(text.data(), text.data() + text.size(), value);
	}
	else
	{
		result = std::from_chars(text.data(), text.data() + text.size(), value);
	}
	return result.ec == std::errc{} && result.ptr == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

// Shortest decimal: "0.1", "1e-09", "inf".
inline std::string numberText(double value)
{
	return shortestDecimal(value);
}

} // namespace nook
