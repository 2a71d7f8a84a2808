// SPDX-License-Identifier: MIT
#include "gl.h"

#include "level_file.h"

#include <array>

namespace
{

unsigned compiled(unsigned kind, const std::string& source)
{
	const unsigned shader = glCreateShader(kind);
	const char* const text = source.c_str();
	glShaderSource(shader, 1, &text, nullptr);
	glCompileShader(shader);
	int good = 0;
	glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
	if (good == 0)
	{
		std::array<char, 512> log{};
		glGetShaderInfoLog(shader, static_cast<int>(log.size()), nullptr, log.data());
		const std::string lines = log.data();
		throw Failure(4, "OpenGL: shader: " + lines.substr(0, lines.find('\n')));
	}
	return shader;
}

} // namespace

unsigned programOf(const std::string& vertex_source, const std::string& fragment_source)
{
	const unsigned program = glCreateProgram();
	for (const unsigned shader : {compiled(GL_VERTEX_SHADER, vertex_source), compiled(GL_FRAGMENT_SHADER, fragment_source)})
	{
		glAttachShader(program, shader);
		glDeleteShader(shader);
	}
	glLinkProgram(program);
	int good = 0;
	glGetProgramiv(program, GL_LINK_STATUS, &good);
	if (good == 0)
	{
		throw Failure(4, "OpenGL: found a program that does not link");
	}
	return program;
}

unsigned screenProgram(const std::string& fragment_source)
{
	return programOf(R"(#version 330 core
void main()
{
	gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)",
					 fragment_source);
}

unsigned screenTexture(int format, int width, int height, const float* values)
{
	unsigned texture = 0;
	glGenTextures(1, &texture);
	glBindTexture(GL_TEXTURE_2D, texture);
	const bool depth = format == GL_DEPTH_COMPONENT32F;
	glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, depth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT, values);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	return texture;
}

unsigned frameOf(unsigned color, unsigned depth, int color_level)
{
	unsigned frame = 0;
	glGenFramebuffers(1, &frame);
	glBindFramebuffer(GL_FRAMEBUFFER, frame);
	glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, color_level);
	glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
	if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
	{
		throw Failure(4, "OpenGL: found a framebuffer that is not complete");
	}
	return frame;
}

void bindTexture(unsigned program, const char* sampler, int unit, unsigned texture)
{
	glActiveTexture(GL_TEXTURE0 + static_cast<unsigned>(unit));
	glBindTexture(GL_TEXTURE_2D, texture);
	glUniform1i(glGetUniformLocation(program, sampler), unit);
}
