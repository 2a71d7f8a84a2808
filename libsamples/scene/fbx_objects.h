// SPDX-License-Identifier: GPL-3.0-or-later
// Objects of an FBX file with their properties and connections, and the transforms of its nodes.
#pragma once

#include "core/math.h"
#include "scene/fbx_tree.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// The entries of a Properties70, by name.
class FbxProperties
{
public:
	FbxProperties() = default;
	explicit FbxProperties(const FbxNode& parent);

	const FbxNode* find(std::string_view name) const; // or null

private:
	std::vector<const FbxNode*> m_sorted;
};

struct FbxLink
{
	std::size_t object = 0;    // the connected object
	std::string_view property; // target property; empty: the object itself
};

struct FbxObject
{
	const FbxNode* node = nullptr;
	std::string_view type;                 // "Model"; empty for the root
	std::string kind;                      // "Mesh"
	std::string name;                      // "Box"
	FbxProperties own;                     // its own properties
	const FbxProperties* common = nullptr; // its type's defaults for all others
	std::vector<FbxLink> parts;            // connected objects, in file order
};

class FbxObjects
{
public:
	// Throws Error like FbxFile.
	explicit FbxObjects(const std::string& path);

	const FbxFile& file() const
	{
		return m_file;
	}
	std::size_t count() const
	{
		return m_objects.size();
	}
	// 0 is the scene's root.
	const FbxObject& operator[](std::size_t index) const
	{
		return m_objects[index];
	}

	// Properties, own ones first; `fallback` if there is none, or none of this type.
	double number(const FbxObject& object, std::string_view property, double fallback) const;
	glm::dvec3 vector(const FbxObject& object, std::string_view property, glm::dvec3 fallback) const;
	std::string text(const FbxObject& object, std::string_view property) const;

	// The objects connected to an object, or to one of its properties; optionally only those of one type or kind.
	std::vector<std::size_t> partsOf(const FbxObject& object, std::string_view type, std::string_view kind = {},
									 std::string_view property = {}) const;

	// "Geometry 'Box'", for errors.
	static std::string placeOf(const FbxObject& object);

private:
	void readTemplates();
	void readObjects();
	void readConnections();
	const FbxNode* property(const FbxObject& object, std::string_view name) const;

	FbxFile m_file;
	std::map<std::string, FbxProperties, std::less<>> m_templates; // by object type, and "NodeAttribute/FbxCamera"
	std::vector<FbxObject> m_objects;
	std::map<int64_t, std::size_t> m_index_of; // by identifier
};

// Exact for multiples of a quarter turn; NaN for non-finite input.
SinCos sinCosOfDegrees(double degrees);

// Transform and visibility of a node.
struct FbxPlace
{
	std::size_t object = 0;    // a Model
	glm::dmat4 world{1.0};     // in the file's units and axes
	glm::dmat4 geometric{1.0}; // additional transform of its meshes only
	bool in_scene = false;     // below the root
	bool hidden = false;
	bool lower_lod = false; // in a level of detail that another one replaces
};

// All nodes, those of the scene first: parents before children, children in file order. Throws Error for a cycle of nodes.
std::vector<FbxPlace> placesOf(const FbxObjects& objects);

} // namespace nook
