// SPDX-License-Identifier: GPL-3.0-or-later
// An STL file, before Assimp 5.2.5 reads it. A binary one says nothing of itself but its length: 80 bytes, a count, 50 bytes for
// each triangle; Assimp takes any other length for text, and then finds nothing. Of text, it takes what it can of a number, a comma
// for a point, and the first three corners of a facet.
#include "scene/load_parts.h"

#include "core/error.h"
#include "core/file.h"
#include "scene/number_text.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace nook
{
namespace
{

using Words = std::vector<std::string_view>;

// Bytes that a binary file with this head has.
uint64_t bytesNeeded(const std::array<char, 84>& head)
{
	uint64_t count = 0;
	for (std::size_t i = 0; i < 4; ++i)
	{
		count |= uint64_t{static_cast<unsigned char>(head[80 + i])} << (8U * i);
	}
	return head.size() + 50 * count;
}

class TextChecker
{
public:
	explicit TextChecker(const std::string& path) : m_path(path) {}

	void run()
	{
		const std::string text = readFile(m_path);
		Words words;
		for (std::size_t begin = 0; begin < text.size();)
		{
			const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
			m_line += 1;
			splitWords(std::string_view(text).substr(begin, end - begin), words);
			take(words);
			begin = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
		}
	}

private:
	[[noreturn]] void fail(const std::string& found, const std::string& expected) const
	{
		throw Error(ExitCode::invalid_input,
					m_path + ": line " + std::to_string(m_line) + ": found " + found + ", expected " + expected);
	}

	void take(const Words& words)
	{
		if (words.empty())
		{
			return;
		}
		if (words[0] == "vertex")
		{
			numbers(words, 1);
			m_corners += 1;
		}
		else if (words[0] == "facet" && words.size() > 1 && words[1] == "normal")
		{
			numbers(words, 2);
			m_corners = 0;
		}
		else if (words[0] == "endfacet" && m_corners != 3)
		{
			fail(std::to_string(m_corners) + " corners of a facet", "3");
		}
	}

	void numbers(const Words& words, std::size_t from) const
	{
		if (words.size() != from + 3)
		{
			fail(std::to_string(words.size() - from) + " numbers", "x y z");
		}
		const auto odd = std::find_if_not(words.begin() + static_cast<std::ptrdiff_t>(from), words.end(), isNumberText);
		if (odd != words.end())
		{
			fail(quoted(*odd), "a number");
		}
	}

	const std::string& m_path;
	std::size_t m_line = 0;
	int m_corners = 0; // of the facet at hand
};

} // namespace

void checkStl(const std::string& path)
{
	std::array<char, 84> head{};
	std::ifstream stream(path, std::ios::binary);
	const bool whole = static_cast<bool>(stream.read(head.data(), head.size()));
	std::error_code failed;
	const std::uintmax_t size = std::filesystem::file_size(path, failed);
	if (failed || (whole && size == bytesNeeded(head)))
	{
		return;
	}
	if (whole && std::find(head.begin(), head.end(), '\0') != head.end()) // no text; and no count below 2^24 is without a zero
	{
		const uint64_t needed = bytesNeeded(head);
		throw Error(ExitCode::invalid_input, path + ": header: found " + std::to_string((needed - head.size()) / 50) +
												 " triangles in " + std::to_string(size) + " bytes, expected " +
												 std::to_string(needed) + " bytes");
	}
	TextChecker(path).run();
}

} // namespace nook
