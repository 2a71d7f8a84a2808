// SPDX-License-Identifier: GPL-3.0-or-later
// A G-buffer → visibility by one of the screen-space methods, on the CPU or through OpenGL.
#pragma once

#include "core/progress.h"
#include "pattern/pattern.h"
#include "scene/gbuffer.h"
#include "shade/rivals.h"

#include <glm/vec4.hpp>

#include <optional>
#include <string>
#include <vector>

namespace nook
{

enum class ShadeMethod
{
	vo_line,  // VO §4.1, lines of the disk
	vo_point, // VO §4, points of the ball
	alchemy,  // ALC eq. 10, points of the disk
	// To compare with, never emitted (rivals_*.glsl), and last:
	crytek,     // points of the ball
	volumetric, // points uniform on the disk
	hbao,       // samples of its own
	sao,        // samples of its own
};

enum class ShadeFilter
{
	none,
	bilateral, // ALC §3.3: two one-dimensional passes that stay on the pixel's surface
	window,    // one pass: the mean over the window of variants, on the pixel's surface
};

// Samples of every pixel of a window, which repeats over the picture.
struct ShadeSamples
{
	int size = 1;                   // side of the window, pixels
	int count = 0;                  // samples a pixel
	std::vector<glm::vec4> samples; // size² × count: x, y, (line: half length; point: z), weight; radius 1
};

// False for methods whose samples are their own.
bool takesPattern(ShadeMethod method);

// The domain of the patterns that a method takes: disk, ball, hemisphere (as points uniform on the disk). Requires takesPattern.
Domain domainOf(ShadeMethod method);

// One pattern for all pixels, or one for each of a window's size² (all of one count). Requires their domain to be the method's.
ShadeSamples samplesOf(ShadeMethod method, const std::vector<Pattern>& variants);

struct ShadeSettings
{
	ShadeMethod method = ShadeMethod::vo_line;
	double radius_m = 0.5;                  // > 0
	bool use_normal = true;                 // volumetric obscurance: above the tangent plane alone
	double sigma = 1.0;                     // alchemy: intensity; lengths are in units of the radius
	double contrast = 1.0;                  // alchemy: k
	double beta = 1e-4;                     // alchemy: bias as a share of the depth
	double epsilon = 1e-4;                  // alchemy: keeps the quotient finite, in squares of the radius
	bool cut = false;                       // alchemy: leave out what is further than the radius
	ShadeFilter filter = ShadeFilter::none; // window: requires samples with a window of more than one pixel
	int filter_taps = 5;                    // bilateral: of each pass; odd, 5 to 13
	bool half_resolution = false;           // methods and filters for every second pixel of both axes, then full resolution again
	RivalSettings rival;                    // of the methods to compare with
};

// Of a method that takes no pattern.
ShadeSamples ownSamples(const ShadeSettings& settings);

struct PassTime
{
	std::string name;
	double seconds = 0.0; // median of the repetitions
};

struct Shaded
{
	std::vector<float> visibility; // [0, 1], rows from the top; sky 1
	std::string renderer;          // "CPU", or what OpenGL calls itself
	double seconds = 0.0;          // of all passes
	std::vector<PassTime> passes;  // in order
};

// How a picture is drawn. One drawing, or for times that mean something: one to warm up and then several.
struct DrawSettings
{
	int repetitions = 0;          // 0: once, without warming up
	std::optional<int> gl_device; // of EGL's list; without: the driver's choice
};

// Throws Error (unsupported) for a projection with a skew: x or y of the picture must depend on x or y alone.
Shaded shadeOnCpu(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, const RunSettings& run,
				  const DrawSettings& drawing = {});

// Through OpenGL 3.3 without a display (EGL); times by the GPU's own timers, by the clock where OpenGL runs on a CPU. Throws Error
// (unsupported) where no context can be made.
Shaded shadeOnGl(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings,
				 const DrawSettings& drawing = {});

} // namespace nook
