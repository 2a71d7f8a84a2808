// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/drawing.h"

#include <algorithm>
#include <array>

namespace nook
{
namespace
{

constexpr double kUnit = 0.7 / 6.0; // size of a grid unit; capitals are six units high
constexpr double kSpacing = 1.9;    // units between characters
constexpr double kSpace = 2.0;      // width of a blank in units
constexpr int kBaseline = 2;        // grid row

struct Glyph
{
	char character;
	const char* strokes; // pairs of digits: x and y on the grid; blanks separate strokes
};

constexpr std::array kGlyphs{
	Glyph{'a', "4642 4536160503123243"},
	Glyph{'b', "0802 0516364543321203"},
	Glyph{'c', "4536160503123243"},
	Glyph{'d', "4842 4536160503123243"},
	Glyph{'e', "04444536160503123243"},
	Glyph{'f', "38281712 0636"},
	Glyph{'g', "46413010 4536160503123243"},
	Glyph{'h', "0802 0516364542"},
	Glyph{'i', "0602 08"},
	Glyph{'j', "161100 18"},
	Glyph{'k', "0802 3603 1432"},
	Glyph{'l', "0802"},
	Glyph{'m', "0602 0516263532 3546566562"},
	Glyph{'n', "0602 0516364542"},
	Glyph{'o', "160503123243453616"},
	Glyph{'p', "0600 0516364543321203"},
	Glyph{'q', "4640 4536160503123243"},
	Glyph{'r', "0602 051636"},
	Glyph{'s', "45361605143443321203"},
	Glyph{'t', "18132232 0636"},
	Glyph{'u', "0603123243 4642"},
	Glyph{'v', "062246"},
	Glyph{'w', "0612365266"},
	Glyph{'x', "0642 4602"},
	Glyph{'y', "0622 4610"},
	Glyph{'z', "06460242"},
	Glyph{'0', "180703123243473818"},
	Glyph{'1', "062822"},
	Glyph{'2', "07183847460242"},
	Glyph{'3', "07183847463515 354443321203"},
	Glyph{'4', "32380444"},
	Glyph{'5', "480805354443321203"},
	Glyph{'6', "473818070312324344351504"},
	Glyph{'7', "084812"},
	Glyph{'8', "15060718384746351504031232434435"},
	Glyph{'9', "031232434738180706153546"},
	Glyph{'.', "02"},
	Glyph{',', "1201"},
	Glyph{':', "05 02"},
	Glyph{'-', "0535"},
	Glyph{'+', "0545 2327"},
	Glyph{'=', "0646 0444"},
	Glyph{'_', "0141"},
	Glyph{'/', "0238"},
	Glyph{'(', "18060412"},
	Glyph{')', "08161402"},
	Glyph{'%', "0248 0818170708 3343423233"},
};

const char* formOf(char c)
{
	const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
	const auto found = std::find_if(kGlyphs.begin(), kGlyphs.end(), [&](const Glyph& glyph) { return glyph.character == lower; });
	return found == kGlyphs.end() ? "" : found->strokes;
}

// Adds the character's strokes at x (units) and returns its width.
double addGlyph(const char* form, double x, std::vector<Stroke>& strokes)
{
	if (*form == '\0')
	{
		return kSpace;
	}
	double width = 0.0;
	strokes.emplace_back();
	for (; *form != '\0'; form += *form == ' ' ? 1 : 2)
	{
		if (*form == ' ')
		{
			strokes.emplace_back();
			continue;
		}
		const double right = form[0] - '0';
		const double up = form[1] - '0' - kBaseline;
		width = std::max(width, right);
		strokes.back().emplace_back((x + right) * kUnit, -up * kUnit);
	}
	return width;
}

} // namespace

std::vector<Stroke> strokesOf(std::string_view text)
{
	std::vector<Stroke> strokes;
	double x = 0.0;
	for (const char c : text)
	{
		x += addGlyph(formOf(c), x, strokes) + kSpacing;
	}
	return strokes;
}

double strokeWidthOf(std::string_view text)
{
	std::vector<Stroke> ignored;
	double x = 0.0;
	for (const char c : text)
	{
		x += addGlyph(formOf(c), 0.0, ignored) + kSpacing;
	}
	return std::max(0.0, x - kSpacing) * kUnit;
}

} // namespace nook
