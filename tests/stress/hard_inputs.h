// SPDX-License-Identifier: GPL-3.0-or-later
// Random inputs that are hard for 32 bits: numbers, directions, cameras and small pictures with samples and settings.
#pragma once

#include "core/math.h"
#include "core/random.h"
#include "methods/block.h"
#include "methods/kernels.h"

#include <glm/mat4x4.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace nook::stress
{

inline constexpr double kDecades = 26.575424759098897; // log2(10⁸)

// Mixes two numbers into one (the finaliser of D. Stafford's "Mix13", as in splitmix64).
inline uint64_t mixed(uint64_t a, uint64_t b)
{
	uint64_t z = a + 0x9e3779b97f4a7c15ULL * (b + 1);
	z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
	z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
	return z ^ (z >> 31U);
}

// From 2^least to 2^most, equally likely in each octave: (1 + f) 2^e, the same on every machine.
inline double octaves(Random& random, double least, double most)
{
	const double exponent = least + (most - least) * random.uniform();
	const double whole = std::floor(exponent);
	return std::ldexp(1.0 + (exponent - whole), static_cast<int>(whole));
}

// 10^U(−8, 8).
inline double anySize(Random& random)
{
	return octaves(random, -kDecades, kDecades);
}

inline double between(Random& random, double least, double most)
{
	return least + (most - least) * random.uniform();
}

inline double signOf(Random& random)
{
	return random.below(2) == 0 ? 1.0 : -1.0;
}

// A coordinate up to `size`; sometimes ±0, a denormal, a power of two or exactly the size.
inline float hardFloat(Random& random, double size)
{
	switch (random.below(16))
	{
	case 0: return random.below(2) == 0 ? 0.0F : -0.0F;
	case 1: return std::bit_cast<float>(1U + random.below(0x7fffffU)) * static_cast<float>(signOf(random));
	case 2: return static_cast<float>(std::ldexp(signOf(random), static_cast<int>(std::floor(std::log2(size)))));
	case 3: return static_cast<float>(signOf(random) * size);
	case 4: return static_cast<float>(signOf(random) * size * octaves(random, -kDecades, 0.0));
	default: return static_cast<float>(between(random, -size, size));
	}
}

inline glm::dvec3 randomDirection(Random& random)
{
	glm::dvec3 v;
	do
	{
		v = 2.0 * glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 1.0;
	} while (glm::dot(v, v) > 1.0 || glm::dot(v, v) < 1e-4);
	return glm::normalize(v);
}

// A unit direction; one in four along an axis, or almost.
inline glm::dvec3 hardDirection(Random& random)
{
	glm::dvec3 v = randomDirection(random);
	if (random.below(4) == 0)
	{
		const double off = random.below(2) == 0 ? 0.0 : octaves(random, -kDecades, -3.0);
		const auto axis = static_cast<int>(random.below(3));
		const double sign = signOf(random);
		v *= off;
		v[axis] = sign;
	}
	return glm::normalize(v);
}

// Perspective or parallel, off centre, depth reversed or not, the far plane at up to 10⁷ times the near one or at infinity.
struct HardCamera
{
	glm::dmat4 projection{0.0};
	DepthFormat format;
	double near_m = 1.0;
	double far_m = 2.0; // the greatest depth, also where the far plane is at infinity
	bool parallel = false;
};

inline HardCamera hardCamera(Random& random)
{
	HardCamera camera;
	camera.near_m = anySize(random);
	camera.far_m = camera.near_m * (1.0 + octaves(random, -7.0, 23.25)); // to 10⁷
	camera.parallel = random.below(4) == 0;
	const bool reversed = random.below(2) == 0;
	const bool infinite = !camera.parallel && random.below(4) == 0;
	camera.format.device = true;
	camera.format.clip = random.below(2) == 0 ? ClipRange::zero_to_one : ClipRange::minus_one_to_one;
	camera.format.bits = random.below(3) == 0 ? 16 : random.below(2) == 0 ? 24 : 32;
	const double least = camera.format.clip == ClipRange::zero_to_one ? 0.0 : -1.0;
	const double front = reversed ? 1.0 : least; // NDC z at the near plane
	const double back = reversed ? least : 1.0;  // at the far plane
	const double n = camera.near_m;
	const double f = camera.far_m;
	glm::dmat4& p = camera.projection;
	if (camera.parallel)
	{
		p[2][2] = (front - back) / (f - n);
		p[3][2] = front + p[2][2] * n;
		p[3][3] = 1.0;
	}
	else
	{
		p[3][2] = (front - back) / (1.0 / n - (infinite ? 0.0 : 1.0 / f));
		p[2][2] = p[3][2] / n - front;
		p[2][3] = -1.0;
	}
	const double width = 1.0 + random.below(random.below(4) == 0 ? 8 : 8192);
	const double height = 1.0 + random.below(random.below(4) == 0 ? 8 : 4320);
	const double zoom = octaves(random, -3.0, 6.0); // half a field of view of 83° to 1°
	p[0][0] = camera.parallel ? 1.0 / (n * octaves(random, -3.0, 10.0)) : zoom;
	p[1][1] = p[0][0] * width / height * (random.below(4) == 0 ? between(random, 0.5, 2.0) : 1.0);
	const int other = camera.parallel ? 3 : 2; // off centre, or jittered
	if (random.below(2) == 0)
	{
		p[other][0] = between(random, -1.0, 1.0);
		p[other][1] = between(random, -1.0, 1.0);
	}
	return camera;
}

// Between near and far plane, often close to one of them.
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

inline constexpr int kPictureWidth = 16;
inline constexpr int kPictureHeight = 8;
inline constexpr uint64_t kPictureCases = kPictureWidth * kPictureHeight; // cases that share a picture, one per pixel

enum class SampleKind
{
	line,      // x, y, half length, weight
	area,      // x, y, log2 of a side, weight
	ball,      // x, y, z, weight
	disk,      // x, y, -, weight
	direction, // cosine, sine, share of a step, weight
	slice,     // the same numbers, for GTAO and bit masks
	spiral,    // x, y, distance, weight
};

// A small picture with samples and settings. It must not move: `kernels` refers to the other members.
struct HardPicture
{
	HardCamera camera;
	std::vector<float> depths;
	std::vector<glm::vec3> normals;
	std::vector<glm::vec4> samples;
	PicturePlane visibility;          // in [0, 1]
	PicturePlane packed;              // empty until a filter fills it
	std::vector<PicturePlane> levels; // empty until a method fills them
	shade_kernels::Kernels kernels;
	float largest = 0.0F; // greatest depth of a surface
};

// A plane, noise, a step, a plane with noise, a constant, or near and far plane; with holes of sky. Returns the plane's normal.
inline glm::dvec3 makeDepths(HardPicture& picture, Random& random)
{
	const HardCamera& camera = picture.camera;
	const double middle = hardDepth(random, camera);
	const double other = hardDepth(random, camera);
	const uint32_t kind = random.below(6);
	const double slope = octaves(random, -10.0, 3.0);
	const SinCos to = sinCosOf(between(random, 0.0, 2.0 * kPi));
	// On the plane, 1 / depth (parallel projections: depth) is linear in x (right) and y (down).
	const glm::dvec2 slopes(slope * to.cos, slope * to.sin);
	const double noise = octaves(random, -24.0, 0.0);
	const bool holes = random.below(3) == 0;
	picture.depths.resize(kPictureCases);
	picture.largest = 0.0F;
	for (int i = 0; i < static_cast<int>(kPictureCases); ++i)
	{
		const double x = (i % kPictureWidth + 0.5) / kPictureWidth * 2.0 - 1.0;
		const double y = (i / kPictureWidth + 0.5) / kPictureHeight * 2.0 - 1.0;
		const double rise = 1.0 + slopes.x * x + slopes.y * y;
		double depth = camera.parallel ? middle * rise : middle / std::max(rise, 1e-12);
		depth = std::clamp(depth, camera.near_m, camera.far_m);
		switch (kind)
		{
		case 0: break;
		case 1: depth = hardDepth(random, camera); break;
		case 2: depth = x * to.cos + y * to.sin > 0.0 ? middle : other; break;
		case 3: depth = std::clamp(depth * (1.0 + noise * between(random, -1.0, 1.0)), camera.near_m, camera.far_m); break;
		case 4: depth = middle; break;
		default: depth = random.below(2) == 0 ? camera.near_m : camera.far_m; break;
		}
		float& stored = picture.depths[static_cast<std::size_t>(i)];
		stored = static_cast<float>(depth);
		picture.largest = std::max(picture.largest, stored);
		if (holes && random.below(8) == 0)
		{
			stored = NOOK_SKY;
		}
	}
	// With w x = P₀₀ X + P₂₀ Z + P₃₀ and −w y = P₁₁ Y + P₂₁ Z + P₃₁ the plane is linear in X, Y, Z.
	const glm::dmat4& p = camera.projection;
	const double along_x = slopes.x * p[0][0];
	const double along_y = slopes.y * p[1][1];
	return glm::normalize(camera.parallel ? glm::dvec3(middle * along_x, -middle * along_y, 1.0)
										  : glm::dvec3(-along_x, along_y, 1.0 - slopes.x * p[2][0] + slopes.y * p[2][1]));
}

// The plane's normals, one random normal, or all random.
inline void makeNormals(HardPicture& picture, Random& random, const glm::dvec3& of_plane)
{
	const uint32_t kind = random.below(3);
	picture.normals.assign(kPictureCases, glm::vec3(of_plane));
	if (kind == 0)
	{
		return;
	}
	const bool one_normal = kind == 1;
	glm::dvec3 n = hardDirection(random);
	for (glm::vec3& stored : picture.normals)
	{
		n = one_normal ? n : hardDirection(random);
		n.z = random.below(16) == 0 ? n.z : std::fabs(n.z); // a few turn away
		stored = glm::vec3(n);
	}
}

inline glm::dvec4 hardSample(Random& random, SampleKind kind, int i, int count)
{
	const SinCos angle = sinCosOf(between(random, 0.0, 2.0 * kPi));
	const uint32_t special = random.below(16);
	const double r = special == 0 ? 0.0 : special == 1 ? 1.0 : std::sqrt(random.uniform());
	const double x = special == 1 ? 1.0 : r * angle.cos;
	const double y = special == 1 ? 0.0 : r * angle.sin;
	const double rest = std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
	switch (kind)
	{
	case SampleKind::line: return {x, y, rest, random.uniform()};
	case SampleKind::area: return {x, y, between(random, -6.0, 1.0), random.uniform()};
	case SampleKind::ball: return {x, y, rest * between(random, -1.0, 1.0), random.uniform()};
	case SampleKind::disk: return {x, y, 0.0, random.uniform()};
	case SampleKind::direction:
	case SampleKind::slice: return {angle.cos, angle.sin, random.uniform(), 1.0};
	case SampleKind::spiral: break;
	}
	const double distance = (i + 0.5) / count;
	return {distance * angle.cos, distance * angle.sin, distance, 1.0};
}

// Weights sum to 1; in pairs, sample 2i + 1 is opposite to sample 2i.
inline void makeSamples(HardPicture& picture, Random& random, SampleKind kind)
{
	const int count = 1 + static_cast<int>(random.below(24));
	picture.samples.clear();
	std::vector<glm::dvec4> samples;
	const bool pairs = kind == SampleKind::line || kind == SampleKind::area;
	double sum = 0.0;
	for (int i = 0; i < count; ++i)
	{
		const bool opposite = pairs && i % 2 == 1;
		samples.push_back(opposite ? samples.back() * glm::dvec4(-1.0, -1.0, 1.0, 1.0) : hardSample(random, kind, i, count));
		sum += samples.back().w;
	}
	for (glm::dvec4& sample : samples)
	{
		sample.w = sum > 0.0 ? sample.w / sum : 1.0 / count;
		picture.samples.emplace_back(sample);
	}
}

inline float narrow(double value)
{
	return static_cast<float>(value);
}

inline void makeRival(ShadeBlock& block, Random& random, SampleKind kind)
{
	switch (kind)
	{
	case SampleKind::direction:
	{
		const SinCos bias = sinCosOf(between(random, 0.0, 89.0) * kPi / 180.0);
		block.hbao_sine = narrow(bias.sin);
		block.hbao_cosine = narrow(bias.cos);
		break;
	}
	case SampleKind::slice:
		block.gtao_falloff = narrow(random.below(4) == 0 ? 0.0 : between(random, 0.0, 0.99));
		block.gtao_thickness = narrow(random.below(4) == 0 ? 0.0 : random.uniform());
		block.bitmask_thickness = narrow(octaves(random, -9.0, 9.0));
		block.bitmask_round = random.below(3) == 0 ? 0.0F : random.below(2) == 0 ? 0.5F : 0.999F;
		break;
	case SampleKind::spiral:
		block.sao_intensity = narrow(octaves(random, -4.0, 4.0));
		block.sao_bias = narrow(random.uniform() * 0.1);
		block.sao_epsilon = narrow(octaves(random, -39.0, 10.0));
		break;
	default: block.crytek_range = narrow(octaves(random, -9.0, 10.0)); break;
	}
}

// A radius of 10⁻⁸ to 10⁸ metres, or of 2⁻⁴ to 2⁷ pixels, and every feature.
inline void makeSettings(HardPicture& picture, Random& random, SampleKind kind)
{
	shade_kernels::Kernels& kernels = picture.kernels;
	ShadeBlock& block = kernels.nook;
	const auto count = static_cast<int>(picture.samples.size());
	const glm::vec2 scale = kernels.nookScale(picture.depths[random.below(kPictureCases)]);
	const double pixels = static_cast<double>(std::max(std::fabs(scale.x), std::fabs(scale.y)));
	block.radius = narrow(random.below(4) == 0 || !(pixels > 0.0) ? anySize(random) : octaves(random, -4.0, 7.0) / pixels);
	block.thickness = random.below(4) == 0 ? narrow(octaves(random, -10.0, 10.0)) * block.radius : 0.0F;
	block.second_radius = block.radius * narrow(octaves(random, -6.0, 6.0));
	const double most = random.below(2) == 0 ? kPictureHeight : octaves(random, 0.0, 8.0);
	block.first_band_px = 16.0F;
	block.second_band_px = 48.0F;
	block.most_px = narrow(most);
	block.least_px = random.below(2) == 0 ? 0.0F : narrow(most * octaves(random, -8.0, 0.0));
	block.normal_error = random.below(2) == 0 ? 0.0F : narrow(normalError(8));
	block.sigma = narrow(octaves(random, -4.0, 4.0));
	block.contrast = narrow(octaves(random, -2.0, 3.0));
	block.beta = narrow(random.below(2) == 0 ? 0.0 : 1e-4);
	block.epsilon = narrow(octaves(random, -39.0, 10.0)); // 1e-12 to 1000
	block.samples = count;
	block.window = 1;
	block.use_normal = random.below(3) != 0 ? 1 : 0;
	block.cut = random.below(2) == 0 ? 1 : 0;
	block.paired = (kind == SampleKind::line || kind == SampleKind::area) && random.below(2) == 0 ? 1 : 0;
	block.radii = static_cast<int>(random.below(3));
	block.quadratic = random.below(2) == 0 ? 1 : 0;
	block.thick = block.thickness > 0.0F ? 1 : 0;
	block.bands = 1 + static_cast<int>(random.below(3));
	block.first_band = (count + block.bands - 1) / block.bands;
	block.two_bands = (2 * count + block.bands - 1) / block.bands;
	block.cell = 1;
	block.taps = 1 + static_cast<int>(random.below(6));
	block.steps = 1 + static_cast<int>(random.below(16));
	makeRival(block, random, kind);
	block.slice_thickness = narrow(octaves(random, -6.0, 6.0));
	block.third = block.radii > 0 ? static_cast<int>(random.below(2)) : 0;
	block.third_radius = narrow(octaves(random, -3.0, 3.0)) * block.radius;
	block.second_thickness = narrow(octaves(random, -6.0, 6.0)) * block.radius;
	block.third_thickness = narrow(octaves(random, -6.0, 6.0)) * block.radius;
	block.shaped = static_cast<int>(random.below(2));
	block.strength = narrow(octaves(random, -2.0, 2.0));
	block.power = narrow(octaves(random, -1.0, 1.0));
}

inline void makePicture(HardPicture& picture, uint64_t key, SampleKind kind)
{
	Random random(key, 17);
	picture.camera = hardCamera(random);
	makeNormals(picture, random, makeDepths(picture, random));
	makeSamples(picture, random, kind);
	picture.visibility.width = kPictureWidth;
	picture.visibility.height = kPictureHeight;
	picture.visibility.values.resize(kPictureCases);
	for (float& value : picture.visibility.values)
	{
		value = static_cast<float>(random.below(4) == 0 ? static_cast<double>(random.below(2)) : random.uniform());
	}
	picture.levels.clear();
	shade_kernels::Kernels& kernels = picture.kernels;
	kernels = {};
	fillCamera(kernels.nook, picture.camera.projection, kPictureWidth, kPictureHeight);
	fillDepth(kernels.nook, picture.camera.projection, picture.camera.format);
	kernels.depths = picture.depths;
	kernels.normals = picture.normals;
	kernels.samples = picture.samples;
	kernels.cells = &picture.visibility;
	makeSettings(picture, random, kind);
}

} // namespace nook::stress
