// SPDX-License-Identifier: GPL-3.0-or-later
// Iterates over the lines of a text file with any line ends, with locations for messages, and replaces some of them.
#pragma once

#include "core/error.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

namespace nook
{

struct TextPlace
{
	const std::string& path;
	std::size_t line = 0;

	[[noreturn]] void fail(const std::string& found, const std::string& expected, ExitCode code = ExitCode::invalid_input) const
	{
		throw Error(code, path + ": line " + std::to_string(line) + ": found " + found + ", expected " + expected);
	}
};

// Calls `repair` with each line and its location; if `joins`, with lines continued by \ joined. The returned text replaces the
// line. Returns none if nothing changed.
template <class Repair>
std::optional<std::string> repairedLines(const std::string& text, const std::string& path, bool joins, const Repair& repair)
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
		const TextPlace place{path, ++number};
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
		if (const std::optional<std::string> line = repair(std::string_view(text).substr(begin, end - begin), place))
		{
			made.append(text, copied, begin - copied);
			made += *line;
			copied = end;
		}
		begin = after();
	}
	return copied == 0 ? std::nullopt : std::optional(made.append(text, copied));
}

} // namespace nook
