// SPDX-License-Identifier: GPL-3.0-or-later
// Options of nook shade that have to do with a level's occlusion volumes: by themselves (aov, aov-mask) or beside a screen-space
// method.
#pragma once

#include "summary.h"

#include "core/file.h"
#include "shade/aov.h"

#include <CLI/CLI.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace nook
{

struct AovOptions
{
	bool alone = false; // the method is one of volumes
	std::string path;   // of the volumes; empty: none
	AovSettings settings;
	bool no_compensation = false;
	bool draw_all = false;
	CLI::Option* faces = nullptr;
	CLI::Option* directions = nullptr;
	CLI::Option* accumulate = nullptr;
};

// --volumes, --directions, --accumulate, --no-compensation, --draw-all, --faces
void addAovOptions(CLI::App& app, AovOptions& options);

// The name on the command line of a method of volumes.
std::string_view methodName(const AovOptions& options);

// Before any work; `others`: options of screen-space methods alone. Throws Error (usage).
void checkAovOptions(const AovOptions& options, bool gl, const std::vector<const CLI::Option*>& others);

// What a picture was made of: the file, and how its volumes were drawn.
struct AovFacts
{
	std::string path;
	double distance_m = 0.0;
	double ray_distance_m = 0.0;
	int every_px = 1;
	AovCounts counts;
};

// Reads the volumes and draws them.
Shaded drawVolumes(const AovOptions& options, bool gl, const GBuffer& gbuffer, const RunSettings& run, const DrawSettings& drawing,
				   AovFacts& facts);

void addAovNotes(Notes& notes, const AovOptions& options, const AovFacts& facts);
void addAovFacts(Summary& summary, const AovOptions& options, const AovFacts& facts, bool gl);

} // namespace nook
