// SPDX-License-Identifier: GPL-3.0-or-later
// The scripts of a plan, put into the library when it is built (embed.cmake).
#pragma once

#include <string_view>

namespace nook::assets
{

extern const std::string_view Snakefile;
extern const std::string_view job_sh;
extern const std::string_view submit_sh;

} // namespace nook::assets
