// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/mesh_text.h"

#include "core/decimal.h"
#include "core/file.h"
#include "core/lists.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>

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

bool isBlank(char c)
{
	return c == ' ' || (c >= '\t' && c <= '\r');
}

struct Property
{
	std::size_t bytes = 0;       // size of a value, or of one in the list
	std::size_t count_bytes = 0; // size of a list's length; 0: not a list
	bool whole = false;          // values are integers
	bool has_sign = false;
	std::size_t slot = SIZE_MAX; // of a vertex's number in kSlots
	bool indices = false;        // a list of vertices
};

struct Element
{
	std::string name;
	uint64_t count = 0;
	std::vector<Property> properties;

	bool has(std::size_t first_slot, std::size_t last_slot) const
	{
		return std::any_of(properties.begin(), properties.end(),
						   [&](const Property& p) { return p.slot >= first_slot && p.slot <= last_slot; });
	}
};

struct Type
{
	std::string_view names;
	std::size_t bytes;
	bool whole;
};
constexpr std::array<Type, 8> kTypes{{{"char int8", 1, true},
									  {"uchar uint8", 1, true},
									  {"short int16", 2, true},
									  {"ushort uint16", 2, true},
									  {"int int32", 4, true},
									  {"uint uint32", 4, true},
									  {"float float32", 4, false},
									  {"double float64", 8, false}}};
constexpr std::array<std::string_view, 3> kFormats{"ascii", "binary_little_endian", "binary_big_endian"};

// Names of the numbers of a vertex: position, normal, texture coordinates, colour.
constexpr std::array<std::string_view, 11> kSlots{"x",   "y",     "z",   "nx", "ny", "nz", "u s tx texture_u", "v t ty texture_v",
												  "red", "green", "blue"};

bool hasWord(std::string_view words, std::string_view word)
{
	return (" " + std::string(words) + " ").find(" " + std::string(word) + " ") != std::string::npos;
}

class PlyReader
{
public:
	PlyReader(const std::string& bytes, const std::string& path) : m_bytes(bytes), m_path(path) {}

	MeshFile run()
	{
		MtlMaterial& material = m_file.materials.list[m_file.materials.number("")];
		material.two_sided = true; // the format does not define the winding
		header(material);
		m_file.meshes.emplace_back();
		for (const Element& element : m_elements)
		{
			refuseInputIf(element.count > 0 && element.properties.empty(), headerPlace(),
						  "elements '" + element.name + "' without properties", "what they are made of");
			for (uint64_t i = 0; i < element.count; ++i)
			{
				m_list.clear();
				if (!std::all_of(element.properties.begin(), element.properties.end(),
								 [&](const Property& property) { return read(property); }))
				{
					refuseInput(m_path + ": " + element.name + " " + std::to_string(i), "the end of the file or no list",
								std::to_string(element.count) + " whole ones");
				}
				take(element);
			}
		}
		return std::move(m_file);
	}

private:
	std::string headerPlace() const
	{
		return m_path + ": header, line " + std::to_string(m_line);
	}

	void header(MtlMaterial& material)
	{
		refuseInputIf(nextLine() != "ply", headerPlace(), "something else", "\"ply\"");
		for (std::string line = nextLine(); line != "end_header"; line = nextLine())
		{
			takeHeader(line, material);
		}
		refuseInputIf(!m_has_format, headerPlace(), "no format", "the line that says it");
	}

	// Accepts any line end.
	std::string nextLine()
	{
		m_line += 1;
		const std::size_t end = m_bytes.find_first_of("\r\n", m_at);
		refuseInputIf(end == std::string::npos, headerPlace(), "no end of the header", "\"end_header\"");
		const std::string line = m_bytes.substr(m_at, m_bytes.find_last_not_of(" \t", end - 1) + 1 - m_at);
		m_at = end + (m_bytes.compare(end, 2, "\r\n") == 0 ? 2 : 1);
		return line;
	}

	const Type& typeOf(std::string_view type) const
	{
		const auto* const known = firstWhere(kTypes, [&](const Type& one) { return hasWord(one.names, type); });
		refuseInputIf(known == nullptr, headerPlace(), "an unknown type of number",
					  "char, uchar, short, ushort, int, uint, float or double");
		return *known;
	}

