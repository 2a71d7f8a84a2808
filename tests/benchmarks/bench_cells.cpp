// SPDX-License-Identifier: GPL-3.0-or-later
// Time of exact cells by their count.
#include "pattern/cells.h"
#include "pattern/recipe.h"

#include <benchmark/benchmark.h>

#include <string>

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
BENCHMARK_MAIN();
