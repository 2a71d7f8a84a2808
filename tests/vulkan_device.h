// SPDX-License-Identifier: GPL-3.0-or-later
// A Vulkan device with buffers and pictures, for tests. Nothing is freed before the process ends.
#pragma once

#include "other_tools.h"
#include "picture_errors.h"
#include "testing.h"

#include "methods/passes.h"

#include <vulkan/vulkan.h>

#include <optional>

namespace nook::test
{

template <class T> T vulkanInfo(VkStructureType type)
{
	T value{};
	value.sType = type;
	return value;
}

inline void requireVulkan(VkResult result)
{
	REQUIRE(result == VK_SUCCESS);
}

// A device that computes, its queue and a command buffer. Everything lives until the process ends.
class VulkanDevice
{
public:
	// Finds no device where device() is null.
	VulkanDevice()
	{
		auto application = vulkanInfo<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
		application.apiVersion = VK_API_VERSION_1_3;
		auto instance_info = vulkanInfo<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
		instance_info.pApplicationInfo = &application;
		VkInstance instance{};
		uint32_t count = 1;
		VkPhysicalDevice physical{};
		if (vkCreateInstance(&instance_info, nullptr, &instance) != VK_SUCCESS ||
			vkEnumeratePhysicalDevices(instance, &count, &physical) < 0 || count == 0)
		{
			return;
		}
		VkPhysicalDeviceProperties properties{};
		vkGetPhysicalDeviceProperties(physical, &properties);
		m_name = properties.deviceName;
		vkGetPhysicalDeviceMemoryProperties(physical, &m_memory);
		const float priority = 1.0F;
		auto queue = vulkanInfo<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
		queue.queueCount = 1; // of family 0
		queue.pQueuePriorities = &priority;
		auto info = vulkanInfo<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
		info.queueCreateInfoCount = 1;
		info.pQueueCreateInfos = &queue;
		auto features = vulkanInfo<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
		VkPhysicalDeviceFeatures found{};
		vkGetPhysicalDeviceFeatures(physical, &found);
		m_draws = properties.apiVersion >= VK_API_VERSION_1_3 && found.logicOp == VK_TRUE;
		features.dynamicRendering = VK_TRUE;
		VkPhysicalDeviceFeatures used{};
		used.logicOp = VK_TRUE;
		if (m_draws)
		{
			info.pNext = &features;
			info.pEnabledFeatures = &used;
		}
		if (vkCreateDevice(physical, &info, nullptr, &m_device) != VK_SUCCESS)
		{
			return;
		}
		vkGetDeviceQueue(m_device, 0, 0, &m_queue);
		auto pool_info = vulkanInfo<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
		pool_info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
		VkCommandPool pool{};
		requireVulkan(vkCreateCommandPool(m_device, &pool_info, nullptr, &pool));
		auto commands_info = vulkanInfo<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
		commands_info.commandPool = pool;
		commands_info.commandBufferCount = 1;
		requireVulkan(vkAllocateCommandBuffers(m_device, &commands_info, &m_commands));
		m_tick_ns = static_cast<double>(properties.limits.timestampPeriod);
		auto timer_info = vulkanInfo<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
		timer_info.queryType = VK_QUERY_TYPE_TIMESTAMP;
		timer_info.queryCount = 2;
		requireVulkan(vkCreateQueryPool(m_device, &timer_info, nullptr, &m_timer));
	}

	VkDevice device() const
	{
		return m_device;
	}
	const std::string& name() const
	{
		return m_name;
	}

	// Has Vulkan 1.3 and logic operations.
	bool draws() const
	{
		return m_draws;
	}

	VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags) const
	{
		auto info = vulkanInfo<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
		info.allocationSize = needs.size;
		while ((needs.memoryTypeBits >> info.memoryTypeIndex & 1U) == 0 ||
			   (m_memory.memoryTypes[info.memoryTypeIndex].propertyFlags & flags) != flags)
		{
			info.memoryTypeIndex += 1;
			REQUIRE(info.memoryTypeIndex < m_memory.memoryTypeCount);
		}
		VkDeviceMemory memory{};
		requireVulkan(vkAllocateMemory(m_device, &info, nullptr, &memory));
		return memory;
	}

