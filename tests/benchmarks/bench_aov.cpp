// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of drawing volumes through OpenGL, compared within one run: files, layouts, faces, targets, masks, order.
//   nook_bench_aov GBUFFER.exr VOLUMES.glb…
// Fragments: those that pass the depth test. Milliseconds of the pass that draws the volumes: median of three after one warm-up.
// RMSE: against the first row's visibility, R32F with front faces.
#include "core/error.h"
#include "scene/gbuffer.h"
#include "shade/aov_gl_parts.h"
#include "volume/volume_glb.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace
{

using namespace nook;

double rmseOf(const std::vector<float>& a, const std::vector<float>& b)
{
	double sum = 0.0;
	for (std::size_t i = 0; i < a.size(); ++i)
	{
		const double difference = static_cast<double>(a[i]) - static_cast<double>(b[i]);
		sum += difference * difference;
	}
	return std::sqrt(sum / static_cast<double>(a.size()));
}

// Polygons in reverse order within each cluster: weakest occluders first.
VolumeSet turned(VolumeSet set)
{
	for (const VolumeCluster& cluster : set.clusters)
	{
		std::vector<glm::dvec3> corners;
		std::vector<Occluder> polygons;
		const uint32_t first = set.occluders.polygons[cluster.first_polygon].first_corner;
		for (uint32_t i = cluster.polygon_count; i-- > 0;)
		{
			Occluder polygon = set.occluders.polygons[cluster.first_polygon + i];
			const auto from = set.occluders.corners.begin() + polygon.first_corner;
			polygon.first_corner = first + static_cast<uint32_t>(corners.size());
			corners.insert(corners.end(), from, from + polygon.corner_count);
			polygons.push_back(polygon);
		}
		std::copy(corners.begin(), corners.end(), set.occluders.corners.begin() + first);
		std::copy(polygons.begin(), polygons.end(), set.occluders.polygons.begin() + cluster.first_polygon);
	}
	std::reverse(set.clusters.begin(), set.clusters.end());
	return set;
}

class Table
{
public:
	explicit Table(const GBuffer& gbuffer) : m_gbuffer(gbuffer) {}

	void row(const std::string& name, const VolumeSet& set, const AovSettings& settings, const AovGlOptions& options)
	{
		DrawSettings drawing;
		drawing.repetitions = 3;
		const AovShaded drawn = aovOnGl(m_gbuffer, set, settings, drawing, options);
		if (m_first.empty())
		{
			m_first = drawn.shaded.visibility;
			std::printf("%s\n%-34s %9s %9s %12s %9s %8s\n", drawn.shaded.renderer.c_str(), "", "volumes", "drawn", "fragments",
						"ms", "RMSE");
		}
		std::printf("%-34s %9llu %9llu %12llu %9.1f %8.5f\n", name.c_str(), static_cast<unsigned long long>(drawn.counts.volumes),
					static_cast<unsigned long long>(drawn.counts.volumes_drawn),
					static_cast<unsigned long long>(drawn.counts.fragments), 1e3 * drawn.shaded.passes.at(1).seconds,
					rmseOf(drawn.shaded.visibility, m_first));
		std::fflush(stdout);
	}

private:
	const GBuffer& m_gbuffer;
	std::vector<float> m_first;
};

void compare(const GBuffer& gbuffer, const std::string& path)
{
	const VolumeSet set = readVolumes(path);
	Table table(gbuffer);
	AovSettings settings{.target = AovTarget::r32f};
	table.row("R32F, front faces", set, settings, {});
	table.row("  no depth bounds", set, settings, {false, false, false, false});
	table.row("  back faces, no depth bounds", set, settings, {false, false, false, true});
	table.row("  back faces alone", set, settings, {false, false, true, true});
	table.row("  prisms", set, settings, {false, true, true, false});
	table.row("  storage buffers, one call", set, settings, {true, false, true, false});
	table.row("  storage buffers, prisms", set, settings, {true, true, true, false});
	settings.cull = false;
	table.row("  no culling of clusters", set, settings, {});
	settings.cull = true;
	settings.target = AovTarget::r16f;
	table.row("R16F", set, settings, {});
	table.row("  least light first", turned(set), settings, {});
	settings.target = AovTarget::r8;
	table.row("R8", set, settings, {});
	table.row("  least light first", turned(set), settings, {});
	settings.target = AovTarget::r16f;
	for (const int every_px : {3, 5})
	{
		settings.every_px = every_px;
		table.row("R16F, one pixel of " + std::to_string(every_px * every_px), set, settings, {});
	}
	settings.every_px = 1;
	settings.mask = true;
	for (const int directions : {32, 128, 256})
	{
		settings.directions = directions;
		table.row("mask of " + std::to_string(directions), set, settings, {});
	}
}

} // namespace

int main(int argc, char** argv)
{
	try
	{
		const GBuffer gbuffer = readGBuffer(argc > 1 ? argv[1] : "", {});
		for (int i = 2; i < argc; ++i)
		{
			std::printf("%s, %d x %d, ", argv[i], gbuffer.width_px, gbuffer.height_px);
			compare(gbuffer, argv[i]);
		}
		return 0;
	}
	catch (const Error& error)
	{
		std::fprintf(stderr, "nook_bench_aov: %s\n", error.what());
		return 1;
	}
}
