// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/fbx.h"

#include "core/lists.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <limits>

namespace nook
{
namespace
{

template <class T>
std::vector<T> arrayBelow(const FbxObjects& objects, const FbxObject& object, const FbxNode& parent, std::string_view name)
{
	const FbxNode* const node = parent.child(name);
	return node == nullptr ? std::vector<T>()
						   : objects.file.arrayOf<T>(*node, FbxObjects::placeOf(object) + ": " + std::string(name));
}

std::vector<glm::dvec3> vectorsBelow(const FbxObjects& objects, const FbxObject& object, std::string_view name)
{
	const std::vector<double> numbers = arrayBelow<double>(objects, object, *object.node, name);
	failIf(numbers.size() % 3 != 0, objects.file, FbxObjects::placeOf(object) + ": " + std::string(name),
		   std::to_string(numbers.size()) + " numbers", "three for each point");
	return listOf(numbers.size() / 3,
				  [&numbers](std::size_t i) { return glm::dvec3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]); });
}

FbxLayer::By mappingOf(const std::string& name)
{
	return name == "ByPolygonVertex"                   ? FbxLayer::By::corner
		   : name == "ByVertice" || name == "ByVertex" ? FbxLayer::By::point
		   : name == "ByPolygon"                       ? FbxLayer::By::polygon
		   : name == "AllSame"                         ? FbxLayer::By::all
													   : FbxLayer::By::other;
}

FbxLayer layerOf(const FbxObjects& objects, const FbxObject& geometry, const FbxNode& node, const std::string& values)
{
	FbxLayer layer;
	layer.name = objects.file.textBelow(node, "Name");
	layer.by = mappingOf(objects.file.textBelow(node, "MappingInformationType"));
	layer.values = arrayBelow<double>(objects, geometry, node, values);
	if (objects.file.textBelow(node, "ReferenceInformationType") != "Direct")
	{
		layer.indices = arrayBelow<int64_t>(objects, geometry, node, values + "Index");
	}
	return layer;
}

// Number of the element of a type that the first layer refers to.
int64_t defaultOf(const FbxObjects& objects, const FbxObject& geometry, std::string_view type)
{
	const FbxNode* const layer = geometry.node->child("Layer");
	for (std::size_t i = 0; layer != nullptr && i < layer->children.size(); ++i)
	{
		const FbxNode& element = layer->children[i];
		const FbxNode* const index = element.child("TypedIndex");
		if (element.name == "LayerElement" && objects.file.textBelow(element, "Type") == type && index != nullptr)
		{
			return wholeAt(*index, 0).value_or(0);
		}
	}
	return 0;
}

std::vector<FbxLayer> uvsOf(const FbxObjects& objects, const FbxObject& geometry)
{
	const int64_t first = defaultOf(objects, geometry, "LayerElementUV");
	std::vector<FbxLayer> sets;
	for (const FbxNode& node : geometry.node->children)
	{
		if (node.name == "LayerElementUV")
		{
			const bool is_default = wholeAt(node, 0).value_or(0) == first;
			sets.insert(is_default ? sets.begin() : sets.end(), layerOf(objects, geometry, node, "UV"));
		}
	}
	return sets;
}

// A shape at its full weight, in percent.
struct Target
{
	double full = 0.0;
	std::size_t shape = 0;          // object index; 0: the unmodified mesh
	double weight = 0.0;            // its weight
	std::vector<double> percents{}; // weight of each of its points; empty: 100 % for all
};

// Shapes are interpolated linearly between adjacent targets, and extrapolated from the last two.
std::vector<Target> targetsOf(const FbxObjects& objects, const FbxObject& channel)
{
	const std::vector<double> fulls = arrayBelow<double>(objects, channel, *channel.node, "FullWeights");
	std::vector<Target> targets(1);
	for (const std::size_t shape : objects.partsOf(channel, "Geometry", "Shape"))
	{
		const std::size_t i = targets.size() - 1;
		targets.push_back({i < fulls.size() ? fulls[i] : 100.0, shape});
	}
	const FbxNode* const own = channel.node->child("DeformPercent");
	const double percent = objects.number(channel, "DeformPercent", own == nullptr ? 0.0 : numberAt(*own, 0).value_or(0.0));
	if (targets.size() == 2 && fulls.size() > 1) // Blender's, per point of the single shape
	{
		targets[1].full = 100.0;
		targets[1].percents = fulls;
	}
	std::stable_sort(targets.begin(), targets.end(), [](const Target& a, const Target& b) { return a.full < b.full; });
	if (targets.size() > 1)
	{
		std::size_t i = 0;
		while (i + 2 < targets.size() && percent > targets[i + 1].full)
		{
			i += 1;
		}
		const double apart = targets[i + 1].full - targets[i].full;
		const double share = apart > 0.0 ? (percent - targets[i].full) / apart : 1.0;
		targets[i].weight = 1.0 - share;
		targets[i + 1].weight = share;
	}
	std::erase_if(targets, [](const Target& target) { return target.shape == 0 || target.weight == 0.0; });
	return targets;
}

