// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the meshes, materials and cameras of an FBX file, in the worker of load_geometry.cpp.
#include "scene/fbx.h"

#include "core/base64.h"
#include "core/lists.h"
#include "core/words.h"
#include "scene/load_parts.h"
#include "scene/mesh_text.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace nook
{
namespace
{

constexpr std::size_t kNone = ~std::size_t{0};

// Material properties that may have a texture of the opacity, or of the colour.
constexpr std::array<std::string_view, 4> kOpacity{"TransparentColor", "TransparencyFactor", "3dsMax|main|opacity_map",
												   "3dsMax|Parameters|cutout_map"};
constexpr std::array<std::string_view, 3> kColour{"DiffuseColor", "Maya|baseColor", "3dsMax|Parameters|base_color_map"};

// The file's axes and unit: UnitScaleFactor centimetres.
FileAxes axesOf(const FbxObjects& objects)
{
	FileAxes axes{.unit_m = 0.01};
	FbxObject settings;
	if (const FbxNode* const node = objects.file.root.child("GlobalSettings"))
	{
		settings.own = propertiesOf(*node);
	}
	constexpr std::array<std::array<const char*, 2>, 3> kNames{
		{{"CoordAxis", "CoordAxisSign"}, {"UpAxis", "UpAxisSign"}, {"FrontAxis", "FrontAxisSign"}}};
	for (std::size_t i = 0; i < kNames.size(); ++i)
	{
		const double axis = objects.number(settings, kNames[i][0], axes.axes[i]);
		axes.axes[i] = axis >= 0.0 && axis <= 2.0 ? static_cast<int>(axis) : -1;
		axes.signs[i] = objects.number(settings, kNames[i][1], axes.signs[i]) < 0.0 ? -1 : 1;
	}
	const double factor = objects.number(settings, "UnitScaleFactor", 1.0);
	axes.unit_m *= std::isfinite(factor) && factor > 0.0 ? factor : 1.0;
	return axes;
}

struct Texture : PlacedPicture // an empty name means none; v upward
{
	std::string uv_set;
};

// One placement of a mesh.
struct Instance
{
	const FbxPlace* place = nullptr;
	std::size_t geometry = 0;
	std::vector<std::size_t> materials; // of the node's slots, as numbers sent
};

class FbxSender
{
public:
	FbxSender(const FbxObjects& objects, const LoadSettings& settings, ValueWriter& to)
		: m_objects(objects), m_file(objects.file), m_settings(settings),
		  m_world_from_file(worldFromFile(settings, axesOf(objects))), m_to(to), m_places(placesOf(objects)),
		  m_worlds(objects.count(), nullptr), m_uses(objects.count(), 0)
	{
		for (const FbxPlace& place : m_places)
		{
			m_worlds[place.object] = &place;
		}
	}

	void run()
	{
		instances();
		materials();
		cameras();
		checkSize();
		for (const Instance& instance : m_instances)
		{
			send(instance);
		}
		m_to.value(MeshHead{0, true});
		m_to.value(m_sources);
		m_tallies["points-or-lines"].add(m_faces.lines.first, m_faces.lines.count);
		m_tallies["bad-polygons"] = m_faces.bad_polygons;
		sendTallies(m_tallies, m_to);
		const std::vector<std::string> none; // further files that were read, or are missing
		nook::send(none, m_to);
		nook::send(none, m_to);
	}

private:
	// Collects the visible meshes of the scene and counts the others.
	void instances()
	{
		for (const FbxPlace& place : m_places)
		{
			const FbxObject& node = m_objects[place.object];
			const std::vector<std::size_t> geometries = m_objects.partsOf(node, "Geometry", "Mesh");
			const std::vector<std::size_t> lines = m_objects.partsOf(node, "Geometry", "Line");
			if ((geometries.empty() && lines.empty()) || !place.in_scene)
			{
				continue;
			}
			if (place.hidden || place.lower_lod)
			{
				m_tallies[place.lower_lod ? "lower-lods" : "hidden-nodes"].add("node '" + node.name + "'");
				continue;
			}
			m_tallies["points-or-lines"].add("node '" + node.name + "'", lines.size());
			for (const std::size_t geometry : geometries)
			{
				m_instances.push_back({&place, geometry, {}});
				m_uses[geometry] += 1;
			}
		}
	}

	// Collects the materials used by faces, in order of first use.
	void materials()
	{
		std::vector<std::size_t> numbers(m_objects.count(), kNone); // by object, for materials; the root: the default material
		std::vector<std::size_t> list;
		for (Instance& instance : m_instances)
		{
			const std::vector<std::size_t> slots = m_objects.partsOf(m_objects[instance.place->object], "Material");
			instance.materials.assign(slots.size() + 1, kNone); // the last slot is for faces without a material
			for (const std::size_t slot : usedSlots(instance.geometry, slots.size()))
			{
				const std::size_t material = slot < slots.size() ? slots[slot] : 0;
				if (numbers[material] == kNone)
				{
					numbers[material] = list.size();
					list.push_back(material);
				}
				instance.materials[slot] = numbers[material];
			}
		}
		m_to.value(static_cast<uint32_t>(list.size()));
		for (const std::size_t material : list)
		{
			sendMaterial(material);
		}
	}

	static std::size_t slotOf(const FbxLayer& layer, std::optional<std::size_t> element, std::size_t count)
	{
		// Polygons that the layer omits have the first material.
		const double slot = element ? layer.values[*element] : 0.0;
		return slot >= 0.0 && slot < static_cast<double>(count) ? static_cast<std::size_t>(slot) : count;
	}

	std::vector<std::size_t> usedSlots(std::size_t geometry, std::size_t count) const
	{
		const FbxLayer layer = readFbxMaterials(m_objects, m_objects[geometry]);
		std::vector<std::size_t> used;
		std::vector<bool> known(count + 1, false);
		const auto use = [&](std::size_t slot)
		{
			if (!known[slot])
			{
				known[slot] = true;
				used.push_back(slot);
			}
		};
		const std::size_t elements = layer.by == FbxLayer::By::polygon ? layer.values.size() : 1;
		for (std::size_t i = 0; i < elements; ++i)
		{
			use(slotOf(layer, layer.elementAt(i, i, i, 1), count));
		}
		use(slotOf(layer, std::nullopt, count));
		return used;
	}

	void sendMaterial(std::size_t index)
	{
		const FbxObject& material = m_objects[index];
		const Texture opacity = index == 0 ? Texture{} : textureOf(material, kOpacity);
		const Texture colour = index == 0 ? Texture{} : textureOf(material, kColour);
		FileMaterial made; // two_sided: FBX has it only on nodes, and exporters set it arbitrarily
		made.name = index == 0 ? "default" : material.name;
		made.alpha = static_cast<float>(index == 0 ? 1.0 : opacityOf(material, !opacity.name.empty()));
		const glm::dvec3 diffuse = m_objects.vector(material, "DiffuseColor", glm::dvec3(1.0));
		made.colour = glm::clamp(diffuse * m_objects.number(material, "DiffuseFactor", 1.0), 0.0, 1.0);
		made.opacity = opacity;
		made.picture = colour;
		made.opacity.uv_of_set = made.picture.uv_of_set = glm::dmat3(1.0); // already applied to the coordinates
		nook::send(made, m_to);
		m_textures.push_back(opacity.name.empty() ? colour : opacity);
		m_textures.back().bytes.clear();
	}

	// Explicit opacity if stated. Else from the transparency: colour × factor; a colour alone counts fully, and a factor alone only
	// if it is neither 0 nor 1, since exporters write 1 for opaque materials. A texture replaces the colour.
	double opacityOf(const FbxObject& material, bool has_texture) const
	{
		if (material.own.contains("Opacity"))
		{
			return m_objects.number(material, "Opacity", 1.0);
		}
		const double factor = m_objects.number(material, "TransparencyFactor", 1.0);
		if (has_texture)
		{
			return 1.0;
		}
		if (material.own.contains("TransparentColor"))
		{
			const glm::dvec3 colour = m_objects.vector(material, "TransparentColor", glm::dvec3(0.0));
			return 1.0 - factor * (colour.x + colour.y + colour.z) / 3.0;
		}
		return !material.own.contains("TransparencyFactor") || factor == 1.0 ? 1.0 : 1.0 - factor;
	}

	// Textures connected to a property of a material; the first one represents a layered texture.
	std::vector<std::size_t> texturesAt(const FbxObject& material, std::string_view property) const
	{
		std::vector<std::size_t> textures = m_objects.partsOf(material, "Texture", {}, property);
		for (const std::size_t layered : m_objects.partsOf(material, "LayeredTexture", {}, property))
		{
			const std::vector<std::size_t> layers = m_objects.partsOf(m_objects[layered], "Texture");
			textures.insert(textures.end(), layers.begin(), layers.begin() + (layers.empty() ? 0 : 1));
		}
		return textures;
	}

	Texture textureOf(const FbxObject& material, std::span<const std::string_view> properties)
	{
		for (const std::string_view property : properties)
		{
			for (const std::size_t index : texturesAt(material, property))
			{
				const FbxObject& object = m_objects[index];
				Texture texture;
				texture.channel = MaskChannel::alpha_or_first;
				texture.name = m_file.textBelow(*object.node, "RelativeFilename");
				texture.name = texture.name.empty() ? m_file.textBelow(*object.node, "FileName") : texture.name;
				if (const FbxNode* const content = contentOf(object))
				{
					texture.bytes = bytesOf(*content, object);
					texture.name = "texture '" + object.name + "'" + (texture.name.empty() ? "" : " (" + texture.name + ")");
				}
				if (texture.name.empty())
				{
					continue;
				}
				texture.wrap_u = m_objects.number(object, "WrapModeU", 0.0) == 1.0 ? Wrap::clamp : Wrap::repeat;
				texture.wrap_v = m_objects.number(object, "WrapModeV", 0.0) == 1.0 ? Wrap::clamp : Wrap::repeat;
				texture.uv_set = m_objects.text(object, "UVSet");
				texture.uv_of_set = uvTransform(object);
				return texture;
			}
		}
		return {};
	}

	// Picture embedded in its Video object; null if there is none.
	const FbxNode* contentOf(const FbxObject& texture) const
	{
		for (const std::size_t video : m_objects.partsOf(texture, "Video"))
		{
			const FbxNode* const content = m_objects[video].node->child("Content");
			for (std::size_t i = 0; content != nullptr && i < content->values.size(); ++i)
			{
				if (content->values[i].kind == FbxValue::Kind::text && !content->values[i].bytes.empty())
				{
					return content;
				}
			}
		}
		return nullptr;
	}

	// Bytes; in ASCII files base64 strings, split anywhere or padded individually.
	std::string bytesOf(const FbxNode& content, const FbxObject& texture) const
	{
		std::string bytes;
		std::string open; // base64 continued in the next string
		for (std::size_t i = 0; i < content.values.size(); ++i)
		{
			std::string part = m_file.text(content, i);
			if (!m_file.is_text)
			{
				bytes += part;
				continue;
			}
			std::erase_if(part, [](char c) { return c == '\n' || c == '\r' || c == ' ' || c == '\t'; });
			open += part;
			if (!open.ends_with('=') && i + 1 < content.values.size())
			{
				continue;
			}
			const std::optional<std::vector<uint8_t>> plain = bytesOfBase64(open);
			failIf(!plain, m_file, FbxObjects::placeOf(texture) + ": Content", "another text", "base64");
			bytes.append(plain->begin(), plain->end());
			open.clear();
		}
		return bytes;
	}

	// Scale about a pivot, counter-clockwise rotation about another, translation: from the set's u and v to the picture's.
	glm::dmat3 uvTransform(const FbxObject& texture) const
	{
		const auto moved = [](glm::dvec3 by)
		{
			return glm::dmat3(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, by.x, by.y, 1.0);
		};
		// The property, else the node below, else `fallback`.
		const auto vectorOf = [&](std::string_view property, std::string_view below, double fallback)
		{
			const FbxNode* const node = texture.node->child(below);
			glm::dvec3 own(fallback);
			for (std::size_t i = 0; i < 2 && node != nullptr; ++i)
			{
				own[static_cast<int>(i)] = numberAt(*node, i).value_or(fallback);
			}
			return m_objects.vector(texture, property, own);
		};
		const glm::dvec3 scale = vectorOf("Scaling", "ModelUVScaling", 1.0);
		const glm::dvec3 move = vectorOf("Translation", "ModelUVTranslation", 0.0);
		const glm::dvec3 scale_pivot = m_objects.vector(texture, "TextureScalingPivot", glm::dvec3(0.0));
		const glm::dvec3 turn_pivot = m_objects.vector(texture, "TextureRotationPivot", glm::dvec3(0.0));
		const SinCos turn = sinCosOfDegrees(m_objects.vector(texture, "Rotation", glm::dvec3(0.0)).z);
		const glm::dmat3 scaled(scale.x, 0.0, 0.0, 0.0, scale.y, 0.0, 0.0, 0.0, 1.0);
		const glm::dmat3 turned(turn.cos, turn.sin, 0.0, -turn.sin, turn.cos, 0.0, 0.0, 0.0, 1.0);
		const bool swaps = m_objects.number(texture, "UVSwap", 0.0) != 0.0;
		const glm::dmat3 swapped = swaps ? glm::dmat3(0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0) : glm::dmat3(1.0);
		return moved(move) * moved(turn_pivot) * turned * moved(-turn_pivot) * moved(scale_pivot) * scaled * moved(-scale_pivot) *
			   swapped;
	}

	void cameras()
	{
		std::vector<std::pair<const FbxPlace*, std::size_t>> list;
		for (const FbxPlace& place : m_places)
		{
			for (const std::size_t camera : m_objects.partsOf(m_objects[place.object], "NodeAttribute", "Camera"))
			{
				if (place.in_scene)
				{
					list.emplace_back(&place, camera);
				}
			}
		}
		m_to.value(static_cast<uint32_t>(list.size()));
		for (const auto& [place, camera] : list)
		{
			m_to.text(m_objects[place->object].name);
			// The camera looks along x; y is up.
			const glm::dmat4 local(0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
			m_to.value(rigidOf(m_world_from_file * place->world * local));
			m_to.value(lensOf(m_objects[camera]));
		}
	}

	Lens lensOf(const FbxObject& camera) const
	{
		const auto number = [&](std::string_view name, double fallback)
		{
			return m_objects.number(camera, name, fallback);
		};
		const double width = number("AspectWidth", 1.0);
		const double height = number("AspectHeight", 1.0);
		const double aspect = width > 0.0 && height > 0.0 ? width / height : 1.0;
		const double unit = glm::length(glm::dvec3(m_world_from_file[0]));
		Lens lens{.near_m = unit * number("NearPlane", 10.0), .far_m = unit * number("FarPlane", 4000.0)};
		const double mode = number("ApertureMode", 1.0); // 0: both angles, 1: horizontal angle, 2: vertical angle, 3: focal length
		const double vertical = number(mode == 0.0 ? "FieldOfViewY" : "FieldOfView", 0.0);
		const double horizontal = number(mode == 0.0 ? "FieldOfViewX" : "FieldOfView", 0.0);
		const auto tangentOf = [](double degrees)
		{
			return degrees > 0.0 && degrees < 180.0 ? std::tan(degrees * (kPi / 360.0)) : 0.0;
		};
		double tangent = mode == 0.0 || mode == 2.0 ? tangentOf(vertical) : 0.0; // tangent of half the vertical angle
		if (!(tangent > 0.0) && mode != 2.0 && mode != 3.0)
		{
			tangent = tangentOf(horizontal) / aspect;
		}
		if (!(tangent > 0.0))
		{
			tangent = 0.5 * 25.4 * number("FilmWidth", 0.0) / number("FocalLength", 0.0) / aspect; // inches, millimetres
		}
		lens.fov_y_rad = 2.0 * std::atan(tangent);
		failIf(!(lens.fov_y_rad > 0.0 && lens.fov_y_rad < kPi), m_file, FbxObjects::placeOf(camera), "a lens that sees nothing",
			   "an angle between 0 and 180 degrees");
		return lens;
	}

	// Every corner becomes a vertex.
	void checkSize() const
	{
		uint64_t corners = 0;
		for (const Instance& instance : m_instances)
		{
			const FbxNode* const indices = m_objects[instance.geometry].node->child("PolygonVertexIndex");
			if (indices != nullptr)
			{
				corners += indices->values.size() == 1 ? indices->values.front().count : indices->values.size();
			}
		}
		refuseInputIf(corners > 3 * uint64_t{kMaxTriangles}, m_file.path,
					  std::to_string(corners) + " corners of polygons, counting every instance",
					  "at most " + std::to_string(3 * kMaxTriangles));
	}

	void send(const Instance& instance)
	{
		const FbxObject& geometry = m_objects[instance.geometry];
		const FbxObject& node = m_objects[instance.place->object];
		const bool is_shared = m_uses[instance.geometry] > 1;
		m_name = geometry.name.empty() ? node.name : is_shared ? node.name + "/" + geometry.name : geometry.name;
		m_name = m_name.empty() ? "mesh " + std::to_string(instance.geometry) : m_name;
		m_path.clear();
		for (const FbxPlace* place = instance.place; place != nullptr; place = m_worlds[place->parent])
		{
			m_path.insert(m_path.begin(), m_objects[place->object].name);
		}
		if (!geometry.name.empty() && geometry.name != node.name)
		{
			m_path.push_back(geometry.name);
		}
		if (const auto known = m_shared.find(instance.geometry); known != m_shared.end())
		{
			m_mesh = known->second;
		}
		else
		{
			m_mesh = readFbxMesh(m_objects, geometry);
			if (is_shared)
			{
				m_shared.emplace(instance.geometry, m_mesh);
			}
		}
		m_triangles += m_mesh.corners.size() - std::min(m_mesh.corners.size(), 2 * m_mesh.ends.size());
		refuseInputIf(m_triangles > kMaxTriangles, m_file.path,
					  "more than " + std::to_string(kMaxTriangles) + " triangles, counting every instance", "at most so many");
		pose(instance, geometry);
		for (const auto& [material, polygons] : groupsOf(instance))
		{
			sendGroup(material, polygons);
		}
		m_sources += m_mesh.points.size();
	}

	// Polygons grouped by material number, in order of first use.
	std::vector<std::pair<std::size_t, std::vector<std::size_t>>> groupsOf(const Instance& instance) const
	{
		std::vector<std::pair<std::size_t, std::vector<std::size_t>>> groups;
		std::vector<std::size_t> group_of(instance.materials.size(), kNone);
		for (std::size_t polygon = 0; polygon < m_mesh.ends.size(); ++polygon)
		{
			const std::size_t corner = firstOf(polygon);
			const std::optional<std::size_t> element = m_mesh.materials.elementAt(corner, m_mesh.corners[corner], polygon, 1);
			const std::size_t slot = slotOf(m_mesh.materials, element, instance.materials.size() - 1);
			if (group_of[slot] == kNone)
			{
				group_of[slot] = groups.size();
				groups.emplace_back(instance.materials[slot], std::vector<std::size_t>());
			}
			groups[group_of[slot]].second.push_back(polygon);
		}
		return groups;
	}

	std::size_t firstOf(std::size_t polygon) const
	{
		return polygon == 0 ? 0 : m_mesh.ends[polygon - 1];
	}

	// Moves the points to their posed world positions, and finds the transforms of the normals.
	void pose(const Instance& instance, const FbxObject& geometry)
	{
		const glm::dmat4 rest = m_world_from_file * instance.place->world * instance.place->geometric;
		std::vector<glm::dmat4> skin;
		m_turned.clear();
		if (isPosed(m_objects, geometry))
		{
			m_tallies[m_settings.pose == Pose::rest ? "not-applied" : "posed-meshes"].add("mesh '" + m_name + "'");
			if (m_settings.pose == Pose::file)
			{
				skin = poseFbxMesh(m_objects, geometry, *instance.place, m_worlds, m_mesh.points, m_turned);
			}
		}
		m_turns.assign(1, normalsFrom(rest));
		m_mirrored = glm::determinant(glm::dmat3(rest)) < 0.0;
		if (skin.empty())
		{
			for (glm::dvec3& point : m_mesh.points)
			{
				point = glm::dvec3(rest * glm::dvec4(point, 1.0));
			}
			return;
		}
		std::size_t mirrored = 0;
		m_turns.resize(skin.size());
		for (std::size_t i = 0; i < skin.size(); ++i)
		{
			const glm::dmat4 world = m_world_from_file * skin[i];
			m_mesh.points[i] = glm::dvec3(world * glm::dvec4(m_mesh.points[i], 1.0));
			m_turns[i] = normalsFrom(world);
			mirrored += glm::determinant(glm::dmat3(world)) < 0.0 ? 1U : 0U;
		}
		m_mirrored = 2 * mirrored > skin.size();
	}

	void sendGroup(std::size_t material, const std::vector<std::size_t>& polygons)
	{
		const Texture& texture = m_textures[material];
		const FbxLayer* const named =
			firstWhere(m_mesh.uvs, [&](const FbxLayer& set) { return set.name == texture.uv_set && !texture.uv_set.empty(); });
		const FbxLayer* const uvs = named != nullptr || m_mesh.uvs.empty() ? named : &m_mesh.uvs.front();
		m_part = {};
		m_part.name = m_name;
		m_part.material = static_cast<uint32_t>(material);
		for (const std::size_t polygon : polygons)
		{
			for (std::size_t corner = firstOf(polygon); corner < m_mesh.ends[polygon]; ++corner)
			{
				addCorner(corner, polygon, uvs, texture.uv_of_set);
			}
			m_part.ends.push_back(static_cast<uint32_t>(m_part.corners.size()));
		}
		m_faces.send(m_part, m_path, m_mirrored, m_to);
	}

	// Adds a vertex for a corner; a corner with an invalid point refers to no vertex.
	void addCorner(std::size_t corner, std::size_t polygon, const FbxLayer* uvs, const glm::dmat3& uv_of_set)
	{
		const std::size_t point = m_mesh.corners[corner];
		if (point >= m_mesh.points.size())
		{
			m_part.corners.push_back(~0U);
			return;
		}
		m_part.corners.push_back(static_cast<uint32_t>(m_part.positions.size()));
		m_part.positions.push_back(m_mesh.points[point]);
		m_part.sources.push_back(static_cast<uint32_t>(m_sources + point));
		if (m_mesh.normals.by != FbxLayer::By::other)
		{
			m_part.normals.push_back(normalAt(corner, point, polygon));
		}
		if (uvs != nullptr)
		{
			const std::optional<std::size_t> element = uvs->elementAt(corner, point, polygon, 2);
			const glm::dvec3 uv = element ? uv_of_set * glm::dvec3(uvs->values[2 * *element], uvs->values[2 * *element + 1], 1.0)
										  : glm::dvec3(0.0, 1.0, 0.0);
			m_part.uvs.emplace_back(uv.x, 1.0 - uv.y);
		}
	}

	// World space, with the file's length; NaN if there is none, as in turnedNormal().
	glm::vec3 normalAt(std::size_t corner, std::size_t point, std::size_t polygon) const
	{
		const std::optional<std::size_t> element = m_mesh.normals.elementAt(corner, point, polygon, 3);
		if (!element)
		{
			return glm::vec3(std::numeric_limits<float>::quiet_NaN());
		}
		const double* const values = m_mesh.normals.values.data() + 3 * *element;
		glm::dvec3 normal(values[0], values[1], values[2]);
		if (!m_turned.empty() && m_turned[point] != glm::dvec3(0.0))
		{
			normal = glm::normalize(normal + m_turned[point]);
		}
		return turnedNormal(m_turns[m_turns.size() == 1 ? 0 : point], normal);
	}

	const FbxObjects& m_objects;
	const FbxFile& m_file;
	const LoadSettings& m_settings;
	glm::dmat4 m_world_from_file;
	ValueWriter& m_to;
	std::vector<FbxPlace> m_places;
	std::vector<const FbxPlace*> m_worlds; // for each object that is a node
	std::vector<std::size_t> m_uses;       // for each object that is a mesh
	std::vector<Instance> m_instances;
	std::vector<Texture> m_textures;         // mask transform of each material sent
	std::map<std::size_t, FbxMesh> m_shared; // meshes shared by several nodes, unposed
	SentTallies m_tallies;
	FaceCutter m_faces;
	uint64_t m_triangles = 0; // of all instances so far
	uint64_t m_sources = 0;   // points of the instances before

	// The current instance, with points in world space.
	std::string m_name;
	std::vector<std::string> m_path; // names from the root to the mesh
	FbxMesh m_mesh;
	bool m_mirrored = false;
	std::vector<glm::dmat3> m_turns;  // normal transforms: one, or one per point
	std::vector<glm::dvec3> m_turned; // normal changes of blend shapes per point; empty: none

	FileMesh m_part; // the current one, with one material
};

} // namespace

void sendFbx(const std::string& path, const LoadSettings& settings, ValueWriter& to)
{
	const FbxObjects objects(path);
	FbxSender(objects, settings, to).run();
}

} // namespace nook
