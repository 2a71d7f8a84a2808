// SPDX-License-Identifier: GPL-3.0-or-later
// Converts the meshes of a checked glTF file, placed by the nodes of its scene, to triangles of a level.
#include "scene/gltf_file.h"

#include "core/lists.h"
#include "core/words.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

namespace nook
{
namespace
{

constexpr uint64_t kTriangles = 4;
constexpr uint64_t kStrip = 5;
constexpr uint64_t kFan = 6;

constexpr uint64_t kMaxMeshes = uint64_t{1} << 22U; // each has a name, even with few triangles

// A primitive of a mesh, shared by its instances.
struct Primitive
{
	std::string name;  // the mesh's name, with the primitive's number if there are several
	std::string where; // location in the file
	uint64_t mode = kTriangles;
	std::size_t material = 0;
	const GltfValues* positions = nullptr;
	const GltfValues* normals = nullptr;
	const GltfValues* uvs = nullptr; // for the mask
	const GltfValues* indices = nullptr;
	const GltfValues* alphas = nullptr; // COLOR_0, if its alpha masks and varies
	bool ramp = false;                  // the alpha is the texture coordinate of an identity mask
	PoseValues pose;
	const GltfValues* second = nullptr;       // the coordinates of GltfFile::second_set
	std::array<const GltfValues*, 2> baked{}; // or the values of nook bake in their place, front and back

	std::size_t count() const // corners
	{
		return positions == nullptr ? 0 : indices == nullptr ? positions->count() : indices->count();
	}
	std::size_t triangleCount() const
	{
		return mode == kTriangles ? count() / 3 : mode > kTriangles && count() >= 3 ? count() - 2 : 0;
	}
	uint64_t vertexAt(std::size_t corner) const
	{
		return indices == nullptr ? uint64_t{corner} : uint64_t{indices->index(corner)};
	}
	// glTF 2.0, section 3.7.2.1.
	std::array<uint64_t, 3> triangleAt(std::size_t i) const
	{
		switch (mode)
		{
		case kStrip: return {vertexAt(i), vertexAt(i + 1 + i % 2), vertexAt(i + 2 - i % 2)};
		case kFan: return {vertexAt(i + 1), vertexAt(i + 2), vertexAt(0)};
		default: return {vertexAt(3 * i), vertexAt(3 * i + 1), vertexAt(3 * i + 2)};
		}
	}
	// Number of points or lines, for other modes.
	std::size_t elementCount() const
	{
		switch (mode)
		{
		case 0:
		case 2: return count();
		case 1: return count() / 2;
		case 3: return count() - std::min<std::size_t>(count(), 1);
		default: return 0;
		}
	}
};

class MeshBuilder
{
public:
	MeshBuilder(GltfFile& file, LevelSource& source, const glm::dmat4& world_from_file, Level& level)
		: m_file(file), m_root(file.root()), m_source(source), m_world_from_file(world_from_file), m_level(level),
		  m_default_material(source.materials.size() - 1), m_poses(file)
	{
	}

	void run(const std::vector<PlacedNode>& nodes)
	{
		primitives();
		reportBadIndices();
		checkSize(nodes);
		for (const PlacedNode& node : nodes)
		{
			place(node);
		}
		for (const auto& [id, tally] : m_tallies)
		{
			report(m_source.findings, id, tally);
		}
	}

private:
	const GltfValues* values(const JsonValue& item, std::string_view field)
	{
		const std::optional<std::size_t> index = item.index(field, m_root.count("accessors"));
		return index ? &m_values.try_emplace(*index, m_file, *index).first->second : nullptr;
	}

