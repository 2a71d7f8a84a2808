// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/gl_parts.h"

#include "core/error.h"

#include <epoxy/gl.h>

#include <array>
#include <chrono>
#include <cstdint>

namespace nook
{

unsigned compiledShader(unsigned kind, const std::string& source)
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
		glGetShaderInfoLog(shader, static_cast<int>(log.size()) - 1, nullptr, log.data());
		glDeleteShader(shader);
		std::string line(log.data());
		line = line.substr(line.find("error") == std::string::npos ? 0 : line.rfind('\n', line.find("error")) + 1); // not a warning
		throw Error(ExitCode::runtime,
					"OpenGL: shader: found '" + line.substr(0, line.find('\n')) + "', expected one that compiles");
	}
	return shader;
}

unsigned linkedProgram(const std::vector<unsigned>& shaders)
{
	const unsigned program = glCreateProgram();
	for (const unsigned shader : shaders)
	{
		glAttachShader(program, shader);
	}
	glLinkProgram(program);
	for (const unsigned shader : shaders)
	{
		glDeleteShader(shader);
	}
	int good = 0;
	glGetProgramiv(program, GL_LINK_STATUS, &good);
	if (good == 0)
	{
		glDeleteProgram(program);
		throw Error(ExitCode::runtime, "OpenGL: found a program that does not link, expected one that does");
	}
	return program;
}

void checkGlErrors()
{
	const unsigned code = glGetError();
	if (code != GL_NO_ERROR)
	{
		throw Error(ExitCode::runtime, "OpenGL: found error " + std::to_string(code) + ", expected none");
	}
}

double secondsOf(const std::function<void()>& commands, bool timer)
{
	unsigned query = 0;
	if (timer)
	{
		glGenQueries(1, &query);
	}
	glFinish();
	const auto start = std::chrono::steady_clock::now();
	if (timer)
	{
		glBeginQuery(GL_TIME_ELAPSED, query);
	}
	commands();
	if (timer)
	{
		glEndQuery(GL_TIME_ELAPSED);
	}
	glFinish();
	double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	if (timer)
	{
		std::uint64_t nanoseconds = 0;
		glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
		seconds = 1e-9 * static_cast<double>(nanoseconds);
		glDeleteQueries(1, &query);
	}
	checkGlErrors();
	return seconds;
}

} // namespace nook
