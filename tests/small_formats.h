// SPDX-License-Identifier: GPL-3.0-or-later
// One view through projections of every kind, and depths and normals quantised to formats of few bits.
#pragma once

#include "picture_errors.h"
#include "small_views.h"
#include "testing.h"

#include "methods/block.h"

#include <glm/common.hpp>

namespace nook::test
{

struct Convention
{
	const char* name;
	glm::dmat4 projection;
	ClipRange clip;
	bool parallel = false;
};

// The projection with its lower right 2 x 2 entries replaced.
inline glm::dmat4 withDepth(glm::dmat4 p, double p22, double p32)
{
	p[2][2] = p22;
	p[3][2] = p32;
	return p;
}

// Planes at 0.1 m and 200 m, or infinity; for parallel projections, `flat` with other z ranges, starting at 0.01 m because much is
// near there.
inline std::vector<Convention> conventions(const glm::dmat4& p, const glm::dmat4& flat, int width, int height)
{
	const double n = 0.1;
	const double f = 200.0;
	const double m = 0.01;
	glm::dmat4 off = withDepth(p, -(f + n) / (f - n), -2.0 * f * n / (f - n));
	off[2][0] = 0.3;
	off[2][1] = -0.2;
	glm::dmat4 jittered = withDepth(p, 0.0, n); // reversed, infinite, and shifted by part of a pixel
	jittered[2][0] = 2.0 * 0.25 / width;
	jittered[2][1] = 2.0 * -0.375 / height;
	return {{"ordinary", withDepth(p, -(f + n) / (f - n), -2.0 * f * n / (f - n)), ClipRange::minus_one_to_one},
			{"ordinary, 0 to 1", withDepth(p, -f / (f - n), -f * n / (f - n)), ClipRange::zero_to_one},
			{"reversed", withDepth(p, n / (f - n), f * n / (f - n)), ClipRange::zero_to_one},
			{"infinite", withDepth(p, -1.0, -2.0 * n), ClipRange::minus_one_to_one},
			{"reversed infinite", withDepth(p, 0.0, n), ClipRange::zero_to_one},
			{"off-centre", off, ClipRange::minus_one_to_one},
			{"jittered", jittered, ClipRange::zero_to_one},
			{"parallel", withDepth(flat, -2.0 / (f - m), -(f + m) / (f - m)), ClipRange::minus_one_to_one, true},
			{"parallel reversed", withDepth(flat, 1.0 / (f - m), f / (f - m)), ClipRange::zero_to_one, true}};
}

// Depth buffer value of a depth: integer steps for 16 and 24 bits, floats for 32; the far end for sky.
inline float deviceOf(double depth, const Convention& convention, int bits)
{
	const glm::dmat4& p = convention.projection;
	const bool far_is_one = p[2][2] * p[3][3] - p[2][3] * p[3][2] < 0.0;
	if (!std::isfinite(depth))
	{
		return far_is_one ? 1.0F : 0.0F;
	}
	const double z = (p[3][2] - p[2][2] * depth) / (p[3][3] - p[2][3] * depth);
	const double device = std::fmin(std::fmax(convention.clip == ClipRange::zero_to_one ? z : 0.5 * z + 0.5, 0.0), 1.0);
	if (bits == 32)
	{
		return static_cast<float>(device);
	}
	const double steps = std::ldexp(1.0, bits) - 1.0;
	return static_cast<float>(std::floor(device * steps + 0.5) / steps);
}

inline std::vector<float> devicesOf(const GBuffer& gbuffer, const Convention& convention, int bits)
{
	const std::vector<float> devices =
		mapped(gbuffer.depth, [&](const float depth) { return deviceOf(static_cast<double>(depth), convention, bits); });
	return devices;
}

inline DepthFormat formatOf(const Convention& convention, int bits)
{
	return {true, convention.clip, bits};
}

// A block with only the depth conversion.
inline shade_kernels::Kernels depthKernels(const Convention& convention, int bits)
{
	shade_kernels::Kernels kernels;
	const glm::dmat4& p = convention.projection;
	kernels.nook.w_slope = static_cast<float>(-p[2][3]);
	kernels.nook.w_start = static_cast<float>(p[3][3]);
	fillDepth(kernels.nook, p, formatOf(convention, bits));
	return kernels;
}

// The depths after a round trip through the buffer.
inline GBuffer through(const GBuffer& gbuffer, const Convention& convention, int bits)
{
	shade_kernels::Kernels kernels = depthKernels(convention, bits);
	GBuffer other = gbuffer;
	const std::vector<float> devices = devicesOf(gbuffer, convention, bits);
	for (std::size_t i = 0; i < devices.size(); ++i)
	{
		const float depth = kernels.nookLinear(devices[i]);
		other.depth[i] = depth >= NOOK_SKY ? std::numeric_limits<float>::infinity() : depth;
	}
	return other;
}

// Normals with components of that many bits, stored as 0 to 1.
inline GBuffer withNormals(const GBuffer& gbuffer, int bits)
{
	GBuffer other = gbuffer;
	const double steps = std::ldexp(1.0, bits) - 1.0;
	for (glm::vec3& normal : other.normals)
	{
		if (normal != glm::vec3(0.0F))
		{
			const glm::dvec3 stored = glm::floor((0.5 * glm::dvec3(normal) + 0.5) * steps + 0.5) / steps;
			normal = glm::vec3(glm::normalize(2.0 * stored - 1.0));
		}
	}
	return other;
}

} // namespace nook::test