	// Values of an attribute that gltf_file.cpp does not know, one per vertex; null if absent.
	const GltfValues* vertexValues(const JsonValue& attributes, const std::string& name, const Primitive& primitive,
								   std::string_view type = {})
	{
		const GltfValues* const found = values(attributes, name);
		if (found == nullptr || primitive.positions == nullptr)
		{
			return nullptr;
		}
		failIf(found->count() != primitive.positions->count(), attributes, name, std::to_string(found->count()) + " values",
			   std::to_string(primitive.positions->count()) + ", as many as positions");
		const std::string held = accessorOf(attributes, name).text("type");
		failIf(!type.empty() && held != type, attributes, name, "an accessor of type " + held, std::string(type));
		return found;
	}

	JsonValue accessorOf(const JsonValue& item, std::string_view field) const
	{
		return m_root.item("accessors", item.at(field).indexInto(m_root.count("accessors")));
	}

	void poseValues(const JsonValue& item, const JsonValue& attributes, Primitive& primitive)
	{
		PoseValues& pose = primitive.pose;
		pose.where = m_file.path + ": " + item.element;
		for (const JsonValue& target : item.objects("targets"))
		{
			pose.targets.emplace_back(vertexValues(target, "POSITION", primitive, "VEC3"),
									  vertexValues(target, "NORMAL", primitive, "VEC3"));
		}
		for (int i = 0; attributes.has("JOINTS_" + std::to_string(i)); ++i)
		{
			const std::string joints = "JOINTS_" + std::to_string(i);
			const std::string weights = "WEIGHTS_" + std::to_string(i);
			const uint64_t component = accessorOf(attributes, joints).at("componentType").whole(UINT16_MAX);
			failIf(component != 5121 && component != 5123, attributes, joints,
				   "an accessor of component type " + std::to_string(component), "5121 or 5123");
			failIf(!attributes.has(weights), attributes, weights, "none", "one for each of " + joints);
			pose.joints.emplace_back(vertexValues(attributes, joints, primitive, "VEC4"),
									 vertexValues(attributes, weights, primitive, "VEC4"));
		}
	}

	double alphaAt(const Primitive& primitive, uint64_t vertex) const
	{
		const double alpha = primitive.alphas->number(static_cast<std::size_t>(vertex), 3);
		return std::isfinite(alpha) ? alpha : 1.0;
	}

	// COLOR_0 multiplies the base colour (glTF 2.0, section 3.9.2). A constant alpha goes into the material's factor. A varying one
	// becomes a mask if the material has none, else a factor per triangle: the mean of its corners.
	void vertexAlpha(Primitive& primitive)
	{
		if (primitive.alphas == nullptr)
		{
			return;
		}
		double least = std::numeric_limits<double>::infinity();
		double most = -least;
		for (std::size_t i = 0; i < primitive.count(); ++i)
		{
			if (primitive.vertexAt(i) < primitive.positions->count())
			{
				least = std::min(least, alphaAt(primitive, primitive.vertexAt(i)));
				most = std::max(most, alphaAt(primitive, primitive.vertexAt(i)));
			}
		}
		if (!(least < most))
		{
			primitive.material = least == most && least != 1.0 ? variantOf(primitive.material, least, false) : primitive.material;
			primitive.alphas = nullptr;
		}
		else if (m_source.materials[primitive.material].mask < 0)
		{
			primitive.material = variantOf(primitive.material, 1.0, true);
			primitive.ramp = true;
		}
	}

	// Variant of a material with its alpha multiplied, or masked by a ramp.
	std::size_t variantOf(std::size_t material, double alpha, bool ramp)
	{
		const auto [found, is_new] = m_variants.try_emplace({material, alpha, ramp}, m_source.materials.size());
		if (is_new)
		{
			SourceMaterial made = m_source.materials[material];
			made.material.alpha *= alpha;
			if (ramp)
			{
				made.mask = static_cast<int>(m_source.masks.size());
				MaskSource& mask = m_source.masks.emplace_back();
				mask.name = "COLOR_0";
				mask.wrap_u = mask.wrap_v = Wrap::clamp;
				mask.ramp = true;
			}
			m_source.materials.push_back(std::move(made));
		}
		return found->second;
	}

