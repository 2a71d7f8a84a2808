// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/block.h"

#include "core/error.h"
#include "core/number.h"
#include "methods/depth_format.h"
#include "methods/method_table.h"
#include "methods/runtime/nook_block.h"

#include <glm/gtc/type_ptr.hpp>

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
nook_row_numbers acrossOf(const glm::dmat4& p, int row)
{
	const int other = 1 - row;
	if (p[other][row] != 0.0 || p[0][3] != 0.0 || p[1][3] != 0.0 || p[row][row] == 0.0)
	{
		throw Error(ExitCode::unsupported,
					"projection: found one with a skew, expected x and y of the picture to depend on x and y alone");
	}
	double numbers[16];
	std::copy_n(glm::value_ptr(p), 16, numbers);
	return nook_row_of(numbers, row);
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
	const int longer = std::max(block.last.x, block.last.y) + 1;
	int levels = 0;
	while (levels < wanted && longer >> (levels + 1) > 0)
	{
		levels += 1;
	}
	return levels;
}

void fillVolume(ShadeBlock& block, const ShadeSettings& settings)
{
	const VoSettings& volume = settings.volume;
	const auto either = [](double own, double otherwise)
	{
		return narrow(own > 0.0 ? own : otherwise);
	};
	block.thickness = narrow(volume.thickness_m);
	block.second_thickness = either(volume.second_thickness_m, volume.thickness_m);
	block.third_thickness = either(volume.third_thickness_m, volume.thickness_m);
	block.second_radius = either(volume.second_radius_m, settings.radius_m);
	block.third_radius = either(volume.third_radius_m, settings.radius_m);
	block.third = volume.third_radius_m > 0.0 ? 1 : 0;
	block.radii = static_cast<int>(volume.radii);
	block.quadratic = volume.quadratic ? 1 : 0;
	block.paired = volume.paired ? 1 : 0;
	block.thick = volume.thickness_m > 0.0 ? 1 : 0;
}

void fillBands(ShadeBlock& block, const ShadeSettings& settings, int height_px)
{
	const BandSettings& bands = settings.bands;
	const double most_px = settings.max_radius_px > 0.0 ? settings.max_radius_px : height_px;
	if (settings.min_radius_px > most_px)
	{
		throw Error(ExitCode::usage, "min-pixels: found " + numberText(settings.min_radius_px) + ", expected at most " +
										 numberText(most_px) + ", the picture's height where nothing else is said (max-pixels)");
	}
	block.first_band_px = narrow(bands.first_px);
	block.second_band_px = narrow(bands.second_px);
	block.most_px = narrow(most_px);
	block.least_px = narrow(settings.min_radius_px);
	block.first_band = (block.samples + bands.count - 1) / bands.count;
	block.two_bands = (2 * block.samples + bands.count - 1) / bands.count;
	block.bands = bands.count;
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
	block.size = glm::vec2(width_px, height_px);
	block.pixel_size = {narrow(1.0 / width_px), narrow(1.0 / height_px)};
	const nook_row_numbers x = acrossOf(projection, 0);
	const nook_row_numbers y = acrossOf(projection, 1);
	block.across_x = {narrow(x.scale), narrow(x.shear)};
	block.across_y = {narrow(y.scale), narrow(y.shear)};
	block.aside = {narrow(x.aside), narrow(y.aside)};
	block.w_slope = narrow(-projection[2][3]);
	block.w_start = narrow(projection[3][3]);
	block.first = {0, 0};
	block.last = {width_px - 1, height_px - 1};
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
	block.normal_error = narrow(normalError(settings.normal_bits));
	block.radius = narrow(settings.radius_m);
	block.sigma = narrow(settings.sigma);
	block.contrast = narrow(settings.contrast);
	block.beta = narrow(settings.beta);
	block.epsilon = narrow(settings.epsilon);
	block.slice_thickness = narrow(settings.slices.thickness);
	block.strength = narrow(settings.strength);
	block.power = narrow(settings.power);
	block.samples = samples.count;
	block.window = samples.size;
	block.variant = samples.variant;
	block.tiled = samples.tiled ? 1 : 0;
	block.use_normal = settings.use_normal ? 1 : 0;
	block.cut = settings.cut ? 1 : 0;
	fillVolume(block, settings);
	fillBands(block, settings, frame.height_px);
	block.levels = levelsOf(block, settings);
	if (rowOf(settings.method).fill != nullptr)
	{
		rowOf(settings.method).fill(block, settings);
	}
	return block;
}

} // namespace nook
