// SPDX-License-Identifier: GPL-3.0-or-later
// Files of occlusion volumes through nook_volumes.h, as engines read them: after open() every index is in range.
#include "fuzz.h"
#include "mutate_json.h"

#include "volume/runtime/nook_volumes.h"

#include <meshoptimizer.h>

#include <vector>

namespace
{

// Reads all contents of the arrays.
std::size_t touched(const nook_volumes::Volumes& volumes)
{
	std::size_t sum = 0;
	for (std::size_t i = 0; i < volumes.clusterCount(); ++i)
	{
		const nook_volumes::Cluster& cluster = volumes.clusters()[i];
		for (std::size_t k = 0; k < cluster.polygon_count; ++k)
		{
			const nook_volumes::Polygon& polygon = volumes.polygons()[cluster.first_polygon + k];
			for (std::size_t c = 0; c < nook_volumes::cornerCountOf(polygon); ++c)
			{
				sum += volumes.corners()[polygon.first_corner + c].x;
			}
		}
		const nook_volumes::Corner* const points =
			volumes.vertexCount() > 0 ? volumes.vertices() + cluster.first_vertex : volumes.corners() + cluster.first_corner;
		for (std::size_t k = 0; k < cluster.index_count; ++k)
		{
			sum += points[volumes.indices()[cluster.first_index + k]].polygon;
		}
	}
	return sum;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	std::vector<std::uint64_t> aligned((size + 7) / 8);
	if (size > 0)
	{
		std::memcpy(aligned.data(), data, size);
	}
	for (const nook_volumes::Decoders& decoders :
		 {nook_volumes::Decoders{}, nook_volumes::Decoders{meshopt_decodeVertexBuffer, meshopt_decodeIndexBuffer}})
	{
		nook_volumes::Volumes volumes;
		if (volumes.open(aligned.data(), size, decoders) == nullptr)
		{
			if (touched(volumes) == SIZE_MAX) // never true, but forces everything to be read
			{
				std::abort();
			}
		}
	}
	return 0;
}

NOOK_MUTATED_BY(nook::fuzz::mutatedGlb)
