// SPDX-License-Identifier: GPL-3.0-or-later
// The OBJ, MTL, PLY, STL and FBX readers.
#include "fuzz.h"

#include "scene/fbx.h"
#include "scene/mesh_text.h"

namespace
{

void readFbx(const std::string& path)
{
	const nook::FbxObjects objects(path);
	const std::vector<nook::FbxPlace> places = nook::placesOf(objects);
	std::vector<const nook::FbxPlace*> worlds(objects.count(), nullptr);
	for (const nook::FbxPlace& place : places)
	{
		worlds[place.object] = &place;
	}
	for (const nook::FbxPlace& place : places)
	{
		for (const std::size_t geometry : objects.partsOf(objects[place.object], "Geometry", "Mesh"))
		{
			nook::FbxMesh mesh = nook::readFbxMesh(objects, objects[geometry]);
			std::vector<glm::dvec3> turned;
			nook::poseFbxMesh(objects, objects[geometry], place, worlds, mesh.points, turned);
		}
	}
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	const std::string fbx = nook::fuzz::fileOf(data, size, ".fbx");
	nook::fuzz::tryTo([&] { readFbx(fbx); });
	const std::string text(reinterpret_cast<const char*>(data), size);
	nook::MtlMaterials materials;
	nook::fuzz::tryTo([&] { nook::readPly(text, "a.ply"); });
	nook::fuzz::tryTo([&] { nook::readStl(text, "a.stl"); });
	nook::fuzz::tryTo([&] { nook::readObj(text, "a.obj", {}); });
	nook::fuzz::tryTo([&] { nook::readMtl(text, "a.mtl", materials); });
	return 0;
}
