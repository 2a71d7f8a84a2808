// SPDX-License-Identifier: GPL-3.0-or-later
// The texts of the kernels of volumes, inside the library.
#pragma once

#include <string_view>

namespace nook::assets
{

extern const std::string_view form_factor_glsl;
extern const std::string_view mask_glsl;
extern const std::string_view volume_glsl;

} // namespace nook::assets
