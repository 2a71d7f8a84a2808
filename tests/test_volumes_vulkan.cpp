// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes and masks in Vulkan's GLSL and in HLSL, compiled by glslang and drawn by a Vulkan driver.
#include "small_gbuffers.h"
#include "small_volumes.h"
#include "testing.h"
#include "vulkan_device.h"

#include "emit/module.h"
#include "shade/aov_gl_parts.h"

namespace
{

// One layout for all stages: docs/reference/modules.md, bindings.
class VolumeLayout
{
public:
	VolumeLayout(const VulkanDevice& vulkan, bool hlsl)
		: m_vulkan(vulkan), m_bindings(vulkan, typesFor(hlsl), VK_SHADER_STAGE_ALL_GRAPHICS)
	{
	}

	template <class Bound> void bind(uint32_t binding, const Bound& bound) const
	{
		m_bindings.bind(binding, bound);
	}

	// Draws into a picture: floats add up, integers are joined by OR.
	template <class Draw>
	void draw(const std::string& vertex, const std::string& fragment, const VulkanPicture& target, const VulkanBuffer& numbers,
			  VkFrontFace front, const Draw& draw) const
	{
		const bool bits = target.shape.format == PictureFormat::counts;
		drawVulkan(m_vulkan, m_bindings, {vertex, fragment}, {target.view, target.format, target.shape.width, target.shape.height},
				   bits ? VulkanBlend::join : VulkanBlend::add, numbers, front, draw);
	}

private:
	static std::vector<VkDescriptorType> typesFor(bool hlsl)
	{
		std::vector<VkDescriptorType> types(15,
											hlsl ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
		types[0] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
		std::fill_n(types.begin() + 3, 3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
		return types;
	}

	const VulkanDevice& m_vulkan;
	VulkanBindings m_bindings;
};

template <class Item> VulkanBuffer vulkanBufferOf(const VulkanDevice& vulkan, const std::vector<Item>& items)
{
	return VulkanBuffer(vulkan, items.size() * sizeof(Item), items.data());
}

// Visibility by the emitted shaders; directions: 0 for sums, or up to 128.
std::vector<float> drawnVolumes(const GBuffer& gbuffer, const VolumeSet& set, GlslTarget target, int directions)
{
	const VulkanDevice& vulkan = anyDevice();
	const TemporaryFolder folder;
	const bool hlsl = target == GlslTarget::hlsl60;
	const std::string text = volumesGlsl({target, directions, false}, {"nook emit", "test", {}, {}});
	const auto spirv = [&](const std::string& stage, const char* kind)
	{
		return hlsl ? spirvOfStage(text, kind, "-D -Od -e main -DNOOK_VULKAN -DNOOK_ANY_DEPTH -D" + stage, folder)
					: spirvOfStage("#version 450\n#define NOOK_ANY_DEPTH\n#define " + stage + "\n" + text, kind, "", folder);
	};
	const std::string triangle = spirvOfStage(kScreenTriangle, "vert", "", folder);

	const PackedVolumes packed = packVolumes(set, {false}, {});
	nook_volumes::Header header = headerOf(set, true);
	header.plane_error = std::max(header.plane_error, packed.plane_error_m);
	nook_volumes::Camera camera = cameraOf(gbuffer, 1);
	camera.faces_by_rows = true;
	nook_volumes::Frame frame;
	REQUIRE(frame.set(header, camera) == nullptr);
	std::vector<nook_volumes::SeenCluster> seen;
	std::vector<int> numbers;
	for (const nook_volumes::Cluster& cluster : packed.clusters)
	{
		seen.push_back(frame.seen(cluster));
		numbers.push_back(static_cast<int>(numbers.size()));
	}
	const std::vector<glm::vec4> normals = mapped(gbuffer.normals, [](const glm::vec3& normal) { return glm::vec4(normal, 0.0F); });
	const auto shapeOf = [&gbuffer](PictureFormat format)
	{
		return PictureShape{format, gbuffer.width_px, gbuffer.height_px};
	};
	const VulkanBuffer block(vulkan, sizeof frame.block, &frame.block);
	const VulkanBuffer corners = vulkanBufferOf(vulkan, packed.corners);
	const VulkanBuffer polygons = vulkanBufferOf(vulkan, packed.polygons);
	const VulkanBuffer clusters = vulkanBufferOf(vulkan, seen);
	const VulkanBuffer instances = vulkanBufferOf(vulkan, numbers);
	const VulkanPicture depths(vulkan, shapeOf(PictureFormat::scalar), finiteDepths(gbuffer).data());
	const VulkanPicture normal_picture(vulkan, shapeOf(PictureFormat::quad), normals.data());
	const VulkanPicture sums(vulkan, shapeOf(directions > 0 ? PictureFormat::counts : PictureFormat::scalar));
	const VulkanPicture half_spaces(vulkan, {PictureFormat::counts, 64, 64});
	const VulkanPicture visibility(vulkan, shapeOf(PictureFormat::scalar));
	const VolumeLayout layout(vulkan, hlsl);
	layout.bind(0, block);
	layout.bind(1, depths.view);
	layout.bind(2, normal_picture.view);
	layout.bind(3, corners);
	layout.bind(4, polygons);
	layout.bind(5, clusters);
	for (const uint32_t unread : {6U, 7U, 8U, 9U, 11U, 12U, 14U})
	{
		layout.bind(unread, depths.view);
	}
	layout.bind(10, half_spaces.view);
	layout.bind(13, sums.view);
	const auto one = [](VkCommandBuffer commands)
	{
		vkCmdDraw(commands, 3, 1, 0, 0);
	};
	if (directions > 0)
	{
		layout.draw(triangle, spirv("NOOK_HALF_SPACES", "frag"), half_spaces, instances, VK_FRONT_FACE_CLOCKWISE, one);
	}
	layout.draw(spirv("NOOK_VERTEX", "vert"), spirv("NOOK_FRAGMENT", "frag"), sums, instances,
				frame.mirrored() ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE,
				[&](VkCommandBuffer commands)
				{
					for (uint32_t i = 0; i < packed.clusters.size(); ++i)
					{
						const nook_volumes::Cluster& cluster = packed.clusters[i];
						if (frame.inSight(cluster))
						{
							vkCmdSetCullMode(commands, frame.holdsEye(cluster) ? VK_CULL_MODE_FRONT_BIT : VK_CULL_MODE_BACK_BIT);
							vkCmdDraw(commands, 12 * cluster.corner_count, 1, hlsl ? 0 : 12 * cluster.first_corner, i);
						}
					}
				});
	layout.draw(triangle, spirv("NOOK_RESOLVE", "frag"), visibility, instances, VK_FRONT_FACE_CLOCKWISE, one);
	return visibility.read(vulkan);
}

} // namespace

TEST_CASE("module: HLSL and Vulkan's GLSL draw the volumes and masks of nook shade", "[emit]")
{
	if (anyDevice().device() == nullptr || !anyDevice().draws() || !toolExists("glslangValidator"))
	{
		WARN("skipped: found no Vulkan 1.3 or no glslangValidator, expected Debian's mesa-vulkan-drivers and glslang-tools");
		return;
	}
	const Level level = builtinLevel("cornell");
	const VolumeSet set = volumesOf(level, 0.4, 8);
	const Tracer tracer(level, {});
	const bool within = GENERATE(false, true);
	View view = viewOf(level.cameras.front(), 64, 48);
	if (within) // volumes that contain the eye
	{
		view.camera_from_world = glm::inverse(worldFromCamera({0.1, 0.3, 0.2}, {-0.2, 0.1, -0.4}));
	}
	const GBuffer gbuffer = castGBuffer(tracer, view, 64, 48, NormalKind::geometric, {});
	for (const int directions : within ? std::vector<int>{0} : std::vector<int>{0, 64}) // drivers take long to compile masks
	{
		AovSettings settings{
			.mask = directions > 0, .directions = std::max(directions, kLeastDirections), .target = AovTarget::r32f};
		const std::vector<float> expected = aovOnCpu(gbuffer, set, settings, {2, {}}).shaded.visibility;
		const std::vector<float> glsl = drawnVolumes(gbuffer, set, GlslTarget::vulkan, directions);
		CAPTURE(anyDevice().name(), within, directions, differenceOf(expected, glsl).worst);
		// A direction that just misses an edge is one bit.
		CHECK(differenceOf(glsl, expected).beyond <= (directions > 0 ? 0.01 : 0.001));
		CHECK(*std::min_element(glsl.begin(), glsl.end()) < 0.7F);
		// Masks are equal bit by bit on llvmpipe; on a GPU an edge may be one direction off.
		const double mask_bound = anyDevice().name().find("llvmpipe") != std::string::npos ? 0.0 : 1.0 / 64.0;
		CHECK(differenceOf(glsl, drawnVolumes(gbuffer, set, GlslTarget::hlsl60, directions)).worst <=
			  (directions > 0 ? mask_bound : 1e-6));
	}
}
