// SPDX-License-Identifier: GPL-3.0-or-later
// The worker linked to Assimp 5.2.5 (core/isolate.h); only this file and assimp_files.cpp use it. It sends what it finds piece by
// piece.
//
// Assimp gives 32-bit positions in the file's own units, and texture coordinates with v upward for every format. It triangulates
// concave polygons incorrectly, so scene/triangulate.h does that here. FBX is read by fbx_source.h.
#include "scene/load_parts.h"

#include "core/error.h"
#include "core/worker.h"
#include "scene/assimp_files.h"
#include "scene/cut_faces.h"
#include "scene/fbx_mesh.h"
#include "scene/mesh_codec.h"
#include "scene/mesh_text.h"

#include <assimp/GltfMaterial.h>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

namespace nook
{
namespace
{

glm::dmat4 matrixOf(const aiMatrix4x4& m)
{
	return {glm::dvec4(m.a1, m.b1, m.c1, m.d1), glm::dvec4(m.a2, m.b2, m.c2, m.d2), glm::dvec4(m.a3, m.b3, m.c3, m.d3),
			glm::dvec4(m.a4, m.b4, m.c4, m.d4)};
}

glm::dvec3 vectorOf(const aiVector3D& v)
{
	return {v.x, v.y, v.z};
}

std::string textOf(const aiString& text)
{
	return {text.C_Str(), ::strnlen(text.C_Str(), std::min<std::size_t>(text.length, sizeof text.data - 1))};
}

class Sender
{
public:
	Sender(const aiScene& scene, const std::string& path, const AssimpFiles& files, const LoadSettings& settings,
		   const glm::dmat4& world_from_file, ValueWriter& to)
		: m_scene(scene), m_path(path), m_files(files), m_is_obj(endingOf(path) == ".obj"), m_tr(settings.tr),
		  m_world_from_file(world_from_file), m_to(to)
	{
	}

	void run()
	{
		materials();
		m_to.value(uint32_t{0}); // number of cameras, which none of these formats has
		meshes();
		SentTallies tallies{{"points-or-lines", m_faces.lines},
							{"bad-polygons", m_faces.bad_polygons},
							{"inverted-transparency", m_inverted},
							{"not-applied", m_not_applied}};
		for (const std::string_view id : kSentFindings)
		{
			m_to.value(tallies[id].count);
			m_to.text(tallies[id].first);
		}
		for (const std::vector<std::string>& list : {m_files.opened, m_files.missing})
		{
			m_to.value(uint64_t{list.size()});
			for (const std::string& file : list)
			{
				m_to.text(file);
			}
		}
	}

private:
	// Sends a material of an MTL file; Assimp provides only its name.
	void send(const std::string& name, const MtlMaterial& material)
	{
		bool inverted = false;
		m_to.value(opacityOf(material, m_tr, inverted));
		m_inverted.add("material '" + name + "'", inverted ? 1 : 0);
		m_not_applied.add("material '" + name + "', map_d " + material.ignored, material.ignored.empty() ? 0 : 1);
		m_to.value(0); // not two-sided
		send(material.mask.name, material.mask, material.uv_of_set, {});
		send(material.colour, {}, glm::dmat3(1.0), {});
	}

	void send(const std::string& picture, const MaskUse& use, const glm::dmat3& uv_of_set, const std::vector<char>& bytes)
	{
		m_to.text(picture);
		m_to.value(use);
		m_to.value(uv_of_set);
		m_to.values(bytes);
	}

	// OBJ has no alpha mode: an opacity texture makes a mask, an opacity below 1 without one makes a blended material.
	void materials()
	{
		const uint32_t count = m_scene.mNumMaterials;
		m_to.value(count);
		for (uint32_t i = 0; i < count; ++i)
		{
			const aiMaterial& material = *m_scene.mMaterials[i];
			aiString text;
			const std::string name = material.Get(AI_MATKEY_NAME, text) == AI_SUCCESS ? textOf(text) : std::string();
			m_to.text(name);
			if (const auto known = m_files.materials.find(name); known != m_files.materials.end())
			{
				send(name, known->second);
				continue;
			}
			float opacity = 1.0F;
			material.Get(AI_MATKEY_OPACITY, opacity);
			m_to.value(opacity);
			int two_sided = 0;
			material.Get(AI_MATKEY_TWOSIDED, two_sided);
			m_to.value(two_sided);
			texture(material, aiTextureType_OPACITY);
			texture(material, aiTextureType_DIFFUSE);
		}
	}

