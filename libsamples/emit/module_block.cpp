// SPDX-License-Identifier: GPL-3.0-or-later
// The uniform block of a module, whose integers may be floats.
#include "emit/module_parts.h"

#include <sstream>

namespace nook
{
namespace
{

bool isInteger(const BlockMember& member)
{
	return member.type[0] == 'i';
}

bool isWordPart(char c)
{
	return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z');
}

// Exchanges a word of a line's code.
std::string exchanged(std::string line, const std::string& word, const std::string& with)
{
	for (std::size_t at = line.find(word); at != std::string::npos && at < line.find("//"); at = line.find(word, at))
	{
		const std::size_t end = at + word.size();
		const bool whole = end == line.size() || !isWordPart(line[end]);
		line.replace(at, word.size(), whole ? with : word);
		at += whole ? with.size() : word.size();
	}
	return line;
}

} // namespace

std::string typeOf(const ModuleSettings& settings, const BlockMember& member)
{
	return settings.float_block && isInteger(member) ? member.type + 1 : member.type;
}

std::string membersText(const ModuleSettings& settings)
{
	std::string text;
	for (const BlockMember& member : blockMembers())
	{
		text += "\t" + typeOf(settings, member) + " " + member.name + "; // " + member.meaning + "\n";
	}
	return text;
}

std::string withIntegers(const ModuleSettings& settings, const std::string& functions)
{
	if (!settings.float_block)
	{
		return functions;
	}
	std::string text;
	std::istringstream rest(functions);
	for (std::string line; std::getline(rest, line);)
	{
		for (const BlockMember& member : blockMembers())
		{
			const std::string read = std::string("nook.") + member.name;
			line = isInteger(member) ? exchanged(line, read, std::string(member.type) + "(" + read + ")") : line;
		}
		text += line + "\n";
	}
	return text;
}

} // namespace nook
