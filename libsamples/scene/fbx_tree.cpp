// SPDX-License-Identifier: GPL-3.0-or-later
// The binary format is inferred from files, since Autodesk has not published it. A node consists of: its end offset, the number and
// size of its values, its name, the values, its children, and after children thirteen zero bytes (25 from 7.5 on, with 64-bit
// offsets).
#include "scene/fbx.h"

#include "core/decimal.h"
#include "core/file.h"
#include "core/lists.h"
#include "core/words.h"
#include "scene/mesh_text.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace nook
{
namespace
{

constexpr std::string_view kMagic{"Kaydara FBX Binary  \0\x1a", 22};
constexpr int kMaxNesting = 64;          // maximum nesting; exporters need ten
constexpr uint64_t kMaxExpansion = 1032; // zlib's maximum: 258 bytes from two bits
constexpr uint32_t kFirstVersion = 7100;
constexpr uint32_t kLastVersion = 7999;

void checkVersion(const std::string& path, int64_t version)
{
	if (version < kFirstVersion || version > kLastVersion)
	{
		const std::string text = version < 0 || version > 99999
									 ? std::to_string(version)
									 : std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 100);
		refuseInput(path, "FBX " + text,
					"7.1 to 7.7: export it again as FBX 2011 or newer, or convert it (Autodesk FBX Converter, Blender)",
					ExitCode::unsupported);
	}
}

template <class T> T numberFrom(const char* bytes, bool big_endian)
{
	std::array<char, sizeof(T)> copy{};
	std::copy_n(bytes, sizeof(T), copy.begin());
	if (big_endian == (std::endian::native == std::endian::little))
	{
		std::reverse(copy.begin(), copy.end());
	}
	return std::bit_cast<T>(copy);
}

class BinaryParser
{
public:
	BinaryParser(const std::string& path, std::string_view bytes, bool big_endian) : m_path(path), m_bytes(bytes), m_big(big_endian)
	{
		m_at = kMagic.size() + 1;
		const auto version = take<uint32_t>("the version");
		checkVersion(path, version);
		m_wide = version >= 7500;
	}

	std::vector<FbxNode> run()
	{
		return nodes(m_bytes.size(), 0);
	}

	[[noreturn]] void fail(const std::string& found, const std::string& expected) const
	{
		refuseInput(m_path + ": byte " + std::to_string(m_at), found, expected);
	}

private:
	std::string_view takeBytes(uint64_t size, const char* what)
	{
		if (size > m_bytes.size() - m_at)
		{
			fail("the file's end", std::to_string(size) + " bytes (" + what + ")");
		}
		const std::string_view bytes = m_bytes.substr(m_at, size);
		m_at += size;
		return bytes;
	}

	template <class T> T take(const char* what)
	{
		return numberFrom<T>(takeBytes(sizeof(T), what).data(), m_big);
	}

	uint64_t takeOffset(const char* what)
	{
		return m_wide ? take<uint64_t>(what) : uint64_t{take<uint32_t>(what)};
	}

	// Reads up to the empty node that ends a list, which an inner list may lack.
	std::vector<FbxNode> nodes(uint64_t end, int depth)
	{
		std::vector<FbxNode> list;
		while (depth == 0 || m_at < end)
		{
			const std::size_t start = m_at;
			uint64_t node_end = takeOffset("a node's end");
			const uint64_t values = takeOffset("a node's number of values");
			const uint64_t values_size = takeOffset("the size of a node's values");
			const std::string_view name = takeBytes(take<uint8_t>("a name's length"), "a name");
			if (node_end == 0 && values_size == 0 && name.empty())
			{
				break;
			}
			if (node_end == 0 && values_size <= end - m_at)
			{
				node_end = m_at + values_size; // some exporters leave it out without children
			}
			if (node_end > end || node_end < m_at || values_size > node_end - m_at || values > values_size / 2)
			{
				m_at = start;
				fail("a node that ends at " + std::to_string(node_end) + " with " + std::to_string(values) + " values in " +
						 std::to_string(values_size) + " bytes",
					 "one that lies inside its parent, to byte " + std::to_string(end) + ", and holds its values");
			}
			FbxNode& node = list.emplace_back();
			node.name = name;
			const uint64_t values_end = m_at + values_size;
			node.values = listOf(values, [this](std::size_t) { return value(); });
			failIf(m_at > values_end, *this, "values that go on", "their end by byte " + std::to_string(values_end));
			m_at = values_end;
			if (m_at < node_end)
			{
				failIf(depth + 1 >= kMaxNesting, *this, "more than " + std::to_string(kMaxNesting) + " nodes within one another",
					   "fewer");
				node.children = nodes(node_end, depth + 1);
			}
			m_at = node_end;
		}
		return list;
	}

	template <class T> FbxValue number()
	{
		const T number = take<T>("a value");
		FbxValue value;
		if constexpr (std::is_floating_point_v<T>)
		{
			value.kind = FbxValue::Kind::number;
			value.number = static_cast<double>(number);
		}
		else
		{
			value.whole = number;
		}
		return value;
	}

	FbxValue value()
	{
		const char type = take<char>("a value's type");
		switch (type)
		{
		case 'B':
		case 'C': return number<uint8_t>();
		case 'Y':
		case 'Z': return number<int16_t>();
		case 'I': return number<int32_t>();
		case 'L': return number<int64_t>();
		case 'F': return number<float>();
		case 'D': return number<double>();
		case 'S':
		case 'R':
		{
			FbxValue value;
			value.kind = FbxValue::Kind::text;
			value.bytes = takeBytes(take<uint32_t>("a text's length"), "a text");
			return value;
		}
		case 'b':
		case 'c':
		case 'i':
		case 'l':
		case 'f':
		case 'd': return array(type);
		default: m_at -= 1; fail("a value of type " + std::to_string(static_cast<unsigned char>(type)), "a type of FBX");
		}
	}

	FbxValue array(char type)
	{
		FbxValue value;
		value.kind = FbxValue::Kind::array;
		value.type = type;
		value.count = take<uint32_t>("an array's length");
		const auto encoding = take<uint32_t>("an array's encoding");
		const auto size = take<uint32_t>("an array's size");
		failIf(encoding > 1, *this, "an array of encoding " + std::to_string(encoding), "0 (plain) or 1 (zlib)");
		value.compressed = encoding == 1;
		const uint64_t plain_size = value.count * sizeOf(type);
		value.bytes = takeBytes(value.compressed ? size : plain_size, "an array");
		failIf(value.compressed && plain_size > kMaxExpansion * (uint64_t{size} + 1), *this,
			   "an array of " + std::to_string(plain_size) + " bytes packed into " + std::to_string(size),
			   "as many as zlib can pack");
		return value;
	}

public:
	static uint64_t sizeOf(char type)
	{
		return type == 'd' || type == 'l' ? 8 : type == 'f' || type == 'i' ? 4 : 1;
	}

private:
	const std::string& m_path;
	std::string_view m_bytes;
	bool m_big;
	bool m_wide = false; // 64-bit offsets
	std::size_t m_at = 0;
};

constexpr std::string_view kSpaces = " \t\r\n\v\f";

// Name: value, value, ... { children }. A comment goes from a semicolon to the end of its line.
class TextParser
{
public:
	TextParser(const std::string& path, std::string_view text) : m_path(path), m_text(text) {}

	std::vector<FbxNode> run()
	{
		return nodes(0);
	}

	[[noreturn]] void fail(const std::string& found, const std::string& expected) const
	{
		const auto line = 1 + std::count(m_text.begin(), m_text.begin() + static_cast<std::ptrdiff_t>(m_at), '\n');
		refuseInput(m_path + ": line " + std::to_string(line), found, expected);
	}

private:
	void failHereIf(bool condition, const char* expected) const
	{
		if (condition)
		{
			fail(m_at >= m_text.size() ? "the file's end" : quoted(m_text.substr(m_at, m_text.find_first_of(kSpaces, m_at) - m_at)),
				 expected);
		}
	}

	// The next character that is neither blank nor comment; 0 at the end.
	char next()
	{
		for (; m_at < m_text.size(); ++m_at)
		{
			if (m_text[m_at] == ';')
			{
				m_at = std::min(m_text.find('\n', m_at), m_text.size() - 1);
			}
			else if (kSpaces.find(m_text[m_at]) == std::string_view::npos)
			{
				return m_text[m_at];
			}
		}
		return 0;
	}

	void need(char c, const char* expected)
	{
		failHereIf(next() != c, expected);
		m_at += 1;
	}

	std::string_view word()
	{
		const std::size_t start = m_at;
		m_at = std::min(m_text.find_first_of(" \t\r\n\v\f,:;{}\"*", m_at), m_text.size());
		return m_text.substr(start, m_at - start);
	}

	std::vector<FbxNode> nodes(int depth)
	{
		failIf(depth >= kMaxNesting, *this, "more than " + std::to_string(kMaxNesting) + " nodes within one another", "fewer");
		std::vector<FbxNode> list;
		for (char c = next(); c != 0 && c != '}'; c = next())
		{
			FbxNode& node = list.emplace_back();
			node.name = word();
			failHereIf(node.name.empty() || next() != ':', "the name of a node and a colon");
			m_at += 1;
			values(node);
			if (next() == '{')
			{
				m_at += 1;
				node.children = nodes(depth + 1);
				need('}', "}");
			}
		}
		failHereIf(depth == 0 && m_at < m_text.size(), "the name of a node");
		return list;
	}

	void values(FbxNode& node)
	{
		bool expected = false; // after a comma
		for (char c = next(); c != 0 && c != '{' && c != '}'; c = next())
		{
			if (c == ',')
			{
				m_at += 1;
				expected = true;
				continue;
			}
			if (!node.values.empty() && !expected)
			{
				return;
			}
			if (c == '"')
			{
				node.values.push_back(string());
			}
			else if (c == '*')
			{
				node.values.push_back(array());
				return;
			}
			else
			{
				const std::size_t start = m_at;
				const std::string_view text = word();
				if (text.empty() || next() == ':')
				{
					m_at = start; // the next node's name
					failHereIf(text.empty() || expected, "a value");
					return;
				}
				node.values.push_back(scalar(text));
			}
			expected = false;
		}
		failHereIf(expected, "a value");
	}

	FbxValue string()
	{
		const std::size_t end = m_text.find('"', m_at + 1);
		failIf(end == std::string_view::npos, *this, "a text without an end", "\"");
		FbxValue value;
		value.kind = FbxValue::Kind::text;
		value.bytes = m_text.substr(m_at + 1, end - m_at - 1);
		m_at = end + 1;
		return value;
	}

	static FbxValue scalar(std::string_view text)
	{
		FbxValue value;
		if (const std::optional<int64_t> whole = nook::numberFrom<int64_t>(text))
		{
			value.whole = *whole;
			return value;
		}
		value.kind = FbxValue::Kind::text;
		value.bytes = text;
		if (const std::optional<double> number = numberOf(text))
		{
			value.kind = FbxValue::Kind::number;
			value.number = *number;
		}
		return value;
	}

	// *3 { a: 1,2,3 }
	FbxValue array()
	{
		m_at += 1;
		const FbxValue count = scalar(word());
		failHereIf(count.kind != FbxValue::Kind::whole || count.whole < 0, "an array's length");
		FbxValue value;
		value.kind = FbxValue::Kind::array;
		value.count = static_cast<uint64_t>(count.whole);
		need('{', "{ of an array");
		if (next() != '}')
		{
			failHereIf(word() != "a", "a: of an array");
			need(':', "a: of an array");
		}
		const std::size_t end = m_text.find('}', m_at);
		failIf(end == std::string_view::npos, *this, "an array without an end", "}");
		value.bytes = m_text.substr(m_at, end - m_at);
		m_at = end + 1;
		return value;
	}

	const std::string& m_path;
	std::string_view m_text;
	std::size_t m_at = 0;
};

// ASCII files escape quotation marks and line ends.
std::string unescapedText(std::string_view text)
{
	constexpr std::array<std::pair<std::string_view, char>, 3> kEscapes{{{"&quot;", '"'}, {"&cr;", '\r'}, {"&lf;", '\n'}}};
	std::string plain;
	while (!text.empty())
	{
		const auto* const escape = firstWhere(kEscapes, [&](const auto& e) { return text.starts_with(e.first); });
		plain += escape == nullptr ? text.front() : escape->second;
		text.remove_prefix(escape == nullptr ? 1 : escape->first.size());
	}
	return plain;
}

std::string inflated(const FbxValue& value, uint64_t size)
{
	std::string plain(size, '\0');
	auto written = static_cast<uLongf>(size);
	const int result = ::uncompress(reinterpret_cast<Bytef*>(plain.data()), &written,
									reinterpret_cast<const Bytef*>(value.bytes.data()), static_cast<uLong>(value.bytes.size()));
	return result == Z_OK && written == size ? plain : std::string();
}

// The integer that a number is, if it is one.
std::optional<int64_t> wholeFrom(double number)
{
	const bool is_whole = std::fabs(number) < 0x1p53 && std::floor(number) == number;
	return is_whole ? std::optional(static_cast<int64_t>(number)) : std::nullopt;
}

} // namespace

