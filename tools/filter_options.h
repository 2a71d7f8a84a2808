// SPDX-License-Identifier: GPL-3.0-or-later
// --filter and --ema, of nook tile and nook info: what an engine does with a tile's variants behind the pass that reads them.
#pragma once

#include "options.h"

#include "format/notes.h"

namespace nook
{

struct FilterOptions
{
	std::vector<std::string> names;
	double ema = 0.1;
	CLI::Option* filter_given = nullptr;
	CLI::Option* ema_given = nullptr;
};

void addFilters(CLI::App& app, FilterOptions& options, const std::string& help);

// NAME or NAME@SHARE; "file:KERNEL.json" is read, and a line says where its sum was not 1. Throws Error.
std::vector<TileFilter> filtersOf(const std::vector<std::string>& names);

// The files among them.
std::vector<std::string> filterFiles(const std::vector<std::string>& names);

// "binomial:3" → the error behind it, or nothing where it takes more than so many steps; with frames also of the mean over them,
// "binomial:3, frames", and of half of its taps, cut off by an edge, "binomial:3, half".
std::vector<Measure> measuresBehind(const PatternTile& tile, const std::vector<TileFilter>& filters, double ema, double most_steps,
									const RunSettings& run);

} // namespace nook