// The parts of one kind of a geometry's deformers of another.
std::vector<std::size_t> partsOfParts(const FbxObjects& objects, const FbxObject& geometry, std::string_view deformers,
									  std::string_view kind)
{
	std::vector<std::size_t> all;
	for (const std::size_t deformer : objects.partsOf(geometry, {}, deformers))
	{
		append(all, objects.partsOf(objects[deformer], {}, kind));
	}
	return all;
}

std::vector<Target> targetsOfMesh(const FbxObjects& objects, const FbxObject& geometry)
{
	std::vector<Target> targets;
	for (const std::size_t channel : partsOfParts(objects, geometry, "BlendShape", "BlendShapeChannel"))
	{
		append(targets, targetsOf(objects, objects[channel]));
	}
	return targets;
}

// Checks an index of `Indexes` of a mesh with that many points.
std::size_t pointAt(const FbxObjects& objects, const FbxObject& object, int64_t index, std::size_t points)
{
	if (index < 0 || static_cast<std::size_t>(index) >= points)
	{
		objects.file.fail(FbxObjects::placeOf(object) + ": Indexes", std::to_string(index),
						  "one of " + std::to_string(points) + " points");
	}
	return static_cast<std::size_t>(index);
}

void applyShape(const FbxObjects& objects, const Target& target, std::vector<glm::dvec3>& points, std::vector<glm::dvec3>& turned)
{
	const FbxObject& shape = objects[target.shape];
	const std::vector<int64_t> indices = arrayBelow<int64_t>(objects, shape, *shape.node, "Indexes");
	const std::vector<glm::dvec3> moves = vectorsBelow(objects, shape, "Vertices");
	const std::vector<glm::dvec3> turns = vectorsBelow(objects, shape, "Normals");
	failIf(moves.size() != indices.size(), objects.file, FbxObjects::placeOf(shape), std::to_string(moves.size()) + " points",
		   std::to_string(indices.size()));
	for (std::size_t i = 0; i < indices.size(); ++i)
	{
		const std::size_t point = pointAt(objects, shape, indices[i], points.size());
		const double weight = target.weight * (i < target.percents.size() ? target.percents[i] / 100.0 : 1.0);
		points[point] += weight * moves[i];
		if (turns.size() == moves.size())
		{
			turned.resize(points.size(), glm::dvec3(0.0));
			turned[point] += weight * turns[i];
		}
	}
}

// Link modes of FBX.
enum class Link
{
	normalized, // weights are normalised by their sum
	total_one,  // the remainder to 1 stays with the node
	additive,   // each bone moves what the previous ones left
};

struct Bone
{
	const FbxObject* cluster = nullptr;
	const FbxPlace* place = nullptr;
};

// Clusters with a bone, from all skins of a mesh.
std::vector<Bone> bonesOf(const FbxObjects& objects, const FbxObject& geometry, const std::vector<const FbxPlace*>& worlds)
{
	std::vector<Bone> bones;
	for (const std::size_t cluster : partsOfParts(objects, geometry, "Skin", "Cluster"))
	{
		const std::vector<std::size_t> links = objects.partsOf(objects[cluster], "Model");
		if (!links.empty() && worlds[links.front()] != nullptr)
		{
			bones.push_back({&objects[cluster], worlds[links.front()]});
		}
	}
	return bones;
}

std::optional<glm::dmat4> matrixBelow(const FbxObjects& objects, const FbxObject& cluster, std::string_view name)
{
	const std::vector<double> numbers = arrayBelow<double>(objects, cluster, *cluster.node, name);
	failIf(numbers.size() != 16 && !numbers.empty(), objects.file, FbxObjects::placeOf(cluster) + ": " + std::string(name),
		   std::to_string(numbers.size()) + " numbers", "16");
	return numbers.empty() ? std::nullopt : std::optional(glm::make_mat4(numbers.data()));
}

// Transform from a point of the mesh to its current position with a bone.
glm::dmat4 worldOfBone(const FbxObjects& objects, const Bone& bone, const FbxPlace& mesh)
{
	std::optional<glm::dmat4> bone_from_mesh = matrixBelow(objects, *bone.cluster, "Transform");
	if (!bone_from_mesh)
	{
		const std::optional<glm::dmat4> bound = matrixBelow(objects, *bone.cluster, "TransformLink");
		bone_from_mesh = glm::inverse(bound.value_or(bone.place->world)) * mesh.world;
	}
	return bone.place->world * *bone_from_mesh * mesh.geometric;
}

