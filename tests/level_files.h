// SPDX-License-Identifier: GPL-3.0-or-later
// Small level files for tests, all of the same unit cube, and measurements of a level.
#pragma once

#include "core/base64.h"
#include "core/file.h"
#include "core/image.h"
#include "core/json_reader.h"
#include "core/json_text.h"
#include "scene/load.h"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace nook
{

// Corner i of the cube from 0 to 1: the bits of i are x, y, z.
inline glm::vec3 cubeCorner(unsigned i)
{
	return {static_cast<float>(i & 1U), static_cast<float>((i >> 1U) & 1U), static_cast<float>((i >> 2U) & 1U)};
}

// Counter-clockwise from outside.
inline constexpr std::array<std::array<unsigned, 4>, 6> kCubeQuads{
	{{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

inline std::vector<std::array<unsigned, 3>> cubeTriangles()
{
	std::vector<std::array<unsigned, 3>> triangles;
	for (const auto& q : kCubeQuads)
	{
		triangles.push_back({q[0], q[1], q[2]});
		triangles.push_back({q[0], q[2], q[3]});
	}
	return triangles;
}

template <class T> void append(std::string& bytes, T value)
{
	std::array<char, sizeof(T)> raw{};
	std::memcpy(raw.data(), &value, sizeof value);
	bytes.append(raw.data(), raw.size());
}

// The cube's buffer: 8 positions (96 bytes), 8 texture coordinates (u = x, v = y; 64 bytes), 36 indices (72 bytes).
inline std::string cubeBuffer()
{
	std::string bytes;
	for (unsigned i = 0; i < 8; ++i)
	{
		append(bytes, cubeCorner(i));
	}
	for (unsigned i = 0; i < 8; ++i)
	{
		append(bytes, cubeCorner(i).x);
		append(bytes, cubeCorner(i).y);
	}
	for (const auto& triangle : cubeTriangles())
	{
		for (const unsigned corner : triangle)
		{
			append(bytes, static_cast<uint16_t>(corner));
		}
	}
	return bytes;
}

inline std::string base64(const std::string& bytes)
{
	return base64Of({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

// One cube, one node; the buffer's bytes are not attached yet.
inline nlohmann::json cubeGltf()
{
	return parseJson(R"({
		"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "box", "mesh": 0}],
		"meshes": [{"name": "cube", "primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}]}],
		"accessors": [
			{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
			{"bufferView": 1, "componentType": 5126, "count": 8, "type": "VEC2"},
			{"bufferView": 2, "componentType": 5123, "count": 36, "type": "SCALAR"}],
		"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 64},
			{"buffer": 0, "byteOffset": 160, "byteLength": 72}],
		"buffers": [{"byteLength": 232}]})",
					 "a.gltf");
}

inline std::string gltfText(nlohmann::json json, const std::string& buffer = cubeBuffer())
{
	json["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(buffer);
	json["buffers"][0]["byteLength"] = buffer.size();
	return jsonLine(json);
}

inline std::string glbBytes(const nlohmann::json& json, std::string chunk)
{
	std::string text = jsonLine(json);
	text.resize((text.size() + 3) / 4 * 4, ' ');
	chunk.resize((chunk.size() + 3) / 4 * 4, '\0');
	std::string bytes = "glTF";
	append(bytes, uint32_t{2});
	append(bytes, static_cast<uint32_t>(28 + text.size() + chunk.size()));
	append(bytes, static_cast<uint32_t>(text.size()));
	bytes += "JSON" + text;
	append(bytes, static_cast<uint32_t>(chunk.size()));
	return bytes + std::string("BIN\0", 4) + chunk;
}

// For small integer coordinates, as short as possible because every truncation is tried.
inline std::string numbers(glm::vec3 p, const std::string& between)
{
	return std::to_string(static_cast<int>(p.x)) + between + std::to_string(static_cast<int>(p.y)) + between +
		   std::to_string(static_cast<int>(p.z));
}

inline std::string cubeObj()
{
	std::string text = "o box\n";
	for (unsigned i = 0; i < 8; ++i)
	{
		const glm::vec3 p = cubeCorner(i);
		text += "v " + numbers(p, " ") + "\n";
		text += "vt " + numbers(p, " ").substr(0, 3) + "\n";
	}
	for (const auto& q : kCubeQuads)
	{
		text += "f";
		for (const unsigned corner : q)
		{
			text += " " + std::to_string(corner + 1) + "/" + std::to_string(corner + 1);
		}
		text += "\n";
	}
	return text;
}

inline std::string cubePly()
{
	std::string text = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
					   "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
	for (unsigned i = 0; i < 8; ++i)
	{
		const glm::vec3 p = cubeCorner(i);
		text += numbers(p, " ") + "\n";
	}
	for (const auto& t : cubeTriangles())
	{
		text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
	}
	return text;
}

inline std::string cubeStl()
{
	std::string text = "solid box\n";
	for (const auto& t : cubeTriangles())
	{
		const glm::vec3 n = glm::cross(cubeCorner(t[1]) - cubeCorner(t[0]), cubeCorner(t[2]) - cubeCorner(t[0]));
		text += "facet normal " + numbers(n, " ") + "\nouter loop\n";
		for (const unsigned corner : t)
		{
			const glm::vec3 p = cubeCorner(corner);
			text += "vertex " + numbers(p, " ") + "\n";
		}
		text += "endloop\nendfacet\n";
	}
	return text + "endsolid box\n";
}

// ASCII FBX 7.4; z up if `z_up`, else y up. Translated by (1, 2, 3) of its own units.
inline std::string cubeFbx(bool z_up, double unit_scale_factor)
{
	const auto whole = [](const std::string& name, int value)
	{
		return "P: \"" + name + "\", \"int\", \"Integer\", \"\"," + std::to_string(value) + "\n";
	};
	std::string vertices;
	std::string polygons;
	for (unsigned i = 0; i < 8; ++i)
	{
		const glm::vec3 p = cubeCorner(i);
		vertices += (i == 0 ? "" : ",") + numbers(p, ",");
	}
	for (const auto& q : kCubeQuads)
	{
		polygons += (polygons.empty() ? "" : ",") + std::to_string(q[0]) + "," + std::to_string(q[1]) + "," + std::to_string(q[2]) +
					",-" + std::to_string(q[3] + 1);
	}
	return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}\n"
		   "GlobalSettings:  {\nVersion: 1000\nProperties70:  {\n" +
		   whole("UpAxis", z_up ? 2 : 1) + whole("UpAxisSign", 1) + whole("FrontAxis", z_up ? 1 : 2) +
		   whole("FrontAxisSign", z_up ? -1 : 1) + whole("CoordAxis", 0) + whole("CoordAxisSign", 1) +
		   "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," + std::to_string(unit_scale_factor) +
		   "\n}\n}\nDefinitions:  {\nVersion: 100\nCount: 0\n}\nObjects:  {\nGeometry: 1000, \"Geometry::box\", \"Mesh\" {\n"
		   "Vertices: *24 {\na: " +
		   vertices + "\n}\nPolygonVertexIndex: *24 {\na: " + polygons +
		   "\n}\nGeometryVersion: 124\n}\nModel: 2000, \"Model::box\", \"Mesh\" {\nVersion: 232\nProperties70:  {\n"
		   "P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",1,2,3\n}\n}\n}\n"
		   "Connections:  {\nC: \"OO\",2000,0\nC: \"OO\",1000,2000\n}\n";
}

// A picture with different rows: opaque except for the topmost quarter.
inline std::string rowsPng()
{
	std::vector<uint16_t> rgba;
	for (unsigned i = 0; i < 8 * 8; ++i)
	{
		rgba.insert(rgba.end(), {uint16_t{30000}, uint16_t{30000}, uint16_t{30000}, i < 16 ? uint16_t{0} : uint16_t{65535}});
	}
	return pngBytes(8, 8, rgba, {});
}

inline double areaOf(const Level& level)
{
	double area = 0.0;
	for (const glm::uvec3& t : level.triangles)
	{
		area +=
			0.5 * glm::length(glm::cross(level.positions[t.y] - level.positions[t.x], level.positions[t.z] - level.positions[t.x]));
	}
	return area;
}

// Positive if surfaces are counter-clockwise from outside.
inline double volumeOf(const Level& level)
{
	double volume = 0.0;
	for (const glm::uvec3& t : level.triangles)
	{
		volume += glm::dot(level.positions[t.x], glm::cross(level.positions[t.y], level.positions[t.z])) / 6.0;
	}
	return volume;
}

inline LoadedLevel loadText(const std::string& path, const std::string& text, const LoadSettings& settings = {})
{
	writeFile(path, text);
	return loadLevel(path, settings, {});
}

// "id count action, …".
inline std::string findingsOf(const Diagnosis& diagnosis)
{
	std::string text;
	for (const Finding& finding : diagnosis.findings)
	{
		text += (text.empty() ? "" : ", ") + finding.id + " " + std::to_string(finding.count) + " " + finding.action;
	}
	return text;
}

} // namespace nook
