// SPDX-License-Identifier: GPL-3.0-or-later
// nook emit --methods aov or aov-mask: the GLSL module that draws the files of nook volumes.
#pragma once

#include "emit_options.h"

namespace nook
{

bool isOfVolumes(const EmitOptions& options);

// Writes the outputs. Throws Error (usage) for options of screen-space methods.
void emitVolumes(const EmitOptions& options, const CLI::App& app);

} // namespace nook
