// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/depfile.h"

#include "core/error.h"

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

// Ninja ends a name at each of these, and has no escape for them. Make runs what follows ; or !=, sets a variable at =, and
// matches the others with files, but for " & ' < > ^ ` |.
constexpr std::string_view kNever = "\"&'*;<=>?[^`|";
// At a name's end: escapes of what follows, the end of a target for Ninja, a member of an archive for Make.
constexpr std::string_view kNeverLast = " \\:)";
// Behind a backslash that is one: Make and Ninja disagree on how many then have to stand there.
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
	if (path.compare(start, 1, "~") == 0) // somebody's home for Make, which takes ./ away first
	{
		refuse('~', " at the start");
	}
	for (std::size_t i = 0; i < path.size(); ++i)
	{
		const char c = path[i];
		const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
		if (control || kNever.find(c) != std::string_view::npos || (side == Side::target && c == '%')) // % of a target: a pattern
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
	std::size_t backslashes = 0; // directly before the character at hand
	for (const char c : path)
	{
		if (c == ' ')
		{
			text.append(backslashes, '\\'); // before a blank they are escapes of each other; elsewhere they stand for themselves
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
	std::string text;
	for (const std::string& target : targets)
	{
		text += (text.empty() ? "" : " ") + escaped(target, Side::target);
	}
	text += ":";
	for (const std::string& source : sources)
	{
		text += " \\\n  " + escaped(source, Side::source);
	}
	return text + "\n";
}

} // namespace nook
