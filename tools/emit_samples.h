// SPDX-License-Identifier: GPL-3.0-or-later
// Files of patterns and tiles → the samples of a module's methods.
#pragma once

#include "emit/module.h"

#include <cstddef>
#include <optional>
#include <string>

namespace nook
{

// Fills the method's variants; returns the command that makes the file. `count`: only the first samples. Throws Error (file;
// invalid_input).
std::string readSamples(const std::string& path, std::optional<std::size_t> count, const ShadeSettings& shade,
						ModuleMethod& method);

// Throws Error (invalid_input) where a window filter would find no window, or more than one.
void checkWindows(const ModuleSettings& settings);

} // namespace nook
