// SPDX-License-Identifier: GPL-3.0-or-later
// Modules with several passes, for tests that draw them as their head says.
#pragma once

#include "emit_samples.h"
#include "nook_vo9.h"
#include "other_tools.h"
#include "testing.h"

#include "emit/module.h"
#include "methods/block.h"
#include "methods/method_table.h"
#include "methods/passes.h"
#include "scene/gbuffer.h"

namespace nook::test
{

struct PassCase
{
	const char* name;
	ShadeSettings shade;
};

inline std::vector<PassCase> passCases()
{
	std::vector<PassCase> all(11);
	all[0].name = "vo-line, bilateral, half";
	all[0].shade.filter = ShadeFilter::bilateral;
	all[0].shade.half_resolution = true;
	all[1].name = "vo-area, two radii, thick";
	all[1].shade.method = ShadeMethod::vo_area;
	all[1].shade.volume.radii = TwoRadii::minimum;
	all[1].shade.volume.second_radius_m = 0.3;
	all[1].shade.volume.thickness_m = 0.4;
	all[2].name = "vo-area, window, half, quadratic";
	all[2].shade.method = ShadeMethod::vo_area;
	all[2].shade.filter = ShadeFilter::window;
	all[2].shade.half_resolution = true;
	all[2].shade.volume.quadratic = true;
	all[3].name = "statvo, four layers";
	all[3].shade.method = ShadeMethod::statvo;
	all[4].name = "statvo, one layer, half tables, quadrants, bilateral 7";
	all[4].shade.method = ShadeMethod::statvo;
	all[4].shade.statvo.layers = 1;
	all[4].shade.statvo.cell_px = 2;
	all[4].shade.statvo.quadrants = true;
	all[4].shade.filter = ShadeFilter::bilateral;
	all[4].shade.filter_taps = 7;
	all[5].name = "alchemy, bands, bilateral";
	all[5].shade.method = ShadeMethod::alchemy;
	all[5].shade.bands = {3, 8.0, 20.0};
	all[5].shade.filter = ShadeFilter::bilateral;
	all[6].name = "vo-line, without normals, window";
	all[6].shade.use_normal = false;
	all[6].shade.filter = ShadeFilter::window;
	all[7].name = "alchemy, coarser depths";
	all[7].shade.method = ShadeMethod::alchemy;
	all[7].shade.depth_levels = 3;
	all[8].name = "slices, two of three steps, bilateral, half";
	all[8].shade.method = ShadeMethod::slices;
	all[8].shade.slices = {2, 3};
	all[8].shade.filter = ShadeFilter::bilateral;
	all[8].shade.half_resolution = true;
	all[9].name = "vo-line, three radii, strength and power, bilateral, half";
	all[9].shade.volume = {0.4, 0.2, 0.1, TwoRadii::product, 0.3, 0.1};
	all[9].shade.strength = 0.7;
	all[9].shade.power = 1.6;
	all[9].shade.filter = ShadeFilter::bilateral;
	all[9].shade.half_resolution = true;
	all[10].name = "vo-point, cut, one variant";
	all[10].shade.method = ShadeMethod::vo_point;
	all[10].shade.use_normal = false;
	all[10].shade.cut = true;
	for (PassCase& one : all)
	{
		one.shade.radius_m = 0.8;
	}
	return all;
}

inline ModuleSettings moduleOf(const PassCase& one, GlslTarget target)
{
	ModuleSettings settings;
	settings.target = target;
	settings.shade = one.shade;
	ModuleMethod method{one.shade.method, {}};
	if (takesPattern(one.shade.method))
	{
		method.variants = scatteredTile(domainOf(one.shade.method), one.shade.cut ? 1 : 4, 6, false).variants;
	}
	settings.methods = {method};
	return settings;
}

inline ModuleSettings moduleOf(ShadeMethod method, ShadeFilter filter, GlslTarget target)
{
	PassCase one{"", {}};
	one.shade.method = method;
	one.shade.radius_m = 0.8;
	one.shade.filter = filter;
	return moduleOf(one, target);
}

// A whole shader of an OpenGL or Vulkan target compiles, and its SPIR-V is valid, where spirv-val is installed.
inline void requireCompiles(const std::string& shader, GlslTarget target)
{
	const TemporaryFolder folder;
	writeFile(folder / "m.frag", shader);
	const bool vulkan = target == GlslTarget::vulkan;
	const std::string spirv = vulkan ? "-V -o '" + folder / "m.spv" + "' " : std::string();
	REQUIRE(passes("glslangValidator " + spirv + "'" + folder / "m.frag" + "'", folder));
	if (vulkan && toolExists("spirv-val"))
	{
		REQUIRE(passes("spirv-val --target-env vulkan1.0 '" + folder / "m.spv" + "'", folder));
	}
}

inline ShadeSamples samplesFor(const ModuleSettings& settings)
{
	const ModuleMethod& method = settings.methods.front();
	return method.variants.empty() ? ownSamples(settings.shade) : samplesOf(method.method, method.variants, layersOf(method));
}

inline nook_block passBlockFor(const GBuffer& gbuffer, const ShadeSettings& shade, int first_row_ndc_y, int frame)
{
	nook_settings settings;
	settings.width = gbuffer.width_px;
	settings.height = gbuffer.height_px;
	settings.first_row_ndc_y = first_row_ndc_y;
	settings.radius = shade.radius_m;
	settings.most_pixels = shade.max_radius_px;
	settings.least_pixels = shade.min_radius_px;
	settings.second_radius = shade.volume.second_radius_m;
	settings.third_radius = shade.volume.third_radius_m;
	settings.thickness = shade.volume.thickness_m;
	settings.second_thickness = shade.volume.second_thickness_m;
	settings.third_thickness = shade.volume.third_thickness_m;
	settings.strength = shade.strength;
	settings.power = shade.power;
	settings.frame = frame;
	settings.first_band = shade.bands.first_px;
	settings.second_band = shade.bands.second_px;
	double numbers[16];
	std::memcpy(numbers, &gbuffer.view.projection, sizeof numbers);
	nook_block block{};
	REQUIRE(nook_fill(block, numbers, settings) == nullptr);
	return block;
}

// The block's bytes as declared in the module.
inline std::vector<float> bytesFor(const nook_block& block, bool floats)
{
	std::vector<float> numbers(sizeof block / 4);
	std::memcpy(numbers.data(), &block, sizeof block);
	for (std::size_t i = 0; floats && i < 2; ++i)
	{
		numbers[offsetof(nook_block, first) / 4 + i] = static_cast<float>(block.first[i]);
		numbers[offsetof(nook_block, last) / 4 + i] = static_cast<float>(block.last[i]);
	}
	return numbers;
}

// The call at a texel, as listed in the module's introduction.
inline std::string passCallOf(const ShadePass& pass, const std::string& entry, bool half)
{
	if (pass.fills)
	{
		return entry + "Full(at)";
	}
	return moduleCallOf(pass) + (pass.of_pixel && half && pass.packing == ShadePacking::none ? "(2 * at)" : "(at)");
}

// Column = variant, row = sample.
inline std::vector<glm::vec4> tileTexels(const ShadeSamples& samples)
{
	std::vector<glm::vec4> texels(samples.samples.size());
	const auto count = static_cast<std::size_t>(samples.count);
	const std::size_t variants = texels.size() / count;
	for (std::size_t i = 0; i < texels.size(); ++i)
	{
		texels[i] = samples.samples[i % variants * count + i / variants];
	}
	return texels;
}

// A whole shader with macros behind its first line, where #version is.
inline std::string withDefinitions(std::string shader, const std::string& definitions)
{
	return shader.insert(shader.find('\n') + 1, definitions);
}

// Number of a pass for NOOK_PASS: calls count in the order in which passes first make them.
inline std::string passNumber(std::vector<std::string>& calls, const std::string& call)
{
	const auto found = std::find(calls.begin(), calls.end(), call);
	const auto number = found - calls.begin();
	if (found == calls.end())
	{
		calls.push_back(call);
	}
	return std::to_string(number);
}

} // namespace nook::test
