// SPDX-License-Identifier: GPL-3.0-or-later
// Modules for Vulkan and HLSL, compiled by glslang and dispatched by a Vulkan driver: pixels decide, not compilers.
#include "small_modules.h"
#include "small_views.h"
#include "testing.h"
#include "vulkan_device.h"

#include "methods/recipes.h"
#include "shade/shade.h"

#include <iostream>
#include <span>

namespace
{

// The bindings of a module (docs/reference/modules.md): the block, textures, the picture of the pass, and for textures apart from
// their sampler the sampler, for HLSL the numbers of the pass.
constexpr uint32_t kOwnTileBinding = 13; // of the test, for a macro that reads it
constexpr uint32_t kOutBinding = 15;
constexpr uint32_t kLastBinding = 16;
constexpr std::array<uint32_t, 5> kSlotBindings{6, 11, 7, 8, 9}; // by ShadeSlot

struct VulkanPass
{
	std::map<uint32_t, VkImageView> textures;
	VulkanTarget target;
	glm::ivec4 numbers{};
};

class VulkanShader
{
public:
	VulkanShader(const VulkanDevice& vulkan, const ModuleSettings& settings, const std::string& spirv)
		: m_vulkan(vulkan), m_hlsl(settings.target == GlslTarget::hlsl60),
		  m_bindings(vulkan, typesFor(settings), VK_SHADER_STAGE_ALL, sizeof VulkanPass::numbers)
	{
		if (settings.main == ModuleMain::fragment)
		{
			m_fragment = spirv;
			return;
		}
		auto info = vulkanInfo<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
		info.stage = vulkanStageOf(vulkan, VK_SHADER_STAGE_COMPUTE_BIT, spirv);
		info.layout = m_bindings.layout();
		requireVulkan(vkCreateComputePipelines(vulkan.device(), VK_NULL_HANDLE, 1, &info, nullptr, &m_pipeline));
	}

