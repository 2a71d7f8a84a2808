// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as text by printf and strtod (for libraries without floating-point <charconv>) compared with <charconv>.
#include "core/decimal.h"
#include "core/random.h"
#include "core/round.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

// core/decimal_printf.cpp, compiled a second time under another name (tests/CMakeLists.txt).
namespace nook_by_printf
{
std::string shortestDecimal(float value);
std::string shortestDecimal(double value);
std::string shortestScientific(float value);
std::string decimalOf(double value, std::chars_format format, int digits);
std::from_chars_result readDecimal(const char* first, const char* last, double& value);
} // namespace nook_by_printf

using namespace nook;

TEST_CASE("decimal: the shortest text is that of <charconv>", "[core]")
{
	Random random(3);
	for (int i = 0; i < 20000; ++i)
	{
		const auto wide = bitsAs<double>((static_cast<uint64_t>(random.next()) << 32U) | random.next());
		const auto narrow = bitsAs<float>(random.next());
		const double power = std::ldexp(i % 2 == 0 ? 1.0 : -1.0, i % 2098 - 1074);
		const double plain = std::round(random.uniform() * 1e6) / std::pow(10.0, i % 12);
		for (const double value : {wide, power, plain, static_cast<double>(narrow), std::ldexp(plain, 60)})
		{
			if (!std::isnan(value))
			{
				REQUIRE(nook_by_printf::shortestDecimal(value) == shortestDecimal(value));
			}
		}
		for (const float value : {narrow, static_cast<float>(power), static_cast<float>(plain)})
		{
			if (!std::isnan(value))
			{
				REQUIRE(nook_by_printf::shortestDecimal(value) == shortestDecimal(value));
				REQUIRE(nook_by_printf::shortestScientific(value) == shortestScientific(value));
			}
		}
		for (const auto format : {std::chars_format::general, std::chars_format::scientific, std::chars_format::fixed})
		{
			REQUIRE(nook_by_printf::decimalOf(wide, format, 1 + i % 8) == decimalOf(wide, format, 1 + i % 8));
			REQUIRE(nook_by_printf::decimalOf(plain, format, i % 8) == decimalOf(plain, format, i % 8));
		}
	}
}

TEST_CASE("decimal: what is read is what <charconv> reads", "[core]")
{
	Random random(4);
	const std::string letters = "0123456789..eE+-0123456789infa x";
	std::vector<std::string> texts{"",       "-",      ".",        "1.",     ".5",        "+1",     " 1",       "0x10",
								   "1e",     "1e+",    "1e5",      "-1E-3",  "inf",       "-INF",   "infinity", "infinit",
								   "nan",    "nan(1)", "nan(",     "nan()",  "nan(_a9)x", "nan( )", "-nan(x)",  "1e400",
								   "-1e400", "1e-400", "4.9e-324", "2e-324", "1,5"};
	for (int i = 0; i < 20000; ++i)
	{
		std::string text;
		for (uint32_t k = random.below(9); k > 0; --k)
		{
			text += letters[random.below(static_cast<uint32_t>(letters.size()))];
		}
		texts.push_back(text);
	}
	for (const std::string& text : texts)
	{
		CAPTURE(text);
		double a = 7.0;
		double b = 7.0;
		const std::from_chars_result expected = readDecimal(text.data(), text.data() + text.size(), a);
		const std::from_chars_result found = nook_by_printf::readDecimal(text.data(), text.data() + text.size(), b);
		REQUIRE(found.ec == expected.ec);
		REQUIRE(found.ptr == expected.ptr);
		REQUIRE((a == b || (std::isnan(a) && std::isnan(b))));
	}
}
