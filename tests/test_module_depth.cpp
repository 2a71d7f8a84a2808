// SPDX-License-Identifier: GPL-3.0-or-later
// Emitted modules over textures as engines have them: device depth of 16, 24 and 32 bits of any projection, linear half floats,
// normals of 8, 10 and 16 bits, rectangles of a texture.
#include "emit_samples.h"
#include "small_formats.h"

#include "emit/module.h"
#include "shade/gl_context.h"
#include "shade/shade.h"

#include "nook_vo9.h"

#include <catch2/catch.hpp>
#include <epoxy/gl.h>

#include <cstring>

using namespace nook;
using namespace nook::test;

namespace
{

constexpr int kModuleWidth = 160;
constexpr int kModuleHeight = 90;
constexpr double kRadius = 0.5;

struct GlStored
{
	unsigned stored;
	unsigned channels; // of the values that are given
};

// A texture of another format, into which OpenGL itself rounds.
void store(const GlTexture& texture, const GlStored& format, const float* values)
{
	glBindTexture(GL_TEXTURE_2D, texture.name());
	glTexImage2D(GL_TEXTURE_2D, 0, static_cast<int>(format.stored), texture.shape().width, texture.shape().height, 0,
				 format.channels, GL_FLOAT, values);
	REQUIRE(glGetError() == GL_NO_ERROR);
}

// A depth buffer. Whole numbers of 16 bits are ours: Mesa cuts floats off instead of rounding them.
void storeDepth(const GlTexture& texture, int bits, const std::vector<float>& devices)
{
	if (bits != 16)
	{
		const unsigned stored = bits == 24 ? GL_DEPTH_COMPONENT24 : GL_DEPTH_COMPONENT32F;
		store(texture, {stored, GL_DEPTH_COMPONENT}, devices.data());
		return;
	}
	std::vector<std::uint16_t> steps;
	for (const float device : devices)
	{
		steps.push_back(static_cast<std::uint16_t>(static_cast<double>(device) * 65535.0 + 0.5));
	}
	glBindTexture(GL_TEXTURE_2D, texture.name());
	glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT16, texture.shape().width, texture.shape().height, 0, GL_DEPTH_COMPONENT,
				 GL_UNSIGNED_SHORT, steps.data());
	REQUIRE(glGetError() == GL_NO_ERROR);
}

ModuleSettings moduleSettings(bool device)
{
	ModuleSettings settings;
	settings.methods = {{ShadeMethod::vo_line, {scatteredPattern(Domain::disk, 9)}}};
	settings.main = true;
	settings.device_depth = device;
	return settings;
}

// The module as a fragment shader, with what an engine defines before it.
std::string shaderOf(const ModuleSettings& settings, const std::string& before = "")
{
	const std::string text = moduleGlsl(settings, contextOf("nook emit"));
	const std::size_t line = text.find('\n') + 1;
	return text.substr(0, line) + before + text.substr(line);
}

nook_settings settingsOf(const GBuffer& gbuffer)
{
	nook_settings settings;
	settings.width = gbuffer.width_px;
	settings.height = gbuffer.height_px;
	settings.first_row_ndc_y = 1; // our rows begin at the top
	settings.radius = kRadius;
	return settings;
}

nook_block blockFor(const glm::dmat4& projection, const nook_settings& settings)
{
	double numbers[16];
	std::memcpy(numbers, &projection, sizeof numbers);
	nook_block block{};
	REQUIRE(nook_fill(block, numbers, settings));
	return block;
}

std::vector<glm::vec4> fourOf(const std::vector<glm::vec3>& normals, bool from_zero)
{
	std::vector<glm::vec4> four;
	for (const glm::vec3& normal : normals)
	{
		four.emplace_back(from_zero ? 0.5F * normal + 0.5F : normal, 0.0F);
	}
	return four;
}

std::vector<float> drawn(GlPass& pass, const GlTexture& depths, const GlTexture& normals, const nook_block& block)
{
	const GlTexture target(depths.shape().width, depths.shape().height, 1, nullptr);
	pass.bind("nook_depths", depths);
	pass.bind("nook_normals", normals);
	pass.bindBlock("nook_block", std::as_bytes(std::span(&block, 1)));
	pass.draw(target);
	return readScalar(target);
}

