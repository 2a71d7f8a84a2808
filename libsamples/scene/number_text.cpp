// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/number_text.h"

#include "core/decimal.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>

namespace nook
{
namespace
{

std::string_view withoutSign(std::string_view word)
{
	return word.starts_with('-') || word.starts_with('+') ? word.substr(1) : word;
}

// "nan" or "inf" without a sign; empty for any other word.
std::string_view notFinite(std::string_view unsigned_word)
{
	const std::string word = lowered(unsigned_word);
	if (word.starts_with("1.#inf") || word == "inf" || word == "infinity")
	{
		return "inf";
	}
	const bool microsoft =
		word.starts_with("1.#qnan") || word.starts_with("1.#snan") || word.starts_with("1.#nan") || word.starts_with("1.#ind");
	return microsoft || word == "nan" || (word.starts_with("nan(") && word.ends_with(")")) ? "nan" : "";
}

std::size_t digitsAt(std::string_view word, std::size_t at)
{
	std::size_t count = 0;
	while (at + count < word.size() && word[at + count] >= '0' && word[at + count] <= '9')
	{
		count += 1;
	}
	return count;
}

} // namespace

bool isNumberText(std::string_view word)
{
	word = withoutSign(word);
	const std::size_t whole = digitsAt(word, 0);
	std::size_t at = whole;
	std::size_t broken = 0;
	if (at < word.size() && word[at] == '.')
	{
		broken = digitsAt(word, at + 1);
		at += 1 + broken;
	}
	if (whole + broken > 0 && at < word.size() && (word[at] == 'e' || word[at] == 'E'))
	{
		const bool has_sign = at + 1 < word.size() && (word[at + 1] == '-' || word[at + 1] == '+');
		const std::size_t digits = digitsAt(word, at + (has_sign ? 2 : 1));
		at += digits > 0 ? (has_sign ? 2 : 1) + digits : 0;
	}
	return (whole + broken > 0 && at == word.size()) || !notFinite(word).empty();
}

std::string plainNumber(std::string_view word)
{
	const std::string_view rest = withoutSign(word);
	const std::string sign(word.starts_with('-') ? "-" : "");
	if (const std::string_view odd = notFinite(rest); !odd.empty())
	{
		return sign + std::string(odd);
	}
	return rest.starts_with('.') ? sign + "0" + std::string(rest) : std::string(word);
}

double numberOf(std::string_view word)
{
	const double sign = word.starts_with('-') ? -1.0 : 1.0;
	const std::string_view rest = withoutSign(word);
	if (const std::string_view odd = notFinite(rest); !odd.empty())
	{
		return odd == "inf" ? sign * std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
	}
	double value = 0.0;
	if (readDecimal(rest.data(), rest.data() + rest.size(), value).ec == std::errc::result_out_of_range)
	{
		const std::size_t exponent = rest.find_first_of("eE");
		const bool small = exponent == std::string_view::npos ? rest.find_first_not_of('0') == rest.find('.')
															  : rest.substr(exponent + 1).starts_with('-');
		value = small ? 0.0 : std::numeric_limits<double>::infinity();
	}
	return sign * value;
}

bool isWholeText(std::string_view word)
{
	const std::string_view digits = withoutSign(word);
	return !digits.empty() && digitsAt(digits, 0) == digits.size();
}

std::string lowered(std::string_view word)
{
	std::string text(word);
	std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
	return text;
}

std::string textFrom(const std::vector<std::string_view>& words, std::size_t first)
{
	return {words[first].data(), words.back().data() + words.back().size()};
}

std::string quoted(std::string_view word)
{
	constexpr std::size_t kMost = 40;
	return "'" + std::string(word.substr(0, kMost)) + (word.size() > kMost ? "...'" : "'");
}

std::optional<int> wholeOf(std::string_view word)
{
	int value = 0;
	const bool positive = word.starts_with('+') && !word.starts_with("+-");
	const char* const end = word.data() + word.size();
	const auto [stop, wrong] = std::from_chars(word.data() + (positive ? 1 : 0), end, value);
	return wrong == std::errc{} && stop == end ? std::optional(value) : std::nullopt;
}

void splitWords(std::string_view line, std::vector<std::string_view>& words)
{
	constexpr std::string_view kBlanks = " \t\r\n\v\f";
	words.clear();
	for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;)
	{
		const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
		words.push_back(line.substr(at, end - at));
		at = line.find_first_not_of(kBlanks, end);
	}
}

} // namespace nook