	// Records commands, runs them and waits. Returns the time between the device's timestamps around them, in milliseconds.
	template <class Commands> double run(const Commands& record) const
	{
		auto begin = vulkanInfo<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
		requireVulkan(vkBeginCommandBuffer(m_commands, &begin));
		vkCmdResetQueryPool(m_commands, m_timer, 0, 2);
		vkCmdWriteTimestamp(m_commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, m_timer, 0);
		record(m_commands);
		vkCmdWriteTimestamp(m_commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, m_timer, 1);
		requireVulkan(vkEndCommandBuffer(m_commands));
		auto submit = vulkanInfo<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
		submit.commandBufferCount = 1;
		submit.pCommandBuffers = &m_commands;
		requireVulkan(vkQueueSubmit(m_queue, 1, &submit, VK_NULL_HANDLE));
		requireVulkan(vkQueueWaitIdle(m_queue));
		std::array<uint64_t, 2> ticks{};
		requireVulkan(vkGetQueryPoolResults(m_device, m_timer, 0, 2, sizeof ticks, ticks.data(), 8,
											VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
		return 1e-6 * m_tick_ns * static_cast<double>(ticks[1] - ticks[0]);
	}

private:
	std::string m_name;
	bool m_draws = false;
	VkDevice m_device{};
	VkQueue m_queue{};
	VkCommandBuffer m_commands{};
	VkQueryPool m_timer{};
	double m_tick_ns = 0.0;
	VkPhysicalDeviceMemoryProperties m_memory{};
};

struct VulkanBuffer
{
	VkBuffer buffer{};
	void* bytes = nullptr; // mapped

	VulkanBuffer(const VulkanDevice& vulkan, std::size_t size, const void* values = nullptr)
	{
		auto info = vulkanInfo<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
		info.size = size;
		info.usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
					 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
		requireVulkan(vkCreateBuffer(vulkan.device(), &info, nullptr, &buffer));
		VkMemoryRequirements needs{};
		vkGetBufferMemoryRequirements(vulkan.device(), buffer, &needs);
		const VkDeviceMemory memory =
			vulkan.allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
		requireVulkan(vkBindBufferMemory(vulkan.device(), buffer, memory, 0));
		requireVulkan(vkMapMemory(vulkan.device(), memory, 0, VK_WHOLE_SIZE, 0, &bytes));
		if (values != nullptr)
		{
			std::memcpy(bytes, values, size);
		}
	}
};

// Always in the layout GENERAL, with 32 bits per channel.
struct VulkanPicture
{
	VkImage image{};
	VkImageView view{}; // of everything
	VkFormat format{};
	PictureShape shape;

	VulkanPicture(const VulkanDevice& vulkan, const PictureShape& own, const void* values = nullptr) : shape(own)
	{
		constexpr std::array kFormats{VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_UINT};
		format = kFormats[static_cast<std::size_t>(shape.format)];
		auto info = vulkanInfo<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
		info.imageType = VK_IMAGE_TYPE_2D;
		info.format = format;
		info.extent = {static_cast<uint32_t>(shape.width), static_cast<uint32_t>(shape.height), 1};
		info.mipLevels = static_cast<uint32_t>(shape.levels);
		info.arrayLayers = static_cast<uint32_t>(std::max(shape.layers, 1));
		info.samples = VK_SAMPLE_COUNT_1_BIT;
		info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
					 VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
		requireVulkan(vkCreateImage(vulkan.device(), &info, nullptr, &image));
		VkMemoryRequirements needs{};
		vkGetImageMemoryRequirements(vulkan.device(), image, &needs);
		requireVulkan(vkBindImageMemory(vulkan.device(), image, vulkan.allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT), 0));
		view = viewOf(vulkan, 0, info.mipLevels, 0, info.arrayLayers,
					  shape.format == PictureFormat::counts ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D);
		const std::optional<VulkanBuffer> staging =
			values != nullptr ? std::optional<VulkanBuffer>(std::in_place, vulkan, size(), values) : std::nullopt;
		vulkan.run(
			[&](VkCommandBuffer commands)
			{
				auto barrier = vulkanInfo<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
				barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
				barrier.image = image;
				barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, info.mipLevels, 0, info.arrayLayers};
				vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
									 nullptr, 0, nullptr, 1, &barrier);
				if (staging)
				{
					const VkBufferImageCopy all = copyOfAll();
					vkCmdCopyBufferToImage(commands, staging->buffer, image, VK_IMAGE_LAYOUT_GENERAL, 1, &all);
				}
			});
	}

	VkImageView viewOf(const VulkanDevice& vulkan, uint32_t level, uint32_t levels, uint32_t layer, uint32_t layers,
					   VkImageViewType type = VK_IMAGE_VIEW_TYPE_2D) const
	{
		auto info = vulkanInfo<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
		info.image = image;
		info.viewType = type;
		info.format = format;
		info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, level, levels, layer, layers};
		VkImageView result{};
		requireVulkan(vkCreateImageView(vulkan.device(), &info, nullptr, &result));
		return result;
	}

	std::size_t size() const // of level 0
	{
		return static_cast<std::size_t>(shape.width * shape.height) * (shape.format == PictureFormat::scalar ? 4 : 16);
	}

	VkBufferImageCopy copyOfAll() const
	{
		VkBufferImageCopy all{};
		all.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
		all.imageExtent = {static_cast<uint32_t>(shape.width), static_cast<uint32_t>(shape.height), 1};
		return all;
	}

	std::vector<float> read(const VulkanDevice& vulkan) const
	{
		const VulkanBuffer staging(vulkan, size());
		const VkBufferImageCopy all = copyOfAll();
		vulkan.run([&](VkCommandBuffer commands)
				   { vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_GENERAL, staging.buffer, 1, &all); });
		std::vector<float> values(size() / 4);
		std::memcpy(values.data(), staging.bytes, size());
		return values;
	}
};

