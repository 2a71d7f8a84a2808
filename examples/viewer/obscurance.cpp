// SPDX-License-Identifier: MIT
#include "obscurance.h"

#include "gl.h"
#include "level_file.h"

#include <viewer_disk.glsl.h>      // the module as a string, viewer_disk_glsl
#include <viewer_disk.h>           // nook_block, nook_fill, and the texels of the tiles
#include <viewer_disk_half.glsl.h> // viewer_disk_half_glsl
#include <viewer_points.glsl.h>    // likewise for methods with point samples
#include <viewer_points.h>
#include <viewer_points_half.glsl.h>

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

const Obscurance::Pass Obscurance::kMoments{"nookMoments(pixel)", false, "vec4"};

const std::vector<Obscurance::Method>& Obscurance::methods()
{
#define METHOD(name, function, module, tile, moments, settings)                                                                    \
	{name, function, module##_glsl, module##_half_glsl, moments != 0, #tile, tile##_width, tile##_height, tile, settings},
	static const std::vector<Method> rows{
#include <viewer_methods.h>
	};
#undef METHOD
	return rows;
}

Obscurance::Obscurance()
{
	for (const Method& method : methods())
	{
		m_tiles[method.tile] = screenTexture(GL_RGBA32F, method.tile_width, method.tile_height, &method.texels[0][0]);
	}
	glGenBuffers(1, &m_block);
	glGenVertexArrays(1, &m_vertices);
	glGenQueries(2, m_timers.data());
}

Obscurance::Target Obscurance::targetOf(int format, int width, int height)
{
	const unsigned picture = screenTexture(format, width, height);
	return {picture, frameOf(picture), width, height};
}

void Obscurance::drop(const Target& target)
{
	glDeleteTextures(1, &target.picture);
	glDeleteFramebuffers(1, &target.frame);
}

void Obscurance::resize(int width, int height)
{
	m_width = width;
	m_height = height;
	for (Target& target : m_full)
	{
		drop(target);
		target = targetOf(GL_R8, width, height);
	}
	for (Target& target : m_half)
	{
		drop(target);
		const bool cells = &target != &m_half.back();
		const int format = &target == &m_half[1] ? GL_RGBA32F : GL_R8; // read by upsampling
		target = cells ? targetOf(format, (width + 1) / 2, (height + 1) / 2) : targetOf(format, width, height);
	}
	resizeMoments();
}

// Half the picture's size, rounded up to a multiple of the last level's texels.
void Obscurance::resizeMoments()
{
	const auto side = [](int pixels)
	{
		constexpr int kLast = 1 << kMomentLevels;
		return (pixels + kLast - 1) / kLast * kLast / 2;
	};
	glDeleteTextures(1, &m_moments);
	glGenTextures(1, &m_moments);
	glBindTexture(GL_TEXTURE_2D, m_moments);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, kMomentLevels - 1);
	for (std::size_t level = 0; level < m_levels.size(); ++level)
	{
		const int number = static_cast<int>(level);
		Target& target = m_levels[level];
		glDeleteFramebuffers(1, &target.frame);
		target.width = side(m_width) >> number;
		target.height = side(m_height) >> number;
		glTexImage2D(GL_TEXTURE_2D, number, GL_RGBA32F, target.width, target.height, 0, GL_RGBA, GL_FLOAT, nullptr);
	}
	for (std::size_t level = 0; level < m_levels.size(); ++level) // of a complete texture
	{
		m_levels[level].frame = frameOf(m_moments, 0, static_cast<int>(level));
	}
}

