// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Wavefront Technologies, Advanced Visualizer manual, appendix B1, Object Files (.obj), and the MTL format
// beside it.
#include "scene/obj_text.h"

#include "core/error.h"
#include "scene/number_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

namespace nook
{
namespace
{

using Words = std::vector<std::string_view>;

// A line of a file, for messages.
struct Place
{
	const std::string& path;
	std::size_t line = 0;

	[[noreturn]] void fail(const std::string& found, const std::string& expected) const
	{
		throw Error(ExitCode::invalid_input,
					path + ": line " + std::to_string(line) + ": found " + found + ", expected " + expected);
	}
};

std::string joined(const Words& words, const std::vector<std::string>& rest)
{
	std::string line(words[0]);
	for (const std::string& word : rest)
	{
		line += " " + word;
	}
	return line;
}

// Of v, vt and vn. A colour behind a position stays where it is three numbers, and goes where it is four.
std::optional<std::string> repairedNumbers(Words& words, const Place& place)
{
	bool changed = false;
	const auto comment = std::find_if(words.begin(), words.end(), [](std::string_view word) { return word.starts_with('#'); });
	if (comment != words.end())
	{
		words.erase(comment, words.end());
		changed = true;
	}
	std::vector<std::string> numbers;
	for (std::size_t i = 1; i < words.size(); ++i)
	{
		if (!isNumberText(words[i]))
		{
			place.fail(quoted(words[i]), "a number");
		}
		numbers.push_back(plainNumber(words[i]));
		changed = changed || numbers.back() != words[i];
	}
	const std::size_t count = numbers.size();
	if (words[0] == "v" && count != 3 && count != 4 && count != 6 && count != 7)
	{
		place.fail(std::to_string(count) + " numbers", "x y z, a weight behind them or a colour");
	}
	if ((words[0] == "vn" && count != 3) || (words[0] == "vt" && (count < 1 || count > 3)))
	{
		place.fail(std::to_string(count) + " numbers", words[0] == "vn" ? "x y z" : "u, u v or u v w");
	}
	if (count == 7 || (words[0] == "vt" && count == 1))
	{
		numbers.resize(words[0] == "v" ? 3 : 2, "0");
		changed = true;
	}
	return changed ? std::optional(joined(words, numbers)) : std::nullopt;
}

// "1", "1/2", "1//3" or "1/2/3", without signs and zeros that only stand before it.
std::string plainCorner(std::string_view word, const Place& place)
{
	std::string plain;
	std::size_t parts = 0;
	for (std::size_t begin = 0; begin <= word.size(); ++parts)
	{
		const std::size_t end = std::min(word.find('/', begin), word.size());
		const std::string_view part = word.substr(begin, end - begin);
		const std::optional<int> index = wholeOf(part);
		if (parts > 2 || (!index && (parts == 0 || !part.empty())))
		{
			place.fail(quoted(word), "an index, or two or three with / between them");
		}
		plain += (parts > 0 ? "/" : "") + (index ? std::to_string(*index) : std::string());
		begin = end + 1;
	}
	return plain.substr(0, plain.find_last_not_of('/') + 1);
}

// Of f, l and p.
std::optional<std::string> repairedCorners(const Words& words, const Place& place)
{
	bool changed = false;
	std::vector<std::string> corners;
	for (std::size_t i = 1; i < words.size() && !words[i].starts_with('#'); ++i)
	{
		corners.push_back(plainCorner(words[i], place));
		changed = changed || corners.back() != words[i];
	}
	changed = changed || corners.size() + 1 < words.size();
	return changed ? std::optional(joined(words, corners)) : std::nullopt;
}

// What stands in place of a line; none: the line itself.
std::optional<std::string> repairedObjLine(std::string_view line, Words& words, const Place& place)
{
	constexpr std::array<std::string_view, 6> kOthers{"g", "o", "s", "usemtl", "mtllib", "mg"};
	const std::string_view keyword = words[0];
	std::optional<std::string> repaired;
	if (keyword == "v" || keyword == "vt" || keyword == "vn")
	{
		repaired = repairedNumbers(words, place);
	}
	else if (keyword == "f" || keyword == "l" || keyword == "p")
	{
		repaired = repairedCorners(words, place);
	}
	else if (std::find(kOthers.begin(), kOthers.end(), keyword) == kOthers.end())
	{
		return ""; // curves and surfaces among them, which nobody here draws
	}
	const auto indent = static_cast<std::size_t>(keyword.data() - line.data());
	return repaired || indent == 0 ? repaired : std::optional(std::string(line.substr(indent)));
}

std::optional<std::string> repairedMtlLine(const Words& words, const Place& place)
{
	std::string keyword(words[0]);
	if (keyword == "d" || keyword == "Tr")
	{
		const std::size_t at = words.size() > 1 && words[1] == "-halo" ? 2 : 1; // what depends on the view is the same from all
		if (at >= words.size() || !isNumberText(words[at]))
		{
			place.fail(at < words.size() ? quoted(words[at]) : "nothing", "a number");
		}
		return keyword + " " + plainNumber(words[at]);
	}
	std::transform(keyword.begin(), keyword.end(), keyword.begin(),
				   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
	const bool kept = keyword == "newmtl" || keyword == "map_d" || keyword == "map_kd";
	return kept ? std::nullopt : std::optional(std::string());
}

// Several lines, each but the last with a \ at its end, as one that `made` holds; one as it is.
std::string_view onOneLine(std::string_view line, std::string& made)
{
	if (line.find_first_of("\r\n") == std::string_view::npos)
	{
		return line;
	}
	made = line;
	for (std::size_t at = made.find_first_of("\r\n"); at != std::string::npos; at = made.find_first_of("\r\n", at))
	{
		made[at] = ' ';
		made[at - 1] = made[at - 1] == '\\' ? ' ' : made[at - 1];
	}
	return made;
}

// Hands `repair` each line, joined to those that a \ at its end calls for, and its number; what it returns takes the line's place.
template <class Repair> std::optional<std::string> repairedLines(const std::string& text, bool joins, const Repair& repair)
{
	std::string made;
	std::size_t copied = 0;
	std::size_t number = 0;
	const auto endOf = [&](std::size_t at)
	{
		return std::min(text.find_first_of("\r\n", at), text.size());
	};
	for (std::size_t begin = 0; begin < text.size();)
	{
		const std::size_t first = ++number;
		std::size_t end = endOf(begin);
		const auto after = [&]
		{
			return std::min(end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1), text.size());
		};
		while (joins && end > begin && text[end - 1] == '\\' && after() < text.size())
		{
			end = endOf(after());
			number += 1;
		}
		if (const std::optional<std::string> line = repair(std::string_view(text).substr(begin, end - begin), first))
		{
			made.append(text, copied, begin - copied);
			made += *line;
			copied = end;
		}
		begin = after();
	}
	return copied == 0 ? std::nullopt : std::optional(made.append(text, copied));
}

} // namespace

std::optional<std::string> repairedObj(const std::string& text, const std::string& path)
{
	Words words;
	std::string one;
	const auto repair = [&](std::string_view line, std::size_t number) -> std::optional<std::string>
	{
		line = onOneLine(line, one);
		splitWords(line, words);
		const bool empty = words.empty() || words[0].starts_with('#');
		return empty ? std::nullopt : repairedObjLine(line, words, {path, number});
	};
	return repairedLines(text, true, repair);
}

std::optional<std::string> repairedMtl(const std::string& text, const std::string& path)
{
	Words words;
	const auto repair = [&](std::string_view line, std::size_t number) -> std::optional<std::string>
	{
		splitWords(line, words);
		const bool empty = words.empty() || words[0].starts_with('#');
		return empty ? std::nullopt : repairedMtlLine(words, {path, number});
	};
	return repairedLines(text, false, repair);
}

} // namespace nook
