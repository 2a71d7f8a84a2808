// SPDX-License-Identifier: GPL-3.0-or-later
// nook shade --debug: what a method does, as a picture.
#pragma once

#include "methods/settings.h"

#include <CLI/CLI.hpp>

#include <string_view>

namespace nook
{

void addDebugOption(CLI::App& app, ShadeSettings& settings);

// As on the command line; "visibility" without a view.
std::string_view debugName(const ShadeSettings& settings);

// Before any work, and once the samples are known. Throws Error (usage) for views that say nothing.
void checkDebug(const ShadeSettings& settings);
void checkDebug(const ShadeSettings& settings, const ShadeSamples& samples);

} // namespace nook