// Weighted sum of transforms as dual quaternions, and of the stretches that these cannot represent.
//
// This work is based on:
//   Ladislav Kavan, Steven Collins, Jiri Zara, Carol O'Sullivan: Skinning with Dual Quaternions. I3D 2007.
struct DualSum
{
	glm::dquat turn{0.0, 0.0, 0.0, 0.0};
	glm::dquat move{0.0, 0.0, 0.0, 0.0};
	glm::dmat3 stretch{0.0};

	explicit DualSum() = default;

	// Starts with one matrix without a projective part.
	explicit DualSum(const glm::dmat4& matrix)
	{
		const glm::dmat3 linear(matrix);
		const double side = glm::determinant(linear) < 0.0 ? -1.0 : 1.0; // a reflection becomes a stretch
		const glm::dvec3 x = glm::normalize(side * linear[0]);
		const glm::dvec3 z = glm::normalize(glm::cross(x, side * linear[1]));
		const glm::dmat3 turned(x, glm::cross(z, x), z);
		turn = glm::quat_cast(turned);
		move = glm::dquat(0.0, glm::dvec3(matrix[3])) * turn * 0.5;
		stretch = glm::transpose(turned) * linear;
	}

	void add(const DualSum& other, double weight)
	{
		const double near = glm::dot(turn, other.turn) < 0.0 ? -weight : weight; // takes the shorter rotation
		turn = turn + other.turn * near;
		move = move + other.move * near;
		stretch += weight * other.stretch;
	}

	glm::dmat4 matrix(double weights) const
	{
		const double length = glm::length(turn);
		const glm::dquat unit = turn / length;
		const glm::dquat moved = (move / length) * glm::conjugate(unit) * 2.0;
		glm::dmat4 matrix(glm::mat3_cast(unit) * (stretch / weights));
		matrix[3] = glm::dvec4(moved.x, moved.y, moved.z, 1.0);
		return matrix;
	}
};

class Skin
{
public:
	Skin(const FbxObjects& objects, const FbxObject& geometry, const FbxPlace& mesh, std::size_t points)
		: m_objects(objects), m_mesh(mesh), m_rest(mesh.world * mesh.geometric), m_matrices(points, glm::dmat4(0.0)),
		  m_sums(points, 0.0)
	{
		for (const std::size_t index : objects.partsOf(geometry, {}, "Skin"))
		{
			const FbxObject& skin = objects[index];
			const std::string type = objects.file.textBelow(*skin.node, "SkinningType");
			if (type != "DualQuaternion" && type != "Blend")
			{
				continue;
			}
			m_duals.resize(points);
			m_dual_shares.resize(points, type == "Blend" ? 0.0 : 1.0);
			const std::vector<int64_t> indices = arrayBelow<int64_t>(objects, skin, *skin.node, "Indexes");
			const std::vector<double> shares = arrayBelow<double>(objects, skin, *skin.node, "BlendWeights");
			for (std::size_t i = 0; type == "Blend" && i < std::min(shares.size(), indices.size()); ++i)
			{
				m_dual_shares[pointAt(objects, skin, indices[i], points)] = shares[i];
			}
		}
	}

	std::vector<glm::dmat4> run(const std::vector<Bone>& bones)
	{
		const std::string mode = m_objects.file.textBelow(*bones.front().cluster->node, "Mode");
		m_link = mode == "Additive" ? Link::additive : mode == "Total1" || mode == "TotalOne" ? Link::total_one : Link::normalized;
		for (const Bone& bone : bones)
		{
			add(bone);
		}
		for (std::size_t i = 0; i < m_matrices.size(); ++i)
		{
			const double sum = m_sums[i];
			if (sum == 0.0)
			{
				m_matrices[i] = m_rest;
			}
			else if (m_link != Link::additive)
			{
				glm::dmat4 held = m_matrices[i] / sum;
				held += m_duals.empty() ? glm::dmat4(0.0) : m_dual_shares[i] * (m_duals[i].matrix(sum) - held);
				m_matrices[i] = m_link == Link::normalized ? held : sum * held + (1.0 - sum) * m_rest;
			}
		}
		return std::move(m_matrices);
	}

private:
	void add(const Bone& bone)
	{
		const FbxObject& cluster = *bone.cluster;
		const std::vector<int64_t> indices = arrayBelow<int64_t>(m_objects, cluster, *cluster.node, "Indexes");
		const std::vector<double> weights = arrayBelow<double>(m_objects, cluster, *cluster.node, "Weights");
		failIf(indices.size() != weights.size(), m_objects.file, FbxObjects::placeOf(cluster) + ": Weights",
			   std::to_string(weights.size()) + " numbers", std::to_string(indices.size()) + ", one for each of Indexes");
		const glm::dmat4 world = worldOfBone(m_objects, bone, m_mesh);
		const glm::dmat4 mesh_from_world = glm::inverse(m_rest);
		const DualSum dual(world);
		for (std::size_t i = 0; i < indices.size(); ++i)
		{
			const std::size_t point = pointAt(m_objects, cluster, indices[i], m_matrices.size());
			const double weight = weights[i];
			if (m_link == Link::additive && weight != 0.0)
			{
				const glm::dmat4 before = m_sums[point] == 0.0 ? m_rest : m_matrices[point];
				m_matrices[point] = (weight * world * mesh_from_world + (1.0 - weight) * glm::dmat4(1.0)) * before;
				m_sums[point] = 1.0;
				continue;
			}
			m_matrices[point] += weight * world;
			m_sums[point] += weight;
			if (!m_duals.empty())
			{
				m_duals[point].add(dual, weight);
			}
		}
	}