	const GltfValues* coordinates(const JsonValue& attributes, uint32_t set)
	{
		return values(attributes, "TEXCOORD_" + std::to_string(set));
	}

	void secondSet(const JsonValue& attributes, uint32_t set, Primitive& primitive)
	{
		const auto baked = std::find(kBakedSets.begin(), kBakedSets.end(), set);
		if (baked == kBakedSets.end())
		{
			primitive.second =
				coordinates(attributes, set == kOcclusionSet ? m_source.materials[primitive.material].occlusion_set : set);
			return;
		}
		const std::string name(kBakedNames[static_cast<std::size_t>(baked - kBakedSets.begin())]);
		primitive.baked = {vertexValues(attributes, name, primitive), vertexValues(attributes, name + "_BACK", primitive)};
	}

	void primitives()
	{
		const std::vector<JsonValue> meshes = m_root.objects("meshes");
		for (const JsonValue& mesh : meshes)
		{
			const std::vector<JsonValue> items = mesh.objects("primitives");
			std::vector<Primitive>& made = m_meshes.emplace_back();
			for (std::size_t i = 0; i < items.size(); ++i)
			{
				const JsonValue attributes = items[i].objectNeeded("attributes");
				Primitive& primitive = made.emplace_back();
				primitive.name = mesh.name() + (items.size() > 1 ? "-" + std::to_string(i) : "");
				primitive.where = items[i].element;
				primitive.mode = items[i].whole("mode", kFan).value_or(kTriangles);
				primitive.material = items[i].index("material", m_default_material).value_or(m_default_material);
				primitive.positions = values(attributes, "POSITION");
				primitive.normals = values(attributes, "NORMAL");
				primitive.indices = values(items[i], "indices");
				poseValues(items[i], attributes, primitive);
				const SourceMaterial& material = m_source.materials[primitive.material];
				primitive.uvs = coordinates(attributes, material.uv_set);
				if (material.material.alpha_mode != AlphaMode::opaque && attributes.has("COLOR_0") &&
					accessorOf(attributes, "COLOR_0").text("type") == "VEC4")
				{
					primitive.alphas = vertexValues(attributes, "COLOR_0", primitive);
				}
				if (material.transmits && primitive.triangleCount() > 0)
				{
					m_tallies["transmission"].add("material '" + material.material.name + "'",
												  m_transmitting.insert(primitive.material).second);
				}
				vertexAlpha(primitive);
				if (m_file.second_set)
				{
					secondSet(attributes, *m_file.second_set, primitive);
				}
			}
		}
		m_uses.resize(m_meshes.size(), 0);
		m_parts.resize(m_root.count("nodes"), -1);
	}

	// Counts each once, however often its mesh is placed: indices for strips and fans, else triangles.
	void reportBadIndices()
	{
		Tally tally;
		for (const std::vector<Primitive>& mesh : m_meshes)
		{
			for (const Primitive& primitive : mesh)
			{
				const std::size_t each = primitive.mode == kTriangles ? 3 : 1;
				const bool is_asked =
					primitive.indices != nullptr && primitive.positions != nullptr && primitive.mode >= kTriangles;
				for (std::size_t i = 0; is_asked && i + each <= primitive.count(); i += each)
				{
					const uint64_t greatest =
						std::max({primitive.vertexAt(i), primitive.vertexAt(i + each / 2), primitive.vertexAt(i + each - 1)});
					if (greatest >= primitive.positions->count())
					{
						tally.add(primitive.where + (each == 3 ? ", triangle " : ", index ") + std::to_string(i / each));
					}
				}
			}
		}
		report(m_source.findings, "index-out-of-range", tally);
	}

