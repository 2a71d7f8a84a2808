// SPDX-License-Identifier: GPL-3.0-or-later
// Assembles a page as a single file.
#pragma once

#include "core/lists.h"
#include "core/text.h"
#include "page/assets.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nook
{

using PageSlot = std::pair<std::string_view, std::string>; // "@STYLE@" and its text

// Replaces each slot of the template with its text, in one pass, because a text may contain slot names.
inline std::string filledPage(std::string_view page, const std::vector<PageSlot>& slots)
{
	std::string out;
	while (!page.empty())
	{
		const PageSlot* const slot = firstWhere(slots, [&](const PageSlot& s) { return page.starts_with(s.first); });
		out += slot != nullptr ? std::string_view(slot->second) : page.substr(0, 1);
		page.remove_prefix(slot != nullptr ? slot->first.size() : 1);
	}
	return out;
}

// Parts specific to a page.
struct PageText
{
	std::string title;
	std::string version;
	std::string_view body;                 // header and sections, without the data
	std::vector<std::string_view> styles;  // appended to those that all pages share
	std::vector<std::string_view> scripts; // likewise; they draw the data
	std::string json;                      // the page's data
};

inline std::string pageHtml(const PageText& page)
{
	const std::string style = std::string(assets::page_css) + joinedText(page.styles, "");
	const std::string script = std::string(assets::parts_js) + joinedText(page.scripts, "");
	// No text may end the script element that holds the data.
	const std::string data = joinedText(page.json, "", [](const char c) { return c == '<' ? "\\u003c" : std::string(1, c); });
	return filledPage(assets::frame_html, {{"@VERSION@", xmlText(page.version)},
										   {"@TITLE@", xmlText(page.title)},
										   {"@STYLE@", style},
										   {"@BODY@", std::string(page.body)},
										   {"@DATA@", data},
										   {"@SCRIPT@", script}});
}

} // namespace nook
