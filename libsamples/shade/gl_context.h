// SPDX-License-Identifier: GPL-3.0-or-later
// A headless OpenGL context and programs that fill pictures.
#pragma once

#include "methods/picture.h"

#include <glm/vec4.hpp>

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace nook
{

enum class GlApi
{
	core, // OpenGL 3.3 core or later
	es,   // OpenGL ES 3.0 or later, with float render targets (EXT_color_buffer_float)
};

// Current on this thread during its lifetime (EGL without a surface). Throws Error (unsupported) with EGL's message. The display
// stays initialised until the process ends: EGL has no reference count for it, and further contexts are created ten times faster.
class GlContext
{
public:
	// Uses the driver's default device, or an EGL device by number (from 0, in EGL's order).
	explicit GlContext(GlApi api = GlApi::core, std::optional<int> device = std::nullopt);
	~GlContext();
	GlContext& operator=(GlContext&&) = delete;

	// Makes the context current on this thread again.
	void use() const;

	// The driver's renderer name and version on one line.
	std::string renderer() const;

	// True if it renders on the CPU, where GPU timers are meaningless.
	bool isSoftware() const;

	// True for OpenGL 4.3 or later.
	bool hasCompute() const;

private:
	void* m_display = nullptr;
	void* m_context = nullptr;
};

// The name of an OpenGL object, which goes with it. Requires the object's context.
class GlName
{
public:
	using Make = void (*)(int count, unsigned* names);
	using Delete = void (*)(int count, const unsigned* names);

	GlName() = default;
	GlName(unsigned name, Delete destroy) : m_name(name), m_delete(destroy) {}
	GlName(Make make, Delete destroy) : m_delete(destroy)
	{
		make(1, &m_name);
	}
	GlName(GlName&& other) noexcept : m_name(std::exchange(other.m_name, 0U)), m_delete(other.m_delete) {}
	GlName& operator=(GlName&& other) noexcept
	{
		std::swap(m_name, other.m_name);
		std::swap(m_delete, other.m_delete);
		return *this;
	}
	~GlName()
	{
		if (m_name != 0)
		{
			m_delete(1, &m_name);
		}
	}

	operator unsigned() const // NOLINT: it stands for the object
	{
		return m_name;
	}

private:
	unsigned m_name = 0;
	Delete m_delete = nullptr;
};

// A texture read by texelFetch. Requires a context.
class GlTexture
{
public:
	// 32-bit floats; 1 or 4 channels; `values` may be null.
	GlTexture(int width, int height, int channels, const float* values);

	// Empty, with levels or layers. An array texture if the format is counts.
	explicit GlTexture(const PictureShape& of);

	const PictureShape shape;
	const unsigned target;
	const GlName name;
};

// Marks the pixels that one pass discarded, for a later pass to fill. Uses a depth buffer, so skipped pixels cost almost nothing.
class GlLeft
{
public:
	GlLeft(int width, int height);

	const GlName name;
};

// A program that runs this shader for every pixel of a picture. Throws Error (runtime) with the compiler's first error line.
GlName fragmentProgram(const std::string& fragment_source);

// Runs a fragment shader once for every pixel of a picture.
class GlPass
{
public:
	// Throws Error (runtime) with the compiler's first error line.
	explicit GlPass(const std::string& fragment_source);

	// Uses a program that outlives it (fragmentProgram()).
	explicit GlPass(unsigned program);

	void bind(const char* sampler, const GlTexture& texture);
	void bindBlock(const char* block, std::span<const std::byte> bytes);

	// Records the pixels that it discards, or fills only those. `left` has the target's size and must outlive the pass.
	void use(const GlLeft& left, bool fills)
	{
		m_left = &left;
		m_fills = fills;
	}

	// Fills one level of a layer, which the pass must not read, and waits. Returns the drawing time in seconds, by the driver's
	// timer with `timer`, else by the clock.
	double draw(const GlTexture& target, int level = 0, int layer = 0, bool timer = false);

private:
	struct Unit
	{
		int location = -1;
		const GlTexture* texture = nullptr;
	};

	GlName m_own; // the program, if it is the pass's own
	unsigned m_program = 0;
	GlName m_vertices;
	GlName m_block;
	std::vector<Unit> m_units;
	const GlLeft* m_left = nullptr;
	bool m_fills = false;
};

// Reads level 0 of a scalar picture, or of quads with four values per pixel; rows in gl_FragCoord order.
std::vector<float> readFloats(const GlTexture& texture);

// Shared by all OpenGL programs: compiling, linking and timing.

// Throws Error (runtime) with the compiler's first error line.
unsigned compiledShader(unsigned kind, const std::string& source);

// Deletes the shaders. Throws Error (runtime).
GlName linkedProgram(const std::vector<unsigned>& shaders);

// Throws Error (runtime) for errors since the last call.
void checkGlErrors();

// Runs `commands` to completion without other work; returns seconds, by the driver's timer with `timer`, else by the clock.
double secondsOf(const std::function<void()>& commands, bool timer);

// Before drawings whose times count (`repetitions` above 0): repeats `draw` until a GPU's clock has risen. Nothing on a CPU.
void warmUp(const GlContext& context, int repetitions, const std::function<void()>& draw);

// Prefix sums along the rows or columns of a picture of counts, by a compute shader.

class GlScan
{
public:
	// Along x (0) or y (1). Requires a context with compute shaders.
	explicit GlScan(int axis);

	// Scans layer 0 of `source` into a layer of `target`, which has the same size, and waits. Returns seconds like GlPass::draw.
	double run(const GlTexture& source, const GlTexture& target, int layer, bool timer);

private:
	int m_axis;
	GlName m_program;
};

// A persistent context with its linked programs, so that a series of pictures compiles each shader once.

class GlSession
{
public:
	// Throws Error (unsupported) like GlContext.
	explicit GlSession(std::optional<int> device = std::nullopt);
	~GlSession();
	GlSession& operator=(GlSession&&) = delete;

	// Makes the context current on this thread.
	const GlContext& use() const;

	// For GlPass; owned by the session. Requires use(). Throws Error (runtime) with the compiler's first error line.
	unsigned program(const std::string& fragment_source);

private:
	GlContext m_context;
	std::map<std::string, GlName> m_programs; // by source text
};

} // namespace nook
