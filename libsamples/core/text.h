// SPDX-License-Identifier: GPL-3.0-or-later
// Formats numbers and strings for output files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// Shortest decimal that reads back as the same 32-bit float, always with a point ("1.0", "2.5e-06", "-0.0"):
// a valid literal in C, GLSL, HLSL, JSON and CSV. `value` must be finite.
std::string floatText(float value);

// Rounds to a 32-bit float first.
std::string floatText(double value);

// Likewise for 64-bit floats.
std::string doubleText(double value);

// For messages: at most `digits` significant digits.
std::string roundedText(double value, int digits);

// Rounded to that many significant digits.
double roundedNumber(double value, int digits);

// Fixed number of digits after the point, the same on every system.
std::string fixedText(double value, int digits);

// One line of UTF-8: control characters become spaces, so that outside text cannot end a comment; invalid UTF-8 becomes U+FFFD.
std::string oneLine(std::string_view text);

// Quoted and escaped for JSON; invalid UTF-8 becomes U+FFFD.
std::string jsonText(std::string_view text);

// Escaped for XML text and attributes.
std::string xmlText(std::string_view text);

// One word of a shell: quoted, and quoted only where that is needed.
std::string shellQuoted(std::string_view text);
std::string shellWord(const std::string& text);

// True for a valid identifier in C, GLSL and HLSL: letters, digits and single underscores, starting with a letter, not "gl_…".
bool isIdentifier(std::string_view name);

// Needs are rounded up and limits down, so the two never read the same.
inline std::string needText(uint64_t bytes)
{
	return std::to_string((bytes + (1U << 20U) - 1) >> 20U) + " MiB";
}

inline std::string capText(uint64_t bytes)
{
	return bytes < (uint64_t{1} << 20U) ? std::to_string(bytes) + " bytes" : std::to_string(bytes >> 20U) + " MiB";
}

// A comment of an output file.
struct Note
{
	std::string key;
	std::string value; // one line
};
using Notes = std::vector<Note>;

// One note per line after `prefix` ("// ", "# "), the command first; ends with a newline.
std::string commentBlock(const Notes& notes, std::string_view prefix);

} // namespace nook
