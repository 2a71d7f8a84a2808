// SPDX-License-Identifier: GPL-3.0-or-later
// Squared error of means over the variants of a tile. The formulas are in energy.cpp.
#include "core/parallel.h"
#include "pattern/energy_rows.h"

namespace nook
{

using namespace energy;

namespace
{

// Pairs of one group's samples with each other and with the groups at half of the offsets; the opposite offset is the same pair
// seen from the other group.
void addGroupPairs(const Setup& setup, const TileShares& shares, std::span<const std::size_t> offsets,
				   std::span<const Sample> samples, std::size_t group, std::size_t count, std::span<RowTerms> rows)
{
	const auto size = static_cast<std::size_t>(shares.size);
	const auto frames = static_cast<std::size_t>(shares.frames);
	const std::size_t first = group * count;
	PairSum sum(setup, samples, rows);
	for (std::size_t i = first; i < first + count && shares.pairs[0] != 0.0; ++i)
	{
		for (std::size_t j = i; j < first + count; ++j)
		{
			sum.add(i, j, shares.pairs[0]);
		}
	}
	for (const std::size_t offset : offsets)
	{
		const std::size_t dx = offset % size;
		const std::size_t dy = offset / size % size;
		const std::size_t df = offset / (size * size);
		const std::size_t opposite = ((frames - df) % frames * size + (size - dy) % size) * size + (size - dx) % size;
		const std::size_t other =
			((group / (size * size) + df) % frames * size + (group / size % size + dy) % size) * size + (group % size + dx) % size;
		// An offset that is its own opposite occurs in both groups; count it once.
		if (offset > opposite || (offset == opposite && other < group))
		{
			continue;
		}
		for (std::size_t i = first; i < first + count; ++i)
		{
			for (std::size_t j = other * count; j < (other + 1) * count; ++j)
			{
				sum.add(i, j, shares.pairs[offset]);
			}
		}
	}
}

// Sums run in a fixed order for any number of threads. Each task holds sums of all samples: 80 MB per million.
std::size_t tileTasks(std::size_t samples)
{
	return samples <= 1024 ? 1 : samples <= (std::size_t{1} << 18U) ? 16 : 2;
}

} // namespace

double tileSquaredError(Domain domain, const TileShares& shares, std::span<const glm::dvec3> points,
						std::span<const double> weights, EnergyGradient* gradient, int threads, ProgressCounter* progress)
{
	const std::size_t groups = shares.pairs.size();
	assert(points.size() == weights.size() && points.size() % groups == 0);
	const Setup setup = makeSetup(domain, Ensemble::plane);
	const std::vector<Sample> samples = makeSamples(setup, points, weights);
	const std::size_t tasks = tileTasks(samples.size());
	std::vector<std::size_t> offsets; // offsets with non-zero weight
	for (std::size_t offset = 1; offset < groups; ++offset)
	{
		if (shares.pairs[offset] != 0.0)
		{
			offsets.push_back(offset);
		}
	}
	std::vector<std::vector<RowTerms>> parts(tasks, std::vector<RowTerms>(samples.size()));
	parallelFor(tasks, threads,
				[&](std::size_t task)
				{
					for (std::size_t group = groups * task / tasks; group < groups * (task + 1) / tasks; ++group)
					{
						addGroupPairs(setup, shares, offsets, samples, group, samples.size() / groups, parts[task]);
						if (progress != nullptr)
						{
							progress->finishOne();
						}
					}
				});
	double total = 0.0;
	for (const double share : shares.pairs)
	{
		total += share;
	}
	if (gradient != nullptr)
	{
		gradient->points.resize(samples.size());
		gradient->weights.resize(samples.size());
	}
	const double factor = setup.factor / static_cast<double>(groups);
	double sum = -0.5 * setup.self * total * static_cast<double>(groups);
	for (std::size_t i = 0; i < samples.size(); ++i)
	{
		RowTerms row = parts[0][i];
		for (std::size_t task = 1; task < tasks; ++task)
		{
			row.pairs += parts[task][i].pairs;
			row.gradient += parts[task][i].gradient;
		}
		RowTerms own;
		addPotential(setup, samples[i], own);
		sum += weights[i] * (total * own.potential - 0.5 * row.pairs);
		if (gradient != nullptr)
		{
			gradient->points[i] = factor * weights[i] * (total * own.gradient + row.gradient);
			gradient->weights[i] = factor * (total * own.potential - row.pairs);
		}
	}
	return factor * sum;
}

} // namespace nook
