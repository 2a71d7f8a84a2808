// SPDX-License-Identifier: GPL-3.0-or-later
// The pick of a search → the files that an engine needs, the commands that make them again, and the features left out.
#pragma once

#include "emit/module.h"
#include "study/tune.h"

#include <string>
#include <vector>

namespace nook
{

struct TuneEmitSettings
{
	GlslTarget target = GlslTarget::gl330; // volumes: gl330 or gl430
	bool device_depth = false;             // depth as a depth buffer holds it
	std::string version;                   // of nook
	LoadSettings load;                     // as the levels were read
};

struct LeftOut
{
	std::string feature;
	std::string why;
};

struct TuneEmission
{
	std::vector<EmittedFile> files;
	std::vector<std::string> commands; // make the files again, in order; those of the search not among them
	std::vector<std::string> use;      // what the engine has to set or to do, a line each
	std::vector<LeftOut> left_out;
};

// Requires something to take (TuneSearch::taken()). Throws Error (unsupported) for volumes in another language than OpenGL's GLSL.
TuneEmission emitPick(const TuneReport& report, const TuneEmitSettings& settings, const RunSettings& run);

} // namespace nook
