// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons' volumes: form factor, falloff and their product.
#include "methods/volume_kernels.h"
#include "stress/case.h"
#include "stress/form_factor_twin.h"
#include "stress/numbers.h"
#include "volume/evaluate.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace nook::stress
{
namespace
{

using WideVector = Vector<long double>;

void notePolygon(Case& one, const std::vector<glm::vec3>& corners, const glm::vec3& normal)
{
	if (one.shown())
	{
		for (std::size_t i = 0; i < corners.size(); ++i)
		{
			one.note("corner " + std::to_string(i), corners[i]);
		}
		one.note("normal", normal);
	}
}

double reachOfCorners(const std::vector<glm::vec3>& corners)
{
	double most = 0.0;
	for (const glm::vec3& corner : corners)
	{
		most = std::max(most, static_cast<double>(glm::length(corner)));
	}
	return most;
}

// Hard polygons of any size.
void runFormFactor(Case& one)
{
	HardPolygon hard = hardPolygon(one.random, static_cast<int>(one.index() % kHardKinds));
	if (one.random.below(2) == 0)
	{
		const auto scale = static_cast<float>(std::ldexp(1.0, static_cast<int>(one.random.below(26)) - 13));
		for (glm::vec3& corner : hard.corners)
		{
			corner *= scale; // exact, but for what becomes denormal
		}
	}
	notePolygon(one, hard.corners, hard.normal);
	volume_kernels::Kernels kernels;
	kernels.corners = hard.corners;
	const float found = kernels.nookFormFactor(static_cast<int>(hard.corners.size()), hard.normal, hard.side);
	one.result("form factor", static_cast<double>(found), 0.0, 1.0);
	if (one.hasTwin())
	{
		one.compare("form factor", static_cast<double>(found), referenceFormFactor<long double>(hard.corners, hard.normal));
	}
}

// Corners that need not make a polygon at all: any size, zeros, denormals, twice the same.
std::vector<glm::vec3> wildCorners(Case& one)
{
	std::vector<glm::vec3> corners(3 + one.random.below(14));
	const double size = anySize(one.random);
	for (glm::vec3& corner : corners)
	{
		for (int i = 0; i < 3; ++i)
		{
			corner[i] = hardFloat(one.random, size);
		}
		if (one.random.below(6) == 0)
		{
			corner = corners[one.random.below(static_cast<uint32_t>(corners.size()))];
		}
	}
	return corners;
}

// How far a volume goes along the normal and beyond the edges, shares of the reach as files hold them: k/128, and of that m/8; half
// of them the whole.
glm::vec2 hardShare(Random& random)
{
	const bool whole = random.below(2) == 0;
	const float height = whole ? 1.0F : static_cast<float>(1U + random.below(128)) / 128.0F;
	return {height, whole ? 1.0F : height * static_cast<float>(1U + random.below(8)) / 8.0F};
}

void runWildVolume(Case& one)
{
	const std::vector<glm::vec3> corners = wildCorners(one);
	const glm::vec3 normal(hardDirection(one.random));
	const glm::vec3 front(hardDirection(one.random));
	const auto alpha = static_cast<float>(between(one.random, 0.0, 1.0));
	const auto reach = static_cast<float>(anySize(one.random));
	const glm::vec2 share = hardShare(one.random);
	const float two_sided = one.random.below(2) == 0 ? 0.0F : 1.0F;
	notePolygon(one, corners, normal);
	one.note("front", front);
	one.note("reach", static_cast<double>(reach));
	volume_kernels::Kernels kernels;
	kernels.corners = corners;
	const auto count = static_cast<int>(corners.size());
	const float bias = static_cast<float>(kVolumeBias) * reach;
	one.result("volume", static_cast<double>(kernels.nookVolume(count, normal, front, alpha, two_sided, reach, share, bias)), 0.0,
			   static_cast<double>(alpha));
	one.result("form factor", static_cast<double>(kernels.nookFormFactor(count, normal, -1.0F)), 0.0, 1.0);
	const float lift = kernels.nookLift(kernels.nookHeight(front), two_sided, bias, glm::dot(normal, front));
	one.result("lift", static_cast<double>(lift), -2.02 * static_cast<double>(bias), 2.02 * static_cast<double>(bias));
}

// A planar polygon around a receiver, its unit normal, how far it reaches, and at which shares of that its volume ends.
struct PlacedPolygon
{
	HardPolygon hard;
	glm::vec3 front;
	float reach;
	glm::vec2 share;
};

PlacedPolygon placedPolygon(Case& one)
{
	PlacedPolygon placed{hardPolygon(one.random, static_cast<int>(one.index() % kHardKinds)), {}, 1.0F, hardShare(one.random)};
	const std::vector<glm::vec3>& corners = placed.hard.corners;
	glm::dvec3 sum(0.0);
	for (std::size_t i = 1; i + 1 < corners.size(); ++i)
	{
		sum += glm::cross(glm::dvec3(corners[i]) - glm::dvec3(corners[0]), glm::dvec3(corners[i + 1]) - glm::dvec3(corners[0]));
	}
	const double length = glm::length(sum);
	placed.front = glm::vec3(length > 0.0 ? sum / length : glm::dvec3(0, 0, 1));
	placed.reach = static_cast<float>(reachOfCorners(corners) * octaves(one.random, -7.0, 3.0));
	notePolygon(one, corners, placed.hard.normal);
	one.note("front", placed.front);
	one.note("reach", static_cast<double>(placed.reach));
	one.note("share", placed.share);
	return placed;
}

// By how much 32 bits may be off in a share of the reach: of corners as far as it, and of further ones as much more.
double unitOf(const PlacedPolygon& placed)
{
	return 1.0 + reachOfCorners(placed.hard.corners) / static_cast<double>(placed.reach);
}

// Eq. 5 as it is written: distances from the lines through the edges, within the polygon's plane; 0 where one of them is beyond the
// share of the reach. None where rounding decides that.
std::optional<long double> falloffTwin(const PlacedPolygon& placed, long double height)
{
	const std::vector<glm::vec3>& corners = placed.hard.corners;
	const WideVector n = wideOf(placed.front);
	const auto share = static_cast<long double>(placed.share.y);
	const auto factor = [&placed](long double x)
	{
		return std::clamp(1.0L - x / static_cast<long double>(placed.reach), 0.0L, 1.0L);
	};
	long double g = factor(height);
	bool unsure = false;
	for (std::size_t i = 0; i < corners.size(); ++i)
	{
		const WideVector a = wideOf(corners[i]);
		const WideVector b = wideOf(corners[(i + 1) % corners.size()]);
		const WideVector inward = crossOf(n, WideVector{b[0] - a[0], b[1] - a[1], b[2] - a[2]});
		const long double length = std::sqrt(dotOf(inward, inward));
		if (length > 0.0L)
		{
			const long double side = factor(dotOf(a, inward) / length);
			unsure = unsure || (share < 1.0L && std::fabs(side - (1.0L - share)) < 4e-7L * unitOf(placed));
			g = side < 1.0L - share ? 0.0L : g * side;
		}
	}
	return unsure ? std::nullopt : std::optional(g);
}

void runFalloff(Case& one)
{
	const PlacedPolygon placed = placedPolygon(one);
	const std::vector<glm::vec3>& corners = placed.hard.corners;
	volume_kernels::Kernels kernels;
	kernels.corners = corners;
	const float height = std::fabs(kernels.nookHeight(placed.front));
	const auto found = static_cast<double>(
		kernels.nookFalloff(static_cast<int>(corners.size()), placed.front, height, placed.reach, placed.share.y));
	one.result("falloff", found, 0.0, 1.0);
	if (one.hasTwin())
	{
		const std::optional<long double> expected = falloffTwin(placed, std::fabs(dotOf(wideOf(placed.front), wideOf(corners[0]))));
		if (!expected)
		{
			one.leaveOpen();
			return;
		}
		one.compare("falloff", found, *expected, unitOf(placed));
	}
}

// None where rounding decides whether the volume reaches the receiver.
std::optional<long double> volumeTwin(const PlacedPolygon& placed, float alpha, bool two_sided, float bias)
{
	const std::vector<glm::vec3>& corners = placed.hard.corners;
	const long double height = -dotOf(wideOf(placed.front), wideOf(corners[0]));
	const long double up = two_sided ? std::fabs(height) : height;
	const auto least = static_cast<long double>(bias);
	const long double most = static_cast<long double>(placed.reach) * static_cast<long double>(placed.share.x);
	const long double close = 4e-7L * reachOfCorners(corners);
	if (std::fabs(up - least) < close || std::fabs(up - most) < close)
	{
		return std::nullopt;
	}
	if (up < least || up > most)
	{
		return 0.0L;
	}
	const std::optional<long double> falloff = falloffTwin(placed, up);
	return falloff && *falloff > 0.0L
			   ? static_cast<long double>(alpha) * *falloff * referenceFormFactor<long double>(corners, placed.hard.normal)
			   : falloff;
}

void runVolume(Case& one)
{
	const PlacedPolygon placed = placedPolygon(one);
	const std::vector<glm::vec3>& corners = placed.hard.corners;
	const auto alpha = static_cast<float>(between(one.random, 0.0, 1.0));
	const bool two_sided = one.random.below(2) == 0;
	one.note("alpha", static_cast<double>(alpha));
	one.note("sides", two_sided ? 2 : 1);
	volume_kernels::Kernels kernels;
	kernels.corners = corners;
	const float bias = static_cast<float>(kVolumeBias) * placed.reach;
	const auto found = static_cast<double>(kernels.nookVolume(static_cast<int>(corners.size()), placed.hard.normal, placed.front,
															  alpha, two_sided ? 1.0F : 0.0F, placed.reach, placed.share, bias));
	one.result("volume", found, 0.0, static_cast<double>(alpha));
	if (one.hasTwin())
	{
		const std::optional<long double> expected = volumeTwin(placed, alpha, two_sided, bias);
		if (!expected)
		{
			one.leaveOpen();
			return;
		}
		one.compare("volume", found, *expected, unitOf(placed));
	}
}

constexpr std::array kVolumeKernels{
	StressKernel{"form-factor", "volume", "the clipped polygon's eq. 4 in 80 bits", "share of the hemisphere", 2e-6, 300, 1,
				 runFormFactor},
	StressKernel{"falloff", "volume", "eq. 5 in 80 bits", "falloff, for corners as far as the reach", 8e-7, 300, 1, runFalloff},
	StressKernel{"volume", "volume", "eqs. 4 and 5 in 80 bits", "occlusion, for corners as far as the reach", 8e-7, 300, 1,
				 runVolume},
	StressKernel{"volume-wild", "volume", "its range alone: corners that make no polygon", "none", 0.0, 300, 1, runWildVolume},
};

} // namespace

std::span<const StressKernel> volumeKernels()
{
	return kVolumeKernels;
}

} // namespace nook::stress
