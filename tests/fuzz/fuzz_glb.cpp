// SPDX-License-Identifier: GPL-3.0-or-later
// Levels as binary glTF: container, JSON, accessors, meshes, materials; masks stay encoded.
#include "fuzz.h"

#include "scene/load_parts.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	const std::string path = nook::fuzz::fileOf(data, size, ".glb");
	nook::fuzz::tryTo(
		[&]
		{
			nook::Level level;
			nook::readGltf(path, {}, level);
			for (const glm::uvec3& triangle : level.triangles)
			{
				if (triangle.x >= level.positions.size() || triangle.y >= level.positions.size() ||
					triangle.z >= level.positions.size())
				{
					std::abort();
				}
			}
		});
	return 0;
}
