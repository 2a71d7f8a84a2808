// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/gl_context.h"

#include "core/error.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <dlfcn.h>

namespace nook
{

namespace
{

void requireEgl(bool works, const std::string& what)
{
	if (works)
	{
		return;
	}
	std::array<char, 16> code{};
	std::snprintf(code.data(), code.size(), "0x%04X", static_cast<unsigned>(eglGetError()));
	throw Error(ExitCode::unsupported,
				"OpenGL: " + what + " (EGL error " + code.data() +
					"), expected a driver that offers OpenGL 3.3 or OpenGL ES 3.0 through EGL without a display");
}

bool opens(const char* library)
{
	return dlopen(library, RTLD_LAZY | RTLD_LOCAL) != nullptr; // stays open, since libepoxy opens it next
}

// libepoxy loads these on their first call and terminates the process if it cannot.
void requireLibraries(GlApi api)
{
	const char* const missing = !opens("libEGL.so.1")                                                    ? "libEGL.so.1"
								: api == GlApi::es && !opens("libGLESv2.so.2")                           ? "libGLESv2.so.2"
								: api == GlApi::core && !opens("libOpenGL.so.0") && !opens("libGL.so.1") ? "libOpenGL.so.0"
																										 : nullptr;
	if (missing != nullptr)
	{
		throw Error(ExitCode::unsupported,
					std::string("OpenGL: found no library ") + missing +
						", expected a driver that offers OpenGL through EGL (Debian: libegl1, libopengl0, libgles2)");
	}
}

EGLDisplay anyDisplay()
{
	if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
	{
		return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
	}
	requireEgl(epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base"), "found no EGL without a display");
	return eglGetDisplay(EGL_DEFAULT_DISPLAY);
}

// EGL's list; none where EGL has no list.
std::optional<std::vector<EGLDeviceEXT>> listedDevices()
{
	if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") ||
		!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device"))
	{
		return std::nullopt;
	}
	EGLint count = 0;
	eglQueryDevicesEXT(0, nullptr, &count);
	std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(std::max(count, 0)));
	eglQueryDevicesEXT(count, devices.data(), &count);
	devices.resize(static_cast<std::size_t>(std::max(count, 0)));
	return devices;
}

EGLDisplay displayOf(int device)
{
	const std::optional<std::vector<EGLDeviceEXT>> devices = listedDevices();
	requireEgl(devices.has_value(), "found no list of devices");
	refuseIf(device < 0 || static_cast<std::size_t>(device) >= devices->size(),
			 "OpenGL: found no device " + std::to_string(device) + ", expected one of the " + std::to_string(devices->size()) +
				 " that EGL lists, from 0",
			 ExitCode::unsupported);
	return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, (*devices)[static_cast<std::size_t>(device)], nullptr);
}

// The first listed device that is no software renderer and opens; otherwise the driver's choice. Where several vendors are
// installed, that choice may be Mesa's software renderer although there is a GPU.
EGLDisplay chosenDisplay()
{
	for (const EGLDeviceEXT device : listedDevices().value_or(std::vector<EGLDeviceEXT>{}))
	{
		const char* const extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
		if (extensions != nullptr && std::string(extensions).find("EGL_MESA_device_software") != std::string::npos)
		{
			continue;
		}
		const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
		if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) != EGL_FALSE)
		{
			return display;
		}
	}
	return anyDisplay();
}

struct GlFormat
{
	int stored;
	unsigned channels;
	unsigned type;
};

GlFormat formatOf(PictureFormat format)
{
	switch (format)
	{
	case PictureFormat::scalar: return {GL_R32F, GL_RED, GL_FLOAT};
	case PictureFormat::quad: return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
	case PictureFormat::counts: break;
	}
	return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT};
}

