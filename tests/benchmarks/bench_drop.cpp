// SPDX-License-Identifier: GPL-3.0-or-later
// Making a level's volumes: without dropping, with all lossless dropping, and with small contributions dropped too; the fragments
// of each in small pictures of the level's cameras compared with one volume per triangle, and the peak memory (which includes all
// previous rows: run a row alone for its own peak). NOOK_LEVEL selects a file, NOOK_DISTANCE δ in metres.
#include "core/parallel.h"
#include "scene/camera_choice.h"
#include "scene/load.h"
#include "shade/aov.h"
#include "volume/build.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <sys/resource.h>

namespace
{

nook::VolumeSettings settingsOf(double distance_m, bool drop, double below, bool merge)
{
	nook::VolumeSettings settings;
	settings.distance_m = distance_m;
	settings.occluders.merge = merge;
	settings.drop.no_receiver = drop;
	settings.drop.sides = drop;
	settings.drop.inside = drop;
	settings.drop.below = below;
	return settings;
}

double fragmentsOf(const nook::Tracer& tracer, nook::VolumeSet set, const nook::RunSettings& run)
{
	nook::clusterVolumes(set, {}, run);
	const nook::Level& level = tracer.level();
	double fragments = 0.0;
	double pixels = 0.0;
	for (const nook::LevelCamera& camera : level.cameras.empty() ? nook::chooseCameras(tracer, 2, run) : level.cameras)
	{
		const nook::GBuffer gbuffer =
			nook::castGBuffer(tracer, nook::viewOf(camera, 32, 18), 32, 18, nook::NormalKind::geometric, run);
		fragments += static_cast<double>(nook::aovOnGl(gbuffer, set, {}).counts.fragments);
		pixels += static_cast<double>(
			std::count_if(gbuffer.depth.begin(), gbuffer.depth.end(), [](const float depth) { return std::isfinite(depth); }));
	}
	return pixels > 0.0 ? fragments / pixels : 0.0;
}

void build(benchmark::State& state, bool drop, double below)
{
	const nook::RunSettings run{nook::availableThreads(), {}};
	const char* name = std::getenv("NOOK_LEVEL");
	const char* distance = std::getenv("NOOK_DISTANCE");
	const double distance_m = distance != nullptr ? std::strtod(distance, nullptr) : 1.0;
	const nook::LoadedLevel loaded = nook::loadLevel(name != nullptr ? name : "builtin:suburb", {}, run);
	nook::BuiltVolumes built;
	for ([[maybe_unused]] const auto round : state)
	{
		built = nook::buildVolumes(loaded.level, settingsOf(distance_m, drop, below, true), run);
	}
	rusage usage{};
	::getrusage(RUSAGE_SELF, &usage);
	const nook::Tracer tracer(loaded.level, run);
	const double whole =
		fragmentsOf(tracer, nook::buildVolumes(loaded.level, settingsOf(distance_m, false, 0.0, false), run).set, run);
	state.counters["triangles"] = static_cast<double>(loaded.level.triangles.size());
	state.counters["polygons"] = static_cast<double>(built.dropped.polygons);
	state.counters["kept"] = static_cast<double>(built.dropped.kept);
	state.counters["fragments_a_pixel"] = fragmentsOf(tracer, built.set, run);
	state.counters["one_a_triangle"] = whole;
	state.counters["peak_MiB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
	state.counters["estimate_MiB"] = static_cast<double>(built.memory_estimate_bytes) / 1048576.0;
}

BENCHMARK_CAPTURE(build, nothing_dropped, false, 0.0)->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();
BENCHMARK_CAPTURE(build, dropped, true, 0.0)->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();
BENCHMARK_CAPTURE(build, dropped_below_1_512, true, 1.0 / 512.0)->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();

} // namespace

BENCHMARK_MAIN();
