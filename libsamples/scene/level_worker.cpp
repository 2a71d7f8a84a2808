// SPDX-License-Identifier: GPL-3.0-or-later
// The worker that reads levels of formats with polygons (core/isolate.h), and decodes compressed glTF. It sends what it finds
// piece by piece.
#include "core/isolate.h"
#include "scene/fbx.h"
#include "scene/load.h"
#include "scene/load_parts.h"
#include "scene/mesh_codec.h"
#include "scene/mesh_text.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

// OBJ has no alpha mode: an opacity texture makes a mask, an opacity below 1 without one makes a blended material.
void sendMaterial(MtlMaterial& material, TrMeaning tr, SentTallies& tallies, ValueWriter& to)
{
	bool inverted = false;
	material.alpha = opacityOf(material, tr, inverted);
	send<FileMaterial>(material, to);
	const std::string place = "material '" + material.name + "'";
	tallies["inverted-transparency"].add(place, inverted ? 1 : 0);
	tallies["not-applied"].add(place + ", map_d " + material.ignored, material.ignored.empty() ? 0 : 1);
}

void checkSize(const std::vector<FileMesh>& meshes, const std::string& path)
{
	uint64_t triangles = 0;
	uint64_t vertices = 0;
	for (const FileMesh& mesh : meshes)
	{
		triangles += mesh.corners.size() - std::min(mesh.corners.size(), 2 * mesh.ends.size());
		vertices += mesh.positions.size();
	}
	checkCounts(path, triangles, vertices, "");
}

// From the file's units and axes to metres, and to v downward.
void placeMesh(FileMesh& mesh, const glm::dmat4& world_from_file)
{
	for (glm::dvec3& position : mesh.positions)
	{
		position = glm::dvec3(world_from_file * glm::dvec4(position, 1.0));
	}
	// All zero is an STL's way to say that there are none.
	const bool has_normals =
		std::any_of(mesh.normals.begin(), mesh.normals.end(), [](glm::vec3 normal) { return normal != glm::vec3(0.0F); });
	mesh.normals.resize(has_normals ? mesh.positions.size() : 0, glm::vec3(0.0F));
	const glm::dmat3 turn = normalsFrom(world_from_file);
	for (glm::vec3& normal : mesh.normals)
	{
		normal = turnedNormal(turn, normal);
	}
	mesh.colours.resize(mesh.colours.empty() ? 0 : mesh.positions.size(), glm::vec3(1.0F));
	mesh.uvs.resize(mesh.uvs.empty() ? 0 : mesh.positions.size(), glm::vec2(0.0F));
	for (glm::vec2& uv : mesh.uvs)
	{
		uv = {std::isfinite(uv.x) ? uv.x : 0.0F, 1.0F - (std::isfinite(uv.y) ? uv.y : 0.0F)};
	}
}

void sendFile(MeshFile file, const std::string& path, const LoadSettings& settings, ValueWriter& to)
{
	SentTallies tallies;
	to.value(static_cast<uint32_t>(file.materials.list.size()));
	for (MtlMaterial& material : file.materials.list)
	{
		sendMaterial(material, settings.tr, tallies, to);
	}
	to.value(uint32_t{0}); // number of cameras, which none of these formats has
	checkSize(file.meshes, path);
	FaceCutter faces;
	for (std::size_t i = 0; i < file.meshes.size(); ++i)
	{
		FileMesh& mesh = file.meshes[i];
		mesh.name = mesh.name.empty() ? "mesh " + std::to_string(i) : mesh.name;
		placeMesh(mesh, worldFromFile(settings));
		faces.send(mesh, {}, false, to);
		mesh = {};
	}
	to.value(MeshHead{0, true});
	to.value(uint64_t{file.vertices});
	tallies["points-or-lines"] = faces.lines;
	tallies["bad-polygons"] = faces.bad_polygons;
	sendTallies(tallies, to);
	send(file.files, to);
	send(file.missing, to);
}

void readLevelFile(ValueReader& request, ValueWriter& answer)
{
	const std::string path = request.text();
	LoadSettings settings;
	static_cast<FileSettings&>(settings) = request.value<FileSettings>();
	const std::string ending = endingOf(path);
	if (ending == ".fbx")
	{
		sendFbx(path, settings, answer);
		return;
	}
	const std::string bytes = readMeshText(path);
	MeshFile file = ending == ".obj"   ? readObj(bytes, path, settings)
					: ending == ".ply" ? readPly(bytes, path)
									   : readStl(bytes, path);
	sendFile(std::move(file), path, settings, answer);
}

using ViewDecoder = int (*)(void* bytes, std::size_t count, std::size_t stride, const unsigned char* coded, std::size_t size);
constexpr std::array<ViewDecoder, 3> kDecoders{meshopt_decodeVertexBuffer, meshopt_decodeIndexBuffer,
											   meshopt_decodeIndexSequence}; // of MeshoptView::Mode
using ViewFilter = void (*)(void* bytes, std::size_t count, std::size_t stride);
constexpr std::array<ViewFilter, 4> kFilters{nullptr, meshopt_decodeFilterOct, meshopt_decodeFilterQuat,
											 meshopt_decodeFilterExp}; // of MeshoptView::Filter

bool decodeView(const MeshoptView& view, const std::vector<unsigned char>& coded, std::vector<char>& bytes)
{
	const auto count = static_cast<std::size_t>(view.count);
	const auto stride = static_cast<std::size_t>(view.stride);
	bytes.resize(count * stride);
	const ViewFilter filter = kFilters[static_cast<std::size_t>(view.filter)];
	const bool is_decoded =
		kDecoders[static_cast<std::size_t>(view.mode)](bytes.data(), count, stride, coded.data(), coded.size()) == 0;
	if (is_decoded && filter != nullptr)
	{
		filter(bytes.data(), count, stride);
	}
	return is_decoded;
}

void decodeMeshopt(ValueReader& request, ValueWriter& answer)
{
	const std::string name = request.text();
	std::vector<MeshoptView> views(request.value<uint64_t>());
	std::vector<std::vector<unsigned char>> coded(views.size());
	for (std::size_t i = 0; i < views.size(); ++i)
	{
		views[i] = request.value<MeshoptView>();
		request.values(coded[i], kMaxFileBytes);
	}
	std::vector<char> bytes;
	for (std::size_t i = 0; i < views.size(); ++i)
	{
		refuseInputIf(!decodeView(views[i], coded[i], bytes),
					  name + ": bufferViews[" + std::to_string(views[i].index) + "].extensions.EXT_meshopt_compression",
					  "bytes that do not decode",
					  std::to_string(views[i].count) + " elements of " + std::to_string(views[i].stride) + " bytes");
		answer.values(bytes);
		std::vector<unsigned char>().swap(coded[i]);
	}
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
