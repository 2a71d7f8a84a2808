// SPDX-License-Identifier: GPL-3.0-or-later
// A debug view as passes, in place of those that draw visibility and filter it.
#pragma once

#include "methods/passes.h"

namespace nook
{

// After the passes that `method` reads. Requires settings.debug. The size is the picture's, in pixels.
void addDebugView(ShadePlan& plan, const ShadePass& method, const ShadeSettings& settings, int width_px, int height_px);

} // namespace nook