	const FbxObjects& m_objects;
	const FbxPlace& m_mesh;
	glm::dmat4 m_rest; // transform of points without bones
	Link m_link = Link::normalized;
	std::vector<glm::dmat4> m_matrices; // per point
	std::vector<double> m_sums;         // sums of weights
	std::vector<DualSum> m_duals;       // likewise as dual quaternions; empty if no skin uses them
	std::vector<double> m_dual_shares;
};

} // namespace

std::optional<std::size_t> FbxLayer::elementAt(std::size_t corner, std::size_t point, std::size_t polygon, std::size_t width) const
{
	if (by == By::other)
	{
		return std::nullopt;
	}
	std::size_t element = by == By::corner ? corner : by == By::point ? point : by == By::polygon ? polygon : 0;
	if (!indices.empty())
	{
		if (element >= indices.size() || indices[element] < 0)
		{
			return std::nullopt;
		}
		element = static_cast<std::size_t>(indices[element]);
	}
	return element < values.size() / width ? std::optional(element) : std::nullopt;
}

FbxLayer readFbxMaterials(const FbxObjects& objects, const FbxObject& geometry)
{
	const FbxNode* const node = geometry.node->child("LayerElementMaterial");
	FbxLayer layer;
	if (node != nullptr)
	{
		layer.by = mappingOf(objects.file.textBelow(*node, "MappingInformationType"));
		layer.values = arrayBelow<double>(objects, geometry, *node, "Materials");
	}
	return layer;
}

FbxMesh readFbxMesh(const FbxObjects& objects, const FbxObject& geometry)
{
	FbxMesh mesh;
	mesh.points = vectorsBelow(objects, geometry, "Vertices");
	// The last corner of a polygon is stored as −1 − its point.
	for (const int64_t index : arrayBelow<int64_t>(objects, geometry, *geometry.node, "PolygonVertexIndex"))
	{
		const int64_t point = index < 0 ? -1 - index : index;
		mesh.corners.push_back(point < std::numeric_limits<uint32_t>::max() ? static_cast<uint32_t>(point) : ~0U);
		if (index < 0)
		{
			mesh.ends.push_back(mesh.corners.size());
		}
	}
	if (!mesh.corners.empty() && (mesh.ends.empty() || mesh.ends.back() != mesh.corners.size()))
	{
		mesh.ends.push_back(mesh.corners.size());
	}
	if (const FbxNode* const normals = geometry.node->child("LayerElementNormal"))
	{
		mesh.normals = layerOf(objects, geometry, *normals, "Normals");
	}
	mesh.materials = readFbxMaterials(objects, geometry);
	mesh.uvs = uvsOf(objects, geometry);
	return mesh;
}

bool isPosed(const FbxObjects& objects, const FbxObject& geometry)
{
	const std::vector<std::size_t> clusters = partsOfParts(objects, geometry, "Skin", "Cluster");
	return std::any_of(clusters.begin(), clusters.end(),
					   [&](std::size_t cluster) { return !objects.partsOf(objects[cluster], "Model").empty(); }) ||
		   !targetsOfMesh(objects, geometry).empty();
}

std::vector<glm::dmat4> poseFbxMesh(const FbxObjects& objects, const FbxObject& geometry, const FbxPlace& place,
									const std::vector<const FbxPlace*>& worlds, std::vector<glm::dvec3>& points,
									std::vector<glm::dvec3>& turned)
{
	for (const Target& target : targetsOfMesh(objects, geometry))
	{
		applyShape(objects, target, points, turned);
	}
	const std::vector<Bone> bones = bonesOf(objects, geometry, worlds);
	return bones.empty() ? std::vector<glm::dmat4>() : Skin(objects, geometry, place, points.size()).run(bones);
}

} // namespace nook
