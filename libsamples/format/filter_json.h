// SPDX-License-Identifier: GPL-3.0-or-later
// A filter's taps in JSON: {"taps": [[0, 1, 0], [1, 4, 1], [0, 1, 0]]}, rows from the top, 1 to 65 of as many numbers.
#pragma once

#include "core/json_reader.h"
#include "pattern/tile_filter.h"

namespace nook
{

struct FilterFile
{
	TileFilter filter; // named "file:" and the file's name without its folder
	double sum = 1.0;  // of the taps as they stand in the file
};

// Throws Error (invalid input) naming `path`, also where the negative taps together reach the sum.
FilterFile readFilter(const std::string& path);
FilterFile parseFilter(const std::string& text, const std::string& path);

// The fields of a filter in a tile's recipe: name, share, width, taps.
nlohmann::ordered_json filterJson(const TileFilter& filter);
TileFilter readFilterFields(const JsonValue& object);

} // namespace nook