std::vector<float> computed(const GBuffer& gbuffer, const DepthFormat& format)
{
	ShadeSettings settings;
	settings.radius_m = kRadius;
	settings.depth = format;
	return shadeOnCpu(gbuffer, samplesOf(ShadeMethod::vo_line, {scatteredPattern(Domain::disk, 9)}), settings, {2, {}}).visibility;
}

} // namespace

TEST_CASE("module: it reads the depth buffers of any projection and format", "[emit]")
{
	const Level level = builtinLevel("courtyard");
	const Tracer tracer(level, {});
	const View view = viewOf(level.cameras[0], kModuleWidth, kModuleHeight);
	const glm::dmat4 flat = projectionOf(lensOf(0.0), static_cast<double>(kModuleWidth) / kModuleHeight);
	const GlContext context;
	GlPass pass(shaderOf(moduleSettings(true)));
	for (const Convention& convention : conventions(view.projection, flat, kModuleWidth, kModuleHeight))
	{
		const GBuffer gbuffer = castGBuffer(tracer, {view.camera_from_world, convention.projection}, kModuleWidth, kModuleHeight,
											NormalKind::geometric, {2, {}});
		const GlTexture normals(kModuleWidth, kModuleHeight, 4, &fourOf(gbuffer.normals, false)[0].x);
		for (const int bits : {16, 24, 32})
		{
			const GlTexture depths(kModuleWidth, kModuleHeight, 1, nullptr);
			storeDepth(depths, bits, devicesOf(gbuffer, convention, bits));
			nook_settings settings = settingsOf(gbuffer);
			settings.device_depth = true;
			settings.zero_to_one = convention.clip == ClipRange::zero_to_one;
			settings.depth_bits = bits;
			const std::vector<float> found = drawn(pass, depths, normals, blockFor(convention.projection, settings));
			const std::vector<float> expected = computed(through(gbuffer, convention, bits), formatOf(convention, bits));
			const Difference difference = differenceOf(found, expected);
			CAPTURE(convention.name, bits, difference.mean, difference.worst, context.renderer());
			CHECK(difference.mean <= 1e-4);
			CHECK(difference.beyond <= 1e-3);
		}
	}
}

TEST_CASE("module: linear half floats, and normals of 8, 10 and 16 bits", "[emit]")
{
	const GBuffer gbuffer = builtinView("courtyard", kModuleWidth, kModuleHeight);
	const std::vector<float> truth = computed(gbuffer, {});
	const GlContext context;
	const GlTexture plain(kModuleWidth, kModuleHeight, 4, &fourOf(gbuffer.normals, false)[0].x);
	const GlTexture halves(kModuleWidth, kModuleHeight, 1, nullptr);
	std::vector<float> depths = gbuffer.depth;
	store(halves, {GL_R16F, GL_RED}, depths.data()); // sky is infinite there
	GlPass linear(shaderOf(moduleSettings(false)));
	nook_settings settings = settingsOf(gbuffer);
	settings.depth_bits = 16;
	const Difference half = differenceOf(drawn(linear, halves, plain, blockFor(gbuffer.view.projection, settings)), truth);
	CAPTURE(half.mean, half.beyond, half.worst);
	CHECK(half.mean <= 0.02);
	CHECK(half.signed_mean >= 0.0); // and nothing occludes itself
	settings.depth_bits = 32;
	const GlTexture exact(kModuleWidth, kModuleHeight, 1, finiteDepths(gbuffer).data());
	struct Stored
	{
		unsigned format;
		bool from_zero;
		double mean;
	};
	for (const Stored& stored : {Stored{GL_RGBA8, true, 1.5e-3}, Stored{GL_RGB10_A2, true, 4e-4}, Stored{GL_RGBA16, true, 1e-4},
								 Stored{GL_RGBA8_SNORM, false, 1.5e-3}, Stored{GL_RGBA16_SNORM, false, 1e-4}})
	{
		GlPass pass(shaderOf(moduleSettings(false), stored.from_zero
														? "uniform sampler2D nook_normals;\n#define NOOK_NORMAL(pixel) "
														  "normalize(texelFetch(nook_normals, pixel, 0).xyz * 2.0 - 1.0)\n"
														: "uniform sampler2D nook_normals;\n#define NOOK_NORMAL(pixel) "
														  "normalize(texelFetch(nook_normals, pixel, 0).xyz)\n"));
		const GlTexture normals(kModuleWidth, kModuleHeight, 4, nullptr);
		store(normals, {stored.format, GL_RGBA}, &fourOf(gbuffer.normals, stored.from_zero)[0].x);
		const Difference difference = differenceOf(drawn(pass, exact, normals, blockFor(gbuffer.view.projection, settings)), truth);
		CAPTURE(stored.format, difference.mean, difference.beyond, difference.worst);
		CHECK(difference.mean <= stored.mean);
	}
}

