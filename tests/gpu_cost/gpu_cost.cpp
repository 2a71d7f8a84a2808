// SPDX-License-Identifier: GPL-3.0-or-later
// Compiles SPIR-V shaders with Mesa's driver for AMD GPUs and prints what its compiler says about each. No GPU is needed: with
// RADV_FORCE_FAMILY the driver opens hardware that is not there, compiles for it and runs nothing.
// usage: nook_gpu_cost SHADER.spv|VERTEX.spv+FRAGMENT.spv...
// Output: a JSON object per shader and line, with the name of the driver and the statistics under the driver's names.
// Exit codes: 0 ok, 1 usage, 2 file cannot be read, 3 no SPIR-V, 5 no driver that reports statistics.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

namespace
{
[[noreturn]] void failCost(int code, const std::string& text)
{
	std::fprintf(stderr, "nook_gpu_cost: %s\n", text.c_str());
	std::exit(code);
}

void mustSucceed(VkResult result, const char* call)
{
	if (result < 0)
	{
		failCost(5, std::string(call) + ": found VkResult " + std::to_string(result) + ", expected success");
	}
}

template <class T> T ofType(VkStructureType type)
{
	T value{};
	value.sType = type;
	return value;
}

// A compiled shader, its entry point and its bindings.
struct Shader
{
	std::vector<uint32_t> words;
	std::string entry;
	VkShaderStageFlagBits stage = VK_SHADER_STAGE_FRAGMENT_BIT;
	std::map<uint32_t, std::map<uint32_t, VkDescriptorType>> sets; // by set and binding
	bool integers = false;                                         // the outputs are integers
	bool pushes = false;
};

Shader readShader(const std::string& path)
{
	std::ifstream file(path, std::ios::binary);
	if (!file)
	{
		failCost(2, path + ": cannot be read");
	}
	const std::string bytes{std::istreambuf_iterator<char>(file), {}};
	Shader shader;
	shader.words.resize(bytes.size() / 4);
	std::memcpy(shader.words.data(), bytes.data(), shader.words.size() * 4);
	const std::vector<uint32_t>& words = shader.words;
	if (words.size() < 5 || words[0] != 0x07230203)
	{
		failCost(3, path + ": expected SPIR-V");
	}
	// Opcodes, storage classes and decorations by their numbers in the SPIR-V specification.
	std::map<uint32_t, std::vector<uint32_t>> types; // opcode and operands
	std::map<uint32_t, std::map<uint32_t, uint32_t>> decorations;
	for (size_t i = 5; i < words.size();)
	{
		const uint32_t opcode = words[i] & 0xffff;
		const size_t length = words[i] >> 16;
		if (length == 0 || i + length > words.size())
		{
			failCost(3, path + ": word " + std::to_string(i) + ": found an instruction beyond the end");
		}
		const uint32_t* const operands = &words[i + 1];
		if (opcode == 15) // OpEntryPoint
		{
			shader.entry = reinterpret_cast<const char*>(operands + 2);
			shader.stage = operands[0] == 0   ? VK_SHADER_STAGE_VERTEX_BIT
						   : operands[0] == 5 ? VK_SHADER_STAGE_COMPUTE_BIT
											  : VK_SHADER_STAGE_FRAGMENT_BIT;
		}
		else if (opcode == 71) // OpDecorate
		{
			decorations[operands[0]][operands[1]] = length > 3 ? operands[2] : 1;
		}
		else if (opcode >= 19 && opcode <= 32) // OpType…
		{
			std::vector<uint32_t>& type = types[operands[0]];
			type.assign(operands + 1, operands + length - 1);
			type.insert(type.begin(), opcode);
		}
		else if (opcode == 59) // OpVariable: pointer, id, storage class
		{
			uint32_t pointee = types[operands[0]][2];
			while (types[pointee][0] == 28 || types[pointee][0] == 23) // arrays and vectors: what they consist of
			{
				pointee = types[pointee][1];
			}
			const std::vector<uint32_t>& type = types[pointee];
			const std::map<uint32_t, uint32_t>& own = decorations[operands[1]];
			const auto number = [&](uint32_t decoration)
			{
				return own.contains(decoration) ? own.at(decoration) : 0;
			};
			const uint32_t storage = operands[2];
			if (storage == 0 || storage == 2 || storage == 12) // UniformConstant, Uniform, StorageBuffer
			{
				const bool is_buffer = storage == 12 || (storage == 2 && decorations[pointee].contains(3)); // BufferBlock
				shader.sets[number(34)][number(33)] =
					storage != 0    ? (is_buffer ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER)
					: type[0] == 27 ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
					: type[0] == 26 ? VK_DESCRIPTOR_TYPE_SAMPLER
					: type[6] == 2  ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
									: VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
			}
			shader.pushes = shader.pushes || storage == 9;
			shader.integers = shader.integers || (storage == 3 && type[0] == 21);
		}
		i += length;
	}
	return shader;
}

VkDevice makeDevice(std::string& driver)
{
	auto application = ofType<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
	application.apiVersion = VK_API_VERSION_1_3;
	auto instance_info = ofType<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
	instance_info.pApplicationInfo = &application;
	VkInstance instance{};
	mustSucceed(vkCreateInstance(&instance_info, nullptr, &instance), "vkCreateInstance");
	uint32_t count = 1;
	VkPhysicalDevice physical{};
	mustSucceed(vkEnumeratePhysicalDevices(instance, &count, &physical), "vkEnumeratePhysicalDevices");
	if (count == 0)
	{
		failCost(5, "found no Vulkan device, expected RADV");
	}
	auto driver_of = ofType<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
	auto properties = ofType<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
	properties.pNext = &driver_of;
	vkGetPhysicalDeviceProperties2(physical, &properties);
	driver = std::string(properties.properties.deviceName) + ", " + driver_of.driverInfo;

	// All features of the device, statistics among them.
	auto statistics = ofType<VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR>(
		VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR);
	auto f13 = ofType<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
	auto f12 = ofType<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
	auto f11 = ofType<VkPhysicalDeviceVulkan11Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES);
	auto features = ofType<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
	f13.pNext = &statistics;
	f12.pNext = &f13;
	f11.pNext = &f12;
	features.pNext = &f11;
	vkGetPhysicalDeviceFeatures2(physical, &features);
	features.features.robustBufferAccess = VK_FALSE; // adds checks
	const float priority = 1.0f;
	auto queue = ofType<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
	queue.queueCount = 1;
	queue.pQueuePriorities = &priority;
	const char* const extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
	auto info = ofType<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
	info.pNext = &features;
	info.queueCreateInfoCount = 1;
	info.pQueueCreateInfos = &queue;
	info.enabledExtensionCount = 1;
	info.ppEnabledExtensionNames = &extension;
	VkDevice device{};
	mustSucceed(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
	return device;
}

VkPipelineLayout makeLayout(VkDevice device, const std::vector<Shader>& shaders)
{
	std::map<uint32_t, std::map<uint32_t, VkDescriptorType>> sets;
	for (const Shader& shader : shaders)
	{
		for (const auto& [set, bindings] : shader.sets)
		{
			sets[set].insert(bindings.begin(), bindings.end());
		}
	}
	std::vector<VkDescriptorSetLayout> layouts(sets.empty() ? 0 : sets.rbegin()->first + 1);
	for (uint32_t set = 0; set < layouts.size(); ++set)
	{
		std::vector<VkDescriptorSetLayoutBinding> bindings;
		for (const auto& [binding, type] : sets[set])
		{
			bindings.push_back({binding, type, 1, VK_SHADER_STAGE_ALL, nullptr});
		}
		auto info = ofType<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
		info.bindingCount = static_cast<uint32_t>(bindings.size());
		info.pBindings = bindings.data();
		mustSucceed(vkCreateDescriptorSetLayout(device, &info, nullptr, &layouts[set]), "vkCreateDescriptorSetLayout");
	}
	const VkPushConstantRange push = {VK_SHADER_STAGE_ALL, 0, 128};
	auto info = ofType<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
	info.setLayoutCount = static_cast<uint32_t>(layouts.size());
	info.pSetLayouts = layouts.data();
	info.pushConstantRangeCount = std::any_of(shaders.begin(), shaders.end(), [](const Shader& shader) { return shader.pushes; });
	info.pPushConstantRanges = &push;
	VkPipelineLayout layout{};
	mustSucceed(vkCreatePipelineLayout(device, &info, nullptr, &layout), "vkCreatePipelineLayout");
	return layout;
}

VkPipeline makePipeline(VkDevice device, const std::vector<Shader>& shaders)
{
	constexpr VkPipelineCreateFlags kFlags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
	const VkPipelineLayout layout = makeLayout(device, shaders);
	std::vector<VkPipelineShaderStageCreateInfo> stages;
	for (const Shader& shader : shaders)
	{
		auto module_info = ofType<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
		module_info.codeSize = shader.words.size() * 4;
		module_info.pCode = shader.words.data();
		auto stage = ofType<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
		mustSucceed(vkCreateShaderModule(device, &module_info, nullptr, &stage.module), "vkCreateShaderModule");
		stage.stage = shader.stage;
		stage.pName = shader.entry.c_str();
		stages.push_back(stage);
	}
	VkPipeline pipeline{};
	if (shaders.size() == 1)
	{
		auto info = ofType<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
		info.flags = kFlags;
		info.layout = layout;
		info.stage = stages[0];
		mustSucceed(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), "vkCreateComputePipelines");
		return pipeline;
	}
	const VkVertexInputAttributeDescription attribute = {0, 0, VK_FORMAT_R32_SINT, 0}; // a volume's cluster
	const VkVertexInputBindingDescription vertex_buffer = {0, 4, VK_VERTEX_INPUT_RATE_INSTANCE};
	auto vertices = ofType<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
	vertices.vertexBindingDescriptionCount = vertices.vertexAttributeDescriptionCount = 1;
	vertices.pVertexBindingDescriptions = &vertex_buffer;
	vertices.pVertexAttributeDescriptions = &attribute;
	auto assembly = ofType<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
	assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
	const VkViewport viewport = {0, 0, 1280, 720, 0, 1};
	const VkRect2D scissor = {{0, 0}, {1280, 720}};
	auto view = ofType<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
	view.viewportCount = view.scissorCount = 1;
	view.pViewports = &viewport;
	view.pScissors = &scissor;
	auto raster = ofType<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
	raster.lineWidth = 1;
	auto samples = ofType<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
	samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
	VkPipelineColorBlendAttachmentState mask{};
	mask.colorWriteMask = 15;
	auto blend = ofType<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
	blend.attachmentCount = 1;
	blend.pAttachments = &mask;
	const VkFormat format = shaders[1].integers ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R8G8B8A8_UNORM;
	auto rendering = ofType<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
	rendering.colorAttachmentCount = 1;
	rendering.pColorAttachmentFormats = &format;
	auto info = ofType<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
	info.pNext = &rendering;
	info.flags = kFlags;
	info.stageCount = 2;
	info.pStages = stages.data();
	info.pVertexInputState = &vertices;
	info.pInputAssemblyState = &assembly;
	info.pViewportState = &view;
	info.pRasterizationState = &raster;
	info.pMultisampleState = &samples;
	info.pColorBlendState = &blend;
	info.layout = layout;
	mustSucceed(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), "vkCreateGraphicsPipelines");
	return pipeline;
}

