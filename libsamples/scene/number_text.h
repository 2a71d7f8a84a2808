// SPDX-License-Identifier: GPL-3.0-or-later
// Parses numbers of text formats, with one rule for OBJ, MTL, PLY and STL: a decimal point, never a comma; no other characters.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// "1", "-.5e3", "+1.", "nan", "-inf", and the forms of Microsoft's C library: "1.#QNAN", "-nan(ind)".
bool isNumberText(std::string_view word);

// Normalises the number for Assimp 5.2.5: ".5" to "0.5", "1.#IND" to "nan". Requires isNumberText().
std::string plainNumber(std::string_view word);

// Correctly rounded to 64 bits; infinite or 0 outside their range. Requires isNumberText().
double numberOf(std::string_view word);

// A 32-bit integer, optionally with a sign and leading zeros; none for anything else.
std::optional<int> wholeOf(std::string_view word);

// True for digits with an optional sign.
bool isWholeText(std::string_view word);

// A word for a message; long ones are truncated.
std::string quoted(std::string_view word);

// Lower case, for ASCII letters.
std::string lowered(std::string_view word);

// The line's text from the given word to the last.
std::string textFrom(const std::vector<std::string_view>& words, std::size_t first);

// Splits a line at blanks; replaces the contents of `words`.
void splitWords(std::string_view line, std::vector<std::string_view>& words);

} // namespace nook
