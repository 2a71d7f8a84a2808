// SPDX-License-Identifier: GPL-3.0-or-later
// Exact cells compared with the paper's grids: time, and the maximum and rms error of the grids' integrals (relative to an even
// cell).
#include "pattern/cells.h"
#include "pattern/recipe.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{

nook::Pattern startOf(const benchmark::State& state)
{
	nook::Recipe recipe;
	recipe.domain = static_cast<nook::Domain>(state.range(0));
	recipe.count = static_cast<int>(state.range(1));
	recipe.method = nook::Method::poisson;
	return nook::generatePattern(recipe);
}

void name(benchmark::State& state)
{
	state.SetLabel(std::string(nook::nameOf(static_cast<nook::Domain>(state.range(0)))));
}

void exact(benchmark::State& state)
{
	const nook::Pattern pattern = startOf(state);
	for ([[maybe_unused]] const auto round : state)
	{
		benchmark::DoNotOptimize(nook::exactCells(pattern.domain, pattern.points));
	}
	name(state);
}

void discrete(benchmark::State& state)
{
	const nook::Pattern pattern = startOf(state);
	nook::Cells cells;
	for ([[maybe_unused]] const auto round : state)
	{
		cells = nook::discreteCells(pattern.domain, pattern.points);
	}
	const nook::Cells truth = nook::exactCells(pattern.domain, pattern.points);
	double greatest = 0.0;
	double squares = 0.0;
	const auto count = static_cast<double>(pattern.count());
	for (std::size_t i = 0; i < pattern.count(); ++i)
	{
		const double error = count * std::fabs(cells.integrals[i] - truth.integrals[i]);
		greatest = std::max(greatest, error);
		squares += error * error;
	}
	state.counters["greatest_error"] = greatest;
	state.counters["rms_error"] = std::sqrt(squares / count);
	name(state);
}

void domainsAndCounts(benchmark::internal::Benchmark* benchmark)
{
	benchmark->ArgNames({"domain", "count"})->Unit(benchmark::kMillisecond);
	for (const int domain : {0, 1, 2, 3})
	{
		for (const int count : {9, 33, 64})
		{
			benchmark->Args({domain, count});
		}
	}
}

// Cost as a function of the count, up to the maximum.
void countsUpToAll(benchmark::internal::Benchmark* benchmark)
{
	for (const int domain : {0, 1, 2, 3})
	{
		for (const int count : {256, 1024, 4096})
		{
			benchmark->Args({domain, count});
		}
	}
}

} // namespace

BENCHMARK(exact)->Apply(domainsAndCounts)->Apply(countsUpToAll);
BENCHMARK(discrete)->Apply(domainsAndCounts);
BENCHMARK_MAIN();
