// SPDX-License-Identifier: GPL-3.0-or-later
// The options of nook bake, and its summary.
#pragma once

#include "scene_options.h"

#include "bake/bake.h"
#include "bake/texture.h"
#include "bake/unwrap.h"
#include "scene/gltf_edit.h"

#include <optional>
#include <string>
#include <vector>

namespace nook
{

struct BakeOptions
{
	LevelOptions level;
	BakeSettings settings;
	std::optional<double> falloff_u_m;
	double probes_m = 0.0; // spacing; 0: vertices
	int texture_px = 0;    // 0: vertices
	bool automatic = false;
	std::size_t max_bytes = 0; // with that; 0: by the error
	bool unwrap = false;       // texture coordinates of its own
	UnwrapSettings charts;     // for that
	std::string volumes;       // drawn as well; empty: none
	bool mask = false;         // how they are drawn
	int directions = 128;
	std::string to = "visibility";
	GltfBake form; // target, attribute, instances and color of it
	std::vector<std::string> occluders;
	std::vector<std::string> receivers;
	std::string from; // the detailed level; empty: none
	const CLI::App* app = nullptr;
	Outputs outputs;
};

void declareBake(CLI::App& app, BakeOptions& options);

// Refuses options whose values contradict each other; sets defaults that depend on others.
void settleBake(BakeOptions& options);

// A texture alone, by the ending.
bool isTextureName(const std::string& path);

void addBakeSettings(Facts& facts, const BakeOptions& options);

// How far the bake is from rays; `where` they were asked.
void addBakeCheck(Facts& facts, const BakeOptions& options, const BakeCheck& check, const std::string& where);

void addBakeResult(Facts& facts, const BakeOptions& options, const VertexBake& bake);
void addBakeTextures(Facts& facts, const std::vector<TextureBake>& pages, std::size_t png_bytes);

} // namespace nook
