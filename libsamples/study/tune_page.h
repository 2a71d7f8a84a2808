// SPDX-License-Identifier: GPL-3.0-or-later
// The result of a search → lines for a terminal, one self-contained page, and JSON.
#pragma once

#include "study/tune.h"
#include "study/tune_emit.h"

#include <string>
#include <vector>

namespace nook
{

// `emission`: null where nothing was written.
struct TuneText
{
	std::string command; // "nook tune …", as it was given
	std::string version;
	const TuneEmission* emission = nullptr;
};

std::string tuneLines(const TuneReport& report, const TuneText& text);

std::string tuneHtml(const TuneReport& report, const TuneText& text);

// Texts of both the lines and the page.
struct TuneTexts
{
	std::string goal;     // "--budget 1ms"
	std::string pick;     // its name and figures, or those of what comes nearest; empty: nothing could be drawn
	std::string measured; // levels, views, what an error is
	std::string search;
	std::vector<std::string> failures; // levels and candidates that are not in the figures, and what is wrong with these
};
TuneTexts tuneTexts(const TuneReport& report);

// Schema "nook.tune/1".
std::string tuneJson(const TuneReport& report, const TuneText& text);

// How the search did against everything measured in full; empty without --check-grid.
std::string gridText(const TuneReport& report);

} // namespace nook