	void checkSize(const std::vector<PlacedNode>& nodes)
	{
		uint64_t triangles = 0;
		uint64_t vertices = 0;
		uint64_t meshes = 0;
		for (const PlacedNode& node : nodes)
		{
			if (const std::optional<std::size_t> mesh = meshOf(node))
			{
				m_uses[*mesh] += 1;
				meshes += m_meshes[*mesh].size();
				for (const Primitive& primitive : m_meshes[*mesh])
				{
					triangles += primitive.triangleCount();
					vertices += std::min(3 * primitive.triangleCount(), primitive.count()) * (1 + primitive.pose.targets.size());
				}
			}
		}
		checkCounts(m_file.path, triangles, vertices, ", counting every instance");
		refuseInputIf(meshes > kMaxMeshes, m_file.path, std::to_string(meshes) + " primitives, counting every instance",
					  "at most " + std::to_string(kMaxMeshes));
	}

	std::optional<std::size_t> meshOf(const PlacedNode& node) const
	{
		return node.has_mesh ? m_root.item("nodes", node.index).index("mesh", m_meshes.size()) : std::nullopt;
	}

	// Marks written by levelGlb() for cells. Other programs' extras may be anything.
	bool isMarked(const PlacedNode& node, const char* mark) const
	{
		const nlohmann::json& item = *m_root.item("nodes", node.index).value;
		const auto extras = item.find("extras");
		return extras != item.end() && extras->is_object() && extras->contains(mark) && (*extras)[mark] == true;
	}

	int addPart(const JsonValue& item, int parent)
	{
		m_level.nodes.push_back({item.name(), parent, extrasOf(item)});
		return static_cast<int>(m_level.nodes.size()) - 1;
	}

	// Adds a node to the level's tree, and its mesh unless nothing distinguishes them.
	void addParts(const PlacedNode& node)
	{
		const JsonValue item = m_root.item("nodes", node.index);
		const std::size_t parent = m_file.parents[node.index];
		m_parts[node.index] = addPart(item, parent < m_parts.size() ? m_parts[parent] : -1);
		m_mesh_part = m_parts[node.index];
		if (const std::optional<std::size_t> index = item.index("mesh", m_meshes.size()))
		{
			const JsonValue mesh = m_root.item("meshes", *index);
			m_mesh_part = mesh.name() != item.name() || mesh.has("extras") ? addPart(mesh, m_mesh_part) : m_mesh_part;
		}
	}

	void place(const PlacedNode& node)
	{
		if (!node.instance)
		{
			addParts(node);
		}
		const std::optional<std::size_t> mesh = meshOf(node);
		if (!mesh)
		{
			return;
		}
		const NodePose pose = poseOf(node, *mesh);
		const std::string number = node.instance ? " " + std::to_string(*node.instance) : "";
		const std::string place = m_uses[*mesh] > 1 ? m_root.item("nodes", node.index).name() + number + "/" : "";
		for (const Primitive& primitive : m_meshes[*mesh])
		{
			Mesh& made = m_level.meshes.emplace_back();
			made.name = place + primitive.name;
			made.first_triangle = m_level.triangles.size();
			made.around = isMarked(node, "nook_around");
			made.closed = isMarked(node, "nook_closed");
			made.node = m_mesh_part;
			m_tallies["points-or-lines"].add("mesh '" + made.name + "'", primitive.elementCount());
			if (m_file.second_set == kPlacesSet && primitive.triangleCount() > 0)
			{
				const auto index = static_cast<std::size_t>(&primitive - m_meshes[*mesh].data());
				m_source.places.push_back({node.index,
										   node.instance,
										   index,
										   primitive.positions->count(),
										   made.first_triangle,
										   {},
										   *mesh,
										   false,
										   {},
										   {}});
			}
			triangles(primitive, m_world_from_file * node.world, pose);
			made.triangle_count = m_level.triangles.size() - made.first_triangle;
			if (m_file.second_set == kPlacesSet && primitive.triangleCount() > 0)
			{
				finishPlace(m_source.places.back(), made);
			}
			if (primitive.uvs == nullptr && !primitive.ramp && made.triangle_count > 0 &&
				m_source.materials[primitive.material].mask >= 0)
			{
				m_tallies["missing-uvs"].add("mesh '" + made.name + "'");
			}
		}
	}

