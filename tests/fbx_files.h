// SPDX-License-Identifier: GPL-3.0-or-later
// FBX files for tests: a tree of nodes that can be written as ASCII or binary, and the objects of a small scene.
#pragma once

#include "level_files.h"
#include "testing.h"

#include "core/decimal.h"

#include <zlib.h>

#include <initializer_list>
#include <list>
#include <variant>

namespace nook
{

using FbxTestValue = std::variant<int64_t, double, std::string, std::vector<double>, std::vector<int32_t>>;

struct FbxTestNode
{
	std::string name;
	std::vector<FbxTestValue> values{};
	std::list<FbxTestNode> children{}; // a list, so that references stay valid

	FbxTestNode& add(std::string child, std::vector<FbxTestValue> with = {})
	{
		return children.emplace_back(FbxTestNode{std::move(child), std::move(with)});
	}
	FbxTestNode& child(const std::string& wanted)
	{
		for (FbxTestNode& node : children)
		{
			if (node.name == wanted)
			{
				return node;
			}
		}
		return add(wanted);
	}
	// A property with the given numbers.
	FbxTestNode& set(const std::string& property, const std::vector<FbxTestValue>& with)
	{
		std::vector<FbxTestValue> all{property, std::string(), std::string(), std::string("A")};
		all.insert(all.end(), with.begin(), with.end());
		child("Properties70").add("P", all);
		return *this;
	}
};

template <class Number> std::string fbxNumbers(const std::vector<Number>& numbers)
{
	std::string text;
	for (const Number number : numbers)
	{
		text += (text.empty() ? "" : ",") + (std::is_same_v<Number, double> ? shortestDecimal(static_cast<double>(number))
																			: std::to_string(static_cast<int64_t>(number)));
	}
	return text;
}

inline void writeFbxText(const FbxTestNode& node, std::string& text, int depth)
{
	const std::string indent(static_cast<std::size_t>(depth), '\t');
	text += indent + node.name + ": ";
	bool has_array = false;
	for (std::size_t i = 0; i < node.values.size(); ++i)
	{
		text += i == 0 ? "" : ", ";
		const FbxTestValue& value = node.values[i];
		const auto array = [&](const auto& numbers)
		{
			text += "*" + std::to_string(numbers.size()) + " {\n" + indent + "\ta: " + fbxNumbers(numbers) + "\n" + indent + "}";
			has_array = true;
		};
		if (const auto* const whole = std::get_if<int64_t>(&value))
		{
			text += std::to_string(*whole);
		}
		else if (const auto* const number = std::get_if<double>(&value))
		{
			text += shortestDecimal(*number);
		}
		else if (const auto* const string = std::get_if<std::string>(&value))
		{
			text += "\"" + *string + "\"";
		}
		else if (const auto* const doubles = std::get_if<std::vector<double>>(&value))
		{
			array(*doubles);
		}
		else
		{
			array(std::get<std::vector<int32_t>>(value));
		}
	}
	if (!has_array && (!node.children.empty() || node.values.empty()))
	{
		text += " {\n";
		for (const FbxTestNode& below : node.children)
		{
			writeFbxText(below, text, depth + 1);
		}
		text += indent + "}";
	}
	text += "\n";
}

// Variants of the binary format.
struct FbxForm
{
	uint32_t version = 7400;
	bool compressed = false;
	bool big_endian = false;
};

template <class T> void appendFbx(std::string& bytes, T value, const FbxForm& form)
{
	append(bytes, value);
	if (form.big_endian)
	{
		std::reverse(bytes.end() - static_cast<std::ptrdiff_t>(sizeof(T)), bytes.end());
	}
}

template <class T> void appendFbxArray(std::string& bytes, char type, const std::vector<T>& numbers, const FbxForm& form)
{
	std::string plain;
	for (const T number : numbers)
	{
		appendFbx(plain, number, form);
	}
	std::string packed = plain;
	if (form.compressed)
	{
		packed.resize(::compressBound(static_cast<uLong>(plain.size())));
		auto size = static_cast<uLongf>(packed.size());
		::compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(plain.data()),
				   static_cast<uLong>(plain.size()));
		packed.resize(size);
	}
	bytes += type;
	appendFbx(bytes, static_cast<uint32_t>(numbers.size()), form);
	appendFbx(bytes, form.compressed ? 1U : 0U, form);
	appendFbx(bytes, static_cast<uint32_t>(packed.size()), form);
	bytes += packed;
}

inline void appendFbxOffset(std::string& bytes, std::size_t value, const FbxForm& form)
{
	form.version >= 7500 ? appendFbx(bytes, static_cast<uint64_t>(value), form)
						 : appendFbx(bytes, static_cast<uint32_t>(value), form);
}

