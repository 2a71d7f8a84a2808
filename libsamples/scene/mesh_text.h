// SPDX-License-Identifier: GPL-3.0-or-later
// Parses the text formats OBJ, MTL, PLY and STL, and rewrites them so that Assimp 5.2.5 reads them correctly.
#pragma once

#include "core/error.h"
#include "core/words.h"
#include "scene/load.h"
#include "scene/load_parts.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// OBJ: Assimp counts words that start with a digit or a sign as numbers, stops at unknown characters in one, and identifies a line
// by its first letter.
//
// Returns nothing if the text can stay as it is. Throws Error (invalid_input) naming the line of an invalid number or index.
// `exact`: empty, or all positions if 32 bits are not precise enough; the text then has their numbers instead.
std::optional<std::string> repairedObj(const std::string& text, const std::string& path, std::vector<glm::dvec3>& exact);

// The position whose number Assimp read.
glm::dvec3 exactPosition(const std::vector<glm::dvec3>& exact, glm::vec3 number);

// PLY: Assimp loops forever on a truncated file, trusts counts, and loses the first byte of some files.
//
// Returns nothing if the bytes can stay as they are. Throws Error (invalid_input or unsupported) if the file is incomplete.
// `exact`: empty, or all positions in order if 32 bits are not precise enough.
std::optional<std::string> repairedPly(const std::string& bytes, const std::string& path, std::vector<glm::dvec3>& exact);

// STL.
//
// Returns nothing if the bytes can stay as they are. Throws Error (invalid_input) if a binary file's length does not match its
// count, or if text is malformed. `exact`: empty, or all positions in order if 32 bits are not precise enough. `solids`: the names
// of the solids in a text file.
std::optional<std::string> repairedStl(const std::string& bytes, const std::string& path, std::vector<glm::dvec3>& exact,
									   std::vector<std::string>& solids);

// Positions of a file with full precision, where Assimp 5.2.5 rounds to 32 bits.

class ExactPositions
{
public:
	void add(glm::dvec3 position)
	{
		for (int i = 0; i < 3; ++i)
		{
			const double length = std::fabs(position[i]);
			m_large = m_large || (length >= kLarge_m && length <= kFarthest_m);
		}
		m_positions.push_back(position);
	}

	// Returns nothing if 32 bits suffice: all coordinates are below kLarge_m units of the file.
	std::vector<glm::dvec3> take()
	{
		return m_large ? std::move(m_positions) : std::vector<glm::dvec3>();
	}

private:
	std::vector<glm::dvec3> m_positions;
	bool m_large = false;
};

// Parses numbers of text formats, with one rule for OBJ, MTL, PLY and STL: a decimal point, never a comma; no other characters.

// "1", "-.5e3", "+1.", "nan", "-inf", and the forms of Microsoft's C library: "1.#QNAN", "-nan(ind)".
bool isNumberText(std::string_view word);

// Normalises the number for Assimp 5.2.5: ".5" to "0.5", "1.#IND" to "nan". Requires isNumberText().
std::string plainNumber(std::string_view word);

// Correctly rounded to 64 bits; infinite or 0 outside their range. Requires isNumberText().
double numberOf(std::string_view word);

// A 32-bit integer, optionally with a sign and leading zeros; none for anything else.
std::optional<int> wholeOf(std::string_view word);

// A word for a message; long ones are truncated.
std::string quoted(std::string_view word);

// The line's text from the given word to the last.
std::string textFrom(const std::vector<std::string_view>& words, std::size_t first);

// Splits a line at blanks; replaces the contents of `words`.
void splitWords(std::string_view line, std::vector<std::string_view>& words);

// Iterates over the lines of a text file with any line ends, with locations for messages, and replaces some of them.

struct TextPlace
{
	const std::string& path;
	std::size_t line = 0;

	[[noreturn]] void fail(const std::string& found, const std::string& expected, ExitCode code = ExitCode::invalid_input) const
	{
		throw Error(code, path + ": line " + std::to_string(line) + ": found " + found + ", expected " + expected);
	}
};

// Calls `repair` with each line and its location; if `joins`, with lines continued by \ joined. The returned text replaces the
// line. Returns none if nothing changed.
template <class Repair>
std::optional<std::string> repairedLines(const std::string& text, const std::string& path, bool joins, const Repair& repair)
{
	std::string made;
	std::size_t copied = 0;
	std::size_t number = 0;
	const auto endOf = [&](std::size_t at)
	{
		return std::min(text.find_first_of("\r\n", at), text.size());
	};
	for (std::size_t begin = 0; begin < text.size();)
	{
		const TextPlace place{path, ++number};
		std::size_t end = endOf(begin);
		const auto after = [&]
		{
			return std::min(end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1), text.size());
		};
		while (joins && end > begin && text[end - 1] == '\\' && after() < text.size())
		{
			end = endOf(after());
			number += 1;
		}
		if (const std::optional<std::string> line = repair(std::string_view(text).substr(begin, end - begin), place))
		{
			made.append(text, copied, begin - copied);
			made += *line;
			copied = end;
		}
		begin = after();
	}
	return copied == 0 ? std::nullopt : std::optional(made.append(text, copied));
}

// Parses MTL files. Assimp 5.2.5 takes the last of d and Tr and ignores most texture options, so it only gets the names.

// Assimp ignores names of 1024 bytes and more; this is the length it gets.
inline constexpr std::size_t kMaxMaterialName = 1000;

struct MtlMaterial
{
	std::string name;        // full name
	std::optional<float> d;  // opacity, 0 to 1
	std::optional<float> tr; // 0 to 1: transparency by the specification, opacity in some programs
	MaskSource mask;         // map_d; an empty name means none
	glm::dmat3 uv_of_set{1.0};
	std::string ignored; // the first unsupported option of map_d
	std::string colour;  // map_Kd
};

using MtlMaterials = std::map<std::string, MtlMaterial>; // sorted by their truncated names

// Adds the file's materials to `materials` and returns text that declares their names to Assimp. Throws Error (invalid_input or
// unsupported) naming the line.
std::string readMtl(const std::string& text, const std::string& path, MtlMaterials& materials);

// d, else Tr interpreted by `meaning`. Sets `inverted` if Tr contradicts d, or is 1 without d and treated as opaque.
float opacityOf(const MtlMaterial& material, TrMeaning meaning, bool& inverted);

} // namespace nook
