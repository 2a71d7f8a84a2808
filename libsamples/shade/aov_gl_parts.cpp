// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/aov_gl_parts.h"

#include "core/error.h"
#include "methods/depth_format.h"
#include "methods/kernels.h"
#include "shade/gl_context.h"
#include "shade/gl_parts.h"

#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace nook
{

GlArray::GlArray(std::span<const std::byte> bytes, unsigned format, std::size_t texel)
{
	int most = 0;
	glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
	if (bytes.size() / texel > static_cast<std::size_t>(most))
	{
		throw Error(ExitCode::unsupported, "OpenGL: found " + std::to_string(bytes.size() / texel) +
											   " corners, polygons or clusters of volumes, expected at most " +
											   std::to_string(most));
	}
	glGenBuffers(1, &m_buffer);
	glGenTextures(1, &m_texture);
	glBindBuffer(GL_TEXTURE_BUFFER, m_buffer);
	glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(std::max(bytes.size(), texel)), nullptr, GL_STATIC_DRAW);
	glBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
	glActiveTexture(GL_TEXTURE15);
	glBindTexture(GL_TEXTURE_BUFFER, m_texture);
	glTexBuffer(GL_TEXTURE_BUFFER, format, m_buffer);
	checkGlErrors();
}

GlArray::~GlArray()
{
	glDeleteTextures(1, &m_texture);
	glDeleteBuffers(1, &m_buffer);
}

void GlArray::bindTexture(unsigned unit) const
{
	glActiveTexture(GL_TEXTURE0 + unit);
	glBindTexture(GL_TEXTURE_BUFFER, m_texture);
}

void GlArray::bindStorage(unsigned binding) const
{
	glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, m_buffer);
}

GlProgram::GlProgram(const std::string& vertex, const std::string& fragment)
	: m_name(linkedProgram({compiledShader(GL_VERTEX_SHADER, vertex), compiledShader(GL_FRAGMENT_SHADER, fragment)}))
{
	const unsigned block = glGetUniformBlockIndex(m_name, "NookVolumes");
	if (block != GL_INVALID_INDEX)
	{
		glUniformBlockBinding(m_name, block, 0);
	}
	glUseProgram(m_name);
	for (std::size_t i = 0; i < kAovUnits.size(); ++i)
	{
		glUniform1i(glGetUniformLocation(m_name, kAovUnits[i]), static_cast<int>(i));
	}
	checkGlErrors();
}

GlProgram::~GlProgram()
{
	glDeleteProgram(m_name);
}

GlTarget::GlTarget(unsigned stored, unsigned channels, unsigned type, int width, int height)
{
	glGenTextures(1, &m_name);
	glActiveTexture(GL_TEXTURE15);
	glBindTexture(GL_TEXTURE_2D, m_name);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	glTexImage2D(GL_TEXTURE_2D, 0, static_cast<int>(stored), width, height, 0, channels, type, nullptr);
	checkGlErrors();
}

GlTarget::~GlTarget()
{
	glDeleteTextures(1, &m_name);
}

GlFrame::GlFrame(std::span<const unsigned> colours, unsigned depth)
{
	glGenFramebuffers(1, &m_name);
	glBindFramebuffer(GL_FRAMEBUFFER, m_name);
	std::vector<unsigned> places;
	for (const unsigned colour : colours)
	{
		places.push_back(GL_COLOR_ATTACHMENT0 + static_cast<unsigned>(places.size()));
		glFramebufferTexture2D(GL_FRAMEBUFFER, places.back(), GL_TEXTURE_2D, colour, 0);
	}
	glDrawBuffers(static_cast<int>(places.size()), places.data());
	if (depth != 0)
	{
		glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
	}
	if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
	{
		glDeleteFramebuffers(1, &m_name);
		throw Error(ExitCode::unsupported, "OpenGL: found no pictures of that format to draw into, expected some");
	}
}

GlFrame::~GlFrame()
{
	glDeleteFramebuffers(1, &m_name);
}

void GlFrame::use() const
{
	glBindFramebuffer(GL_FRAMEBUFFER, m_name);
}

nook_volumes::Header headerOf(const VolumeSet& volumes, bool compensate)
{
	nook_volumes::Header header{};
	header.version = nook_volumes::kVersion;
	header.flags = volumes.exact_bounds ? nook_volumes::kExactBounds : 0;
	header.distance = volumes.distance_m;
	header.ray_distance = volumes.ray_distance_m;
	header.plane_error = volumes.plane_error_m;
	header.sum_range = compensate ? volumes.compensation.range : 1.0;
	for (std::size_t i = 0; i < nook_volumes::kKnots; ++i)
	{
		const double place = static_cast<double>(i) / static_cast<double>(nook_volumes::kKnots - 1);
		header.occlusion[i] = compensate ? volumes.compensation.occlusion[i] : place;
	}
	return header;
}

nook_volumes::Camera cameraOf(const GBuffer& gbuffer, int every_px)
{
	nook_volumes::Camera camera;
	std::copy_n(glm::value_ptr(gbuffer.view.camera_from_world), 16, camera.camera_from_world);
	std::copy_n(glm::value_ptr(gbuffer.view.projection), 16, camera.projection);
	camera.width = gbuffer.width_px;
	camera.height = gbuffer.height_px;
	camera.every = every_px;
	camera.position_error = gbuffer.view_error_m;
	if (!gbuffer.depth_error_m.empty())
	{
		ShadeBlock block;
		block.w_slope = static_cast<float>(-camera.projection[11]);
		block.w_start = static_cast<float>(camera.projection[15]);
		fillMeasuredError(block, gbuffer.depth, gbuffer.depth_error_m);
		camera.depth_step = static_cast<double>(block.depth_step);
		camera.depth_share = std::max(static_cast<double>(block.depth_share), camera.depth_share);
	}
	double nearest = std::numeric_limits<double>::infinity();
	double farthest = 0.0;
	for (const float depth : gbuffer.depth)
	{
		if (std::isfinite(depth))
		{
			nearest = std::min(nearest, static_cast<double>(depth));
			farthest = std::max(farthest, static_cast<double>(depth));
		}
	}
	nearest = std::min(nearest, 1e15); // all is sky
	camera.nearest = nearest * (1.0 - 1e-6);
	camera.farthest = std::max(farthest, nearest) * (1.0 + 1e-6);
	// Rows run downward, so y does, too. z = a · depth + b is −w at the nearest depth and w at the farthest.
	double* const p = camera.projection;
	for (int column = 0; column < 4; ++column)
	{
		p[4 * column + 1] = -p[4 * column + 1];
		p[4 * column + 2] = 0.0;
	}
	const double least = -p[11] * camera.nearest + p[15];
	const double most = -p[11] * camera.farthest + p[15];
	const double a = (least + most) / (camera.farthest - camera.nearest);
	p[10] = -a;
	p[14] = -least - a * camera.nearest;
	return camera;
}

} // namespace nook
