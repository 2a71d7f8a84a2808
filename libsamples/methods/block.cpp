// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/block.h"

#include "core/error.h"
#include "core/number.h"
#include "methods/depth_format.h"
#include "methods/method_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

float narrow(double value)
{
	return static_cast<float>(value);
}

// One row of the projection → what camera.glsl takes of it.
glm::vec4 acrossOf(const glm::dmat4& p, int row)
{
	const int other = 1 - row;
	if (p[other][row] != 0.0 || p[0][3] != 0.0 || p[1][3] != 0.0 || p[row][row] == 0.0)
	{
		throw Error(ExitCode::unsupported,
					"projection: found one with a skew, expected x and y of the picture to depend on x and y alone");
	}
	return {narrow(1.0 / p[row][row]), narrow(p[2][row] / p[row][row]), narrow(-p[3][row] / p[row][row]), 0.0F};
}

// Coarser levels beside the picture.
int levelsOf(const ShadeBlock& block, const ShadeSettings& settings)
{
	const MethodRow& row = rowOf(settings.method);
	if (row.moments)
	{
		return kMomentLevels;
	}
	const int wanted = row.levels != nullptr ? row.levels(settings) : 0;
	const int longer = std::max(block.rect.z, block.rect.w) + 1;
	int levels = 0;
	while (levels < wanted && longer >> (levels + 1) > 0)
	{
		levels += 1;
	}
	return levels;
}

} // namespace

glm::dmat4 unitProjection(const glm::dmat4& projection)
{
	const double w = std::max(std::fabs(projection[2][3]), std::fabs(projection[3][3]));
	return w > 0.0 && std::isfinite(w) ? projection * std::ldexp(1.0, -std::ilogb(w)) : projection;
}

void fillCamera(ShadeBlock& block, const glm::dmat4& given, int width_px, int height_px)
{
	const glm::dmat4 projection = unitProjection(given);
	block.size = glm::vec4(glm::dvec4(width_px, height_px, 1.0 / width_px, 1.0 / height_px));
	block.across_x = acrossOf(projection, 0);
	block.across_y = acrossOf(projection, 1);
	block.w = {narrow(-projection[2][3]), narrow(projection[3][3]), 0.0F, 0.0F};
	block.rect = {0, 0, width_px - 1, height_px - 1};
}

ShadeBlock blockOf(const ShadeFrame& frame, const ShadeSamples& samples, const ShadeSettings& settings)
{
	assert(settings.radius_m > 0.0);
	ShadeBlock block;
	fillCamera(block, frame.projection, frame.width_px, frame.height_px);
	checkLengths(frame, block);
	fillDepth(block, frame.projection, settings.depth);
	if (!frame.depth_error_m.empty())
	{
		fillMeasuredError(block, frame.depth, frame.depth_error_m);
	}
	block.error.z = narrow(normalError(settings.normal_bits));
	block.radius = {narrow(settings.radius_m), 0.0F, 0.0F, 0.0F};
	block.alchemy = glm::vec4(glm::dvec4(settings.sigma, settings.contrast, settings.beta, settings.epsilon));
	block.count = {samples.count, samples.size, settings.use_normal ? 1 : 0, settings.cut ? 1 : 0};
	const VoSettings& volume = settings.volume;
	block.volume = {narrow(volume.thickness_m), narrow(volume.second_radius_m > 0.0 ? volume.second_radius_m : settings.radius_m),
					0.0F, 0.0F};
	block.features = {static_cast<int>(volume.radii), volume.quadratic ? 1 : 0, volume.paired ? 1 : 0,
					  volume.thickness_m > 0.0 ? 1 : 0};
	const BandSettings& bands = settings.bands;
	const double most_px = settings.max_radius_px > 0.0 ? settings.max_radius_px : frame.height_px;
	if (settings.min_radius_px > most_px)
	{
		throw Error(ExitCode::usage, "--min-pixels: found " + numberText(settings.min_radius_px) + ", expected at most " +
										 numberText(most_px) + ", the picture's height where --max-pixels says nothing else");
	}
	block.limits = {narrow(bands.first_px), narrow(bands.second_px), narrow(most_px), narrow(settings.min_radius_px)};
	block.bands = {(samples.count + bands.count - 1) / bands.count, (2 * samples.count + bands.count - 1) / bands.count,
				   bands.count, 0};
	block.grid.w = levelsOf(block, settings);
	if (rowOf(settings.method).fill != nullptr)
	{
		rowOf(settings.method).fill(block, settings);
	}
	return block;
}

} // namespace nook
