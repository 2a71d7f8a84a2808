// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Greg Turk, "The PLY Polygon File Format", 1994.
#include "scene/mesh_text.h"

#include "core/error.h"
#include "scene/exact_positions.h"
#include "scene/load_parts.h"
#include "scene/number_text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <iterator>
#include <sstream>

namespace nook
{
namespace
{

struct Property
{
	std::size_t bytes = 0;       // size of a value, or of one in the list
	std::size_t count_bytes = 0; // size of a list's length; 0: not a list
	bool whole = false;          // values are integers
	bool has_sign = false;
	int axis = -1; // of a position
};

struct Element
{
	std::string name;
	uint64_t count = 0;
	std::vector<Property> properties;
};

struct Type
{
	std::string_view name;
	std::size_t bytes;
	bool whole;
};
constexpr std::array<Type, 16> kTypes{{{"char", 1, true},
									   {"uchar", 1, true},
									   {"short", 2, true},
									   {"ushort", 2, true},
									   {"int", 4, true},
									   {"uint", 4, true},
									   {"float", 4, false},
									   {"double", 8, false},
									   {"int8", 1, true},
									   {"uint8", 1, true},
									   {"int16", 2, true},
									   {"uint16", 2, true},
									   {"int32", 4, true},
									   {"uint32", 4, true},
									   {"float32", 4, false},
									   {"float64", 8, false}}};
constexpr std::array<std::string_view, 3> kFormats{"ascii", "binary_little_endian", "binary_big_endian"};

class PlyReader
{
public:
	PlyReader(const std::string& bytes, const std::string& path) : m_bytes(bytes), m_path(path) {}

	// Throws if the file is truncated.
	void run()
	{
		if (nextLine() != "ply")
		{
			fail("something else", "\"ply\"");
		}
		for (std::string line = nextLine(); line != "end_header"; line = nextLine())
		{
			take(line);
		}
		if (!m_has_format)
		{
			fail("no format", "the line that says it");
		}
		m_data = m_at;
		uint64_t faces = 0;
		for (const Element& element : m_elements)
		{
			if (element.count > 0 && element.properties.empty())
			{
				fail("elements '" + element.name + "' without properties", "what they are made of");
			}
			if (element.count > 0 && element.name == "tristrips")
			{
				// Assimp 5.2.5 silently makes one triangle of a strip.
				throw Error(ExitCode::unsupported, m_path + ": found triangle strips, expected faces");
			}
			const bool placed = element.name == "vertex" && std::count_if(element.properties.begin(), element.properties.end(),
																		  [](const Property& p) { return p.axis >= 0; }) == 3;
			for (uint64_t i = 0; i < element.count; ++i)
			{
				if (!skip(element))
				{
					throw Error(ExitCode::invalid_input, m_path + ": " + element.name + " " + std::to_string(i) +
															 ": found the end of the file or no list, expected " +
															 std::to_string(element.count) + " whole ones");
				}
				if (placed)
				{
					positions.add(m_position);
				}
			}
			faces += element.name == "face" ? element.count : 0;
		}
		if (faces == 0)
		{
			throw Error(ExitCode::invalid_input, m_path + ": found no triangle, expected a surface");
		}
	}

	// Start of the data if their first byte is 10 and the header's last 10 is not preceded by 13; else 0. Assimp takes that byte
	// for a second end of line and misreads everything after it.
	std::size_t lostByte() const
	{
		constexpr std::string_view kEnd = "end_header\n\n";
		return m_data > kEnd.size() && m_bytes.compare(m_data - kEnd.size() + 1, kEnd.size(), kEnd) == 0 ? m_data : 0;
	}

	ExactPositions positions;

private:
	[[noreturn]] void fail(const std::string& found, const std::string& expected) const
	{
		throw Error(ExitCode::invalid_input,
					m_path + ": header, line " + std::to_string(m_line) + ": found " + found + ", expected " + expected);
	}

	// Accepts any line end.
	std::string nextLine()
	{
		m_line += 1;
		const std::size_t end = m_bytes.find_first_of("\r\n", m_at);
		if (end == std::string::npos)
		{
			fail("no end of the header", "\"end_header\"");
		}
		const std::string line = m_bytes.substr(m_at, m_bytes.find_last_not_of(" \t", end - 1) + 1 - m_at);
		m_at = end + (m_bytes.compare(end, 2, "\r\n") == 0 ? 2 : 1);
		return line;
	}

	const Type& typeOf(const std::string& type) const
	{
		for (const Type& known : kTypes)
		{
			if (known.name == type)
			{
				return known;
			}
		}
		fail("an unknown type of number", "char, uchar, short, ushort, int, uint, float or double");
	}

	void takeFormat(const std::vector<std::string>& words)
	{
		const bool known = words.size() == 3 && std::find(kFormats.begin(), kFormats.end(), words[1]) != kFormats.end();
		if (m_has_format || !known || words[2] != "1.0")
		{
			fail(m_has_format ? "a second format" : "an unknown format",
				 "ascii, binary_little_endian or binary_big_endian, with 1.0 behind it, once");
		}
		m_has_format = true;
		m_binary = words[1] != kFormats[0];
		m_big_endian = words[1] == kFormats[2];
	}

