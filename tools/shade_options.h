// SPDX-License-Identifier: GPL-3.0-or-later
// The options of `nook shade`.
#pragma once

#include "aov_options.h"
#include "feature_options.h"
#include "gbuffer_options.h"
#include "options.h"
#include "picture_options.h"
#include "recipe_options.h"
#include "still_options.h"

#include "shade/shade.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr std::array<std::string_view, 2> kShadeFormats{".exr", ".png"};

struct ShadeOptions
{
	std::string gbuffer;
	GBufferImport import;
	ShadeSettings settings;
	std::string pattern; // a pattern or a tile; empty: 9 samples of our own
	bool gl = false;
	std::vector<FeatureOption> features;
	std::optional<int> frame;
	RecipeOption recipe;
	double reach_m = 0.0; // --radius
	CLI::Option* recipe_option = nullptr;
	PictureOptions picture;
	AovOptions aov;
	StillOptions still;
	std::size_t resolution = 0; // full, half, third, fifth
	CLI::Option* pattern_option = nullptr;
	std::vector<const CLI::Option*> of_screen; // of no method of volumes
	CLI::Option* filter = nullptr;
	CLI::Option* taps = nullptr;
	CLI::Option* device_number = nullptr;
	int device = 0;
	bool timing = false;
	Outputs outputs;
	int threads = 0;
};

void declareShade(CLI::App& app, ShadeOptions& options);

// What options stand for: the recipe, the filter that goes with the method.
void settle(ShadeOptions& options);

// Throws Error (usage) where options contradict each other.
void check(const ShadeOptions& options);

// A method of the screen, not volumes or a bake alone.
bool isOfScreen(const ShadeOptions& options);
std::string nameOfMethod(const ShadeOptions& options);

std::string_view resolutionOf(const ShadeOptions& options); // its name
int everyPx(const ShadeOptions& options);                   // 1, 2, 3, 5: of so many pixels of an axis one is drawn

} // namespace nook
