// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/level.h"

#include "core/lists.h"
#include "scene/load_parts.h"
#include "scene/ray_triangle.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <array>
#include <cassert>
#include <cmath>
#include <vector>

namespace nook
{
namespace
{

// Texel index of an integer coordinate under a wrap mode.
int wrapped(double texel, int size, Wrap wrap)
{
	// Far beyond anything visible, and safe to convert.
	const double n = size;
	switch (wrap)
	{
	case Wrap::clamp: return static_cast<int>(glm::clamp(texel, 0.0, n - 1.0));
	case Wrap::repeat: return static_cast<int>(texel - n * std::floor(texel / n)) % size;
	case Wrap::mirror: break;
	}
	const int in_two = static_cast<int>(texel - 2.0 * n * std::floor(texel / (2.0 * n))) % (2 * size);
	return in_two < size ? in_two : 2 * size - 1 - in_two;
}

double texelAt(const Mask& mask, int x, int y)
{
	return mask.alpha[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width_px) + static_cast<std::size_t>(x)] / 255.0;
}

bool isIn(const Bounds& box, glm::dvec3 position)
{
	return glm::all(glm::greaterThanEqual(position, box.least)) && glm::all(glm::lessThan(position, box.most));
}

constexpr uint8_t kAway = 0;
constexpr uint8_t kOwn = 1;
constexpr uint8_t kAround = 2;

// Classifies each triangle.
std::vector<uint8_t> placesOf(const Level& level, const CellSettings& settings)
{
	std::vector<uint8_t> places(level.triangles.size(), kAway);
	Bounds near = settings.box;
	for (std::size_t i = 0; i < places.size(); ++i)
	{
		const glm::uvec3& t = level.triangles[i];
		if (isIn(settings.box, (level.positions[t.x] + level.positions[t.y] + level.positions[t.z]) / 3.0))
		{
			places[i] = kOwn;
			const Bounds bounds = boundsOf(level, i);
			near = {glm::min(near.least, bounds.least), glm::max(near.most, bounds.most)};
		}
	}
	near.least -= settings.around_m;
	near.most += settings.around_m;
	for (std::size_t i = 0; i < places.size(); ++i)
	{
		const Bounds bounds = boundsOf(level, i);
		const bool reaches =
			glm::all(glm::lessThanEqual(bounds.least, near.most)) && glm::all(glm::greaterThanEqual(bounds.most, near.least));
		places[i] = places[i] == kOwn ? kOwn : reaches ? kAround : kAway;
	}
	return places;
}

bool isHalved(const Bounds& all, const Bounds& rest)
{
	return 2.0 * glm::distance(rest.least, rest.most) < glm::distance(all.least, all.most);
}

// Bounding box of the boxes whose centres are in `all`, without those at both ends of each axis that have `end` of their weight, by
// a sample of them; of the sample alone if that is at least half as large.
Bounds withoutEnds(const Bounds& all, std::size_t count, const BoxOf& boxOf, const WeightOf& weightOf, double end)
{
	constexpr int kBins = 4096;
	const std::size_t step = count / 100'000 + 1;
	const auto binsOf = [&](const Bounds& box)
	{
		const glm::dvec3 centre = 0.5 * (box.least + box.most);
		return glm::floor((centre - all.least) / glm::max(all.most - all.least, 1e-300) * static_cast<double>(kBins));
	};
	const auto areIn = [](glm::dvec3 bins, glm::dvec3 first, glm::dvec3 last)
	{
		return glm::all(glm::greaterThanEqual(bins, first)) && glm::all(glm::lessThanEqual(bins, last));
	};
	glm::dvec3 first(0.0); // bins
	glm::dvec3 last(kBins);
	std::array<std::vector<double>, 3> weights;
	weights.fill(std::vector<double>(kBins + 1, 0.0));
	for (std::size_t i = 0; i < count; i += step)
	{
		const glm::dvec3 bins = binsOf(boxOf(i));
		const double weight = areIn(bins, first, last) ? weightOf(i) : 0.0;
		for (int axis = 0; axis < 3 && weight > 0.0; ++axis)
		{
			weights[static_cast<std::size_t>(axis)][static_cast<std::size_t>(bins[axis])] += weight;
		}
	}
	const double most = end * sumOver(weights[0]);
	for (int axis = 0; axis < 3; ++axis)
	{
		const std::vector<double>& weight = weights[static_cast<std::size_t>(axis)];
		for (double below = weight.front(); below <= most && first[axis] < kBins;
			 below += weight[static_cast<std::size_t>(first[axis])])
		{
			first[axis] += 1.0;
		}
		for (double above = weight.back(); above <= most && last[axis] > 0.0; above += weight[static_cast<std::size_t>(last[axis])])
		{
			last[axis] -= 1.0;
		}
	}
	const auto restOf = [&](std::size_t every)
	{
		Bounds rest;
		for (std::size_t i = 0; i < count; i += every)
		{
			const Bounds box = boxOf(i);
			if (areIn(binsOf(box), first, last))
			{
				rest = {glm::min(rest.least, box.least), glm::max(rest.most, box.most)};
			}
		}
		return rest;
	};
	const Bounds sampled = restOf(step);
	return isHalved(all, sampled) ? restOf(1) : sampled;
}

Bounds boundsOf(std::size_t count, const BoxOf& boxOf)
{
	Bounds bounds;
	for (std::size_t i = 0; i < count; ++i)
	{
		const Bounds box = boxOf(i);
		bounds = {glm::min(bounds.least, box.least), glm::max(bounds.most, box.most)};
	}
	return bounds;
}

// Drops the ends as long as that more than halves the diagonal.
Bounds withoutStrays(Bounds bounds, std::size_t count, const BoxOf& boxOf, const WeightOf& weightOf, double end)
{
	for (;;)
	{
		const Bounds rest = withoutEnds(bounds, count, boxOf, weightOf, end);
		if (!isHalved(bounds, rest))
		{
			return bounds;
		}
		bounds = rest;
	}
}

BoxOf boxesOf(const Level& level)
{
	return [&](std::size_t i)
	{
		return boundsOf(level, i);
	};
}

WeightOf weightsOf(const Level& level)
{
	return [&](std::size_t i)
	{
		return glm::length(twiceAreaOf(level, i));
	};
}

} // namespace

