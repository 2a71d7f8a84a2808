// SPDX-License-Identifier: GPL-3.0-or-later
// Making occluder polygons and the prisms of their volumes from a level's triangles, without dropping. Time per triangle should not
// grow. NOOK_LARGE adds 10^7 triangles; NOOK_LEVEL selects a file. The peak memory includes the level and all previous sizes: run
// one size alone for its own peak.
#include "core/parallel.h"
#include "scene/builtin.h"
#include "scene/load.h"
#include "volume/occluders.h"
#include "volume/volumes.h"

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <string>
#include <vector>

#include <sys/resource.h>

namespace
{

double peakMiB()
{
	rusage usage{};
	::getrusage(RUSAGE_SELF, &usage);
	return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Computes both rings of every prism in blocks; returns their number.
std::size_t prisms(const nook::Occluders& occluders, const nook::RunSettings& run)
{
	constexpr std::size_t kBlock = 1U << 14U;
	std::vector<glm::dvec3> points(2 * occluders.corners.size());
	nook::parallelFor((occluders.polygons.size() + kBlock - 1) / kBlock, run.threads,
					  [&](std::size_t block)
					  {
						  const std::size_t end = std::min(occluders.polygons.size(), (block + 1) * kBlock);
						  for (std::size_t i = block * kBlock; i < end; ++i)
						  {
							  const nook::Occluder& polygon = occluders.polygons[i];
							  const auto corners = std::span(occluders.corners).subspan(polygon.first_corner, polygon.corner_count);
							  const auto to = std::span(points).subspan(2 * std::size_t{polygon.first_corner},
																		2 * std::size_t{polygon.corner_count});
							  nook::prismOf(corners, nook::frontOf(corners), {1.0, polygon.two_sided, false}, to);
						  }
					  });
	return points.size();
}

void build(benchmark::State& state, const nook::Level& level)
{
	const nook::RunSettings run{nook::availableThreads(), {}};
	std::size_t polygons = 0;
	std::size_t points = 0;
	for ([[maybe_unused]] const auto round : state)
	{
		const nook::Occluding occluding = nook::occludersOf(level, {}, run);
		polygons = occluding.occluders.polygons.size();
		points = prisms(occluding.occluders, run);
	}
	const auto triangles = static_cast<double>(level.triangles.size());
	state.counters["triangles"] = triangles;
	state.counters["polygons"] = static_cast<double>(polygons);
	state.counters["prism_points"] = static_cast<double>(points);
	state.counters["triangles_per_s"] = benchmark::Counter(triangles, benchmark::Counter::kIsIterationInvariantRate);
	state.counters["peak_MiB"] = peakMiB();
}

void heightField(benchmark::State& state)
{
	build(state, nook::builtinLevel("heightfield:" + std::to_string(state.range(0))));
}

void builtin(benchmark::State& state, const char* name)
{
	build(state, nook::builtinLevel(name));
}

void file(benchmark::State& state)
{
	const char* const path = std::getenv("NOOK_LEVEL");
	if (path == nullptr)
	{
		state.SkipWithError("no NOOK_LEVEL");
		return;
	}
	build(state, nook::loadLevel(path, {}, {nook::availableThreads(), {}}).level);
}

void sizes(benchmark::internal::Benchmark* benchmark)
{
	benchmark->Arg(10000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
	if (std::getenv("NOOK_LARGE") != nullptr)
	{
		benchmark->Arg(10000000);
	}
}

} // namespace

BENCHMARK(heightField)->Apply(sizes);
BENCHMARK_CAPTURE(builtin, courtyard, "courtyard")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(builtin, suburb, "suburb")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(builtin, foliage, "foliage")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(file)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_MAIN();
