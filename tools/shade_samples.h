// SPDX-License-Identifier: GPL-3.0-or-later
// The samples that nook shade takes: of a file, or of nook's own.
#pragma once

#include "core/progress.h"
#include "methods/settings.h"

#include <optional>
#include <string>

namespace nook
{

// `path`: a pattern or a tile; empty: 9 samples of our own. `frame`: of a tile of several. Throws Error for a file that does not
// suit the method, or the frame.
ShadeSamples shadeSamples(const std::string& path, const std::optional<int>& frame, const ShadeSettings& settings,
						  const RunSettings& run);

} // namespace nook
