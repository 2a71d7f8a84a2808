// SPDX-License-Identifier: GPL-3.0-or-later
// The headers that read and draw volumes, embedded in the library so that verbs can write them (MIT).
#pragma once

#include <string_view>

namespace nook::assets
{

extern const std::string_view nook_volumes_h;
extern const std::string_view nook_volumes_draw_h;

} // namespace nook::assets
