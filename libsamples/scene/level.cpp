// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/level.h"

#include <glm/common.hpp>

#include <cassert>
#include <cmath>

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
	Bounds bounds;
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		const Bounds one = boundsOf(level, i);
		bounds = {glm::min(bounds.least, one.least), glm::max(bounds.most, one.most)};
	}
	return bounds;
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

} // namespace nook
