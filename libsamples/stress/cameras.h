// SPDX-License-Identifier: GPL-3.0-or-later
// Random projections: perspective and parallel, off their centre, either end of depth at either end of the range, far planes at up
// to 10⁷ times the near one or at infinity, any format of depth.
#pragma once

#include "core/random.h"
#include "shade/block.h"
#include "shade/depth_format.h"
#include "stress/numbers.h"

#include <glm/mat4x4.hpp>

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

// sizes: 2^±this of the near plane in metres.
inline HardCamera hardCamera(Random& random, double sizes = kDecades)
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

// As blockOf: size, across, w, rect; and the format of depth.
inline ShadeBlock blockOf(const HardCamera& camera)
{
	const glm::dmat4& p = camera.projection;
	const auto narrow = [](double value)
	{
		return static_cast<float>(value);
	};
	ShadeBlock block;
	block.size = glm::vec4(glm::dvec4(camera.width, camera.height, 1.0 / camera.width, 1.0 / camera.height));
	block.across_x = {narrow(1.0 / p[0][0]), narrow(p[2][0] / p[0][0]), narrow(-p[3][0] / p[0][0]), 0.0F};
	block.across_y = {narrow(1.0 / p[1][1]), narrow(p[2][1] / p[1][1]), narrow(-p[3][1] / p[1][1]), 0.0F};
	block.w = {narrow(-p[2][3]), narrow(p[3][3]), 0.0F, 0.0F};
	block.rect = {0, 0, camera.width - 1, camera.height - 1};
	fillDepth(block, p, camera.format);
	return block;
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
