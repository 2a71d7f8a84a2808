// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/coverage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace nook::detail
{
namespace
{

// Martin Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018: multiples of 1/ρ and 1/ρ², ρ³ = ρ + 1.
constexpr double kStepX = 0.75487766624669276;
constexpr double kStepY = 0.56984029099805327;

double doubleArea(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
	return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// As alphaAt(), quicker within the texture's inside.
double quickAlpha(const Mask& mask, glm::dvec2 uv)
{
	const double x = uv.x * mask.width_px - 0.5;
	const double y = uv.y * mask.height_px - 0.5;
	if (mask.nearest || !(x >= 0.0 && y >= 0.0 && x < mask.width_px - 1.0 && y < mask.height_px - 1.0))
	{
		return alphaAt(mask, uv);
	}
	const auto left = static_cast<std::size_t>(x);
	const auto top = static_cast<std::size_t>(y);
	const double right_share = x - static_cast<double>(left);
	const double bottom_share = y - static_cast<double>(top);
	const uint8_t* const texel = mask.alpha.data() + top * static_cast<std::size_t>(mask.width_px) + left;
	const double upper = texel[0] + right_share * (texel[1] - texel[0]);
	const double lower = texel[mask.width_px] + right_share * (texel[mask.width_px + 1] - texel[mask.width_px]);
	return (upper + bottom_share * (lower - upper)) / 255.0;
}

// Samples of a triangle that are solid.
std::size_t solidIn(const Mask& mask, const Material& material, glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, std::size_t count)
{
	std::size_t solid = 0;
	for (std::size_t i = 0; i < count; ++i)
	{
		double x = 0.5 + static_cast<double>(i) * kStepX;
		double y = 0.5 + static_cast<double>(i) * kStepY;
		x -= std::floor(x);
		y -= std::floor(y);
		if (x + y > 1.0)
		{
			x = 1.0 - x;
			y = 1.0 - y;
		}
		solid += material.alpha * quickAlpha(mask, a + x * (b - a) + y * (c - a)) >= material.cutoff ? 1U : 0U;
	}
	return solid;
}

} // namespace

double coverageOf(const Level& level, const Material& material, std::span<const glm::dvec2> corners)
{
	if (material.alpha_mode == AlphaMode::opaque || material.mask < 0)
	{
		return isSolidAt(level, material, {}) ? 1.0 : 0.0;
	}
	const Mask& mask = level.masks[static_cast<std::size_t>(material.mask)];
	double area = 0.0;
	for (std::size_t i = 1; i + 1 < corners.size(); ++i)
	{
		area += std::fabs(doubleArea(corners[0], corners[i], corners[i + 1]));
	}
	const bool has_area = area > 0.0 && std::isfinite(area); // else a line or a point of the texture
	const double texels = 0.5 * area * mask.width_px * mask.height_px;
	const double wanted = has_area ? std::clamp(4.0 * texels, 64.0, 1024.0) : 64.0;
	double sum = 0.0;
	for (std::size_t i = 1; i + 1 < corners.size(); ++i)
	{
		const double share = has_area ? std::fabs(doubleArea(corners[0], corners[i], corners[i + 1])) / area
									  : 1.0 / static_cast<double>(corners.size() - 2);
		const auto count = static_cast<std::size_t>(std::ceil(share * wanted)) + 1;
		sum += share * static_cast<double>(solidIn(mask, material, corners[0], corners[i], corners[i + 1], count)) /
			   static_cast<double>(count);
	}
	return std::min(sum, 1.0);
}

} // namespace nook::detail
