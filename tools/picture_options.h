// SPDX-License-Identifier: GPL-3.0-or-later
// Options about the picture that is shaded: how large a radius may be in it, and which pixels around it are no part of it.
#pragma once

#include "methods/settings.h"
#include "scene/gbuffer.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace nook
{

struct PictureOptions
{
	int guard_px = 0; // on each side
};

// --guard, --max-pixels, --min-pixels
void addPictureOptions(CLI::App& app, ShadeSettings& settings, PictureOptions& picture);

// Before any work. Throws Error (usage).
void checkPictureOptions(const ShadeSettings& settings);

// A picture without its guard band. Throws Error (invalid_input) where nothing would be left of it.
struct Picture
{
	int width_px = 0;
	int height_px = 0;
	std::vector<float> values;
};
Picture withoutGuard(const std::string& path, const GBuffer& gbuffer, const std::vector<float>& values,
					 const PictureOptions& picture);

// The same of directions, after that.
std::vector<glm::vec3> withoutGuard(const GBuffer& gbuffer, const std::vector<glm::vec3>& values, const PictureOptions& picture);

} // namespace nook
