// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/closed.h"

#include "volume/surface.h"

namespace nook
{

std::vector<uint8_t> closedTriangles(const Level& level, const RunSettings& run)
{
	OccluderSettings settings;
	settings.merge = false;
	OccluderCounts counts;
	const detail::Soup soup{&level, level.triangles, level.materials, {}};
	const detail::Surface surface = detail::surfaceOf(soup, settings, run, counts);
	std::vector<uint8_t> closed(level.triangles.size());
	for (std::size_t i = 0; i < closed.size(); ++i)
	{
		closed[i] = surface.kept[i] != 0 && surface.two_sided[i] == 0 ? 1 : 0;
	}
	return closed;
}

} // namespace nook
