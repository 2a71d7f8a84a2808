// SPDX-License-Identifier: GPL-3.0-or-later
// Emitted modules with textures as engines have them: device depth of 16, 24 and 32 bits for any projection, linear half floats,
// normals of 8, 10 and 16 bits, rectangles of a texture.
#include "emit_samples.h"
#include "nook_vo9.h"
#include "other_tools.h"
#include "small_formats.h"
#include "testing.h"

#include "emit/module.h"
#include "shade/gl_context.h"
#include "shade/shade.h"

#include <epoxy/gl.h>

namespace
{

constexpr int kModuleWidth = 160;
constexpr int kModuleHeight = 90;
constexpr double kRadius = 0.5;

struct GlStored
{
	unsigned stored;
	unsigned channels; // of the given values
};

// A texture of another format, into which OpenGL rounds.
void store(const GlTexture& texture, const GlStored& format, const float* values)
{
	glBindTexture(GL_TEXTURE_2D, texture.name);
	glTexImage2D(GL_TEXTURE_2D, 0, static_cast<int>(format.stored), texture.shape.width, texture.shape.height, 0, format.channels,
				 GL_FLOAT, values);
	REQUIRE(glGetError() == GL_NO_ERROR);
}

// A depth buffer. 16-bit integers are rounded here, because Mesa truncates floats.
void storeDepth(const GlTexture& texture, int bits, const std::vector<float>& devices)
{
	if (bits != 16)
	{
		const unsigned stored = bits == 24 ? GL_DEPTH_COMPONENT24 : GL_DEPTH_COMPONENT32F;
		store(texture, {stored, GL_DEPTH_COMPONENT}, devices.data());
		return;
	}
	const std::vector<std::uint16_t> steps =
		mapped(devices, [](const float device) { return static_cast<std::uint16_t>(static_cast<double>(device) * 65535.0 + 0.5); });
	glBindTexture(GL_TEXTURE_2D, texture.name);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT16, texture.shape.width, texture.shape.height, 0, GL_DEPTH_COMPONENT,
				 GL_UNSIGNED_SHORT, steps.data());
	REQUIRE(glGetError() == GL_NO_ERROR);
}

ModuleSettings moduleSettings(bool device)
{
	ModuleSettings settings;
	settings.methods = {{ShadeMethod::vo_line, {scatteredPattern(Domain::disk, 9)}}};
	settings.main = ModuleMain::fragment;
	settings.device_depth = device;
	return settings;
}

// The module as a fragment shader, with an engine's definitions before it.
std::string shaderOf(const ModuleSettings& settings, const std::string& before = "")
{
	const std::string text = moduleGlsl(settings, contextOf("nook emit"));
	const std::size_t line = text.find('\n') + 1;
	return text.substr(0, line) + before + text.substr(line);
}

nook_settings settingsOf(const GBuffer& gbuffer)
{
	nook_settings settings{.width = gbuffer.width_px, .height = gbuffer.height_px};
	settings.first_row_ndc_y = 1; // rows start at the top
	settings.radius = kRadius;
	return settings;
}

nook_block blockFor(const glm::dmat4& projection, const nook_settings& settings)
{
	double numbers[16];
	std::memcpy(numbers, &projection, sizeof numbers);
	nook_block block{};
	REQUIRE(nook_fill(block, numbers, settings) == nullptr);
	return block;
}

std::vector<glm::vec4> fourOf(const std::vector<glm::vec3>& normals, bool from_zero)
{
	return mapped(normals, [&](const glm::vec3& normal) { return glm::vec4(from_zero ? 0.5F * normal + 0.5F : normal, 0.0F); });
}

std::vector<float> drawn(GlPass& pass, const GlTexture& depths, const GlTexture& normals, const nook_block& block)
{
	const GlTexture target(depths.shape.width, depths.shape.height, 1, nullptr);
	pass.bind("nook_depths", depths);
	pass.bind("nook_normals", normals);
	pass.bindBlock("nook_block", std::as_bytes(std::span(&block, 1)));
	pass.draw(target);
	return readFloats(target);
}

std::vector<float> computed(const GBuffer& gbuffer, const DepthFormat& format)
{
	ShadeSettings settings;
	settings.radius_m = kRadius;
	settings.depth = format;
	return shadeOnCpu(gbuffer, samplesOf(ShadeMethod::vo_line, {scatteredPattern(Domain::disk, 9)}), settings, {2, {}}).visibility;
}

// The reason why a projection is rejected, for linear depth unless `device`.
std::string faultOf(const glm::dmat4& projection, bool device = false, bool zero_to_one = false)
{
	nook_settings settings{.width = 16, .height = 9, .device_depth = device, .zero_to_one = zero_to_one};
	double numbers[16];
	std::memcpy(numbers, &projection, sizeof numbers);
	nook_block block{};
	block.frame = 7.0F;
	const char* const reason = nook_fill(block, numbers, settings);
	CHECK((reason == nullptr) == (block.frame != 7.0F)); // nothing filled
	return reason == nullptr ? "" : reason;
}