inline VkPipelineShaderStageCreateInfo vulkanStageOf(const VulkanDevice& vulkan, VkShaderStageFlagBits kind,
													 const std::string& spirv)
{
	std::vector<uint32_t> words(spirv.size() / 4);
	std::memcpy(words.data(), spirv.data(), spirv.size());
	auto module_info = vulkanInfo<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
	module_info.codeSize = spirv.size();
	module_info.pCode = words.data();
	auto stage = vulkanInfo<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
	stage.stage = kind;
	stage.pName = "main";
	requireVulkan(vkCreateShaderModule(vulkan.device(), &module_info, nullptr, &stage.module));
	return stage;
}

// A descriptor per binding, 0 and up, one sampler for all, and constants that are pushed.
class VulkanBindings
{
public:
	VulkanBindings(const VulkanDevice& vulkan, std::vector<VkDescriptorType> types, VkShaderStageFlags stages, uint32_t pushed = 0)
		: m_device(vulkan.device()), m_types(std::move(types))
	{
		std::vector<VkDescriptorSetLayoutBinding> bindings;
		std::vector<VkDescriptorPoolSize> sizes;
		for (const VkDescriptorType type : m_types)
		{
			bindings.push_back({static_cast<uint32_t>(bindings.size()), type, 1, stages, nullptr});
			sizes.push_back({type, 1});
		}
		auto set_info = vulkanInfo<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
		set_info.bindingCount = static_cast<uint32_t>(bindings.size());
		set_info.pBindings = bindings.data();
		VkDescriptorSetLayout set_layout{};
		requireVulkan(vkCreateDescriptorSetLayout(m_device, &set_info, nullptr, &set_layout));
		const VkPushConstantRange push{stages, 0, pushed};
		auto layout_info = vulkanInfo<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
		layout_info.setLayoutCount = 1;
		layout_info.pSetLayouts = &set_layout;
		layout_info.pushConstantRangeCount = pushed > 0 ? 1 : 0;
		layout_info.pPushConstantRanges = &push;
		requireVulkan(vkCreatePipelineLayout(m_device, &layout_info, nullptr, &m_layout));
		auto sampler_info = vulkanInfo<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
		sampler_info.maxLod = VK_LOD_CLAMP_NONE;
		requireVulkan(vkCreateSampler(m_device, &sampler_info, nullptr, &m_sampler));
		auto pool_info = vulkanInfo<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
		pool_info.maxSets = 1;
		pool_info.poolSizeCount = static_cast<uint32_t>(sizes.size());
		pool_info.pPoolSizes = sizes.data();
		VkDescriptorPool pool{};
		requireVulkan(vkCreateDescriptorPool(m_device, &pool_info, nullptr, &pool));
		auto set = vulkanInfo<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
		set.descriptorPool = pool;
		set.descriptorSetCount = 1;
		set.pSetLayouts = &set_layout;
		requireVulkan(vkAllocateDescriptorSets(m_device, &set, &m_set));
	}