unsigned Obscurance::draw(const Method& method, const Input& input, bool half)
{
	float projection[16];
	std::copy_n(glm::value_ptr(input.projection), 16, projection);
	nook_settings settings = method.settings(input.radius_m); // fitted to rays, for a module of device depth
	settings.width = m_width;
	settings.height = m_height;
	settings.zero_to_one = input.reversed;
	settings.frame = input.frame % (1 << 24); // selects the tile's samples; the module knows the cycle's length
	nook_block block;
	if (const char* const reason = nook_fill(block, projection, settings))
	{
		throw Failure(3, reason);
	}
	glBindBuffer(GL_UNIFORM_BUFFER, m_block);
	glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_DYNAMIC_DRAW);
	glBindBufferBase(GL_UNIFORM_BUFFER, 0, m_block);
	glBindVertexArray(m_vertices);
	glDisable(GL_DEPTH_TEST);
	// The method, the mean over its window, and for half resolution the upsampling.
	const std::string function = method.function;
	std::vector<Pass> passes{{function + "(pixel)", half}, {"nookWindow(pixel)", half}};
	if (half)
	{
		passes = {{function + "(2 * pixel)", half}, {"nookWindowOfSurface(pixel)", half, "vec4"}, {function + "Full(pixel)", half}};
	}
	for (const Pass& pass : passes) // compile before timing starts
	{
		programFor(method, pass);
	}
	if (method.moments)
	{
		programFor(method, kMoments);
	}
	const Target* const targets = half ? m_half.data() : m_full.data();
	glBeginQuery(GL_TIME_ELAPSED, m_timers[m_drawn % 2]);
	if (method.moments)
	{
		drawMoments(method, input);
	}
	for (std::size_t i = 0; i < passes.size(); ++i)
	{
		run(passes[i], input, method, targets[i], i == 0 ? 0 : targets[i - 1].picture);
	}
	glEndQuery(GL_TIME_ELAPSED);
	m_drawn += 1;
	return targets[passes.size() - 1].picture;
}

// Draws a level from the previous one; until then, the texture ends before it.
void Obscurance::drawMoments(const Method& method, const Input& input)
{
	for (std::size_t level = 0; level < m_levels.size(); ++level)
	{
		const int number = static_cast<int>(level);
		glBindTexture(GL_TEXTURE_2D, m_moments);
		glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, number == 0 ? 0 : number - 1);
		const unsigned program = programFor(method, kMoments);
		begin(program, input, m_levels[level]);
		bindTexture(program, "nook_levels", 4, number == 0 ? 0 : m_moments);
		glUniform4i(glGetUniformLocation(program, "nook_pass"), number, 0, 0, 0);
		glDrawArrays(GL_TRIANGLES, 0, 3);
	}
	glBindTexture(GL_TEXTURE_2D, m_moments);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, kMomentLevels - 1);
}

void Obscurance::run(const Pass& pass, const Input& input, const Method& method, const Target& target, unsigned cells)
{
	const unsigned program = programFor(method, pass);
	begin(program, input, target);
	bindTexture(program, method.tile, 2, m_tiles.at(method.tile));
	bindTexture(program, "nook_cells", 3, cells);
	bindTexture(program, "nook_packed", 3, cells);
	bindTexture(program, "nook_levels", 4, method.moments ? m_moments : 0);
	glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Obscurance::begin(unsigned program, const Input& input, const Target& target)
{
	glBindFramebuffer(GL_FRAMEBUFFER, target.frame);
	glViewport(0, 0, target.width, target.height);
	glUseProgram(program);
	bindTexture(program, "nook_depths", 0, input.depth);
	bindTexture(program, "nook_normals", 1, input.normals);
	glUniformBlockBinding(program, glGetUniformBlockIndex(program, "nook_block"), 0);
}

unsigned Obscurance::programFor(const Method& method, const Pass& pass)
{
	const char* const module = pass.half ? method.half_module : method.module;
	unsigned& program = m_programs[{module, pass.call}];
	if (program == 0)
	{
		program =
			screenProgram(std::string("#version 330 core\n") + module + "out " + pass.type +
						  " value;\nvoid main()\n{\n\tivec2 pixel = ivec2(gl_FragCoord.xy);\n\tvalue = " + pass.call + ";\n}\n");
	}
	return program;
}

double Obscurance::milliseconds() const
{
	GLuint64 nanoseconds = 0;
	glGetQueryObjectui64v(m_timers[m_drawn < 2 ? 0 : m_drawn % 2], GL_QUERY_RESULT, &nanoseconds);
	return 1e-6 * static_cast<double>(nanoseconds);
}
