// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/fbx.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace nook
{
namespace
{

constexpr std::size_t kFirstValue = 4; // of a property, after its name, two types and flags

// "Model::Box" in ASCII files, "Box\0\1Model" in binary ones.
std::string objectName(const std::string& text)
{
	const std::size_t binary = text.find(std::string_view("\0\1", 2));
	const std::size_t ascii = text.find("::");
	return binary != std::string::npos ? text.substr(0, binary) : ascii != std::string::npos ? text.substr(ascii + 2) : text;
}

glm::dmat3 turnAbout(int axis, double degrees)
{
	const SinCos turn = sinCosOfDegrees(degrees);
	const int u = (axis + 1) % 3;
	const int v = (axis + 2) % 3;
	glm::dmat3 matrix(1.0);
	matrix[u][u] = turn.cos;
	matrix[u][v] = turn.sin;
	matrix[v][u] = -turn.sin;
	matrix[v][v] = turn.cos;
	return matrix;
}

// Rotation about three axes in FBX's RotationOrder: XYZ rotates about x first.
glm::dmat3 turnOf(glm::dvec3 degrees, double order = 0.0)
{
	constexpr std::array<std::array<int, 3>, 6> kOrders{{{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}}};
	glm::dmat3 turn(1.0);
	for (const int axis : kOrders[order >= 0.0 && order < 6.0 ? static_cast<std::size_t>(order) : 0]) // 6: spheric, treated as XYZ
	{
		turn = turnAbout(axis, degrees[axis]) * turn;
	}
	return turn;
}

glm::dmat3 scaled(const glm::dmat3& m, glm::dvec3 scale)
{
	return {m[0] * scale.x, m[1] * scale.y, m[2] * scale.z};
}

glm::dmat4 matrixOf(const glm::dmat3& linear, glm::dvec3 translation)
{
	glm::dmat4 matrix(linear);
	matrix[3] = glm::dvec4(translation, 1.0);
	return matrix;
}

// A node's frame as its children need it. Its world matrix is translation · turn · before · scale.
struct Frame
{
	glm::dmat4 world{1.0};
	glm::dmat3 turn{1.0};
	glm::dmat3 before{1.0}; // inherited part of its ancestors' scales
	glm::dvec3 scale{1.0};
	bool hidden = false;
	bool lower_lod = false;
};

class Placer
{
public:
	explicit Placer(const FbxObjects& objects) : m_objects(objects), m_parents(objects.count(), 0), m_off(objects.count(), false)
	{
		for (std::size_t i = 0; i < objects.count(); ++i)
		{
			const FbxObject& object = objects[i];
			const bool is_layer = object.type == "CollectionExclusive" && object.kind == "DisplayLayer";
			for (const FbxLink& link : object.parts)
			{
				if (objects[link.object].type != "Model" || !link.property.empty())
				{
					continue;
				}
				if ((i == 0 || object.type == "Model") && m_parents[link.object] == 0)
				{
					m_parents[link.object] = i + 1; // the first connection determines the parent
				}
				if (is_layer && objects.number(object, "Show", 1.0) == 0.0)
				{
					m_off[link.object] = true;
				}
			}
		}
	}

	std::vector<FbxPlace> run()
	{
		walk(0, true);
		for (std::size_t i = 0; i < m_objects.count(); ++i)
		{
			if (m_objects[i].type == "Model" && m_parents[i] == 0)
			{
				walk(i, false);
			}
		}
		const auto models = std::count_if(m_parents.begin(), m_parents.end(), [](std::size_t parent) { return parent != 0; });
		const auto below =
			std::count_if(m_places.begin(), m_places.end(), [&](const FbxPlace& place) { return m_parents[place.object] != 0; });
		failIf(models != below, m_objects.file, "Connections", "a circle of nodes", "a tree");
		return std::move(m_places);
	}

private:
	bool isOff(std::size_t node) const
	{
		const FbxObject& object = m_objects[node];
		return m_off[node] || !(m_objects.number(object, "Visibility", 1.0) > 0.0);
	}

	// True if a node is hidden; does not hide its children.
	bool isNotShown(const FbxObject& node) const
	{
		return m_objects.number(node, "Show", 1.0) == 0.0;
	}

	std::vector<std::size_t> childrenOf(std::size_t node) const
	{
		std::vector<std::size_t> children = m_objects.partsOf(m_objects[node], "Model");
		std::erase_if(children, [&](std::size_t child) { return m_parents[child] != node + 1; });
		return children;
	}

	// Visits a node, possibly the root, and its descendants.
	void walk(std::size_t from, bool in_scene)
	{
		std::vector<std::pair<std::size_t, Frame>> open{{from, Frame{}}};
		while (!open.empty())
		{
			auto [node, frame] = open.back();
			open.pop_back();
			if (node != 0)
			{
				place(node, frame, in_scene);
			}
			const std::vector<std::size_t> children = childrenOf(node);
			// The first visible level of detail represents the others.
			const bool is_group =
				m_objects[node].kind == "LodGroup" || !m_objects.partsOf(m_objects[node], "NodeAttribute", "LodGroup").empty();
			const auto kept = is_group
								  ? std::find_if(children.begin(), children.end(),
												 [&](std::size_t child) { return !isOff(child) && !isNotShown(m_objects[child]); })
								  : children.end();
			for (auto child = children.rbegin(); child != children.rend(); ++child)
			{
				open.emplace_back(*child, frame);
				open.back().second.lower_lod = frame.lower_lod || (kept != children.end() && *child != *kept);
			}
		}
	}

	// Converts its parent's frame to its own.
	void place(std::size_t node, Frame& frame, bool in_scene)
	{
		const FbxObject& object = m_objects[node];
		const auto vector = [&](std::string_view name, double fallback)
		{
			return m_objects.vector(object, name, glm::dvec3(fallback));
		};
		glm::dmat3 turn = turnOf(vector("Lcl Rotation", 0.0));
		if (m_objects.number(object, "RotationActive", 1.0) != 0.0 &&
			m_objects.number(object, "RotationSpaceForLimitOnly", 0.0) == 0.0)
		{
			turn = turnOf(vector("PreRotation", 0.0)) *
				   turnOf(vector("Lcl Rotation", 0.0), m_objects.number(object, "RotationOrder", 0.0)) *
				   glm::transpose(turnOf(vector("PostRotation", 0.0)));
		}
		const glm::dvec3 scale = vector("Lcl Scaling", 1.0);
		const glm::dvec3 turn_pivot = vector("RotationPivot", 0.0);
		const glm::dvec3 scale_pivot = vector("ScalingPivot", 0.0);
		const glm::dvec3 moved = vector("Lcl Translation", 0.0) + vector("RotationOffset", 0.0) + turn_pivot +
								 turn * (vector("ScalingOffset", 0.0) + scale_pivot - scale * scale_pivot - turn_pivot);
		const glm::dvec3 at(frame.world * glm::dvec4(moved, 1.0));

		const glm::dmat3 parent_scale = scaled(frame.before, frame.scale);
		const double inherits = m_objects.number(object, "InheritType", 1.0);
		frame.turn = frame.turn * turn;
		if (inherits == 0.0) // RrSs: along the node's own axes
		{
			frame.before = parent_scale;
		}
		else if (inherits != 2.0) // RSrs: along its parent's; 2 is Rrs: without its parent's own scale
		{
			frame.before = glm::transpose(turn) * parent_scale * turn;
		}
		frame.scale = scale;
		frame.world = matrixOf(frame.turn * scaled(frame.before, scale), at);

		bool inherits_off = frame.hidden;
		for (const char* const name :
			 {"Visibility Inheritance", "VisibilityInheritance"}) // the SDK's name, and that of other exporters
		{
			inherits_off = inherits_off && m_objects.number(object, name, 1.0) != 0.0;
		}
		frame.hidden = inherits_off || isOff(node);

		const std::size_t parent = m_parents[node] > 1 ? m_parents[node] - 1 : 0; // 1 is the root
		const glm::dmat4 geometric = matrixOf(scaled(turnOf(vector("GeometricRotation", 0.0)), vector("GeometricScaling", 1.0)),
											  vector("GeometricTranslation", 0.0));
		m_places.push_back({node, parent, frame.world, geometric, in_scene, frame.hidden || isNotShown(object), frame.lower_lod});
	}

	const FbxObjects& m_objects;
	std::vector<std::size_t> m_parents; // parent of each node plus 1; 0: none
	std::vector<bool> m_off;            // hidden by its layer
	std::vector<FbxPlace> m_places;
};

} // namespace

FbxProperties propertiesOf(const FbxNode& parent)
{
	FbxProperties properties;
	for (const FbxNode& property : parent.childrenOf("Properties70"))
	{
		if (property.name == "P" && !property.values.empty() && property.values.front().kind == FbxValue::Kind::text)
		{
			properties.try_emplace(property.values.front().bytes, &property);
		}
	}
	return properties;
}

FbxObjects::FbxObjects(const std::string& path) : file(path)
{
	readTemplates();
	readObjects();
	readConnections();
}

void FbxObjects::readTemplates()
{
	for (const FbxNode& type : file.root.childrenOf("Definitions"))
	{
		for (const FbxNode& from : type.children)
		{
			if (type.name == "ObjectType" && from.name == "PropertyTemplate")
			{
				const std::string name = file.text(type, 0);
				m_templates.try_emplace(name == "NodeAttribute" ? name + "/" + file.text(from, 0) : name, propertiesOf(from));
			}
		}
	}
}

void FbxObjects::readObjects()
{
	m_objects.emplace_back();
	m_index_of[0] = 0;
	const std::vector<FbxNode>& list = file.root.childrenOf("Objects");
	m_objects.reserve(list.size() + 1);
	for (const FbxNode& node : list)
	{
		const std::optional<int64_t> id = wholeAt(node, 0);
		if (!id || !m_index_of.try_emplace(*id, m_objects.size()).second)
		{
			continue; // nothing can be connected to it, or its number is a duplicate
		}
		FbxObject& object = m_objects.emplace_back();
		object.node = &node;
		object.type = node.name;
		object.name = objectName(file.text(node, 1));
		object.kind = file.text(node, 2);
		object.own = propertiesOf(node);
		const auto common =
			m_templates.find(object.type == "NodeAttribute" ? "NodeAttribute/Fbx" + object.kind : std::string(object.type));
		object.common = common == m_templates.end() ? nullptr : &common->second;
	}
}

void FbxObjects::readConnections()
{
	for (const FbxNode& node : file.root.childrenOf("Connections"))
	{
		const std::optional<int64_t> from = wholeAt(node, 1);
		const std::optional<int64_t> to = wholeAt(node, 2);
		const std::string type = file.text(node, 0);
		if (!from || !to || (type != "OO" && type != "OP"))
		{
			continue;
		}
		const auto part = m_index_of.find(*from);
		const auto whole = m_index_of.find(*to);
		if (part != m_index_of.end() && whole != m_index_of.end() && part->second != 0)
		{
			const std::string_view property = type == "OP" && node.values.size() > 3 ? node.values[3].bytes : std::string_view();
			m_objects[whole->second].parts.push_back({part->second, property});
		}
	}
}

const FbxNode* FbxObjects::property(const FbxObject& object, std::string_view name) const
{
	for (const FbxProperties* const properties : {&object.own, object.common})
	{
		if (properties != nullptr && properties->contains(name))
		{
			return properties->at(name);
		}
	}
	return nullptr;
}

double FbxObjects::number(const FbxObject& object, std::string_view name, double fallback) const
{
	const FbxNode* const found = property(object, name);
	return found == nullptr ? fallback : numberAt(*found, kFirstValue).value_or(fallback);
}

glm::dvec3 FbxObjects::vector(const FbxObject& object, std::string_view name, glm::dvec3 fallback) const
{
	const FbxNode* const found = property(object, name);
	for (std::size_t i = 0; i < 3 && found != nullptr; ++i)
	{
		fallback[static_cast<int>(i)] = numberAt(*found, kFirstValue + i).value_or(fallback[static_cast<int>(i)]);
	}
	return fallback;
}

std::string FbxObjects::text(const FbxObject& object, std::string_view name) const
{
	const FbxNode* const found = property(object, name);
	return found == nullptr ? "" : file.text(*found, kFirstValue);
}

std::vector<std::size_t> FbxObjects::partsOf(const FbxObject& object, std::string_view type, std::string_view kind,
											 std::string_view property) const
{
	std::vector<std::size_t> found;
	for (const FbxLink& link : object.parts)
	{
		const FbxObject& part = m_objects[link.object];
		if ((type.empty() || part.type == type) && (kind.empty() || part.kind == kind) && link.property == property)
		{
			found.push_back(link.object);
		}
	}
	return found;
}

std::string FbxObjects::placeOf(const FbxObject& object)
{
	return std::string(object.type) + " '" + object.name + "'";
}

SinCos sinCosOfDegrees(double degrees)
{
	if (!std::isfinite(degrees))
	{
		return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
	}
	const double turns = std::remainder(degrees, 360.0);
	const double quarters = std::round(turns / 90.0);
	SinCos turn = sinCosOf((turns - 90.0 * quarters) * (kPi / 180.0));
	for (int i = 0; i < (static_cast<int>(quarters) + 4) % 4; ++i)
	{
		turn = {turn.cos, -turn.sin};
	}
	return turn;
}

std::vector<FbxPlace> placesOf(const FbxObjects& objects)
{
	return Placer(objects).run();
}

} // namespace nook
