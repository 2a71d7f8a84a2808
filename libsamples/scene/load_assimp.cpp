// SPDX-License-Identifier: GPL-3.0-or-later
// The worker linked to Assimp 5.2.5 (core/isolate.h); only this file uses it. It sends what it finds piece by
// piece.
//
// Assimp gives 32-bit positions in the file's own units, and texture coordinates with v upward for every format. It triangulates
// concave polygons incorrectly, so scene/triangulate.cpp does that here. FBX is read by fbx_source.cpp.
#include "core/file.h"
#include "core/isolate.h"
#include "core/words.h"
#include "scene/cut_faces.h"
#include "scene/fbx.h"
#include "scene/load.h"
#include "scene/load_parts.h"
#include "scene/mesh_codec.h"
#include "scene/mesh_text.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/GltfMaterial.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <glm/matrix.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

namespace nook
{
namespace
{

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// glTF writes blanks as %20, which Assimp leaves unchanged.
std::string pathOf(const char* file)
{
	std::error_code failed;
	return std::filesystem::exists(file, failed) ? std::string(file) : unescaped(file);
}

// Devices and pipes have no end.
bool isFile(const std::string& path)
{
	std::error_code failed;
	return std::filesystem::is_regular_file(path, failed);
}

// `bytes` must outlive the stream. The importer deletes it.
Assimp::IOStream* streamOf(const std::string& bytes)
{
	return new Assimp::MemoryIOStream(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()); // NOLINT
}

class AssimpFiles : public Assimp::DefaultIOSystem
{
public:
	AssimpFiles(std::string level_path, const LoadSettings& settings) : m_level_path(std::move(level_path)), m_settings(settings) {}

	bool Exists(const char* file) const override
	{
		return isFile(pathOf(file)); // Assimp's own check opens it, and would block on a pipe
	}

	Assimp::IOStream* Open(const char* file, const char* mode) override
	{
		const std::string path = pathOf(file);
		if (!isFile(path))
		{
			addFile(missing, path);
			return nullptr;
		}
		try
		{
			Assimp::IOStream* const stream = streamOfFile(path, mode);
			addFile(stream == nullptr ? missing : opened, path);
			return stream;
		}
		catch (const Error& error)
		{
			if (error.code() == ExitCode::file)
			{
				addFile(missing, path); // cannot be opened
			}
			else if (!refused)
			{
				refused = error; // Assimp would report a missing file, or something unrelated
			}
			return nullptr;
		}
	}

	std::vector<std::string> opened;  // without duplicates
	std::vector<std::string> missing; // without duplicates
	std::optional<Error> refused;     // reason for the first file that was rejected

	// Read here because Assimp does not provide it:
	MtlMaterials materials;
	std::vector<glm::dvec3> exact;   // positions; empty: Assimp's 32 bits suffice. For OBJ by number, else in order
	std::vector<std::string> solids; // names in an STL file, one per mesh

private:
	// Replacement text of the level's file for Assimp; none: use the file itself.
	std::optional<std::string> levelText()
	{
		std::string bytes = readFile(m_level_path);
		const bool marked = bytes.starts_with(kByteOrderMark); // Assimp would take the mark for a part of the first word
		bytes.erase(0, marked ? kByteOrderMark.size() : 0);
		const std::string ending = endingOf(m_level_path);
		std::optional<std::string> repaired = ending == ".obj"   ? repairedObj(bytes, m_level_path, exact)
											  : ending == ".ply" ? repairedPly(bytes, m_level_path, exact)
											  : ending == ".stl" ? repairedStl(bytes, m_level_path, exact, solids)
																 : std::nullopt;
		return repaired || !marked ? std::move(repaired) : std::optional(std::move(bytes));
	}

	// Throws Error if the file must not be read, or is not what its name says.
	Assimp::IOStream* streamOfFile(const std::string& path, const char* mode)
	{
		if (path == m_level_path)
		{
			if (!m_has_read) // opened once for its size, then for its text
			{
				m_text = levelText();
				m_has_read = true;
			}
			return m_text ? streamOf(*m_text) : DefaultIOSystem::Open(path.c_str(), mode);
		}
		const bool is_obj = endingOf(m_level_path) == ".obj";
		checkInside(m_level_path, is_obj ? "mtllib" : "reference", path, m_settings);
		if (!is_obj)
		{
			return DefaultIOSystem::Open(path.c_str(), mode);
		}
		std::string bytes = readFile(path);
		bytes.erase(0, bytes.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
		m_names = readMtl(bytes, path, materials);
		return streamOf(m_names);
	}

	std::string m_level_path;
	LoadSettings m_settings;
	bool m_has_read = false;           // the level's file
	std::optional<std::string> m_text; // the level's text for Assimp; none: the file itself
	std::string m_names;               // of the materials in the current MTL file
};

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
		sendTallies(tallies, m_to);
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
			// Only OBJ has pictures of opacity, which readMtl() reads.
			send({}, {}, glm::dmat3(1.0), {});
			send(material.GetTexture(aiTextureType_DIFFUSE, 0, &text) == AI_SUCCESS ? textOf(text) : std::string(), {},
				 glm::dmat3(1.0), {});
		}
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
			refuseInput(m_path, std::to_string(exact) + " positions, of which " + std::to_string(count) + " belong to a surface",
						"all of them");
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
		checkCounts(m_path, triangles, vertices, ", counting every instance");
	}

	void send(const aiMesh& mesh, const std::string& name, const glm::dmat4& world)
	{
		m_to.value(MeshHead{mesh.mMaterialIndex, false});
		m_to.text(name);
		m_to.value(uint32_t{0}); // names of a path, which none of these formats has
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
	LoadSettings settings;
	static_cast<FileSettings&>(settings) = request.value<FileSettings>();
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