	// Draws a fragment shader, or dispatches a compute shader `times` times, one after the other, which keeps the GPU's clock up.
	// Returns the time of one in milliseconds.
	double run(const VulkanPass& pass, const VulkanBuffer& block, int times) const
	{
		m_bindings.bind(0, block);
		for (const auto& [binding, view] : pass.textures)
		{
			m_bindings.bind(binding, view);
		}
		m_bindings.bind(kOutBinding, pass.target.view);
		if (m_hlsl)
		{
			m_bindings.bind(kLastBinding, VulkanBuffer(m_vulkan, sizeof pass.numbers, &pass.numbers));
		}
		else
		{
			m_bindings.bind(kLastBinding, VkImageView{});
		}
		if (!m_fragment.empty())
		{
			const TemporaryFolder folder;
			drawVulkan(m_vulkan, m_bindings, {spirvOfStage(kScreenTriangle, "vert", "", folder), m_fragment}, pass.target,
					   VulkanBlend::none, block, VK_FRONT_FACE_CLOCKWISE,
					   [](VkCommandBuffer commands) { vkCmdDraw(commands, 3, 1, 0, 0); });
			return 0.0;
		}
		const double milliseconds = m_vulkan.run(
			[&](VkCommandBuffer commands)
			{
				m_bindings.use(commands, VK_PIPELINE_BIND_POINT_COMPUTE, m_pipeline);
				vkCmdPushConstants(commands, m_bindings.layout(), VK_SHADER_STAGE_ALL, 0, 16, &pass.numbers);
				for (int i = 0; i < times; ++i)
				{
					vkCmdDispatch(commands, static_cast<uint32_t>(pass.target.width + 7) / 8,
								  static_cast<uint32_t>(pass.target.height + 7) / 8, 1);
					auto barrier = vulkanInfo<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
					barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
					barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
					vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1,
										 &barrier, 0, nullptr, 0, nullptr);
				}
			});
		return milliseconds / times;
	}

private:
	static std::vector<VkDescriptorType> typesFor(const ModuleSettings& settings)
	{
		const bool hlsl = settings.target == GlslTarget::hlsl60;
		const bool separate = hlsl || settings.textures == ModuleTextures::separate;
		std::vector<VkDescriptorType> types(kLastBinding + 1, separate ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE
																	   : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
		types[0] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
		types[kOutBinding] = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
		types[kLastBinding] = hlsl ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_SAMPLER;
		return types;
	}

	const VulkanDevice& m_vulkan;
	bool m_hlsl = false;
	VulkanBindings m_bindings;
	std::string m_fragment; // SPIR-V
	VkPipeline m_pipeline{};
};

// SPIR-V of one pass of a whole shader.
std::string spirvOf(const ModuleSettings& settings, const std::string& module, const std::string& number, PictureFormat format,
					const TemporaryFolder& folder)
{
	constexpr std::array<const char*, 3> kImageFormats{"r32f", "rgba32f", "rgba32ui"};
	// Without -Od, glslang joins multiplications and additions of HLSL. That moves areas by 1e-5, which take the root of a
	// difference.
	const std::string options = settings.target == GlslTarget::hlsl60
									? "-D -Od -e main -DNOOK_VULKAN"
									: std::string("-DNOOK_OUT_FORMAT=") + kImageFormats[static_cast<std::size_t>(format)];
	return spirvOfStage(module, settings.main == ModuleMain::fragment ? "frag" : "comp", options + " -DNOOK_PASS=" + number,
						folder);
}

struct ComputedPicture
{
	std::vector<float> visibility;
	std::vector<double> all_ms;  // per repetition
	std::vector<double> main_ms; // without filters and preparation
	std::map<std::string, std::vector<double>> calls_ms;
};

// The picture of a module, computed as its head says. For times: with repetitions. own_tile: what to define so that macros read the
// tile from kOwnTileBinding instead of its own.
ComputedPicture computed(const GBuffer& gbuffer, const ModuleSettings& settings, int repetitions = 1,
						 const std::string& own_tile = "")
{
	static std::map<std::string, VulkanShader> shaders; // by the module and the number of the pass
	const VulkanDevice& vulkan = anyDevice();
	const TemporaryFolder folder;
	const std::string module = withDefinitions(moduleGlsl(settings, contextOf("nook emit")), own_tile);
	const ShadeSamples samples = samplesFor(settings);
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings.shade, false);
	const std::vector<float> numbers = bytesFor(passBlockFor(gbuffer, settings.shade, 1, 0), settings.float_block);
	const VulkanBuffer block(vulkan, numbers.size() * 4, numbers.data());
	const std::vector<glm::vec4> normals = mapped(gbuffer.normals, [](const glm::vec3& normal) { return glm::vec4(normal, 0.0F); });
	const VulkanPicture depths(vulkan, {PictureFormat::scalar, gbuffer.width_px, gbuffer.height_px}, finiteDepths(gbuffer).data());
	const VulkanPicture normal_picture(vulkan, {PictureFormat::quad, gbuffer.width_px, gbuffer.height_px}, normals.data());
	const std::vector<glm::vec4> texels = tileTexels(samples);
	const VulkanPicture tile(vulkan, {PictureFormat::quad, static_cast<int>(texels.size()) / samples.count, samples.count},
							 texels.data());
	const std::vector<std::unique_ptr<VulkanPicture>> pictures =
		mapped(plan.pictures, [&](const PictureShape& shape) { return std::make_unique<VulkanPicture>(vulkan, shape); });
	std::vector<std::string> calls;
	ComputedPicture result{{}, std::vector<double>(static_cast<std::size_t>(repetitions)), {}, {}};
	result.main_ms = result.all_ms;
	for (std::size_t repetition = 0; repetition < result.all_ms.size(); ++repetition)
	{
		std::string entry;
		std::vector<ShadeRead> upsampled;
		for (const ShadePass& pass : plan.passes)
		{
			if (std::string(pass.kernel.call) == "nookUpsample") // a part of nook...Full
			{
				upsampled = pass.reads;
				continue;
			}
			entry = pass.of_pixel ? pass.kernel.call : entry;
			const std::string call = passCallOf(pass, entry, settings.shade.half_resolution);
			const std::string number = passNumber(calls, call);
			const VulkanPicture& picture = *pictures[pass.picture];
			const std::string key = number + module;
			if (!shaders.contains(key))
			{
				shaders.emplace(
					std::piecewise_construct, std::forward_as_tuple(key),
					std::forward_as_tuple(vulkan, settings, spirvOf(settings, module, number, picture.shape.format, folder)));
			}
			VulkanPass one;
			for (uint32_t binding = 1; binding < kOutBinding; ++binding) // every binding holds something, read or not
			{
				one.textures[binding] = depths.view;
			}
			one.textures[2] = normal_picture.view;
			for (const uint32_t binding : {3U, 4U, 5U, 10U, 12U}) // the tile of any method
			{
				one.textures[binding] = own_tile.empty() ? tile.view : depths.view;
			}
			one.textures[kOwnTileBinding] = tile.view;
			std::vector<ShadeRead> reads = pass.reads;
			reads.insert(reads.end(), upsampled.begin(), upsampled.end());
			for (const ShadeRead& read : reads)
			{
				one.textures[kSlotBindings[static_cast<std::size_t>(read.slot)]] = pictures[read.picture]->view;
			}
			one.target = {picture.viewOf(vulkan, static_cast<uint32_t>(pass.level), 1, static_cast<uint32_t>(pass.layer), 1),
						  picture.format, std::max(picture.shape.width >> pass.level, 1),
						  std::max(picture.shape.height >> pass.level, 1)};
			one.numbers = modulePassOf(pass.block, pass.kernel.call);
			if (settings.float_block)
			{
				const glm::vec4 floats(one.numbers);
				std::memcpy(&one.numbers, &floats, sizeof floats);
			}
			const double milliseconds = shaders.at(key).run(one, block, repetitions == 1 ? 1 : 64);
			result.all_ms[repetition] += milliseconds;
			result.calls_ms[call].resize(result.all_ms.size());
			result.calls_ms[call][repetition] += milliseconds;
			result.main_ms[repetition] += pass.of_pixel ? milliseconds : 0.0;
		}
	}
	result.visibility = pictures[plan.passes.back().picture]->read(vulkan);
	return result;
}

