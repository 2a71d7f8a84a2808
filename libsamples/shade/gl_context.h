// SPDX-License-Identifier: GPL-3.0-or-later
// An OpenGL context without a display, and programs in it that fill pictures.
#pragma once

#include "methods/picture.h"

#include <glm/vec4.hpp>

#include <cstdint>
#include <optional>
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
// The display stays as it is once it was asked for, until the process ends: EGL does not count who uses it, and the next context
// comes ten times faster.
class GlContext
{
public:
	// On the driver's choice of device, or on one of EGL's by number (from 0, in EGL's order).
	explicit GlContext(GlApi api = GlApi::core, std::optional<int> device = std::nullopt);
	~GlContext();
	GlContext(const GlContext&) = delete;
	GlContext& operator=(const GlContext&) = delete;

	// Current on this thread again, after another one was.
	void use() const;

	// Vendor's name of the renderer and its version, in one line.
	std::string renderer() const;

	// Draws on a CPU, where its own timers say nothing.
	bool isSoftware() const;

	// OpenGL 4.3 or later.
	bool hasCompute() const;

private:
	void* m_display = nullptr;
	void* m_context = nullptr;
};

// A texture for texelFetch. Requires a context.
class GlTexture
{
public:
	// 32-bit floats; 1 or 4 channels; `values` may be null.
	GlTexture(int width, int height, int channels, const float* values);

	// Empty, with levels or layers. An array texture where the format is counts.
	explicit GlTexture(const PictureShape& shape);
	~GlTexture();
	GlTexture(const GlTexture&) = delete;
	GlTexture& operator=(const GlTexture&) = delete;

	unsigned name() const
	{
		return m_name;
	}
	unsigned target() const
	{
		return m_target;
	}
	const PictureShape& shape() const
	{
		return m_shape;
	}

private:
	PictureShape m_shape;
	unsigned m_target = 0;
	unsigned m_name = 0;
};

// The pixels of a picture that one pass left out (discard), for a later one to fill: a depth buffer, so that what is not left costs
// next to nothing.
class GlLeft
{
public:
	GlLeft(int width, int height);
	~GlLeft();
	GlLeft(const GlLeft&) = delete;
	GlLeft& operator=(const GlLeft&) = delete;

	unsigned name() const
	{
		return m_name;
	}

private:
	unsigned m_name = 0;
};

// A program that runs this shader for every pixel of a picture. Throws Error (runtime) with the compiler's first line.
unsigned fragmentProgram(const std::string& fragment_source);

// A fragment shader that is run once for every pixel of a picture.
class GlPass
{
public:
	// Throws Error (runtime) with the compiler's first line.
	explicit GlPass(const std::string& fragment_source);

	// Of a program that outlives it (fragmentProgram()).
	explicit GlPass(unsigned program);
	~GlPass();
	GlPass(const GlPass&) = delete;
	GlPass& operator=(const GlPass&) = delete;

	void bind(const char* sampler, const GlTexture& texture);
	void bindBlock(const char* block, std::span<const std::byte> bytes);

	// A uniform ivec4; nothing where the program has none of that name.
	void setIntegers(const char* name, const glm::ivec4& values);

	// From now on it notes what it leaves, or fills that alone. Of the target's size; outlives the pass.
	void leave(const GlLeft& left);
	void fill(const GlLeft& left);

	// Fills a level of a layer, which the pass must not read, and waits for the end; the seconds that drawing took, by the
	// driver's timer with `timer`, else by the clock.
	double draw(const GlTexture& target, int level = 0, int layer = 0, bool timer = false);

private:
	struct Unit
	{
		int location = -1;
		const GlTexture* texture = nullptr;
	};

	unsigned m_program = 0;
	bool m_owns = false; // the program
	unsigned m_vertices = 0;
	unsigned m_block = 0;
	std::vector<Unit> m_units;
	const GlLeft* m_left = nullptr;
	bool m_fills = false;
};

// Level 0 of a scalar, or of quads, four numbers a pixel: rows as gl_FragCoord counts them.
std::vector<float> readScalar(const GlTexture& texture);
std::vector<float> readQuads(const GlTexture& texture);

// A layer of counts.
std::vector<std::uint32_t> readCounts(const GlTexture& texture, int layer);

} // namespace nook
