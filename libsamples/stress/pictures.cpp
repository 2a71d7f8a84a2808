// SPDX-License-Identifier: GPL-3.0-or-later
#include "stress/pictures.h"

#include "core/math.h"

#include <algorithm>
#include <cmath>

namespace nook::stress
{
namespace
{

// A plane through a point of the picture's middle: 1 / depth (parallel: depth) is linear in the picture. x to the right, y down,
// from −1 to 1.
struct PicturedPlane
{
	double middle;
	double slope_x;
	double slope_y;

	// Where it leaves what is between near and far plane it ends there.
	double depthAt(const HardCamera& camera, double x, double y) const
	{
		const double rise = 1.0 + slope_x * x + slope_y * y;
		const double depth = camera.parallel ? middle * rise : middle / std::max(rise, 1e-12);
		return std::clamp(depth, camera.near_m, camera.far_m);
	}
	// With w x = P₀₀ X + P₂₀ Z + P₃₀ and −w y = P₁₁ Y + P₂₁ Z + P₃₁ the plane is linear in X, Y, Z.
	glm::dvec3 normal(const HardCamera& camera) const
	{
		const glm::dmat4& p = camera.projection;
		const double x = slope_x * p[0][0];
		const double y = slope_y * p[1][1];
		return glm::normalize(camera.parallel ? glm::dvec3(middle * x, -middle * y, 1.0)
											  : glm::dvec3(-x, y, 1.0 - slope_x * p[2][0] + slope_y * p[2][1]));
	}
};

// Returns the normal of the plane that most of the depths begin with.
glm::dvec3 makeDepths(HardPicture& picture, Random& random)
{
	const HardCamera& camera = picture.camera;
	const double middle = hardDepth(random, camera);
	const double other = hardDepth(random, camera);
	const uint32_t kind = random.below(6);
	const double slope = octaves(random, -10.0, 3.0);
	const double turn = between(random, 0.0, 2.0 * kPi);
	const SinCos to = sinCosOf(turn);
	const PicturedPlane plane{middle, slope * to.cos, slope * to.sin};
	const double noise = octaves(random, -24.0, 0.0);
	const bool holes = random.below(3) == 0;
	picture.depths.resize(kPictureCases);
	picture.largest = 0.0F;
	for (int i = 0; i < static_cast<int>(kPictureCases); ++i)
	{
		const double x = (i % kPictureWidth + 0.5) / kPictureWidth * 2.0 - 1.0;
		const double y = (i / kPictureWidth + 0.5) / kPictureHeight * 2.0 - 1.0;
		double depth = plane.depthAt(camera, x, y);
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
	return plane.normal(camera);
}

// Those of the plane, one at random, or any.
void makeNormals(HardPicture& picture, Random& random, const glm::dvec3& of_plane)
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

glm::dvec4 hardSample(Random& random, SampleKind kind, int i, int count)
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

// Weights sum to 1; with pairs, sample 2i + 1 is opposite to 2i.
void makeSamples(HardPicture& picture, Random& random, SampleKind kind)
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

float narrow(double value)
{
	return static_cast<float>(value);
}

void makeRival(ShadeBlock& block, Random& random, SampleKind kind)
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

void makeSettings(HardPicture& picture, Random& random, SampleKind kind)
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

} // namespace

void makePicture(HardPicture& picture, uint64_t key, SampleKind kind)
{
	Random random(key, 17);
	picture.camera = hardCamera(random);
	picture.camera.width = kPictureWidth;
	picture.camera.height = kPictureHeight;
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
	kernels.nook = blockOf(picture.camera);
	kernels.depths = picture.depths;
	kernels.normals = picture.normals;
	kernels.samples = picture.samples;
	kernels.cells = &picture.visibility;
	makeSettings(picture, random, kind);
}

void compareWide(Case& one, std::string_view name, double found, const std::function<Wide()>& twin)
{
	wide_unsure = false;
	wide_broken = false;
	const Wide expected = twin();
	one.note("error bound", expected.error);
	if (wide_broken)
	{
		one.note("on the way", std::string_view("not a number"));
		one.broken = true;
	}
	if (wide_unsure || !(expected.error <= kMostBound))
	{
		one.note(name, expected.value);
		one.leaveOpen();
		return;
	}
	one.compare(name, found, expected.value);
	one.require("within the error bound", std::fabs(static_cast<long double>(found) - expected.value) <= expected.error);
}

void noteBlock(Case& one, const ShadeBlock& block)
{
#define NOOK_NOTE(type, name, meaning) one.note(#name, block.name);
	NOOK_MODULE_MEMBERS(NOOK_NOTE)
	NOOK_RIVAL_MEMBERS(NOOK_NOTE)
#undef NOOK_NOTE
#define NOOK_NOTE(name, value, meaning) one.note(#name, block.name);
	NOOK_SHADE_CONSTANTS(NOOK_NOTE)
#undef NOOK_NOTE
}

void notePicture(Case& one, const HardPicture& picture, glm::ivec2 pixel)
{
	if (!one.shown())
	{
		return;
	}
	const ShadeBlock& block = picture.kernels.nook;
	one.note("pixel", pixel);
	one.note("depth", static_cast<double>(picture.kernels.nookDepth(pixel)));
	one.note("normal", picture.kernels.nookNormal(pixel));
	noteBlock(one, block);
	for (int y = 0; y < kPictureHeight; ++y)
	{
		std::string row;
		for (int x = 0; x < kPictureWidth; ++x)
		{
			char text[32];
			std::snprintf(text, sizeof text, " %.9g", static_cast<double>(picture.kernels.nookDepth({x, y})));
			row += text;
		}
		one.note("depths, row " + std::to_string(y), row);
	}
	for (const glm::vec4& sample : picture.samples)
	{
		one.note("sample", sample);
	}
}

} // namespace nook::stress