struct TimedMethod
{
	const char* name;
	ShadeMethod method;
	int count; // of samples, or slices
	int steps;
	bool paper;
	bool half;
};
constexpr std::array kTimed{TimedMethod{"lines 3 x 3", ShadeMethod::vo_line, 3, 0, false, false},
							TimedMethod{"slices 1 x 2", ShadeMethod::slices, 1, 2, false, false},
							TimedMethod{"lines 3 x 3, half", ShadeMethod::vo_line, 3, 0, false, true},
							TimedMethod{"lines 9, one radius", ShadeMethod::vo_line, 9, 0, true, false},
							TimedMethod{"points 12", ShadeMethod::vo_point, 12, 0, false, false},
							TimedMethod{"areas 3 x 3", ShadeMethod::vo_area, 3, 0, false, false},
							TimedMethod{"areas 9, one radius", ShadeMethod::vo_area, 9, 0, true, false},
							TimedMethod{"Alchemy 9", ShadeMethod::alchemy, 9, 0, false, false},
							TimedMethod{"slices 1 x 3", ShadeMethod::slices, 1, 3, false, false},
							TimedMethod{"slices 1 x 4", ShadeMethod::slices, 1, 4, false, false},
							TimedMethod{"slices 1 x 4, half", ShadeMethod::slices, 1, 4, false, true},
							TimedMethod{"slices 3 x 6", ShadeMethod::slices, 3, 6, false, false},
							TimedMethod{"slices 3 x 6, half", ShadeMethod::slices, 3, 6, false, true},
							TimedMethod{"StatVO, 4 layers, half tables", ShadeMethod::statvo, 0, 0, false, false}};