	VkPipelineLayout layout() const
	{
		return m_layout;
	}

	void bind(uint32_t binding, VkImageView view) const
	{
		const VkDescriptorImageInfo image{m_sampler, view, VK_IMAGE_LAYOUT_GENERAL};
		write(binding, &image, nullptr);
	}
	void bind(uint32_t binding, const VulkanBuffer& buffer) const
	{
		const VkDescriptorBufferInfo whole{buffer.buffer, 0, VK_WHOLE_SIZE};
		write(binding, nullptr, &whole);
	}

	void use(VkCommandBuffer commands, VkPipelineBindPoint point, VkPipeline pipeline) const
	{
		vkCmdBindPipeline(commands, point, pipeline);
		vkCmdBindDescriptorSets(commands, point, m_layout, 0, 1, &m_set, 0, nullptr);
	}

private:
	void write(uint32_t binding, const VkDescriptorImageInfo* image, const VkDescriptorBufferInfo* buffer) const
	{
		auto info = vulkanInfo<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
		info.dstSet = m_set;
		info.dstBinding = binding;
		info.descriptorCount = 1;
		info.descriptorType = m_types[binding];
		info.pImageInfo = image;
		info.pBufferInfo = buffer;
		vkUpdateDescriptorSets(m_device, 1, &info, 0, nullptr);
	}

	VkDevice m_device{};
	std::vector<VkDescriptorType> m_types;
	VkPipelineLayout m_layout{};
	VkSampler m_sampler{};
	VkDescriptorSet m_set{};
};

inline const VulkanDevice& anyDevice()
{
	static const VulkanDevice vulkan;
	return vulkan;
}