const FbxNode* FbxNode::child(std::string_view wanted) const
{
	return firstWhere(children, [&](const FbxNode& node) { return node.name == wanted; });
}

const std::vector<FbxNode>& FbxNode::childrenOf(std::string_view wanted) const
{
	static const std::vector<FbxNode> kNothing;
	const FbxNode* const found = child(wanted);
	return found == nullptr ? kNothing : found->children;
}

std::optional<double> numberAt(const FbxNode& node, std::size_t index)
{
	if (index >= node.values.size() || node.values[index].kind > FbxValue::Kind::number)
	{
		return std::nullopt;
	}
	const FbxValue& value = node.values[index];
	return value.kind == FbxValue::Kind::whole ? static_cast<double>(value.whole) : value.number;
}

std::optional<int64_t> wholeAt(const FbxNode& node, std::size_t index)
{
	if (index < node.values.size() && node.values[index].kind == FbxValue::Kind::whole)
	{
		return node.values[index].whole; // an identifier may need all 64 bits
	}
	const std::optional<double> number = numberAt(node, index);
	return number ? wholeFrom(*number) : std::nullopt;
}

FbxFile::FbxFile(std::string of) : path(std::move(of)), m_bytes(readFile(path))
{
	if (m_bytes.starts_with(kMagic))
	{
		m_big_endian = m_bytes.size() > kMagic.size() && m_bytes[kMagic.size()] != 0;
		root.children = BinaryParser(path, m_bytes, m_big_endian).run();
		return;
	}
	is_text = true;
	constexpr std::string_view kMark = "\xEF\xBB\xBF";
	const std::string_view text = m_bytes;
	root.children = TextParser(path, text.substr(text.starts_with(kMark) ? kMark.size() : 0)).run();
	const FbxNode* const header = root.child("FBXHeaderExtension");
	const FbxNode* const version = header == nullptr ? nullptr : header->child("FBXVersion");
	const std::optional<int64_t> number = version == nullptr ? std::nullopt : wholeAt(*version, 0);
	failIf(!number, *this, "FBXHeaderExtension.FBXVersion", "nothing", "a version, as FBX files have");
	checkVersion(path, *number);
}