// A triangle that covers the picture.
constexpr const char* kVertexSource = R"(void main()
{
	gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

// This work is based on: W. D. Hillis, G. L. Steele, "Data Parallel Algorithms", CACM 1986 (sums by doubling distances).

// One work group per row or column; processes 256 entries at a time and carries the sum along.
constexpr const char* kSource = R"(
layout(local_size_x = 256) in;
uniform highp usampler2DArray nook_source;
layout(rgba32ui) writeonly uniform uimage2D nook_target;
shared uvec4 nook_sums[2][256];
void main()
{
	int line = int(gl_WorkGroupID.x);
	int lane = int(gl_LocalInvocationID.x);
	ivec2 size = textureSize(nook_source, 0).xy;
	int count = AXIS == 0 ? size.x : size.y;
	uvec4 before = uvec4(0u);
	for (int first = 0; first < count; first += 256)
	{
		int at = first + lane;
		ivec2 texel = AXIS == 0 ? ivec2(at, line) : ivec2(line, at);
		nook_sums[0][lane] = at < count ? texelFetch(nook_source, ivec3(texel, 0), 0) : uvec4(0u);
		int from = 0;
		barrier();
		for (int stride = 1; stride < 256; stride *= 2)
		{
			uvec4 sum = nook_sums[from][lane];
			if (lane >= stride)
			{
				sum += nook_sums[from][lane - stride];
			}
			nook_sums[1 - from][lane] = sum;
			from = 1 - from;
			barrier();
		}
		if (at < count)
		{
			imageStore(nook_target, texel, before + nook_sums[from][lane]);
		}
		before += nook_sums[from][255];
		barrier();
	}
}
)";

} // namespace

GlContext::GlContext(GlApi api, std::optional<int> device)
{
	requireLibraries(api);
	m_display = device ? displayOf(*device) : chosenDisplay();
	requireEgl(m_display != EGL_NO_DISPLAY && eglInitialize(m_display, nullptr, nullptr) != EGL_FALSE, "found no display");
	requireEgl(eglBindAPI(api == GlApi::core ? EGL_OPENGL_API : EGL_OPENGL_ES_API) != EGL_FALSE,
			   api == GlApi::core ? "found no desktop OpenGL" : "found no OpenGL ES");
	// Mesa gives its newest version whatever is asked for; NVIDIA gives the version asked for, without compute shaders in 3.3.
	for (const auto& [major, minor] : api == GlApi::core ? std::vector<std::pair<EGLint, EGLint>>{{4, 5}, {4, 3}, {3, 3}}
														 : std::vector<std::pair<EGLint, EGLint>>{{3, 0}})
	{
		const std::array<EGLint, 7> wanted{EGL_CONTEXT_MAJOR_VERSION,
										   major,
										   EGL_CONTEXT_MINOR_VERSION,
										   minor,
										   api == GlApi::core ? EGL_CONTEXT_OPENGL_PROFILE_MASK : EGL_NONE,
										   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
										   EGL_NONE};
		m_context = eglCreateContext(m_display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted.data());
		if (m_context != EGL_NO_CONTEXT)
		{
			break;
		}
	}
	requireEgl(m_context != EGL_NO_CONTEXT, "found no context");
	use();
	requireEgl(api == GlApi::core || epoxy_has_gl_extension("GL_EXT_color_buffer_float"), "found no pictures of floats");
}

GlContext::~GlContext()
{
	eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
	eglDestroyContext(m_display, m_context);
}

void GlContext::use() const
{
	requireEgl(eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, m_context) != EGL_FALSE, "found no context");
}

std::string GlContext::renderer() const
{
	const auto text = [](unsigned name)
	{
		return std::string(reinterpret_cast<const char*>(glGetString(name)));
	};
	return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

bool GlContext::isSoftware() const
{
	const std::string name = renderer();
	constexpr std::array<const char*, 5> known{"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software Rasterizer"};
	return std::any_of(known.begin(), known.end(), [&name](const char* one) { return name.find(one) != std::string::npos; });
}

bool GlContext::hasCompute() const
{
	return epoxy_is_desktop_gl() && epoxy_gl_version() >= 43;
}

GlTexture::GlTexture(int width, int height, int channels, const float* values)
	: GlTexture(PictureShape{channels == 1 ? PictureFormat::scalar : PictureFormat::quad, width, height})
{
	if (values != nullptr)
	{
		glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
		glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, channels == 1 ? GL_RED : GL_RGBA, GL_FLOAT, values);
	}
	checkGlErrors();
}

