// SPDX-License-Identifier: GPL-3.0-or-later
// The headers that read and draw volumes, inside the library: for what hands them out (MIT, as they say).
#pragma once

#include <string_view>

namespace nook::assets
{

extern const std::string_view nook_volumes_h;
extern const std::string_view nook_volumes_draw_h;

} // namespace nook::assets
