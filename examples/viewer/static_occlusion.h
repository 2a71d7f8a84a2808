// SPDX-License-Identifier: MIT
// Everything that this program has to do with nook's volumes: a file of `nook volumes`, a depth buffer and normals → visibility of
// the level's own surfaces, by the stages that nook emitted.
#pragma once

#include <glm/mat4x4.hpp>

#include <nook/nook_volumes_draw.h>

#include <cstdint>
#include <string>
#include <vector>

class StaticOcclusion
{
public:
	// Needs a current context, as all else here; what it makes there goes with the context. Throws Failure.
	explicit StaticOcclusion(const std::string& path);

	void resize(int width, int height);

	struct Input
	{
		unsigned depth = 0;       // texture: a depth buffer as it is, GL_DEPTH_COMPONENT32F
		unsigned depth_frame = 0; // that it is part of
		unsigned normals = 0;     // texture: unit, in view space
		bool reversed = false;    // 1 near, 0 far, z_ndc from 0 to 1
		glm::mat4 camera_from_world{1.0f};
		glm::mat4 projection{1.0f};
	};
	// Returns a texture, R8: 1 where open. Throws Failure for a camera that the shaders do not take.
	unsigned draw(const Input& input);

	std::size_t volumesDrawn() const;

private:
	void drawVolumes(const Input& input);
	void drawClusters(const std::vector<std::size_t>& clusters) const;

	std::vector<std::uint64_t> m_bytes; // of the file; the reader points into them
	nook_volumes::Volumes m_volumes;
	nook_volumes::Frame m_frame;
	std::vector<std::size_t> m_before; // clusters in sight that do not hold the eye
	std::vector<std::size_t> m_around; // that do
	std::vector<nook_volumes::SeenCluster> m_seen;
	unsigned m_volume_program = 0;
	unsigned m_resolve_program = 0;
	unsigned m_vertices = 0;
	unsigned m_block = 0;
	unsigned m_clusters = 0;   // buffer
	unsigned m_textures[3]{};  // of the buffers: corners, polygons, clusters
	unsigned m_depth = 0;      // a copy: a texture cannot be tested against and be read
	unsigned m_sums = 0;       // R16F
	unsigned m_visibility = 0; // R8
	unsigned m_sum_frame = 0;
	unsigned m_visibility_frame = 0;
	int m_width = 0;
	int m_height = 0;
};
