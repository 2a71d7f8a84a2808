// SPDX-License-Identifier: GPL-3.0-or-later
// Texts → a page of one file.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// Nothing in the data may end the script element that holds it.
inline std::string escapedJson(std::string_view json)
{
	std::string out;
	for (const char c : json)
	{
		out += c == '<' ? "\\u003c" : std::string(1, c);
	}
	return out;
}

struct PageSlot
{
	std::string_view name; // "@STYLE@"
	std::string text;
};

// Each slot of the template by its text, in one pass, so that a text may hold what looks like a slot.
inline std::string filledPage(std::string_view page, const std::vector<PageSlot>& slots)
{
	std::string out;
	while (!page.empty())
	{
		const auto slot =
			std::find_if(slots.begin(), slots.end(), [&](const PageSlot& s) { return page.substr(0, s.name.size()) == s.name; });
		if (slot != slots.end())
		{
			out += slot->text;
			page.remove_prefix(slot->name.size());
		}
		else
		{
			out += page.front();
			page.remove_prefix(1);
		}
	}
	return out;
}

} // namespace nook