void FbxFile::fail(const std::string& where, const std::string& found, const std::string& expected) const
{
	refuseInput(path + ": " + where, found, expected);
}

std::string FbxFile::text(const FbxNode& node, std::size_t index) const
{
	if (index >= node.values.size() || node.values[index].kind != FbxValue::Kind::text)
	{
		return "";
	}
	const std::string_view bytes = node.values[index].bytes;
	return is_text && bytes.find('&') != std::string_view::npos ? unescapedText(bytes) : std::string(bytes);
}

std::string FbxFile::textBelow(const FbxNode& parent, std::string_view name) const
{
	const FbxNode* const node = parent.child(name);
	return node == nullptr ? "" : text(*node, 0);
}

void FbxFile::decode(const FbxValue& value, const std::string& where, const char* what, std::vector<double>& into) const
{
	const auto take = [&](std::string_view word)
	{
		const std::optional<double> number = numberOf(word);
		number ? into.push_back(*number) : fail(where, quoted(word), what);
	};
	if (value.kind == FbxValue::Kind::text)
	{
		take(value.bytes);
		return;
	}
	if (value.kind != FbxValue::Kind::array)
	{
		into.push_back(value.kind == FbxValue::Kind::whole ? static_cast<double>(value.whole) : value.number);
		return;
	}
	if (value.type == 0)
	{
		std::string_view text = value.bytes;
		const auto skip = [&]
		{
			text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n\v\f,"), text.size()));
		};
		for (skip(); !text.empty(); skip())
		{
			const std::string_view word = text.substr(0, text.find_first_of(text.front() == ';' ? "\n" : " \t\r\n\v\f,;"));
			if (word.front() != ';')
			{
				take(word);
			}
			text.remove_prefix(word.size());
		}
	}
	else
	{
		const std::size_t size = BinaryParser::sizeOf(value.type);
		const std::string plain = value.compressed ? inflated(value, value.count * size) : std::string();
		const std::string_view bytes = value.compressed ? std::string_view(plain) : value.bytes;
		failIf(bytes.size() != value.count * size, *this, where, "an array that zlib cannot unpack",
			   std::to_string(value.count) + " numbers");
		into.reserve(value.count);
		for (const char* at = bytes.data(); at != bytes.data() + bytes.size(); at += size)
		{
			switch (value.type)
			{
			case 'd': into.push_back(numberFrom<double>(at, m_big_endian)); break;
			case 'f': into.push_back(numberFrom<float>(at, m_big_endian)); break;
			case 'i': into.push_back(numberFrom<int32_t>(at, m_big_endian)); break;
			case 'l': into.push_back(static_cast<double>(numberFrom<int64_t>(at, m_big_endian))); break;
			default: into.push_back(static_cast<unsigned char>(*at)); break;
			}
		}
	}
	failIf(into.size() != value.count, *this, where, std::to_string(into.size()) + " numbers", std::to_string(value.count));
}

template <class T> std::vector<T> FbxFile::arrayOf(const FbxNode& node, const std::string& where) const
{
	constexpr bool kWhole = std::is_same_v<T, int64_t>;
	const char* const what = kWhole ? "whole numbers" : "numbers";
	std::vector<double> numbers;
	for (const FbxValue& value : node.values)
	{
		failIf(node.values.size() > 1 && value.kind == FbxValue::Kind::array, *this, where, "an array among other values",
			   "one array");
		decode(value, where, what, numbers);
	}
	if constexpr (!kWhole)
	{
		return numbers;
	}
	else
	{
		return mapped(numbers,
					  [&](double number)
					  {
						  const std::optional<int64_t> whole = wholeFrom(number);
						  return whole ? *whole : (fail(where, numberText(number), what), 0);
					  });
	}
}

template std::vector<double> FbxFile::arrayOf(const FbxNode& node, const std::string& where) const;
template std::vector<int64_t> FbxFile::arrayOf(const FbxNode& node, const std::string& where) const;

} // namespace nook
