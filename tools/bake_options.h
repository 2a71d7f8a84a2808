// SPDX-License-Identifier: GPL-3.0-or-later
// Options of nook bake: what they are, what contradicts what, and as the summary has them.
#pragma once

#include "bake_beside.h"
#include "level_options.h"
#include "options.h"
#include "summary.h"

#include "bake/bake.h"

#include <CLI/CLI.hpp>

#include <array>
#include <string>
#include <string_view>

namespace nook
{

inline constexpr std::array<std::string_view, 1> kBakeFormats{".glb"};
inline constexpr std::array<std::string_view, 2> kProbeFormats{".ktx2", ".glsl"};

struct BakeOptions
{
	LevelOptions level;
	BakeSettings settings;
	bool has_u = false;
	bool has_cap = false;
	std::string of_vertices; // the last option that vertices alone have
	double probes_m = 0.0;   // spacing; 0: vertices
	int texture_px = 0;      // 0: vertices
	BesideOptions beside;
	bool color = false;
	Outputs outputs;
	int threads = 0;
};

void addBakeOptions(CLI::App& app, BakeOptions& options);

// Options that contradict each other; defaults that depend on others. Throws Error (usage).
void settleBake(BakeOptions& options);

void addBakeSettings(Summary& summary, const BakeOptions& options);

} // namespace nook
