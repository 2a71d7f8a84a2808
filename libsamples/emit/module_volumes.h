// SPDX-License-Identifier: GPL-3.0-or-later
// How to draw a file of volumes → one GLSL file with the stages for an engine's programs.
#pragma once

#include "emit/module.h"
#include "format/notes.h"
#include "methods/aov_text.h"

#include <string>

namespace nook
{

// Volumes are drawn by OpenGL 3.3 and 4.3 alone.
constexpr bool drawsVolumes(GlslTarget target)
{
	return target == GlslTarget::gl330 || target == GlslTarget::gl430;
}

// The same text that `nook shade --device gl` draws with, and what an engine has to do beside it. The same bytes for the same
// arguments.
std::string volumesGlsl(const AovTextSettings& settings, const EmitContext& context);

} // namespace nook
