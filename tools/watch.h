// SPDX-License-Identifier: GPL-3.0-or-later
// Who looks on while something is made: a page of the browser that the program runs in.
#pragma once

#include "core/progress.h"
#include "pattern/generate.h"

namespace nook
{

// Both empty where nobody does.
Progress pageProgress();
Watch pageWatch();

} // namespace nook
