// SPDX-License-Identifier: MIT
#include "static_occlusion.h"

#include "gl.h"
#include "level_file.h"

#include <viewer_volumes.glsl.h> // the stages as a string, viewer_volumes_glsl

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <fstream>

namespace
{

// A buffer and its buffer texture.
unsigned arrayTexture(unsigned format, const void* items, std::size_t bytes, unsigned& buffer)
{
	unsigned texture = 0;
	glGenBuffers(1, &buffer);
	glBindBuffer(GL_TEXTURE_BUFFER, buffer);
	glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(bytes), items, GL_STATIC_DRAW);
	glGenTextures(1, &texture);
	glBindTexture(GL_TEXTURE_BUFFER, texture);
	glTexBuffer(GL_TEXTURE_BUFFER, format, buffer);
	return texture;
}

std::vector<std::uint64_t> bytesOf(const std::string& path, std::size_t& size)
{
	std::ifstream file(path, std::ios::binary | std::ios::ate);
	size = file ? static_cast<std::size_t>(file.tellg()) : 0;
	std::vector<std::uint64_t> bytes((size + 7) / 8);
	file.seekg(0);
	if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
	{
		throw Failure(2, path + ": cannot be read");
	}
	return bytes;
}

std::string stage(const char* name)
{
	return std::string("#version 330 core\n#define ") + name + "\n" + viewer_volumes_glsl;
}

} // namespace

StaticOcclusion::StaticOcclusion(const std::string& path)
{
	std::size_t size = 0;
	m_bytes = bytesOf(path, size);
	if (const char* const problem = m_volumes.open(m_bytes.data(), size))
	{
		throw Failure(3, path + ": found " + problem + ", expected a file of nook volumes, not compressed");
	}
	int most = 0;
	glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
	// One texel per corner or polygon, of which there are fewer; four per cluster.
	const std::size_t texels = std::max<std::size_t>(m_volumes.cornerCount(), 4 * m_volumes.clusterCount());
	if (texels > static_cast<std::size_t>(most))
	{
		throw Failure(5, path + ": found volumes that take " + std::to_string(texels) +
							 " texels of a buffer texture, expected at most " + std::to_string(most));
	}
	unsigned buffer = 0;
	m_textures[0] = arrayTexture(GL_RGBA16UI, m_volumes.corners(), 8 * m_volumes.cornerCount(), buffer);
	m_textures[1] = arrayTexture(GL_RG32UI, m_volumes.polygons(), 8 * m_volumes.polygonCount(), buffer);
	m_textures[2] = arrayTexture(GL_RGBA32UI, nullptr, sizeof(nook_volumes::SeenCluster) * m_volumes.clusterCount(), m_clusters);
	m_volume_program = programOf(stage("NOOK_VERTEX"), stage("NOOK_FRAGMENT"));
	m_resolve_program = screenProgram(stage("NOOK_RESOLVE"));
	glGenVertexArrays(1, &m_vertices);
	glGenBuffers(1, &m_block);
}

void StaticOcclusion::resize(int width, int height)
{
	m_width = width;
	m_height = height;
	for (unsigned* const texture : {&m_depth, &m_sums, &m_visibility})
	{
		glDeleteTextures(1, texture);
	}
	for (unsigned* const frame : {&m_sum_frame, &m_visibility_frame})
	{
		glDeleteFramebuffers(1, frame);
	}
	m_depth = screenTexture(GL_DEPTH_COMPONENT32F, width, height);
	m_sums = screenTexture(GL_R16F, width, height);
	m_visibility = screenTexture(GL_R8, width, height);
	m_sum_frame = frameOf(m_sums, m_depth);
	m_visibility_frame = frameOf(m_visibility);
}