inline void writeFbxNode(const FbxTestNode& node, std::string& bytes, const FbxForm& form)
{
	const std::size_t offset_size = form.version >= 7500 ? 8 : 4;
	std::string values;
	for (const FbxTestValue& value : node.values)
	{
		if (const auto* const whole = std::get_if<int64_t>(&value))
		{
			values += 'L';
			appendFbx(values, *whole, form);
		}
		else if (const auto* const number = std::get_if<double>(&value))
		{
			values += 'D';
			appendFbx(values, *number, form);
		}
		else if (const auto* const string = std::get_if<std::string>(&value))
		{
			// "Model::Box" is "Box\0\1Model" in binary files.
			const std::size_t colons = string->find("::");
			const std::string text = colons == std::string::npos
										 ? *string
										 : string->substr(colons + 2) + std::string("\0\1", 2) + string->substr(0, colons);
			values += 'S';
			appendFbx(values, static_cast<uint32_t>(text.size()), form);
			values += text;
		}
		else if (const auto* const doubles = std::get_if<std::vector<double>>(&value))
		{
			appendFbxArray(values, 'd', *doubles, form);
		}
		else
		{
			appendFbxArray(values, 'i', std::get<std::vector<int32_t>>(value), form);
		}
	}
	const std::size_t start = bytes.size();
	std::string head;
	appendFbxOffset(head, 0, form);
	appendFbxOffset(head, node.values.size(), form);
	appendFbxOffset(head, values.size(), form);
	bytes += head + static_cast<char>(node.name.size()) + node.name + values;
	for (const FbxTestNode& below : node.children)
	{
		writeFbxNode(below, bytes, form);
	}
	if (!node.children.empty())
	{
		bytes += std::string(3 * offset_size + 1, '\0');
	}
	std::string end;
	appendFbxOffset(end, bytes.size(), form);
	bytes.replace(start, offset_size, end);
}

// A scene in metres, y up.
class FbxTestScene
{
public:
	FbxTestScene()
	{
		root.add("GlobalSettings").set("UpAxis", {int64_t{1}}).set("UnitScaleFactor", {100.0});
		root.add("Definitions");
		root.add("Objects");
		root.add("Connections");
	}

	// Connected to `whole`, if that is given.
	FbxTestNode& object(const std::string& type, int64_t id, const std::string& name, const std::string& kind, int64_t whole = -1)
	{
		if (whole >= 0)
		{
			connect(id, whole);
		}
		return root.child("Objects").add(type, {id, type + "::" + name, kind});
	}
	FbxTestNode& model(int64_t id, const std::string& name, int64_t parent = 0, const std::string& kind = "Mesh")
	{
		return object("Model", id, name, kind, parent);
	}
	void connect(int64_t part, int64_t whole, const std::string& property = "")
	{
		std::vector<FbxTestValue> values{std::string(property.empty() ? "OO" : "OP"), part, whole};
		if (!property.empty())
		{
			values.emplace_back(property);
		}
		root.child("Connections").add("C", values);
	}
	// A mesh with corners numbered from 0, and that many for each polygon.
	FbxTestNode& mesh(int64_t id, const std::string& name, const std::vector<double>& points, std::vector<int32_t> corners,
					  int64_t node)
	{
		FbxTestNode& made = object("Geometry", id, name, "Mesh", node);
		made.add("Vertices", {points});
		made.add("PolygonVertexIndex", {std::move(corners)});
		return made;
	}
	// A box about the origin.
	FbxTestNode& box(int64_t id, int64_t node, glm::dvec3 half = glm::dvec3(1.0))
	{
		std::vector<double> points;
		std::vector<int32_t> corners;
		for (unsigned i = 0; i < 8; ++i)
		{
			const glm::dvec3 p = (2.0 * glm::dvec3(cubeCorner(i)) - 1.0) * half;
			points.insert(points.end(), {p.x, p.y, p.z});
		}
		for (const auto& q : kCubeQuads)
		{
			for (std::size_t i = 0; i < 4; ++i)
			{
				corners.push_back(i < 3 ? static_cast<int32_t>(q[i]) : -1 - static_cast<int32_t>(q[i]));
			}
		}
		return mesh(id, "box", points, corners, node);
	}

	std::string text(int64_t version = 7400) const
	{
		std::string written =
			"; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: " + std::to_string(version) + "\n}\n";
		for (const FbxTestNode& node : root.children)
		{
			writeFbxText(node, written, 0);
		}
		return written;
	}
	std::string bytes(const FbxForm& form = {}) const
	{
		std::string written{"Kaydara FBX Binary  \0\x1a", 22};
		written += form.big_endian ? '\1' : '\0';
		appendFbx(written, form.version, form);
		for (const FbxTestNode& node : root.children)
		{
			writeFbxNode(node, written, form);
		}
		return written + std::string(form.version >= 7500 ? 25 : 13, '\0');
	}

	FbxTestNode root{"", {}, {}};
};

} // namespace nook