	void finishPlace(GltfPlace& place, const Mesh& made) const
	{
		place.mirrored = m_mirrored;
		place.triangles = countingFrom(static_cast<uint32_t>(made.first_triangle), made.triangle_count);
		const auto numberOf = [&](uint32_t vertex)
		{
			return place.vertices[vertex - place.vertices.front().second].first;
		};
		for (const uint32_t t : place.triangles)
		{
			const glm::uvec3 corner = m_level.triangles[t];
			place.corners.emplace_back(numberOf(corner.x), numberOf(m_mirrored ? corner.z : corner.y),
									   numberOf(m_mirrored ? corner.y : corner.z));
		}
	}

	// The pose of a node's mesh; counts what is not applied.
	NodePose poseOf(const PlacedNode& node, std::size_t mesh)
	{
		const JsonValue item = m_root.item("nodes", node.index);
		std::size_t targets = 0;
		bool has_joints = !m_meshes[mesh].empty() && !node.instance; // a skin stays with its joints, instances are elsewhere
		for (const Primitive& primitive : m_meshes[mesh])
		{
			targets = std::max(targets, primitive.pose.targets.size());
			has_joints = has_joints && !primitive.pose.joints.empty();
		}
		NodePose pose = m_poses.poseOf(item, m_root.item("meshes", mesh), targets);
		const bool moves = !pose.weights.empty() || pose.joints != nullptr;
		if (m_file.settings.pose == Pose::rest || (pose.joints != nullptr && !has_joints))
		{
			m_tallies["not-applied"].add("node '" + item.name() + "'", moves && node.instance.value_or(0) == 0 ? 1 : 0);
			pose = m_file.settings.pose == Pose::rest ? NodePose{} : NodePose{std::move(pose.weights), nullptr};
		}
		else
		{
			m_tallies["posed-meshes"].add("node '" + item.name() + "'", moves && node.instance.value_or(0) == 0 ? 1 : 0);
		}
		return pose;
	}

	void triangles(const Primitive& primitive, const glm::dmat4& world, const NodePose& pose)
	{
		const std::size_t count = primitive.triangleCount();
		if (count == 0)
		{
			return;
		}
		m_world = world;
		m_turn = normalsFrom(world);
		m_mirrored = glm::determinant(glm::dmat3(world)) < 0.0;
		const std::size_t vertices = primitive.positions->count();
		m_slot.resize(std::max(m_slot.size(), vertices));
		m_slot_of.resize(m_slot.size(), 0);
		m_current += 1;
		for (std::size_t i = 0; i < count; ++i)
		{
			const std::array<uint64_t, 3> corners = primitive.triangleAt(i);
			const bool inside = corners[0] < vertices && corners[1] < vertices && corners[2] < vertices;
			const bool joint = primitive.mode == kStrip && // strips are joined by degenerate triangles
							   (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]);
			if (!inside || joint)
			{
				continue;
			}
			glm::uvec3 triangle(0);
			for (int corner = 0; corner < 3; ++corner)
			{
				triangle[corner] = slotOf(primitive, static_cast<std::size_t>(corners[static_cast<std::size_t>(corner)]), pose);
			}
			if (m_mirrored)
			{
				std::swap(triangle.y, triangle.z);
			}
			m_level.triangles.push_back(triangle);
			m_level.materials.push_back(static_cast<uint32_t>(materialOf(primitive, corners)));
		}
	}

	std::size_t materialOf(const Primitive& primitive, const std::array<uint64_t, 3>& corners)
	{
		if (primitive.alphas == nullptr || primitive.ramp)
		{
			return primitive.material;
		}
		const double mean =
			(alphaAt(primitive, corners[0]) + alphaAt(primitive, corners[1]) + alphaAt(primitive, corners[2])) / 3.0;
		return variantOf(primitive.material, std::round(255.0 * mean) / 255.0, false);
	}

