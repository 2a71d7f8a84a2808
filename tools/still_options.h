// SPDX-License-Identifier: GPL-3.0-or-later
// Options of nook shade that have to do with what does not move: a bake, and the view without what moves; and the rule by which
// what is known of it and a screen-space method are drawn together.
#pragma once

#include "summary.h"

#include "bake/baked_picture.h"
#include "core/image.h"
#include "scene/gbuffer.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace nook
{

struct StillOptions
{
	bool alone = false; // --method bake
	std::string bake;   // a file of nook bake; empty: none
	std::string still;  // a G-buffer of what does not move; empty: none
};

// --bake, --static
void addStillOptions(CLI::App& app, StillOptions& options);

// Before any work; `volumes`: there are some; `screen`: the method is one of screen space. Throws Error (usage).
void checkStill(const StillOptions& options, bool volumes, bool screen);

// What is known of what does not move, pixel by pixel.
struct Still
{
	std::optional<BakedPicture> baked;
	std::optional<GBuffer> gbuffer; // of what does not move, where it differs from the picture's
	std::vector<uint8_t> is_still;  // 1: the pixel shows what does not move; empty: not known
	std::size_t baked_pixels = 0;
	std::size_t moving_pixels = 0;
	std::vector<std::string> files; // read
};

// Reads what there is. `mask`: volumes are drawn by masks, `volumes`: at all. Throws Error (invalid_input) for a bake that is not
// made for that, or for a G-buffer of another size or camera.
Still readStill(const StillOptions& options, bool volumes, bool mask, const GBuffer& gbuffer, const RunSettings& run);

// Visibility by volumes, empty where there are none, and by the bake: their sum where it was made beside them.
std::vector<float> visibilityOfStill(const Still& still, const std::vector<float>& by_volumes, std::size_t pixels);

// Screen space over what is known of what does not move. Without a view of that the lesser of the two: both see the same creases.
// With it, where the pixel shows what does not move, known · min(1, screen / screen_still): what both see cancels, so only what
// moves darkens. On what moves the lesser. `known`: where nothing is known 1.
std::vector<float> overStill(const Still& still, const std::vector<float>& known, const std::vector<float>& screen,
							 const std::vector<float>& screen_still);

void addStillFacts(Summary& summary, const StillOptions& options, const Still& still);

} // namespace nook