	// Sends name and wrap modes.
	void texture(const aiMaterial& material, aiTextureType type)
	{
		aiString path;
		std::array<aiTextureMapMode, 2> wrap{aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
		const bool found = material.GetTexture(type, 0, &path, nullptr, nullptr, nullptr, nullptr, wrap.data()) == AI_SUCCESS;
		const auto wrapOf = [](aiTextureMapMode mode)
		{
			return mode == aiTextureMapMode_Mirror ? Wrap::mirror : mode == aiTextureMapMode_Clamp ? Wrap::clamp : Wrap::repeat;
		};
		send(found ? textOf(path) : std::string(), MaskUse{wrapOf(wrap[0]), wrapOf(wrap[1]), MaskChannel::alpha_or_first},
			 glm::dmat3(1.0), {});
	}

	// Sends every node's meshes, parents first, children in order.
	void meshes()
	{
		std::vector<uint32_t> uses(m_scene.mNumMeshes, 0);
		std::vector<std::pair<const aiNode*, glm::dmat4>> open{{m_scene.mRootNode, m_world_from_file}};
		std::vector<std::pair<const aiNode*, glm::dmat4>> nodes;
		while (!open.empty())
		{
			auto [node, parent] = open.back();
			open.pop_back();
			const glm::dmat4 world = parent * matrixOf(node->mTransformation);
			if (node->mNumMeshes > 0)
			{
				nodes.emplace_back(node, world);
			}
			for (uint32_t i = 0; i < node->mNumMeshes; ++i)
			{
				uses[node->mMeshes[i]] += 1;
			}
			for (uint32_t i = node->mNumChildren; i > 0; --i)
			{
				open.emplace_back(node->mChildren[i - 1], world);
			}
		}
		checkSize(uses);
		const std::vector<std::size_t> firsts = firstPositions();
		for (const auto& [node, world] : nodes)
		{
			for (uint32_t i = 0; i < node->mNumMeshes; ++i)
			{
				const aiMesh& mesh = *m_scene.mMeshes[node->mMeshes[i]];
				m_first = firsts[node->mMeshes[i]];
				std::string name = m_files.solids.empty() ? textOf(mesh.mName) : m_files.solids.at(node->mMeshes[i]);
				const std::string place = textOf(node->mName);
				if (name.empty() || uses[node->mMeshes[i]] > 1)
				{
					name = name.empty() ? place : place + "/" + name;
				}
				send(mesh, name.empty() ? "mesh " + std::to_string(node->mMeshes[i]) : name, world);
			}
		}
		m_to.value(MeshHead{0, true});
	}

	// For each mesh the number of positions before it in the file.
	std::vector<std::size_t> firstPositions() const
	{
		std::vector<std::size_t> firsts;
		std::size_t count = 0;
		for (uint32_t i = 0; i < m_scene.mNumMeshes; ++i)
		{
			firsts.push_back(count);
			count += m_scene.mMeshes[i]->mNumVertices;
		}
		if (const std::size_t exact = m_files.exact.size(); exact > 0 && exact != count && !m_is_obj)
		{
			throw Error(ExitCode::invalid_input, m_path + ": found " + std::to_string(exact) + " positions, of which " +
													 std::to_string(count) + " belong to a surface, expected all of them");
		}
		return firsts;
	}

	// With the file's full precision.
	glm::dvec3 positionOf(const aiMesh& mesh, std::size_t vertex) const
	{
		const aiVector3D& v = mesh.mVertices[vertex];
		return m_files.exact.empty() ? vectorOf(v)
			   : m_is_obj            ? exactPosition(m_files.exact, {v.x, v.y, v.z})
									 : m_files.exact[m_first + vertex];
	}

	void checkSize(const std::vector<uint32_t>& uses) const
	{
		uint64_t triangles = 0;
		uint64_t vertices = 0;
		for (std::size_t i = 0; i < uses.size(); ++i)
		{
			triangles += uint64_t{uses[i]} * m_scene.mMeshes[i]->mNumFaces;
			vertices += uint64_t{uses[i]} * m_scene.mMeshes[i]->mNumVertices;
		}
		if (triangles > kMaxTriangles || vertices > 3 * uint64_t{kMaxTriangles})
		{
			throw Error(ExitCode::invalid_input,
						m_path + ": found " + std::to_string(triangles) + " triangles of " + std::to_string(vertices) +
							" vertices, counting every instance, expected at most " + std::to_string(kMaxTriangles));
		}
	}

	void send(const aiMesh& mesh, const std::string& name, const glm::dmat4& world)
	{
		m_to.value(MeshHead{mesh.mMaterialIndex, false});
		m_to.text(name);
		positions(mesh, world);
		normals(mesh, world);
		uvs(mesh);
		faces(mesh, name, glm::determinant(glm::dmat3(world)) < 0.0);
	}

	void positions(const aiMesh& mesh, const glm::dmat4& world)
	{
		m_positions.resize(mesh.mVertices == nullptr ? 0 : mesh.mNumVertices);
		for (std::size_t i = 0; i < m_positions.size(); ++i)
		{
			m_positions[i] = glm::dvec3(world * glm::dvec4(positionOf(mesh, i), 1.0));
		}
		m_to.values(m_positions);
	}

	void normals(const aiMesh& mesh, const glm::dmat4& world)
	{
		const glm::dmat3 turn = normalsFrom(world);
		m_normals.clear();
		// All zero is an STL's way to say that there are none.
		const auto isZero = [](const aiVector3D& n)
		{
			return n.x == 0.0F && n.y == 0.0F && n.z == 0.0F;
		};
		if (mesh.mNormals != nullptr && !std::all_of(mesh.mNormals, mesh.mNormals + m_positions.size(), isZero))
		{
			m_normals.reserve(m_positions.size());
			for (std::size_t i = 0; i < m_positions.size(); ++i)
			{
				m_normals.push_back(turnedNormal(turn, vectorOf(mesh.mNormals[i])));
			}
		}
		m_to.values(m_normals);
	}

	void uvs(const aiMesh& mesh)
	{
		m_uvs.clear();
		if (mesh.mTextureCoords[0] != nullptr)
		{
			m_uvs.reserve(m_positions.size());
			for (std::size_t i = 0; i < m_positions.size(); ++i)
			{
				const aiVector3D& uv = mesh.mTextureCoords[0][i];
				m_uvs.emplace_back(uv.x, 1.0 - static_cast<double>(uv.y));
			}
		}
		m_to.values(m_uvs);
	}

	void faces(const aiMesh& mesh, const std::string& name, bool mirrored)
	{
		m_faces.start(name, m_positions, mirrored);
		for (uint32_t f = 0; f < mesh.mNumFaces; ++f)
		{
			m_faces.add({mesh.mFaces[f].mIndices, mesh.mFaces[f].mNumIndices});
		}
		m_to.values(m_faces.triangles);
	}

	const aiScene& m_scene;
	const std::string& m_path;
	const AssimpFiles& m_files;
	bool m_is_obj;
	TrMeaning m_tr;
	glm::dmat4 m_world_from_file;
	ValueWriter& m_to;

	FaceCutter m_faces;
	Tally m_inverted;                    // materials
	Tally m_not_applied;                 // materials
	std::size_t m_first = 0;             // first position of the current mesh in the file
	std::vector<glm::dvec3> m_positions; // of the current mesh
	std::vector<glm::vec3> m_normals;
	std::vector<glm::vec2> m_uvs;
};

void readLevelFile(ValueReader& request, ValueWriter& answer)
{
	const std::string path = request.text();
	const auto settings = request.value<LoadSettings>();
	if (endingOf(path) == ".fbx")
	{
		sendFbx(path, settings, answer);
		return;
	}
	Assimp::Importer importer;
	auto* const files = new AssimpFiles(path, settings); // NOLINT: the importer deletes it
	importer.SetIOHandler(files);
	const aiScene* const scene = importer.ReadFile(path, 0);
	if (files->refused)
	{
		throw *files->refused;
	}
	if (scene == nullptr || scene->mRootNode == nullptr)
	{
		// It may quote the rest of the file.
		const std::string reason = importer.GetErrorString();
		throw Error(ExitCode::invalid_input, path + ": found \"" + (reason.size() > 200 ? reason.substr(0, 200) + "..." : reason) +
												 "\", expected a level that Assimp can read");
	}
	Sender(*scene, path, *files, settings, worldFromFile(settings), answer).run();
}

} // namespace
} // namespace nook

int main(int argc, char** argv)
{
	using namespace nook;
	static constexpr WorkerFunction kFunctions[]
	{
		{kReadLevel, readLevelFile}, {kDecodeMeshopt, decodeMeshopt},
#if NOOK_HAS_DRACO
			{kDecodeDraco, decodeDraco},
#endif
	};
	return serveRequests(argc, argv, kFunctions);
}
