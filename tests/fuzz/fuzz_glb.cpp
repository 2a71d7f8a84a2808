// SPDX-License-Identifier: GPL-3.0-or-later
// Levels as glTF, binary or JSON only: container, JSON, accessors, meshes, materials; masks stay encoded.
#include "fuzz.h"
#include "mutate_json.h"

#include "scene/load_parts.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	const bool is_document = size > 0 && data[0] == '{';
	const std::string path = nook::fuzz::fileOf(data, size, is_document ? ".gltf" : ".glb");
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

NOOK_MUTATED_BY(nook::fuzz::mutatedGlb)
