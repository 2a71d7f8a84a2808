// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/file.h"

#include "core/error.h"
#include "core/lists.h"

#include <algorithm>
#include <cstdio>
#include <string_view>

namespace nook
{
namespace
{

enum class Side
{
	target,
	source,
};

// Ninja ends a name at each of these and cannot escape them. In Make, ; and != start commands, = sets a variable and the others are
// globs, except " & ' < > ^ ` |.
constexpr std::string_view kNever = "\"&'*;<=>?[^`|";
// At a name's end these escape what follows (\ and blank), end a Ninja target (:) or mark an archive member in Make.
constexpr std::string_view kNeverLast = " \\:)";
// Make and Ninja disagree on how many backslashes escape these after a literal backslash.
constexpr std::string_view kNeverBehindBackslash = "#:$%";

std::string spoken(char c)
{
	const auto code = static_cast<unsigned char>(c);
	if (code > 0x20 && code != 0x7F)
	{
		return std::string("'") + c + "'";
	}
	char text[8];
	std::snprintf(text, sizeof text, "\\x%02X", code);
	return c == ' ' ? "a blank" : c == '\n' || c == '\r' ? "a line break" : text;
}

void check(const std::string& path, Side side)
{
	const auto refuse = [&](char c, const char* where)
	{
		throw Error(ExitCode::unsupported,
					path + ": found " + spoken(c) + where + ", expected a name that a depfile for Make and Ninja can hold");
	};
	std::size_t start = 0;
	while (path.compare(start, 2, "./") == 0)
	{
		start = std::min(path.find_first_not_of('/', start + 1), path.size());
	}
	if (path.compare(start, 1, "~") == 0) // Make expands ~ even after a stripped ./
	{
		refuse('~', " at the start");
	}
	for (std::size_t i = 0; i < path.size(); ++i)
	{
		const char c = path[i];
		const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
		if (control || kNever.find(c) != std::string_view::npos ||
			(side == Side::target && c == '%')) // % in a target makes a pattern rule
		{
			refuse(c, "");
		}
		if (i > 0 && path[i - 1] == '\\' && kNeverBehindBackslash.find(c) != std::string_view::npos)
		{
			refuse(c, " behind a backslash");
		}
	}
	if (path.empty() || kNeverLast.find(path.back()) != std::string_view::npos)
	{
		refuse(path.empty() ? ' ' : path.back(), " at the end");
	}
}

std::string escaped(const std::string& path, Side side)
{
	check(path, side);
	std::string text;
	std::size_t backslashes = 0; // number directly before the current character
	for (const char c : path)
	{
		if (c == ' ')
		{
			text.append(backslashes, '\\'); // before a blank, backslashes must be escaped; elsewhere they are literal
		}
		if (c == ' ' || c == '#' || c == ':')
		{
			text += '\\';
		}
		if (c == '$')
		{
			text += '$';
		}
		text += c;
		backslashes = c == '\\' ? backslashes + 1 : 0;
	}
	return text;
}

} // namespace

std::string depfileText(std::span<const std::string> targets, std::span<const std::string> sources)
{
	std::string text = joinedText(targets, " ", [](const std::string& target) { return escaped(target, Side::target); }) + ":";
	for (const std::string& source : sources)
	{
		text += " \\\n  " + escaped(source, Side::source);
	}
	return text + "\n";
}

} // namespace nook
