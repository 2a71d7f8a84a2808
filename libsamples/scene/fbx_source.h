// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/value_stream.h"
#include "scene/load.h"

#include <string>

namespace nook
{

// Reads an FBX file and sends what readGeometry() takes (load_parts.h). Throws Error.
void sendFbx(const std::string& path, const LoadSettings& settings, ValueWriter& to);

} // namespace nook
