// SPDX-License-Identifier: GPL-3.0-or-later
// Implementation with printf and strtod, for libraries that round correctly but lack floating-point <charconv> (libc++ before 14
// with musl). Slower.
#include "core/decimal.h"
#include "core/lists.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <regex>

namespace nook
{
namespace
{

std::string printed(const char* format, int digits, double value)
{
	std::array<char, 512> buffer{};
	const int size = std::snprintf(buffer.data(), buffer.size(), format, digits, value);
	return {buffer.data(), static_cast<std::size_t>(size)};
}

template <class Float> bool readsBack(const std::string& text, Float value)
{
	return (sizeof(Float) == sizeof(float) ? static_cast<Float>(std::strtof(text.c_str(), nullptr))
										   : static_cast<Float>(std::strtod(text.c_str(), nullptr))) == value;
}

// Raises the last digit of "1.25e-04" by one. The gap below a power of two is smaller than the gap above, so the next decimal may
// round-trip where the nearest one does not.
std::string raised(std::string text)
{
	for (std::size_t at = text.find('e'); at-- > 0;)
	{
		if (text[at] == '9')
		{
			text[at] = '0';
		}
		else if (text[at] != '.' && text[at] != '-')
		{
			text[at] = static_cast<char>(text[at] + 1);
			return text;
		}
	}
	return text; // all nines: shorter forms were already tried
}

template <class Float> std::string shortestForm(Float value)
{
	for (int digits = 0; digits < std::numeric_limits<Float>::max_digits10; ++digits)
	{
		const std::string text = printed("%.*e", digits, static_cast<double>(value));
		for (const std::string& candidate : {text, raised(text)})
		{
			if (readsBack(candidate, value))
			{
				return candidate;
			}
		}
	}
	return printed("%.*e", std::numeric_limits<Float>::max_digits10 - 1, static_cast<double>(value));
}

std::string notFinite(double value)
{
	return std::string(std::signbit(value) ? "-" : "") + (std::isnan(value) ? "nan" : "inf");
}

// Expands a scientific form (no sign, no point) to plain decimal notation.
template <class Float> std::string withoutExponent(const std::string& form, Float value)
{
	const std::size_t e = form.find('e');
	const int exponent = std::atoi(form.c_str() + e + 1);
	std::string digits =
		joinedText(form.substr(0, e), "", [](const char c) { return c >= '0' && c <= '9' ? std::string(1, c) : ""; });
	const std::string sign = std::signbit(value) ? "-" : "";
	const auto count = static_cast<int>(digits.size());
	if (exponent < 0)
	{
		return sign + "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + digits;
	}
	if (exponent + 1 < count)
	{
		return sign + digits.insert(static_cast<std::size_t>(exponent) + 1, ".");
	}
	return printed("%.*f", 0, static_cast<double>(value)); // an integer: print all digits instead of zeros
}

template <class Float> std::string shortest(Float value)
{
	if (!std::isfinite(value))
	{
		return notFinite(static_cast<double>(value));
	}
	const std::string form = shortestForm(value);
	const std::string plain = withoutExponent(form, value);
	return plain.size() <= form.size() ? plain : form;
}

// Returns the end of what std::from_chars accepts as a number: no leading blank or plus, no hexadecimal.
const char* endOfNumber(const char* first, const char* last)
{
	static const std::regex number(R"(-?(inf(inity)?|nan(\(\w*\))?|(\d+\.?\d*|\.\d+)(e[-+]?\d+)?))", std::regex::icase);
	std::cmatch match;
	return std::regex_search(first, last, match, number, std::regex_constants::match_continuous) ? match[0].second : nullptr;
}

} // namespace

std::string shortestDecimal(float value)
{
	return shortest(value);
}

std::string shortestDecimal(double value)
{
	return shortest(value);
}

std::string shortestScientific(float value)
{
	return std::isfinite(value) ? shortestForm(value) : notFinite(static_cast<double>(value));
}

std::string decimalOf(double value, std::chars_format format, int digits)
{
	return printed(format == std::chars_format::fixed        ? "%.*f"
				   : format == std::chars_format::scientific ? "%.*e"
															 : "%.*g",
				   digits, value);
}

std::from_chars_result readDecimal(const char* first, const char* last, double& value)
{
	const char* const end = endOfNumber(first, last);
	if (end == nullptr)
	{
		return {first, std::errc::invalid_argument};
	}
	errno = 0;
	const double read = std::strtod(std::string(first, end).c_str(), nullptr);
	if (errno == ERANGE && (std::isinf(read) || read == 0.0))
	{
		return {end, std::errc::result_out_of_range};
	}
	value = read;
	return {end, std::errc{}};
}

} // namespace nook
