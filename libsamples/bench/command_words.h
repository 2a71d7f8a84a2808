// SPDX-License-Identifier: GPL-3.0-or-later
// What stated commands are made of.
#pragma once

#include "scene/load.h"

#include <string>

namespace nook
{

// As one word of a shell.
std::string shellWord(const std::string& text);

// Options of what differs from the defaults, each after a blank: " --unit 0.01 --up z --strict".
std::string loadOptions(const LoadSettings& load);

} // namespace nook
