// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility of a G-buffer by one of the screen-space methods, on the CPU or through OpenGL.
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

// The input of the kernels' block. Refers to the G-buffer.
ShadeFrame frameOf(const GBuffer& gbuffer);

// Depths with infinity replaced by NOOK_SKY.
std::vector<float> finiteDepths(const GBuffer& gbuffer);

struct PassTime
{
	std::string name;
	double seconds = 0.0;           // median of the repetitions
	std::vector<double> drawings{}; // time of each repetition in order, without the warm-up
};

struct Shaded
{
	std::vector<float> visibility; // [0, 1], rows from the top; sky is 1; for a debug view sky is 0
	std::string renderer;          // "CPU", or OpenGL's renderer name
	double seconds = 0.0;          // total of all passes
	std::vector<PassTime> passes;  // in order
	std::string tables_by;         // StatVO: "scans", "compute" or "fragments"
	std::vector<glm::vec3> bent{}; // if requested: unit bent normals in view space; sky is 0
};

// Counts pixels with a surface whose radius is limited in pixels.
struct LimitedRadii
{
	std::size_t near = 0; // reduced
	std::size_t far = 0;  // increased

	bool operator==(const LimitedRadii&) const = default;
};
LimitedRadii limitedRadii(const GBuffer& gbuffer, const ShadeSettings& settings);

// How a picture is drawn: once, or for meaningful times several times after a warm-up.
struct DrawSettings
{
	int repetitions = 0;          // 0: draw once without warm-up
	std::optional<int> gl_device; // index in EGL's list; default: its first GPU, otherwise the driver's choice
	GlSession* session = nullptr; // used by shadeOnGl() regardless of the device; null: a new context
};

// Throws Error (unsupported) for a skewed projection: the picture's x and y must depend on x and y alone, respectively.
Shaded shadeOnCpu(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, const RunSettings& run,
				  const DrawSettings& drawing = {});

// Headless OpenGL 3.3 (EGL), timed by the GPU, or by the clock if it is software. Throws Error (unsupported) without a context.
Shaded shadeOnGl(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings,
				 const DrawSettings& drawing = {});

} // namespace nook