unsigned StaticOcclusion::draw(const Input& input)
{
	nook_volumes::Camera camera;
	std::copy_n(glm::value_ptr(input.camera_from_world), 16, camera.camera_from_world);
	std::copy_n(glm::value_ptr(input.projection), 16, camera.projection);
	camera.width = m_width;
	camera.height = m_height;
	camera.zero_to_one = input.reversed;
	if (const char* const problem = m_frame.set(m_volumes.header(), camera))
	{
		throw Failure(3, std::string("camera: found ") + problem);
	}
	m_before.clear();
	m_around.clear();
	m_seen.clear();
	for (std::size_t i = 0; i < m_volumes.clusterCount(); ++i)
	{
		const nook_volumes::Cluster& cluster = m_volumes.clusters()[i];
		m_seen.push_back(m_frame.seen(cluster));
		if (m_frame.inSight(cluster))
		{
			(m_frame.holdsEye(cluster) ? m_around : m_before).push_back(i);
		}
	}
	glBindBuffer(GL_TEXTURE_BUFFER, m_clusters);
	glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(m_seen.size() * sizeof m_seen[0]), m_seen.data(), GL_STREAM_DRAW);
	glBindBuffer(GL_UNIFORM_BUFFER, m_block);
	glBufferData(GL_UNIFORM_BUFFER, sizeof m_frame.block, &m_frame.block, GL_STREAM_DRAW);
	glBindBufferBase(GL_UNIFORM_BUFFER, 1, m_block);
	glBindVertexArray(m_vertices);
	glViewport(0, 0, m_width, m_height);
	drawVolumes(input);

	glBindFramebuffer(GL_FRAMEBUFFER, m_visibility_frame);
	glUseProgram(m_resolve_program);
	glUniformBlockBinding(m_resolve_program, glGetUniformBlockIndex(m_resolve_program, "NookVolumes"), 1);
	bindTexture(m_resolve_program, "nook_sums", 0, m_sums);
	glDrawArrays(GL_TRIANGLES, 0, 3);
	return m_visibility;
}

void StaticOcclusion::drawVolumes(const Input& input)
{
	glBindFramebuffer(GL_READ_FRAMEBUFFER, input.depth_frame);
	glBindFramebuffer(GL_DRAW_FRAMEBUFFER, m_sum_frame);
	glDisable(GL_DEPTH_TEST);
	glBlitFramebuffer(0, 0, m_width, m_height, 0, 0, m_width, m_height, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
	glBindFramebuffer(GL_FRAMEBUFFER, m_sum_frame);
	const float none[4] = {};
	glClearBufferfv(GL_COLOR, 0, none);
	glUseProgram(m_volume_program);
	glUniformBlockBinding(m_volume_program, glGetUniformBlockIndex(m_volume_program, "NookVolumes"), 1);
	bindTexture(m_volume_program, "nook_depths", 0, input.depth);
	bindTexture(m_volume_program, "nook_normals", 1, input.normals);
	const char* const names[3] = {"nook_corners", "nook_polygons", "nook_clusters"};
	for (int i = 0; i < 3; ++i)
	{
		glActiveTexture(GL_TEXTURE0 + static_cast<unsigned>(2 + i));
		glBindTexture(GL_TEXTURE_BUFFER, m_textures[i]);
		glUniform1i(glGetUniformLocation(m_volume_program, names[i]), 2 + i);
	}
	glEnable(GL_DEPTH_TEST);
	glDepthMask(GL_FALSE);
	glEnable(GL_DEPTH_CLAMP);
	glEnable(GL_CULL_FACE);
	glFrontFace(m_frame.mirrored() ? GL_CW : GL_CCW);
	glEnable(GL_BLEND);
	glBlendFunc(GL_ONE, GL_ONE);
	glCullFace(GL_BACK);
	glDepthFunc(input.reversed ? GL_GEQUAL : GL_LEQUAL);
	drawClusters(m_before);
	glCullFace(GL_FRONT);
	glDepthFunc(input.reversed ? GL_LEQUAL : GL_GEQUAL);
	drawClusters(m_around);
	glDisable(GL_BLEND);
	glDisable(GL_CULL_FACE);
	glDisable(GL_DEPTH_CLAMP);
	glDepthMask(GL_TRUE);
	glDisable(GL_DEPTH_TEST);
}

void StaticOcclusion::drawClusters(const std::vector<std::size_t>& clusters) const
{
	for (const std::size_t i : clusters)
	{
		const nook_volumes::Cluster& cluster = m_volumes.clusters()[i];
		glVertexAttribI1i(0, static_cast<int>(i));
		glDrawArrays(GL_TRIANGLES, static_cast<int>(12 * cluster.first_corner), static_cast<int>(12 * cluster.corner_count));
	}
}

std::size_t StaticOcclusion::volumesDrawn() const
{
	std::size_t count = 0;
	for (const std::vector<std::size_t>* const some : {&m_before, &m_around})
	{
		for (const std::size_t i : *some)
		{
			count += m_volumes.clusters()[i].polygon_count;
		}
	}
	return count;
}
