// SPDX-License-Identifier: GPL-3.0-or-later
// A pattern ↔ comma-separated values, one sample a row.
#pragma once

#include "format/pattern_json.h"

namespace nook
{

// Comments (#), the header x,y,half_length,weight (disk) or x,y,z,weight, then the rows; all 32-bit floats.
std::string patternCsv(const Pattern& pattern, const Quality& quality, const EmitContext& context);

// Reads what patternCsv writes, and what others write: columns x, y, and perhaps z, half_length (checked) and weight.
// With a header its names decide, in any order. Without one: x,y; x,y,z; x,y,z,weight; and for the disk x,y,weight.
// The domain is `domain`, or that of a comment "# domain: ball", or else disk for points without z and ball for those with z;
// directions cannot be told from points, so theirs must be named.
// `path` is for messages only, which name the row of the file. Throws Error (invalid_input).
PatternFile parsePatternCsv(const std::string& text, const std::string& path, std::optional<Domain> domain = std::nullopt);

} // namespace nook
