// SPDX-License-Identifier: MIT
#include "obscurance.h"

#include "gl.h"
#include "level_file.h"

#include <viewer_ao.glsl.h> // the module as a string, viewer_ao_glsl
#include <viewer_ao.h>      // nook_block, nook_fill, and the texels of the tiles

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

namespace
{

std::string passSource(const std::string& function)
{
	return std::string("#version 330 core\n") + viewer_ao_glsl +
		   "out float visibility;\nvoid main()\n{\n\tvisibility = " + function + "(ivec2(gl_FragCoord.xy));\n}\n";
}

} // namespace

const std::vector<Obscurance::Method>& Obscurance::methods()
{
	static const std::vector<Method> rows{
		{"vo-line",
		 {"nookVoLine", "nookWindow"},
		 "nook_vo_line_tile",
		 nook_vo_line_tile_width,
		 nook_vo_line_tile_height,
		 nook_vo_line_tile},
		{"vo-point",
		 {"nookVoPoint", "nookWindow"},
		 "nook_vo_point_tile",
		 nook_vo_point_tile_width,
		 nook_vo_point_tile_height,
		 nook_vo_point_tile},
		{"alchemy",
		 {"nookAlchemy", "nookWindow"},
		 "nook_alchemy_tile",
		 nook_alchemy_tile_width,
		 nook_alchemy_tile_height,
		 nook_alchemy_tile},
	};
	return rows;
}

Obscurance::Obscurance()
{
	for (const Method& method : methods())
	{
		for (const char* const function : method.passes)
		{
			unsigned& program = m_programs[function];
			program = program != 0 ? program : screenProgram(passSource(function));
		}
		m_tiles[method.tile] = screenTexture(GL_RGBA32F, method.tile_width, method.tile_height, &method.texels[0][0]);
	}
	glGenBuffers(1, &m_block);
	glGenVertexArrays(1, &m_vertices);
	glGenQueries(2, m_timers.data());
}

void Obscurance::resize(int width, int height)
{
	m_width = width;
	m_height = height;
	glDeleteTextures(2, m_pictures.data());
	glDeleteFramebuffers(2, m_frames.data());
	for (std::size_t i = 0; i < 2; ++i)
	{
		m_pictures[i] = screenTexture(GL_R8, width, height);
		m_frames[i] = frameOf(m_pictures[i]);
	}
}

unsigned Obscurance::draw(const Method& method, const Input& input)
{
	float projection[16];
	std::copy_n(glm::value_ptr(input.projection), 16, projection);
	nook_settings settings;
	settings.width = m_width;
	settings.height = m_height;
	settings.radius = input.radius_m;
	settings.device_depth = true; // the module reads a depth buffer as it is
	settings.zero_to_one = input.reversed;
	nook_block block;
	if (!nook_fill(block, projection, settings))
	{
		throw Failure(3, "projection: found a skew or no radius, expected what nook_fill takes");
	}
	glBindBuffer(GL_UNIFORM_BUFFER, m_block);
	glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_DYNAMIC_DRAW);
	glBindBufferBase(GL_UNIFORM_BUFFER, 0, m_block);
	glBindVertexArray(m_vertices);
	glDisable(GL_DEPTH_TEST);
	glViewport(0, 0, m_width, m_height);
	glBeginQuery(GL_TIME_ELAPSED, m_timers[m_drawn % 2]);
	for (std::size_t i = 0; i < method.passes.size(); ++i)
	{
		run(m_programs.at(method.passes[i]), input, method, i % 2);
	}
	glEndQuery(GL_TIME_ELAPSED);
	m_drawn += 1;
	return m_pictures[(method.passes.size() - 1) % 2];
}

void Obscurance::run(unsigned program, const Input& input, const Method& method, std::size_t target)
{
	glBindFramebuffer(GL_FRAMEBUFFER, m_frames[target]);
	glUseProgram(program);
	bindTexture(program, "nook_depths", 0, input.depth);
	bindTexture(program, "nook_normals", 1, input.normals);
	bindTexture(program, method.tile, 2, m_tiles.at(method.tile));
	bindTexture(program, "nook_cells", 3, m_pictures[1 - target]);
	glUniformBlockBinding(program, glGetUniformBlockIndex(program, "nook_block"), 0);
	glDrawArrays(GL_TRIANGLES, 0, 3);
}

double Obscurance::milliseconds() const
{
	GLuint64 nanoseconds = 0;
	glGetQueryObjectui64v(m_timers[m_drawn < 2 ? 0 : m_drawn % 2], GL_QUERY_RESULT, &nanoseconds);
	return 1e-6 * static_cast<double>(nanoseconds);
}
