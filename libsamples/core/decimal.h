// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers ↔ decimal text, as std::to_chars and std::from_chars have it: not every standard library has these for floating point.
#pragma once

#include <charconv>
#include <string>

namespace nook
{

// The shortest that reads back as the same number: std::to_chars(value).
std::string shortestDecimal(float value);
std::string shortestDecimal(double value);

// The same, always with an exponent: "2.5e-06".
std::string shortestScientific(float value);

// With so many digits: significant ones (general), or after the point (scientific, fixed).
std::string decimalOf(double value, std::chars_format format, int digits);

// std::from_chars(first, last, value).
std::from_chars_result readDecimal(const char* first, const char* last, double& value);

} // namespace nook