TEST_CASE("module: a rectangle of a texture, and a guard band around it", "[emit]")
{
	const GBuffer gbuffer = builtinView("courtyard", 64, 48);
	const GlContext context;
	GlPass pass(shaderOf(moduleSettings(false)));
	const GlTexture depths(64, 48, 1, finiteDepths(gbuffer).data());
	const GlTexture normals(64, 48, 4, &fourOf(gbuffer.normals, false)[0].x);
	nook_settings settings = settingsOf(gbuffer);
	const std::vector<float> alone = drawn(pass, depths, normals, blockFor(gbuffer.view.projection, settings));
	// The same in a larger texture, with walls in front of the camera all around.
	const int x0 = 32;
	const int y0 = 16;
	std::vector<float> around(128U * 80U, 0.01F);
	std::vector<glm::vec4> around_normals(128U * 80U, glm::vec4(0.0F, 0.0F, 1.0F, 0.0F));
	for (int y = 0; y < 48; ++y)
	{
		for (int x = 0; x < 64; ++x)
		{
			const auto from = static_cast<std::size_t>(y * 64 + x);
			const auto to = static_cast<std::size_t>((y0 + y) * 128 + x0 + x);
			around[to] = finiteDepths(gbuffer)[from];
			around_normals[to] = glm::vec4(gbuffer.normals[from], 0.0F);
		}
	}
	const GlTexture larger(128, 80, 1, around.data());
	const GlTexture larger_normals(128, 80, 4, &around_normals[0].x);
	settings.x = x0;
	settings.y = y0;
	const auto differing = [&](int guard)
	{
		settings.guard = guard;
		const std::vector<float> found = drawn(pass, larger, larger_normals, blockFor(gbuffer.view.projection, settings));
		std::size_t count = 0;
		for (int y = 0; y < 48; ++y)
		{
			for (int x = 0; x < 64; ++x)
			{
				count += found[static_cast<std::size_t>((y0 + y) * 128 + x0 + x)] == alone[static_cast<std::size_t>(y * 64 + x)]
							 ? 0U
							 : 1U;
			}
		}
		return count;
	};
	CHECK(differing(0) == 0);
	CHECK(differing(8) > 100); // now the walls are neighbours
}

TEST_CASE("module: what a block cannot be filled from is refused", "[emit]")
{
	const GBuffer gbuffer = builtinView("cornell", 8, 8);
	const auto fills = [&](const glm::dmat4& projection, auto change)
	{
		nook_settings settings = settingsOf(gbuffer);
		settings.device_depth = true;
		change(settings);
		double numbers[16];
		std::memcpy(numbers, &projection, sizeof numbers);
		nook_block block{};
		return nook_fill(block, numbers, settings);
	};
	const auto as_it_is = [](nook_settings&) {
	};
	const glm::dmat4 good = gbuffer.view.projection;
	CHECK(fills(good, as_it_is));
	CHECK(fills(good,
				[](nook_settings& s)
				{
					s.depth_bits = 16;
					s.guard = 3;
					s.normal_bits = 10;
				}));
	CHECK_FALSE(fills(good, [](nook_settings& s) { s.depth_bits = 8; }));
	CHECK_FALSE(fills(good, [](nook_settings& s) { s.normal_bits = 4; }));
	CHECK_FALSE(fills(good, [](nook_settings& s) { s.guard = -1; }));
	CHECK_FALSE(fills(good, [](nook_settings& s) { s.radius = 0.0; }));
	CHECK_FALSE(fills(good, [](nook_settings& s) { s.most_pixels = -1.0; }));
	glm::dmat4 flat = good;
	flat[2][2] = 0.0;
	flat[3][2] = 0.0;
	CHECK_FALSE(fills(flat, as_it_is));
	CHECK(fills(flat, [](nook_settings& s) { s.device_depth = false; }));
	flat = good;
	flat[0][2] = 0.1;
	CHECK_FALSE(fills(flat, as_it_is));
}
