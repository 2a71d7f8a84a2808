// SPDX-License-Identifier: GPL-3.0-or-later
// A pattern ↔ JSON, "schema": "nook.pattern/1".
//
// Fields, in this order: schema, SPDX-License-Identifier, command, version, quality (the measures), recipe (every option of
// `nook pattern` by its name), domain, count, points (x, y for the disk, else x, y, z), weights, powers (only power diagrams).
// Points and weights are 32-bit floats; powers have all 64 bits. A file made by someone else needs domain and points only.
#pragma once

#include "format/notes.h"
#include "pattern/pattern.h"
#include <functional>

#include <optional>
#include <string>

namespace nook
{

inline constexpr const char* kPatternSchema = "nook.pattern/1";

std::string patternJson(const Pattern& pattern, const Recipe* recipe, const Quality& quality, const EmitContext& context);

struct PatternFile
{
	Pattern pattern;           // without weights if the file has none
	bool weights_given = true; // false: the caller computes them
	std::optional<Recipe> recipe;
	std::optional<Quality> quality; // from the file
	std::string command;            // from the file, or empty
	std::string version;
};

// `path` is for messages only. Strict: unknown fields are rejected. Throws Error (invalid_input).
PatternFile parsePatternJson(const std::string& text, const std::string& path);

// Reads a pattern file: CSV if the path ends in .csv, else JSON. A file that contradicts the expected domain is an error.
PatternFile readPattern(const std::string& path, std::optional<Domain> domain = std::nullopt);

// Checks points and weights read from a file and rounds them to 32-bit values that the measures can rely on.

// Names a sample in messages: "p.json: weights[3]", "p.csv: row 5".
using SampleName = std::function<std::string(std::size_t index)>;

// Checks one finite point of a domain and rounds it to 32-bit floats (held in doubles). Points up to 1e-6 outside the unit circle
// or ball, from other tools' rounding, are moved to the nearest floats inside; directions must have unit length within 1e-5, and z
// ≥ −1e-6 on the hemisphere. `where` is "path: element". Throws Error (invalid_input).
glm::dvec3 checkedPoint(Domain domain, const glm::dvec3& point, const std::string& where);

// Checks given finite weights: ≥ 0, sum 1 within 1e-4; rounds them to 32-bit floats.
// `where` names the list and `name_of` an entry, both starting with the path.
void checkWeights(std::vector<double>& weights, const std::string& where, const SampleName& name_of);

// Comments (#), the header x,y,half_length,weight (disk) or x,y,z,weight, then the rows; all 32-bit floats.
std::string patternCsv(const Pattern& pattern, const Quality& quality, const EmitContext& context);

// Reads what patternCsv writes and files from other tools: columns x, y, and optionally z, half_length (checked) and weight. With a
// header, columns may be in any order. Without one they are x,y; x,y,z; x,y,z,weight; or for the disk x,y,weight. The domain is
// `domain`, else that of a comment "# domain: ball", else disk for points without z and ball for points with z; directions look
// like points, so their domain must be given.
// `path` is for messages only, which name the row of the file. Throws Error (invalid_input).
PatternFile parsePatternCsv(const std::string& text, const std::string& path, std::optional<Domain> domain = std::nullopt);

} // namespace nook
