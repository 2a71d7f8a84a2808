// SPDX-License-Identifier: GPL-3.0-or-later
// Parses an FBX file, binary or ASCII, into its tree of nodes. The objects below interpret them.
#pragma once

#include "core/math.h"
#include "core/value_stream.h"
#include "scene/load.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// A value of a node. Arrays stay encoded until arrayOf() reads them, since most are not needed.
struct FbxValue
{
	enum class Kind : uint8_t
	{
		whole,
		number,
		text, // a string, raw bytes, or an ASCII word such as T
		array,
	};
	Kind kind = Kind::whole;
	char type = 0;           // element type of an array: b, c, i, l, f or d; 0: ASCII text
	bool compressed = false; // with zlib
	uint64_t count = 0;      // stated number of elements
	union
	{
		int64_t whole = 0;
		double number;
	};
	std::string_view bytes; // in the file: the text, or the encoded array
};

struct FbxNode
{
	std::string_view name;
	std::vector<FbxValue> values;
	std::vector<FbxNode> children;

	const FbxNode* child(std::string_view name) const;                   // first child with that name, or null
	const std::vector<FbxNode>& childrenOf(std::string_view name) const; // its children; none without it
};

class FbxFile
{
public:
	// Reads versions 7.1 to 7.7. Throws Error: file, invalid_input, unsupported for other versions.
	explicit FbxFile(std::string of);

	const std::string path;
	FbxNode root;
	bool is_text = false;

	// Value `index` of a node as text; empty if absent. ASCII escapes are resolved.
	std::string text(const FbxNode& node, std::size_t index) const;

	// Text of a node below; empty if absent.
	std::string textBelow(const FbxNode& parent, std::string_view name) const;

	// The numbers of the node's array or, without one, of all its values: double or int64_t. `where` locates the node in errors.
	template <class T> std::vector<T> arrayOf(const FbxNode& node, const std::string& where) const;

	[[noreturn]] void fail(const std::string& where, const std::string& found, const std::string& expected) const;

private:
	// `what`: the numbers that are expected, for errors.
	void decode(const FbxValue& value, const std::string& where, const char* what, std::vector<double>& into) const;

	std::string m_bytes;
	bool m_big_endian = false;
};

// Value `index` of a node if it is a number.
std::optional<double> numberAt(const FbxNode& node, std::size_t index);
std::optional<int64_t> wholeAt(const FbxNode& node, std::size_t index);

// The entries of a Properties70, by name; the first of several.
using FbxProperties = std::map<std::string_view, const FbxNode*>;
FbxProperties propertiesOf(const FbxNode& parent);

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

	const FbxFile file;

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
	std::size_t parent = 0;    // a Model; 0: none
	glm::dmat4 world{1.0};     // in the file's units and axes
	glm::dmat4 geometric{1.0}; // additional transform of its meshes only
	bool in_scene = false;     // below the root
	bool hidden = false;
	bool lower_lod = false; // in a level of detail that another one replaces
};

// All nodes, those of the scene first: parents before children, children in file order. Throws Error for a cycle of nodes.
std::vector<FbxPlace> placesOf(const FbxObjects& objects);

// Values at the corners of a mesh.
struct FbxLayer
{
	enum class By
	{
		corner,
		point,
		polygon,
		all,
		other, // edges or unknown: no values
	};
	std::string name;
	By by = By::other;
	std::vector<double> values;   // several numbers per element
	std::vector<int64_t> indices; // element indices; empty: consecutive

	// The element for a corner of the mesh, given its point and polygon; none if the layer has none. `width`: numbers per element.
	std::optional<std::size_t> elementAt(std::size_t corner, std::size_t point, std::size_t polygon, std::size_t width) const;
};

struct FbxMesh
{
	std::vector<glm::dvec3> points;
	std::vector<uint32_t> corners; // point indices, polygon after polygon; may be out of range
	std::vector<std::size_t> ends; // end of each polygon's corners
	FbxLayer normals;
	FbxLayer materials;        // one number per element: index into the node's materials
	std::vector<FbxLayer> uvs; // the first is the default
};

// Throws Error (invalid_input).
FbxMesh readFbxMesh(const FbxObjects& objects, const FbxObject& geometry);

// Reads only its materials.
FbxLayer readFbxMaterials(const FbxObjects& objects, const FbxObject& geometry);

// True if its shape depends on skins, or on blend shapes with non-zero weight.
bool isPosed(const FbxObjects& objects, const FbxObject& geometry);

// Applies blend shapes to the points and stores the change of their normals in `turned` (empty: none). Then returns the skinning
// transform of each point in the file's units and axes; empty without a skin. `place`: the node that shows the mesh; `worlds`: for
// each object that is a node.
std::vector<glm::dmat4> poseFbxMesh(const FbxObjects& objects, const FbxObject& geometry, const FbxPlace& place,
									const std::vector<const FbxPlace*>& worlds, std::vector<glm::dvec3>& points,
									std::vector<glm::dvec3>& turned);

// Reads an FBX file and sends what readGeometry() expects (load_parts.h). Throws Error.
void sendFbx(const std::string& path, const LoadSettings& settings, ValueWriter& to);

} // namespace nook
