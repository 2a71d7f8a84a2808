// SPDX-License-Identifier: GPL-3.0-or-later
// Implementation with <charconv>.
#include "core/decimal.h"

#include <array>

namespace nook
{
namespace
{

template <class... What> std::string decimalText(What... what)
{
	std::array<char, 512> buffer{}; // fits 309 digits before the point
	const std::to_chars_result end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), what...);
	return {buffer.data(), end.ptr};
}

} // namespace

std::string shortestDecimal(float value)
{
	return decimalText(value);
}

std::string shortestDecimal(double value)
{
	return decimalText(value);
}

std::string shortestScientific(float value)
{
	return decimalText(value, std::chars_format::scientific);
}

std::string decimalOf(double value, std::chars_format format, int digits)
{
	return decimalText(value, format, digits);
}

std::from_chars_result readDecimal(const char* first, const char* last, double& value)
{
	return std::from_chars(first, last, value);
}

} // namespace nook
