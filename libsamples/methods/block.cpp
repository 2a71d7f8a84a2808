// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/block.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/lists.h"
#include "core/round.h"
#include "methods/method_table.h"
#include "methods/runtime/nook_block.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <cmath>
#include <string_view>

namespace nook
{
namespace
{

float narrow(double value)
{
	return static_cast<float>(value);
}

// Scales the projection by a power of two so that w is about 1 per metre or 1: then w and its square fit 32 bits, however the
// matrix was scaled.
glm::dmat4 unitProjection(const glm::dmat4& projection)
{
	const double w = std::max(std::fabs(projection[2][3]), std::fabs(projection[3][3]));
	return w > 0.0 && std::isfinite(w) ? projection * std::ldexp(1.0, -std::ilogb(w)) : projection;
}

// Converts one row of the projection for camera.glsl.
nook_row_numbers acrossOf(const glm::dmat4& p, int row)
{
	const int other = 1 - row;
	refuseIf(p[other][row] != 0.0 || p[0][3] != 0.0 || p[1][3] != 0.0 || p[row][row] == 0.0,
			 "projection: found one with a skew, expected x and y of the picture to depend on x and y alone",
			 ExitCode::unsupported);
	double numbers[16];
	std::copy_n(glm::value_ptr(p), 16, numbers);
	return nook_row_of(numbers, row);
}

// Number of coarser depth levels.
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
	refuseIf(settings.min_radius_px > most_px, "min-pixels: found " + numberText(settings.min_radius_px) + ", expected at most " +
												   numberText(most_px) +
												   ", the picture's height where nothing else is said (max-pixels)");
	block.first_band_px = narrow(bands.first_px);
	block.second_band_px = narrow(bands.second_px);
	block.most_px = narrow(most_px);
	block.least_px = narrow(settings.min_radius_px);
	block.first_band = (block.samples + bands.count - 1) / bands.count;
	block.two_bands = (2 * block.samples + bands.count - 1) / bands.count;
	block.bands = bands.count;
}

// Lengths of a G-buffer that the kernels cannot take.

// Error in the picture's width or height at a depth; empty: none.
std::string wrongAcross(const glm::dvec3& across, double w, double depth_m)
{
	const double half_m = w * std::fabs(across.x);
	const double aside_m = depth_m * std::fabs(across.y) + std::fabs(across.z);
	if (!isLength(half_m))
	{
		return ", where half the picture is " + numberText(half_m) + " m";
	}
	return aside_m <= kMostLength_m ? "" : ", where the picture's middle is " + numberText(aside_m) + " m aside";
}

// Requires the block's camera. Throws Error (invalid_input), naming the pixel, if a depth, or half the picture's extent there, is
// outside the lengths that kernels can square; so no kernel meets an infinity or a radius of 0.
void checkLengths(const ShadeFrame& frame, const ShadeBlock& block)
{
	const glm::dvec3 across_x(block.across_x, block.aside.x);
	const glm::dvec3 across_y(block.across_y, block.aside.y);
	for (std::size_t i = 0; i < frame.depth.size(); ++i)
	{
		const auto depth_m = static_cast<double>(frame.depth[i]);
		if (!std::isfinite(depth_m))
		{
			continue;
		}
		const double w = static_cast<double>(block.w_slope) * depth_m + static_cast<double>(block.w_start);
		const std::string wrong_x = wrongAcross(across_x, w, depth_m);
		const std::string wrong = wrong_x.empty() ? wrongAcross(across_y, w, depth_m) : wrong_x;
		if (isLength(depth_m) && wrong.empty())
		{
			continue;
		}
		const auto width = static_cast<std::size_t>(frame.width_px);
		throw Error(ExitCode::invalid_input, "depth, pixel " + std::to_string(i % width) + "," + std::to_string(i / width) +
												 ": found " + numberText(depth_m) + " m" + (isLength(depth_m) ? wrong : "") +
												 ", expected lengths from " + numberText(kLeastLength_m) + " to " +
												 numberText(kMostLength_m) + " m");
	}
}

// The block as a table and as GLSL.

#define NOOK_ROW(type, name, meaning) BlockMember{#type, #name, meaning, offsetof(ShadeBlock, name)},
constexpr std::array kMembers{NOOK_MODULE_MEMBERS(NOOK_ROW) NOOK_OWN_MEMBERS(NOOK_ROW)};
constexpr std::array kModuleMembers{NOOK_MODULE_MEMBERS(NOOK_ROW)};
#undef NOOK_ROW

} // namespace

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

