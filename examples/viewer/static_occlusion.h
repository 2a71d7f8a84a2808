// SPDX-License-Identifier: MIT
// Everything in this program that uses nook's volumes: computes the visibility of the level's surfaces from a file of `nook
// volumes`, a depth buffer and normals, with shaders that nook generated.
#pragma once

#include <glm/mat4x4.hpp>

#include <nook/nook_volumes_draw.h>

#include <cstdint>
#include <string>
#include <vector>

class StaticOcclusion
{
public:
	// Needs a current context, like everything here; its OpenGL objects are destroyed with the context. Throws Failure.
	explicit StaticOcclusion(const std::string& path);

	void resize(int width, int height);

	struct Input
	{
		unsigned depth = 0;       // texture: depth buffer, GL_DEPTH_COMPONENT32F
		unsigned depth_frame = 0; // framebuffer that it is attached to
		unsigned normals = 0;     // texture: unit, in view space
		bool reversed = false;    // 1 near, 0 far, z_ndc from 0 to 1
		glm::mat4 camera_from_world{1.0f};
		glm::mat4 projection{1.0f};
	};
	// Returns a texture, R8: 1 is open. Throws Failure for a camera that the shaders do not support.
	unsigned draw(const Input& input);

	std::size_t volumesDrawn() const;

private:
	void drawVolumes(const Input& input);
	void drawClusters(const std::vector<std::size_t>& clusters) const;

	std::vector<std::uint64_t> m_bytes; // file contents; the reader points into them
	nook_volumes::Volumes m_volumes;
	nook_volumes::Frame m_frame;
	std::vector<std::size_t> m_before; // visible clusters that do not contain the eye
	std::vector<std::size_t> m_around; // visible clusters that do
	std::vector<nook_volumes::SeenCluster> m_seen;
	unsigned m_volume_program = 0;
	unsigned m_resolve_program = 0;
	unsigned m_vertices = 0;
	unsigned m_block = 0;
	unsigned m_clusters = 0;   // buffer
	unsigned m_textures[3]{};  // for the buffers: corners, polygons, clusters
	unsigned m_depth = 0;      // a copy: a depth texture cannot be tested and read at the same time
	unsigned m_sums = 0;       // R16F
	unsigned m_visibility = 0; // R8
	unsigned m_sum_frame = 0;
	unsigned m_visibility_frame = 0;
	int m_width = 0;
	int m_height = 0;
};