	void takeFormat(const std::vector<std::string_view>& words)
	{
		const bool known = words.size() == 3 && std::find(kFormats.begin(), kFormats.end(), words[1]) != kFormats.end();
		refuseInputIf(m_has_format || !known || words[2] != "1.0", headerPlace(),
					  m_has_format ? "a second format" : "an unknown format",
					  "ascii, binary_little_endian or binary_big_endian, with 1.0 behind it, once");
		m_has_format = true;
		m_binary = words[1] != kFormats[0];
		m_big_endian = words[1] == kFormats[2];
	}

	void takeHeader(const std::string& line, MtlMaterial& material)
	{
		std::vector<std::string_view> words;
		splitWords(line, words);
		if (words.empty() || words[0] == "comment" || words[0] == "obj_info")
		{
			if (words.size() > 2 && words[1] == "TextureFile")
			{
				material.picture.name = textFrom(words, 2);
			}
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
			element.count = nook::numberFrom<uint64_t>(words[2]).value_or(UINT64_MAX);
			refuseInputIf(element.count > 3 * uint64_t{kMaxTriangles}, headerPlace(), "a count that is none, or too large",
						  "0 to " + std::to_string(3 * kMaxTriangles));
		}
		else if (words[0] == "property" && !m_elements.empty() && (words.size() == 3 || (words.size() == 5 && words[1] == "list")))
		{
			Property& property = m_elements.back().properties.emplace_back();
			const Type& type = typeOf(words[words.size() - 2]);
			property.bytes = type.bytes;
			property.whole = type.whole;
			property.has_sign = !words[words.size() - 2].starts_with('u');
			const std::string_view name = words.back();
			if (words.size() == 5)
			{
				property.count_bytes = typeOf(words[2]).bytes;
				property.indices = name == "vertex_index" || name == "vertex_indices";
				return;
			}
			const auto* const slot =
				std::find_if(kSlots.begin(), kSlots.end(), [&](std::string_view names) { return hasWord(names, name); });
			property.slot = m_elements.back().name == "vertex" ? static_cast<std::size_t>(slot - kSlots.begin()) : kSlots.size();
		}
		else
		{
			refuseInput(headerPlace(), "something else", "format, element, property, comment or end_header");
		}
	}

	// Reads a number or a list; false if it is truncated.
	bool read(const Property& property)
	{
		uint64_t values = 1;
		if ((property.count_bytes > 0 && !count(property.count_bytes, values)) ||
			(m_binary && values > (m_bytes.size() - m_at) / property.bytes)) // negative lengths become very large here
		{
			return false;
		}
		for (; values > 0; --values)
		{
			double value = 0.0;
			if (m_binary)
			{
				value = valueAt(property);
				m_at += property.bytes;
			}
			else if (!word(property, value))
			{
				return false;
			}
			if (property.indices)
			{
				m_list.push_back(value >= 0.0 && value < kNone ? static_cast<uint32_t>(value) : kNone);
			}
			else if (property.slot < kSlots.size())
			{
				const bool scaled = property.slot >= kFirstColour && property.whole;
				m_numbers[property.slot] = scaled ? value / (std::exp2(8.0 * static_cast<double>(property.bytes)) - 1.0) : value;
			}
		}
		return true;
	}

	bool count(std::size_t bytes, uint64_t& values)
	{
		if (!m_binary)
		{
			const std::optional<uint64_t> number = nook::numberFrom<uint64_t>(nextWord());
			values = number.value_or(0);
			return number.has_value();
		}
		const bool whole = m_bytes.size() - m_at >= bytes;
		values = whole ? bitsOf(bytes) : 0;
		m_at += whole ? bytes : 0;
		return whole;
	}

	// A number of a text file; false at the end.
	bool word(const Property& property, double& value)
	{
		const std::string_view text = nextWord();
		const bool digits = withoutSign(text).find_first_not_of("0123456789") == std::string_view::npos;
		const std::optional<double> number = !property.whole || digits ? numberOf(text) : std::nullopt;
		if (!text.empty() && !number)
		{
			refuseInput(m_path + ": byte " + std::to_string(m_at - text.size()), quoted(text),
						std::string("a ") + (property.whole ? "whole " : "") + "number");
		}
		value = number.value_or(0.0);
		return number.has_value();
	}

