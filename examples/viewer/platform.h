// SPDX-License-Identifier: MIT
// Creates a current OpenGL 3.3 context, with a window (GLFW) or without a display (EGL).
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <memory>
#include <string>

class Platform
{
public:
	virtual ~Platform() = default;

	virtual bool isOpen() const = 0;
	virtual glm::ivec2 size() const = 0; // pixels
	virtual bool isWindow() const = 0;   // framebuffer 0 is displayed
	virtual void present(const std::string& title) = 0;

	// Since the last call: metres along the camera's axes, and mouse movement in pixels while a button is held.
	struct Motion
	{
		glm::vec3 step_m{0.0f};
		glm::vec2 turn_px{0.0f};
	};
	virtual Motion takeMotion() = 0;

protected:
	Platform() = default;
	Platform(const Platform&) = delete;
	Platform& operator=(const Platform&) = delete;
};

// One at a time. `on_key` receives digits and lower-case letters. Throws Failure (5) without a display or OpenGL 3.3.
std::unique_ptr<Platform> openWindow(glm::ivec2 size, std::function<void(char)> on_key);
std::unique_ptr<Platform> openWithoutWindow(glm::ivec2 size);