GlTexture::GlTexture(const PictureShape& of)
	: shape(of), target(shape.format == PictureFormat::counts ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D),
	  name(glGenTextures, glDeleteTextures)
{
	glBindTexture(target, name);
	glTexParameteri(target, GL_TEXTURE_MIN_FILTER, shape.levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
	glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, shape.levels - 1);
	const GlFormat format = formatOf(shape.format);
	for (int level = 0; level < shape.levels; ++level)
	{
		const int width = levelSide(shape.width, level);
		const int height = levelSide(shape.height, level);
		if (target == GL_TEXTURE_2D)
		{
			glTexImage2D(target, level, format.stored, width, height, 0, format.channels, format.type, nullptr);
		}
		else
		{
			glTexImage3D(target, level, format.stored, width, height, shape.layers, 0, format.channels, format.type, nullptr);
		}
	}
	checkGlErrors();
}

GlLeft::GlLeft(int width, int height) : name(glGenRenderbuffers, glDeleteRenderbuffers)
{
	glBindRenderbuffer(GL_RENDERBUFFER, name);
	glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT16, width, height);
	checkGlErrors();
}

GlName fragmentProgram(const std::string& fragment_source)
{
	const std::string version = epoxy_is_desktop_gl() ? "#version 330 core\n" : "#version 300 es\n";
	return linkedProgram(
		{compiledShader(GL_VERTEX_SHADER, version + kVertexSource), compiledShader(GL_FRAGMENT_SHADER, fragment_source)});
}

GlPass::GlPass(const std::string& fragment_source) : GlPass(0U)
{
	m_own = fragmentProgram(fragment_source);
	m_program = m_own;
	glUseProgram(m_program);
}

GlPass::GlPass(unsigned program)
	: m_program(program), m_vertices(glGenVertexArrays, glDeleteVertexArrays), m_block(glGenBuffers, glDeleteBuffers)
{
	glUseProgram(m_program);
}

void GlPass::bind(const char* sampler, const GlTexture& texture)
{
	m_units.push_back({glGetUniformLocation(m_program, sampler), &texture});
}

void GlPass::bindBlock(const char* block, std::span<const std::byte> bytes)
{
	glBindBuffer(GL_UNIFORM_BUFFER, m_block);
	glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STATIC_DRAW);
	glUniformBlockBinding(m_program, glGetUniformBlockIndex(m_program, block), 0);
	glBindBufferBase(GL_UNIFORM_BUFFER, 0, m_block);
	checkGlErrors();
}

double GlPass::draw(const GlTexture& target, int level, int layer, bool timer)
{
	const GlName frame(glGenFramebuffers, glDeleteFramebuffers);
	glBindFramebuffer(GL_FRAMEBUFFER, frame);
	if (target.target == GL_TEXTURE_2D)
	{
		glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.name, level);
	}
	else
	{
		glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, target.name, level, layer);
	}
	glViewport(0, 0, levelSide(target.shape.width, level), levelSide(target.shape.height, level));
	glBindVertexArray(m_vertices);
	glUseProgram(m_program);
	glBindBufferBase(GL_UNIFORM_BUFFER, 0, m_block);
	for (std::size_t i = 0; i < m_units.size(); ++i)
	{
		const GlTexture& texture = *m_units[i].texture;
		glActiveTexture(GL_TEXTURE0 + static_cast<unsigned>(i));
		glBindTexture(texture.target, texture.name);
		if (texture.shape.levels > 1)
		{
			// A render target must not be readable: otherwise a level that reads the one above would be undefined.
			const bool own = &texture == &target;
			glTexParameteri(texture.target, GL_TEXTURE_MAX_LEVEL, own ? std::max(level - 1, 0) : texture.shape.levels - 1);
		}
		glUniform1i(m_units[i].location, static_cast<int>(i));
	}
	if (m_left != nullptr)
	{
		// Draws at the middle of the depth range: drawn pixels pass against the far end, discarded ones do not.
		glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, m_left->name);
		glEnable(GL_DEPTH_TEST);
		glDepthMask(m_fills ? GL_FALSE : GL_TRUE);
		glDepthFunc(m_fills ? GL_LESS : GL_ALWAYS);
	}
	const auto commands = [this]
	{
		if (m_left != nullptr && !m_fills)
		{
			glClear(GL_DEPTH_BUFFER_BIT);
		}
		glDrawArrays(GL_TRIANGLES, 0, 3);
	};
	const double seconds = secondsOf(commands, timer);
	glDisable(GL_DEPTH_TEST);
	return seconds;
}