	// Adds the current vertex, face or strips to the mesh.
	void take(const Element& element)
	{
		FileMesh& mesh = m_file.meshes.front();
		if (element.has(0, 2))
		{
			mesh.positions.emplace_back(m_numbers[0], m_numbers[1], m_numbers[2]);
		}
		if (element.has(3, 5))
		{
			mesh.normals.emplace_back(m_numbers[3], m_numbers[4], m_numbers[5]);
		}
		if (element.has(6, 7))
		{
			mesh.uvs.emplace_back(m_numbers[6], m_numbers[7]);
		}
		if (element.has(kFirstColour, kFirstColour + 2))
		{
			mesh.colours.push_back(linearOf({m_numbers[kFirstColour], m_numbers[kFirstColour + 1], m_numbers[kFirstColour + 2]}));
		}
		if (element.name == "face")
		{
			append(mesh.corners, m_list);
			mesh.ends.push_back(static_cast<uint32_t>(mesh.corners.size()));
		}
		for (std::size_t i = 0, begin = 0; element.name == "tristrips" && i < m_list.size(); ++i)
		{
			begin = m_list[i] == kNone ? i + 1 : begin; // -1 starts the next strip
			if (i >= begin + 2)
			{
				const std::size_t turned = (i - begin) % 2;
				mesh.corners.insert(mesh.corners.end(), {m_list[i - 2 + turned], m_list[i - 1 - turned], m_list[i]});
				mesh.ends.push_back(static_cast<uint32_t>(mesh.corners.size()));
			}
		}
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

	std::string_view nextWord()
	{
		while (m_at < m_bytes.size() && isBlank(m_bytes[m_at]))
		{
			++m_at;
		}
		const std::size_t begin = m_at;
		while (m_at < m_bytes.size() && !isBlank(m_bytes[m_at]))
		{
			++m_at;
		}
		return std::string_view(m_bytes).substr(begin, m_at - begin);
	}

	static constexpr uint32_t kNone = ~0U;
	static constexpr std::size_t kFirstColour = 8; // of kSlots

	const std::string& m_bytes;
	const std::string& m_path;
	MeshFile m_file;
	std::vector<Element> m_elements;
	std::array<double, kSlots.size()> m_numbers{}; // of the current element
	std::vector<uint32_t> m_list;                  // of its vertices
	std::size_t m_at = 0;
	std::size_t m_line = 0;
	bool m_has_format = false;
	bool m_binary = false;
	bool m_big_endian = false;
};

constexpr std::size_t kHead = 84; // bytes before the first triangle

// Size of a binary file with this head.
uint64_t bytesNeeded(const std::string& bytes)
{
	return kHead + 50 * littleEndian(bytes, 80, 4);
}

void addFacet(FileMesh& mesh, glm::vec3 normal, std::span<const glm::dvec3> corners)
{
	for (const glm::dvec3& corner : corners)
	{
		mesh.corners.push_back(static_cast<uint32_t>(mesh.positions.size()));
		mesh.positions.push_back(corner);
		mesh.normals.push_back(normal);
	}
	mesh.ends.push_back(static_cast<uint32_t>(mesh.corners.size()));
}

void readFacets(const std::string& bytes, FileMesh& mesh)
{
	const std::size_t facets = (bytes.size() - kHead) / 50;
	mesh.positions.reserve(3 * facets);
	mesh.normals.reserve(3 * facets);
	mesh.corners.reserve(3 * facets);
	mesh.ends.reserve(facets);
	for (std::size_t at = kHead; at < bytes.size(); at += 50)
	{
		std::array<glm::vec3, 4> values; // normal, corners
		for (std::size_t i = 0; i < 12; ++i)
		{
			values[i / 3][static_cast<int>(i % 3)] =
				std::bit_cast<float>(static_cast<uint32_t>(littleEndian(bytes, at + 4 * i, 4)));
		}
		addFacet(mesh, values[0], std::array<glm::dvec3, 3>{values[1], values[2], values[3]});
	}
}

class StlText
{
public:
	explicit StlText(std::vector<FileMesh>& meshes) : m_meshes(meshes) {}

	void take(std::string_view line, const TextPlace& place)
	{
		splitWords(line, m_words);
		const std::string keyword = m_words.empty() ? "" : lowered(m_words[0]);
		if (keyword == "solid")
		{
			end(place);
			m_meshes.emplace_back().name = m_words.size() > 1 ? textFrom(m_words, 1) : "";
		}
		else if (keyword == "vertex")
		{
			m_corners.push_back(numbers(1, place));
		}
		else if (keyword == "facet")
		{
			end(place);
			m_normal = numbers(2, place);
			m_open = true;
		}
		else if (keyword == "endfacet" || keyword == "endsolid")
		{
			end(place);
		}
	}

