// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/mesh_text.h"

#include "core/decimal.h"

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <limits>
#include <sstream>

namespace nook
{
namespace
{

std::string_view withoutSign(std::string_view word)
{
	return word.starts_with('-') || word.starts_with('+') ? word.substr(1) : word;
}

// "nan" or "inf" without a sign; empty for any other word.
std::string_view notFinite(std::string_view unsigned_word)
{
	const std::string word = lowered(unsigned_word);
	if (word.starts_with("1.#inf") || word == "inf" || word == "infinity")
	{
		return "inf";
	}
	const bool microsoft =
		word.starts_with("1.#qnan") || word.starts_with("1.#snan") || word.starts_with("1.#nan") || word.starts_with("1.#ind");
	return microsoft || word == "nan" || (word.starts_with("nan(") && word.ends_with(")")) ? "nan" : "";
}

std::size_t digitsAt(std::string_view word, std::size_t at)
{
	return std::min(word.find_first_not_of("0123456789", at), word.size()) - std::min(at, word.size());
}

} // namespace

bool isNumberText(std::string_view word)
{
	word = withoutSign(word);
	const std::size_t whole = digitsAt(word, 0);
	std::size_t at = whole;
	std::size_t broken = 0;
	if (at < word.size() && word[at] == '.')
	{
		broken = digitsAt(word, at + 1);
		at += 1 + broken;
	}
	if (whole + broken > 0 && at < word.size() && (word[at] == 'e' || word[at] == 'E'))
	{
		const bool has_sign = at + 1 < word.size() && (word[at + 1] == '-' || word[at + 1] == '+');
		const std::size_t digits = digitsAt(word, at + (has_sign ? 2 : 1));
		at += digits > 0 ? (has_sign ? 2 : 1) + digits : 0;
	}
	return (whole + broken > 0 && at == word.size()) || !notFinite(word).empty();
}

std::string plainNumber(std::string_view word)
{
	const std::string_view rest = withoutSign(word);
	const std::string sign(word.starts_with('-') ? "-" : "");
	if (const std::string_view odd = notFinite(rest); !odd.empty())
	{
		return sign + std::string(odd);
	}
	return rest.starts_with('.') ? sign + "0" + std::string(rest) : std::string(word);
}

double numberOf(std::string_view word)
{
	const double sign = word.starts_with('-') ? -1.0 : 1.0;
	const std::string_view rest = withoutSign(word);
	if (const std::string_view odd = notFinite(rest); !odd.empty())
	{
		return odd == "inf" ? sign * std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
	}
	double value = 0.0;
	if (readDecimal(rest.data(), rest.data() + rest.size(), value).ec == std::errc::result_out_of_range)
	{
		const std::size_t exponent = rest.find_first_of("eE");
		const bool small = exponent == std::string_view::npos ? rest.find_first_not_of('0') == rest.find('.')
															  : rest.substr(exponent + 1).starts_with('-');
		value = small ? 0.0 : std::numeric_limits<double>::infinity();
	}
	return sign * value;
}

std::string textFrom(const std::vector<std::string_view>& words, std::size_t first)
{
	return {words[first].data(), words.back().data() + words.back().size()};
}

std::string quoted(std::string_view word)
{
	constexpr std::size_t kMost = 40;
	return "'" + std::string(word.substr(0, kMost)) + (word.size() > kMost ? "...'" : "'");
}

std::optional<int> wholeOf(std::string_view word)
{
	int value = 0;
	const bool positive = word.starts_with('+') && !word.starts_with("+-");
	const char* const end = word.data() + word.size();
	const auto [stop, wrong] = std::from_chars(word.data() + (positive ? 1 : 0), end, value);
	return wrong == std::errc{} && stop == end ? std::optional(value) : std::nullopt;
}

void splitWords(std::string_view line, std::vector<std::string_view>& words)
{
	constexpr std::string_view kBlanks = " \t\r\n\v\f";
	words.clear();
	for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;)
	{
		const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
		words.push_back(line.substr(at, end - at));
		at = line.find_first_not_of(kBlanks, end);
	}
}

// This work is based on: Greg Turk, "The PLY Polygon File Format", 1994.

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

// Digits with an optional sign.
bool isWholeText(std::string_view word)
{
	const std::string_view digits = withoutSign(word);
	return !digits.empty() && digitsAt(digits, 0) == digits.size();
}

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
				refuseInput(m_path, "triangle strips", "faces", ExitCode::unsupported);
			}
			const bool placed = element.name == "vertex" && std::count_if(element.properties.begin(), element.properties.end(),
																		  [](const Property& p) { return p.axis >= 0; }) == 3;
			for (uint64_t i = 0; i < element.count; ++i)
			{
				if (!skip(element))
				{
					refuseInput(m_path + ": " + element.name + " " + std::to_string(i), "the end of the file or no list",
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
			refuseInput(m_path, "no triangle", "a surface");
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
		refuseInput(m_path + ": header, line " + std::to_string(m_line), found, expected);
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
		const auto* const known = std::find_if(kTypes.begin(), kTypes.end(), [&](const Type& one) { return one.name == type; });
		if (known == kTypes.end())
		{
			fail("an unknown type of number", "char, uchar, short, ushort, int, uint, float or double");
		}
		return *known;
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
			values = bitsOf(property.count_bytes);
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

	// The current number in a binary file: its bits, and its value.
	uint64_t bitsOf(std::size_t size) const
	{
		uint64_t bits = 0;
		for (std::size_t i = 0; i < size; ++i)
		{
			bits = (bits << 8U) | static_cast<unsigned char>(m_bytes[m_at + (m_big_endian ? i : size - 1 - i)]);
		}
		return bits;
	}

	double valueAt(const Property& property) const
	{
		const uint64_t bits = bitsOf(property.bytes);
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

// A binary STL file is recognisable only by its length: 80 bytes, a count, 50 bytes per triangle. Assimp takes any other length for
// text, and then finds nothing. In text, it accepts partial numbers, a comma as decimal point, the first three corners of a facet,
// only lower case, and treats words of a solid's name as keywords.

namespace
{

using Words = std::vector<std::string_view>;

constexpr std::size_t kHead = 84; // bytes before the first triangle

// Size of a binary file with this head.
uint64_t bytesNeeded(const std::string& bytes)
{
	return kHead + 50 * littleEndian(bytes, 80, 4);
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
		refuseInput(path + ": header",
					std::to_string((needed - kHead) / 50) + " triangles in " + std::to_string(bytes.size()) + " bytes",
					std::to_string(needed) + " bytes");
	}
	TextReader reader(solids);
	std::optional<std::string> repaired =
		repairedLines(bytes, path, false, [&](std::string_view line, const TextPlace& place) { return reader.take(line, place); });
	exact = reader.positions.take();
	return repaired;
}

} // namespace nook