	// The level's vertex for one of the primitive's; created on first use, since primitives may share data they do not use.
	uint32_t slotOf(const Primitive& primitive, std::size_t vertex, const NodePose& pose)
	{
		if (m_slot_of[vertex] == m_current)
		{
			return m_slot[vertex];
		}
		m_slot_of[vertex] = m_current;
		m_slot[vertex] = static_cast<uint32_t>(m_level.positions.size());
		glm::dvec3 position = primitive.positions->vec3(vertex);
		glm::dvec3 normal = primitive.normals == nullptr ? glm::dvec3(0.0) : primitive.normals->vec3(vertex);
		primitive.pose.morph(pose.weights, vertex, position, normal);
		if (pose.joints != nullptr)
		{
			m_world = m_world_from_file * primitive.pose.skin(*pose.joints, vertex);
			m_turn = normalsFrom(m_world);
			m_mirrored = glm::determinant(glm::dmat3(m_world)) < 0.0; // the last corner decides: joints mirror all or none
		}
		m_level.positions.emplace_back(m_world * glm::dvec4(position, 1.0));
		m_level.normals.push_back(primitive.normals == nullptr ? glm::vec3(0.0F) : turnedNormal(m_turn, normal));
		glm::vec2 uv(0.0F);
		if (primitive.ramp)
		{
			uv = {(255.0 * alphaAt(primitive, vertex) + 0.5) / 256.0, 0.5};
		}
		else if (primitive.uvs != nullptr)
		{
			uv = glm::dvec2(m_source.materials[primitive.material].uv_of_set * glm::dvec3(primitive.uvs->vec2(vertex), 1.0));
		}
		m_level.uvs.push_back(uv);
		if (m_file.second_set == kPlacesSet)
		{
			m_source.places.back().vertices.emplace_back(static_cast<uint32_t>(vertex), m_slot[vertex]);
		}
		else if (m_file.second_set)
		{
			m_source.second_uvs.push_back(secondOf(primitive, vertex));
		}
		return m_slot[vertex];
	}

	static glm::vec2 secondOf(const Primitive& primitive, std::size_t vertex)
	{
		glm::vec2 second(std::numeric_limits<float>::quiet_NaN());
		if (primitive.second != nullptr)
		{
			second = primitive.second->vec2(vertex);
		}
		for (int side = 0; primitive.baked[0] != nullptr && side < 2; ++side)
		{
			const GltfValues* const of_side = primitive.baked[1] != nullptr && side == 1 ? primitive.baked[1] : primitive.baked[0];
			second[side] = static_cast<float>(of_side->number(vertex, 0));
		}
		return second;
	}

	GltfFile& m_file;
	JsonValue m_root;
	LevelSource& m_source;
	glm::dmat4 m_world_from_file;
	Level& m_level;

	std::map<std::size_t, GltfValues> m_values; // of the used accessors
	std::vector<std::vector<Primitive>> m_meshes;
	std::vector<std::size_t> m_uses; // of each mesh
	std::vector<int> m_parts;        // of each node: its index in the level's tree
	int m_mesh_part = -1;            // that of the current node's mesh
	SentTallies m_tallies;           // findings

	std::size_t m_default_material; // for primitives without a material
	std::map<std::tuple<std::size_t, double, bool>, std::size_t> m_variants;
	std::set<std::size_t> m_transmitting; // materials
	GltfPoses m_poses;

	// The transform of the current primitive, or of its current vertex with a skin.
	glm::dmat4 m_world{1.0};
	glm::dmat3 m_turn{1.0};
	bool m_mirrored = false;

	// The level's vertex for each of the primitive's, and the call of triangles() that created it.
	std::vector<uint32_t> m_slot;
	std::vector<uint64_t> m_slot_of;
	uint64_t m_current = 0;
};

} // namespace

void readMeshes(GltfFile& file, const std::vector<PlacedNode>& nodes, const glm::dmat4& world_from_file, LevelSource& source,
				Level& level)
{
	MeshBuilder(file, source, world_from_file, level).run(nodes);
}

} // namespace nook
