// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/gl_context.h"

#include "core/error.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

namespace nook
{
namespace
{

[[noreturn]] void refuse(const std::string& what)
{
	std::array<char, 16> code{};
	std::snprintf(code.data(), code.size(), "0x%04X", static_cast<unsigned>(eglGetError()));
	throw Error(ExitCode::unsupported,
				"OpenGL: " + what + " (EGL error " + code.data() +
					"), expected a driver that offers OpenGL 3.3 or OpenGL ES 3.0 through EGL without a display");
}

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
		glGetShaderInfoLog(shader, static_cast<int>(log.size()) - 1, nullptr, log.data());
		glDeleteShader(shader);
		const std::string line(log.data());
		throw Error(ExitCode::runtime,
					"OpenGL: shader: found '" + line.substr(0, line.find('\n')) + "', expected one that compiles");
	}
	return shader;
}

void checkErrors()
{
	const unsigned code = glGetError();
	if (code != GL_NO_ERROR)
	{
		throw Error(ExitCode::runtime, "OpenGL: found error " + std::to_string(code) + ", expected none");
	}
}

// Three corners that cover the picture.
constexpr const char* kVertexSource = R"(void main()
{
	gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

} // namespace

GlContext::GlContext(GlApi api)
{
	if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless") &&
		!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base"))
	{
		refuse("found no EGL without a display");
	}
	m_display = epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")
					? eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)
					: eglGetDisplay(EGL_DEFAULT_DISPLAY);
	if (m_display == EGL_NO_DISPLAY || eglInitialize(m_display, nullptr, nullptr) == EGL_FALSE)
	{
		refuse("found no display");
	}
	if (eglBindAPI(api == GlApi::core ? EGL_OPENGL_API : EGL_OPENGL_ES_API) == EGL_FALSE)
	{
		refuse(api == GlApi::core ? "found no desktop OpenGL" : "found no OpenGL ES");
	}
	const std::array<EGLint, 7> core{
		EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
		EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
	const std::array<EGLint, 3> es{EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
	m_context = eglCreateContext(m_display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, api == GlApi::core ? core.data() : es.data());
	if (m_context == EGL_NO_CONTEXT || eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, m_context) == EGL_FALSE)
	{
		refuse("found no context");
	}
	if (api == GlApi::es && !epoxy_has_gl_extension("GL_EXT_color_buffer_float"))
	{
		refuse("found no pictures of floats");
	}
}

GlContext::~GlContext()
{
	eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
	eglDestroyContext(m_display, m_context);
	eglTerminate(m_display);
}

std::string GlContext::renderer() const
{
	const auto text = [](unsigned name)
	{
		return std::string(reinterpret_cast<const char*>(glGetString(name)));
	};
	return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

GlTexture::GlTexture(int width, int height, int channels, const float* values) : m_width(width), m_height(height)
{
	glGenTextures(1, &m_name);
	glBindTexture(GL_TEXTURE_2D, m_name);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
	glTexImage2D(GL_TEXTURE_2D, 0, channels == 1 ? GL_R32F : GL_RGBA32F, width, height, 0, channels == 1 ? GL_RED : GL_RGBA,
				 GL_FLOAT, values);
	checkErrors();
}

GlTexture::~GlTexture()
{
	glDeleteTextures(1, &m_name);
}

GlPass::GlPass(const std::string& fragment_source)
{
	const unsigned vertex = compiled(GL_VERTEX_SHADER, (epoxy_is_desktop_gl() ? "#version 330 core\n" : "#version 300 es\n") +
														   std::string(kVertexSource));
	const unsigned fragment = compiled(GL_FRAGMENT_SHADER, fragment_source);
	m_program = glCreateProgram();
	glAttachShader(m_program, vertex);
	glAttachShader(m_program, fragment);
	glLinkProgram(m_program);
	glDeleteShader(vertex);
	glDeleteShader(fragment);
	int good = 0;
	glGetProgramiv(m_program, GL_LINK_STATUS, &good);
	if (good == 0)
	{
		throw Error(ExitCode::runtime, "OpenGL: found a program that does not link, expected one that does");
	}
	glGenVertexArrays(1, &m_vertices);
	glGenBuffers(1, &m_block);
	glUseProgram(m_program);
}

GlPass::~GlPass()
{
	glDeleteBuffers(1, &m_block);
	glDeleteVertexArrays(1, &m_vertices);
	glDeleteProgram(m_program);
}

void GlPass::bind(const char* sampler, const GlTexture& texture)
{
	glUseProgram(m_program);
	glActiveTexture(GL_TEXTURE0 + static_cast<unsigned>(m_units));
	glBindTexture(GL_TEXTURE_2D, texture.name());
	glUniform1i(glGetUniformLocation(m_program, sampler), m_units);
	m_units += 1;
}

void GlPass::bindBlock(const char* block, std::span<const std::byte> bytes)
{
	glBindBuffer(GL_UNIFORM_BUFFER, m_block);
	glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STATIC_DRAW);
	glUniformBlockBinding(m_program, glGetUniformBlockIndex(m_program, block), 0);
	glBindBufferBase(GL_UNIFORM_BUFFER, 0, m_block);
	checkErrors();
}

double GlPass::draw(const GlTexture& target, std::vector<float>* values)
{
	unsigned frame = 0;
	glGenFramebuffers(1, &frame);
	glBindFramebuffer(GL_FRAMEBUFFER, frame);
	glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.name(), 0);
	glViewport(0, 0, target.width(), target.height());
	glBindVertexArray(m_vertices);
	glUseProgram(m_program);
	glFinish();
	const auto start = std::chrono::steady_clock::now();
	glDrawArrays(GL_TRIANGLES, 0, 3);
	glFinish();
	const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	if (values != nullptr)
	{
		values->resize(static_cast<std::size_t>(target.width()) * static_cast<std::size_t>(target.height()));
		glPixelStorei(GL_PACK_ALIGNMENT, 4);
		glReadPixels(0, 0, target.width(), target.height(), GL_RED, GL_FLOAT, values->data());
	}
	glDeleteFramebuffers(1, &frame);
	checkErrors();
	return seconds;
}

} // namespace nook