std::vector<float> readFloats(const GlTexture& texture)
{
	const PictureShape& shape = texture.shape;
	const auto channels = static_cast<std::size_t>(channelsOf(shape.format));
	std::vector<float> values(channels * static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.height));
	const GlName frame(glGenFramebuffers, glDeleteFramebuffers);
	glBindFramebuffer(GL_FRAMEBUFFER, frame);
	glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.name, 0);
	glPixelStorei(GL_PACK_ALIGNMENT, 4);
	glReadPixels(0, 0, shape.width, shape.height, formatOf(shape.format).channels, GL_FLOAT, values.data());
	checkGlErrors();
	return values;
}

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
		line = line.substr(line.find("error") == std::string::npos ? 0 : line.rfind('\n', line.find("error")) + 1); // no warning
		throw Error(ExitCode::runtime,
					"OpenGL: shader: found '" + line.substr(0, line.find('\n')) + "', expected one that compiles");
	}
	return shader;
}

GlName linkedProgram(const std::vector<unsigned>& shaders)
{
	GlName program(glCreateProgram(), [](int, const unsigned* name) { glDeleteProgram(*name); });
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
	refuseIf(good == 0, "OpenGL: found a program that does not link, expected one that links", ExitCode::runtime);
	return program;
}

void checkGlErrors()
{
	const unsigned code = glGetError();
	refuseIf(code != GL_NO_ERROR, "OpenGL: found error " + std::to_string(code) + ", expected none", ExitCode::runtime);
}

double secondsOf(const std::function<void()>& commands, bool timer)
{
	const GlName query = timer ? GlName(glGenQueries, glDeleteQueries) : GlName();
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
	}
	checkGlErrors();
	return seconds;
}

void warmUp(const GlContext& context, int repetitions, const std::function<void()>& draw)
{
	constexpr double kWarmUp_s = 0.1; // idle GPUs raise their clock within tens of milliseconds
	const auto start = std::chrono::steady_clock::now();
	while (repetitions > 0 && !context.isSoftware() &&
		   std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < kWarmUp_s)
	{
		draw();
	}
}

GlScan::GlScan(int axis)
	: m_axis(axis), m_program(linkedProgram(
						{compiledShader(GL_COMPUTE_SHADER, "#version 430 core\n#define AXIS " + std::to_string(axis) + kSource)}))
{
}

double GlScan::run(const GlTexture& source, const GlTexture& target, int layer, bool timer)
{
	glUseProgram(m_program);
	glActiveTexture(GL_TEXTURE0);
	glBindTexture(source.target, source.name);
	glUniform1i(glGetUniformLocation(m_program, "nook_source"), 0);
	glUniform1i(glGetUniformLocation(m_program, "nook_target"), 0);
	glBindImageTexture(0, target.name, 0, GL_FALSE, layer, GL_WRITE_ONLY, GL_RGBA32UI);
	const PictureShape& shape = target.shape;
	const auto lines = static_cast<unsigned>(m_axis == 0 ? shape.height : shape.width);
	return secondsOf(
		[lines]
		{
			glDispatchCompute(lines, 1, 1);
			glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
		},
		timer);
}

GlSession::GlSession(std::optional<int> device) : m_context(GlApi::core, device) {}

GlSession::~GlSession()
{
	m_context.use();
	m_programs.clear();
}

const GlContext& GlSession::use() const
{
	m_context.use();
	return m_context;
}

unsigned GlSession::program(const std::string& fragment_source)
{
	const auto found = m_programs.find(fragment_source);
	return found != m_programs.end() ? found->second
									 : m_programs.emplace(fragment_source, fragmentProgram(fragment_source)).first->second;
}

} // namespace nook
