// SPDX-License-Identifier: GPL-3.0-or-later
// The screen-space methods and all that can be said of them: what a picture is drawn with.
#pragma once

#include "methods/depth_format.h"
#include "methods/rivals.h"
#include "methods/statvo_settings.h"
#include "pattern/pattern.h"
#include "pattern/recipe.h"

#include <glm/vec4.hpp>

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace nook
{

// In the order of the table of methods (method_table.h).
enum class ShadeMethod
{
	vo_line,  // VO §4.1, lines of the disk
	vo_point, // VO §4, points of the ball
	vo_area,  // VO §4.2, lines of the disk that see the depths around them
	alchemy,  // ALC eq. 10, points of the disk
	statvo,   // SVO, no samples at all
	slices,   // bits of what is covered, on planes through the view ray
	// To compare with, never emitted (rivals_*.glsl), and last:
	crytek,     // points of the ball
	volumetric, // points uniform on the disk
	hbao,       // samples of its own
	sao,        // samples of its own
	gtao,       // slices of its own
	bitmask,    // slices of its own
};
template <> std::span<const std::string_view> namesOf<ShadeMethod>();

enum class ShadeFilter
{
	none,
	bilateral, // ALC §3.3: two one-dimensional passes that stay on the pixel's surface
	window,    // one pass: the mean over the window of variants, on the pixel's surface
};

// Drawn instead of visibility (debug.glsl); before any filter.
enum class DebugView
{
	edges,   // where a filter finds another surface beside a pixel
	lod,     // mean level of the coarser depths, or their moments, that the samples read, of the levels there are
	layers,  // statvo: layers looked at, of all
	samples, // samples taken, of all
	noise,   // standard deviation of the estimates by all variants of the window; sao: by sixteen turns of the spiral
};

// Volumetric obscurance beyond one ball of one density (VO §3, §4.3, §5).
enum class TwoRadii
{
	none,
	product,
	minimum,
};

struct VoSettings
{
	double thickness_m = 0.0;        // what a surface is thick; 0: without end
	double second_thickness_m = 0.0; // for the other radii; 0: as thickness_m
	double third_thickness_m = 0.0;
	TwoRadii radii = TwoRadii::none;
	double second_radius_m = 0.0; // > 0 with two radii
	double third_radius_m = 0.0;  // > 0: a third one, where there are two
	bool quadratic = false;       // falloff 1 − (d/r)² instead of 1
	bool paired = false;          // vo_line, vo_area: out of range as open as opposite; requires samples of pairedPattern
};

// How many balls are looked at.
inline int radiiOf(const VoSettings& volume)
{
	return volume.radii == TwoRadii::none ? 1 : volume.third_radius_m > 0.0 ? 3 : 2;
}

// Planes through the view ray, each with a mask of covered directions (slices.glsl).
struct SliceSettings
{
	int count = 1;           // of a pixel, evenly around the view ray; 1 to 16
	int steps = 4;           // depths on either side of each, 1 to 32
	double thickness = 0.65; // of surfaces at the reach, in radii; > 0
	bool bent = false;       // bent normals as well; requires full resolution and no window filter
};

// Fewer samples where the radius is small in the picture (ALC §4): bands of equally many samples. The first ones of a pattern must
// be a pattern themselves (one made with --order progressive).
struct BandSettings
{
	int count = 1;           // 1 to 3
	double first_px = 16.0;  // below this radius in the picture the first band alone
	double second_px = 48.0; // with three bands: below this, the first two
};

// Samples of every pixel of a window, which repeats over the picture.
struct ShadeSamples
{
	int size = 1;                   // side of the window, pixels
	int count = 0;                  // samples a pixel
	std::vector<glm::vec4> samples; // size² × count, of all frames: x, y, third, weight, for a radius of 1; third:
									// line: half length; point: z; area: log2 of the side of its area
	int variant = 0;                // of the frame that is drawn (variantOfFrame in tile.h)
	bool tiled = false;             // given, for a method that has its own as well
};

// False for methods whose samples are their own.
bool takesPattern(ShadeMethod method);

// Its samples are its own, unless it is given a tile.
bool mayTakeTile(ShadeMethod method);

// The domain of the patterns that a method takes: disk, ball, hemisphere (as points uniform on the disk), or slice. Requires
// takesPattern or mayTakeTile.
Domain domainOf(ShadeMethod method);

// One pattern for all pixels, or one for each of a window's size² (all of one count), as many `layers` of them one after the other.
// Requires their domain to be the method's.
ShadeSamples samplesOf(ShadeMethod method, const std::vector<Pattern>& variants, int layers = 1);

struct ShadeSettings
{
	ShadeMethod method{};
	double radius_m = 0.5;                  // > 0
	double strength = 1.0;                  // factor of the obscurance at the end, > 0
	double power = 1.0;                     // of visibility after that, > 0
	double max_radius_px = 0.0;             // > 0: near the camera no radius is greater in the picture; 0: the picture's height
	double min_radius_px = 0.0;             // far away no radius is less; at most max_radius_px
	DepthFormat depth;                      // of a module's input, and how exact depths are that come without their errors
	int normal_bits = 32;                   // of a component, 8 to 16 or 32; alchemy: what that turns counts for nothing
	bool use_normal = true;                 // volumetric obscurance: above the tangent plane alone
	double sigma = 1.0;                     // alchemy: intensity; lengths are in units of the radius
	double contrast = 1.0;                  // alchemy: k
	double beta = 1e-4;                     // alchemy: bias as a share of the depth
	double epsilon = 1e-4;                  // alchemy: keeps the quotient finite, in squares of the radius
	bool cut = false;                       // alchemy: leave out what is further than the radius
	int depth_levels = 0;                   // alchemy: coarser depths for samples that are far away, 0 to 8
	ShadeFilter filter = ShadeFilter::none; // window: requires samples with a window of more than one pixel
	int filter_taps = 5;                    // bilateral: of each pass; odd, 5 to 13
	bool half_resolution = false;           // methods and filters for every second pixel of both axes, then full resolution again
	VoSettings volume;                      // volumetric obscurance
	BandSettings bands;                     // of methods that take a pattern
	StatVoSettings statvo;
	SliceSettings slices;
	RivalSettings rival;            // of the methods to compare with
	std::optional<DebugView> debug; // requires debugShows; noise but for sao: samples of a window of more than one pixel
};

// Strength or power change visibility.
inline bool isShaped(const ShadeSettings& settings)
{
	return settings.strength != 1.0 || settings.power != 1.0;
}

// Does a view say anything of the method.
bool debugShows(DebugView view, const ShadeSettings& settings);

// With the samples 2i and 2i + 1 at opposite sides, one at the centre last. Throws Error (invalid input) for one without symmetry.
Pattern pairedPattern(const Pattern& pattern);

// Of a method that takes no pattern.
ShadeSamples ownSamples(const ShadeSettings& settings);

} // namespace nook
