// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/depfile.h"

#include "core/error.h"

namespace nook
{
namespace
{

std::string escaped(const std::string& path)
{
	std::string text;
	std::size_t backslashes = 0; // directly before the character at hand
	for (const char c : path)
	{
		if (c == '\n' || c == '\r')
		{
			throw Error(ExitCode::unsupported,
						path + ": found a line break in a file name, expected a name that a depfile can hold");
		}
		if (c == ' ' || c == '\t' || c == '#')
		{
			// Make takes backslashes before a blank as escapes of each other; elsewhere they stand for themselves.
			text.append(backslashes, '\\');
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
		text += (text.empty() ? "" : " ") + escaped(target);
	}
	text += ":";
	for (const std::string& source : sources)
	{
		text += " \\\n  " + escaped(source);
	}
	return text + "\n";
}

} // namespace nook
