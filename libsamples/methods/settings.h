// SPDX-License-Identifier: GPL-3.0-or-later
// The screen-space methods and all their settings.
#pragma once

#include "core/round.h"
#include "pattern/pattern.h"
#include "pattern/recipe.h"

#include <glm/vec4.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace nook
{

// A row of the method table (method_table.h) by its position. These are the rows that code names; others need no enumerator.
enum class ShadeMethod
{
	vo_line,  // VO §4.1, lines of the disk
	vo_point, // VO §4, points of the ball
	vo_area,  // VO §4.2, lines of the disk with averaged depths
	alchemy,  // ALC eq. 10, points of the disk
	statvo,   // SVO, no samples at all
	slices,   // bit masks of covered directions, on planes through the view ray
	// Published methods for comparison, never emitted (published_*.glsl):
	crytek,     // points of the ball
	volumetric, // points uniform on the disk
	hbao,       // its own samples
	sao,        // its own samples
	gtao,       // its own slices
	bitmask,    // its own slices
};
template <> std::span<const std::string_view> namesOf<ShadeMethod>();

enum class ShadeFilter
{
	none,
	bilateral, // ALC §3.3: two one-dimensional passes that stay on the pixel's surface
	window,    // one pass: the mean over the window of variants, on the pixel's surface
};

// Shown instead of visibility (debug.glsl), before any filter.
enum class DebugView
{
	edges,   // where a filter finds another surface next to a pixel
	lod,     // mean level of depths or moments that the samples read, relative to the number of levels
	layers,  // statvo: fraction of the layers evaluated
	samples, // fraction of the samples taken
	noise,   // standard deviation over all variants of the window; sao: over sixteen rotations of the spiral
};
template <> inline constexpr std::array<std::string_view, 5> kNamesOf<DebugView>{"edges", "lod", "layers", "samples", "noise"};

// The depth that an engine stores, and its precision.
struct DepthFormat
{
	bool device = false;                          // depth buffer values, 0 to 1; else metres along the view direction
	ClipRange clip = ClipRange::minus_one_to_one; // device: NDC range that 0 to 1 map to
	int bits = 32;                                // device: 16 or 24 for integers, 32 for floats; metres: 16- or 32-bit floats
};

// Volumetric obscurance with features beyond one uniform ball (VO §3, §4.3, §5).
enum class TwoRadii
{
	none,
	product,
	minimum,
};

struct VoSettings
{
	double thickness_m = 0.0;        // thickness of surfaces; 0: infinite
	double second_thickness_m = 0.0; // for the other radii; 0: same as thickness_m
	double third_thickness_m = 0.0;
	TwoRadii radii = TwoRadii::none;
	double second_radius_m = 0.0; // > 0 with two radii
	double third_radius_m = 0.0;  // > 0: a third radius, if there are two
	bool quadratic = false;       // falloff 1 − (d/r)² instead of 1
	bool paired = false; // vo_line, vo_area: out-of-range samples take their opposite's openness; requires samples of pairedPattern
};

// Number of balls.
inline int radiiOf(const VoSettings& volume)
{
	return volume.radii == TwoRadii::none ? 1 : volume.third_radius_m > 0.0 ? 3 : 2;
}

// Statistical volumetric obscurance (statvo.glsl).
enum class StatVoLayering
{
	adaptive, // SVO §5: by the mean depth around each pixel
	uniform,  // SVO §4: equal parts of the picture's range of depths
};

// How sums are computed from cells.
enum class TableBuilder
{
	automatic, // compute shaders if OpenGL supports them and runs on a GPU
	compute,   // one work group per row, and one per column
	fragments, // recursive doubling, eight entries per pass
};

struct StatVoSettings
{
	int layers = 4; // adaptive: 1, 2, 4; uniform: 1 to 64
	StatVoLayering layering = StatVoLayering::adaptive;
	bool quadrants = false;
	int cell_px = 1;      // of the tables: 1, 2, 4
	double slope = 1.0;   // slope of ψ above 1, > 0
	double height = 1.0;  // height of the box above the surface, in radii, 0.05 to 100
	int largest_px = 127; // maximum half side of a rectangle, 1 to 255
	bool skip = true;     // skip layers where the surface is smooth
	TableBuilder builder = TableBuilder::automatic;
};

// Planes through the view ray, each with a bit mask of covered directions (slices.glsl).
struct SliceSettings
{
	int count = 1;           // per pixel, evenly spaced around the view ray; 1 to 16
	int steps = 4;           // depths on either side of each slice, 1 to 32
	double thickness = 0.65; // thickness of surfaces at the reach, in radii; > 0
	bool bent = false;       // also bent normals; requires full resolution and no window filter
};

// Takes fewer samples if the radius is small in the picture (ALC §4): bands with equal numbers of samples. Prefixes of the pattern
// must be patterns themselves (made with --order progressive).
struct BandSettings
{
	int count = 1;           // 1 to 3
	double first_px = 16.0;  // below this radius in pixels, only the first band
	double second_px = 48.0; // with three bands: below this, the first two
};

// Samples of every pixel of a window that repeats over the picture.
struct ShadeSamples
{
	int size = 1;                   // side of the window, pixels
	int count = 0;                  // samples per pixel
	std::vector<glm::vec4> samples; // size² × count, for all frames: x, y, third, weight, for a radius of 1; third: half length for
									// lines, z for points, log2 of the side for areas
	int variant = 0;    // of the current frame (variantOfFrame in tile.h)
	bool tiled = false; // a tile was given, although the method has its own samples
};

// False for methods with their own samples.
bool takesPattern(ShadeMethod method);

// True if a tile may replace its own samples.
bool mayTakeTile(ShadeMethod method);

// The domain of a method's patterns: disk, ball, hemisphere (as points uniform on the disk), or slice. Requires takesPattern or
// mayTakeTile.
Domain domainOf(ShadeMethod method);

// One pattern for all pixels, or one for each of a window's size² pixels (with equal counts), repeated for `layers` layers.
// Requires the method's domain.
ShadeSamples samplesOf(ShadeMethod method, const std::vector<Pattern>& variants, int layers = 1);

struct ShadeSettings
{
	ShadeMethod method{};
	double radius_m = 0.5;                  // > 0
	double strength = 1.0;                  // factor of the final obscurance, > 0
	double power = 1.0;                     // exponent of visibility after that, > 0
	double max_radius_px = 0.0;             // > 0: maximum radius in the picture, near the camera; 0: the picture's height
	double min_radius_px = 0.0;             // minimum radius, far away; at most max_radius_px
	DepthFormat depth;                      // input format of a module; also the assumed precision of depths without given errors
	int normal_bits = 32;                   // per component, 8 to 16 or 32; alchemy ignores occlusion within that rounding
	bool use_normal = true;                 // volumetric obscurance: only above the tangent plane
	double sigma = 1.0;                     // alchemy: intensity; lengths are in units of the radius
	double contrast = 1.0;                  // alchemy: k
	double beta = 1e-4;                     // alchemy: bias relative to the depth
	double epsilon = 1e-4;                  // alchemy: keeps the quotient finite, in squared radii
	bool cut = false;                       // alchemy: ignore surfaces beyond the radius
	int depth_levels = 0;                   // alchemy: coarser depth levels for distant samples, 0 to 8
	ShadeFilter filter = ShadeFilter::none; // window: requires samples with a window of more than one pixel
	int filter_taps = 5;                    // bilateral: taps per pass; odd, 5 to 13
	bool half_resolution = false;           // runs methods and filters for every second pixel on both axes, then upsamples
	VoSettings volume;                      // volumetric obscurance
	BandSettings bands;                     // for methods with patterns
	StatVoSettings statvo;
	SliceSettings slices;
	std::optional<DebugView> debug; // requires debugShows; noise, except for sao: samples of a window of more than one pixel

	// Parameters that a single method has, by their option ("--gtao-steps"), where they are not at their default. ownValue() in
	// feature_table.h reads them.
	std::map<std::string_view, double> own;
};

// True if strength or power change visibility.
inline bool isShaped(const ShadeSettings& settings)
{
	return settings.strength != 1.0 || settings.power != 1.0;
}

// True if a view applies to the method.
bool debugShows(DebugView view, const ShadeSettings& settings);

// Reorders samples so that 2i and 2i + 1 are opposite each other, with the centre last. Throws Error (invalid input) if the pattern
// is not symmetric.
Pattern pairedPattern(const Pattern& pattern);

// For methods without patterns.
ShadeSamples ownSamples(const ShadeSettings& settings);

// Crytek's points: the corners of a cube in turn, each further out than the previous one (ShaderX7: by 1 + 2.4 / count), the last
// at distance 1; equal weights. Requires a multiple of 8.
Pattern crytekPoints(int count);

// For the pixels of a 4 × 4 window in turn: directions × (cos, sin, jitter, weight), rotated by sixteenths of the angle between
// directions and jittered by sixteenths of a step, both in random order.
std::vector<glm::vec4> horizonDirections(int directions);

// For the pixels of a 4 × 4 window in turn: slices × (cos, sin, jitter, weight), rotated by sixteenths of the angle between slices
// and jittered by quarters of a step, in GTAO's order.
std::vector<glm::vec4> sliceDirections(int slices);

// (x, y, distance, weight): sample i of n is at distance (i + 1/2) / n, with `turns` turns in total.
std::vector<glm::vec4> spiral(int count, int turns);

} // namespace nook
