// SPDX-License-Identifier: GPL-3.0-or-later
// A level, the npm package, the catalogue → one page that makes patterns and shades the level in a browser: `nook report live`.
#pragma once

#include "core/progress.h"
#include "scene/load.h"

#include <string>
#include <vector>

namespace nook
{

struct LiveReportSettings
{
	std::string level = "builtin:suburb"; // a file, or "builtin:NAME"
	LoadSettings load;
	std::string camera;     // by name; empty: the level's first, or one chosen
	bool automatic = false; // one chosen
	int width_px = 640;     // of the picture
	int height_px = 360;    //
	int rays = 256;         // of the reference, a pixel
	double radius_m = 0.0;  // reach of its rays; 0: half of radiusFor() the level
	std::string package;    // folder of the npm package
	std::string catalogue;  // folder of the catalogue
	std::string version;    // of nook
};

// Makes the page again; the level by its file's name, the folders left out.
std::string commandOf(const LiveReportSettings& settings);

struct LivePage
{
	std::string html;
	std::vector<std::string> read; // files that it was made from
};

// The same bytes for the same arguments and files. Throws Error: file where the package or the catalogue is not there,
// invalid_input where they are of another version, and as loadLevel, camerasOf and shading do.
LivePage liveReport(const LiveReportSettings& settings, const RunSettings& run);

} // namespace nook
