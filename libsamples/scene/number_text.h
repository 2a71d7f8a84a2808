// SPDX-License-Identifier: GPL-3.0-or-later
// Words of a text format as numbers, by one rule for OBJ, MTL, PLY and STL: a point, never a comma; nothing before or behind.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// "1", "-.5e3", "+1.", "nan", "-inf", and what Microsoft's C library writes for these: "1.#QNAN", "-nan(ind)".
bool isNumberText(std::string_view word);

// The same as Assimp 5.2.5 takes it: ".5" as "0.5", "1.#IND" as "nan". Requires isNumberText().
std::string plainNumber(std::string_view word);

// Its value, to the last of 64 bits; infinite or 0 beyond their range. Requires isNumberText().
double numberOf(std::string_view word);

// A whole number that 32 bits hold, with or without a sign and leading zeros; none where it is anything else.
std::optional<int> wholeOf(std::string_view word);

// Digits with or without a sign.
bool isWholeText(std::string_view word);

// A word for a message; a long one is cut.
std::string quoted(std::string_view word);

// In lower case, of ASCII letters.
std::string lowered(std::string_view word);

// A line's text from one of its words to the last.
std::string textFrom(const std::vector<std::string_view>& words, std::size_t first);

// The words of a line, blanks between them, in place of what `words` held.
void splitWords(std::string_view line, std::vector<std::string_view>& words);

} // namespace nook
