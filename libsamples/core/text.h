// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and strings → the text of the emitted formats.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// The shortest decimal that reads back as the same 32-bit float, always with a point ("1.0", "2.5e-06", "-0.0"):
// a valid literal of C, GLSL, HLSL, JSON and CSV. value must be finite.
std::string floatText(float value);

// The value rounded to a 32-bit float, the same way.
std::string floatText(double value);

// The same for all 64 bits.
std::string doubleText(double value);

// For people: at most `digits` significant digits.
std::string roundedText(double value, int digits);

// To that many significant digits.
double roundedNumber(double value, int digits);

// With a fixed number of digits after the point, the same on every system.
std::string fixedText(double value, int digits);

// One line of UTF-8: control characters become spaces, so that text from outside cannot end a comment; bytes that are no UTF-8
// become U+FFFD.
std::string oneLine(std::string_view text);

// Quoted and escaped for JSON; bytes that are not UTF-8 become U+FFFD.
std::string jsonText(std::string_view text);

// Escaped for XML text and attributes.
std::string xmlText(std::string_view text);

// A name as C, GLSL and HLSL all take it: letters, digits and single underscores, a letter first, not "gl_…".
bool isIdentifier(std::string_view name);

} // namespace nook
