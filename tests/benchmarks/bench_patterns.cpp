// SPDX-License-Identifier: GPL-3.0-or-later
// Cost as a function of the count, one start on one thread, and the error reached in the same time: ratios within one run.
#include "pattern/energy.h"
#include "pattern/recipe.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace
{

void generate(benchmark::State& state)
{
	nook::Recipe recipe;
	recipe.domain = static_cast<nook::Domain>(state.range(0));
	recipe.method = static_cast<nook::Method>(state.range(1));
	recipe.count = static_cast<int>(state.range(2));
	recipe.starts = 1;
	nook::Pattern pattern;
	for ([[maybe_unused]] const auto round : state)
	{
		pattern = nook::generatePattern(recipe);
	}
	state.counters["plane"] =
		std::sqrt(nook::squaredError(recipe.domain, nook::Ensemble::plane, nook::Part::whole, pattern.points, pattern.weights));
	state.SetLabel(std::string(nook::nameOf(recipe.domain)) + " " + std::string(nook::nameOf(recipe.method)));
}

void counts(benchmark::internal::Benchmark* bench)
{
	for (const nook::Domain domain : {nook::Domain::disk, nook::Domain::ball, nook::Domain::sphere, nook::Domain::hemisphere})
	{
		for (const nook::Method method : {nook::Method::electro, nook::Method::refine})
		{
			for (const int count : {4, 16, 64, 256, 1024, 4096})
			{
				bench->Args({static_cast<int>(domain), static_cast<int>(method), count});
			}
		}
	}
	bench->Unit(benchmark::kMillisecond)->Iterations(1);
}

} // namespace

BENCHMARK(generate)->Apply(counts);
BENCHMARK_MAIN();
