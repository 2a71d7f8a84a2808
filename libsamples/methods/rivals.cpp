// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/rivals.h"

#include "core/math.h"
#include "core/random.h"
#include "methods/rival_parts.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace nook
{
namespace
{

constexpr std::size_t kVariants = 16; // of a window of 4 × 4 pixels

// 0 to 15 in a random order (Fisher-Yates).
std::array<double, kVariants> shuffled(Random& random)
{
	std::array<double, kVariants> order{};
	for (std::size_t i = 0; i < kVariants; ++i)
	{
		order[i] = static_cast<double>(i);
	}
	for (std::uint32_t i = kVariants; i > 1; --i)
	{
		std::swap(order[i - 1], order[random.below(i)]);
	}
	return order;
}

} // namespace

Pattern crytekPoints(int count)
{
	assert(count > 0 && count % 8 == 0);
	Pattern pattern;
	pattern.domain = Domain::ball;
	const double step = 1.0 + 2.4 / count;
	double distance = 1.0;
	for (int i = 1; i < count; ++i)
	{
		distance /= step;
	}
	for (int i = 0; i < count; ++i)
	{
		const double side = distance / std::sqrt(3.0);
		pattern.points.emplace_back((i & 4) != 0 ? side : -side, (i & 2) != 0 ? side : -side, (i & 1) != 0 ? side : -side);
		pattern.weights.push_back(1.0 / count);
		distance = std::min(1.0, distance * step);
	}
	return pattern;
}

std::vector<glm::vec4> horizonDirections(int directions, std::uint32_t seed)
{
	assert(directions > 0);
	Random random(seed);
	const std::array<double, kVariants> turns = shuffled(random);
	const std::array<double, kVariants> jitters = shuffled(random);
	std::vector<glm::vec4> samples;
	for (std::size_t variant = 0; variant < kVariants; ++variant)
	{
		for (int i = 0; i < directions; ++i)
		{
			const SinCos angle = sinCosOf(2.0 * kPi * (i + turns[variant] / kVariants) / directions);
			samples.emplace_back(angle.cos, angle.sin, (jitters[variant] + 0.5) / kVariants, 1.0 / directions);
		}
	}
	return samples;
}

std::vector<glm::vec4> sliceDirections(int slices)
{
	assert(slices > 0);
	std::vector<glm::vec4> samples;
	for (int y = 0; y < 4; ++y)
	{
		for (int x = 0; x < 4; ++x)
		{
			const double turn = 4 * ((x + y) % 4) + x;
			const double jitter = (y - x + 4) % 4;
			for (int i = 0; i < slices; ++i)
			{
				const SinCos angle = sinCosOf(kPi * (i + (turn + 0.5) / kVariants) / slices);
				samples.emplace_back(angle.cos, angle.sin, (jitter + 0.5) / 4.0, 1.0 / slices);
			}
		}
	}
	return samples;
}

std::vector<glm::vec4> spiral(int count, int turns)
{
	assert(count > 0);
	std::vector<glm::vec4> samples;
	for (int i = 0; i < count; ++i)
	{
		const double distance = (i + 0.5) / count;
		const SinCos angle = sinCosOf(2.0 * kPi * distance * turns);
		samples.emplace_back(distance * angle.cos, distance * angle.sin, distance, 1.0 / count);
	}
	return samples;
}

ShadeSamples horizonSamples(const ShadeSettings& settings)
{
	return {4, settings.rival.directions, horizonDirections(settings.rival.directions)};
}

void setDirections(ShadeSettings& settings, int count)
{
	settings.rival.directions = count;
}

int setBestHorizon(ShadeSettings& settings)
{
	settings.rival.directions = 32;
	settings.rival.steps = 32;
	return settings.rival.directions;
}

ShadeSamples spiralSamples(const ShadeSettings& settings)
{
	const RivalSettings& rival = settings.rival;
	return {1, rival.spiral_samples, spiral(rival.spiral_samples, rival.spiral_turns)};
}

void setSpiral(ShadeSettings& settings, int count)
{
	settings.rival.spiral_samples = count;
}

int setBestSpiral(ShadeSettings& settings)
{
	settings.rival.spiral_samples = 256;
	return settings.rival.spiral_samples;
}

int spiralLevels(const ShadeSettings& settings)
{
	return settings.rival.levels;
}

ShadeSamples gtaoSamples(const ShadeSettings& settings)
{
	return {4, settings.rival.gtao_slices, sliceDirections(settings.rival.gtao_slices)};
}

void setGtaoSlices(ShadeSettings& settings, int count)
{
	settings.rival.gtao_slices = count;
}

int setBestGtao(ShadeSettings& settings)
{
	settings.rival.gtao_slices = 16;
	settings.rival.gtao_steps = 32;
	return settings.rival.gtao_slices;
}

ShadeSamples bitmaskSamples(const ShadeSettings& settings)
{
	return {4, settings.rival.bitmask_slices, sliceDirections(settings.rival.bitmask_slices)};
}

void setBitmaskSlices(ShadeSettings& settings, int count)
{
	settings.rival.bitmask_slices = count;
}

int setBestBitmask(ShadeSettings& settings)
{
	settings.rival.bitmask_slices = 16;
	settings.rival.bitmask_steps = 32;
	return settings.rival.bitmask_slices;
}

void fillCrytek(ShadeBlock& block, const ShadeSettings& settings)
{
	block.crytek_range = static_cast<float>(settings.rival.range);
}

void fillHorizon(ShadeBlock& block, const ShadeSettings& settings)
{
	const RivalSettings& rival = settings.rival;
	const SinCos bias = sinCosOf(rival.angle_bias_deg * kPi / 180.0);
	block.hbao_sine = static_cast<float>(bias.sin);
	block.hbao_cosine = static_cast<float>(bias.cos);
	block.steps = rival.steps;
}

void fillSpiral(ShadeBlock& block, const ShadeSettings& settings)
{
	const RivalSettings& rival = settings.rival;
	block.sao_intensity = static_cast<float>(rival.intensity);
	block.sao_bias = static_cast<float>(rival.bias);
	block.sao_epsilon = static_cast<float>(rival.epsilon);
}

void fillGtao(ShadeBlock& block, const ShadeSettings& settings)
{
	const RivalSettings& rival = settings.rival;
	block.gtao_falloff = static_cast<float>(rival.gtao_falloff);
	block.gtao_thickness = static_cast<float>(rival.gtao_thickness);
	block.steps = rival.gtao_steps;
}

void fillBitmask(ShadeBlock& block, const ShadeSettings& settings)
{
	const RivalSettings& rival = settings.rival;
	block.bitmask_thickness = static_cast<float>(rival.bitmask_thickness);
	block.bitmask_round = rival.bitmask_hit == BitmaskHit::half ? 0.5F : rival.bitmask_hit == BitmaskHit::whole ? 0.0F : 0.999F;
	block.steps = rival.bitmask_steps;
}

} // namespace nook
