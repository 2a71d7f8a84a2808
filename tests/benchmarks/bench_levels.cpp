// SPDX-License-Identifier: GPL-3.0-or-later
// Time of loading and diagnosing a level as a function of its triangles: a height field as binary PLY. Time per triangle should not
// grow. NOOK_LARGE adds 10^7 triangles; NOOK_LEVEL selects a file. The peak memory includes the reader process and, from the second
// size on, previous sizes: run one size alone for its own peak.
#include "../level_files.h"

#include "core/parallel.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <sys/resource.h>

namespace
{

using nook::append;

// A square grid with waves, with at least `triangles` triangles.
std::string heightFieldPly(std::size_t triangles)
{
	const auto side = static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<double>(triangles) / 2.0)));
	std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string((side + 1) * (side + 1)) +
						"\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(2 * side * side) +
						"\nproperty list uchar int vertex_indices\nend_header\n";
	for (uint32_t i = 0; i <= side; ++i)
	{
		for (uint32_t j = 0; j <= side; ++j)
		{
			append(bytes, 0.1F * static_cast<float>(i));
			append(bytes, 0.02F * static_cast<float>((i * 7 + j * 3) % 11));
			append(bytes, 0.1F * static_cast<float>(j));
		}
	}
	for (uint32_t i = 0; i < side; ++i)
	{
		for (uint32_t j = 0; j < side; ++j)
		{
			const uint32_t at = i * (side + 1) + j;
			for (const std::array<uint32_t, 3>& t : {std::array{at, at + 1, at + side + 1}, {at + 1, at + side + 2, at + side + 1}})
			{
				append(bytes, uint8_t{3});
				append(bytes, t);
			}
		}
	}
	return bytes;
}

double peakMiB(int who)
{
	rusage usage{};
	::getrusage(who, &usage);
	return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void load(benchmark::State& state, const std::string& path)
{
	const nook::RunSettings run{nook::availableThreads(), {}};
	std::size_t triangles = 0;
	std::size_t findings = 0;
	for ([[maybe_unused]] const auto round : state)
	{
		const nook::LoadedLevel loaded = nook::loadLevel(path, {}, run);
		triangles = loaded.level.triangles.size();
		findings = loaded.diagnosis.findings.size();
	}
	state.counters["triangles"] = static_cast<double>(triangles);
	state.counters["findings"] = static_cast<double>(findings);
	state.counters["time_per_triangle"] = benchmark::Counter(
		static_cast<double>(triangles), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
	state.counters["peak_MiB_here"] = peakMiB(RUSAGE_SELF);
	state.counters["peak_MiB_child"] = peakMiB(RUSAGE_CHILDREN);
}

void heightField(benchmark::State& state)
{
	const std::filesystem::path path = std::filesystem::temp_directory_path() / "nook_bench_levels.ply";
	nook::writeFile(path.string(), heightFieldPly(static_cast<std::size_t>(state.range(0))));
	load(state, path.string());
	std::filesystem::remove(path);
}

void file(benchmark::State& state)
{
	const char* const path = std::getenv("NOOK_LEVEL");
	if (path == nullptr)
	{
		state.SkipWithError("no NOOK_LEVEL");
		return;
	}
	load(state, path);
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
BENCHMARK(file)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_MAIN();