	// Ends a facet, if one is open.
	void end(const TextPlace& place)
	{
		if (m_corners.empty() && !m_open)
		{
			return;
		}
		if (m_corners.size() != 3)
		{
			place.fail(std::to_string(m_corners.size()) + " corners of a facet", "3");
		}
		failIf(m_meshes.empty(), place, "a facet", "\"solid\" before it");
		addFacet(m_meshes.back(), m_normal, m_corners);
		m_corners.clear();
		m_open = false;
	}

private:
	glm::dvec3 numbers(std::size_t from, const TextPlace& place) const
	{
		if (m_words.size() != from + 3)
		{
			place.fail(std::to_string(m_words.size() - std::min(m_words.size(), from)) + " numbers", "x y z");
		}
		return {place.number(m_words[from]), place.number(m_words[from + 1]), place.number(m_words[from + 2])};
	}

	std::vector<FileMesh>& m_meshes;
	std::vector<std::string_view> m_words;
	glm::dvec3 m_normal{0.0};
	std::vector<glm::dvec3> m_corners; // of the current facet
	bool m_open = false;               // a facet
};

} // namespace

std::optional<double> numberOf(std::string_view word)
{
	const double sign = word.starts_with('-') ? -1.0 : 1.0;
	const std::string_view rest = withoutSign(word);
	double value = 0.0;
	const auto [end, wrong] = readDecimal(rest.data(), rest.data() + rest.size(), value);
	const bool whole = end == rest.data() + rest.size() && rest.find_first_of("0123456789.") == 0;
	if (whole && wrong == std::errc::result_out_of_range)
	{
		const std::size_t exponent = rest.find_first_of("eE");
		const bool small = exponent == std::string_view::npos ? rest.find_first_not_of('0') == rest.find('.')
															  : rest.substr(exponent + 1).starts_with('-');
		return small ? 0.0 : sign * std::numeric_limits<double>::infinity();
	}
	if (whole && wrong == std::errc{})
	{
		return sign * value;
	}
	const std::string_view odd = notFinite(rest);
	return odd == "inf"   ? std::optional(sign * std::numeric_limits<double>::infinity())
		   : odd == "nan" ? std::optional(std::numeric_limits<double>::quiet_NaN())
						  : std::nullopt;
}

glm::vec3 linearOf(glm::dvec3 colour)
{
	for (int i = 0; i < 3; ++i)
	{
		const double value = std::isnan(colour[i]) ? 1.0 : std::clamp(colour[i], 0.0, 1.0);
		colour[i] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
	}
	return glm::vec3(colour);
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
	const bool positive = word.starts_with('+') && !word.starts_with("+-");
	return nook::numberFrom<int>(word.substr(positive ? 1 : 0));
}

void splitWords(std::string_view line, std::vector<std::string_view>& words)
{
	words.clear();
	for (std::size_t at = 0; at < line.size();)
	{
		const std::size_t begin = at;
		while (at < line.size() && !isBlank(line[at]))
		{
			++at;
		}
		if (at > begin)
		{
			words.push_back(line.substr(begin, at - begin));
		}
		++at;
	}
}

std::string readMeshText(const std::string& path)
{
	std::string bytes = readFile(path);
	bytes.erase(0, bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0);
	return bytes;
}

MeshFile readPly(const std::string& bytes, const std::string& path)
{
	return PlyReader(bytes, path).run();
}

MeshFile readStl(const std::string& bytes, const std::string& path)
{
	MeshFile file;
	file.materials.number(kNoMaterial);
	const bool has_head = bytes.size() >= kHead;
	if (has_head && bytes.size() == bytesNeeded(bytes))
	{
		readFacets(bytes, file.meshes.emplace_back());
		return file;
	}
	if (has_head && bytes.find('\0') < kHead) // not text; and every count below 2^24 contains a zero
	{
		const uint64_t needed = bytesNeeded(bytes);
		refuseInput(path + ": header",
					std::to_string((needed - kHead) / 50) + " triangles in " + std::to_string(bytes.size()) + " bytes",
					std::to_string(needed) + " bytes");
	}
	StlText text(file.meshes);
	std::size_t lines = 0;
	forLines(bytes, path, false,
			 [&](std::string_view line, const TextPlace& place)
			 {
				 text.take(line, place);
				 lines = place.line;
			 });
	text.end({path, lines});
	return file;
}

} // namespace nook
