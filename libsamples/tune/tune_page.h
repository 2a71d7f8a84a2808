// SPDX-License-Identifier: GPL-3.0-or-later
// What tune.h found → lines for a terminal, one self-contained page, and JSON.
#pragma once

#include "tune/tune.h"
#include "tune/tune_emit.h"

#include <string>

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

// Time against error of all candidates, as an SVG element; colours by the page's classes.
std::string tuneChart(const TuneReport& report);

// Schema "nook.tune/1".
std::string tuneJson(const TuneReport& report, const TuneText& text);

// How the search did against everything measured in full; empty without --check-grid.
std::string gridText(const TuneReport& report);

} // namespace nook
