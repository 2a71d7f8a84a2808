// SPDX-License-Identifier: GPL-3.0-or-later
// What is read of OBJ, MTL, PLY and STL files before Assimp gets them.
#include "fuzz.h"

#include "scene/mtl_text.h"
#include "scene/obj_text.h"
#include "scene/ply_text.h"
#include "scene/stl_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	const std::string text(reinterpret_cast<const char*>(data), size);
	std::vector<glm::dvec3> exact;
	std::vector<std::string> solids;
	nook::MtlMaterials materials;
	nook::fuzz::tryTo([&] { nook::repairedPly(text, "a.ply", exact); });
	nook::fuzz::tryTo([&] { nook::repairedStl(text, "a.stl", exact, solids); });
	nook::fuzz::tryTo([&] { nook::repairedObj(text, "a.obj", exact); });
	nook::fuzz::tryTo([&] { nook::readMtl(text, "a.mtl", materials); });
	return 0;
}