	void take(const std::string& line)
	{
		std::istringstream stream(line);
		const std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
		if (words.empty() || words[0] == "comment" || words[0] == "obj_info")
		{
			return;
		}
		if (words[0] == "format")
		{
			takeFormat(words);
		}
		else if (words[0] == "element" && words.size() == 3)
		{
			Element& element = m_elements.emplace_back();
			element.name = words[1];
			const char* const end = words[2].data() + words[2].size();
			const auto [stop, wrong] = std::from_chars(words[2].data(), end, element.count);
			if (wrong != std::errc{} || stop != end || element.count > 3 * uint64_t{kMaxTriangles})
			{
				fail("a count that is none, or too large", "0 to " + std::to_string(3 * kMaxTriangles));
			}
		}
		else if (words[0] == "property" && !m_elements.empty() && (words.size() == 3 || (words.size() == 5 && words[1] == "list")))
		{
			Property& property = m_elements.back().properties.emplace_back();
			const Type& type = typeOf(words[words.size() - 2]);
			property.bytes = type.bytes;
			property.whole = type.whole;
			property.has_sign = !type.name.starts_with('u');
			const std::size_t axis = words.back().size() == 1 && words.size() == 3 ? std::string_view("xyz").find(words.back()) : 3;
			property.axis = axis < 3 ? static_cast<int>(axis) : -1;
			if (words.size() == 5)
			{
				property.count_bytes = typeOf(words[2]).bytes;
			}
		}
		else
		{
			fail("something else", "format, element, property, comment or end_header");
		}
	}

	// Skips one element; false if it is truncated.
	bool skip(const Element& element)
	{
		return std::all_of(element.properties.begin(), element.properties.end(),
						   [&](const Property& property) { return m_binary ? skipBinary(property) : skipText(property); });
	}

	bool skipBinary(const Property& property)
	{
		uint64_t values = 1;
		if (property.count_bytes > 0)
		{
			if (m_bytes.size() - m_at < property.count_bytes)
			{
				return false;
			}
			values = 0;
			for (std::size_t i = 0; i < property.count_bytes; ++i)
			{
				const std::size_t at = m_at + (m_big_endian ? i : property.count_bytes - 1 - i);
				values = (values << 8U) | static_cast<unsigned char>(m_bytes[at]);
			}
			m_at += property.count_bytes;
		}
		if (values > (m_bytes.size() - m_at) / property.bytes) // negative lengths become very large here
		{
			return false;
		}
		if (property.axis >= 0)
		{
			m_position[property.axis] = valueAt(property);
		}
		m_at += static_cast<std::size_t>(values) * property.bytes;
		return true;
	}

	// The current number in a binary file.
	double valueAt(const Property& property) const
	{
		uint64_t bits = 0;
		for (std::size_t i = 0; i < property.bytes; ++i)
		{
			const std::size_t at = m_at + (m_big_endian ? i : property.bytes - 1 - i);
			bits = (bits << 8U) | static_cast<unsigned char>(m_bytes[at]);
		}
		if (!property.whole)
		{
			return property.bytes == 8 ? std::bit_cast<double>(bits)
									   : static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(bits)));
		}
		const uint64_t sign = uint64_t{1} << (8 * property.bytes - 1);
		return static_cast<double>(property.has_sign ? static_cast<int64_t>((bits ^ sign) - sign) : static_cast<int64_t>(bits));
	}

	bool skipText(const Property& property)
	{
		uint64_t values = 1;
		if (property.count_bytes > 0)
		{
			const std::string_view word = nextWord();
			const auto [stop, wrong] = std::from_chars(word.data(), word.data() + word.size(), values);
			if (wrong != std::errc{} || stop != word.data() + word.size())
			{
				return false;
			}
		}
		for (; values > 0; --values)
		{
			const std::string_view word = nextWord();
			if (word.empty())
			{
				return false;
			}
			if (property.whole ? !isWholeText(word) : !isNumberText(word))
			{
				throw Error(ExitCode::invalid_input, m_path + ": byte " + std::to_string(m_at - word.size()) + ": found " +
														 quoted(word) + ", expected a " + (property.whole ? "whole " : "") +
														 "number");
			}
			if (property.axis >= 0)
			{
				m_position[property.axis] = numberOf(word);
			}
		}
		return true;
	}

	std::string_view nextWord()
	{
		const auto blank = [&]
		{
			return m_bytes[m_at] == ' ' || (m_bytes[m_at] >= '\t' && m_bytes[m_at] <= '\r');
		};
		while (m_at < m_bytes.size() && blank())
		{
			++m_at;
		}
		const std::size_t begin = m_at;
		while (m_at < m_bytes.size() && !blank())
		{
			++m_at;
		}
		return std::string_view(m_bytes).substr(begin, m_at - begin);
	}

	const std::string& m_bytes;
	const std::string& m_path;
	std::vector<Element> m_elements;
	glm::dvec3 m_position{0.0}; // of the current vertex
	std::size_t m_data = 0;     // start of the data
	std::size_t m_at = 0;
	std::size_t m_line = 0;
	bool m_has_format = false;
	bool m_binary = false;
	bool m_big_endian = false;
};

} // namespace

std::optional<std::string> repairedPly(const std::string& bytes, const std::string& path, std::vector<glm::dvec3>& exact)
{
	PlyReader reader(bytes, path);
	reader.run();
	exact = reader.positions.take();
	const std::size_t lost = reader.lostByte();
	return lost == 0 ? std::nullopt : std::optional(std::string(bytes).insert(lost - 1, 1, '\r'));
}

} // namespace nook