// Depth formats.

void fillDepth(ShadeBlock& block, const glm::dmat4& projection, const DepthFormat& format)
{
	const glm::dmat4 p = unitProjection(projection);
	assert(format.bits == 16 || format.bits == 24 || format.bits == 32);
	block.depth = glm::vec4(0.0F);
	block.depth_step = 0.0F;
	block.depth_share = static_cast<float>(format.bits == 16 ? kHalfRoundoff : kUnitRoundoff);
	if (!format.device)
	{
		return;
	}
	refuseIf(p[0][2] != 0.0 || p[1][2] != 0.0, "projection: found a z that depends on x or y, expected none with device depth",
			 ExitCode::unsupported);
	double numbers[16];
	std::copy_n(glm::value_ptr(p), 16, numbers);
	nook_depth_numbers depth;
	refuseIf(!nook_depth_of(depth, numbers, format.clip == ClipRange::zero_to_one, format.bits),
			 "projection: found a z that does not depend on depth, expected another with device depth", ExitCode::invalid_input);
	block.depth = glm::vec4(glm::make_vec4(depth.terms));
	block.far_end = static_cast<float>(depth.far_end);
	block.depth_step = static_cast<float>(depth.half_step);
	block.depth_share = static_cast<float>(depth.rounding);
}

void fillMeasuredError(ShadeBlock& block, std::span<const float> depths, std::span<const float> depth_error_m)
{
	assert(depth_error_m.size() == depths.size());
	double steps = 0.0;  // multiple of w squared
	double shares = 0.0; // multiple of the depth
	double slope = 0.0;  // sums over the pixels, to choose between the two
	double square = 0.0;
	for (std::size_t i = 0; i < depths.size(); ++i)
	{
		const auto depth = static_cast<double>(depths[i]);
		if (std::isfinite(depth))
		{
			const auto error = static_cast<double>(depth_error_m[i]);
			const double w = static_cast<double>(block.w_slope) * depth + static_cast<double>(block.w_start);
			steps = std::max(steps, (error - 2.0 * kUnitRoundoff * depth) / (w * w));
			shares = std::max(shares, error / depth);
			slope += depth;
			square += w * w;
		}
	}
	const bool floats = shares * slope < steps * square + 2.0 * kUnitRoundoff * slope;
	block.depth_step = static_cast<float>(floats ? 0.0 : steps);
	block.depth_share = static_cast<float>(floats ? std::max(shares, kUnitRoundoff) : 2.0 * kUnitRoundoff);
}

double normalError(int bits)
{
	assert(bits >= 8 && bits <= 32);
	return nook_normal_error(bits);
}

std::span<const BlockMember> blockMembers(bool all)
{
	return std::span(kMembers).first(all ? kMembers.size() : kModuleMembers.size());
}

MemberPlace placeOf(const BlockMember& member, std::size_t end)
{
	const char last = std::string_view(member.type).back();
	const std::size_t count = last == '2' || last == '4' ? static_cast<std::size_t>(last - '0') : 1;
	const std::size_t bytes = 4 * count;
	const std::size_t offset = (end + bytes - 1) / bytes * bytes;
	return {offset, offset + bytes};
}

std::string membersGlsl()
{
	return joinedText(blockMembers(true), "",
					  [](const BlockMember& member)
					  { return "\t" + std::string(member.type) + " " + member.name + "; // " + member.meaning + "\n"; });
}

std::map<std::string, std::string> constantsOf(const ShadeBlock& block)
{
	std::map<std::string, std::string> constants;
	const auto add = [&constants](std::string name, int value)
	{
		std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
		constants["NOOK_" + name] = std::to_string(value);
	};
#define NOOK_ADD(name, value, meaning) add(#name, block.name);
	NOOK_SHADE_CONSTANTS(NOOK_ADD)
#undef NOOK_ADD
	return constants;
}

} // namespace nook