// Prints the statistics of the last stage: fragments or compute.
void printCost(VkDevice device, VkPipeline pipeline, const std::string& driver)
{
	const auto stages_of = reinterpret_cast<PFN_vkGetPipelineExecutablePropertiesKHR>(
		vkGetDeviceProcAddr(device, "vkGetPipelineExecutablePropertiesKHR"));
	const auto values_of = reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(
		vkGetDeviceProcAddr(device, "vkGetPipelineExecutableStatisticsKHR"));
	auto which = ofType<VkPipelineInfoKHR>(VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR);
	which.pipeline = pipeline;
	uint32_t count = 8;
	std::vector<VkPipelineExecutablePropertiesKHR> stages(
		count, ofType<VkPipelineExecutablePropertiesKHR>(VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR));
	mustSucceed(stages_of(device, &which, &count, stages.data()), "vkGetPipelineExecutablePropertiesKHR");
	auto stage = ofType<VkPipelineExecutableInfoKHR>(VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR);
	stage.pipeline = pipeline;
	for (uint32_t i = 0; i < count; ++i)
	{
		if ((stages[i].stages & (VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT)) != 0)
		{
			stage.executableIndex = i;
		}
	}
	count = 64;
	std::vector<VkPipelineExecutableStatisticKHR> values(
		count, ofType<VkPipelineExecutableStatisticKHR>(VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR));
	mustSucceed(values_of(device, &stage, &count, values.data()), "vkGetPipelineExecutableStatisticsKHR");
	std::printf("{\"driver\": \"%s\"", driver.c_str());
	for (uint32_t i = 0; i < count; ++i)
	{
		std::printf(", \"%s\": %llu", values[i].name, static_cast<unsigned long long>(values[i].value.u64));
	}
	std::puts("}");
}
} // namespace

int main(int argc, char** argv)
{
	if (argc < 2)
	{
		failCost(1, "usage: nook_gpu_cost SHADER.spv|VERTEX.spv+FRAGMENT.spv...");
	}
	std::string driver;
	VkDevice device = makeDevice(driver);
	for (int i = 1; i < argc; ++i)
	{
		const std::string files = argv[i];
		const size_t plus = files.find('+');
		std::vector<Shader> shaders = {readShader(files.substr(0, plus))};
		if (plus != std::string::npos)
		{
			shaders.push_back(readShader(files.substr(plus + 1)));
		}
		if ((shaders.size() == 1) != (shaders[0].stage == VK_SHADER_STAGE_COMPUTE_BIT))
		{
			failCost(1, files + ": expected a compute shader, or a vertex and a fragment shader");
		}
		printCost(device, makePipeline(device, shaders), driver);
	}
	return 0;
}
