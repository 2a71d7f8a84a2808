// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gltf_pose.h"

#include "core/error.h"
#include "scene/gltf_source.h"

#include <algorithm>
#include <optional>

namespace nook
{
namespace
{

// Transforms of all nodes, whether in a scene or not.
std::vector<glm::dmat4> worldsOf(const std::vector<JsonValue>& nodes)
{
	std::vector<std::vector<std::size_t>> children;
	std::vector<bool> is_root(nodes.size(), true);
	for (const JsonValue& node : nodes)
	{
		for (const std::size_t child : children.emplace_back(node.indices("children", nodes.size())))
		{
			is_root[child] = false;
		}
	}
	std::vector<glm::dmat4> worlds(nodes.size(), glm::dmat4(1.0)); // of a node's parent until the node is processed
	std::vector<std::size_t> open;
	for (std::size_t i = 0; i < nodes.size(); ++i)
	{
		if (is_root[i])
		{
			open.push_back(i);
		}
	}
	while (!open.empty())
	{
		const std::size_t node = open.back();
		open.pop_back();
		worlds[node] = worlds[node] * localOf(nodes[node]);
		for (const std::size_t child : children[node])
		{
			worlds[child] = worlds[node];
			open.push_back(child);
		}
	}
	return worlds;
}

} // namespace

const std::vector<glm::dmat4>& GltfPoses::jointsOf(std::size_t skin)
{
	const auto [found, is_new] = m_joints.try_emplace(skin);
	if (!is_new)
	{
		return found->second;
	}
	const JsonValue root = m_file.root();
	const std::vector<JsonValue> nodes = root.objects("nodes");
	if (m_worlds.empty())
	{
		m_worlds = worldsOf(nodes);
	}
	const JsonValue item = root.item("skins", skin);
	const std::vector<std::size_t> joints = item.indices("joints", nodes.size());
	if (joints.empty())
	{
		item.fail("joints", "none", "nodes that move the skin");
	}
	std::optional<GltfValues> inverse;
	if (const std::optional<std::size_t> accessor = item.index("inverseBindMatrices", root.count("accessors")))
	{
		const JsonValue matrices = root.item("accessors", *accessor);
		inverse.emplace(m_file, *accessor);
		if (matrices.text("type") != "MAT4" || matrices.wholeNeeded("componentType", UINT16_MAX) != 5126 ||
			inverse->count() < joints.size())
		{
			item.fail("inverseBindMatrices", std::to_string(inverse->count()) + " values of type " + matrices.text("type"),
					  std::to_string(joints.size()) + " of type MAT4 of 5126, as many as joints");
		}
	}
	for (std::size_t i = 0; i < joints.size(); ++i)
	{
		glm::dmat4 bind(1.0);
		for (std::size_t k = 0; inverse && k < 16; ++k)
		{
			bind[static_cast<int>(k / 4)][static_cast<int>(k % 4)] = inverse->number(i, k);
		}
		found->second.push_back(m_worlds[joints[i]] * bind);
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
			throw Error(ExitCode::invalid_input, where + ": found joint " + std::to_string(static_cast<uint64_t>(joint)) +
													 " at vertex " + std::to_string(vertex) + ", expected one below " +
													 std::to_string(matrices.size()));
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

} // namespace nook
