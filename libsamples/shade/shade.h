// SPDX-License-Identifier: GPL-3.0-or-later
// A G-buffer → visibility by one of the screen-space methods, on the CPU or through OpenGL.
#pragma once

#include "core/progress.h"
#include "methods/block.h"
#include "methods/settings.h"
#include "scene/gbuffer.h"

#include <optional>
#include <string>
#include <vector>

namespace nook
{

class GlSession;

// What the kernels' block is made from. Refers to the G-buffer.
ShadeFrame frameOf(const GBuffer& gbuffer);

// Depths with NOOK_SKY for infinity.
std::vector<float> finiteDepths(const GBuffer& gbuffer);

struct PassTime
{
	std::string name;
	double seconds = 0.0;           // median of the repetitions
	std::vector<double> drawings{}; // of each repetition, in their order, without the one that warmed up
};

struct Shaded
{
	std::vector<float> visibility; // [0, 1], rows from the top; sky 1; or a debug view, sky 0
	std::string renderer;          // "CPU", or what OpenGL calls itself
	double seconds = 0.0;          // of all passes
	std::vector<PassTime> passes;  // in order
	std::string tables_by;         // StatVO: "scans", "compute" or "fragments"
	std::vector<glm::vec3> bent{}; // where settings ask for them: bent normals, unit, view space; sky 0
};

// Pixels with a surface whose radius the limits in pixels change.
struct LimitedRadii
{
	std::size_t near = 0; // made less
	std::size_t far = 0;  // made greater

	bool operator==(const LimitedRadii&) const = default;
};
LimitedRadii limitedRadii(const GBuffer& gbuffer, const ShadeSettings& settings);

// How a picture is drawn. One drawing, or for times that mean something: one to warm up and then several.
struct DrawSettings
{
	int repetitions = 0;          // 0: once, without warming up
	std::optional<int> gl_device; // of EGL's list; without: the driver's choice
	GlSession* session = nullptr; // shadeOnGl() draws in it, whatever the device; without: in one of its own
};

// Throws Error (unsupported) for a projection with a skew: x or y of the picture must depend on x or y alone.
Shaded shadeOnCpu(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, const RunSettings& run,
				  const DrawSettings& drawing = {});

// Through OpenGL 3.3 without a display (EGL); times by the GPU's own timers, by the clock where OpenGL runs on a CPU. Throws Error
// (unsupported) where no context can be made.
Shaded shadeOnGl(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings,
				 const DrawSettings& drawing = {});

} // namespace nook
