// SPDX-License-Identifier: GPL-3.0-or-later
// An OpenGL context without a display, and programs in it that fill pictures.
#pragma once

#include <glm/vec4.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace nook
{

enum class GlApi
{
	core, // OpenGL 3.3 core or a later one that holds it
	es,   // OpenGL ES 3.0 or later, with pictures of floats (EXT_color_buffer_float)
};

// Current on this thread while it lives (EGL without a surface). Throws Error (unsupported), saying what EGL said.
class GlContext
{
public:
	explicit GlContext(GlApi api = GlApi::core);
	~GlContext();
	GlContext(const GlContext&) = delete;
	GlContext& operator=(const GlContext&) = delete;

	// Vendor's name of the renderer and its version, in one line.
	std::string renderer() const;

private:
	void* m_display = nullptr;
	void* m_context = nullptr;
};

// A texture of 32-bit floats for texelFetch; 1 or 4 channels. Requires a context.
class GlTexture
{
public:
	GlTexture(int width, int height, int channels, const float* values);
	~GlTexture();
	GlTexture(const GlTexture&) = delete;
	GlTexture& operator=(const GlTexture&) = delete;

	unsigned name() const
	{
		return m_name;
	}
	int width() const
	{
		return m_width;
	}
	int height() const
	{
		return m_height;
	}

private:
	unsigned m_name = 0;
	int m_width = 0;
	int m_height = 0;
};

// A fragment shader that is run once for every pixel of a picture.
class GlPass
{
public:
	// Throws Error (runtime) with the compiler's first line.
	explicit GlPass(const std::string& fragment_source);
	~GlPass();
	GlPass(const GlPass&) = delete;
	GlPass& operator=(const GlPass&) = delete;

	void bind(const char* sampler, const GlTexture& texture);
	void bindBlock(const char* block, std::span<const std::byte> bytes);

	// Fills a texture of 1 channel, which the pass must not read, and waits for the end; the seconds that drawing took. What was
	// drawn goes to `values`, if any are given (rows as gl_FragCoord counts them).
	double draw(const GlTexture& target, std::vector<float>* values = nullptr);

private:
	unsigned m_program = 0;
	unsigned m_vertices = 0;
	unsigned m_block = 0;
	int m_units = 0;
};

} // namespace nook