bool holds(const std::string& text, const char* part)
{
	return text.find(part) != std::string::npos;
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
	store(halves, {GL_R16F, GL_RED}, depths.data()); // sky overflows to infinity
	GlPass linear(shaderOf(moduleSettings(false)));
	nook_settings settings = settingsOf(gbuffer);
	settings.depth_bits = 16;
	const Difference half = differenceOf(drawn(linear, halves, plain, blockFor(gbuffer.view.projection, settings)), truth);
	CAPTURE(half.mean, half.beyond, half.worst);
	CHECK(half.mean <= 0.02);
	CHECK(half.signed_mean >= 0.0); // no self-occlusion
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
	// Again in a larger texture, with walls in front of the camera all around.
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

TEST_CASE("module: projections of another convention are refused by its name", "[emit]")
{
	const View view = viewOf(builtinLevel("cornell").cameras[0], 160, 90);
	const glm::dmat4 flat = projectionOf(lensOf(0.0), 160.0 / 90.0);
	glm::dmat4 shifted = flat; // off-centre
	shifted[3][0] = 0.25;
	for (const glm::dmat4& parallel : {flat, shifted})
	{
		for (const Convention& convention : conventions(view.projection, parallel, 160, 90))
		{
			CAPTURE(convention.name);
			const glm::dmat4& p = convention.projection;
			const bool unit = convention.clip == ClipRange::zero_to_one;
			glm::dmat4 upside_down = p;
			upside_down[1] = -p[1];
			for (const glm::dmat4& good : {p, upside_down, 0.37 * p, 1e-3 * p})
			{
				CHECK(faultOf(good).empty());
				CHECK(faultOf(good, true, unit).empty());
			}
			CHECK(holds(faultOf(glm::transpose(p)), "row-major: transpose it"));
			glm::dmat4 left = p; // view space with z forward
			left[2] = -p[2];
			CHECK(holds(faultOf(left), "left-handed"));
			CHECK(holds(faultOf(glm::transpose(left)), "row-major"));
			CHECK_FALSE(faultOf(-p).empty()); // w is negative in front of the camera
			for (int i = 0; i < 16; ++i)
			{
				for (const double number : {std::nan(""), HUGE_VAL, -HUGE_VAL})
				{
					glm::dmat4 broken = p;
					broken[i / 4][i % 4] = number;
					CHECK(holds(faultOf(broken), "infinity or NaN"));
				}
			}
		}
	}
	// Near and far planes on both sides of the camera, as in orthographic projections of 2D engines.
	glm::dmat4 around = flat;
	around[2][2] = -1.0;
	around[3][2] = 0.0;
	CHECK(faultOf(around).empty());
	CHECK(holds(faultOf(glm::dmat4(0.0)), "found 0 for the scale"));
	CHECK(holds(faultOf(glm::dmat4(1.0)), "left-handed"));
	glm::dmat4 oblique = view.projection;
	oblique[0][2] = 0.3;
	oblique[1][2] = -0.2;
	CHECK(faultOf(oblique).empty());
	CHECK(holds(faultOf(oblique, true), "depends on x or y"));
	glm::dmat4 flat_depth = view.projection;
	flat_depth[2][2] = 0.0;
	flat_depth[3][2] = 0.0;
	CHECK(faultOf(flat_depth).empty());
	CHECK_FALSE(faultOf(flat_depth, true).empty());
	const View turned = viewOf(builtinLevel("courtyard").cameras[0], 160, 90);
	CHECK(holds(faultOf(turned.projection * turned.camera_from_world), "found a skew"));
}

TEST_CASE("module: each setting out of range is named", "[emit]")
{
	const View view = viewOf(builtinLevel("cornell").cameras[0], 160, 90);
	double numbers[16];
	std::memcpy(numbers, &view.projection, sizeof numbers);
	const auto refused = [&](const char* name, auto change)
	{
		nook_settings settings{.width = 16, .height = 9};
		change(settings);
		nook_block block{};
		const char* const reason = nook_fill(block, numbers, settings);
		CAPTURE(name, reason);
		REQUIRE(reason != nullptr);
		CHECK(holds(reason, "settings: "));
		CHECK(holds(reason, name));
	};
	for (const double number : {-1.0, std::nan(""), HUGE_VAL})
	{
		for (const auto& [name, member] : std::initializer_list<std::pair<const char*, double nook_settings::*>>{
				 {"radius", &nook_settings::radius},
				 {"second_radius", &nook_settings::second_radius},
				 {"third_radius", &nook_settings::third_radius},
				 {"most_pixels", &nook_settings::most_pixels},
				 {"least_pixels", &nook_settings::least_pixels},
				 {"thickness", &nook_settings::thickness},
				 {"second_thickness", &nook_settings::second_thickness},
				 {"third_thickness", &nook_settings::third_thickness},
				 {"first_band", &nook_settings::first_band},
				 {"second_band", &nook_settings::second_band},
				 {"box_height", &nook_settings::box_height},
				 {"slope", &nook_settings::slope},
				 {"largest_pixels", &nook_settings::largest_pixels},
				 {"sigma", &nook_settings::sigma},
				 {"beta", &nook_settings::beta},
				 {"contrast", &nook_settings::contrast},
				 {"epsilon", &nook_settings::epsilon},
				 {"slice_thickness", &nook_settings::slice_thickness},
				 {"strength", &nook_settings::strength},
				 {"power", &nook_settings::power}})
		{
			refused(name, [&member = member, number](nook_settings& settings) { settings.*member = number; });
		}
	}
	refused("width", [](nook_settings& settings) { settings.width = 0; });
	refused("height", [](nook_settings& settings) { settings.height = -9; });
	refused("guard", [](nook_settings& settings) { settings.guard = -1; });
	refused("depth_bits", [](nook_settings& settings) { settings.depth_bits = 8; });
	refused("normal_bits", [](nook_settings& settings) { settings.normal_bits = 4; });
	refused("radius", [](nook_settings& settings) { settings.radius = 0.0; });
	refused("frame", [](nook_settings& settings) { settings.frame = 16777217; });
}

TEST_CASE("module: device depth needs no more settings than linear depth", "[emit]")
{
	const Level level = builtinLevel("courtyard");
	const Tracer tracer(level, {});
	const View view = viewOf(level.cameras[0], kModuleWidth, kModuleHeight);
	const glm::dmat4 flat = projectionOf(lensOf(0.0), static_cast<double>(kModuleWidth) / kModuleHeight);
	const Convention convention = conventions(view.projection, flat, kModuleWidth, kModuleHeight).front(); // in OpenGL's row order
	const GBuffer gbuffer = castGBuffer(tracer, {view.camera_from_world, convention.projection}, kModuleWidth, kModuleHeight,
										NormalKind::geometric, {2, {}});
	const GlContext context;
	const GlTexture normals(kModuleWidth, kModuleHeight, 4, &fourOf(gbuffer.normals, false)[0].x);
	const GlTexture linear(kModuleWidth, kModuleHeight, 1, finiteDepths(gbuffer).data());
	const GlTexture device(kModuleWidth, kModuleHeight, 1, nullptr);
	storeDepth(device, 24, devicesOf(gbuffer, convention, 24));
	const TemporaryFolder folder;
	std::vector<std::vector<float>> pictures;
	for (const bool of_device : {false, true})
	{
		ModuleSettings settings = moduleSettings(of_device);
		settings.methods.front().recipe = *recipeFor(raysRecipes(), ShadeMethod::vo_line);
		settings.methods.front().shade = ShadeSettings();
		applyRecipe(*settings.methods.front().shade, *settings.methods.front().recipe, 1.0);
		// An engine's program: with its settings the header works for a module of linear depth.
		writeFile(folder / "m.h", moduleHeader(settings, contextOf("nook emit")));
		std::string numbers;
		for (int i = 0; i < 16; ++i)
		{
			numbers += (i == 0 ? "" : ", ") + std::to_string(convention.projection[i / 4][i % 4]);
		}
		writeFile(folder / "fill.cpp",
				  "#include \"m.h\"\n#include <cstdio>\nint main()\n{\n\tconst double p[16] = {" + numbers +
					  "};\n\tnook_settings s = nook_vo_line_settings(1.0);\n\ts.width = " + std::to_string(kModuleWidth) +
					  ";\n\ts.height = " + std::to_string(kModuleHeight) +
					  ";\n\ts.first_row_ndc_y = 1;\n\tnook_block b{};\n\tif (nook_fill(b, p, s))\n\t\treturn 1;\n"
					  "\tstd::fwrite(&b, sizeof b, 1, stdout);\n}\n");
		REQUIRE(passes("c++ -std=c++17 -Wall -Wextra -Werror '" + folder / "fill.cpp" + "' -o '" + folder / "fill" + "' && ('" +
						   folder / "fill" + "' > '" + folder / "block" + "')",
					   folder));
		const std::string bytes = readFile(folder / "block");
		nook_block block{};
		REQUIRE(bytes.size() == sizeof block);
		std::memcpy(&block, bytes.data(), sizeof block);
		GlPass pass(shaderOf(settings));
		pictures.push_back(drawn(pass, of_device ? device : linear, normals, block));
	}
	const Difference difference = differenceOf(pictures[0], pictures[1]);
	CAPTURE(difference.mean, difference.worst);
	CHECK(difference.mean <= 1e-3);
	CHECK(difference.beyond <= 1e-2);
	const double closed = sumOver(pictures[0], [](const float value) { return 1.0 - static_cast<double>(value); });
	CHECK(closed > 0.03 * static_cast<double>(pictures[0].size())); // the effect is visible
}
