// SPDX-License-Identifier: GPL-3.0-or-later
// Options that say how to read a G-buffer, shared by the verbs that take one.
#pragma once

#include "scene/gbuffer.h"

#include <CLI/CLI.hpp>

#include <vector>

namespace nook
{

// --depth, --clip, --sky-depth, --depth-channel, --normal-channels, --normal-space, --normal-range: what the file's channels hold.
// Returns the options, for verbs that take other inputs too.
std::vector<CLI::Option*> addGBufferChannels(CLI::App& app, GBufferImport& import);

// The same, and --normals, --projection, --world-to-camera. What is not given comes from the file. Pass `import` to readGBuffer().
void addGBufferImport(CLI::App& app, GBufferImport& import);

// Before any work: refuses options that contradict each other. Throws Error (usage).
void checkGBufferImport(const GBufferImport& import);

} // namespace nook
