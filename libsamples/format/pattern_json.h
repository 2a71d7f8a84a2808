// SPDX-License-Identifier: GPL-3.0-or-later
// A pattern ↔ JSON, "schema": "nook.pattern/1".
//
// Fields, in this order: schema, SPDX-License-Identifier, command, version, quality (the measures), recipe (every option of
// `nook pattern` by its name), domain, count, points (x, y for the disk, else x, y, z), weights, powers (only power diagrams).
// Points and weights are 32-bit floats; powers have all 64 bits. A file made by someone else needs domain and points only.
#pragma once

#include "format/notes.h"

#include <optional>
#include <string>

namespace nook
{

inline constexpr const char* kPatternSchema = "nook.pattern/1";

std::string patternJson(const Pattern& pattern, const Recipe* recipe, const Quality& quality, const EmitContext& context);

struct PatternFile
{
	Pattern pattern;           // without weights where the file has none
	bool weights_given = true; // false: the caller computes them
	std::optional<Recipe> recipe;
	std::optional<Quality> quality; // as written in the file
	std::string command;            // as written in the file, or empty
	std::string version;
};

// `path` is for messages only. Throws Error (invalid_input) for anything wrong: nothing is guessed, unknown fields are refused.
PatternFile parsePatternJson(const std::string& text, const std::string& path);

// Reads a pattern file: CSV (pattern_csv.h) where the path ends in .csv, else JSON. domain: what the caller knows of it;
// a file that says otherwise is an error.
PatternFile readPattern(const std::string& path, std::optional<Domain> domain = std::nullopt);

} // namespace nook
