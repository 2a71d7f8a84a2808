// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/lists.h"
#include "core/words.h"
#include "scene/gltf_file.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

namespace nook
{
namespace
{

template <class T> T valueAt(const char* at)
{
	T value{};
	std::memcpy(&value, at, sizeof value);
	return value;
}

uint32_t indexAt(const char* at, uint64_t component)
{
	return withComponent(component, [at](auto zero) { return static_cast<uint32_t>(valueAt<decltype(zero)>(at)); });
}

// This work is based on: Khronos Group, "EXT_mesh_gpu_instancing", glTF extensions.

// Reads an attribute, if present. `wide`: normalised integers are allowed too.
std::optional<GltfValues> attributeOf(GltfFile& file, const JsonValue& attributes, std::string_view name, std::string_view type,
									  bool wide)
{
	const JsonValue root = file.root();
	const std::optional<std::size_t> index = attributes.index(name, root.count("accessors"));
	if (!index)
	{
		return std::nullopt;
	}
	const JsonValue accessor = root.item("accessors", *index);
	const uint64_t component = accessor.at("componentType").whole(UINT16_MAX);
	const bool whole = (component == 5120 || component == 5122) && accessor.boolean("normalized", false);
	failIf(accessor.text("type") != type || !(component == 5126 || (wide && whole)), attributes, name,
		   "an accessor of type " + accessor.text("type") + " of " + std::to_string(component),
		   std::string(type) + (wide ? " of 5126, or of 5120 or 5122 normalised" : " of 5126"));
	failIf(!accessor.has("bufferView"), attributes, name, "an accessor that no buffer holds",
		   "one of a bufferView"); // a count alone could request any amount of memory
	return GltfValues(file, *index);
}

} // namespace

std::size_t bytesOfComponent(uint64_t component)
{
	const bool is_known = component >= 5120 && component <= 5126 && component != 5124;
	return is_known ? withComponent(component, [](auto zero) { return sizeof zero; }) : 0;
}

std::size_t componentsOf(std::string_view type)
{
	constexpr std::array<std::pair<std::string_view, std::size_t>, 7> kTypes{
		{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
	const auto* const found = firstWhere(kTypes, [&](const auto& entry) { return entry.first == type; });
	return found == nullptr ? 0 : found->second;
}

GltfValues::GltfValues(GltfFile& file, std::size_t accessor)
{
	const JsonValue item = file.root().item("accessors", accessor);
	m_count = static_cast<std::size_t>(item.at("count").whole(UINT32_MAX));
	m_component = item.at("componentType").whole(UINT16_MAX);
	m_normalized = item.boolean("normalized", false);
	m_size = componentsOf(item.text("type")) * bytesOfComponent(m_component);
	// Bytes of the view that `of` names, starting at its offset.
	const auto bytes = [&](const JsonValue& of)
	{
		const auto view = static_cast<std::size_t>(of.at("bufferView").whole(UINT32_MAX));
		return viewBytes(file, view).substr(static_cast<std::size_t>(of.whole("byteOffset", UINT64_MAX).value_or(0)));
	};
	m_stride = m_size;
	if (item.has("bufferView"))
	{
		const JsonValue view = file.root().item("bufferViews", static_cast<std::size_t>(item.at("bufferView").whole(UINT32_MAX)));
		m_stride = static_cast<std::size_t>(view.whole("byteStride", UINT16_MAX).value_or(0));
		m_stride = m_stride == 0 ? m_size : m_stride;
		m_bytes = bytes(item);
	}
	if (const std::optional<JsonValue> sparse = item.object("sparse"))
	{
		const auto count = static_cast<std::size_t>(sparse->at("count").whole(m_count));
		const JsonValue indices = sparse->objectNeeded("indices");
		const uint64_t component = indices.at("componentType").whole(UINT16_MAX);
		const std::string_view from = bytes(indices);
		for (std::size_t i = 0; i < count; ++i)
		{
			const uint32_t index = indexAt(from.data() + i * bytesOfComponent(component), component);
			if (index >= m_count || (i > 0 && index <= m_replaced.back()))
			{
				sparse->fail("indices", std::to_string(index) + " in place " + std::to_string(i),
							 "ascending ones below " + std::to_string(m_count));
			}
			m_replaced.push_back(index);
		}
		m_replacing_bytes = bytes(sparse->objectNeeded("values"));
	}
}

const char* GltfValues::elementAt(std::size_t i) const
{
	if (!m_replaced.empty())
	{
		const auto found = std::lower_bound(m_replaced.begin(), m_replaced.end(), i);
		if (found != m_replaced.end() && *found == i)
		{
			return m_replacing_bytes.data() + static_cast<std::size_t>(found - m_replaced.begin()) * m_size;
		}
	}
	return m_bytes.empty() ? nullptr : m_bytes.data() + i * m_stride;
}

double GltfValues::number(std::size_t i, std::size_t component) const
{
	const char* at = elementAt(i);
	if (at == nullptr)
	{
		return 0.0;
	}
	at += component * bytesOfComponent(m_component);
	return withComponent(m_component,
						 [&](auto zero)
						 {
							 using Number = decltype(zero);
							 const auto value = static_cast<double>(valueAt<Number>(at));
							 // glTF 2.0, section 3.6.2.2: signed numbers range from −1 to 1; the least integer also maps to −1.
							 return std::is_integral_v<Number> && m_normalized
										? std::max(value / static_cast<double>(std::numeric_limits<Number>::max()), -1.0)
										: value;
						 });
}

glm::dvec2 GltfValues::vec2(std::size_t i) const
{
	return {number(i, 0), number(i, 1)};
}

glm::dvec3 GltfValues::vec3(std::size_t i) const
{
	return {number(i, 0), number(i, 1), number(i, 2)};
}

void GltfValues::append(std::string& bytes, std::size_t i) const
{
	const char* const at = elementAt(i);
	at == nullptr ? bytes.append(m_size, '\0') : bytes.append(at, m_size);
}

uint32_t GltfValues::index(std::size_t i) const
{
	const char* const at = elementAt(i);
	return at == nullptr ? 0 : indexAt(at, m_component);
}

// Also of nodes in no scene.
const glm::dmat4& GltfPoses::worldOf(std::size_t node)
{
	m_worlds.resize(m_file.parents.size());
	if (!m_worlds[node])
	{
		const std::size_t parent = m_file.parents[node];
		const glm::dmat4 above = parent == m_worlds.size() ? glm::dmat4(1.0) : worldOf(parent);
		m_worlds[node] = above * localOf(m_file.root().item("nodes", node));
	}
	return *m_worlds[node];
}

const std::vector<glm::dmat4>& GltfPoses::jointsOf(std::size_t skin)
{
	const auto [found, is_new] = m_joints.try_emplace(skin);
	if (!is_new)
	{
		return found->second;
	}
	const JsonValue root = m_file.root();
	const JsonValue item = root.item("skins", skin);
	const std::vector<std::size_t> joints = item.indices("joints", m_file.parents.size());
	failIf(joints.empty(), item, "joints", "none", "nodes that move the skin");
	std::optional<GltfValues> inverse;
	if (const std::optional<std::size_t> accessor = item.index("inverseBindMatrices", root.count("accessors")))
	{
		const JsonValue matrices = root.item("accessors", *accessor);
		inverse.emplace(m_file, *accessor);
		failIf(matrices.text("type") != "MAT4" || matrices.at("componentType").whole(UINT16_MAX) != 5126 ||
				   inverse->count() < joints.size(),
			   item, "inverseBindMatrices", std::to_string(inverse->count()) + " values of type " + matrices.text("type"),
			   std::to_string(joints.size()) + " of type MAT4 of 5126, as many as joints");
	}
	for (std::size_t i = 0; i < joints.size(); ++i)
	{
		glm::dmat4 bind(1.0);
		for (std::size_t k = 0; inverse && k < 16; ++k)
		{
			bind[static_cast<int>(k / 4)][static_cast<int>(k % 4)] = inverse->number(i, k);
		}
		found->second.push_back(worldOf(joints[i]) * bind);
	}
	return found->second;
}

NodePose GltfPoses::poseOf(const JsonValue& node, const JsonValue& mesh, std::size_t targets)
{
	NodePose pose;
	if (targets > 0)
	{
		pose.weights = (node.has("weights") ? node : mesh).numbers("weights", targets);
		if (std::all_of(pose.weights.begin(), pose.weights.end(), [](double weight) { return weight == 0.0; }))
		{
			pose.weights.clear();
		}
	}
	if (const std::optional<std::size_t> skin = node.index("skin", m_file.root().count("skins")))
	{
		pose.joints = &jointsOf(*skin);
	}
	return pose;
}

void PoseValues::morph(const std::vector<double>& weights, std::size_t vertex, glm::dvec3& position, glm::dvec3& normal) const
{
	for (std::size_t i = 0; i < weights.size() && i < targets.size(); ++i)
	{
		const auto [positions, normals] = targets[i];
		position += weights[i] == 0.0 || positions == nullptr ? glm::dvec3(0.0) : weights[i] * positions->vec3(vertex);
		normal += weights[i] == 0.0 || normals == nullptr ? glm::dvec3(0.0) : weights[i] * normals->vec3(vertex);
	}
}

glm::dmat4 PoseValues::skin(const std::vector<glm::dmat4>& matrices, std::size_t vertex) const
{
	const auto matrixOf = [&](const GltfValues& indices, std::size_t k) -> const glm::dmat4&
	{
		const double joint = indices.number(vertex, k);
		if (!(joint < static_cast<double>(matrices.size())))
		{
			refuseInput(where, "joint " + std::to_string(static_cast<uint64_t>(joint)) + " at vertex " + std::to_string(vertex),
						"one below " + std::to_string(matrices.size()));
		}
		return matrices[static_cast<std::size_t>(joint)];
	};
	glm::dmat4 mean(0.0);
	double sum = 0.0;
	for (const auto& [indices, weights] : joints)
	{
		for (std::size_t k = 0; k < 4; ++k)
		{
			if (const double weight = weights->number(vertex, k); weight != 0.0) // exporters write any joint if the weight is 0
			{
				mean += weight * matrixOf(*indices, k);
				sum += weight;
			}
		}
	}
	return sum > 0.0 ? mean / sum : matrixOf(*joints.front().first, 0);
}

glm::dmat4 placeOf(glm::dvec3 translation, glm::dvec4 rotation, glm::dvec3 scale)
{
	glm::dmat4 place = glm::mat4_cast(glm::normalize(glm::dquat(rotation.w, rotation.x, rotation.y, rotation.z)));
	for (int axis = 0; axis < 3; ++axis)
	{
		place[axis] *= scale[axis];
	}
	place[3] = glm::dvec4(translation, 1.0);
	return place;
}

std::optional<std::vector<glm::dmat4>> instancesOf(GltfFile& file, const JsonValue& node, std::size_t most)
{
	const std::optional<JsonValue> extension = extensionOf(node, "EXT_mesh_gpu_instancing");
	if (!extension || !node.has("mesh"))
	{
		return std::nullopt;
	}
	const JsonValue attributes = extension->objectNeeded("attributes");
	const std::optional<GltfValues> translation = attributeOf(file, attributes, "TRANSLATION", "VEC3", false);
	const std::optional<GltfValues> rotation = attributeOf(file, attributes, "ROTATION", "VEC4", true);
	const std::optional<GltfValues> scale = attributeOf(file, attributes, "SCALE", "VEC3", false);
	std::optional<std::size_t> count;
	for (const auto& [name, values] : {std::pair{"TRANSLATION", &translation}, {"ROTATION", &rotation}, {"SCALE", &scale}})
	{
		if (*values && count && (*values)->count() != *count)
		{
			attributes.fail(name, std::to_string((*values)->count()) + " instances", std::to_string(*count));
		}
		count = *values ? (*values)->count() : count;
	}
	for (const auto& [name, number] : attributes.value->items())
	{
		// A custom attribute moves nothing, but determines the number of instances if it is the only one.
		const std::size_t index = attributes.at(name).indexInto(file.root().count("accessors"));
		const JsonValue accessor = file.root().item("accessors", index);
		failIf(!count && !accessor.has("bufferView"), attributes, name, "an accessor that no buffer holds", "one of a bufferView");
		count = count ? *count : static_cast<std::size_t>(accessor.at("count").whole(UINT32_MAX));
	}
	failIf(!count, attributes, "", "no attribute", "one at least, such as TRANSLATION");
	failIf(*count > most, attributes, "", std::to_string(*count) + " instances",
		   "at most " + std::to_string(kMaxInstances) + " in the file");
	const auto placeAt = [&](std::size_t i)
	{
		return placeOf(translation ? translation->vec3(i) : glm::dvec3(0.0),
					   rotation ? glm::dvec4(rotation->vec3(i), rotation->number(i, 3)) : glm::dvec4(0.0, 0.0, 0.0, 1.0),
					   scale ? scale->vec3(i) : glm::dvec3(1.0));
	};
	return listOf(*count, placeAt);
}

} // namespace nook
