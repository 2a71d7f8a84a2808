// SPDX-License-Identifier: GPL-3.0-or-later
// Levels built in code, in metres, each with named cameras; the first is called "main".
#pragma once

#include "scene/level.h"

#include <span>
#include <string>
#include <string_view>

namespace nook
{

inline constexpr std::string_view kBuiltinPrefix = "builtin:";

// "cornell", "courtyard", …: what may follow the prefix.
std::span<const std::string_view> builtinNames();

// `name` without the prefix; "heightfield:1000000", "cave:20000" ask for at least that many triangles. Throws Error (usage) for
// another name.
Level builtinLevel(std::string_view name);

} // namespace nook