// Prints the lower quartile of the times of compute shaders.
void printTimes(std::span<const TimedMethod> methods, std::span<const double> radii_px, int width, int height, int repetitions)
{
	const VulkanDevice& vulkan = anyDevice();
	REQUIRE(vulkan.device() != nullptr);
	std::cout << vulkan.name() << "\n| method | radius, px | all passes, ms per megapixel | method alone | passes |\n"
			  << "| --- | --- | --- | --- | --- |\n";
	const GBuffer gbuffer = builtinView("courtyard", width, height);
	const auto perMegapixel = [&gbuffer](std::vector<double> times)
	{
		std::sort(times.begin(), times.end());
		return 1e6 * times[times.size() / 4] / (gbuffer.width_px * gbuffer.height_px);
	};
	for (const TimedMethod& one : methods)
	{
		ShadeSettings shade;
		shade.method = one.method;
		if (const MethodRecipe* const recipe = recipeFor(raysRecipes(), one.method); recipe != nullptr && !one.paper)
		{
			applyRecipe(shade, *recipe, 1.5);
		}
		shade.slices = {std::max(one.count, 1), std::max(one.steps, 1)};
		shade.statvo.cell_px = 2;
		shade.filter = one.method == ShadeMethod::statvo ? ShadeFilter::none : ShadeFilter::bilateral;
		shade.half_resolution = one.half;
		ModuleSettings settings = moduleOf({one.name, shade}, GlslTarget::vulkan);
		settings.main = ModuleMain::compute;
		if (takesPattern(one.method))
		{
			settings.methods.front().variants = scatteredTile(domainOf(one.method), 4, one.count, false).variants;
		}
		for (const double radius_px : radii_px)
		{
			settings.shade.min_radius_px = radius_px;
			settings.shade.max_radius_px = radius_px;
			const ComputedPicture picture = computed(gbuffer, settings, repetitions);
			std::cout << "| " << one.name << " | " << radius_px << " | " << perMegapixel(picture.all_ms) << " | "
					  << perMegapixel(picture.main_ms) << " |";
			for (const auto& [call, times] : picture.calls_ms)
			{
				std::cout << ' ' << call << ' ' << perMegapixel(times);
			}
			std::cout << " |" << std::endl;
		}
	}
}

} // namespace

TEST_CASE("module: HLSL and Vulkan's GLSL compute one picture, that of nook shade", "[emit]")
{
	const VulkanDevice& vulkan = anyDevice();
	if (vulkan.device() == nullptr || !toolExists("glslangValidator"))
	{
		WARN("skipped: found no Vulkan device or no glslangValidator, expected Debian's mesa-vulkan-drivers and glslang-tools");
		return;
	}
	const GBuffer gbuffer = builtinView("courtyard", 96, 54);
	const std::vector<PassCase> all = passCases();
	std::vector<PassCase> cases{all[2], all[4], all[7], all[9]}; // one of each method: drivers take long to compile
	for (const ShadeMethod method : {ShadeMethod::vo_point, ShadeMethod::slices})
	{
		cases.push_back({"one pass", {}});
		cases.back().shade.method = method;
		cases.back().shade.radius_m = 0.8;
		cases.back().shade.slices.bent = method == ShadeMethod::slices;
		cases.back().shade.filter = method == ShadeMethod::slices ? ShadeFilter::bilateral : ShadeFilter::none;
	}
	std::size_t number = 0;
	for (const PassCase& one : cases)
	{
		number += 1;
		ModuleSettings settings = moduleOf(one, GlslTarget::vulkan);
		settings.main = ModuleMain::compute;
		settings.tile = number % 2 == 0 ? TilePlace::array : TilePlace::texture;
		settings.float_block = number % 3 == 0;
		settings.textures = number % 2 == 0 ? ModuleTextures::separate : ModuleTextures::fixed;
		CAPTURE(one.name, vulkan.name());
		const std::vector<float> glsl = computed(gbuffer, settings).visibility;
		if (!one.shade.slices.bent)
		{
			checkSamePicture(shadeOnCpu(gbuffer, samplesFor(settings), settings.shade, {2, {}}).visibility, glsl);
		}
		settings.target = GlslTarget::hlsl60;
		// A GPU's compiler joins multiplications and additions its own way.
		const double most = vulkan.name().find("llvmpipe") != std::string::npos ? 1e-6 : 2e-5;
		const double found = differenceOf(glsl, computed(gbuffer, settings).visibility).worst;
		CAPTURE(1e6 * found);
		CHECK(found <= most);
		if (vulkan.draws() && (one.shade.method == ShadeMethod::vo_line || one.shade.method == ShadeMethod::vo_point))
		{
			settings.main = ModuleMain::fragment;
			CHECK(differenceOf(glsl, computed(gbuffer, settings).visibility).worst <= most);
		}
	}
}

