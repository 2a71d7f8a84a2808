// SPDX-License-Identifier: GPL-3.0-or-later
// Depth buffers and cameras: depth from what a buffer holds, positions, sizes in the picture, tangent planes.
#include "methods/kernels.h"
#include "stress/cameras.h"
#include "stress/case.h"

#include <algorithm>
#include <array>

namespace nook::stress
{
namespace
{

using shade_kernels::Kernels;
using Long = long double;

constexpr auto kSky = static_cast<double>(NOOK_SKY);

void noteCamera(Case& one, const HardCamera& camera)
{
	if (one.shown())
	{
		for (int i = 0; i < 4; ++i)
		{
			one.note("projection column " + std::to_string(i) + " x y z", glm::dvec3(camera.projection[i]));
			one.note("projection column " + std::to_string(i) + " w", camera.projection[i].w);
		}
		one.note("pixels", glm::ivec2(camera.width, camera.height));
		one.note("near", camera.near_m);
		one.note("far", camera.far_m);
		one.note("bits of depth", camera.format.bits);
	}
}

// What a buffer holds of a depth: 0 to 1, rounded as its format does.
double storedDepth(const HardCamera& camera, double depth)
{
	const glm::dmat4& p = camera.projection;
	const Long d = depth;
	const Long ndc = (static_cast<Long>(p[3][2]) - static_cast<Long>(p[2][2]) * d) /
					 (static_cast<Long>(p[3][3]) - static_cast<Long>(p[2][3]) * d);
	const Long device = std::clamp(camera.format.clip == ClipRange::zero_to_one ? ndc : (ndc + 1.0L) / 2.0L, 0.0L, 1.0L);
	if (camera.format.bits == 32)
	{
		return static_cast<double>(static_cast<float>(device));
	}
	const Long most = std::ldexp(1.0L, camera.format.bits) - 1.0L;
	return static_cast<double>(static_cast<float>(std::floor(device * most + 0.5L) / most));
}

// The depth that a buffer's number stands for, by the projection's own 64 bits.
Long depthOf(const HardCamera& camera, double device)
{
	const glm::dmat4& p = camera.projection;
	const Long ndc =
		camera.format.clip == ClipRange::zero_to_one ? static_cast<Long>(device) : 2.0L * static_cast<Long>(device) - 1.0L;
	return (static_cast<Long>(p[3][2]) - ndc * static_cast<Long>(p[3][3])) /
		   (static_cast<Long>(p[2][2]) - ndc * static_cast<Long>(p[2][3]));
}

// What a depth comes back as is off by no more than nookDepthError says; the projection's own rounding (64 bits) included.
void runDepthFormat(Case& one)
{
	const HardCamera camera = hardCamera(one.random);
	const double depth = hardDepth(one.random, camera);
	noteCamera(one, camera);
	one.note("depth", depth);
	Kernels kernels;
	kernels.nook = blockOf(camera);
	const double device = storedDepth(camera, depth);
	one.note("device depth", device);
	const auto found = static_cast<double>(kernels.nookLinear(static_cast<float>(device)));
	one.result("depth", found, 0.0, kSky);
	if (found >= kSky)
	{
		one.leaveOpen(); // rounded to the far end
		return;
	}
	const auto allowed = static_cast<double>(kernels.nookDepthError(static_cast<float>(found)));
	one.note("allowed", allowed);
	const double away = std::fabs(device - static_cast<double>(kernels.nook.far_end));
	const int digits = std::min(camera.format.bits, kernels.nook.far_end > 0.5F ? 24 : 64); // floats are finest at 0
	if (!camera.parallel && away * std::ldexp(1.0, digits) < 64.0)
	{
		// nookDepthError is of first order: k steps from the far end, depths may be off by k / (k - 1/2) times as much.
		one.leaveOpen();
		return;
	}
	one.compare("depth", found, static_cast<Long>(depth), allowed);
}

// The same number by exact arithmetic.
void runDepthLinear(Case& one)
{
	const HardCamera camera = hardCamera(one.random);
	const double depth = hardDepth(one.random, camera);
	noteCamera(one, camera);
	Kernels kernels;
	kernels.nook = blockOf(camera);
	const double device = storedDepth(camera, depth);
	one.note("device depth", device);
	const auto found = static_cast<double>(kernels.nookLinear(static_cast<float>(device)));
	one.result("depth", found, 0.0, kSky);
	if (found >= kSky)
	{
		one.leaveOpen();
		return;
	}
	const Long expected = depthOf(camera, device);
	// Parallel: 32 bits of the far plane's depth, of which a part is taken off.
	one.compare("depth", found, expected, camera.parallel ? camera.far_m : static_cast<double>(expected));
}

glm::ivec2 hardPixel(Case& one, const HardCamera& camera)
{
	if (one.random.below(4) == 0)
	{
		return {one.random.below(2) == 0 ? 0 : camera.width - 1, one.random.below(2) == 0 ? 0 : camera.height - 1};
	}
	return {static_cast<int>(one.random.below(static_cast<uint32_t>(camera.width))),
			static_cast<int>(one.random.below(static_cast<uint32_t>(camera.height)))};
}

void runPosition(Case& one)
{
	const HardCamera camera = hardCamera(one.random);
	const auto depth = static_cast<float>(hardDepth(one.random, camera));
	const glm::ivec2 pixel = hardPixel(one, camera);
	noteCamera(one, camera);
	one.note("pixel", pixel);
	one.note("depth", static_cast<double>(depth));
	Kernels kernels;
	kernels.nook = blockOf(camera);
	const glm::vec3 found = kernels.nookPosition(pixel, depth);
	const Sight sight = sightOf(camera.projection, camera.width, camera.height, pixel);
	const std::array<Long, 3> expected = sight.point(static_cast<Long>(depth));
	Long size = 0.0L;
	for (std::size_t i = 0; i < 3; ++i)
	{
		size = std::max({size, std::fabs(expected[i]), std::fabs(sight.at[i])});
	}
	// Off-centre projections add terms as large as half of the picture's width at that depth.
	const glm::vec2 scale = kernels.nookScale(depth);
	const auto half =
		static_cast<Long>(0.5F * std::max(static_cast<float>(camera.width) / scale.x, static_cast<float>(camera.height) / scale.y));
	size = std::max(size, half);
	for (std::size_t i = 0; i < 3; ++i)
	{
		const auto value = static_cast<double>(found[static_cast<int>(i)]);
		one.result("position", value, -1e30, 1e30);
		one.compare("position", value, expected[i], static_cast<double>(size));
	}
}

// Pixels a metre, and the pixel that lies an offset away.
void runNeighbour(Case& one)
{
	const HardCamera camera = hardCamera(one.random);
	const auto depth = static_cast<float>(hardDepth(one.random, camera));
	const glm::ivec2 pixel = hardPixel(one, camera);
	Kernels kernels;
	kernels.nook = blockOf(camera);
	const glm::vec2 scale = kernels.nookScale(depth);
	const glm::dvec2 away(between(one.random, -1.0, 1.0) * camera.width, between(one.random, -1.0, 1.0) * camera.width);
	const glm::vec2 offset(glm::dvec2(away.x / static_cast<double>(scale.x), away.y / static_cast<double>(scale.y)));
	noteCamera(one, camera);
	one.note("pixel", pixel);
	one.note("depth", static_cast<double>(depth));
	one.note("offset", offset);
	const glm::ivec2 found = kernels.nookNeighbour(pixel, offset, scale);
	one.note("neighbour", found);
	one.result("x", found.x, 0.0, camera.width - 1.0);
	one.result("y", found.y, 0.0, camera.height - 1.0);
	const auto [across, down] = pixelsPerMetre(camera.projection, camera.width, camera.height, static_cast<Long>(depth));
	const std::array<Long, 2> place{static_cast<Long>(pixel.x) + 0.5L + static_cast<Long>(offset.x) * across,
									static_cast<Long>(pixel.y) + 0.5L - static_cast<Long>(offset.y) * down};
	for (int i = 0; i < 2; ++i)
	{
		// How far outside of the pixel that was found the true place is; beyond the picture's border any of the last is right.
		const Long side = i == 0 ? camera.width : camera.height;
		const Long inside = std::clamp(place[static_cast<std::size_t>(i)], 0.0L, side);
		const Long off = std::max({0.0L, static_cast<Long>(found[i]) - inside, inside - static_cast<Long>(found[i]) - 1.0L});
		one.compare(i == 0 ? "pixels beside x" : "pixels beside y", static_cast<double>(off), 0.0L);
	}
}

// Where a line of sight meets a plane, as rays have it.
void runPlane(Case& one)
{
	const HardCamera camera = hardCamera(one.random, 13.0);
	const auto depth = static_cast<float>(hardDepth(one.random, camera));
	const glm::ivec2 pixel = hardPixel(one, camera);
	const glm::ivec2 there = hardPixel(one, camera);
	glm::vec3 n(hardDirection(one.random));
	n.z = std::fabs(n.z);
	Kernels kernels;
	kernels.nook = blockOf(camera);
	const auto height =
		static_cast<float>(one.random.below(2) == 0 ? 0.0 : static_cast<double>(depth) * octaves(one.random, -20.0, 0.0));
	noteCamera(one, camera);
	one.note("pixel", pixel);
	one.note("there", there);
	one.note("depth", static_cast<double>(depth));
	one.note("height", static_cast<double>(height));
	one.note("normal", n);
	const auto found = static_cast<double>(kernels.nookPlaneRise(pixel, there, n, depth, height));
	one.result("rise", found, -1e37, 1e37);
	const Sight own = sightOf(camera.projection, camera.width, camera.height, pixel);
	const Sight other = sightOf(camera.projection, camera.width, camera.height, there);
	Long over = static_cast<Long>(height); // that the plane is over the other line's point at this depth, along n
	Long fall = 0.0L;
	Long size = std::fabs(over); // of the terms of `over`, and of `fall`
	Long steep = 0.0L;
	for (std::size_t i = 0; i < 3; ++i)
	{
		const auto component = static_cast<Long>(n[static_cast<int>(i)]);
		const Long apart = other.at[i] - own.at[i] + static_cast<Long>(depth) * (other.along[i] - own.along[i]);
		over -= component * apart;
		size += std::fabs(component * apart);
		fall += component * other.along[i];
		steep += std::fabs(component) * (other.size + own.size + 0.2L);
	}
	if (found >= kSky || std::fabs(fall) < 1e-5L * steep)
	{
		one.require("a plane that faces the camera is met", !(found >= kSky) || fall > -1e-6L - 1e-6L * steep);
		one.leaveOpen();
		return;
	}
	// A relative error of `fall` is one of the result; at grazing angles that is what rounding of the projection leaves.
	const Long unit = size / std::fabs(fall) * (steep / std::fabs(fall));
	one.compare("rise", found, over / fall, static_cast<double>(std::max(unit, 1e-38L)));
}

constexpr std::array kDepthKernels{
	StressKernel{"depth-format", "depth", "the depth before a buffer of 16, 24 or 32 bits rounded it", "what nookDepthError allows",
				 1.02, 300, 1, runDepthFormat},
	StressKernel{"depth-linear", "depth", "the projection's inverse in 80 bits", "share of the depth, parallel: of the far plane's",
				 1e-6, 300, 1, runDepthLinear},
	StressKernel{"position", "camera", "the projection's inverse in 80 bits", "share of its distance, or of half the picture", 1e-6,
				 300, 1, runPosition},
	StressKernel{"neighbour", "camera", "the projection in 80 bits, pictures up to 8192 wide", "pixels", 4e-3, 300, 1,
				 runNeighbour},
	StressKernel{"plane-rise", "camera", "a ray against the plane in 80 bits", "the terms' size over the cosine squared", 2e-5, 300,
				 1, runPlane},
};

} // namespace

std::span<const StressKernel> depthKernels()
{
	return kDepthKernels;
}

} // namespace nook::stress