Bounds boundsOf(const Level& level, std::size_t triangle)
{
	Bounds bounds;
	for (int corner = 0; corner < 3; ++corner)
	{
		const glm::dvec3& position = level.positions[level.triangles[triangle][corner]];
		bounds = {glm::min(bounds.least, position), glm::max(bounds.most, position)};
	}
	return bounds;
}

Bounds boundsOf(const Level& level)
{
	return boundsOf(level, {"", 0, level.triangles.size()});
}

Bounds boundsOf(const Level& level, const Mesh& mesh)
{
	Bounds bounds;
	for (std::size_t i = mesh.first_triangle; i < mesh.first_triangle + mesh.triangle_count; ++i)
	{
		const Bounds one = boundsOf(level, i);
		bounds = {glm::min(bounds.least, one.least), glm::max(bounds.most, one.most)};
	}
	return bounds;
}

Bounds mainBounds(const Level& level)
{
	return withoutStrays(preciseBounds(level), level.triangles.size(), boxesOf(level), weightsOf(level), 1.0 / 2000.0);
}

Bounds preciseBounds(std::size_t count, const BoxOf& boxOf, const WeightOf& weightOf)
{
	const Bounds all = boundsOf(count, boxOf);
	const Bounds main = withoutStrays(all, count, boxOf, weightOf, 1.0 / 20.0);
	return glm::distance(all.least, all.most) > 1000.0 * glm::distance(main.least, main.most) ? main : all;
}

Bounds preciseBounds(const Level& level)
{
	return preciseBounds(level.triangles.size(), boxesOf(level), weightsOf(level));
}

double alphaAt(const Mask& mask, glm::dvec2 uv)
{
	const double shift = mask.nearest ? 0.0 : 0.5;
	const double x = uv.x * mask.width_px - shift;
	const double y = uv.y * mask.height_px - shift;
	if (!std::isfinite(x) || !std::isfinite(y))
	{
		return 1.0;
	}
	if (mask.nearest)
	{
		return texelAt(mask, wrapped(std::floor(x), mask.width_px, mask.wrap_u),
					   wrapped(std::floor(y), mask.height_px, mask.wrap_v));
	}
	const double x0 = std::floor(x);
	const double y0 = std::floor(y);
	const int left = wrapped(x0, mask.width_px, mask.wrap_u);
	const int right = wrapped(x0 + 1.0, mask.width_px, mask.wrap_u);
	const int top = wrapped(y0, mask.height_px, mask.wrap_v);
	const int bottom = wrapped(y0 + 1.0, mask.height_px, mask.wrap_v);
	const double upper = glm::mix(texelAt(mask, left, top), texelAt(mask, right, top), x - x0);
	const double lower = glm::mix(texelAt(mask, left, bottom), texelAt(mask, right, bottom), x - x0);
	return glm::mix(upper, lower, y - y0);
}

bool isSolidAt(const Level& level, const Material& material, glm::dvec2 uv)
{
	if (material.alpha_mode == AlphaMode::opaque)
	{
		return true;
	}
	const double texture = material.mask < 0 ? 1.0 : alphaAt(level.masks[static_cast<std::size_t>(material.mask)], uv);
	return material.alpha * texture >= material.cutoff;
}

