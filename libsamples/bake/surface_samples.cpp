// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018 (the sequence R2);
// E. Heitz, "A Low-Distortion Map Between Triangle and Square", 2019.
#include "bake/surface_samples.h"

#include "core/lists.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/work_units.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace nook
{
namespace
{

constexpr double kShut = 0.02; // visibility: below one of 32 rays, or with a falloff gaps of a fiftieth of the radius
constexpr std::size_t kBlock = std::size_t{1} << 18U; // samples traced at a time, to bound the memory

// Point i of the sequence R2, shifted, mapped to the triangle.
void place(SurfaceSample& sample, std::size_t i, glm::dvec2 shift)
{
	constexpr double kPlastic = 1.32471795724474602596; // the root of g³ = g + 1
	const auto behind_point = [](double x) // fraction() of non-negative numbers: for millions of them the conversion avoids a call
	{
		return x - static_cast<double>(static_cast<int64_t>(x));
	};
	double b = behind_point(shift.x + static_cast<double>(i) / kPlastic);
	double c = behind_point(shift.y + static_cast<double>(i) / (kPlastic * kPlastic));
	if (b < c)
	{
		b *= 0.5;
		c -= b;
	}
	else
	{
		c *= 0.5;
		b -= c;
	}
	sample.b = static_cast<float>(b);
	sample.c = static_cast<float>(c);
}

bool hasTwoSides(const Level& level, std::size_t triangle)
{
	return level.material_list[level.materials[triangle]].two_sided;
}

// Where its rays start; `flat`: with the normal of the triangle, whatever the settings say.
ReferencePoint pointOf(const Tracer& tracer, const Level& level, SurfaceSample& sample, const BakeSettings& settings, bool flat)
{
	const glm::dvec2 at(static_cast<double>(sample.b), static_cast<double>(sample.c));
	const double side = sample.back ? -1.0 : 1.0;
	ReferencePoint point{interpolated(level.positions, level.triangles[sample.triangle], at.x, at.y),
						 side * geometricNormal(level, sample.triangle), 0.0};
	const bool smooth = settings.normals == NormalKind::interpolated && !flat;
	if (!smooth && settings.cage_m == 0.0)
	{
		return point;
	}
	const glm::dvec3 normal = side * interpolatedNormal(level, sample.triangle, at);
	point.normal = smooth ? normal : point.normal;
	return startOf(tracer, point, normal, settings, &sample.missed);
}

// Finds the samples inside matter.
void findBuried(const Tracer& tracer, const Level& level, std::span<SurfaceSample> samples, const BakeSettings& settings,
				const RunSettings& run)
{
	constexpr std::size_t kChunk = 256;
	constexpr double kRays = 9.0; // rays traced by isBuried()
	const auto chunk = [&](std::size_t unit)
	{
		return samples.subspan(unit * kChunk, std::min(kChunk, samples.size() - unit * kChunk));
	};
	const auto compute = [&](std::size_t unit)
	{
		for (SurfaceSample& sample : chunk(unit))
		{
			const ReferencePoint point = pointOf(tracer, level, sample, settings, true);
			sample.buried = isBuried(tracer, point.position + tracer.error() * point.normal, point.normal);
		}
	};
	const auto pass = [&](std::size_t unit, Archive& archive)
	{
		for (SurfaceSample& sample : chunk(unit))
		{
			archive(sample.buried);
			if (settings.cage_m > 0.0)
			{
				archive(sample.missed);
			}
		}
	};
	runStage({"inside", (samples.size() + kChunk - 1) / kChunk,
			  [&](std::size_t unit) { return kRays * static_cast<double>(chunk(unit).size()); }, compute, pass},
			 withoutProgress(run));
}

// Values of `base` at samples, coarse to fine: where three samples in a cell of a grid agree, the others take their values, unless
// rays say otherwise; else the cell is halved, and in the end each sample is evaluated. Samples that face another way have cells of
// their own, and so do those inside matter, where hardly anybody sees them: there one sample is enough. Tuned on a cave and an
// apartment.
class BaseAtSamples
{
public:
	BaseAtSamples(const Level& level, std::span<const SurfaceSample> samples, double radius_m)
		: m_samples(samples), m_positions(mapped(samples,
												 [&](const SurfaceSample& of) {
													 return interpolated(level.positions, level.triangles[of.triangle],
																		 static_cast<double>(of.b), static_cast<double>(of.c));
												 })),
		  m_values(samples.size()), m_known(samples.size()), m_order(samples.size()), m_keys(samples.size())
	{
		glm::dvec3 least(std::numeric_limits<double>::infinity());
		glm::dvec3 most = -least;
		for (const glm::dvec3& position : m_positions)
		{
			least = glm::min(least, position);
			most = glm::max(most, position);
		}
		const glm::dvec3 size = most - least;
		m_coarsest_m = kCoarsest * radius_m;
		m_finest_m = std::max(m_coarsest_m / (1U << kHalvings), std::max({size.x, size.y, size.z}) / ((1U << kBits) - 1U));
		for (std::size_t i = 0; i < samples.size(); ++i)
		{
			const glm::dvec3 normal = (samples[i].back ? -1.0 : 1.0) * geometricNormal(level, samples[i].triangle);
			const glm::uvec3 cell((m_positions[i] - least) / m_finest_m);
			uint64_t key = samples[i].buried ? 1 : 0;
			for (int axis = 0; axis < 3; ++axis)
			{
				key = 3 * key + (normal[axis] > kDiagonal ? 2U : normal[axis] < -kDiagonal ? 0U : 1U);
			}
			for (int bit = kBits - 1; bit >= 0; --bit)
			{
				key = 8 * key + 4 * (cell.x >> bit & 1U) + 2 * (cell.y >> bit & 1U) + (cell.z >> bit & 1U);
			}
			m_keys[i] = key;
		}
		std::iota(m_order.begin(), m_order.end(), uint32_t{0});
		std::sort(m_order.begin(), m_order.end(),
				  [this](uint32_t a, uint32_t b) { return std::pair(m_keys[a], a) < std::pair(m_keys[b], b); });
	}

	// `valuesOf` evaluates samples of these numbers.
	template <class ValuesOf> std::vector<double> values(const ValuesOf& valuesOf)
	{
		std::vector<uint32_t> asked;
		const auto evaluate = [&]
		{
			const std::vector<double> found = valuesOf(std::span<const uint32_t>(asked));
			for (std::size_t i = 0; i < asked.size(); ++i)
			{
				m_values[asked[i]] = found[i];
			}
			asked.clear();
		};
		const auto ask = [&](uint32_t i)
		{
			if (!m_known[i])
			{
				m_known[i] = true;
				asked.push_back(i);
			}
		};
		std::vector<Cell> cells{{m_order.data(), m_order.data() + m_order.size()}};
		for (int halvings = 0; halvings <= kHalvings; ++halvings)
		{
			cells = parted(cells, 3 * (kHalvings - halvings));
			if (m_finest_m * (1U << (kHalvings - halvings)) > 1.001 * m_coarsest_m)
			{
				continue;
			}
			for (const Cell& cell : cells)
			{
				ask(cell[cell.size() / 2]);
				if (!m_samples[cell.front()].buried)
				{
					ask(cell.front());
					ask(cell.back());
				}
			}
			evaluate();
			std::erase_if(cells, [&](const Cell& cell) { return settle(cell); });
		}
		std::for_each(m_order.begin(), m_order.end(), ask);
		evaluate();
		return m_values;
	}

private:
	using Cell = std::span<const uint32_t>;

	static constexpr double kCoarsest = 0.1; // of the radius
	static constexpr int kHalvings = 1;
	static constexpr int kBits = 19;
	static constexpr double kDiagonal = 0.55; // component of a normal
	static constexpr double kAgree = 0.03;
	static constexpr double kRaysAgree = 0.1;

	std::vector<Cell> parted(const std::vector<Cell>& cells, int shift) const
	{
		std::vector<Cell> parts;
		for (const Cell& cell : cells)
		{
			for (std::size_t first = 0, i = 1; i <= cell.size(); ++i)
			{
				if (i == cell.size() || m_keys[cell[i]] >> shift != m_keys[cell[first]] >> shift)
				{
					parts.push_back(cell.subspan(first, i - first));
					first = i;
				}
			}
		}
		return parts;
	}

	// Gives the cell's other samples the mean of those that are known, weighted by the inverse squared distance, unless these
	// disagree.
	bool settle(const Cell& cell)
	{
		std::vector<uint32_t> known;
		std::copy_if(cell.begin(), cell.end(), std::back_inserter(known), [this](uint32_t i) { return m_known[i]; });
		const auto byValue = [this](uint32_t a, uint32_t b)
		{
			return m_values[a] < m_values[b];
		};
		const auto [least, most] = std::minmax_element(known.begin(), known.end(), byValue);
		const bool is_buried = m_samples[cell.front()].buried;
		if (!is_buried && m_values[*most] - m_values[*least] > kAgree)
		{
			return false;
		}
		std::vector<uint32_t> taken;
		for (const uint32_t i : cell)
		{
			glm::dvec3 sum(0.0); // of weights, values and visibility by rays
			for (const uint32_t other : known)
			{
				const glm::dvec3 way = m_positions[i] - m_positions[other];
				const double weight = 1.0 / (glm::dot(way, way) + 1e-4 * m_finest_m * m_finest_m);
				sum += weight * glm::dvec3(1.0, m_values[other], m_samples[other].visibility);
			}
			if (!m_known[i] && (is_buried || std::fabs(m_samples[i].visibility - sum.z / sum.x) <= kRaysAgree))
			{
				m_values[i] = sum.y / sum.x;
				taken.push_back(i);
			}
		}
		std::for_each(taken.begin(), taken.end(), [this](uint32_t i) { m_known[i] = true; });
		return true;
	}

	std::span<const SurfaceSample> m_samples;
	std::vector<glm::dvec3> m_positions;
	std::vector<double> m_values;
	std::vector<bool> m_known;
	std::vector<uint32_t> m_order; // by key
	std::vector<uint64_t> m_keys;  // what a sample faces, and its cell
	double m_coarsest_m = 0.0;
	double m_finest_m = 0.0;
};

} // namespace

std::vector<std::size_t> samplesOfTriangles(std::span<const double> areas, std::size_t count)
{
	const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
	const double even = 0.5 * static_cast<double>(count) / static_cast<double>(areas.size());
	const double by_area = total > 0.0 ? 0.5 * static_cast<double>(count) / total : 0.0;
	std::vector<std::size_t> counts;
	counts.reserve(areas.size());
	double share = 0.5;
	for (const double area : areas)
	{
		share += even + by_area * area;
		const double whole = std::max(1.0, std::floor(share));
		share -= whole;
		counts.push_back(static_cast<std::size_t>(whole));
	}
	return counts;
}

SamplePlaces::SamplePlaces(const Level& level, std::span<const std::size_t> counts, uint32_t seed) : m_level(level), m_seed(seed)
{
	assert(counts.size() == level.triangles.size());
	m_first.reserve(counts.size() + 1);
	m_first.push_back(0);
	for (std::size_t t = 0; t < counts.size(); ++t)
	{
		const std::size_t sides = hasTwoSides(level, t) ? 2 : 1;
		m_first.push_back(m_first.back() + (counts[t] + sides - 1) / sides * sides);
	}
}

void SamplePlaces::place(std::size_t first, std::span<SurfaceSample> samples) const
{
	const std::size_t end = first + samples.size();
	assert(end <= count());
	auto t = static_cast<std::size_t>(std::upper_bound(m_first.begin(), m_first.end(), first) - m_first.begin()) - 1;
	for (std::size_t at = first; at < end; ++t)
	{
		const std::size_t sides = hasTwoSides(m_level, t) ? 2 : 1;
		Random random(m_seed, t);
		const glm::dvec2 shift{random.uniform(), random.uniform()}; // braces fix the evaluation order
		for (; at < std::min(end, m_first[t + 1]); ++at)
		{
			const std::size_t i = at - m_first[t];
			SurfaceSample& sample = samples[at - first];
			sample = {};
			sample.triangle = static_cast<uint32_t>(t);
			sample.back = i % sides == 1;
			nook::place(sample, i / sides, shift);
		}
	}
}

std::vector<SurfaceSample> SamplePlaces::all() const
{
	std::vector<SurfaceSample> samples(count());
	place(0, samples);
	return samples;
}

ReferencePoint startOf(const Tracer& tracer, const ReferencePoint& point, glm::dvec3 along, const BakeSettings& settings,
					   bool* missed)
{
	if (settings.cage_m == 0.0)
	{
		return point;
	}
	const glm::dvec3 from = point.position + settings.cage_m * along;
	const RayHit hit = tracer.nearest(from, -along, 2.0 * settings.cage_m);
	const Level& detailed = tracer.level();
	const bool found = hit.hit && (hit.front || hasTwoSides(detailed, hit.triangle));
	if (missed != nullptr)
	{
		*missed = !found;
	}
	if (!found)
	{
		return point;
	}
	const glm::dvec3 normal = settings.normals == NormalKind::interpolated
								  ? interpolatedNormal(detailed, hit.triangle, hit.barycentric)
								  : geometricNormal(detailed, hit.triangle);
	return {from - hit.distance * along, hit.front ? normal : -normal, 0.0};
}

void countUnseen(std::span<const SurfaceSample> samples, VertexBake& bake)
{
	for (const SurfaceSample& sample : samples)
	{
		bake.buried += sample.buried ? 1U : 0U;
		bake.shut += sample.shut && !sample.buried ? 1U : 0U;
	}
}

ReferenceSettings raysOf(const BakeSettings& settings, int rays, uint32_t seed)
{
	ReferenceSettings how;
	how.radius_m = settings.radius_m;
	how.falloff = settings.falloff;
	how.falloff_u_m = settings.falloff_u_m;
	how.rays = rays;
	how.seed = seed;
	return how;
}

std::vector<SurfaceSample> placeByArea(const Level& level, std::span<const double> areas, std::size_t count, uint32_t seed)
{
	const double step = std::accumulate(areas.begin(), areas.end(), 0.0) / static_cast<double>(count);
	std::vector<SurfaceSample> samples;
	samples.reserve(count);
	Random random(seed, level.triangles.size());
	const glm::dvec2 shift{random.uniform(), random.uniform()}; // braces fix the evaluation order
	double passed = step * random.uniform();
	for (std::size_t t = 0; t < areas.size() && samples.size() < count; ++t)
	{
		for (; passed < areas[t] && samples.size() < count; passed += step)
		{
			SurfaceSample& sample = samples.emplace_back();
			sample.triangle = static_cast<uint32_t>(t);
			sample.back = hasTwoSides(level, t) && random.below(2) == 1;
			place(sample, samples.size(), shift);
		}
		passed -= areas[t];
	}
	return samples;
}

void traceSamples(const Tracer& tracer, const Level& level, std::span<SurfaceSample> samples, const BakeSettings& settings,
				  int rays, uint32_t seed, const RunSettings& run, const char* stage)
{
	traceSamples(
		tracer, level, samples.size(), [samples](std::size_t first, std::size_t size) { return samples.subspan(first, size); },
		settings, rays, seed, run, stage);
}

void traceSamples(const Tracer& tracer, const Level& level, std::size_t count, const BlockAt& block_at,
				  const BakeSettings& settings, int rays, uint32_t seed, const RunSettings& run, const char* stage)
{
	ReferenceSettings how = raysOf(settings, rays, seed);
	how.measure = settings.bent ? ReferenceMeasure::bent : ReferenceMeasure::obscurance;
	ProgressCounter progress(run.progress, stage, count);
	for (std::size_t first = 0; first < count; first += kBlock)
	{
		const std::span<SurfaceSample> block = block_at(first, std::min(kBlock, count - first));
		findBuried(tracer, level, block, settings, run);
		const auto pointAt = [&](std::size_t i)
		{
			return pointOf(tracer, level, block[i], settings, false);
		};
		how.seed = seed + static_cast<uint32_t>(first / kBlock) * 0x9e3779b9U; // another sequence for each block
		const std::vector<ReferenceValue> values = referenceAtPoints(tracer, block.size(), pointAt, how, withoutProgress(run));
		const auto take = [&](std::size_t i)
		{
			block[i].visibility = static_cast<float>(values[i].visibility);
			block[i].standard_error = static_cast<float>(values[i].standard_error);
			block[i].bent = values[i].bent;
			block[i].shut = values[i].visibility <= kShut;
		};
		parallelFor(isShare(run) ? 0 : block.size(), run.threads, take); // nobody reads them in a share
		if (settings.base && !isShare(run))
		{
			const std::vector<double> base =
				BaseAtSamples(level, block, settings.radius_m)
					.values([&](std::span<const uint32_t> of) { return settings.base(mapped(of, pointAt)); });
			for (std::size_t i = 0; i < block.size(); ++i)
			{
				block[i].visibility -= static_cast<float>(base[i]);
			}
		}
		progress.finish(block.size());
	}
}

} // namespace nook
