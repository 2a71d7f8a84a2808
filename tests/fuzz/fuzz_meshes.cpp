// SPDX-License-Identifier: GPL-3.0-or-later
// What is looked at of PLY and STL files, and what is done to the text of OBJ and MTL files, before Assimp gets them, in a child
// process.
#include "fuzz.h"

#include "scene/load_parts.h"
#include "scene/obj_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	const std::string ply = nook::fuzz::fileOf(data, size, ".ply");
	nook::fuzz::tryTo([&] { nook::checkPly(ply); });
	const std::string stl = nook::fuzz::fileOf(data, size, ".stl");
	nook::fuzz::tryTo([&] { nook::checkStl(stl); });
	const std::string text(reinterpret_cast<const char*>(data), size);
	nook::fuzz::tryTo([&] { nook::repairedObj(text, "a.obj"); });
	nook::fuzz::tryTo([&] { nook::repairedMtl(text, "a.mtl"); });
	return 0;
}
