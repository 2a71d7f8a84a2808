// SPDX-License-Identifier: GPL-3.0-or-later
// The samples that nook shade takes: of a file, or of nook's own.
#pragma once

#include "core/progress.h"
#include "methods/settings.h"

#include <string>

namespace nook
{

// `path`: a pattern or a tile; empty: 9 samples of our own. Throws Error (invalid input) for a file that does not suit the method.
ShadeSamples shadeSamples(const std::string& path, const ShadeSettings& settings, const RunSettings& run);

} // namespace nook
