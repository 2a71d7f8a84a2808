// SPDX-License-Identifier: GPL-3.0-or-later
// A binary STL file is recognisable only by its length: 80 bytes, a count, 50 bytes per triangle. Assimp takes any other length for
// text, and then finds nothing. In text, it accepts partial numbers, a comma as decimal point, the first three corners of a facet,
// only lower case, and treats words of a solid's name as keywords.
#include "scene/mesh_text.h"

#include "scene/exact_positions.h"
#include "scene/number_text.h"
#include "scene/text_lines.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace nook
{
namespace
{

using Words = std::vector<std::string_view>;

constexpr std::size_t kHead = 84; // bytes before the first triangle

// Size of a binary file with this head.
uint64_t bytesNeeded(const std::string& bytes)
{
	uint64_t count = 0;
	for (std::size_t i = 0; i < 4; ++i)
	{
		count |= uint64_t{static_cast<unsigned char>(bytes[80 + i])} << (8U * i);
	}
	return kHead + 50 * count;
}

class TextReader
{
public:
	explicit TextReader(std::vector<std::string>& solids) : m_solids(solids) {}

	// Returns the text that replaces a line, or none to keep it.
	std::optional<std::string> take(std::string_view line, const TextPlace& place)
	{
		splitWords(line, m_words);
		if (m_words.empty())
		{
			return std::nullopt;
		}
		m_keyword = lowered(m_words[0]);
		if (m_keyword == "solid")
		{
			m_solids.push_back(m_words.size() > 1 ? textFrom(m_words, 1) : "");
			return "solid";
		}
		if (m_keyword == "vertex")
		{
			m_corners += 1;
			return numbers(1, "vertex", place);
		}
		if (m_keyword == "facet")
		{
			m_corners = 0;
			if (m_words.size() < 2 || lowered(m_words[1]) != "normal")
			{
				return "facet"; // truncated, or Assimp rejects its corners
			}
			return numbers(2, "facet normal", place);
		}
		if (m_keyword == "endfacet" && m_corners != 3)
		{
			place.fail(std::to_string(m_corners) + " corners of a facet", "3");
		}
		constexpr std::array<std::string_view, 3> kOthers{"outer", "endloop", "endfacet"};
		const bool known = std::find(kOthers.begin(), kOthers.end(), m_words[0]) != kOthers.end();
		return known ? std::nullopt : std::optional(m_keyword == "endsolid" ? m_keyword : std::string());
	}

	ExactPositions positions;

private:
	std::optional<std::string> numbers(std::size_t from, const std::string& keywords, const TextPlace& place)
	{
		if (m_words.size() != from + 3)
		{
			place.fail(std::to_string(m_words.size() - from) + " numbers", "x y z");
		}
		bool changed = m_keyword != m_words[0] || (from == 2 && m_words[1] != "normal");
		std::string plain = keywords;
		glm::dvec3 values;
		for (std::size_t i = 0; i < 3; ++i)
		{
			const std::string_view word = m_words[from + i];
			if (!isNumberText(word))
			{
				place.fail(quoted(word), "a number");
			}
			const std::string number = plainNumber(word);
			changed = changed || number != word;
			plain += " " + number;
			values[static_cast<int>(i)] = numberOf(word);
		}
		if (from == 1)
		{
			positions.add(values);
		}
		return changed ? std::optional(plain) : std::nullopt;
	}

	std::vector<std::string>& m_solids;
	Words m_words;
	std::string m_keyword; // in lower case
	int m_corners = 0;     // of the current facet
};

} // namespace

std::optional<std::string> repairedStl(const std::string& bytes, const std::string& path, std::vector<glm::dvec3>& exact,
									   std::vector<std::string>& solids)
{
	const bool has_head = bytes.size() >= kHead;
	if (has_head && bytes.size() == bytesNeeded(bytes))
	{
		return std::nullopt;
	}
	if (has_head && bytes.find('\0') < kHead) // not text; and every count below 2^24 contains a zero
	{
		const uint64_t needed = bytesNeeded(bytes);
		throw Error(ExitCode::invalid_input, path + ": header: found " + std::to_string((needed - kHead) / 50) + " triangles in " +
												 std::to_string(bytes.size()) + " bytes, expected " + std::to_string(needed) +
												 " bytes");
	}
	TextReader reader(solids);
	std::optional<std::string> repaired =
		repairedLines(bytes, path, false, [&](std::string_view line, const TextPlace& place) { return reader.take(line, place); });
	exact = reader.positions.take();
	return repaired;
}

} // namespace nook
