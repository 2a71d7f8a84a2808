// SPDX-License-Identifier: GPL-3.0-or-later
// A G-buffer → one picture of visibility by a screen-space method, by occlusion volumes and by a bake.
#pragma once

#include "shade/aov.h"
#include "shade/asset_kinds.h"
#include "shade/shade.h"

#include <optional>
#include <string>
#include <vector>

namespace nook
{

struct ComposeSettings
{
	bool screen = true;       // a screen-space method draws
	ShadeSettings shade;      // its settings
	std::string pattern;      // its samples: a pattern or a tile; empty: nook's own
	std::optional<int> frame; // of a tile of several
	std::string volumes;      // a file of nook volumes; empty: none
	AovSettings aov;
	std::string bake;  // a file of nook bake; empty: none
	std::string fixed; // a G-buffer of what does not move; empty: none
	bool gl = false;
	DrawSettings drawing;
};

struct Composed
{
	Shaded shaded;
	ShadeSamples samples;                     // of the screen-space method
	AovCounts volumes;                        // if there are some
	double distance_m = 0.0;                  // of these
	double ray_distance_m = 0.0;              // of these
	std::optional<std::size_t> baked_pixels;  // with a bake
	std::optional<std::size_t> moving_pixels; // if the view without what moves is known
	std::vector<std::string> files;           // read of the bake and of what does not move
};

// Volumes and bake add up if the bake was made beside the volumes. A screen-space method darkens that: each pixel takes the lesser
// of the two, since both see the same creases. Where a pixel is known to show something that does not move it takes known · min(1,
// screen / screen without what moves): what both see cancels, so only moving things darken. Throws Error for files that do not suit
// the method or each other.
Composed compose(const ComposeSettings& settings, const GBuffer& gbuffer, const RunSettings& run);

// A picture without its guard band.
struct Picture
{
	int width_px = 0;
	int height_px = 0;
	std::vector<float> values;
};

// Throws Error (invalid_input) naming `path` if no pixel remains.
Picture withoutGuard(const std::string& path, const GBuffer& gbuffer, const std::vector<float>& values, int guard_px);

// For directions, after that.
std::vector<glm::vec3> withoutGuard(const GBuffer& gbuffer, const std::vector<glm::vec3>& values, int guard_px);

} // namespace nook
