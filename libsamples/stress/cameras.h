// SPDX-License-Identifier: GPL-3.0-or-later
// Random projections: perspective and parallel, off their centre, either end of depth at either end of the range, far planes at up
// to 10⁷ times the near one or at infinity, any format of depth.
#pragma once

#include "core/random.h"
#include "methods/block.h"
#include "methods/depth_format.h"
#include "stress/numbers.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <array>
#include <cmath>

namespace nook::stress
{

struct HardCamera
{
	glm::dmat4 projection{0.0};
	DepthFormat format;
	int width = 1; // pixels
	int height = 1;
	double near_m = 1.0;
	double far_m = 2.0; // infinite: the greatest depth that is asked for
	bool parallel = false;
	bool reversed = false;
	bool infinite = false;
};

// The rows of z and w, for ndc z from `front` at the near plane to `back` at the far one.
inline void fillDepthRows(HardCamera& camera, double front, double back)
{
	glm::dmat4& p = camera.projection;
	const double n = camera.near_m;
	const double f = camera.far_m;
	if (camera.parallel)
	{
		p[2][2] = (front - back) / (f - n);
		p[3][2] = front + p[2][2] * n;
		p[3][3] = 1.0;
		return;
	}
	const double b = (front - back) / (1.0 / n - (camera.infinite ? 0.0 : 1.0 / f));
	p[2][2] = b / n - front;
	p[3][2] = b;
	p[2][3] = -1.0;
}

// sizes: 2^±this of the near plane in metres. pixels: of the picture; any where there are none. Three in four pixels are square.
inline HardCamera hardCamera(Random& random, double sizes = kDecades, glm::ivec2 pixels = glm::ivec2(0))
{
	HardCamera camera;
	camera.near_m = octaves(random, -sizes, sizes);
	camera.far_m = camera.near_m * (1.0 + octaves(random, -7.0, 23.25)); // to 10⁷
	camera.parallel = random.below(4) == 0;
	camera.reversed = random.below(2) == 0;
	camera.infinite = !camera.parallel && random.below(4) == 0;
	camera.format.device = true;
	camera.format.clip = random.below(2) == 0 ? ClipRange::zero_to_one : ClipRange::minus_one_to_one;
	camera.format.bits = random.below(3) == 0 ? 16 : random.below(2) == 0 ? 24 : 32;
	const double least = camera.format.clip == ClipRange::zero_to_one ? 0.0 : -1.0;
	fillDepthRows(camera, camera.reversed ? 1.0 : least, camera.reversed ? least : 1.0);
	camera.width = 1 + static_cast<int>(random.below(random.below(4) == 0 ? 8 : 8192));
	camera.height = 1 + static_cast<int>(random.below(random.below(4) == 0 ? 8 : 4320));
	if (pixels.x > 0)
	{
		camera.width = pixels.x;
		camera.height = pixels.y;
	}
	glm::dmat4& p = camera.projection;
	const double zoom = octaves(random, -3.0, 6.0); // half a field of view of 83° to 1°
	const double size = camera.parallel ? 1.0 / (camera.near_m * octaves(random, -3.0, 10.0)) : zoom;
	p[0][0] = size;
	p[1][1] = size * camera.width / camera.height * (random.below(4) == 0 ? between(random, 0.5, 2.0) : 1.0);
	const int other = camera.parallel ? 3 : 2; // off the centre, or jittered
	if (random.below(2) == 0)
	{
		p[other][0] = between(random, -1.0, 1.0);
		p[other][1] = between(random, -1.0, 1.0);
	}
	return camera;
}

inline ShadeBlock blockOf(const HardCamera& camera)
{
	ShadeBlock block;
	fillCamera(block, camera.projection, camera.width, camera.height);
	fillDepth(block, camera.projection, camera.format);
	return block;
}

struct Sight
{
	std::array<long double, 3> at;    // at depth 0
	std::array<long double, 3> along; // a metre of depth
	long double size = 0.0L;          // of the terms of the latter, which off-centre projections take from each other

	std::array<long double, 3> point(long double depth) const
	{
		return {at[0] + depth * along[0], at[1] + depth * along[1], at[2] + depth * along[2]};
	}
};

// The line of sight of a pixel's middle, by the projection's own 64 bits.
inline Sight sightOf(const glm::dmat4& projection, int width_px, int height_px, glm::ivec2 pixel)
{
	const auto of = [&projection](int column, int row)
	{
		return static_cast<long double>(projection[column][row]);
	};
	const std::array<long double, 2> ndc{(2.0L * pixel.x + 1.0L) / width_px - 1.0L, 1.0L - (2.0L * pixel.y + 1.0L) / height_px};
	Sight sight{{0.0L, 0.0L, 0.0L}, {0.0L, 0.0L, -1.0L}, 0.0L};
	for (int i = 0; i < 2; ++i)
	{
		// ndc w = P_ii x + P_2i z + P_3i, w = P_23 z + P_33, z = −depth.
		const auto k = static_cast<std::size_t>(i);
		sight.at[k] = (ndc[k] * of(3, 3) - of(3, i)) / of(i, i);
		sight.along[k] = (of(2, i) - ndc[k] * of(2, 3)) / of(i, i);
		sight.size += (std::fabs(of(2, i)) + std::fabs(ndc[k] * of(2, 3))) / std::fabs(of(i, i));
	}
	return sight;
}

// Pixels a metre at that depth, without their signs.
inline std::array<long double, 2> pixelsPerMetre(const glm::dmat4& projection, int width_px, int height_px, long double depth)
{
	const long double w = static_cast<long double>(projection[3][3]) - static_cast<long double>(projection[2][3]) * depth;
	return {std::fabs(0.5L * width_px * static_cast<long double>(projection[0][0]) / w),
			std::fabs(0.5L * height_px * static_cast<long double>(projection[1][1]) / w)};
}

// Anywhere between the planes; often close to one of them.
inline double hardDepth(Random& random, const HardCamera& camera)
{
	const double n = camera.near_m;
	const double f = camera.far_m;
	switch (random.below(4))
	{
	case 0: return between(random, n, f);
	case 1: return 1.0 / between(random, 1.0 / f, 1.0 / n);
	case 2: return random.below(2) == 0 ? n : f;
	default: return n + (f - n) * octaves(random, -24.0, -1.0);
	}
}

} // namespace nook::stress
