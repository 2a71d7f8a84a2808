// SPDX-License-Identifier: GPL-3.0-or-later
// Words and options of the commands that reports state.
#pragma once

#include "scene/load.h"

#include <string>

namespace nook
{

// Quotes a text where a shell needs it.
std::string shellWord(const std::string& text);

// Options of what differs from the defaults, each after a blank: " --unit 0.01 --up z --strict".
std::string loadOptions(const LoadSettings& load);

} // namespace nook
