// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Wavefront Technologies, Advanced Visualizer manual, appendix B1, Object Files (.obj), and the MTL format
// beside it.
#include "scene/mesh_text.h"

#include "scene/exact_positions.h"
#include "scene/mtl_text.h"
#include "scene/number_text.h"
#include "scene/text_lines.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace nook
{
namespace
{

using Words = std::vector<std::string_view>;

std::string joined(const Words& words, const std::vector<std::string>& rest)
{
	std::string line(words[0]);
	for (const std::string& word : rest)
	{
		line += " " + word;
	}
	return line;
}

// For v, vt and vn. A colour after a position is kept if it has three numbers and removed if it has four.
std::optional<std::string> repairedNumbers(Words& words, const TextPlace& place)
{
	bool changed = false;
	const auto comment = std::find_if(words.begin(), words.end(), [](std::string_view word) { return word.starts_with('#'); });
	if (comment != words.end())
	{
		words.erase(comment, words.end());
		changed = true;
	}
	std::vector<std::string> numbers;
	for (std::size_t i = 1; i < words.size(); ++i)
	{
		if (!isNumberText(words[i]))
		{
			place.fail(quoted(words[i]), "a number");
		}
		numbers.push_back(plainNumber(words[i]));
		changed = changed || numbers.back() != words[i];
	}
	const std::size_t count = numbers.size();
	if (words[0] == "v" && count != 3 && count != 4 && count != 6 && count != 7)
	{
		place.fail(std::to_string(count) + " numbers", "x y z, a weight behind them or a colour");
	}
	if ((words[0] == "vn" && count != 3) || (words[0] == "vt" && (count < 1 || count > 3)))
	{
		place.fail(std::to_string(count) + " numbers", words[0] == "vn" ? "x y z" : "u, u v or u v w");
	}
	if (count == 7 || (words[0] == "vt" && count == 1))
	{
		numbers.resize(words[0] == "v" ? 3 : 2, "0");
		changed = true;
	}
	return changed ? std::optional(joined(words, numbers)) : std::nullopt;
}

// "1", "1/2", "1//3" or "1/2/3", without signs and leading zeros.
std::string plainCorner(std::string_view word, const TextPlace& place)
{
	std::string plain;
	std::size_t parts = 0;
	for (std::size_t begin = 0; begin <= word.size(); ++parts)
	{
		const std::size_t end = std::min(word.find('/', begin), word.size());
		const std::string_view part = word.substr(begin, end - begin);
		const std::optional<int> index = wholeOf(part);
		if (parts > 2 || (!index && (parts == 0 || !part.empty())))
		{
			place.fail(quoted(word), "an index, or two or three with / between them");
		}
		plain += (parts > 0 ? "/" : "") + (index ? std::to_string(*index) : std::string());
		begin = end + 1;
	}
	return plain.substr(0, plain.find_last_not_of('/') + 1);
}

// For f, l and p.
std::optional<std::string> repairedCorners(const Words& words, const TextPlace& place)
{
	bool changed = false;
	std::vector<std::string> corners;
	for (std::size_t i = 1; i < words.size() && !words[i].starts_with('#'); ++i)
	{
		corners.push_back(plainCorner(words[i], place));
		changed = changed || corners.back() != words[i];
	}
	changed = changed || corners.size() + 1 < words.size();
	return changed ? std::optional(joined(words, corners)) : std::nullopt;
}

// Returns the text that replaces a line, or none to keep it.
std::optional<std::string> repairedObjLine(std::string_view line, Words& words, const TextPlace& place)
{
	constexpr std::array<std::string_view, 6> kOthers{"g", "o", "s", "usemtl", "mtllib", "mg"};
	const std::string_view keyword = words[0];
	std::optional<std::string> repaired;
	if (keyword == "v" || keyword == "vt" || keyword == "vn")
	{
		repaired = repairedNumbers(words, place);
	}
	else if (keyword == "usemtl" && line.size() > kMaxMaterialName)
	{
		return "usemtl " + (words.size() > 1 ? textFrom(words, 1).substr(0, kMaxMaterialName) : "");
	}
	else if (keyword == "f" || keyword == "l" || keyword == "p")
	{
		repaired = repairedCorners(words, place);
	}
	else if (std::find(kOthers.begin(), kOthers.end(), keyword) == kOthers.end())
	{
		return ""; // including curves and surfaces, which are not supported
	}
	const auto indent = static_cast<std::size_t>(keyword.data() - line.data());
	return repaired || indent == 0 ? repaired : std::optional(std::string(line.substr(indent)));
}

// Joins lines continued by a final \ into `made`; a single line is returned unchanged.
std::string_view onOneLine(std::string_view line, std::string& made)
{
	if (line.find_first_of("\r\n") == std::string_view::npos)
	{
		return line;
	}
	made = line;
	for (std::size_t at = made.find_first_of("\r\n"); at != std::string::npos; at = made.find_first_of("\r\n", at))
	{
		made[at] = ' ';
		made[at - 1] = made[at - 1] == '\\' ? ' ' : made[at - 1];
	}
	return made;
}

// x y z of a line's numbers, divided by the weight if there is one.
glm::dvec3 pointOf(const Words& words, const TextPlace& place)
{
	std::array<double, 4> numbers{0.0, 0.0, 0.0, 1.0};
	const bool has_weight = words.size() == 5;
	for (std::size_t i = 0; i < (has_weight ? 4 : 3); ++i)
	{
		numbers[i] = numberOf(words[i + 1]);
	}
	if (numbers[3] == 0.0)
	{
		place.fail("a weight of 0", "another");
	}
	return glm::dvec3(numbers[0], numbers[1], numbers[2]) / numbers[3];
}

// Replaces each position with its number, for exactPosition().
std::optional<std::string> numbered(const std::string& text, const std::string& path)
{
	uint32_t count = 0;
	const auto replaced = [&](std::string_view line, const TextPlace& /*place*/) -> std::optional<std::string>
	{
		if (line.size() < 2 || line[0] != 'v' || line[1] == 't' || line[1] == 'n')
		{
			return std::nullopt;
		}
		const uint32_t number = count++;
		return "v " + std::to_string(number & 0xffffU) + " " + std::to_string(number >> 16U) + " 0";
	};
	return repairedLines(text, path, true, replaced);
}

} // namespace

std::optional<std::string> repairedObj(const std::string& text, const std::string& path, std::vector<glm::dvec3>& exact)
{
	Words words;
	std::string one;
	ExactPositions positions;
	const auto repair = [&](std::string_view line, const TextPlace& place) -> std::optional<std::string>
	{
		line = onOneLine(line, one);
		splitWords(line, words);
		if (words.empty() || words[0].starts_with('#'))
		{
			return std::nullopt;
		}
		std::optional<std::string> repaired = repairedObjLine(line, words, place);
		if (words[0] == "v")
		{
			positions.add(pointOf(words, place));
		}
		return repaired;
	};
	std::optional<std::string> repaired = repairedLines(text, path, true, repair);
	exact = positions.take();
	return exact.empty() ? repaired : numbered(repaired ? *repaired : text, path);
}

glm::dvec3 exactPosition(const std::vector<glm::dvec3>& exact, glm::vec3 number)
{
	return exact.at(static_cast<std::size_t>(number.x) + (static_cast<std::size_t>(number.y) << 16U));
}

} // namespace nook