AlphaCounts countAlpha(const Mask& mask)
{
	// Four tables, since equal neighbours would wait for each other's increment.
	std::array<AlphaCounts, 4> parts{};
	for (std::size_t i = 0; i < mask.alpha.size(); ++i)
	{
		parts[i % 4][mask.alpha[i]] += 1;
	}
	AlphaCounts counts = parts[0];
	for (std::size_t i = 0; i < counts.size(); ++i)
	{
		counts[i] += parts[1][i] + parts[2][i] + parts[3][i];
	}
	return counts;
}

void measureAlpha(Material& material, const AlphaCounts& counts)
{
	material.mean_alpha = 1.0;
	material.coverage = 1.0;
	if (material.alpha_mode == AlphaMode::opaque)
	{
		return;
	}
	if (material.mask < 0)
	{
		material.mean_alpha = material.alpha;
		material.coverage = material.alpha >= material.cutoff ? 1.0 : 0.0;
		return;
	}
	uint64_t count = 0;
	uint64_t sum = 0;
	uint64_t passed = 0;
	for (std::size_t alpha = 0; alpha < counts.size(); ++alpha)
	{
		count += counts[alpha];
		sum += counts[alpha] * alpha;
		passed += material.alpha * (static_cast<double>(alpha) / 255.0) >= material.cutoff ? counts[alpha] : 0U;
	}
	assert(count > 0);
	material.mean_alpha = material.alpha * static_cast<double>(sum) / (255.0 * static_cast<double>(count));
	material.coverage = static_cast<double>(passed) / static_cast<double>(count);
}

void measureAlpha(Material& material, const std::vector<Mask>& masks)
{
	const bool masked = material.alpha_mode != AlphaMode::opaque && material.mask >= 0;
	measureAlpha(material, masked ? countAlpha(masks[static_cast<std::size_t>(material.mask)]) : AlphaCounts{});
}

Level cutCell(const Level& level, const CellSettings& settings, std::span<const uint8_t> closed, int threads)
{
	assert(closed.empty() || closed.size() == level.triangles.size());
	const std::vector<uint8_t> places = placesOf(level, settings);
	Level cell = level;
	cell.triangles.clear();
	cell.materials.clear();
	cell.meshes.clear();
	std::erase_if(cell.cameras,
				  [&](const LevelCamera& camera) { return !isIn(settings.box, glm::dvec3(camera.world_from_camera[3])); });
	for (const uint8_t place : {kOwn, kAround})
	{
		for (const Mesh& mesh : level.meshes)
		{
			for (const bool is_closed : {false, true})
			{
				Mesh made = mesh;
				made.first_triangle = cell.triangles.size();
				made.around = place == kAround;
				made.closed = is_closed;
				for (std::size_t i = mesh.first_triangle; i < mesh.first_triangle + mesh.triangle_count; ++i)
				{
					const bool closed_here = mesh.closed || (!closed.empty() && closed[i] != 0);
					if (places[i] == place && closed_here == is_closed)
					{
						cell.triangles.push_back(level.triangles[i]);
						cell.materials.push_back(level.materials[i]);
					}
				}
				made.triangle_count = cell.triangles.size() - made.first_triangle;
				cell.meshes.push_back(made);
			}
		}
		if (cell.triangles.empty())
		{
			break; // the cell has no triangles
		}
	}
	compactLevel(cell, std::vector<uint8_t>(cell.triangles.size(), 1), threads);
	return cell;
}

std::vector<Bounds> gridOf(const Level& level, glm::uvec3 counts)
{
	const Bounds all = boundsOf(level);
	const glm::dvec3 size = all.most - all.least;
	const auto at = [&](glm::uvec3 index)
	{
		glm::dvec3 corner = all.least + size * glm::dvec3(index) / glm::dvec3(counts);
		for (int axis = 0; axis < 3; ++axis)
		{
			// Boxes are half-open: a surface may coincide with the level's bounds, and rounding may move its centre outside.
			const double more = 1e-6 * (1.0 + size[axis]);
			corner[axis] = index[axis] == 0              ? all.least[axis] - more
						   : index[axis] == counts[axis] ? all.most[axis] + more
														 : corner[axis];
		}
		return corner;
	};
	std::vector<Bounds> boxes;
	for (unsigned z = 0; z < counts.z; ++z)
	{
		for (unsigned y = 0; y < counts.y; ++y)
		{
			for (unsigned x = 0; x < counts.x; ++x)
			{
				boxes.push_back({at({x, y, z}), at({x + 1, y + 1, z + 1})});
			}
		}
	}
	return boxes;
}

} // namespace nook