TEST_CASE("module: macros read the tile from another texture", "[emit]")
{
	if (anyDevice().device() == nullptr || !toolExists("glslangValidator"))
	{
		WARN("skipped: found no Vulkan device or no glslangValidator, expected Debian's mesa-vulkan-drivers and glslang-tools");
		return;
	}
	const GBuffer gbuffer = builtinView("courtyard", 48, 27);
	ModuleSettings settings = moduleOf({"vo-line", {}}, GlslTarget::vulkan);
	settings.main = ModuleMain::compute;
	settings.textures = ModuleTextures::macros;
	const std::vector<float> expected = computed(gbuffer, settings).visibility;
	const std::string glsl = "layout(set = 0, binding = 13) uniform sampler2D own;\n"
							 "#define NOOK_VO_LINE_TILE(row, i) texelFetch(own, ivec2(row, i), 0)\n";
	CHECK(computed(gbuffer, settings, 1, glsl).visibility == expected);
	settings.target = GlslTarget::hlsl60;
	settings.textures = ModuleTextures::fixed; // HLSL always has the macros
	const std::string hlsl = "[[vk::binding(13, 0)]] Texture2D<float4> own;\n"
							 "#define NOOK_VO_LINE_TILE(row, i) own.Load(int3(row, i, 0))\n";
	CHECK(differenceOf(computed(gbuffer, settings, 1, hlsl).visibility, expected).worst <= 1e-6);
	CHECK(differenceOf(computed(gbuffer, settings, 1, "// none").visibility, expected).worst >
		  0.1); // the tile's own binding has depths
}

TEST_CASE("module: spirv-cross translates HLSL's SPIR-V to MSL", "[emit]")
{
	if (!toolExists("glslangValidator") || !toolExists("spirv-cross"))
	{
		WARN("skipped: found no glslangValidator or no spirv-cross, expected Debian's glslang-tools and spirv-cross");
		return;
	}
	const TemporaryFolder folder;
	const PassCase one = GENERATE(from_range(passCases()));
	CAPTURE(one.name);
	ModuleSettings settings = moduleOf(one, GlslTarget::hlsl60);
	settings.main = ModuleMain::fragment;
	spirvOf(settings, moduleGlsl(settings, contextOf("nook emit")), "0", PictureFormat::scalar, folder);
	REQUIRE(passes("spirv-cross --msl '" + folder / "m.spv" + "' --output '" + folder / "m.metal" + "'", folder));
	CHECK(readFile(folder / "m.metal").find("fragment main0_out main0(") != std::string::npos);
}

// Hidden: a table for docs/measurements/gpu.md, where the Vulkan device is a GPU.
TEST_CASE("module times: milliseconds per megapixel of compute shaders, radii in pixels", "[.times]")
{
	printTimes(kTimed, std::array{12.0, 48.0, 120.0, 240.0}, 2560, 1440, 7);
}

// Hidden: for scripts/gpu.sh run --quick.
TEST_CASE("module times: two methods on a small picture", "[.times_quick]")
{
	printTimes(std::span(kTimed).first(2), std::array{48.0}, 64, 36, 1);
}