inline constexpr const char* kScreenTriangle = R"(#version 450
void main()
{
	gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

// SPIR-V of one stage. options: of glslangValidator.
inline std::string spirvOfStage(const std::string& text, const char* kind, const std::string& options,
								const TemporaryFolder& folder)
{
	writeFile(folder / "m.txt", text);
	REQUIRE(passes("glslangValidator -V -S " + std::string(kind) + " " + options + " -o '" + folder / "m.spv" + "' '" +
					   folder / "m.txt" + "'",
				   folder));
	return readFile(folder / "m.spv");
}

struct VulkanTarget
{
	VkImageView view{};
	VkFormat format{};
	int width = 0;
	int height = 0;
};

enum class VulkanBlend
{
	none,
	add,
	join // integers, by OR
};

// Draws into a target that is cleared to 0, with the SPIR-V of a vertex and a fragment shader. draw(commands) makes the draw calls.
// An instance of a draw call reads one integer of `numbers`.
template <class Draw>
void drawVulkan(const VulkanDevice& vulkan, const VulkanBindings& bindings, const std::array<std::string, 2>& spirv,
				const VulkanTarget& target, VulkanBlend mode, const VulkanBuffer& numbers, VkFrontFace front, const Draw& draw)
{
	const std::array stages{vulkanStageOf(vulkan, VK_SHADER_STAGE_VERTEX_BIT, spirv[0]),
							vulkanStageOf(vulkan, VK_SHADER_STAGE_FRAGMENT_BIT, spirv[1])};
	const VkVertexInputBindingDescription instances{0, 4, VK_VERTEX_INPUT_RATE_INSTANCE};
	const VkVertexInputAttributeDescription cluster{0, 0, VK_FORMAT_R32_SINT, 0};
	auto input = vulkanInfo<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
	input.vertexBindingDescriptionCount = 1;
	input.pVertexBindingDescriptions = &instances;
	input.vertexAttributeDescriptionCount = 1;
	input.pVertexAttributeDescriptions = &cluster;
	auto assembly = vulkanInfo<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
	assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
	const VkExtent2D size{static_cast<uint32_t>(target.width), static_cast<uint32_t>(target.height)};
	const VkViewport view{0.0F, 0.0F, static_cast<float>(size.width), static_cast<float>(size.height), 0.0F, 1.0F};
	const VkRect2D whole{{0, 0}, size};
	auto viewport = vulkanInfo<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
	viewport.viewportCount = 1;
	viewport.pViewports = &view;
	viewport.scissorCount = 1;
	viewport.pScissors = &whole;
	auto raster = vulkanInfo<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
	raster.frontFace = front;
	raster.lineWidth = 1.0F;
	auto samples = vulkanInfo<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
	samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
	VkPipelineColorBlendAttachmentState add{};
	add.blendEnable = mode == VulkanBlend::add ? VK_TRUE : VK_FALSE;
	add.srcColorBlendFactor = add.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
	add.colorWriteMask = 15;
	auto blend = vulkanInfo<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
	blend.logicOpEnable = mode == VulkanBlend::join ? VK_TRUE : VK_FALSE;
	blend.logicOp = VK_LOGIC_OP_OR;
	blend.attachmentCount = 1;
	blend.pAttachments = &add;
	const VkDynamicState cull = VK_DYNAMIC_STATE_CULL_MODE;
	auto dynamic = vulkanInfo<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
	dynamic.dynamicStateCount = 1;
	dynamic.pDynamicStates = &cull;
	auto formats = vulkanInfo<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
	formats.colorAttachmentCount = 1;
	formats.pColorAttachmentFormats = &target.format;
	auto info = vulkanInfo<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
	info.pNext = &formats;
	info.stageCount = 2;
	info.pStages = stages.data();
	info.pVertexInputState = &input;
	info.pInputAssemblyState = &assembly;
	info.pViewportState = &viewport;
	info.pRasterizationState = &raster;
	info.pMultisampleState = &samples;
	info.pColorBlendState = &blend;
	info.pDynamicState = &dynamic;
	info.layout = bindings.layout();
	VkPipeline pipeline{};
	requireVulkan(vkCreateGraphicsPipelines(vulkan.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));

	auto attachment = vulkanInfo<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
	attachment.imageView = target.view;
	attachment.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
	attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
	attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
	auto rendering = vulkanInfo<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
	rendering.renderArea = whole;
	rendering.layerCount = 1;
	rendering.colorAttachmentCount = 1;
	rendering.pColorAttachments = &attachment;
	vulkan.run(
		[&](VkCommandBuffer commands)
		{
			const VkDeviceSize start = 0;
			vkCmdBeginRendering(commands, &rendering);
			bindings.use(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
			vkCmdBindVertexBuffers(commands, 0, 1, &numbers.buffer, &start);
			vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
			draw(commands);
			vkCmdEndRendering(commands);
		});
}

} // namespace nook::test
