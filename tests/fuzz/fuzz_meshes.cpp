// SPDX-License-Identifier: GPL-3.0-or-later
// What is looked at of PLY and STL files before Assimp gets them, in a child process.
#include "fuzz.h"

#include "scene/load_parts.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	const std::string ply = nook::fuzz::fileOf(data, size, ".ply");
	nook::fuzz::tryTo([&] { nook::checkPly(ply); });
	const std::string stl = nook::fuzz::fileOf(data, size, ".stl");
	nook::fuzz::tryTo([&] { nook::checkStl(stl); });
	return 0;
}
