// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Khronos Group, "EXT_mesh_gpu_instancing", glTF extensions.
#include "scene/gltf_file.h"

#include "scene/gltf_values.h"

#include <glm/gtc/quaternion.hpp>

namespace nook
{
namespace
{

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
	const uint64_t component = accessor.wholeNeeded("componentType", UINT16_MAX);
	const bool whole = (component == 5120 || component == 5122) && accessor.boolean("normalized", false);
	if (accessor.text("type") != type || !(component == 5126 || (wide && whole)))
	{
		attributes.fail(name, "an accessor of type " + accessor.text("type") + " of " + std::to_string(component),
						std::string(type) + (wide ? " of 5126, or of 5120 or 5122 normalised" : " of 5126"));
	}
	if (!accessor.has("bufferView"))
	{
		attributes.fail(name, "an accessor that no buffer holds",
						"one of a bufferView"); // a count alone could request any amount of memory
	}
	return GltfValues(file, *index);
}

} // namespace

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
	const std::optional<JsonValue> extensions = node.object("extensions");
	const std::optional<JsonValue> extension = extensions ? extensions->object("EXT_mesh_gpu_instancing") : std::nullopt;
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
		const std::size_t index = attributes.indexNeeded(name, file.root().count("accessors"));
		const JsonValue accessor = file.root().item("accessors", index);
		if (!count && !accessor.has("bufferView"))
		{
			attributes.fail(name, "an accessor that no buffer holds", "one of a bufferView");
		}
		count = count ? *count : static_cast<std::size_t>(accessor.wholeNeeded("count", UINT32_MAX));
	}
	if (!count)
	{
		attributes.fail("", "no attribute", "one at least, such as TRANSLATION");
	}
	if (*count > most)
	{
		attributes.fail("", std::to_string(*count) + " instances", "at most " + std::to_string(kMaxInstances) + " in the file");
	}
	std::vector<glm::dmat4> places;
	places.reserve(*count);
	for (std::size_t i = 0; i < *count; ++i)
	{
		places.push_back(placeOf(translation ? translation->vec3(i) : glm::dvec3(0.0),
								 rotation ? glm::dvec4(rotation->vec3(i), rotation->number(i, 3)) : glm::dvec4(0.0, 0.0, 0.0, 1.0),
								 scale ? scale->vec3(i) : glm::dvec3(1.0)));
	}
	return places;
}

} // namespace nook
