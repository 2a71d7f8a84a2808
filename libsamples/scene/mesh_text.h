// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes with polygons: reads them from OBJ with MTL, PLY and STL files, triangulates and sends them; parses numbers of text
// formats.
#pragma once

#include "core/error.h"
#include "core/words.h"
#include "scene/load.h"
#include "scene/load_parts.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

struct FileMesh
{
	std::string name;
	uint32_t material = 0;
	std::vector<glm::dvec3> positions;
	std::vector<glm::vec3> normals; // one per position, or none
	std::vector<glm::vec2> uvs;     // likewise
	std::vector<glm::vec3> colours; // likewise, linear
	std::vector<uint32_t> sources;  // number of each position in the file; none: as they follow each other
	std::vector<uint32_t> corners;  // indices of positions, face after face
	std::vector<uint32_t> ends;     // end of each face's corners
};

class FaceCutter
{
public:
	// Sends a mesh in metres, with v downward, as triangles (load_parts.h). `path`: names from the root to the mesh. A mirrored
	// mesh gets the reverse winding.
	//
	// A face with fewer than three corners counts as a line; with an index out of range or a non-finite position it becomes one
	// triangle that the level drops and counts.
	void send(const FileMesh& mesh, const std::vector<std::string>& path, bool mirrored, ValueWriter& to);

	Tally lines; // over all meshes
	Tally bad_polygons;

private:
	void add(std::span<const uint32_t> corners, const FileMesh& mesh);
	void addPolygon(std::span<const uint32_t> corners, const FileMesh& mesh);

	std::vector<glm::uvec3> m_triangles; // of the mesh
};

// Triangulates a polygon in space using its own corners; supports concave ones and holes connected by bridges.

// Appends triangles, as indices into `corners`, with the polygon's winding. Requires at least 3 finite corners. False if the
// polygon has no area or runs out of ears, like most self-intersecting ones: some triangles are then a guess. O(n · reflex
// corners).
bool triangulate(std::span<const glm::dvec3> corners, std::vector<glm::uvec3>& triangles);

struct MtlMaterial : FileMaterial // Kd, map_d, map_Kd
{
	std::optional<float> d;  // opacity, 0 to 1
	std::optional<float> tr; // 0 to 1: transparency by the specification, opacity in some programs
	std::string ignored;     // the first unsupported option of map_d
};

struct MtlMaterials
{
	std::vector<MtlMaterial> list;
	std::map<std::string, uint32_t> numbers; // by name

	// The number of the material with this name, which is added if it is new.
	uint32_t number(const std::string& name)
	{
		const auto [known, is_new] = numbers.try_emplace(name, static_cast<uint32_t>(list.size()));
		if (is_new)
		{
			list.emplace_back().name = name;
		}
		return known->second;
	}
};

struct MeshFile
{
	MtlMaterials materials;
	std::vector<FileMesh> meshes; // in the file's units and axes, v upward; missing normals and coordinates are zero, or at the end
	std::vector<std::string> files;   // others that were read
	std::vector<std::string> missing; // others that are named but missing
	std::size_t vertices = 0;         // that FileMesh::sources refers to
};

// Contents of a file without a byte order mark. Throws Error (file).
std::string readMeshText(const std::string& path);

// Each reader takes the contents of a file. Throws Error (invalid_input or unsupported) with the place of a mistake.

// Also reads the MTL files that the level names. Each corner of a face becomes a vertex.
MeshFile readObj(const std::string& text, const std::string& path, const LoadSettings& settings);

// This work is based on: Greg Turk, "The PLY Polygon File Format", 1994.
MeshFile readPly(const std::string& bytes, const std::string& path);

// A binary file is recognisable only by its length: 80 bytes, a count, 50 bytes per triangle.
MeshFile readStl(const std::string& bytes, const std::string& path);

void readMtl(const std::string& text, const std::string& path, MtlMaterials& materials);

// d, else Tr interpreted by `meaning`. Sets `inverted` if Tr contradicts d, or is 1 without d and treated as opaque.
float opacityOf(const MtlMaterial& material, TrMeaning meaning, bool& inverted);

// Material of faces that have none.
inline constexpr const char* kNoMaterial = "DefaultMaterial";

// Parses numbers of text formats, with one rule for OBJ, MTL, PLY and STL: a decimal point, never a comma; no other characters.

// "1", "-.5e3", "+1.", "nan", "-inf", and the forms of Microsoft's C library: "1.#QNAN", "-nan(ind)"; none for other words.
// Correctly rounded to 64 bits; infinite or 0 outside their range.
std::optional<double> numberOf(std::string_view word);

// 8-bit sRGB, scaled to 0 to 1, → linear (IEC 61966-2-1).
glm::vec3 linearOf(glm::dvec3 colour);

// A 32-bit integer, optionally with a sign and leading zeros; none for anything else.
std::optional<int> wholeOf(std::string_view word);

// A word for a message; long ones are truncated.
std::string quoted(std::string_view word);

// The line's text from the given word to the last.
std::string textFrom(const std::vector<std::string_view>& words, std::size_t first);

// Splits a line at blanks; replaces the contents of `words`.
void splitWords(std::string_view line, std::vector<std::string_view>& words);

// A location in a text file, for messages.
struct TextPlace
{
	const std::string& path;
	std::size_t line = 0;

	[[noreturn]] void fail(const std::string& found, const std::string& expected, ExitCode code = ExitCode::invalid_input) const
	{
		throw Error(code, path + ": line " + std::to_string(line) + ": found " + found + ", expected " + expected);
	}

	// The number that a word is.
	double number(std::string_view word) const
	{
		const std::optional<double> number = numberOf(word);
		return number ? *number : (fail(quoted(word), "a number"), 0.0);
	}
};

// Calls `take` with each line of a text with any line ends, and its location; if `joins`, lines continued by \ are one.
template <class Take> void forLines(std::string_view text, const std::string& path, bool joins, const Take& take)
{
	std::string joined;
	std::size_t newline = 0; // the first one from here on
	std::size_t number = 0;
	for (std::size_t begin = 0; begin < text.size();)
	{
		joined.clear();
		const TextPlace place{path, number + 1};
		std::string_view line;
		for (bool continues = true; continues;)
		{
			newline = newline >= begin && number > 0 ? newline : std::min(text.find('\n', begin), text.size());
			line = text.substr(begin, newline - begin);
			line = line.substr(0, line.find('\r'));
			begin += line.size();
			begin += text.substr(begin).starts_with("\r\n") ? 2U : 1U;
			number += 1;
			continues = joins && line.ends_with('\\') && begin < text.size();
			if (continues || !joined.empty())
			{
				joined.append(line.substr(0, line.size() - (continues ? 1 : 0))) += ' ';
			}
		}
		take(joined.empty() ? line : std::string_view(joined), place);
	}
}

} // namespace nook
