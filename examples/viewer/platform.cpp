// SPDX-License-Identifier: MIT
#include "platform.h"

#include "level_file.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cctype>
#include <utility>

namespace
{

class Window : public Platform
{
public:
	Window(glm::ivec2 size, std::function<void(char)> on_key) : m_on_key(std::move(on_key))
	{
		if (glfwInit() == GLFW_FALSE)
		{
			throw Failure(5, "window: found no display, expected one, or --no-window");
		}
		glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
		glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
		glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
		glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
		m_window = glfwCreateWindow(size.x, size.y, "nook viewer", nullptr, nullptr);
		if (m_window == nullptr)
		{
			glfwTerminate();
			throw Failure(5, "window: found no OpenGL 3.3, expected a driver that offers it");
		}
		glfwMakeContextCurrent(m_window);
		glfwSwapInterval(1);
		glfwSetWindowUserPointer(m_window, this);
		glfwSetKeyCallback(m_window, [](GLFWwindow* window, int key, int, int action, int)
						   { static_cast<Window*>(glfwGetWindowUserPointer(window))->onKey(key, action); });
		m_time_s = glfwGetTime();
	}
	~Window() override
	{
		glfwDestroyWindow(m_window);
		glfwTerminate();
	}
	bool isOpen() const override
	{
		return glfwWindowShouldClose(m_window) == GLFW_FALSE;
	}
	bool isWindow() const override
	{
		return true;
	}
	glm::ivec2 size() const override
	{
		glm::ivec2 size;
		glfwGetFramebufferSize(m_window, &size.x, &size.y);
		return glm::max(size, glm::ivec2(1)); // 0 while it is minimised
	}
	void present(const std::string& title) override
	{
		glfwSetWindowTitle(m_window, title.c_str());
		glfwSwapBuffers(m_window);
		glfwPollEvents();
	}
	Motion takeMotion() override
	{
		const double now_s = glfwGetTime();
		const float step_m =
			static_cast<float>(now_s - std::exchange(m_time_s, now_s)) * (isDown(GLFW_KEY_LEFT_SHIFT) ? 12.0f : 3.0f);
		Motion motion;
		motion.step_m.x = step_m * static_cast<float>(isDown(GLFW_KEY_D) - isDown(GLFW_KEY_A));
		motion.step_m.y = step_m * static_cast<float>(isDown(GLFW_KEY_E) - isDown(GLFW_KEY_Q));
		motion.step_m.z = step_m * static_cast<float>(isDown(GLFW_KEY_S) - isDown(GLFW_KEY_W));
		glm::dvec2 mouse;
		glfwGetCursorPos(m_window, &mouse.x, &mouse.y);
		const glm::dvec2 way = mouse - std::exchange(m_mouse, mouse);
		motion.turn_px = glfwGetMouseButton(m_window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS ? glm::vec2(way) : glm::vec2(0.0f);
		return motion;
	}

private:
	int isDown(int key) const
	{
		return glfwGetKey(m_window, key) == GLFW_PRESS ? 1 : 0;
	}
	void onKey(int key, int action)
	{
		if (action == GLFW_PRESS && key == GLFW_KEY_ESCAPE)
		{
			glfwSetWindowShouldClose(m_window, GLFW_TRUE);
		}
		else if (action == GLFW_PRESS && key < 128) // ASCII codes of digits and capital letters
		{
			m_on_key(static_cast<char>(std::tolower(key)));
		}
	}

	GLFWwindow* m_window = nullptr;
	std::function<void(char)> m_on_key;
	double m_time_s = 0.0;
	glm::dvec2 m_mouse{0.0};
};

class NoWindow : public Platform
{
public:
	explicit NoWindow(glm::ivec2 size) : m_size(size)
	{
		// libepoxy loads these on their first call and terminates the process if it cannot.
		if (dlopen("libEGL.so.1", RTLD_LAZY) == nullptr ||
			(dlopen("libOpenGL.so.0", RTLD_LAZY) == nullptr && dlopen("libGL.so.1", RTLD_LAZY) == nullptr))
		{
			throw Failure(5, "EGL: found no libEGL.so.1 or no libOpenGL.so.0, expected a driver that offers OpenGL 3.3");
		}
		const bool surfaceless = epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless");
		m_display = surfaceless ? eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)
								: eglGetDisplay(EGL_DEFAULT_DISPLAY);
		const EGLint attributes[] = {
			EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
			EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
		const bool ready = m_display != EGL_NO_DISPLAY && eglInitialize(m_display, nullptr, nullptr) != EGL_FALSE &&
						   eglBindAPI(EGL_OPENGL_API) != EGL_FALSE;
		m_context = ready ? eglCreateContext(m_display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes) : EGL_NO_CONTEXT;
		if (m_context == EGL_NO_CONTEXT || eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, m_context) == EGL_FALSE)
		{
			throw Failure(5, "EGL: found no context, expected a driver that offers OpenGL 3.3 without a display");
		}
	}
	~NoWindow() override
	{
		eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
		eglDestroyContext(m_display, m_context);
		eglTerminate(m_display);
	}
	bool isOpen() const override
	{
		return true;
	}
	bool isWindow() const override
	{
		return false;
	}
	glm::ivec2 size() const override
	{
		return m_size;
	}
	void present(const std::string&) override {}
	Motion takeMotion() override
	{
		return {};
	}

private:
	glm::ivec2 m_size;
	EGLDisplay m_display = EGL_NO_DISPLAY;
	EGLContext m_context = EGL_NO_CONTEXT;
};

} // namespace

std::unique_ptr<Platform> openWindow(glm::ivec2 size, std::function<void(char)> on_key)
{
	return std::make_unique<Window>(size, std::move(on_key));
}

std::unique_ptr<Platform> openWithoutWindow(glm::ivec2 size)
{
	return std::make_unique<NoWindow>(size);
}
